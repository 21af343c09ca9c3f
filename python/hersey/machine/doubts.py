"""Values of a machine file that are possible, but so unusual that a unit is probably wrong."""

from __future__ import annotations

import math
from collections.abc import Iterator

from hersey.machine.limits import OperatingPoint
from hersey.units import celsius

#: Natural frequencies of a belt on its drive, Hz, and the coldest temperature, K, that need no question.
_SLOWEST, _FASTEST, _COLDEST = 0.5, 500.0, 250.0


def doubts(
    stiffness: float, mass: float, stick_speed: float, points: tuple[OperatingPoint, ...]
) -> Iterator[str]:
    """Yield what is unusual, and the value that was probably meant.

    Parameters
    ----------
    stiffness, mass, stick_speed
        N/m, kg and m/s, at the belt.
    points
        Operating points.
    """
    frequency = math.sqrt(stiffness / mass) / (2 * math.pi)
    if not _SLOWEST <= frequency <= _FASTEST:
        slow = frequency < _SLOWEST
        meant = (
            f'stiffness = "{stiffness:.4g} N/mm" or mass = "{mass:.4g} g"'
            if slow
            else f'mass = "{1e3 * mass:.4g} kg" or stiffness = "{stiffness / 1e3:.4g} N/m"'
        )
        yield (
            f"stiffness {stiffness:.4g} N/m and mass {mass:.4g} kg give a natural frequency of "
            f"{frequency:.2g} Hz; usual are {_SLOWEST:g} to {_FASTEST:g} Hz. Check both units. "
            f"Was this meant: {meant}?"
        )
    slowest = min((point.speed for point in points), default=math.inf)
    if stick_speed >= slowest:
        yield (
            f"stick_speed {1e3 * stick_speed:.4g} mm/s is not below the slowest operating point, "
            f"{1e3 * slowest:.4g} mm/s. Check its unit. Was this meant: "
            f'stick_speed = "{stick_speed:.4g} mm/s"?'
        )
    for point in points:
        if point.temperature < _COLDEST:
            kelvin = point.temperature
            yield (
                f"the temperature of operating point '{point.name}', {kelvin:.4g} K, is "
                f'{celsius(kelvin):.4g} degC. Was this meant: temperature = "{kelvin:.4g} degC"?'
            )
