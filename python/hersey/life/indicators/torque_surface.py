"""The torque of a run between its dwells, and a little beyond, without a law.

ln torque over ln speed and temperature is a quadratic trend that costs nothing, a smooth deviation from it
and the noise of the dwells (universal kriging, Matheron 1969; Rasmussen and Williams, Gaussian Processes,
2006, 2.7; 4.2 with nu = 3/2, as the least torque is a bend). A power law of both does not hold of an aged
drive, cold starved and hot flooded; here the dwells beside a point say what holds there, and the error how
far they do. How much and over what lengths torque deviates from its trend is shared by all runs of a
campaign: no run of few dwells shows it.

The torque is that of the belt alone where the no-load torque is known: above a large rest its logarithm is
flat at one end and steep at the other, and no trend goes on from there. Noise may then be as large as torque
itself; so the logarithm is taken about the smooth torque, not about that of the dwell, until they agree.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy import linalg

from hersey.arrays import BoolArray, FloatArray
from hersey.errors import InsufficientDataError, ParameterError

#: Kelvin that count as much as one unit of ln speed in the trend.
TEMPERATURE_SCALE = 50.0
#: Levels this close are one: logarithm of speed, K.
_SAME_SPEED, _SAME_TEMPERATURE = 0.02, 3.0
#: Dwells beyond the terms of the trend, which show deviations and noise.
_TO_SPARE = 1
#: Fewest dwells of a run that determine its torque.
FEWEST = 4
#: Variance of ln torque below which no dwell is believed: rounding of large covariances.
_FLOOR = 1e-9
#: Relative standard error from which on a torque counts as unknown.
_LOST = 2.0
#: The logarithm is taken about the smooth torque until it moves by no more than this, in so many rounds; the
#: longest step of a round.
_SETTLED, _ROUNDS, _STEP = 1e-3, 12, 1.0


@dataclass(frozen=True)
class RunDwells:
    """The dwells of a run: arrays of shape (dwells,).

    ``speed`` in rad/s, positive; ``temperature`` in K (NaN throughout where none was recorded). ``torque`` in
    N m is that of the belt alone so far as the no-load torque is known, ``drive_torque`` that of the whole
    drive, both in the sense of rotation; ``error`` is the standard error of either.
    """

    speed: FloatArray
    temperature: FloatArray
    torque: FloatArray
    drive_torque: FloatArray
    error: FloatArray


@dataclass(frozen=True)
class Kernel:
    """How torque deviates from its trend, the same for all runs of a campaign.

    ``deviation`` is relative, ``speed_length`` in ln speed, ``temperature_length`` in K. What is at one speed
    lies faster by ``tilt`` (1/K) in ln speed where it is warmer, as viscosity is less. ``scatter`` is what
    dwells scatter beyond their stated errors, relative to the whole torque.
    """

    deviation: float
    speed_length: float
    temperature_length: float
    tilt: float
    scatter: float

    def covariance(self, steps: FloatArray, temperature_steps: FloatArray) -> FloatArray:
        """Return the covariance of deviations, so many steps of ln speed and kelvin apart."""
        along = np.sqrt(3.0) * np.abs(steps - self.tilt * temperature_steps) / self.speed_length
        across = np.sqrt(3.0) * np.abs(temperature_steps) / self.temperature_length
        return np.asarray(self.deviation**2 * (1.0 + along) * (1.0 + across) * np.exp(-along - across))


@dataclass(frozen=True)
class Prediction:
    """Torque of the belt at points: arrays of shape (points,).

    ``torque`` in N m is the median, ``error`` its relative standard error, without the scatter of a dwell;
    both NaN at a temperature that the run does not cover, and where the error is beyond all use.
    ``outside`` marks points that dwells do not enclose; they are ``factor`` times as fast as the nearest
    dwell, and ``kelvin`` warmer.
    """

    torque: FloatArray
    error: FloatArray
    outside: BoolArray
    factor: FloatArray
    kelvin: FloatArray


class _Solved(NamedTuple):
    """The roots of the covariances of dwells and of the trend, weights of the trend, and what is whitened."""

    root: FloatArray
    inner: FloatArray
    weights: FloatArray
    trend: FloatArray
    left: FloatArray
    settled: FloatArray  #: ln torque at the dwells, smooth
    noise: FloatArray  #: variance of ln torque of the dwells about that


class Layout:
    """Where the dwells of a run lie, and the trend that they determine."""

    def __init__(self, dwells: RunDwells) -> None:
        self.dwells = dwells
        self.thermal = bool(np.isfinite(dwells.temperature).all())
        self.log_speed, self.kelvin = np.log(dwells.speed), self.temperatures(dwells.temperature)
        self._origin = float(np.mean(self.log_speed)), float(np.mean(self.kelvin))
        self.steps = self.log_speed[:, None] - self.log_speed
        self.temperature_steps = self.kelvin[:, None] - self.kelvin
        self._terms = self._estimable_terms()
        self.trend = self.trend_at(self.log_speed, self.kelvin)
        while np.linalg.matrix_rank(self.trend, tol=1e-6) < self.trend.shape[1]:
            self._terms = self._terms[:-1]
            self.trend = self.trend[:, :-1]

    def temperatures(self, temperature: FloatArray) -> FloatArray:
        """Temperatures, K; all the same where the run recorded none."""
        return np.asarray(temperature if self.thermal else np.zeros_like(temperature))

    @property
    def varied(self) -> bool:
        """Whether the trend has a term of temperature."""
        return 2 in self._terms

    def trend_at(self, log_speed: FloatArray, kelvin: FloatArray) -> FloatArray:
        """Terms 1, u, T, u T, u^2, T^2 so far as they can be estimated, shape (points, terms)."""
        u, t = log_speed - self._origin[0], (kelvin - self._origin[1]) / TEMPERATURE_SCALE
        return np.stack([np.ones_like(u), u, t, u * t, u * u, t * t], axis=1)[:, self._terms]

    def _estimable_terms(self) -> list[int]:
        speeds, temperatures = _levels(self.log_speed, _SAME_SPEED), _levels(self.kelvin, _SAME_TEMPERATURE)
        has = [
            True,
            speeds > 1,
            temperatures > 1,
            min(speeds, temperatures) > 1,
            speeds > 2,
            temperatures > 2,
        ]
        return [term for term in range(6) if has[term]][: max(self.log_speed.size - _TO_SPARE, 1)]

    def first(self) -> FloatArray:
        """Ln torque of the dwells, those lost in noise at the size of that noise."""
        least = np.maximum(self.dwells.error, 1e-3 * np.abs(self.dwells.drive_torque))
        return np.log(np.maximum(self.dwells.torque, least))

    def solved(self, kernel: Kernel, about: FloatArray, deviations: FloatArray) -> _Solved:
        """The surface with ln torque taken about values of the dwells; ``deviations``: their covariance."""
        torque = _torque(about)
        noise = (self.dwells.error**2 + (kernel.scatter * self.dwells.drive_torque) ** 2) / torque**2 + _FLOOR
        value = about + np.clip(self.dwells.torque / torque - 1.0, -_STEP, _STEP)
        covariance = deviations + np.diag(noise)
        root = _root(covariance)
        both = _forward(root, np.column_stack([self.trend, value]))
        trend = both[:, :-1]
        inner = _root(trend.T @ trend)
        weights = _backward(inner, _forward(inner, trend.T @ both[:, -1]))
        left = both[:, -1] - trend @ weights
        pulled = _backward(root, left)
        return _Solved(root, inner, weights, trend, left, value - noise * pulled, noise)

    def settled(self, kernel: Kernel) -> _Solved:
        """The surface about itself."""
        deviations = kernel.covariance(self.steps, self.temperature_steps)
        solved = self.solved(kernel, about := self.first(), deviations)
        for _ in range(_ROUNDS):
            if float(np.max(np.abs(solved.settled - about))) < _SETTLED:
                break
            about = about + np.clip(solved.settled - about, -_STEP, _STEP)
            solved = self.solved(kernel, about, deviations)
        return solved

    def misfit(self, kernel: Kernel, about: FloatArray) -> float:
        """Twice the negative restricted log-likelihood, but for a constant (Patterson and Thompson 1971)."""
        solved = self.solved(kernel, about, kernel.covariance(self.steps, self.temperature_steps))
        size = np.log(np.diag(solved.root)).sum() + np.log(np.diag(solved.inner)).sum()
        return float(2.0 * size + solved.left @ solved.left)


class TorqueSurface:
    """The torque of the belt of one run, from its dwells and the kernel of the campaign.

    Raises
    ------
    InsufficientDataError
        If there are fewer than four dwells.
    """

    def __init__(self, dwells: RunDwells, kernel: Kernel) -> None:
        """Solve for the deviations at the dwells."""
        if dwells.speed.size < FEWEST:
            raise InsufficientDataError(
                f"only {dwells.speed.size} dwells: interpolating torque needs at least {FEWEST}"
            )
        self.dwells, self.kernel = dwells, kernel
        self._layout = Layout(dwells)
        self._solved = self._layout.settled(kernel)

    def covers(self, temperature: float) -> bool:
        """Return whether the run covers a temperature, K.

        One of a single temperature, or of too few dwells to show what temperature does, covers only what
        it recorded; one without temperature is taken to have been at that which is asked for.
        """
        if self._layout.varied or not self._layout.thermal:
            return True
        temperatures = self.dwells.temperature
        return bool(
            temperatures.min() - _SAME_TEMPERATURE <= temperature <= temperatures.max() + _SAME_TEMPERATURE
        )

    def at(self, speed: FloatArray, temperature: FloatArray) -> Prediction:
        """Return the torque at points: speeds in rad/s and temperatures in K, shape (points,)."""
        speed, temperature = np.broadcast_arrays(np.asarray(speed, float), np.asarray(temperature, float))
        mean, across, basis = self._predicted(speed, temperature)
        variance = self.kernel.deviation**2 - np.sum(across**2, axis=0) + np.sum(basis**2, axis=0)
        error = np.sqrt(np.maximum(variance, 0.0))
        known = np.array([self.covers(float(each)) for each in temperature]) & (error < _LOST)
        return Prediction(
            np.where(known, _torque(mean), np.nan),
            np.where(known, error, np.nan),
            *self._nearest(speed, temperature),
        )

    def curve(self, speed: FloatArray, temperature: float) -> FloatArray:
        """Return the median torque against speed (rad/s, shape (speeds,)) at a temperature in K, in N m.

        Raises
        ------
        ParameterError
            If the run does not cover this temperature.
        """
        return _torque(self._on_curve(speed, temperature)[0])

    def drawn(self, speed: FloatArray, temperature: float, draws: int, seed: int) -> FloatArray:
        """Return joint draws of such a curve, (draws, speeds)."""
        mean, across, basis = self._on_curve(speed, temperature)
        steps = np.log(speed)[:, None] - np.log(speed)
        covariance = self.kernel.covariance(steps, np.zeros(())) - across.T @ across + basis.T @ basis
        # Of neighbours on a fine grid nearly all is known: without a little more there is no root.
        covariance[np.diag_indices_from(covariance)] += 1e-10 * (1.0 + self.kernel.deviation**2)
        try:
            root = _root(covariance)
        except linalg.LinAlgError:
            spread, axes = np.linalg.eigh(covariance)
            root = np.sqrt(np.maximum(spread, 0.0)) * axes
        normal = np.random.default_rng(seed).standard_normal((draws, speed.size))
        return _torque(mean + normal @ root.T)

    def repeated(self, speed: FloatArray, temperature: float, draws: int, seed: int) -> FloatArray:
        """Return such curves that the same run would show with other noise, (draws, speeds)."""
        solved, layout = self._solved, self._layout
        mean, across, _ = self._on_curve(speed, temperature)
        normal = np.random.default_rng(seed).standard_normal((draws, solved.noise.size))
        noise = _forward(solved.root, (normal * np.sqrt(solved.noise)).T)
        weights = _backward(solved.inner, _forward(solved.inner, solved.trend.T @ noise))
        trend = layout.trend_at(np.log(speed), layout.temperatures(np.full(speed.shape, temperature)))
        return _torque(mean + (trend @ weights + across.T @ (noise - solved.trend @ weights)).T)

    def with_more_noise(self, factor: float) -> TorqueSurface:
        """Return the surface of the same dwells, taken to be so many times as noisy."""
        dwells = replace(self.dwells, error=factor * self.dwells.error)
        return TorqueSurface(dwells, replace(self.kernel, scatter=factor * self.kernel.scatter))

    def _on_curve(self, speed: FloatArray, temperature: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        if not self.covers(temperature):
            raise ParameterError(
                f"the run was recorded at other temperatures and does not cover {temperature:.6g} K"
            )
        return self._predicted(speed, np.full(speed.shape, temperature))

    def _predicted(
        self, speed: FloatArray, temperature: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Mean of ln torque at points; what dwells take from its variance, and what the trend adds: roots."""
        layout, solved = self._layout, self._solved
        at, kelvin = np.log(speed), layout.temperatures(temperature)
        covariance = self.kernel.covariance(layout.log_speed[:, None] - at, layout.kelvin[:, None] - kelvin)
        across = _forward(solved.root, covariance)
        trend = layout.trend_at(at, kelvin)
        basis = _forward(solved.inner, trend.T - solved.trend.T @ across)
        return trend @ solved.weights + across.T @ solved.left, across, basis

    def _nearest(
        self, speed: FloatArray, temperature: FloatArray
    ) -> tuple[BoolArray, FloatArray, FloatArray]:
        """Whether dwells do not enclose points, and how they lie to the nearest."""
        layout = self._layout
        step = np.log(speed)[:, None] - layout.log_speed
        temperature_step = layout.temperatures(temperature)[:, None] - layout.kelvin
        sides = [
            np.any((side * step >= -_SAME_SPEED) & (other * temperature_step >= -_SAME_TEMPERATURE), axis=1)
            for side in (1, -1)
            for other in (1, -1)
        ]
        far = (step / self.kernel.speed_length) ** 2 + (
            temperature_step / self.kernel.temperature_length
        ) ** 2
        nearest = np.arange(far.shape[0]), np.argmin(far, axis=1)
        return ~np.all(sides, axis=0), np.exp(step[nearest]), temperature_step[nearest]


def _torque(logarithm: FloatArray) -> FloatArray:
    """Torque of its logarithm, a number also where nothing is known of it."""
    return np.asarray(np.exp(np.clip(logarithm, -60.0, 60.0)))


def _levels(values: FloatArray, separation: float) -> int:
    """How many levels there are, neighbours closer than ``separation`` being one."""
    return 1 + int(np.count_nonzero(np.diff(np.sort(values)) > separation))


# SciPy's own doors to these take longer than the work on a hundred dwells.
def _root(covariance: FloatArray) -> FloatArray:
    root, failed = linalg.lapack.dpotrf(covariance.T, lower=1, clean=1)
    if failed:
        raise linalg.LinAlgError("a covariance is not positive")
    return np.asarray(root)


def _forward(root: FloatArray, right: FloatArray) -> FloatArray:
    return np.asarray(linalg.lapack.dtrtrs(root, right, lower=1)[0])


def _backward(root: FloatArray, right: FloatArray) -> FloatArray:
    return np.asarray(linalg.lapack.dtrtrs(root, right, lower=1, trans=1)[0])
