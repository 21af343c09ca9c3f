"""Tables that hersey itself wrote beside logs: known by their columns, and no logs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from hersey.errors import ChannelError, HerseyError
from hersey.files.reading import open_file
from hersey.log.text.column import split_unit

#: Columns of numbers that no log has together, by what such a table holds and the command that wrote it.
_TABLES = {
    ("fits", "hersey fit --each"): {"dwells", "speed from", "speed to", "c low", "c high"},
    ("dwells", "hersey campaign export"): {"run_id", "unit", "age", "settling_rows"},
    ("draws", "hersey posterior --out"): {"stick_speed", "fold_speed"},
}
#: Bytes of a first line that are read at the most.
_START = 4096


def own_table(names: Iterable[str]) -> str:
    """Return what a table with columns of these names is, if hersey wrote it; else nothing."""
    there = set(names)
    found = next((kind for kind, columns in _TABLES.items() if columns <= there), None)
    return "" if found is None else f"a table of the {found[0]} that '{found[1]}' wrote"


def own_table_in(path: Path) -> str:
    """Return what a file is, if it is a table that hersey wrote; only its first line is read."""
    try:
        if path.suffix == ".csv":
            with open_file(path) as file:
                head = file.read(_START).decode(errors="replace").partition("\n")[0]
            return own_table(split_unit(cell.strip('"\r'))[0] for cell in head.split(","))
        if path.suffix == ".parquet":
            from hersey.log.reading import list_channels

            return own_table(name for name, _ in list_channels(path))
    except HerseyError:  # which reading it says, too
        return ""
    return ""


def not_a_log(what: str, file: str) -> ChannelError:
    """Return the error for a table of its own that hersey is given as a log."""
    return ChannelError(f"{file} is {what}, not a log", remedy="give the logs without it")
