"""How much better each slip explains the runs: the gain in log probability if it is undone.

A slip of one run or of a pair is judged by what all other runs of its specimen say, a slip of a whole
specimen by its
runs one after the other. A free factor or shape costs what its prior says (Laplace's approximation).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.diagnostics.compared import Compared
from hersey.life.diagnostics.trends import Rows, left_out, log_density

#: Kinds of slips: what was done, in two or three words.
EXCHANGED = "logs exchanged"
REORDERED = "ages exchanged"
AGES = "ages scaled"
AGE = "age scaled"
TORQUE = "torque scaled"
TORQUES = "torques scaled"
MACHINE = "another machine"
LUBRICANT = "another lubricant or machine"
SAME = "same log"
#: Factors by which ages go wrong: orders of magnitude, and hours, minutes, seconds and days taken for each
#: other.
_AGES = (10.0, 100.0, 1000.0, 1e6, 24.0, 60.0, 1440.0, 3600.0, 86400.0)
#: Factors by which torques go wrong: N m, N cm, N mm and uN m; ozf in, lbf in, lbf ft, kgf cm in each of
#: them.
_TORQUES = (
    10.0,
    100.0,
    1000.0,
    1e6,
    7.06155,
    141.612,
    8.85075,
    11.2985,
    112.985,
    12.0,
    16.0,
    9.80665,
    98.0665,
)
#: Others, which are less usual: the gain that they lack.
_FREE, _UNUSUAL = np.array([float(f"{each:.2g}") for each in np.geomspace(8.0, 2e5, 40)]), 2.0
AGE_FACTORS = tuple(factor for each in _AGES for factor in (each, 1.0 / each))
TORQUE_FACTORS = tuple(factor for each in _TORQUES for factor in (each, 1.0 / each))
#: Deviations of level and of the other numbers, in ln torque, of a run of another machine or lubricant.
_LEVEL, _SHAPES = 0.5, (0.2, 0.2, 0.08, 0.08, 0.08)
#: Runs, the farthest off, that are paired, and those whose own age is tried.
_PAIRED, _TRIED = 300, 24
#: Scatter of last ages of specimens, and of their levels at least, logarithms.
_OF_LAST, _OF_LEVELS = 0.4, 0.15
#: Degrees of freedom of their law.
_FREEDOM = 4.0
#: Gain of an age that is that of other specimens once it is corrected, of all of a specimen at most, and how
#: much more the range of ages says of a specimen that was seen several times.
_COINCIDES, _MOST, _SEEN = 2.0, 6.0, 1.5
#: Gain per logarithm by which two ages of a specimen lie closer together than half the usual gap, if they are
#: small: a new specimen is rarely measured twice in so short a time, an old one sometimes is. And how many
#: times closer the ages of an old one must lie before they count.
_CROWDED, _CLOSER, _FAR_CLOSER = 3.0, 2.0, 10.0
#: Share of ages that follow no schedule, and how far those that do lie from it, in the usual gap of two.
_UNPLANNED, _ABOUT = 0.05, 0.5
#: The usual slip in the age of one run, and the gain that others lack: thousands typed as units.
_THOUSAND, _LESS_USUAL = 1000.0, 4.0
#: Ages closer than this, in the usual last one, are the same.
_SAME_AGE = 1e-9


@dataclass(frozen=True)
class Slip:
    """A slip: ``runs`` are places, ``factor`` is what multiplied their ages or torque."""

    kind: str
    runs: tuple[int, ...]
    gain: float
    factor: float = 1.0


def alone(at: Compared) -> list[Slip]:
    """Return for each run the slips of it alone: torque unit, another machine or lubricant."""
    logs = np.log(at.variance).sum(axis=1)
    inverse = 1.0 / at.variance

    def moved(directions: FloatArray, deviations: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gains and likeliest amounts along directions, (terms, directions), with deviations of priors."""
        pulled = directions.T * inverse[:, None, :]
        inner = pulled @ directions + np.diag(1.0 / deviations**2)
        amount = np.linalg.solve(inner, (pulled @ at.off[..., None]))[..., 0]
        square = ((at.off - amount @ directions.T) ** 2 * inverse).sum(axis=1)
        cost = 0.5 * ((amount / deviations) ** 2).sum(axis=1)
        cost += 0.5 * (np.linalg.slogdet(inner)[1] + 2.0 * np.log(deviations).sum())
        return at.density(square, logs) - cost - at.logs, np.asarray(amount, dtype=float)

    machine, level = moved(at.whiten[:, :1], np.array([_LEVEL]))
    deviations = np.array([_LEVEL, *_SHAPES])[: at.terms]
    lubricant, _ = moved(at.whiten, deviations)
    steps = np.log(np.array(TORQUE_FACTORS))
    shifted = at.off[:, None] - steps[:, None] * at.whiten[:, 0]
    unit = at.density((shifted**2 * inverse[:, None]).sum(axis=-1), logs[:, None])
    unit += -at.logs[:, None] - np.log(steps.size)
    which = unit.argmax(axis=1)
    found = []
    for i in range(logs.size):
        found += [
            Slip(MACHINE, (i,), float(machine[i]), float(np.exp(level[i, 0]))),
            Slip(LUBRICANT, (i,), float(lubricant[i])),
            Slip(TORQUE, (i,), float(unit[i, which[i]]), TORQUE_FACTORS[which[i]]),
        ]
    return found


