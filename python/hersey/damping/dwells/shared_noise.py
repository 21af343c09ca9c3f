"""The noise of all dwells of a log together: one shape, so that noise as slow as a dwell is seen.

A dwell a few correlation times long says almost nothing of its slow noise: its mean follows it. Many dwells
together do. Each is taken apart into cosines (about its mean, half a period and more), whose powers over all
dwells give one spectrum: a mixture of noise without memory and of noise that forgets exponentially, with
times from a sample to a quarter of a dwell (Whittle's likelihood, Ark. Mat. 2 (1953) 423). Its value at no
frequency is the variance of the mean. Each dwell has a level of its own; that of its slow part is drawn
towards the common one as far as the dwells agree (Smyth, Stat. Appl. Genet. Mol. Biol. 3 (2004) 3).
Where they do not agree at all there is no common shape, and each dwell is left to itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft, optimize, special

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.dwells.noise import thinned

#: Fewest dwells that have a shape in common.
FEWEST = 5
#: Dwells, spread over the log, from which the shape is taken at most.
MOST = 400
#: Cosines taken singly; the rest in bands.
SINGLE = 16
#: Factor by which each band is wider than the one before.
BAND = 1.3
#: Cosines as which a band counts at most.
BAND_COUNT = 16.0
#: Slowest cosines, whose power is that of the slow part of a dwell.
SLOW = 6
#: Powers beyond so many times their expectation are ripple, not noise; the first few are never excluded.
RIPPLE, NEVER_RIPPLE = 16.0, 3
#: Dwells do not share a shape if their slow parts scatter by so many standard errors more than chance.
DISAGREE = 5.0
#: Longest time of the mixture, as a share of a dwell: of slower noise a dwell shows only the steepest part.
LONGEST_TIME = 0.22
#: Steps of the search for the mixture.
STEPS = 200
#: Those after ripple was excluded.
MORE_STEPS = 60
#: Factor from one time of the mixture to the next.
TIME_STEP = 2.0


@dataclass(frozen=True)
class Powers:
    """A dwell in cosines: power of each band per frequency, and how many cosines it counts as.

    ``power`` is (N m)^2 s, ``order`` the mean order of a band (1: half a period in the dwell), both of shape
    (bands,); ``duration`` and ``interval`` are s.
    """

    order: FloatArray
    power: FloatArray
    count: FloatArray
    duration: float
    interval: float

    @classmethod
    def of(cls, values: FloatArray, interval: float) -> Powers:
        """Return the powers of a series about its mean, sampled every ``interval`` s."""
        series = thinned(values)
        step = interval * (values.size // series.size)
        power = step * np.asarray(fft.dct(series - series.mean(), norm="ortho"))[1:] ** 2
        edges = _edges(power.size)
        width = np.diff(np.append(edges, power.size))
        order = edges + 1.0 + (width - 1.0) / 2.0
        banded = np.add.reduceat(power, edges) / width
        return cls(order, banded, np.minimum(width, BAND_COUNT), step * series.size, interval)


def _edges(size: int) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """First cosine of each band."""
    edges = list(range(min(SINGLE, size)))
    edge = float(SINGLE)
    while edge < size:
        edges.append(int(edge))
        edge = max(edge + 1.0, edge * BAND)
    return np.array(edges, dtype=np.intp)


def cosine_power(order: FloatArray, share: FloatArray) -> FloatArray:
    """Return the power of a cosine of a dwell in noise of unit variance, over its correlation time.

    ``share`` is that time as a share of the dwell; order 0 is the mean itself. 2 where the share is small.
    """
    a = np.pi * order
    rate = 1.0 / share - 1j * a
    faded = (1.0 - np.exp(-rate)) / rate
    level = ((1.0 - faded) / rate).real
    with np.errstate(divide="ignore", invalid="ignore"):
        edge = np.where(order > 0, faded.imag / a, 0.0)
    return np.asarray(2.0 * (level - edge) / share)


@dataclass(frozen=True)
class SharedNoise:
    """The spectrum that dwells share: shares of noise without memory (first) and of each time, s."""

    times: FloatArray
    shares: FloatArray
    prior: float  #: cosines that the common level of the slow part counts as; infinite where dwells agree
    level: float  #: of the slow part beside the whole, common to all dwells

    def expected(self, order: FloatArray, duration: float) -> FloatArray:
        """Return the power of cosines of a dwell whose noise has the level 1."""
        return np.asarray(_basis(order, duration, self.times) @ self.shares)

    def mean_error(self, powers: Powers, duration: float | None = None) -> float:
        """Return the standard error of the mean of a dwell, N m, or of so many seconds beside it."""
        lasting = duration or powers.duration
        at_rest = float(self.expected(np.zeros(1), lasting)[0])
        return float(np.sqrt(self._slow_level(powers, 0) * at_rest / lasting))

    def rise_error(self, powers: Powers) -> float:
        """Return the standard error of the rise of a line over a dwell, N m.

        A line is cosines of odd order, falling as its square; the dwell's own first one may be that of a
        drift, and says nothing here.
        """
        odd = np.arange(1.0, 12.0, 2.0)
        sum_of_line = float(np.sum(self.expected(odd, powers.duration) / odd**4))
        variance = 1152.0 / np.pi**4 * self._slow_level(powers, 1) * sum_of_line / powers.duration
        return float(np.sqrt(variance))

    def _slow_level(self, powers: Powers, first: int) -> float:
        """Level of the slow part of a dwell, its own and the common one each as far as it is known."""
        if not np.any(powers.power):  # a drive that stands may read one number all the time
            return 0.0
        expected = self.expected(powers.order, powers.duration)
        whole = _level(powers, expected)
        common = whole * self.level
        if not np.isfinite(self.prior):
            return common
        own = float(np.mean((powers.power / expected)[first:SLOW]))
        count = SLOW - first
        return (self.prior * common + count * own) / (self.prior + count)


def _basis(order: FloatArray, duration: float, times: FloatArray) -> FloatArray:
    """Powers of noise without memory, and of each time, shape (orders, 1 + times)."""
    slow = times[None, :] / 2.0 * cosine_power(order[:, None], times[None, :] / duration)
    return np.column_stack([np.ones(order.size), slow / times[-1]])


def _level(powers: Powers, expected: FloatArray) -> float:
    """Level of a dwell beside what is expected of noise of the level 1, its ripple excluded."""
    ratio, weight = powers.power / expected, powers.count
    for _ in range(3):
        level = float(np.sum(weight * ratio) / np.sum(weight))
        weight = np.where(_is_ripple(ratio / level, powers.order, powers.count), 0.0, powers.count)
    return float(np.sum(weight * ratio) / np.sum(weight))


def _is_ripple(ratio: FloatArray, order: FloatArray, count: FloatArray) -> BoolArray:
    """Whether powers are so far beyond their expectation that they are ripple."""
    return np.asarray((ratio > 1.0 + (RIPPLE - 1.0) / np.sqrt(count)) & (order > NEVER_RIPPLE))


def shared_noise(dwells: list[Powers]) -> SharedNoise | None:
    """Return the noise that dwells share, or None if they are too few, without noise, or share none."""
    noisy = [p for p in dwells if float(np.sum(p.power)) > 0.0]
    if len(noisy) < FEWEST:
        return None
    chosen = [noisy[i] for i in np.linspace(0, len(noisy) - 1, min(MOST, len(noisy))).astype(int)]
    shortest = min(p.interval for p in chosen)
    longest = LONGEST_TIME * float(np.median([p.duration for p in chosen]))
    steps = max(0, int(np.log(max(longest / shortest, 1.0)) / np.log(TIME_STEP)))
    times = longest / TIME_STEP ** np.arange(steps + 1.0)
    pooled = _Pooled(chosen, times)
    return pooled.fitted()


class _Pooled:
    """Bands of all dwells, one after another."""

    def __init__(self, dwells: list[Powers], times: FloatArray) -> None:
        self.times = times
        self.basis = np.concatenate([_basis(p.order, p.duration, times) for p in dwells])
        self.power = np.concatenate([p.power for p in dwells])
        self.count = np.concatenate([p.count for p in dwells])
        self.order = np.concatenate([p.order for p in dwells])
        self.dwell = np.repeat(np.arange(len(dwells)), [p.order.size for p in dwells])
        self.dwells = len(dwells)

    def fitted(self) -> SharedNoise | None:
        """The mixture, ripple excluded as soon as it is seen; None if dwells differ in more than level."""
        shares = np.ones(self.basis.shape[1])
        weight = self.count.copy()
        for steps in (STEPS, MORE_STEPS):
            shares = self._mixture(shares, weight, steps)
            ratio = self._ratio(shares, weight)
            weight = self._without_ripple(_is_ripple(ratio, self.order, self.count))
        shares = self._mixture(shares, weight, MORE_STEPS)
        slow = self._slow(shares, weight)
        if _disagree(slow, SLOW):
            return None
        prior, level = _agreement(slow, SLOW)
        return SharedNoise(self.times, shares, prior, level)

    def _without_ripple(self, ripple: BoolArray) -> FloatArray:
        """Counts of the bands, 0 for ripple; a dwell that holds nothing else keeps it.

        So it is with readings that flip once between two steps of their sensor.
        """
        weight = np.where(ripple, 0.0, self.count)
        left = np.bincount(self.dwell, weight * self.power, self.dwells)
        return np.where((left > 0.0)[self.dwell], weight, self.count)

    def _levels(self, expected: FloatArray, weight: FloatArray) -> FloatArray:
        """Level of each dwell, at its bands."""
        total = np.bincount(self.dwell, weight * self.power / expected, self.dwells)
        return np.asarray((total / np.bincount(self.dwell, weight, self.dwells))[self.dwell])

    def _ratio(self, shares: FloatArray, weight: FloatArray) -> FloatArray:
        expected = self.basis @ shares
        return np.asarray(self.power / (self._levels(expected, weight) * expected))

    def _slow(self, shares: FloatArray, weight: FloatArray) -> FloatArray:
        """Level of the slow part of each dwell beside its whole."""
        slow = self.order <= SLOW
        ratio = self._ratio(shares, weight)
        return np.asarray(np.bincount(self.dwell[slow], ratio[slow], self.dwells) / SLOW)

    def _mixture(self, shares: FloatArray, weight: FloatArray, steps: int) -> FloatArray:
        """Shares of the largest likelihood: steps that keep them positive."""
        for _ in range(steps):
            expected = self.basis @ shares
            ratio = self.power / (self._levels(expected, weight) * expected)
            gain = self.basis.T @ (weight * ratio / expected) / (self.basis.T @ (weight / expected))
            shares = shares * gain
            shares = shares / shares.sum()
        return shares


def _disagree(levels: FloatArray, count: int) -> bool:
    """Whether levels of ``count`` cosines scatter by more than chance: there is no shape in common then.

    So it is where what fluctuates belongs to the angle of the shaft and not to time.
    """
    chance = float(special.polygamma(1, count / 2.0))
    kurtosis = float(special.polygamma(3, count / 2.0)) / chance**2
    error = chance * ((2.0 + kurtosis) / (levels.size - 1)) ** 0.5
    return bool(np.var(np.log(np.maximum(levels, 1e-12)), ddof=1) > chance + DISAGREE * error)


def _agreement(levels: FloatArray, count: int) -> tuple[float, float]:
    """Cosines that a common level counts as beside ``count`` of a dwell's own, and that level (Smyth)."""
    logs = np.log(np.maximum(levels, 1e-12)) - special.digamma(count / 2.0) + np.log(count / 2.0)
    beyond = float(np.var(logs, ddof=1)) - float(special.polygamma(1, count / 2.0))
    if beyond <= 1e-3:
        return float("inf"), float(np.mean(levels))
    half = float(optimize.brentq(lambda x: float(special.polygamma(1, x)) - beyond, 1e-3, 1e6))
    return 2.0 * half, float(np.exp(np.mean(logs) + special.digamma(half) - np.log(half)))
