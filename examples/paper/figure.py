"""A figure of the paper or of our own, its claims, and the verdicts on them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from hersey.charts.style import Chart

#: How far "about" reaches: in an exponent, or as a share of a value.
ABOUT = 0.1
#: Relative differences below this are rounding.
ROUNDING = 1e-6


class Verdict(StrEnum):
    """Whether a claim holds."""

    HOLDS = "holds"
    IN_DIRECTION = "holds in direction, not in size"
    FAILS = "does not hold"

    @classmethod
    def of(cls, holds: bool, in_direction: bool) -> Verdict:
        """Return the verdict: a comparison with a missing number (nan) is false, so it fails."""
        if holds:
            return cls.HOLDS
        return cls.IN_DIRECTION if in_direction else cls.FAILS


@dataclass(frozen=True)
class Claim:
    """One claim, the criterion it is judged by, the verdict, and the numbers behind it."""

    source: str
    statement: str
    criterion: str
    verdict: Verdict
    evidence: str
    numbers: Mapping[str, float]


@dataclass(frozen=True)
class PaperFigure:
    """A figure of the paper, drawn anew, with its claims and the ``data`` of its curves by column."""

    number: int
    title: str
    chart: Chart
    claims: tuple[Claim, ...]
    data: Mapping[str, tuple[float, ...]]

    @property
    def name(self) -> str:
        """Name of its files, without the suffix."""
        return f"figure-{self.number:02d}"

    @property
    def heading(self) -> str:
        """What stands over it."""
        return f"Fig. {self.number}: {self.title}"


@dataclass(frozen=True)
class OwnFigure:
    """A figure that the paper does not have, under the ``name`` of its files; else as `PaperFigure`."""

    name: str
    title: str
    chart: Chart
    claims: tuple[Claim, ...]
    data: Mapping[str, tuple[float, ...]]

    @property
    def number(self) -> None:
        """It has none in the paper."""
        return

    @property
    def heading(self) -> str:
        """What stands over it."""
        return f"Beyond the paper: {self.title}"


Figure = PaperFigure | OwnFigure


def shown(value: float) -> str:
    """Return a number to four significant digits, zeros among them."""
    return f"{value:#.4g}".rstrip(".")
