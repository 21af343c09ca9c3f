"""One law fitted to the dwells: its likeliest numbers, their covariance, and how well it predicts.

The numbers of a law are, in order: ln torque at the reference, where the law stands in ln Hersey number, how
viscosity and force go with temperature (``move``, ``bend``, ``force``), those of its shape, the weights of
the smooth curve of a ``free`` law, ln scatter, and the effects that dwells share. All have normal priors.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray
from hersey.cache.kept import kept
from hersey.damping.curves.dwells import Dwells
from hersey.damping.curves.shapes import Shape

#: Numbers before those of the shape.
_COMMON = ("level", "at", "move", "bend", "force")
#: How far the smooth curve of a free law goes on below the dwells, in ln speed.
_BELOW = 2.5
#: How far above them.
_ABOVE = 1.5
#: Distance of its bumps.
_SPACING = 0.9
#: Standard deviations of the priors: of ln torque, place, viscosity, its bend, and force with temperature.
_WIDE = {"level": 3.0, "at": 1.5, "move": 8.0, "bend": 1.0, "force": 0.3}
#: Standard deviation of the prior of ln scatter about that of the fitted surface.
_SCATTER = 1.0
#: Steps of derivatives, over the standard deviation of the prior.
_STEP = 1e-4
#: Damping of the first step to the likeliest numbers, and that at which none is better any more.
_DAMPED, _STUCK = 1e-2, 1e10
#: Steps at the most, and the gain in ln posterior at which they end.
_MOST_STEPS, _GAINED = 300, 1e-9
#: Draws are wider than the curvature of the posterior by this factor, so that none of its tail is missed.
INFLATED = 1.2
#: Draws and seed that the mean weight of the draws of a law is taken from.
_MEANS, _MEANS_SEED = 2000, 7
#: Speeds among the dwells at which the least torque is looked for.
_LOOKS = 60
#: Greatest ln weight of a draw over the mean of a normal posterior: no single one far out may rule (Ionides,
#: J. Comput. Graph. Stat. 17 (2008) 295).
_GREATEST = 3.0


@dataclass(frozen=True)
class FittedLaw:
    """A law as fitted: numbers, the square root of their covariance, and AICc."""

    shape: Shape
    dwells: Dwells
    numbers: FloatArray
    root: FloatArray  #: lower triangular, shape (numbers, numbers)
    log_posterior: float
    deviance: float
    parameters: float  #: effective number
    aicc: float

    def log_torque(self, numbers: FloatArray, log_speed: FloatArray, shape: float | FloatArray) -> FloatArray:
        """Return ln torque (N m) of draws, shape (draws, numbers), at ln(speed/reference).

        ``log_speed`` has the shape (points,), or (draws, points) where each draw has its own; ``shape`` is
        s(T), one value or one for each point.
        """
        return predicted(self.shape, self.dwells, numbers, log_speed, np.asarray(shape))

    def scaled_speed(
        self, numbers: FloatArray, log_speed: FloatArray, shape: float | FloatArray
    ) -> FloatArray:
        """Return ln(speed/reference) that has the same Hersey number at the reference, (draws, points)."""
        return _scaled(numbers, log_speed, np.asarray(shape))

    @cached_property
    def reach(self) -> tuple[float, float]:
        """Range of the dwells in ln(speed/reference) at the same Hersey number at the reference."""
        dwells = self.dwells
        measured = self.scaled_speed(self.numbers[None], dwells.log_speed, dwells.temperature)
        return float(measured.min()), float(measured.max())

    def fastest(self, numbers: FloatArray, shape: float) -> FloatArray:
        """Return ln(speed/reference) at s(T) of the greatest Hersey number measured, (draws,)."""
        return np.asarray(self.reach[1] - self.scaled_speed(numbers, np.zeros(1), shape)[:, 0])

    def log_level(self, numbers: FloatArray, shape: float) -> FloatArray:
        """Return the change of ln torque with temperature at the same Hersey number, (draws,)."""
        return np.asarray(numbers[:, _COMMON.index("force")] * shape)

    def slowest_below_least(self, numbers: FloatArray) -> FloatArray:
        """Return ln of the slowest dwell over the speed of least torque among the dwells, (draws,).

        Both at the Hersey number of the reference temperature.
        """
        grid = np.linspace(*self.reach, _LOOKS)
        least = np.argmin(self.log_torque(numbers, grid, 0.0), axis=1)
        return np.asarray(grid[0] - grid[least])

    @property
    def log_scatter(self) -> float:
        """Logarithm of the relative scatter between dwells."""
        return float(self.numbers[self.size - self.dwells.shared.shape[1] - 1])

    @cached_property
    def size(self) -> int:
        """How many numbers there are."""
        return int(self.numbers.size)

    def at(self, latent: FloatArray) -> FloatArray:
        """Return numbers, shape (draws, numbers), from standard normal latents of the same shape."""
        return np.asarray(self.numbers + INFLATED * latent @ self.root.T)

    def log_weight(self, latent: FloatArray) -> FloatArray:
        """Return by how much draws are likelier than the latents they are made of, one on average."""
        return self._log_weight(latent) - self._mean_log_weight

    def _log_weight(self, latent: FloatArray) -> FloatArray:
        posterior = log_posterior(self.shape, self.dwells, self.at(latent))
        weight = posterior - self.log_posterior + 0.5 * np.sum(latent**2, axis=1)
        return np.asarray(np.minimum(weight, _GREATEST - self.size * np.log(INFLATED)))

    @cached_property
    def _mean_log_weight(self) -> float:
        """Logarithm of the mean weight: without it a law of many numbers would count for too little."""
        latent = np.random.default_rng(_MEANS_SEED).standard_normal((_MEANS, self.size))
        every = self._log_weight(latent)
        return float(np.log(np.mean(np.exp(every - every.max()))) + every.max())


@kept()
def fit_shape(shape: Shape, dwells: Dwells, starts: list[FloatArray]) -> FittedLaw:
    """Return the likeliest of the fits from ``starts``: numbers before those that dwells share."""
    mean, deviation = priors(shape, dwells)
    found = []
    for start in starts:
        begin = mean.copy()
        begin[: start.size] = start
        found.append(_climbed(shape, dwells, begin, mean, deviation))
    return _fitted(shape, dwells, min(found, key=lambda each: each[1])[0], deviation)


def _climbed(
    shape: Shape, dwells: Dwells, numbers: FloatArray, mean: FloatArray, deviation: FloatArray
) -> tuple[FloatArray, float]:
    """Numbers where the posterior is highest, and minus its logarithm there, by damped Gauss-Newton steps."""
    damping, cost = _DAMPED, -float(log_posterior(shape, dwells, numbers[None])[0])
    for _ in range(_MOST_STEPS):
        gradient, curvature = _slopes(shape, dwells, numbers, mean, deviation)
        diagonal = np.diag(np.diag(curvature))
        while damping < _STUCK:
            step = np.linalg.solve(curvature + damping * diagonal, gradient)
            tried = numbers + deviation * step
            there = -float(log_posterior(shape, dwells, tried[None])[0])
            if there < cost:
                break
            damping *= 4.0
        else:
            break
        gained, numbers, cost, damping = cost - there, tried, there, 0.2 * damping
        if gained < _GAINED and float(gradient @ step) < _GAINED:
            break
    return numbers, cost


def _slopes(
    shape: Shape, dwells: Dwells, numbers: FloatArray, mean: FloatArray, deviation: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Gradient of the log-posterior, and about minus its second derivatives, in deviations of the priors."""
    many = dwells.shared.shape[1]
    scatter = numbers.size - many - 1
    curve, slopes = _curve_and_slopes(shape, dwells, numbers, deviation)
    pull, weight, by_scatter, information = dwells.slopes_of(
        curve + dwells.shared @ numbers[scatter + 1 :], float(numbers[scatter])
    )
    slopes *= deviation[:, None]
    gradient = slopes @ pull - (numbers - mean) / deviation
    gradient[scatter] += deviation[scatter] * by_scatter
    curvature = (slopes * weight) @ slopes.T + np.eye(numbers.size)
    curvature[scatter, scatter] += deviation[scatter] ** 2 * information
    return gradient, curvature


