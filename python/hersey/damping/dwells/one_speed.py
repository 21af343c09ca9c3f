"""The speeds that a log holds, however long each lasts."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import OneSpeedError, way_in
from hersey.log.torque_log import STANDING, TorqueLog

#: Speeds this near, as a share, are one.
SAME = 0.05
#: Share of the rows in motion that one speed must have to be the only one.
_ONLY = 0.8
#: Speeds that are looked for at the most.
_MOST = 5


def speeds_held(speed: FloatArray, standing: float = STANDING) -> list[tuple[float, float]]:
    """Return speeds without sign, the most frequent first, each with its share of the rows in motion.

    At or below ``standing``, in the unit of the speeds, the drive stands.
    """
    left = np.sort(speed[speed > standing])
    rows = left.size
    found: list[tuple[float, float]] = []
    while left.size and len(found) < _MOST:
        ends = np.searchsorted(left, left * (1.0 + SAME), side="right")
        first = int(np.argmax(ends - np.arange(left.size)))
        held = float(np.median(left[first : ends[first]]))
        near = np.abs(left - held) <= SAME * held
        found.append((held, float(np.sum(near)) / rows))
        left = left[~near]
    return found


def only_speed(speed: FloatArray, standing: float = STANDING) -> float | None:
    """Return the one speed that is held whenever the drive moves, in the unit given, or None."""
    found = speeds_held(speed, standing)
    return found[0][0] if found and found[0][1] >= _ONLY else None


def of_one_speed(reason: str, log: TorqueLog) -> OneSpeedError:
    """Return the error of a log of one speed, with what it is good for; a terminal adds the line."""
    way = "To follow friction over time, use hersey.trend(log)" if way_in() == "python" else ""
    return OneSpeedError(reason, files=tuple(each.name for each in log.files), remedy=way)


def is_one_speed(log: TorqueLog) -> bool:
    """Return whether a log holds one speed whenever the drive turns."""
    speed = np.abs(np.concatenate([run.speed for run in log.runs]))
    return only_speed(speed, log.domain.standing) is not None
