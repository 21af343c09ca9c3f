"""Whether anything ages: which failure modes show growth, and how long none can fail if none does."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

from hersey.life.growth.limit_ages import CONFIDENCE
from hersey.life.time_to_failure.way import FittedWay
from hersey.result import Means, Record


@dataclass(frozen=True)
class Ageing(Record):
    """Which failure modes show growth, and the earliest age at which a specimen can fail; ages as given.

    ``none_before`` counts each mode as growing as fast as the runs allow. It moves with the test: as many
    runs over twice the ages, again without growth, show twice that age.
    """

    also_stated = ("doubled", "until", "enough")

    shown: Annotated[Literal["all", "some", "none"], Means("failure modes that show growth")]
    unchanged: Annotated[tuple[str, ...], Means("failure modes that show no growth")]
    confidence: Annotated[float, Means("of `none_before`")]
    none_before: Annotated[
        float | None, Means("age before which no specimen fails, at this confidence; null if unknown")
    ]
    followed: Annotated[float, Means("greatest age")]
    goal: Annotated[float | None, Means("age that specimens should reach, if stated")] = None

    @property
    def doubled(self) -> float | None:
        """Age before which none fails if the test goes on to twice the age, without growth."""
        return None if self.shown != "none" or self.none_before is None else 2.0 * self.none_before

    @property
    def until(self) -> float | None:
        """Age to which the test must go on to show the goal, if still nothing grows; None without a goal."""
        if self.goal is None or self.shown != "none" or not self.none_before:
            return None
        return max(self.followed, self.followed * self.goal / self.none_before)

    @property
    def enough(self) -> bool | None:
        """Whether the test has shown the goal, and may stop; None without a goal."""
        if self.goal is None or self.none_before is None:
            return None
        return self.none_before >= self.goal

    def headline(self, age_unit: str) -> str:
        """Return that nothing grows, and the age before which none fails."""
        words = "no specimen shows growth"
        if self.none_before is None:
            return words
        age = before(self.none_before, age_unit)
        return f"{words}. At {100 * self.confidence:g} % confidence none fails before {age}"

    def advice(self, age_unit: str) -> str:
        """Return how long the test must go on where nothing grows."""
        if self.doubled is None:
            return ""
        if self.enough and self.goal is not None:
            return f"stop the test: none fails before {before(self.goal, age_unit)}"
        if self.until is not None and self.goal is not None:
            return (
                f"follow the specimens to {after(self.until, age_unit)}. If nothing grows by then, none "
                f"fails before {before(self.goal, age_unit)}"
            )
        return (
            f"follow the specimens to {after(2.0 * self.followed, age_unit)}. If nothing grows by then, "
            f"none fails before {before(self.doubled, age_unit)}"
        )


def before(age: float, age_unit: str) -> str:
    """Return an age, rounded down to two digits, in words."""
    return _rounded(age, age_unit, math.floor)


def after(age: float, age_unit: str) -> str:
    """Return an age, rounded up to two digits, in words."""
    return _rounded(age, age_unit, math.ceil)


def _rounded(age: float, age_unit: str, way: Callable[[float], int]) -> str:
    if age <= 0.0:
        return f"0 {age_unit}".strip()
    digit = 10.0 ** (math.floor(math.log10(age)) - 1)
    steps = age / digit
    whole = round(steps) if math.isclose(steps, round(steps), rel_tol=1e-9) else way(steps)
    return f"{float(f'{whole * digit:.3g}'):,.10g} {age_unit}".strip()


def ageing_of(ending: Sequence[FittedWay], followed: float, goal: float | None) -> Ageing:
    """Return what the failure modes that end a specimen show together."""
    unchanged = tuple(each.mode.name for each in ending if not each.mode.grows)
    earliest = min(each.mode.none_before for each in ending)
    return Ageing(
        "all" if not unchanged else "none" if len(unchanged) == len(ending) else "some",
        unchanged,
        CONFIDENCE,
        earliest if math.isfinite(earliest) else None,
        followed,
        goal,
    )
