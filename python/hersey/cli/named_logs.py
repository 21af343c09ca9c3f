"""The logs that words of a command line name, without tables that hersey wrote beside them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from hersey.cli.terminal import note
from hersey.errors import HerseyError
from hersey.files.patterns import files_of
from hersey.files.reading import open_file

#: Bytes of a first line that are read at the most.
_START = 4096


def logs_of(words: Sequence[Path], tables: Sequence[Path | None]) -> list[Path]:
    """Return the files that names and patterns stand for; a table that hersey wrote is skipped, and noted.

    It is skipped where a pattern matched it. It is also skipped where the command writes it again, as one of
    ``tables``: a shell may have put the files in the place of the pattern. Any other is refused when read.
    """
    files = files_of(words)
    again = {os.path.realpath(path) for path in tables if path is not None}
    doubtful = [path for path in files if path not in words or os.path.realpath(path) in again]
    if not doubtful or len(files) == 1:
        return files
    skipped = {path: what for path in doubtful if (what := _own_table_in(path))}
    if len(skipped) == len(files):
        return files
    note(*(f"{path} is skipped: it is {what}, not a log." for path, what in skipped.items()))
    return [path for path in files if path not in skipped]


def _own_table_in(path: Path) -> str:
    """What a file is, if it is a table that hersey wrote; of a text only the first line is read."""
    from hersey.log.own_tables import own_table
    from hersey.log.reading import list_channels
    from hersey.log.text.column import split_unit

    try:
        if path.suffix == ".csv":
            with open_file(path) as file:
                head = file.read(_START).decode(errors="replace").partition("\n")[0]
            return own_table(split_unit(cell.strip('"\r'))[0] for cell in head.split(","))
        if path.suffix == ".parquet":
            return own_table(name for name, _ in list_channels(path))
    except HerseyError:  # which reading it says, too
        return ""
    return ""
