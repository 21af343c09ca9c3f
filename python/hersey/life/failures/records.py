"""Parts of the law of ages at failure: parameters, laws compared, failure modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.result import OPEN, Means, Record


@dataclass(frozen=True)
class BLife(Record):
    """Age by which a share of all specimens has failed, with its interval."""

    share: float
    age: float
    low: float
    high: Annotated[float, OPEN]  #: infinite where no upper end is known
    level: float

    @property
    def name(self) -> str:
        """Usual name, e.g. B10."""
        return f"B{100 * self.share:g}"


@dataclass(frozen=True)
class LawParameter(Record):
    """A parameter of a law with its bounds."""

    name: str
    value: float
    low: Annotated[float, OPEN]
    high: Annotated[float, OPEN]
    unit: Annotated[str, Means("unit of the ages, or empty for a pure number")]


@dataclass(frozen=True)
class LawComparison(Record):
    """A law that was tried, and how well it fits beside the others."""

    law: str
    log_likelihood: float
    aic: Annotated[float, Means("Akaike's criterion; the law with the least fits best")]


@dataclass(frozen=True)
class ModeLaw(Record):
    """The law of one failure mode, to which specimens that failed otherwise are suspensions."""

    mode: str
    failures: int
    parameters: tuple[LawParameter, ...]
    b10: BLife | None


@dataclass(frozen=True)
class Reliability(Record):
    """The share that outlives an age, with its bounds at a level."""

    age: float
    share: float
    low: float
    high: float
    level: float


def written(value: float, digits: int = 4) -> str:
    """Return a number with so many digits, those up to ten millions without a power of ten."""
    return f"{float(f'{value:.{digits}g}'):.8g}" if np.isfinite(value) else "unknown"


def span(low: float, high: float) -> str:
    """Return bounds in brackets."""
    return f"[{written(low)}, {written(high)}]"
