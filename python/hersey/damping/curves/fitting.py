"""One law fitted to the dwells: its likeliest numbers, their covariance, and how well it predicts.

The numbers of a law are, in order: ln torque at the reference, where the law stands in ln Hersey number, how
viscosity and force go with temperature (``move``, ``bend``, ``force``), those of its shape, the weights of
the smooth curve of a ``free`` law, ln scatter, and the effects that dwells share. All have normal priors.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray
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


def fit_shape(shape: Shape, dwells: Dwells, starts: list[FloatArray]) -> FittedLaw:
    """Return the likeliest of the fits from ``starts``: numbers before those that dwells share."""
    mean, deviation = priors(shape, dwells)

    def cost(scaled: FloatArray) -> tuple[float, FloatArray]:
        moved = np.vstack([np.zeros(mean.size), np.eye(mean.size), -np.eye(mean.size)]) * _STEP
        values = -log_posterior(shape, dwells, mean + deviation * (scaled + moved))
        slopes = (values[1 : mean.size + 1] - values[mean.size + 1 :]) / (2.0 * _STEP)
        return float(values[0]), np.asarray(slopes)

    best = None
    for start in starts:
        begin = mean.copy()
        begin[: start.size] = start
        found = optimize.minimize(
            cost, (begin - mean) / deviation, jac=True, method="BFGS", options={"maxiter": 200, "gtol": 1e-3}
        )
        if best is None or found.fun < best.fun:
            best = found
    assert best is not None
    return _fitted(shape, dwells, mean + deviation * best.x, deviation)


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
    bumps = _bumps(dwells)
    first += len(shape.priors)
    weights = numbers[:, first : first + bumps.size]
    tilted = numbers[:, first + bumps.size : first + 2 * bumps.size]
    reach = max(float(np.ptp(dwells.temperature)), 1e-9)
    both = (
        weights[:, None, :] + 0.5 * tilted[:, None, :] * (np.atleast_1d(temperature) / reach)[None, :, None]
    )
    near = np.exp(-0.5 * ((scaled[:, :, None] - bumps) / _SPACING) ** 2)
    return np.asarray(out + shape.residual * np.sum(near * both, axis=2))


def _scaled(numbers: FloatArray, log_speed: FloatArray, temperature: FloatArray) -> FloatArray:
    """Ln speed at the same Hersey number at the reference temperature."""
    return np.asarray(log_speed + numbers[:, 2:3] * temperature + numbers[:, 3:4] * temperature**2)


def _bumps(dwells: Dwells) -> FloatArray:
    """Centres of the bumps of the smooth curve, in ln speed."""
    low, high = float(dwells.log_speed.min()) - _BELOW, float(dwells.log_speed.max()) + _ABOVE
    return np.arange(low, high + _SPACING, _SPACING)