def _curve_and_slopes(
    shape: Shape, dwells: Dwells, numbers: FloatArray, deviation: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Ln torque at the dwells without shared effects, and its derivatives, shape (numbers, points).

    Those by numbers that bend the curve are central differences.
    """
    own = len(_COMMON) + len(shape.priors)
    bent = [_COMMON.index("at"), _COMMON.index("move"), _COMMON.index("bend"), *range(len(_COMMON), own)]
    aside = np.diag(_STEP * deviation)[bent]
    spots = numbers + np.vstack([np.zeros(numbers.size), aside, -aside])
    curves = predicted(shape, dwells, spots, dwells.log_speed, dwells.temperature)
    slopes = np.zeros((numbers.size, len(dwells)))
    up, down = np.split(curves[1:], 2)
    slopes[bent] = (up - down) / (2.0 * _STEP * deviation[bent, None])
    slopes[_COMMON.index("level")] = 1.0
    slopes[_COMMON.index("force")] = dwells.temperature
    if shape.residual:
        scaled = _scaled(numbers[None], dwells.log_speed, dwells.temperature)
        near = shape.residual * _near(dwells, scaled)[0].T
        slopes[own : own + len(near)] = near
        slopes[own + len(near) : own + 2 * len(near)] = near * _tilt(dwells, dwells.temperature)
    if many := dwells.shared.shape[1]:
        slopes[-many:] = dwells.shared.T
    return curves[0], slopes


def _fitted(shape: Shape, dwells: Dwells, numbers: FloatArray, deviation: FloatArray) -> FittedLaw:
    hessian = -_hessian(lambda n: log_posterior(shape, dwells, n), numbers, deviation)
    values, vectors = np.linalg.eigh(0.5 * (hessian + hessian.T))
    # no direction is less certain than its prior
    inverse = (vectors / np.maximum(values, 1.0)) @ vectors.T
    likely = log_likelihood(shape, dwells, numbers[None])
    effective = float(np.trace(np.eye(numbers.size) - inverse))
    named = min(effective - _effects_share(dwells, inverse), len(dwells) - 2.0)
    deviance = -2.0 * float(likely[0])
    few = 2.0 * named * (named + 1.0) / max(len(dwells) - named - 1.0, 1.0)
    return FittedLaw(
        shape=shape,
        dwells=dwells,
        numbers=numbers,
        root=np.linalg.cholesky((inverse + 1e-12 * np.eye(numbers.size)) * np.outer(deviation, deviation)),
        log_posterior=float(log_posterior(shape, dwells, numbers[None])[0]),
        deviance=deviance,
        parameters=named,
        aicc=deviance + 2.0 * named + few,
    )


def _effects_share(dwells: Dwells, inverse: FloatArray) -> float:
    """How many degrees of freedom the shared effects take up, the same in all laws."""
    many = dwells.shared.shape[1]
    return float(many - np.trace(inverse[-many:, -many:])) if many else 0.0


def _hessian(of: object, at: FloatArray, deviation: FloatArray) -> FloatArray:
    """Second derivatives in standard deviations of the prior, all points in one call."""
    size, step = at.size, 2e-3
    rows, columns = np.triu_indices(size)
    plus = np.eye(size)[rows] + np.eye(size)[columns]
    minus = np.eye(size)[rows] - np.eye(size)[columns]
    moves = step * np.vstack([plus, minus, -minus, -plus])
    values = of(at + deviation * moves).reshape(4, -1)  # type: ignore[operator]
    # on the diagonal this is the central difference over two steps
    second = (values[0] - values[1] - values[2] + values[3]) / (4.0 * step**2)
    out = np.zeros((size, size))
    out[rows, columns] = second
    return np.asarray(out + np.triu(out, 1).T)


def priors(shape: Shape, dwells: Dwells) -> tuple[FloatArray, FloatArray]:
    """Return means and standard deviations of the priors of all numbers."""
    thermal = dwells.thermal is not None
    centre = {"level": float(np.mean(dwells.log_torque)), "at": float(np.mean(dwells.log_speed))}
    mean = [centre.get(name, 0.0) for name in _COMMON]
    deviation = [_WIDE[name] if thermal or name in centre else 1e-6 for name in _COMMON]
    mean += [prior.mean for prior in shape.priors]
    deviation += [prior.deviation for prior in shape.priors]
    bumps = 2 * _bumps(dwells).size if shape.residual else 0
    mean += [0.0] * bumps + [float(np.log(dwells.scatter))] + [0.0] * dwells.shared.shape[1]
    deviation += [1.0] * bumps + [_SCATTER] + [1.0] * dwells.shared.shape[1]
    return np.array(mean), np.array(deviation)


def log_posterior(shape: Shape, dwells: Dwells, numbers: FloatArray) -> FloatArray:
    """Return the log-posterior of draws of the numbers, without its constant, shape (draws,)."""
    mean, deviation = priors(shape, dwells)
    prior = -0.5 * np.sum(((numbers - mean) / deviation) ** 2, axis=1)
    return np.asarray(prior + log_likelihood(shape, dwells, numbers))


def log_likelihood(shape: Shape, dwells: Dwells, numbers: FloatArray) -> FloatArray:
    """Return the log-likelihood of draws of the numbers."""
    many = dwells.shared.shape[1]
    effects = numbers[:, numbers.shape[1] - many :]
    curve = predicted(shape, dwells, numbers, dwells.log_speed, dwells.temperature)
    return dwells.log_likelihood(curve, numbers[:, numbers.shape[1] - many - 1], effects)


def predicted(
    shape: Shape, dwells: Dwells, numbers: FloatArray, log_speed: FloatArray, temperature: FloatArray
) -> FloatArray:
    """Return ln torque of draws, shape (draws, points)."""
    scaled = _scaled(numbers, log_speed, temperature)
    first = len(_COMMON)
    own = numbers[:, first : first + len(shape.priors)]
    out = numbers[:, :1] + numbers[:, 4:5] * temperature + shape.curve(scaled - numbers[:, 1:2], own)
    if not shape.residual:
        return np.asarray(out)
    near = _near(dwells, scaled)
    bumps = near.shape[2]
    first += len(shape.priors)
    weights = numbers[:, first : first + bumps]
    tilted = numbers[:, first + bumps : first + 2 * bumps]
    both = weights[:, None, :] + tilted[:, None, :] * np.atleast_1d(_tilt(dwells, temperature))[None, :, None]
    return np.asarray(out + shape.residual * np.sum(near * both, axis=2))


def _near(dwells: Dwells, scaled: FloatArray) -> FloatArray:
    """The bumps of the smooth curve at scaled speeds, shape (draws, points, bumps)."""
    return np.asarray(np.exp(-0.5 * ((scaled[:, :, None] - _bumps(dwells)) / _SPACING) ** 2))


def _tilt(dwells: Dwells, temperature: FloatArray) -> FloatArray:
    """How much of a tilted bump there is at temperatures."""
    return np.asarray(0.5 * temperature / max(float(np.ptp(dwells.temperature)), 1e-9))


def _scaled(numbers: FloatArray, log_speed: FloatArray, temperature: FloatArray) -> FloatArray:
    """Ln speed at the same Hersey number at the reference temperature."""
    return np.asarray(log_speed + numbers[:, 2:3] * temperature + numbers[:, 3:4] * temperature**2)


def _bumps(dwells: Dwells) -> FloatArray:
    """Centres of the bumps of the smooth curve, in ln speed."""
    low, high = float(dwells.log_speed.min()) - _BELOW, float(dwells.log_speed.max()) + _ABOVE
    return np.arange(low, high + _SPACING, _SPACING)
