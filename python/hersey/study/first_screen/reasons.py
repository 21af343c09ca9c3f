"""Why something cannot be computed, as the first screen says it: names, units, and a way out."""

from __future__ import annotations

import math

from hersey.errors import HerseyError, ParameterError, UnfinishedError
from hersey.study.first_screen.words import figures, mm

#: Quantities of a machine file that the core names, as people call them, and their units.
_NAMED = {
    "stick_speed": "the stick speed",
    "transition_speed": "the transition speed",
    "drive_speed": "the drive speed",
    "target_speed": "the target speed",
    "stiffness": "the stiffness",
    "mass": "the mass",
    "transition_force": "the drag at the transition",
    "grip": "the grip",
    "rest_force": "the drag of the no-load torque",
}
#: Where a value must lie, by `ParameterError.bound`.
_BOUNDS = {"above": "be greater than", "at most": "not exceed", "below": "be less than"}
_UNITS = {"stiffness": "N/m", "mass": "kg", "transition_force": "N", "grip": "N", "rest_force": "N"}


def in_words(error: HerseyError) -> str:
    """Return the reason without names of code, with units, and with what to do about it."""
    if isinstance(error, UnfinishedError):
        return (
            "the simulation did not finish. Check the units of stiffness, mass and stick speed in "
            "the machine file"
        )
    if not isinstance(error, ParameterError) or error.quantity is None or error.value is None:
        return str(error)
    if error.quantity == "stick_speed" and error.limit:
        return (
            f"the stick speed, up to {mm(error.value)} mm/s here, reaches the transition speed, "
            f"{mm(error.limit)} mm/s. State a lower stick speed"
        )
    name = _NAMED.get(error.quantity, error.quantity.replace("_", " "))
    if not math.isfinite(error.value):
        return f"{name} is {error.value}: it must be finite"
    if error.bound is None or error.limit is None:
        return str(error)
    value, limit = (_amount(error.quantity, each, error.unit) for each in (error.value, error.limit))
    return f"{name} is {value}: it must {_BOUNDS[error.bound]} {limit}"


def _amount(quantity: str, value: float, unit: str | None) -> str:
    if quantity.endswith("speed"):
        shown = mm(value) if value > 0 else f"{1e3 * value:.3g}"
        return f"{shown} mm/s"
    text = figures(value) if 0.01 <= value < 1e5 else f"{value:.3g}"
    return f"{text} {_UNITS.get(quantity, unit or '')}".rstrip()
