"""Tables that hersey itself wrote beside logs: known by their columns, and no logs."""

from __future__ import annotations

from collections.abc import Iterable

from hersey.errors import ChannelError

#: Columns of numbers that no log has together, by what such a table holds and the command that wrote it.
_TABLES = {
    ("fits", "hersey fit"): {"dwells", "speed from", "speed to", "c low", "c high"},
    ("dwells", "hersey campaign export"): {"run_id", "unit", "age", "settling_rows"},
    ("draws", "hersey posterior"): {"stick_speed", "fold_speed"},
}


def own_table(names: Iterable[str]) -> str:
    """Return what a table with columns of these names is, if hersey wrote it; else nothing."""
    there = set(names)
    found = next((kind for kind, columns in _TABLES.items() if columns <= there), None)
    return "" if found is None else f"a table of the {found[0]} that '{found[1]}' wrote"


def not_a_log(what: str, file: str) -> ChannelError:
    """Return the error for a table of its own that hersey is given as a log."""
    return ChannelError(f"{file} is {what}, not a log", remedy="give the logs without it")
