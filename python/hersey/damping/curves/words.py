"""The laws of drag curves in words."""

from __future__ import annotations

from collections.abc import Sequence

from hersey.damping.curves.mixture import LawWeight


def weight_lines(laws: Sequence[LawWeight]) -> list[str]:
    """Return a line for each law: its weight, its name, and whether the dwells reject it."""
    return [
        f"  {100 * law.weight:5.1f} %  {law.words}{' (rejected)' if law.rejected else ''}" for law in laws
    ]


def drag_curves(laws: Sequence[LawWeight]) -> str:
    """Return the laws by weight under their heading, for the terminal."""
    heading = "[[Drag curves]]    (weights with which they enter V* and the decision)"
    return "\n".join([heading, *weight_lines(laws)])
