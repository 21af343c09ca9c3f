"""Every run against its own specimen and the others: the state from which slips are judged."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.diagnostics.fingerprint import Fingerprints
from hersey.life.diagnostics.trends import (
    FREEDOM,
    LeftOut,
    Mean,
    Rows,
    Spreads,
    freedom_of,
    innovations,
    left_out,
    log_density,
    robust_mean,
    spreads_of,
    whitening,
)

#: Least difference of neighbours that is believed, relative.
_LEAST = 2e-3


@dataclass(frozen=True)
class Compared:
    """Runs with their trend: whitened numbers less the mean of all specimens, and what the others say."""

    rows: Rows
    whiten: FloatArray
    mean: Mean
    spreads: Spreads
    freedom: float = FREEDOM

    @classmethod
    def of(
        cls, specimen: IntArray, age: FloatArray, prints: Fingerprints, near: Compared | None = None
    ) -> Compared:
        """Return known runs compared; ages are over a usual last age, ``near`` has almost the same runs."""
        raw = Rows.of(specimen, age, prints.value, prints.variance)
        floor = np.maximum(np.sqrt(np.median(prints.variance, axis=0)), _LEAST)
        whiten = whitening(innovations(raw, raw.value - robust_mean(raw).at(raw.age)), floor)
        variance = prints.variance @ (whiten**2).T
        rows = Rows.of(specimen, age, prints.value @ whiten.T, variance)
        mean = robust_mean(rows)
        near_by = None if near is None or near.terms != whiten.shape[0] else near.spreads
        spreads = spreads_of(rows, rows.value - mean.at(rows.age), near_by)
        found = cls(rows, whiten, mean, spreads)
        return replace(found, freedom=freedom_of(found.squares, found.terms))

    def with_runs(self, specimen: IntArray, age: FloatArray, prints: Fingerprints) -> Compared:
        """Return other runs in the place of its own, by the same trend."""
        rows = Rows.of(specimen, age, prints.value @ self.whiten.T, prints.variance @ (self.whiten**2).T)
        return replace(self, rows=rows)

    def density(self, square: FloatArray, logs: FloatArray, runs: int = 1) -> FloatArray:
        """Return the log density of squared distances of so many runs together; ``logs`` of variances."""
        return log_density(square, logs, runs * self.terms, self.freedom)

    @property
    def terms(self) -> int:
        """How many numbers a run has."""
        return int(self.rows.value.shape[-1])

    @cached_property
    def left(self) -> FloatArray:
        """Numbers less the mean, (specimens, runs, terms)."""
        return np.asarray(self.rows.value - self.mean.at(self.rows.age))

    @cached_property
    def out(self) -> LeftOut:
        """What all other runs of a specimen say of each of its runs."""
        return left_out(self.left, self.rows, self.spreads)

    @cached_property
    def off(self) -> FloatArray:
        """By how much each run differs from what the others say, (runs, terms)."""
        return self.rows.flat(self.out.off)

    @cached_property
    def variance(self) -> FloatArray:
        """Variance of `off`, (runs, terms)."""
        return self.rows.flat(self.out.variance)

    @cached_property
    def squares(self) -> FloatArray:
        """Squared studentised distance of each run."""
        return np.asarray((self.off**2 / self.variance).sum(axis=1))

    @cached_property
    def logs(self) -> FloatArray:
        """Log density of each run under the others of its specimen."""
        return self.density(self.squares, np.log(self.variance).sum(axis=1))

    @property
    def distance(self) -> FloatArray:
        """Studentised distance of each run from what the others of its specimen say: 1 is the usual one."""
        return np.asarray(np.sqrt(self.squares / self.terms))

    @cached_property
    def influence(self) -> FloatArray:
        """By how much the torque of a specimen at its last age moves without each run, relative.

        What all others say of a run and its weight in the trend give it, without another fit.
        """
        rows, spreads = self.rows, self.spreads
        last = np.where(rows.given, rows.age, 0.0).max(axis=1, keepdims=True)
        common = spreads.level[0] ** 2 + spreads.slope[0] ** 2 * last * rows.age
        common = (common + spreads.walk[0] ** 2 * np.minimum(last, rows.age)) * rows.given
        weight = (common[:, None] @ self.out.precision[:, 0])[:, 0]
        return np.asarray(np.expm1(-rows.flat(weight * self.out.off[..., 0]) / self.whiten[0, 0]))
