"""The variables of a unit, as the library itself tells them."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import MissingFileError, ParameterError

#: What a library must have to be one of hersey's: the function that names its variables.
_TABLE = "hersey_variables"


@dataclass(frozen=True)
class Variable:
    """One variable: its number for FMI, name, type in FMI 3.0, causality and so on.

    ``unit`` is empty where the value is no quantity; ``start`` is where the drive says it. ``port`` is the
    coupling that it belongs to, empty if a drive has it with any; ``items`` are the names of an enumeration,
    numbered from 0.
    """

    reference: int
    name: str
    type: str
    causality: str
    variability: str
    unit: str
    start: str
    description: str
    port: str
    items: tuple[str, ...]


def variables_of(library: Path) -> tuple[Variable, ...]:
    """Return the variables that a library of this machine's kind tells.

    Raises
    ------
    MissingFileError
        If it is not there.
    ParameterError
        If it cannot be loaded, or is no library of hersey.
    """
    if not library.is_file():
        raise MissingFileError(
            f"this installation has no library for FMUs ({library.name} is missing). Build it with make "
            "build, or install a hersey wheel"
        )
    try:
        tell = getattr(ctypes.CDLL(str(library)), _TABLE)
    except (OSError, AttributeError) as error:
        raise ParameterError(f"{library} cannot be loaded: {error}") from None
    tell.restype = ctypes.c_char_p
    return table(tell().decode("utf-8"))


def table(text: str) -> tuple[Variable, ...]:
    """Return the variables of a table: a line each, its parts between tabs."""
    rows = [line.split("\t") for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return tuple(_variable(*row) for row in rows)


def _variable(reference: str, *others: str) -> Variable:
    name, kind, causality, variability, unit, start, description, port, items = others
    listed = tuple(items.split())
    return Variable(
        int(reference), name, kind, causality, variability, unit, start, description, port, listed
    )
