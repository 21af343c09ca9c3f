"""The speed of the drive behind a trace, and how far it may be off."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from hersey.damping.estimate import quantile
from hersey.errors import ParameterError

#: Half width of the 95 % interval of a drive speed of which nothing is stated, as a share of it.
DRIVE_SPEED_UNCERTAINTY = 1e-3
#: A channel of the drive speed is known to what the means of so many parts of it differ.
_PARTS = 10
#: A greater one would tell no drive.
_GREATEST_UNCERTAINTY = 0.5


def driven(
    given: ArrayLike | None, stated: float | None, shape: tuple[int, ...]
) -> tuple[float | None, float]:
    """Return the drive speed and its uncertainty, a share; of a channel from the means of its parts.

    Raises
    ------
    ParameterError
        If there is no such speed, or it is known too badly.
    """
    speed, uncertainty = _mean(given, stated, shape)
    if speed is not None and not (np.isfinite(speed) and speed > 0):
        raise ParameterError(f"drive_speed is {speed}: it must be greater than 0")
    if not 0 < uncertainty <= _GREATEST_UNCERTAINTY:
        raise ParameterError(
            f"drive_speed_uncertainty is {uncertainty:.4g}: it must be greater than 0 and at most "
            f"{_GREATEST_UNCERTAINTY} of the drive speed"
        )
    return speed, uncertainty


def _mean(
    given: ArrayLike | None, stated: float | None, shape: tuple[int, ...]
) -> tuple[float | None, float]:
    speed = np.asarray(given, dtype=float) if given is not None else None
    if speed is None or speed.ndim == 0:
        stated = DRIVE_SPEED_UNCERTAINTY if stated is None else stated
        return None if speed is None else float(speed), stated
    if speed.shape != shape or speed.size < _PARTS:
        raise ParameterError(
            f"drive_speed has shape {speed.shape}, but time has {shape}. Give one number, or equal lengths"
        )
    held = speed[np.isfinite(speed)]
    if held.size < _PARTS:
        raise ParameterError(f"drive_speed has {held.size} numbers. Give one number, or one per sample")
    means = np.array([np.mean(part) for part in np.array_split(held, _PARTS)])
    mean = float(np.mean(means))
    if stated is None and mean:
        error = float(np.std(means, ddof=1)) / float(np.sqrt(_PARTS))
        stated = DRIVE_SPEED_UNCERTAINTY + quantile(_PARTS - 1) * error / abs(mean)
    return mean, DRIVE_SPEED_UNCERTAINTY if stated is None else stated
