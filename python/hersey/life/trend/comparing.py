"""Courses compared on the blocks of a record: likelihood over every kind of noise, draws of what they say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import special

from hersey.arrays import FloatArray
from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.life.trend.blocks import Blocks, Noise, blocks_of, noises
from hersey.life.trend.record import Record
from hersey.life.trend.shapes import Shape

#: Values of a parameter that are tried at first, and between those that count.
_COARSE, _FINE = 24, 32
#: Logarithm of the likelihood below the greatest at which a value no longer counts.
_FAINT = 12.0
#: Parts of a record of which temperature is the mean.
PARTS = 10
#: Change of temperature, K, from which on it counts as a possible cause.
WARM = 0.5
#: Parameters of the noise: its variance, how long it lasts and how much of it does.
_OF_NOISE = 3


@dataclass(frozen=True)
class Data:
    """Rows and blocks of a record with their noise, and what else friction depends on."""

    record: Record
    blocks: Blocks
    noise: Noise
    start: float  #: first age, in T
    age: FloatArray  #: of the blocks, in T
    scale: float  #: T
    last_temperature: float  #: K, of the last tenth of the record
    rows: tuple[int, ...] = ()  #: first row after each jump

    @classmethod
    def of(cls, record: Record, cuts: tuple[int, ...] = ()) -> Data:
        """Return the blocks of a record, none of which goes across a cut."""
        kelvin = record.temperature
        blocks = blocks_of(record.age, record.time, record.value, kelvin, cuts)
        scale = float(record.age[-1])
        last = 0.0 if kelvin is None else float(np.array_split(kelvin, PARTS)[-1].mean())
        age = blocks.age / scale
        return cls(record, blocks, noises(blocks), float(age[0]), age, scale, last)

    @property
    def jumps(self) -> tuple[int, ...]:
        """First block after each jump."""
        return tuple(int(each) for each in np.searchsorted(self.blocks.first, self.rows))

    def cut_before(self, block: int) -> tuple[Data, int]:
        """Return the data with a cut where a jump near the begin of a block is likeliest, and its row."""
        ends = (*self.blocks.first.tolist(), self.record.value.size)
        begin, end = ends[block - 1], ends[min(block + 1, len(ends) - 1)]
        values = self.record.value[begin:end]
        count = np.arange(1, values.size)
        left = np.cumsum(values)[:-1]
        right = float(values.sum()) - left
        row = begin + 1 + int(np.argmax(left**2 / count + right**2 / (values.size - count)))
        return replace(Data.of(self.record, (*self.rows, row)), rows=self.rows), row

    def with_jump(self, row: int) -> Data:
        """Return the same with one more jump, before a row that begins a block."""
        return replace(self, rows=tuple(sorted((*self.rows, row))))

    def fixed(self, shape: Shape, warm: bool, at: FloatArray) -> FloatArray:
        """Return the columns beside the course at parameters ``at``: level, first change, jumps."""
        columns = [np.ones(self.age.size)]
        if shape.drifts:
            columns.append((self.age - self.start) / (1.0 - self.start))
        if shape.meets:
            columns.append(np.exp(-(self.age - self.start) * np.exp(-at[1])))
        if warm and self.blocks.temperature is not None:
            columns.append(self.blocks.temperature - self.last_temperature)
        columns += [(np.arange(self.age.size) >= first).astype(float) for first in self.jumps]
        return np.array(columns).T


@dataclass(frozen=True)
class Fitted:
    """A course fitted: likelihoods of each kind of noise and each value of its parameter."""

    shape: Shape
    warm: bool  #: whether temperature is a cause beside age
    at: FloatArray  #: values of the parameter, (shapes, values)
    log_likelihood: FloatArray  #: greatest, by the linear parameters, (kinds, values)
    integrated: FloatArray  #: over the linear parameters, (kinds, values)
    data: Data

    @property
    def best(self) -> tuple[int, int]:
        """The kind of noise and the value that are likeliest."""
        kind, value = np.unravel_index(np.argmax(self.log_likelihood), self.log_likelihood.shape)
        return int(kind), int(value)

    @property
    def greatest(self) -> float:
        """Greatest log-likelihood."""
        return float(self.log_likelihood.max())

    @property
    def parameters(self) -> int:
        """How many numbers were fitted; a jump takes its height and its place."""
        return 1 + self.shape.parameters + self.warm + 2 * len(self.data.jumps) + _OF_NOISE

    @property
    def aicc(self) -> float:
        """AICc: blocks are independent once their noise is made so; infinite if they are too few."""
        k, room = self.parameters, self.data.age.size - self.parameters - 1.0
        return np.inf if room <= 0.0 else -2.0 * self.greatest + 2.0 * k + 2.0 * k * (k + 1.0) / room

    @property
    def rank(self) -> float:
        """AICc by which laws are weighed: one of two parts must be better by more than chance."""
        return self.aicc + EVIDENCE * (self.shape.drifts or self.shape.meets)

    def design(self, value: int) -> FloatArray:
        """Return the columns for a value of the parameter; the course, if any, is the last."""
        columns = self.data.fixed(self.shape, self.warm, self.at[:, value])
        if not self.shape.law.grows:
            return columns
        course = self.shape.course(self.data.age, self.at[:, [value]], self.data.start)
        return np.concatenate([columns, course], axis=1)


def fitted(shape: Shape, data: Data, *, warm: bool = False) -> Fitted:
    """Return a course fitted, its parameter tried finely where it counts."""
    found = _evaluated(shape, data, warm, shape.grid(_COARSE))
    if not shape.varied:
        return found
    high = found.integrated.max(axis=0)
    near = found.at[0, high > high.max() - _FAINT]
    every = np.unique(found.at[0])
    step = every[1] - every[0]
    ends = max(every[0], near.min() - step), min(every[-1], near.max() + step)
    return _evaluated(shape, data, warm, shape.grid(_FINE, ends))


def _evaluated(shape: Shape, data: Data, warm: bool, at: FloatArray) -> Fitted:
    if not shape.meets:
        return _of_one(shape, data, warm, at)
    every = [at[:, at[1] == fast] for fast in np.unique(at[1])]
    parts = [_of_one(shape, data, warm, each) for each in every]
    return replace(
        parts[0],
        at=np.concatenate(every, axis=1),
        log_likelihood=np.concatenate([each.log_likelihood for each in parts], axis=1),
        integrated=np.concatenate([each.integrated for each in parts], axis=1),
    )


def _of_one(shape: Shape, data: Data, warm: bool, at: FloatArray) -> Fitted:
    """A course with one set of columns beside it."""
    fixed, values = data.fixed(shape, warm, at[:, 0]), data.blocks.value
    count, known = values.size, fixed.shape[1]
    course = shape.course(data.age, at, data.start) if shape.law.grows else np.empty((count, 0))
    whole = np.concatenate([fixed, values[:, None], course], axis=1)
    kinds = data.noise.time.size
    squares, logs = np.empty((2, kinds, at.shape[1]))
    for k in range(kinds):
        white = data.noise.whitening[k] @ whole
        q, r = np.linalg.qr(white[:, :known])
        others = white[:, known:] - q @ (q.T @ white[:, known:])
        y, g = others[:, 0], others[:, 1:]
        total, size = float(y @ y), np.sum(g * g, axis=0)
        logs[k] = 2.0 * np.sum(np.log(np.maximum(np.abs(np.diag(r)), 1e-300)))
        squares[k] = total
        if shape.law.grows:
            size = np.maximum(size, 1e-300)
            squares[k] = np.maximum(total - (y @ g) ** 2 / size, 1e-30 * total)
            logs[k] += np.log(size)
    squares = np.maximum(squares, 1e-24 * float(np.sum(values * values)))  # of a record without noise
    free = count - known - int(shape.law.grows)
    half = 0.5 * data.noise.log_determinant[:, None]
    likelihood = -0.5 * count * np.log(squares / count) - half
    return Fitted(shape, warm, at, likelihood, -0.5 * (free * np.log(squares) + logs) - half, data)


def effective_rows(found: Fitted) -> float:
    """Return how many independent rows would determine the mean as well."""
    white = found.data.noise.whitening[found.best[0]].sum(axis=1)
    return float(white @ white)


@dataclass(frozen=True)
class Draws:
    """Equally probable linear parameters of a course with its parameter."""

    fitted: Fitted
    at: FloatArray  #: (shapes, draws)
    linear: FloatArray  #: (draws, columns)

    def curves(self, age: FloatArray, jumped: FloatArray) -> FloatArray:
        """Return friction at ages in T at the last temperature, (draws, ages).

        ``jumped`` holds for each age and jump whether it comes after it, (ages, jumps).
        """
        shape, data = self.fitted.shape, self.fitted.data
        curve = np.repeat(self.linear[:, :1], age.size, axis=1)
        if shape.drifts:
            curve += self.linear[:, 1:2] * (age - data.start) / (1.0 - data.start)
        if shape.meets:
            curve += self.linear[:, 1:2] * np.exp(-(age - data.start) * np.exp(-self.at[1][:, None]))
        curve += self._heights @ jumped.T
        if shape.law.grows:
            curve += self.linear[:, -1:] * shape.course(age, self.at, data.start).T
        return curve

    @property
    def _heights(self) -> FloatArray:
        """Of the jumps, (draws, jumps)."""
        first = 1 + self.fitted.shape.drifts + self.fitted.shape.meets + self.fitted.warm
        return self.linear[:, first : first + len(self.fitted.data.jumps)]

    def per_kelvin(self) -> FloatArray:
        """Return how much friction changes per K, of a law with temperature as a cause, shape (draws,)."""
        return self.linear[:, 1 + self.fitted.shape.drifts + self.fitted.shape.meets]

    def steady(self) -> FloatArray:
        """Return the value at which friction comes to rest, at the last temperature, shape (draws,)."""
        shape = self.fitted.shape
        level = self.linear[:, 0] + self._heights.sum(axis=1)
        if not shape.law.grows:
            return np.asarray(level)
        return np.asarray(level + self.linear[:, -1] * shape.limit(self.at, self.fitted.data.start))


def draws_of(found: Fitted, count: int, random: np.random.Generator) -> Draws:
    """Return equally probable draws over noise, parameter and linear parameters."""
    data, values = found.data, found.data.blocks.value
    weights = np.exp(found.integrated - special.logsumexp(found.integrated))
    places = (np.arange(count) + random.random()) / count
    cells = np.searchsorted(np.cumsum(weights.ravel()), places).clip(max=weights.size - 1)
    at = np.empty((found.at.shape[0], count))
    linear: list[FloatArray] = []
    chosen, first, many = np.unique(cells, return_index=True, return_counts=True)
    for cell, begin, number in zip(chosen, first, many, strict=True):
        kind, value = divmod(int(cell), found.at.shape[1])
        at[:, begin : begin + number] = found.at[:, [value]]
        white = data.noise.whitening[kind] @ np.column_stack([found.design(value), values])
        q, r = np.linalg.qr(white[:, :-1])
        middle = np.linalg.solve(r, q.T @ white[:, -1])
        off = white[:, -1] - white[:, :-1] @ middle
        free = max(values.size - r.shape[0], 1)
        spread = np.sqrt(float(off @ off) / random.chisquare(free, number))
        normal = random.standard_normal((r.shape[0], number))
        linear.append((middle[:, None] + np.linalg.solve(r, normal) * spread).T)
    return Draws(found, at, np.concatenate(linear))


def jump_gains(found: Fitted, candidates: Sequence[int]) -> FloatArray:
    """Return by how much a jump before each of these blocks would raise twice the log-likelihood.

    The course stays that of the likeliest parameter; the noise may be another one.
    """
    data = found.data
    count = data.age.size
    steps = (np.arange(count)[:, None] >= np.asarray(candidates)).astype(float)
    whole = np.column_stack([found.design(found.best[1]), data.blocks.value, steps])
    known = whole.shape[1] - len(candidates) - 1
    gains = np.full(len(candidates), -np.inf)
    for k in range(data.noise.time.size):
        white = data.noise.whitening[k] @ whole
        q, _ = np.linalg.qr(white[:, :known])
        others = white[:, known:] - q @ (q.T @ white[:, known:])
        y, g = others[:, 0], others[:, 1:]
        total, size = float(y @ y), np.maximum(np.sum(g * g, axis=0), 1e-300)
        squares = np.maximum(total - (y @ g) ** 2 / size, 1e-12 * total)
        half = 0.5 * data.noise.log_determinant[k]
        gains = np.maximum(gains, -count * np.log(squares / count) - 2.0 * half)
    return np.asarray(gains - 2.0 * found.greatest)
