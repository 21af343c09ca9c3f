"""What departs from one law of friction: another shape of the law, coasts that differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.coast_down.fitting import TERMS, CoastFit, Trace
from hersey.damping.distributions import square_above

#: A departure is reported below this probability of a chance as large.
RARE = 1e-3
#: A departure of a smaller share of the torque does not matter: no inertia is known better.
SLIGHT = 0.005
#: Points on which a change of friction is followed through a coast.
_POINTS = 2000
#: Speeds at which a departure is measured.
_SPEEDS = 60


@dataclass(frozen=True)
class Departure:
    """How far friction departs from the law: probability by chance, and the largest share of the torque."""

    p_value: float
    share: float

    @property
    def shows(self) -> bool:
        """Whether it is no chance, and large enough to matter."""
        return self.p_value < RARE and self.share > SLIGHT


def deceleration(law: FloatArray, speed: FloatArray) -> FloatArray:
    """Return the deceleration, rad/s^2, at speeds, rad/s."""
    return np.asarray(law[0] + speed * (law[1] + speed * law[2]))


def of_shape(fit: CoastFit) -> Departure:
    """Return how far the speeds ask for a law of another shape: three more functions of speed are tried."""
    slowest, fastest = _range(fit)

    def shapes(speed: FloatArray) -> FloatArray:
        u = 2.0 * (speed - slowest) / (fastest - slowest) - 1.0
        log = 2.0 * np.log(np.maximum(speed, slowest) / slowest) / np.log(fastest / slowest) - 1.0
        own = np.stack([u**3, u**4, log**3], axis=-1)
        return own * deceleration(fit.law, np.full(1, 0.5 * (slowest + fastest)))

    extra = [_followed(fit, index, shapes(_course(fit, index)[1])) for index in range(len(fit.traces))]
    found = fit.added(extra)
    values = found.own()[0]
    freedom = max(found.noise.effective_rows / TERMS - values.size, 1.0)
    at = np.geomspace(slowest, fastest, _SPEEDS)
    change = shapes(at) @ values
    basis = np.stack([np.ones(at.size), at, at * at], axis=-1) / deceleration(fit.law, at)[:, None]
    relative = change / deceleration(fit.law, at)
    left = relative - basis @ np.linalg.lstsq(basis, relative, rcond=None)[0]  # the law takes the rest
    return Departure(found.p_value(freedom), float(np.max(np.abs(left))))


def of_coasts(fit: CoastFit) -> tuple[Departure, float]:
    """Return how far coasts differ in their torque, and the standard deviation between them as a share."""
    count = len(fit.traces)
    if count < 2:
        return Departure(1.0, 0.0), 0.0
    extra = []
    for index, trace in enumerate(fit.traces):
        own = np.zeros((trace.time.size, count))
        own[:, index] = -trace.time * deceleration(fit.law, fit.predicted(index, trace.time))
        extra.append(own[:, :-1] - own[:, -1:])  # the shares add up to 0
    added = fit.added(extra)
    values, covariance = added.own()
    shares = np.append(values, -values.sum())
    turn = np.vstack([np.eye(count - 1), -np.ones(count - 1)])
    errors = np.diag(turn @ covariance @ turn.T)
    between = float(np.sqrt(max(0.0, (np.sum(shares**2) - np.sum(errors)) / (count - 1))))
    freedom = max(added.noise.effective_rows / TERMS - count, 1.0)
    found = Departure(added.p_value(freedom), float(np.max(np.abs(shares))))
    return found, between if found.shows else 0.0


def of_bound(fit: CoastFit, law: FloatArray, distance: float) -> Departure:
    """Return how far the speeds ask for a negative term; ``law`` has none, at this distance squared."""
    at = np.geomspace(*_range(fit), _SPEEDS)
    change = deceleration(fit.law, at) / deceleration(law, at) - 1.0
    return Departure(float(square_above(distance, TERMS)), float(np.max(np.abs(change))))


def _range(fit: CoastFit) -> tuple[float, float]:
    ends = [fit.predicted(i, trace.time[[0, -1]]) for i, trace in enumerate(fit.traces)]
    fastest = max(float(each[0]) for each in ends)
    return max(min(float(each[1]) for each in ends), 1e-3 * fastest), fastest


def _course(fit: CoastFit, index: int) -> tuple[FloatArray, FloatArray]:
    """Times and speeds of a coast, dense enough to follow a change of friction."""
    trace: Trace = fit.traces[index]
    time = np.union1d(np.linspace(0.0, trace.time[-1], _POINTS), trace.time)
    return time, fit.predicted(index, time)


def _followed(fit: CoastFit, index: int, change: FloatArray) -> FloatArray:
    """Change of speed at the rows of a coast, by a change of the deceleration along its course."""
    time, speed = _course(fit, index)
    rate = deceleration(fit.law, speed)[:, None]
    share = change / rate
    steps = np.diff(time)[:, None] * (share[1:] + share[:-1]) / 2.0
    summed = np.vstack([np.zeros((1, change.shape[1])), np.cumsum(steps, axis=0)])
    return np.asarray((-rate * summed)[np.searchsorted(time, fit.traces[index].time)])
