"""A record as means of blocks, short at its begin, and the correlation of their noise.

The noise of rows is that of sensors, independent from row to row, and one that wanders and forgets what it
was within a correlation time (a process of Ornstein and Uhlenbeck); means of both over blocks of any length
are known exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray, IntArray

#: Blocks at the most, and how much shorter the first is than they are on average.
_BLOCKS, _FIRST = 150, 0.2
#: Steps without a row that end a block, and how many such gaps do at the most.
_GAP, _GAPS = 5.0, 50
#: Longest correlation time, as a share of the duration, and how many are tried.
_LONGEST, _TIMES = 1.0, 10
#: Least share of the greatest variance in any direction.
_LEAST = 1e-6
#: Half widths in correlation times from which on neighbours count as independent.
_FAR = 60.0
#: Ratios of the variances of what wanders and of a row's own noise.
_RATIOS = (0.0, 0.003, 0.03, 0.3, 3.0, 300.0)


@dataclass(frozen=True)
class Blocks:
    """Means of blocks: arrays of shape (blocks,)."""

    first: IntArray  #: first row
    age: FloatArray  #: mean age
    time: FloatArray  #: mean time, s
    width: FloatArray  #: duration, s
    rows: FloatArray
    value: FloatArray
    temperature: FloatArray | None

    @property
    def duration(self) -> float:
        """From the begin of the first block to the end of the last, s."""
        return float(self.time[-1] - self.time[0] + 0.5 * (self.width[0] + self.width[-1]))


def blocks_of(
    age: FloatArray,
    time: FloatArray,
    value: FloatArray,
    temperature: FloatArray | None,
    cuts: tuple[int, ...] = (),
) -> Blocks:
    """Return the means of blocks of rows, ascending in time; each row is one where they are few.

    No block goes across a gap, or across the first row of ``cuts``.
    """
    rows = value.size
    count = min(rows, _BLOCKS)
    u = np.linspace(0.0, 1.0, count + 1)
    ends = np.round(rows * (_FIRST * u + (1.0 - _FIRST) * u * u)).astype(int)
    apart = np.diff(time)
    step = float(np.median(apart))
    gaps = np.flatnonzero(apart > _GAP * step)
    longest = gaps[np.argsort(-apart[gaps], kind="stable")[:_GAPS]]
    ends = np.union1d(np.union1d(ends, longest + 1), np.array(cuts, dtype=int))
    number = np.diff(ends).astype(float)

    def mean(values: FloatArray) -> FloatArray:
        return np.asarray(np.add.reduceat(values, ends[:-1]) / number)

    width = time[ends[1:] - 1] - time[ends[:-1]] + step
    return Blocks(
        ends[:-1],
        mean(age),
        mean(time),
        width,
        number,
        mean(value),
        None if temperature is None else mean(temperature),
    )


@dataclass(frozen=True)
class Noise:
    """Kinds of noise: what makes the blocks independent, (kinds, blocks, blocks), per variance of a row."""

    time: FloatArray  #: correlation time, s, shape (kinds,)
    ratio: FloatArray
    whitening: FloatArray
    log_determinant: FloatArray  #: of the covariance, shape (kinds,)

    def some(self, kept: FloatArray) -> Noise:
        """Return some of the kinds."""
        return Noise(self.time[kept], self.ratio[kept], self.whitening[kept], self.log_determinant[kept])


def noises(blocks: Blocks) -> Noise:
    """Return the kinds of noise that are tried."""
    step = float(np.min(blocks.width / blocks.rows))
    longest = max(_LONGEST * blocks.duration, 2.0 * step)
    kinds = [(step, 0.0)]
    kinds += [(t, r) for t in np.geomspace(step, longest, _TIMES) for r in _RATIOS[1:]]
    times, ratios = np.array(kinds).T
    whitening = np.empty((times.size, blocks.age.size, blocks.age.size))
    logs = np.empty(times.size)
    for k, (time, ratio) in enumerate(kinds):
        factor = _factor(_covariance(blocks, time, ratio))
        whitening[k] = np.linalg.inv(factor)
        logs[k] = 2.0 * np.sum(np.log(np.diag(factor)))
    return Noise(times, ratios, whitening, logs)


def _factor(covariance: FloatArray) -> FloatArray:
    """The triangle of a covariance, also where rows at uneven times make it slightly wrong."""
    try:
        return np.asarray(np.linalg.cholesky(covariance))
    except np.linalg.LinAlgError:
        values, vectors = np.linalg.eigh(covariance)
        least = _LEAST * float(values[-1])
        return np.asarray(np.linalg.cholesky((vectors * np.maximum(values, least)) @ vectors.T))


def _covariance(blocks: Blocks, time: float, ratio: float) -> FloatArray:
    """The covariance of means, where a row has the variance 1."""
    own = np.diag(1.0 / blocks.rows) / (1.0 + ratio)
    if not ratio:
        return own
    step = blocks.width / blocks.rows / time
    half = np.minimum(0.5 * blocks.rows * step, _FAR)
    spread = np.sinh(half) / (blocks.rows * np.sinh(np.minimum(0.5 * step, _FAR)))
    apart = np.abs(blocks.time[:, None] - blocks.time) / time
    covariance = np.exp(-np.minimum(apart, 5.0 * _FAR)) * spread[:, None] * spread
    kept = np.exp(-step)
    left = -np.expm1(-step)
    lost = -np.expm1(-blocks.rows * step)
    within = ((1.0 + kept) / left - 2.0 * kept * lost / (blocks.rows * left**2)) / blocks.rows
    np.fill_diagonal(covariance, within)
    return np.asarray(own + covariance * (ratio / (1.0 + ratio)))
