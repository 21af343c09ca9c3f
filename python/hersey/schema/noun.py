"""What slides, by the one word that its machine file has for it."""

from __future__ import annotations

from typing import Literal

#: What slides on its counterface. Words begin with a consonant, so that "a" goes before each.
Noun = Literal["drive", "belt", "joint", "seal", "shaft", "pad", "guide", "bearing", "gear", "screw"]
#: Where no machine file names it.
DRIVE: Noun = "drive"
#: What a roll drives, and may slip on.
BELT: Noun = "belt"
#: What turns as a whole, so that its stiffness is torsional and its inertia a moment.
TURNING = frozenset({"joint", "shaft", "bearing", "gear"})


def puller_of(part: Noun) -> str:
    """Return what drives the part, and slips on it where the grip does not suffice."""
    return "roll" if part == BELT else "drive"
