"""Ages of specimens that failed, and of those that did not: exact, at least, at most, or between two."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hersey.arguments.frozen import explained
from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.failures.acceleration import Relation
from hersey.life.failures.likelihood import Observed


@explained
@dataclass(frozen=True)
class Failures:
    """Specimens, a row for each age: it failed after ``low`` and by ``high``, in ``unit``.

    Equal ends are an exact age; ``high`` is infinite for specimens that have not failed, ``low`` is 0 where
    only the latest age is known. ``count`` is the number of specimens of a row, ``mode`` their failure mode
    (empty where there is none), ``stress`` the temperature (K) or load of a row, which
    acts on life by the ``relation``; ages are wanted for the stress ``use``. All are None where it does not.
    """

    low: FloatArray
    high: FloatArray
    count: IntArray
    unit: str = ""
    mode: tuple[str, ...] = ()
    stress: FloatArray | None = None
    stress_unit: str = ""
    relation: Relation | None = None
    use: float | None = None

    @property
    def failed(self) -> BoolArray:
        """Whether the specimens of each row have failed."""
        return np.isfinite(self.high)

    @property
    def exact(self) -> BoolArray:
        """Whether each row is a failure at an exact age."""
        return np.asarray(self.low == self.high)

    @property
    def failures(self) -> int:
        """Number of specimens that have failed."""
        return int(self.count[self.failed].sum())

    @property
    def specimens(self) -> int:
        """Number of specimens."""
        return int(self.count.sum())

    @property
    def modes(self) -> tuple[str, ...]:
        """Failure modes, the most frequent first."""
        named = {each for each in self.mode if each}
        counted = {name: int(self.count[[each == name for each in self.mode]].sum()) for name in named}
        return tuple(sorted(named, key=lambda name: (-counted[name], name)))

    def of_mode(self, mode: str) -> Failures:
        """Return the same with only one mode as failures: a specimen that failed otherwise had outlived it.

        Where the age of another failure is known between two inspections, it outlived the earlier one.
        """
        own = np.array([each == mode for each in self.mode])
        others = self.failed & ~own
        low = np.where(others & ~self.exact, self.low, np.where(others, self.high, self.low))
        high = np.where(others, np.inf, self.high)
        keep = low + np.where(np.isfinite(high), 1, 0) > 0  # one found failed at the first look says nothing
        names = tuple(name if mine else "" for name, mine in zip(self.mode, own, strict=True))
        return replace(self, low=low, high=high, mode=names).at(keep)

    def at(self, rows: BoolArray) -> Failures:
        """Return some of the rows."""
        names = tuple(name for name, kept in zip(self.mode, rows, strict=True) if kept) if self.mode else ()
        stress = None if self.stress is None else self.stress[rows]
        return replace(
            self, low=self.low[rows], high=self.high[rows], count=self.count[rows], mode=names, stress=stress
        )

    def observed(self, covariate: FloatArray | None = None) -> Observed:
        """Return what the likelihood takes; ``covariate`` is what acts on ln age, of each row."""
        stress = np.zeros(self.low.size) if covariate is None else covariate
        exact, right = self.exact, ~self.failed
        between = ~(exact | right)
        with np.errstate(divide="ignore"):
            low, high = np.log(self.low), np.log(self.high)
        count = self.count.astype(float)
        return Observed(
            exact=low[None, exact],
            right=low[None, right],
            low=low[None, between],
            high=high[None, between],
            exact_count=count[exact],
            right_count=count[right],
            between_count=count[between],
            exact_stress=stress[exact],
            right_stress=stress[right],
            between_stress=stress[between],
        )