def exchanged(at: Compared, near: float) -> list[Slip]:
    """Return exchanges of the logs of two specimens at ages no farther than ``near`` apart.

    Logs of one age are likelier, then those of one place in the order of their specimens.
    """
    order = at.rows.column
    far = np.sort(np.argsort(-at.squares, kind="stable")[:_PAIRED])
    first, second = (far[each] for each in np.triu_indices(far.size, 1))
    age = at.rows.flat(at.rows.age)
    apart = np.abs(age[first] - age[second])
    keep = at.rows.row[first] != at.rows.row[second]
    keep &= apart <= np.where(order[first] == order[second], near, 0.5 * near)
    first, second, apart = first[keep], second[keep], apart[keep]
    if not first.size:
        return []
    value = at.rows.flat(at.rows.value)
    expected = value - at.off
    logs = np.log(at.variance).sum(axis=1)

    def as_if(log: IntArray, run: IntArray) -> FloatArray:
        square = ((value[log] - expected[run]) ** 2 / at.variance[run]).sum(axis=1)
        return at.density(square, logs[run])

    gain = as_if(second, first) + as_if(first, second) - at.logs[first] - at.logs[second]
    gain -= np.where(apart <= 1e-9, 0.0, np.where(order[first] == order[second], 1.0, 3.0))
    return [
        Slip(EXCHANGED, tuple(pair), g)
        for *pair, g in zip(first.tolist(), second.tolist(), gain.tolist(), strict=True)
    ]


def reordered(at: Compared) -> list[Slip]:
    """Return exchanges of two logs of one specimen."""
    rows, found = at.rows, []
    place = np.full(rows.given.shape, -1)
    place[rows.row, rows.column] = np.arange(rows.row.size)
    pulled = (at.out.precision @ np.moveaxis(at.left, -1, -2)[..., None])[..., 0]
    for i in range(rows.given.shape[1]):
        for j in range(i):
            both = rows.given[:, i] & rows.given[:, j]
            if not both.any():
                continue
            precision = at.out.precision[both][:, :, [[i, i], [j, j]], [[i, j], [i, j]]]
            off = np.linalg.solve(precision, pulled[both][:, :, [i, j]][..., None])[..., 0]
            change = (rows.value[both, j] - rows.value[both, i])[..., None] * np.array([1.0, -1.0])
            logs = -np.linalg.slogdet(precision)[1].sum(axis=1)
            squares = [np.einsum("spi,spij,spj->s", v, precision, v) for v in (off, off + change)]
            now, then = (at.density(square, logs, 2) for square in squares)
            pairs = zip(place[both, j].tolist(), place[both, i].tolist(), (then - now).tolist(), strict=True)
            found += [Slip(REORDERED, (a, b), gain) for a, b, gain in pairs]
    return found


def ages_scaled(at: Compared) -> list[Slip]:
    """Return for each specimen the likeliest factor by which its ages are wrong."""
    rows = at.rows
    if len(rows.age) < 3:
        return []
    last = np.where(rows.given, rows.age, 0.0).max(axis=1)
    now = _sequence(at, 1.0)
    factors = [*AGE_FACTORS, *_FREE.tolist(), *(1.0 / _FREE).tolist()]
    of_runs = np.stack([_sequence(at, 1.0 / k) - now for k in factors], axis=2)
    # One run, of another machine or lubricant, is no reason to doubt the ages of all.
    gains = of_runs.sum(axis=1) - np.maximum(of_runs.max(axis=1), 0.0)
    ages = SharedAges.of(rows)
    gains += np.stack([_schedule(at, last, ages, k) for k in factors], axis=1)
    gains -= np.log(len(AGE_FACTORS)) + np.where(np.arange(len(factors)) < len(AGE_FACTORS), 0.0, _UNUSUAL)
    gains[last <= 0.0] = -np.inf
    found = []
    for i, k in enumerate(gains.argmax(axis=1).tolist()):
        runs = tuple(np.flatnonzero(rows.row == i).tolist())
        found.append(Slip(AGES, runs, float(gains[i, k]), factors[k]))
    return found


