"""Units that a file states and that a person replaced by others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from hersey.errors import Setting, UnitError
from hersey.log.roles import role_conversion
from hersey.log.text.column import Column
from hersey.log.torque_log import LogFile
from hersey.schema.warning import Warning
from hersey.units import Conversion, without_factor

#: Kind of the warning.
UNIT_REPLACED = "unit replaced"


def replaced_units(channels: Mapping[str, tuple[Column, Conversion]]) -> tuple[Warning, ...]:
    """Return a warning for each channel, by role, that is read in another unit than the file states.

    A factor or sign on the same unit replaces nothing, nor does a unit where that of the file is none of the
    role.
    """
    return tuple(
        Warning(
            UNIT_REPLACED,
            "'{channel}' is in {stated}, but it is read in {unit}",
            severity="watch",
            remedy="if the file is right, omit {how}, or the unit of the {role} in its mapping",
            channel=column.path,
            role=role,
            stated=column.unit,
            unit=used.unit,
            how=Setting(role, "unit"),
        )
        for role, (column, used) in channels.items()
        if column.unit and _differ(role, column.unit, used.unit)
    )


def replaced_in(files: Iterable[LogFile]) -> list[Warning]:
    """Return these warnings of files that were read, each with the name of its file."""
    return [each.within(file.name) for file in files for each in file.warnings if each.kind == UNIT_REPLACED]


def _differ(role: str, stated: str, used: str) -> bool:
    """Whether two units of a role, without their factors, do not mean the same."""
    try:
        (kind, one), (other_kind, other) = (
            role_conversion(role, without_factor(unit)) for unit in (stated, used)
        )
    except (UnitError, KeyError):
        return False
    return (kind, one.scale, one.offset) != (other_kind, other.scale, other.offset)
