"""Rotational quantities in the place of those at the surface that slides; the radius leads to these."""

from __future__ import annotations

from hersey.errors import UnitError
from hersey.units import parse

#: Units that make a torque a torsional stiffness; N*m alone is a slip of N/m too.
_ANGLES = ("rad", "deg", "°", "rev")
#: For a kind at the surface: the rotational one, and the power of the radius (m) that leads from it.
_ROTATIONAL = {
    "belt speed": ("speed", 1),
    "stiffness": ("torsional stiffness", -2),
    "mass": ("moment of inertia", -2),
}


def has_angle(text: str) -> bool:
    """Return whether a unit contains an angle."""
    return any(each in text for each in _ANGLES)


def turning_at_radius(kind: str, text: str, radius: float | None) -> float | None:
    """Return the SI value at a radius (m) of a rotational quantity; None if it is none, or without radius.

    Examples
    --------
    >>> turning_at_radius("stiffness", "200 N*m/rad", 0.5)
    800.0
    """
    rotational, power = _ROTATIONAL.get(kind, ("", 0))
    if not rotational or not radius or (kind == "stiffness" and not has_angle(text)):
        return None
    try:
        return parse(rotational, text) * radius**power
    except UnitError:
        return None


def at_radius(kind: str, text: str, radius: float | None) -> float:
    """Return the SI value of a quantity at a radius (m), which may be written as a rotational one.

    Raises
    ------
    UnitError
        If it is of neither kind, or is rotational and the radius is not known.
    """
    turning = turning_at_radius(kind, text, radius)
    return parse(kind, text) if turning is None else turning