def _sequence(at: Compared, times: float) -> FloatArray:
    """The log density of each run under those before it, at so many times its ages: (specimens, runs)."""
    rows = at.rows
    age = rows.age * times
    left = np.moveaxis(rows.value - at.mean.at(age), -1, -2)
    root = np.linalg.cholesky(at.spreads.covariance(age, rows.variance, rows.given))
    white = np.linalg.solve(root, left[..., None])[..., 0]
    logs = 2.0 * np.log(np.diagonal(root, axis1=-2, axis2=-1)).sum(axis=1)
    return np.asarray(at.density((white**2).sum(axis=1), logs) * rows.given)


def _log_student(off: FloatArray, scale: float) -> FloatArray:
    """Log density of deviations of a scale by a law with heavy tails."""
    return log_density((off / scale) ** 2, np.asarray(2.0 * np.log(scale)), 1, _FREEDOM)


def _schedule(at: Compared, last: FloatArray, ages: SharedAges, factor: float) -> FloatArray:
    """What the ages of the others say of a factor: the usual last age, and ages that are theirs."""
    usual = (
        np.array([np.median(np.delete(last, i)) for i in range(last.size)])
        if last.size < 200
        else np.median(last)
    )
    off = np.log(np.maximum(last, 1e-12) / np.maximum(usual, 1e-12))
    gain = _log_student(off - np.log(factor), _OF_LAST) - _log_student(off, _OF_LAST)
    # A specimen seen several times in a small part of the usual age is no new one.
    seen = np.count_nonzero(at.rows.given & (at.rows.age > 0.0), axis=1)
    gain = gain * np.clip(seen / 2.0, 1.0, _SEEN)
    return np.asarray(gain + np.minimum(_COINCIDES * (ages.count(factor) - ages.count(1.0)), _MOST))


