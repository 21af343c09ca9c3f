"""The least error that each parameter can have: generalised least squares with the true covariance.

What is written here knows the truth: the law at its true parameters, the size of every error, which dwells
share a visit, and what the standing stretches can tell of the zero (the drift at the dwells given the
standstills, Gaussian conditioning; the offset itself is unknown).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.independent.laws import Array, PowerLaw, TwoBranches
from benchmarks.independent.logs import (
    REST_NOISE,
    SETTLING,
    SPEED_NOISE,
    TEMPERATURE_NOISE,
    Errors,
    Log,
    Plan,
)

#: Steps of the derivatives, in each parameter.
_STEP = 1e-4


def least_errors(
    law: PowerLaw, log: Log, plan: Plan, errors: Errors, celsius: float, *, tare: bool
) -> dict[str, float]:
    """Return the standard error of ln a, b, c and, where the law has it, ln w_t at a temperature (degC)."""
    design = slopes(law, log, celsius)
    covariance = true_covariance(law, log, plan, errors, tare=tare)
    information = design.T @ np.linalg.solve(covariance, design)
    deviations = np.sqrt(np.diag(np.linalg.inv(information)))
    return dict(zip(("a", "b", "c", "w_t", "mixed"), deviations.tolist(), strict=False))


def slopes(law: PowerLaw, log: Log, celsius: float) -> Array:
    """Return the derivatives of ln torque of each dwell, shape (dwells, parameters)."""
    speed, film = log.dwell_speed, log.dwell_celsius
    moves = [{"a": law.a * np.exp(_STEP)}, {"b": law.b + _STEP}, {"c": law.c + _STEP}]
    if isinstance(law, TwoBranches):
        at = float(law.transition_speed(np.array(celsius)))
        law = replace(law, at=at, celsius=celsius)
        moves += [{"at": at * np.exp(_STEP)}, {"mixed": law.mixed + _STEP}]
    here = np.log(law.torque(speed, film))
    return np.column_stack([(np.log(replace(law, **m).torque(speed, film)) - here) / _STEP for m in moves])


def true_covariance(law: PowerLaw, log: Log, plan: Plan, errors: Errors, *, tare: bool) -> Array:
    """Return the covariance of ln torque of the dwells, shape (dwells, dwells)."""
    own = variance_of_means(log, plan, errors) + errors.scatter**2
    together = errors.visit**2 * (log.visit[:, None] == log.visit[None, :])
    covariance = np.diag(own) + together
    if tare:
        covariance += _of_zero(log, errors) / np.outer(log.dwell_torque, log.dwell_torque)
    if errors.heating:
        hotter = np.log(law.torque(log.dwell_speed, log.dwell_celsius + 1e-3) / log.dwell_torque) / 1e-3
        shift = hotter * log.heated * errors.heating / np.sqrt(12.0)  # evenly anywhere up to its bound
        covariance += np.outer(shift, shift)
    return np.asarray(covariance)


def variance_of_means(log: Log, plan: Plan, errors: Errors) -> Array:
    """Return the variance of ln of the mean torque of each settled dwell, from the noise of its samples."""
    n = np.maximum(log.samples - 3.0 * SETTLING * plan.rate, 2.0)
    rest = REST_NOISE * log.level / log.dwell_torque
    others = SPEED_NOISE**2 + (TEMPERATURE_NOISE / log.dwell_celsius) ** 2
    white = (errors.noise**2 + rest**2 + others) / n
    keep = np.exp(-1.0 / (plan.rate * errors.tau))
    # variance of the mean of n samples of an AR(1) series
    sums = n * (1.0 + keep) / (1.0 - keep) - 2.0 * keep * (1.0 - keep**n) / (1.0 - keep) ** 2
    return np.asarray(white + errors.slow_noise**2 * sums / n**2)


def _of_zero(log: Log, errors: Errors) -> Array:
    """Covariance (N m)^2 of the zero at the dwells, given the standing stretches."""
    prior, m = _prior_of_zero(log, errors), log.middle.size
    return np.asarray(prior[:m, :m] - zero_given_rest(log, errors) @ prior[m:, :m])


def zero_given_rest(log: Log, errors: Errors) -> Array:
    """Return the weights of the standing means in the zero at each dwell, shape (dwells, standstills)."""
    prior, m = _prior_of_zero(log, errors), log.middle.size
    samples = np.array(log.standing)[:, 1]
    seen = prior[m:, m:] + np.diag((REST_NOISE * log.level) ** 2 / samples)
    return np.asarray(np.linalg.solve(seen, prior[m:, :m]).T)


def _prior_of_zero(log: Log, errors: Errors) -> Array:
    """Covariance (N m)^2 of the zero at the dwells and then at the standstills; its mean is unknown."""
    standing = np.array(log.standing)[:, 0]
    times = np.concatenate([log.middle, standing])
    end = float(log.time[-1])
    prior = np.full((times.size, times.size), (100.0 * log.level) ** 2)
    if errors.drift:
        size = (errors.drift * log.level) ** 2
        prior += size * (
            np.minimum.outer(times, times) / end if errors.walk else np.outer(times, times) / end**2
        )
    return np.asarray(prior)
