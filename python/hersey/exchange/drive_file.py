"""`resources/drive.txt`: what a unit's library reads of its drive, in SI, a ``name = value`` a line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hersey.errors import ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag, BesideShape, Wire


def drive_values(train: Drivetrain, drag: AnyDrag) -> dict[str, Wire]:
    """Return what the file holds of a drivetrain and a drag; what is not stated is left out.

    Raises
    ------
    ParameterError
        If the drag has no wire form.
    """
    if not isinstance(drag, BesideShape):
        raise ParameterError(f"an FMU cannot use a drag of type {type(drag).__name__}")
    values: dict[str, Wire] = {"stiffness": train.stiffness, "mass": train.mass}
    if train.grip is not None:
        values["grip"] = train.grip
    return values | drag.wire()


def drive_text(values: Mapping[str, Wire], remarks: Sequence[str] = ()) -> str:
    """Return the file: remarks first, numbers to their last digit."""
    lines = [f"# {remark}" for remark in remarks]
    return "\n".join([*lines, *(f"{name} = {_written(value)}" for name, value in values.items())]) + "\n"


def _written(value: Wire) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return repr(float(value))
    return " ".join(repr(float(number)) for number in value)
