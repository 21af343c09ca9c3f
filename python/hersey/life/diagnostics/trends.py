"""What a specimen's own runs, and the other specimens, let expect of each of its runs.

A number of a run is the mean of all specimens at that age, plus the level of the specimen, its own slope, a
random
walk and the scatter of runs: a Gaussian process of each specimen (Rasmussen and Williams, Gaussian Processes,
2006,
5.4.2 for what all runs but one say of that one). Numbers are made independent by the covariance with which
runs
differ from their neighbours. Every distance is judged by Student's law, so that one run more or less decides
nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import optimize, special

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.padded_rows import PaddedRows

#: Degrees of freedom of Student's law: the usual ones, and those that runs may show.
FREEDOM = 8.0
_FREEDOMS = (2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
#: Knots of the mean over specimens, at the most.
_KNOTS = 5
#: Rounds of the robust mean, and the deviation (in the median one) from which on a run counts less.
_ROUNDS, _FAR = 8, 2.0
#: Runs from which the spreads are estimated, at most.
_SPECIMENS = 40
#: Variance that stands for no run.
_NONE = 1e9
#: How far the start of the search for spreads is known: deviation of their logarithms.
_KNOWN = np.array([1.0, 1.5, 1.5, 0.7])
#: Sides of its first simplex.
_SIDES = np.array([0.7, -1.0, -1.0, -0.7])


@dataclass(frozen=True)
class Rows:
    """Runs as rows of specimens: ages over a usual one, numbers (specimens, runs, terms), variances."""

    age: FloatArray
    value: FloatArray
    variance: FloatArray
    given: BoolArray
    row: IntArray  #: of each run
    column: IntArray

    @classmethod
    def of(cls, specimen: IntArray, age: FloatArray, value: FloatArray, variance: FloatArray) -> Rows:
        """Return runs, sorted by specimen, as rows."""
        rows = PaddedRows.of(specimen)
        wide = [np.stack([rows.filled(c) for c in v.T], axis=-1) for v in (value, variance)]
        return cls(rows.filled(age), wide[0], wide[1], rows.given, rows.row, rows.column)

    def flat(self, values: FloatArray) -> FloatArray:
        """Return what belongs to each run, in the order of the runs."""
        return values[self.row, self.column]


@dataclass(frozen=True)
class Spreads:
    """Standard deviations, shape (terms,), of level, slope, random walk and runs."""

    level: FloatArray
    slope: FloatArray
    walk: FloatArray
    run: FloatArray

    def covariance(self, age: FloatArray, variance: FloatArray, given: BoolArray) -> FloatArray:
        """Return the covariances of runs at ages, (..., runs): (..., terms, runs, runs)."""
        one, other = age[..., :, None], age[..., None, :]
        parts = [
            each[:, None, None] ** 2 * kernel[..., None, :, :]
            for each, kernel in (
                (self.level, np.ones_like(one * other)),
                (self.slope, one * other),
                (self.walk, np.minimum(one, other)),
            )
        ]
        both = given[..., :, None] & given[..., None, :]
        own = np.moveaxis(variance, -1, -2) + self.run[:, None] ** 2
        own = np.where(given[..., None, :], own, _NONE)
        return np.where(both[..., None, :, :], sum(parts), 0.0) + own[..., None] * np.eye(age.shape[-1])


@dataclass(frozen=True)
class Mean:
    """The mean of all specimens at an age, of each term: straight between knots, the last value beyond."""

    knots: FloatArray
    height: FloatArray  #: (knots, terms)

    def at(self, age: FloatArray) -> FloatArray:
        """Return it, (..., terms)."""
        return _hats(age, self.knots) @ self.height


def _hats(age: FloatArray, knots: FloatArray) -> FloatArray:
    return np.stack([np.interp(age, knots, unit) for unit in np.eye(knots.size)], axis=-1)


def robust_mean(rows: Rows) -> Mean:
    """Return the mean of all specimens; each counts the same, and runs far from it count less."""
    ages = rows.age[rows.given]
    specimens = len(rows.age)
    inside = ages[ages <= 1.5]
    inside = inside if inside.size else ages
    count = 1 if specimens < 2 else min(_KNOTS, max(2, np.unique(inside).size // 2 + 1))
    knots = np.unique(np.quantile(inside, np.linspace(0.0, 1.0, count)))
    hats = _hats(rows.age, knots) * rows.given[..., None]
    share = hats / np.maximum(hats.sum(axis=1, keepdims=True), 1.0)  # of a specimen at each knot
    own = np.maximum(share.sum(axis=-1), 1e-9) * rows.given
    height = np.zeros((knots.size, rows.value.shape[-1]))
    flat = hats[rows.given]
    for term in range(height.shape[1]):
        value = rows.value[..., term]
        weight = np.ones(int(rows.given.sum()))
        for _ in range(_ROUNDS):
            left = np.where(rows.given, value - hats @ height[:, term], np.nan)
            level = np.nanmedian(left, axis=1)
            about = (value - level[:, None])[rows.given]
            root = np.sqrt(weight * own[rows.given])
            solved = np.linalg.lstsq(flat * root[:, None], about * root, rcond=None)[0]
            height[:, term] = solved + np.median(level)
            off = np.abs(about - flat @ solved)
            usual = max(float(np.median(off)), 1e-12)
            weight = 1.0 / np.maximum(1.0, off / (_FAR * usual))
    return Mean(knots, height)


def innovations(rows: Rows, left: FloatArray) -> FloatArray:
    """Return how runs differ from the straight line through their neighbours, (differences, terms)."""
    age, given = rows.age, rows.given
    if age.shape[1] < 3:
        return np.empty((0, left.shape[-1]))
    gap_before, gap_after = age[:, 1:-1] - age[:, :-2], age[:, 2:] - age[:, 1:-1]
    whole = gap_before + gap_after
    after = np.where(whole > 0.0, gap_before / np.where(whole > 0.0, whole, 1.0), 0.5)
    off = left[:, 1:-1] - (1 - after)[..., None] * left[:, :-2] - after[..., None] * left[:, 2:]
    size = np.sqrt(1.0 + after**2 + (1.0 - after) ** 2)
    return np.asarray((off / size[..., None])[given[:, 2:]])


def whitening(differences: FloatArray, floor: FloatArray) -> FloatArray:
    """Return what makes numbers independent with differences of size one: (terms, terms), lower, robust."""
    terms = floor.size
    if len(differences) < 2:
        return np.diag(1.0 / np.maximum(floor, 1e-6))
    scale = np.maximum(1.4826 * np.median(np.abs(differences), axis=0), floor)
    unit = differences / scale
    far = (unit**2).mean(axis=1)
    weight = 1.0 / np.maximum(1.0, far / 2.0)
    unit = unit * np.sqrt(weight)[:, None]
    square = unit.T @ unit / weight.sum()
    size = np.sqrt(np.diag(square))
    size = np.where(size > 0.0, size, 1.0)
    both = square / np.outer(size, size)
    both *= len(unit) / (len(unit) + 3.0 * terms)
    np.fill_diagonal(both, 1.0)
    return np.asarray(np.linalg.inv(np.linalg.cholesky(both)) / scale)


@dataclass(frozen=True)
class LeftOut:
    """What its other runs say of each run: distance and variance, (specimens, runs, terms)."""

    off: FloatArray
    variance: FloatArray
    precision: FloatArray  #: (specimens, terms, runs, runs)


def left_out(left: FloatArray, rows: Rows, spreads: Spreads) -> LeftOut:
    """Return it for numbers less their mean, ``left``."""
    precision = np.asarray(
        np.linalg.inv(spreads.covariance(rows.age, rows.variance, rows.given)), dtype=float
    )
    pulled = (precision @ np.moveaxis(left, -1, -2)[..., None])[..., 0]
    own = np.diagonal(precision, axis1=-2, axis2=-1)
    return LeftOut(np.moveaxis(pulled / own, -1, -2), np.moveaxis(1.0 / own, -1, -2), precision)


def log_density(square: FloatArray, logs: FloatArray, terms: int, freedom: float = FREEDOM) -> FloatArray:
    """Student's log density of a squared distance and the sum of the logarithms of the variances."""
    constant = special.gammaln((freedom + terms) / 2) - special.gammaln(freedom / 2)
    constant -= 0.5 * terms * np.log(freedom * np.pi)
    return np.asarray(constant - 0.5 * logs - 0.5 * (freedom + terms) * np.log1p(square / freedom))


