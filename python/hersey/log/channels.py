"""Which column plays which role: found by name and unit, or named by the user."""

from __future__ import annotations

import re
from dataclasses import dataclass

from hersey.errors import ChannelError, UnitError, WrongKindError
from hersey.log.text.layout import Column
from hersey.spelling import printable
from hersey.units import KINDS, Conversion, conversion

#: Roles of a log's columns, in the order in which they are asked for.
ROLES = ("time", "torque", "speed", "temperature")

_NAMES = {
    "time": r"t|time.*|.*\btime|.*datetime|.*zeit|timestamp|elapsed.*|.*seconds|epoch.*|unix.*",
    "torque": r".*torque.*|tq.*|.*\btq|.*moment.*|m",
    "speed": r".*speed.*|.*velocity.*|.*rpm.*|.*omega.*|.*drehzahl.*|n|w|ω",
    "temperature": r".*temp.*|.*thermistor.*|.*heater.*|.*thermocouple.*|.*film t.*",
}
#: Columns named in a message at the most.
_SHOWN = 40
_SETPOINT = re.compile(r"\b(set|cmd|command|commanded|target|demand|reference|soll|nominal)", re.IGNORECASE)


@dataclass(frozen=True)
class ChannelChoice:
    """What the user says of a role: column name and unit, empty where the file is to tell."""

    name: str = ""
    unit: str = ""


def find_channel(
    role: str, columns: tuple[Column, ...], choice: ChannelChoice, file: str
) -> tuple[Column, Conversion] | None:
    """Return the column of a role and the conversion to SI, or None if no column comes near it.

    Raises
    ------
    ChannelError
        If several columns could play the role, or the named one is not there.
    UnitError
        If the column that must be it has no unit, an unknown one, or one of another kind.
    """
    if choice.name:
        return _with_unit(role, _named(role, columns, choice.name, file), choice, file)
    named = [c for c in columns if re.fullmatch(_NAMES[role], c.name, re.IGNORECASE)]
    measured = [c for c in named if not _SETPOINT.search(c.name)] or named
    # a column of another kind of unit is out; one without a unit could still be it
    candidates = [c for c in measured if _could_be(role, c)] or measured
    if not named:
        candidates = [c for c in columns if c.unit and _could_be(role, c, surely=True)]
    if not candidates:
        return None
    if len(candidates) > 1:
        listed = _either([str(c) for c in candidates])
        if len({c.path for c in candidates}) == 1:
            raise _repeated(role, candidates, file)
        raise ChannelError(f"{file}: {role} could be {listed}: choose with --{role} '{candidates[0].path}'")
    return _with_unit(role, candidates[0], choice, file)


def no_channel(role: str, columns: tuple[Column, ...], file: str) -> ChannelError:
    """Return the error for a role that no column plays."""
    return ChannelError(f"{file}: no {role} column among {_listed(columns)}: name it with --{role}")


def called(name: str, columns: tuple[Column, ...]) -> list[Column]:
    """Return the columns that a person may mean by a name; ``name#2`` is the second one of a name."""
    name = printable(name)  # as columns are known
    exact = [c for c in columns if name in _spellings(c)]
    same = exact or [c for c in columns if name.lower() in {s.lower() for s in _spellings(c)}]
    repeated = re.fullmatch(r"(.+)#([1-9][0-9]?)", name)
    if same or not repeated:
        return same
    same = [c for c in columns if repeated[1].lower() in {s.lower() for s in _spellings(c)}]
    return same[int(repeated[2]) - 1 : int(repeated[2])]


def _spellings(c: Column) -> set[str]:
    with_unit = (f"{c.path} ({c.unit})", f"{c.name} ({c.unit})", f"{c.name} [{c.unit}]", f"{c.name}_{c.unit}")
    return {c.name, c.path, str(c), *with_unit}


def _named(role: str, columns: tuple[Column, ...], name: str, file: str) -> Column:
    same = called(name, columns)
    if not same:
        raise ChannelError(f"{file}: --{role}: there is no column '{name}'; the file has {_listed(columns)}")
    if len(same) > 1 and len({c.path for c in same}) == 1:
        raise _repeated(role, same, file)
    if len(same) > 1:
        listed = _either([str(c) for c in same])
        raise ChannelError(f"{file}: --{role}: '{name}' could be {listed}: say --{role} '{same[0].path}'")
    return same[0]


def _repeated(role: str, columns: list[Column], file: str) -> ChannelError:
    path = columns[0].path
    listed = _either([f"{path}#{i + 1}" for i in range(len(columns))])
    return ChannelError(f"{file}: {len(columns)} columns are called '{path}': choose with --{role} {listed}")


def _either(names: list[str]) -> str:
    """Names to choose from, the first of them where there are very many."""
    listed = " or ".join(f"'{name}'" for name in names[:_SHOWN])
    return listed + (f" or {len(names) - _SHOWN} more" if len(names) > _SHOWN else "")


def _listed(columns: tuple[Column, ...]) -> str:
    """Columns with their units, the first of them where there are very many."""
    listed = ", ".join(f"'{c}'" for c in columns[:_SHOWN])
    return listed + (f" and {len(columns) - _SHOWN} more" if len(columns) > _SHOWN else "")


def _could_be(role: str, column: Column, surely: bool = False) -> bool:
    """Whether the unit allows the role; one that is missing or unknown does, unless asked to be sure."""
    if role == "time" and re.search("rad|rev|turn", column.unit):  # angles have no dimension
        return False
    try:
        return bool(column.unit and conversion(role, column.unit)) or not surely
    except WrongKindError:
        return False
    except UnitError:
        return not surely


def _with_unit(role: str, column: Column, choice: ChannelChoice, file: str) -> tuple[Column, Conversion]:
    unit = choice.unit or column.unit
    if not unit:
        example = KINDS[role][1]
        raise UnitError(
            f"{file}: column '{column.path}' has no unit: write '{column.name} [{example}]' in the header, "
            f"add a row of units, or say --{role}-unit '{example}'"
        )
    try:
        return column, conversion(role, unit)
    except UnitError as error:
        raise UnitError(f"{file}: column '{column.path}': {error}") from None
