"""Which specimens need attention, and when the others should be looked at again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from hersey.errors import sentence
from hersey.life.growth.limit_ages import SURE, Interval, rounded
from hersey.life.time_to_failure.first import SpecimenEnd
from hersey.result import Means, Record

#: Specimens that a sentence names.
_NAMED = 4
_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


@dataclass(frozen=True)
class Attention(Record):
    """Specimens by their state when last seen, and the age that the running ones should reach."""

    failed: Annotated[tuple[str, ...], Means("specimens that have failed with 95 % probability or more")]
    unclear: Annotated[tuple[str, ...], Means("specimens that may have failed")]
    running: Annotated[tuple[str, ...], Means("specimens that have failed with 5 % probability at most")]
    look_again: Annotated[
        float | None,
        Means(
            "age that the running specimens should reach: the least lower end of their intervals, at most "
            f"{SURE:g} times the age followed; null if none is running"
        ),
    ]

    def words(self, age_unit: str) -> list[str]:
        """Return which specimens need attention, and what the others should reach, as sentences."""
        said = [
            f"{_named(self.failed)} {'has' if len(self.failed) == 1 else 'have'} probably failed"
            if self.failed
            else "",
            f"{_named(self.unclear)} may have" + ("" if self.failed else " failed") if self.unclear else "",
        ]
        count = len(self.failed) + len(self.unclear)
        need = "specimen needs" if count <= 1 else "specimens need"
        lines = [f"{_number(count)} {need} attention" + ": " * bool(count) + ", ".join(filter(None, said))]
        if self.look_again is not None:
            age = f"{rounded(self.look_again)} {age_unit}".strip()
            lines.append(f"{self._others} should reach at least {age}")
        return [sentence(each) for each in lines]

    @property
    def _others(self) -> str:
        """The running specimens, as the subject of a sentence."""
        count = len(self.running)
        if count == 1:
            return self.running[0]
        rest = "the other" if self.failed or self.unclear else "all"
        return f"{rest} {_number(count)}"


def attention_of(specimens: Sequence[SpecimenEnd]) -> Attention:
    """Return which specimens need attention, each state in the order of the ages at failure."""
    ordered = sorted(specimens, key=lambda each: each.age.age.value)
    named = {
        state: tuple(each.unit for each in ordered if each.state == state)
        for state in ("failed", "unclear", "running")
    }
    lows = [each.age.age.low for each in specimens if each.state == "running"]
    return Attention(**named, look_again=min(lows, default=None))


def half_failed(b50: Interval, shares: dict[str, Interval], age_unit: str) -> str:
    """Return the age by which half of new specimens fail, and the main failure mode, as a sentence."""
    unit = f" {age_unit}" if age_unit else ""
    if math.isinf(b50.value):
        least = f"{rounded(b50.low)}{unit}" if math.isfinite(b50.low) else "any age"
        return f"Fewer than half of new specimens fail before {least}."
    high = "no upper limit" if math.isinf(b50.high) else rounded(b50.high)
    ends = f"{rounded(b50.low)} to {high}{unit}"
    likely = max(shares, key=lambda name: shares[name].value)
    by = "mostly" if shares[likely].value > 0.5 else "most often"
    return f"Half of new specimens fail by {rounded(b50.value)}{unit} (90 %: {ends}), {by} by {likely}."


def _number(count: int) -> str:
    return _NUMBERS[count] if count < len(_NUMBERS) else str(count)


def _named(names: Sequence[str]) -> str:
    """The first of the names, and how many more there are."""
    shown = list(names[:_NAMED])
    if len(names) > _NAMED:
        return f"{', '.join(shown)} and {len(names) - _NAMED} more"
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"
