"""Drag curves beyond the dwells, where no law was tested.

Where there are dwells a draw follows its law. Below the slowest dwell friction may go on rising as a power of
speed, or saturate. Every draw starts there with the slope of its law at the slowest dwell, and the slope
fades over a random length in ln speed (long: a power law; short: saturation). Where the law itself steepens,
as beside a minimum, a random part of that is kept. Below dwells whose torque only rises, boundary friction
may be hidden: each draw has some, of a random size and place. Above the fastest dwell each draw goes on as
its law, with a slope that becomes larger or smaller by a random factor.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.curves.fitting import FittedLaw
from hersey.damping.distributions import normal_above

#: Latents of a curve beyond the dwells: fading, drift below, part of the steepening, drift above, size and
#: place of boundary friction that no dwell reaches.
BEYOND = 6
#: Median of the length in ln speed over which the slope fades, and the standard deviation of its logarithm.
FADES = (8.0, 1.5)
#: Standard deviations of the drift of the slope below the dwells, and of ln of its factor above them.
DRIFT, STEEPER = 0.08, 0.5
#: Boundary friction below dwells whose torque only rises: median over the drag at the slowest dwell, standard
#: deviation of its logarithm, and the power of speed with which it decays (Armstrong-Helouvry 1994).
HIDDEN, DECAY = (0.5, 1.2), 1.2
#: Slowest dwell over the speed at which it has decayed by a factor e, at the least, and the standard
#: deviation of the logarithm of that ratio.
PLACE = (3.5, 0.8)
#: Deviations of that factor beyond which drag that rises might fall.
_MOST = 4.0
#: Step in ln speed by which the slope at the slowest dwell is taken.
_STEP = 0.05
#: Points beside the slower ones that their slopes take.
_BESIDE = 2


def log_torque_beyond(
    law: FittedLaw, numbers: FloatArray, latent: FloatArray, z: FloatArray, shape: float
) -> FloatArray:
    """Return ln torque of draws at ln(speed/reference) and a temperature's s(T), shape (draws, speeds).

    Parameters
    ----------
    numbers, latent
        Of the law, and of what is beyond the dwells: shapes (draws, numbers), (draws, `BEYOND`).
    z
        Ascending, shape (speeds,).
    """
    inside = law.log_torque(numbers, z, shape)
    shift = law.scaled_speed(numbers, np.zeros(1), shape)[:, 0]
    low, high = (end - shift for end in law.reach)
    out = inside.copy()
    fast = z > np.min(high)
    if fast.any():
        above = np.maximum(z[fast] - high[:, None], 0.0)
        at_high = law.log_torque(numbers, high[:, None], shape)
        factor = np.exp(STEEPER * np.clip(latent[:, 3:4], -_MOST, _MOST) * -np.expm1(-above))
        out[:, fast] = np.where(above > 0.0, at_high + (inside[:, fast] - at_high) * factor, inside[:, fast])
    slow = int(np.count_nonzero(z < np.max(low)))
    if not slow:
        return out
    slow = min(slow + _BESIDE, z.size)  # the slopes there take their neighbours
    below = np.maximum(low[:, None] - z[:slow], 0.0)
    at_edge = law.log_torque(numbers, low[:, None] + np.array([-_STEP, 0.0, _STEP]), shape)
    edge = (at_edge[:, 2] - at_edge[:, 0]) / (2.0 * _STEP)
    down = at_edge[:, 1:2] - _gone(inside[:, :slow], edge, below, latent, z[:slow])
    rises = edge > 0.0
    if np.any(rises):
        down[rises] += _hidden(below[rises], latent[rises])
    out[:, :slow] = np.where(below > 0.0, down, out[:, :slow])
    return out


def _hidden(below: FloatArray, latent: FloatArray) -> FloatArray:
    """Ln of the factor by which boundary friction raises drag below dwells that do not show it."""
    size = HIDDEN[0] * np.exp(HIDDEN[1] * latent[:, 4:5])
    ratio = PLACE[0] * np.exp(PLACE[1] * np.abs(latent[:, 5:6]))
    share = np.exp(-((ratio * np.exp(-below)) ** DECAY)) - np.exp(-(ratio**DECAY))
    return np.asarray(np.log1p(size * np.maximum(share, 0.0)))


def _gone(
    inside: FloatArray, edge: FloatArray, below: FloatArray, latent: FloatArray, z: FloatArray
) -> FloatArray:
    """Change of ln torque from the slowest dwell down to each speed, by a slope that stays negative.

    Friction that falls towards rest is known of no boundary.
    """
    fades = FADES[0] * np.exp(FADES[1] * latent[:, :1])
    fading = np.exp(-below / fades)
    steeper = np.minimum(np.gradient(inside, z, axis=1) - edge[:, None], 0.0)
    slope = (edge[:, None] + normal_above(-latent[:, 2:3]) * steeper) * fading
    slope = slope + DRIFT * latent[:, 1:2] * (1.0 - np.exp(-below))
    slope = np.where(edge[:, None] < 0.0, np.minimum(slope, 0.0), slope)
    middle = 0.5 * (slope[:, 1:] + slope[:, :-1])
    steps = -np.diff(below, axis=1)  # what of each step lies below the edge
    total = np.cumsum((middle * steps)[:, ::-1], axis=1)[:, ::-1]
    return np.concatenate([total, np.zeros((total.shape[0], 1))], axis=1)