@dataclass(frozen=True)
class SharedAges:
    """Ages to six digits as whole numbers: which specimens have each, and how many do."""

    row: IntArray  #: specimen of each run whose age is not 0
    age: FloatArray
    specimens: int
    pairs: IntArray  #: specimens with their ages, ascending, each once
    ages: IntArray  #: all ages, ascending
    had_by: IntArray  #: how many specimens have each

    @classmethod
    def of(cls, rows: Rows) -> SharedAges:
        """Return those of runs."""
        age, specimens = rows.flat(rows.age), len(rows.age)
        some = age > 0.0
        pairs = np.unique(_to_six_digits(age[some]) * specimens + rows.row[some])
        ages, had_by = np.unique(pairs // specimens, return_counts=True)
        return cls(rows.row[some], age[some], specimens, pairs, ages, had_by)

    def count(self, factor: float) -> FloatArray:
        """Return how many ages of each specimen, over a factor, are also those of others."""
        pairs = np.unique(_to_six_digits(self.age / factor) * self.specimens + self.row)
        ages, row = np.divmod(pairs, self.specimens)
        at = np.minimum(np.searchsorted(self.ages, ages), max(self.ages.size - 1, 0))
        others = np.where(self.ages[at] == ages, self.had_by[at], 0) if self.ages.size else np.zeros(0)
        others = others - np.isin(pairs, self.pairs)
        return np.asarray(np.bincount(row, others >= 1, self.specimens), dtype=float)


def _to_six_digits(age: FloatArray) -> IntArray:
    """Ages, all above 0, as digits and exponent in one whole number."""
    exponent = np.floor(np.log10(age))
    digits = np.rint(age * 10.0 ** (5.0 - exponent))
    exponent, digits = np.where(digits == 1e6, exponent + 1.0, exponent), np.where(digits == 1e6, 1e5, digits)
    return np.asarray((exponent + 400.0) * 1e6 + digits, dtype=np.int64)


def age_scaled(at: Compared) -> list[Slip]:
    """Return for runs far off the likeliest factor by which their own age is wrong."""
    rows, age = at.rows, at.rows.flat(at.rows.age)
    if len(rows.age) < 2:
        return []
    odd = (age > 2.0) | (_nearest(rows)[rows.row, rows.column] < _least_gap(rows) / _FAR_CLOSER)
    far = np.argsort(-np.where(odd, np.inf, at.squares), kind="stable")[:_TRIED]
    found = []
    for i in far[age[far] > 0.0].tolist():
        row, column = rows.row[i], rows.column[i]
        number = len(AGE_FACTORS)
        ages = np.repeat(rows.age[[row]], number, axis=0)
        ages[:, column] /= AGE_FACTORS
        tried = replace(
            rows,
            age=ages,
            value=np.repeat(rows.value[[row]], number, axis=0),
            variance=np.repeat(rows.variance[[row]], number, axis=0),
            given=np.repeat(rows.given[[row]], number, axis=0),
        )
        out = left_out(tried.value - at.mean.at(ages), tried, at.spreads)
        off, variance = out.off[:, column], out.variance[:, column]
        gain = at.density((off**2 / variance).sum(axis=1), np.log(variance).sum(axis=1)) - at.logs[i]
        others = np.delete(rows.age[row][rows.given[row]], column)
        gain += _within(ages[:, column], others, rows, row) - _within(age[[i]], others, rows, row)
        gain -= np.where(np.isclose(np.abs(np.log(AGE_FACTORS)), np.log(_THOUSAND)), 0.0, _LESS_USUAL)
        best = int(gain.argmax())
        found.append(Slip(AGE, (i,), float(gain[best] - np.log(number)), AGE_FACTORS[best]))
    return found


def _within(age: FloatArray, others: FloatArray, rows: Rows, row: int) -> FloatArray:
    """What the schedule says of an age: whether others have it, and where it lies among its own."""
    everywhere = {
        float(f"{a:.6g}")
        for k in range(len(rows.age))
        if k != row
        for a in rows.age[k][rows.given[k]].tolist()
    }
    shared = np.array([float(f"{a:.6g}") in everywhere for a in age.tolist()])
    again = np.array([np.any(np.abs(others - a) < 1e-9) for a in age.tolist()])
    top = max(float(others.max(initial=0.0)), 1e-12)
    late = np.log(np.maximum(age, 1e-12) / top)
    off = _log_student(late, _OF_LAST) - _log_student(np.zeros(()), _OF_LAST)
    out = np.where(age > 1.5 * top, off, 0.0)
    return (
        _COINCIDES * shared
        - 3.0 * again
        + out
        + _scheduled(age, rows, row)
        - _CROWDED * _crowding(age, others, rows, row)
    )


def _scheduled(age: FloatArray, rows: Rows, row: int) -> FloatArray:
    """How dense the ages of the other specimens are about an age, a logarithm."""
    other = np.arange(len(rows.age)) != row
    ages = rows.age[other][rows.given[other]]
    scale = _ABOUT * (_least_gap(rows, other) or 1.0)
    near = np.exp(-0.5 * ((age[:, None] - ages) / scale) ** 2).mean(axis=1) / (scale * np.sqrt(2.0 * np.pi))
    return np.asarray(np.log((1.0 - _UNPLANNED) * near + _UNPLANNED / max(float(ages.max()), scale)))


def _crowding(age: FloatArray, others: FloatArray, rows: Rows, row: int) -> FloatArray:
    """How much closer to another of its specimen a small age lies than half of what those of others do.

    Where the others of its specimen lie as close, all of its ages are small, and this one is as good as they.
    """
    if not others.size:
        return np.zeros(age.shape)
    near = np.abs(age[:, None] - others).min(axis=1)
    apart = np.diff(np.sort(others))
    own = float(apart[apart > _SAME_AGE].min(initial=np.inf))
    usual = min(_least_gap(rows, np.arange(len(rows.age)) != row), own)
    closer = np.log(np.maximum(usual / (_CLOSER * np.maximum(near, _SAME_AGE)), 1.0))
    return np.asarray(np.where(age < usual, closer, 0.0))


def _nearest(rows: Rows) -> FloatArray:
    """How near each run lies to another of its specimen that is not of the same age, (specimens, runs)."""
    apart = np.abs(rows.age[:, :, None] - rows.age[:, None, :])
    both = rows.given[:, :, None] & rows.given[:, None, :] & (apart > _SAME_AGE)
    return np.asarray(np.where(both, apart, np.inf).min(axis=2))


def _least_gap(rows: Rows, of: BoolArray | None = None) -> float:
    """The least that runs of one specimen lie apart, the median of specimens; 0 where none has two ages."""
    least = np.sort(_nearest(rows)[slice(None) if of is None else of].min(axis=1))
    known = least[np.isfinite(least)]
    return float(known[len(known) // 2]) if known.size else 0.0


def torques_scaled(at: Compared) -> list[Slip]:
    """Return for each specimen the likeliest factor by which the torque of all its runs is wrong."""
    rows = at.rows
    if len(rows.age) < 3:
        return []
    raw = np.linalg.solve(at.whiten, np.moveaxis(at.left, -1, 0).reshape(at.terms, -1))[0].reshape(
        rows.given.shape
    )
    level = np.array([np.median(each[known]) for each, known in zip(raw, rows.given, strict=True)])
    steps = np.log(np.array(TORQUE_FACTORS))
    found = []
    for i in range(level.size):
        others = np.delete(level, i)
        middle = np.median(others)
        scale = max(1.4826 * float(np.median(np.abs(others - middle))), _OF_LEVELS)
        gain = _log_student(level[i] - middle - steps, scale) - _log_student(level[i] - middle, scale)
        gain -= np.log(steps.size)
        best = int(gain.argmax())
        runs = tuple(np.flatnonzero(rows.row == i).tolist())
        found.append(Slip(TORQUES, runs, float(gain[best]), TORQUE_FACTORS[best]))
    return found
