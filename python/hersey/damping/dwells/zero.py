"""The zero of the torque over the log, from every stretch in which the drive stands.

Each standing stretch measures the zero at its time. Between and beyond them it is a constant, a line and a
random walk together. Neither the size of the line nor that of the walk is chosen: every pair of sizes, none
among them, is weighed by its restricted likelihood, and the zeros that they give are averaged with their
covariances and with what they differ by. Few stretches thus leave much open, by themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import linalg

from hersey.arrays import FloatArray
from hersey.damping.distributions import square_above
from hersey.damping.dwells.noise import mean_and_error
from hersey.damping.dwells.resolution import rounding_error
from hersey.damping.dwells.segments import Segment
from hersey.damping.dwells.shared_noise import Powers, SharedNoise
from hersey.errors import TARE
from hersey.log.torque_log import Run
from hersey.schema.warning import Warning

#: Sizes of line and walk over the log that are weighed, as shares of what the stretches differ by.
SIZES = (0.0, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2)
#: Disturbances of the zero with less than this share of the variance of the largest are left to the dwells.
SMALL = 1e-6
#: So are those that leave no dwell more than this share of its own error.
NEGLIGIBLE = 0.1
#: Disturbances at the most.
MOST_DISTURBANCES = 30
#: Times at which disturbances are computed at the most; between them they are straight.
MOST_TIMES = 300
#: A difference of stretches is no chance below this p-value.
CHANCE = 0.01


@dataclass(frozen=True)
class Standing:
    """A stretch in which the drive stands: middle, s into the log, and its mean torque and error, N m."""

    run: int
    time: float
    torque: float
    error: float


def starts_of(runs: tuple[Run, ...]) -> FloatArray:
    """Return when each run starts, s into the log: runs follow one another without a pause."""
    durations = [float(run.time[-1] - run.time[0]) for run in runs]
    return np.concatenate([[0.0], np.cumsum(durations)[:-1]])


def standing_stretches(
    runs: tuple[Run, ...],
    segments: list[list[Segment]],
    noise: SharedNoise | None = None,
    steps: Sequence[float] | None = None,
) -> list[Standing]:
    """Return the stretches in which the drive stands, without their first and last tenth.

    ``steps`` are those in which the torque sensor counts in each run, N m.
    """
    starts = starts_of(runs)
    stretches = []
    for index, (run, run_segments) in enumerate(zip(runs, segments, strict=True)):
        for s in run_segments:
            if s.standing and s.steady:
                trim = (s.end - s.start) // 10
                first, last = s.start + trim, s.end - trim
                mean, error, _ = mean_and_error(run.torque[first:last])
                if noise is not None:  # noise of a standing drive may be less, hardly slower
                    error = noise.mean_error(Powers.of(run.torque[first:last], run.sampling_interval))
                if steps is not None:
                    error = float(np.hypot(error, rounding_error(run.torque[first:last], steps[index])))
                middle = float(run.time[first] + run.time[last - 1]) / 2.0 - float(run.time[0])
                run.passed(s.start, s.end)
                stretches.append(Standing(index, float(starts[index]) + middle, mean, error))
    return stretches


@dataclass(frozen=True)
class _Drift:
    """A line and a walk of given sizes, N m over the log, beside what the stretches show."""

    line: float
    walk: float
    inverse: FloatArray  #: of the covariance of the stretches
    level: float  #: about which they drift, N m
    solved: FloatArray  #: weights by which a stretch bears on the zero at another time
    likelihood: float  #: restricted, logarithm


@dataclass(frozen=True)
class Zero:
    """What the stretches say of the zero, N m, at any time of the log, s."""

    stretches: tuple[Standing, ...]
    duration: float  #: of the log, s

    @property
    def mean(self) -> float:
        """Mean of the stretches, each by how well it is known."""
        return float(np.average(self._torque, weights=1.0 / self._errors**2))

    @property
    def p_value(self) -> float:
        """Probability that stretches of one constant zero differ as much; 1 for a single one."""
        if len(self.stretches) < 2:
            return 1.0
        square = float(np.sum(((self._torque - self.mean) / self._errors) ** 2))
        return float(square_above(square, len(self.stretches) - 1))

    def at(self, times: FloatArray) -> FloatArray:
        """Return the zero at these times, shape (times,)."""
        times = np.asarray(times, dtype=np.float64)
        if len(self.stretches) == 1:
            return np.full(times.size, self._torque[0])
        each = [weight * self._kriged(times, drift) for weight, drift in self._drifts]
        return np.asarray(np.sum(each, axis=0))

    def disturbances(self, times: FloatArray, errors: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what one standard error of each disturbance does at these times, and the error left over.

        Shapes (times, disturbances), the largest first, and (times,); ``errors`` are those of the dwells
        themselves, beside which small disturbances cannot be distinguished.
        """
        known = np.unique(times)
        if known.size > MOST_TIMES:
            known = np.unique(np.quantile(known, np.linspace(0.0, 1.0, MOST_TIMES)))
        covariance = self._covariance(known)
        values, vectors = linalg.eigh(covariance)
        large = np.flatnonzero(values > SMALL * values[-1])[::-1][:MOST_DISTURBANCES]
        modes = vectors[:, large] * np.sqrt(values[large])
        modes = modes * np.where(modes.sum(axis=0) < 0.0, -1.0, 1.0)
        variances = np.diag(covariance)[:, None] - np.cumsum(modes**2, axis=1)
        left = np.column_stack([np.interp(times, known, v) for v in np.sqrt(np.maximum(variances, 0.0)).T])
        enough = np.all(left <= NEGLIGIBLE * errors[:, None], axis=0)
        count = int(np.argmax(enough)) + 1 if enough.any() else left.shape[1]
        at_times = [np.interp(times, known, mode) for mode in modes[:, :count].T]
        return np.column_stack(at_times), np.asarray(left[:, count - 1])

    @property
    def _torque(self) -> FloatArray:
        return np.array([s.torque for s in self.stretches])

    @property
    def _errors(self) -> FloatArray:
        """Errors of the stretches; a sensor without noise still has some resolution."""
        least = 1e-5 * max(1e-9, float(np.max(np.abs(self._torque))))
        return np.maximum([s.error for s in self.stretches], least)

    @cached_property
    def _drifts(self) -> tuple[tuple[float, _Drift], ...]:
        """Sizes of line and walk that the stretches allow, each with its weight."""
        size = max(float(np.ptp(self._torque)), float(np.min(self._errors)))
        drifts = [self._drift(size * line, size * walk) for line in SIZES for walk in SIZES]
        # each alone: no line, or one of any size; no walk, or one of any size
        nothing = 0.5
        prior = np.where(np.array(SIZES) == 0.0, nothing, (1.0 - nothing) / (len(SIZES) - 1))
        weight = np.array([drift.likelihood for drift in drifts]) + np.log(np.outer(prior, prior)).ravel()
        weight = np.exp(weight - weight.max())
        kept = np.flatnonzero(weight > 1e-6 * weight.sum())
        return tuple((float(weight[i] / weight[kept].sum()), drifts[i]) for i in kept)

    def _covariance(self, times: FloatArray) -> FloatArray:
        """The covariance of the zero at these times, averaged over sizes of line and walk."""
        if len(self.stretches) == 1:
            return np.full((times.size,) * 2, self._errors[0] ** 2)
        mean, covariance = self.at(times), np.zeros((times.size, times.size))
        for weight, drift in self._drifts:
            away = self._kriged(times, drift) - mean
            covariance += weight * (self._spread(times, drift) + np.outer(away, away))
        return covariance

    def _drift(self, line: float, walk: float) -> _Drift:
        """What the stretches say, if line and walk have these sizes (N m) over the log."""
        own = np.array([s.time for s in self.stretches])
        inside = self._kernel(own, own, line, walk) + np.diag(self._errors**2)
        inverse = linalg.inv(inside)
        of_ones = inverse.sum(axis=1)
        level = float(self._torque @ of_ones) / float(of_ones.sum())
        solved = inverse @ (self._torque - level)
        likelihood = -0.5 * (float((self._torque - level) @ solved) + float(np.linalg.slogdet(inside)[1]))
        likelihood -= 0.5 * float(np.log(of_ones.sum()))
        return _Drift(line, walk, inverse, level, solved, likelihood)

    def _kriged(self, times: FloatArray, drift: _Drift) -> FloatArray:
        """The zero at these times, for one size of line and of walk."""
        return np.asarray(drift.level + self._across(times, drift) @ drift.solved)

    def _spread(self, times: FloatArray, drift: _Drift) -> FloatArray:
        """The covariance of that."""
        across = self._across(times, drift)
        of_ones = drift.inverse.sum(axis=1)
        left = 1.0 - across @ of_ones
        spread = self._kernel(times, times, drift.line, drift.walk) - across @ drift.inverse @ across.T
        return np.asarray(spread + np.outer(left, left) / float(of_ones.sum()))

    def _across(self, times: FloatArray, drift: _Drift) -> FloatArray:
        """Covariance between these times and those of the stretches."""
        own = np.array([s.time for s in self.stretches])
        return self._kernel(times, own, drift.line, drift.walk)

    def _kernel(self, first: FloatArray, second: FloatArray, line: float, walk: float) -> FloatArray:
        """Covariance of line and walk between times."""
        a, b = first[:, None] / self.duration, second[None, :] / self.duration
        return np.asarray(line**2 * (a - 0.5) * (b - 0.5) + walk**2 * np.minimum(a, b))

    def warnings(self, *, subtracted: bool, times: FloatArray) -> tuple[Warning, ...]:
        """Return what is to be known of it, for dwells at these times."""
        count, p = len(self.stretches), self.p_value
        if count == 1:
            return (_seen_once(),) if subtracted else ()
        drifts = p < CHANCE
        if not subtracted:
            rise = float(np.ptp(self._torque))
            return (_drifting_unsubtracted(rise, p),) if drifts else ()
        out = []
        if drifts:
            rise = float(np.ptp(self.at(times)))
            out.append(_drifting(rise, p, count))
        if count == 2:
            words = (
                "the drive stood still only twice, so only the total change of the {measured} zero is known, "
                "not its course between or outside these times"
            )
            out.append(Warning("two standing stretches", words))
        return tuple(out)


def _drifting_unsubtracted(rise: float, p_value: float) -> Warning:
    return Warning(
        "zero drifts, not subtracted",
        "{measured} at standstill drifts by {rise:.3g N m} ({p_value:p}) and is not subtracted. If the "
        "drive stands free, use {how:standing}",
        severity="watch",
        rise=rise,
        p_value=p_value,
        how=TARE,
    )


def _drifting(rise: float, p_value: float, count: int) -> Warning:
    return Warning(
        "zero drifts",
        "the {measured} zero varies by {rise:.3g N m} ({p_value:p}, {count} standstills), by drift or "
        "hysteresis. Each dwell is corrected by the zero at its time; intervals include its error",
        severity="watch",
        rise=rise,
        p_value=p_value,
        count=count,
    )


def _seen_once() -> Warning:
    return Warning(
        "one standing stretch",
        "the drive stood still only once, so drift of the {measured} zero cannot be checked. Record "
        "another standstill at the end, or better, every few dwells",
        severity="watch",
    )
