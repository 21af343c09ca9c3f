"""One unit per quantity, in words, tables and charts of a report."""

from __future__ import annotations

import numpy as np

from hersey.damping.dwells import SteadyPoints
from hersey.stability.operating_map import OperatingMap

#: From so much on torque is shown in N m, N m.
_LARGE = 1.0


def display_units(points: SteadyPoints, map_: OperatingMap | None) -> dict[str, str]:
    """Return the unit that each quantity is shown in; torque by the greatest that is told."""
    told = [float(np.abs(points.column("torque")).max())]
    if map_ is not None:
        told += [float(np.max(map_.holding)), map_.torque_limit or 0.0]
    return {
        "torque": "N·m" if max(told) >= _LARGE else "mN·m",
        "belt_speed": "mm/s",
        "roll_speed": "rpm",
        "temperature": "°C",
        "force": "N",
    }