def freedom_of(square: FloatArray, terms: int) -> float:
    """Return the degrees of freedom under which squared distances are most probable, the usual one else."""
    gains = [
        float(log_density(square, np.zeros(()), terms, each).sum()) - abs(np.log(each / FREEDOM))
        for each in _FREEDOMS
    ]
    return _FREEDOMS[int(np.argmax(gains))]


def spreads_of(rows: Rows, left: FloatArray, near: Spreads | None = None) -> Spreads:
    """Return the spreads under which runs left out are most probable, by Student's law, of each term.

    ``near`` are those of almost the same runs, from which a short search begins.
    """
    some = np.flatnonzero(rows.given.sum(axis=1) >= 2)
    if not some.size:
        one = np.ones(left.shape[-1])
        return Spreads(3.0 * one, one, one, one)
    some = some[np.unique(np.linspace(0, some.size - 1, min(some.size, _SPECIMENS)).round().astype(int))]
    found = np.array([_spreads_of_term(rows, left, some, term, near) for term in range(left.shape[-1])])
    return Spreads(*np.exp(found.T))


def _spreads_of_term(
    rows: Rows, left: FloatArray, some: IntArray, term: int, near: Spreads | None
) -> FloatArray:
    part = Rows(
        rows.age[some],
        rows.value[some][..., [term]],
        rows.variance[some][..., [term]],
        rows.given[some],
        rows.row,
        rows.column,
    )
    own, given = left[some][..., [term]], rows.given[some]
    levels = np.array([np.median(each[known]) for each, known in zip(own[..., 0], given, strict=True)])
    level = max(1.4826 * float(np.median(np.abs(levels - np.median(levels)))), 1.0) if len(some) > 2 else 3.0
    start = np.log([level, 1.0, 1.0, 0.7])

    def misfit(numbers: FloatArray) -> float:
        spread = Spreads(*(np.array([each]) for each in np.exp(numbers)))
        out = left_out(own, part, spread)
        logs = log_density(out.off[..., 0] ** 2 / out.variance[..., 0], np.log(out.variance[..., 0]), 1)
        return float(-logs[given].sum() + 0.5 * np.sum(((numbers - start) / _KNOWN) ** 2))

    first, sides, most = start, _SIDES, 160
    if near is not None:
        first = np.log([getattr(near, name)[term] for name in ("level", "slope", "walk", "run")])
        sides, most = 0.3 * _SIDES, 60
    simplex = np.vstack([first, first + np.diag(sides)])
    options: Any = {"maxfev": most, "xatol": 0.05, "fatol": 0.05, "initial_simplex": simplex}
    found = optimize.minimize(misfit, first, method="Nelder-Mead", options=options)
    return np.asarray(found.x)
