"""`resources/drive.txt`: what a unit's library reads of its drive, in SI, a ``name = value`` a line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from hersey.errors import ParameterError
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag, BesideShape, Drag, DragTable, PowersOfTemperature

#: What one line holds.
Value = str | float | Sequence[float]
#: Law of viscosity by the name of its first coefficients.
_VISCOSITIES = {("prefactor", "activation_energy"): "arrhenius", ("prefactor", "slope"): "vogel"}
_WALTHER = "walther"
_POWERS = (
    *("reference_temperature", "temperature_zero"),
    *("force_temperature_exponent", "speed_temperature_exponent", "rest_temperature_slope"),
)
_NEAR_REST = ("bristle_stiffness", "bristle_damping", "static_force")


def drive_values(train: Drivetrain, drag: AnyDrag) -> dict[str, Value]:
    """Return what the file holds of a drivetrain and a drag; what is not stated is left out.

    Raises
    ------
    ParameterError
        If the library knows no such law.
    """
    values: dict[str, Value] = {"stiffness": train.stiffness, "mass": train.mass}
    if train.grip is not None:
        values["grip"] = train.grip
    if isinstance(drag, Drag):
        values |= _power(drag)
    elif isinstance(drag, DragTable):
        values |= {"law": "table", "speeds": drag.speeds, "forces": drag.forces, **_temperature_law(drag)}
    elif isinstance(drag, MixedDrag):
        values |= _mixed(drag)
    else:
        raise ParameterError(f"a unit knows no drag of the kind {type(drag).__name__}")
    assert isinstance(drag, BesideShape)
    near = {name: getattr(drag, name) for name in _NEAR_REST}
    values |= {name: value for name, value in near.items() if value is not None}
    return values | {
        "stick_speed": drag.stick_speed,
        "closure": drag.closure,
        "rest_force": drag.rest_force,
        "rest_damping": drag.rest_damping,
    }


def _power(drag: Drag) -> dict[str, Value]:
    names = ["transition_force", "transition_speed", "ehl_exponent", "mixed_exponent"]
    if drag.static_growth:
        names += ["static_growth", "static_growth_time"]
    return {"law": "power", **_temperature_law(drag), **{name: getattr(drag, name) for name in names}}


def _temperature_law(drag: PowersOfTemperature) -> dict[str, Value]:
    if drag.reference_temperature is None:
        return {"temperature_law": "none"}
    return {"temperature_law": "power", **{name: getattr(drag, name) for name in _POWERS}}


def _mixed(drag: MixedDrag) -> dict[str, Value]:
    lubricant, friction = drag.contact.lubricant, drag.contact.friction
    kelvin = np.asarray(drag.temperature, dtype=float)
    coefficients = dict(lubricant.law.coefficients)
    first, second, *_ = coefficients
    return {
        "law": "mixed",
        "numbers": [float(number) for number in drag.contact.numbers(kelvin)],
        "viscosity": float(lubricant.viscosity(kelvin)),
        "temperature_law": _VISCOSITIES.get((first, second), _WALTHER),
        "viscosity_numbers": list(coefficients.values()),
        "reference_temperature": drag.temperature,
        "boundary_temperature_slope": float(friction.slope / friction.at(kelvin)),
        "rest_temperature_slope": drag.rest_temperature_slope,
    }


def drive_text(values: Mapping[str, Value], remarks: Sequence[str] = ()) -> str:
    """Return the file: remarks first, numbers to their last digit."""
    lines = [f"# {remark}" for remark in remarks]
    return "\n".join([*lines, *(f"{name} = {_written(value)}" for name, value in values.items())]) + "\n"


def _written(value: Value) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return repr(float(value))
    return " ".join(repr(float(number)) for number in value)
