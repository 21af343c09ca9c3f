"""The lubricant of a file that holds nothing else, or of a machine file."""

from __future__ import annotations

from pathlib import Path

from pydantic.dataclasses import dataclass

from hersey.errors import ParameterError
from hersey.files.toml import Table, read_tables, read_toml
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.machine import read_machine
from hersey.machine.nip import LubricantTable


@dataclass(frozen=True)
class _File(Table):
    lubricant: LubricantTable | None = None


def read_lubricant(path: str | Path) -> Lubricant:
    """Return the lubricant of a file with a table ``[lubricant]``, be it a machine file.

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key.
    """
    path = Path(path)
    if "drivetrain" in read_toml(path):
        found = read_machine(path).lubricant
    else:
        table = read_tables(path, _File).lubricant
        found = None if table is None else table.lubricant()
    if found is None:
        raise ParameterError(
            f'{path.name} has no [lubricant]. Write it, e.g. [lubricant], then example = "light machine oil"'
        )
    return found
