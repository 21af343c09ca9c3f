"""The temperatures and speeds that a map shows where none are asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray, numbers_of
from hersey.damping.surface import DampingSurface
from hersey.errors import ParameterError
from hersey.machine.limits import OperatingPoint
from hersey.motion.drag import PowerDrag
from hersey.stability.operating_map.edges import check_temperatures

if TYPE_CHECKING:
    pass

#: Temperatures and speeds of a map that are not given.
TEMPERATURES, SPEEDS = 61, 81
#: Share of the measured span of temperature shown beyond it on either side, and the least of it in K.
MARGIN, LEAST_MARGIN = 0.15, 5.0
#: Greatest speed shown, as a multiple of the fastest dwell, where V* lies higher.
_REACH = 10.0


def shown_temperatures(
    surface: DampingSurface, drag: PowerDrag, points: Sequence[OperatingPoint], given: ArrayLike | None
) -> FloatArray | None:
    """Return temperatures (K) as given, or those measured and a little beyond; None for an isothermal law."""
    if surface.temperature_range is None or not drag.varies_with_temperature:
        if given is not None:
            raise ParameterError("the fit is isothermal. Do not give temperatures")
        return None
    if given is not None:
        kelvin = np.atleast_1d(numbers_of("temperatures", given))
        if kelvin.ndim > 1 or kelvin.size < 2 or not np.all(np.diff(kelvin) > 0):
            raise ParameterError("temperatures must be at least two, in ascending order")
        check_temperatures(kelvin, drag)
        return kelvin
    check_temperatures(np.array([p.temperature for p in points]), drag)
    cold, hot = surface.temperature_range
    margin = max(MARGIN * (hot - cold), LEAST_MARGIN)
    cold, hot = (f([end, *(p.temperature for p in points)]) for f, end in ((min, cold), (max, hot)))
    # A law in degC has no meaning at 0 degC, and all speeds go to nought there.
    least = cold - 0.5 * (cold - drag.temperature_zero)
    return np.linspace(max(cold - margin, least), hot + margin, TEMPERATURES)


def shown_speeds(
    edges: Mapping[str, FloatArray],
    measured: tuple[float, float],
    points: Sequence[OperatingPoint],
    greatest: float | None,
    given: ArrayLike | None,
) -> FloatArray:
    """Return speeds (m/s) as given, or all that bands, dwells and points need."""
    if given is not None:
        speeds = np.atleast_1d(numbers_of("speeds", given))
        if speeds.ndim > 1 or speeds.size < 2 or not (speeds[0] > 0 and np.all(np.diff(speeds) > 0)):
            raise ParameterError("speeds must be at least two, above 0 and in ascending order")
        return speeds
    wanted = [point.speed for point in points]
    low = max(float(edges["lower"].min()), measured[0] / _REACH)
    high = min(float(edges["upper"].max()), measured[1] * _REACH)
    if greatest is not None and greatest < 3.0 * measured[1]:
        wanted.append(greatest)
    return np.geomspace(0.7 * min(low, measured[0], *wanted), 1.25 * max(high, measured[1], *wanted), SPEEDS)
