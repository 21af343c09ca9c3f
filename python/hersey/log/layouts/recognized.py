"""A file that is no log as it stands: read by the layout that it shows, or with the advice to describe it."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from hersey.errors import (
    HerseyError,
    MissingFileError,
    ParameterError,
    Setting,
    UnitError,
    UnreadableLogError,
    way_in,
)
from hersey.log.layouts.presets import PRESETS
from hersey.log.layouts.proposing import Proposal, proposed_layout
from hersey.log.layouts.table import LogLayout
from hersey.log.torque_log import LogFile
from hersey.schema.warning import Warning

#: Kind of the warning of a file that was read by a layout which nobody stated.
LAYOUT_RECOGNIZED = "layout recognized"
#: What writes a proposal.
_SAVE_MAPPING = Setting("save_mapping", "switch")


def recognized(
    error: HerseyError, files: Sequence[Any], channels: Mapping[str, str], units: Mapping[str, str]
) -> Proposal:
    """Return the layout by which files that cannot be read as they stand are read.

    ``channels`` and ``units`` are those that a user states, by role.

    Raises
    ------
    HerseyError
        The error of the files, with the advice to describe their layout where one is known, but is a guess.
    """
    first = files[0]
    if isinstance(error, MissingFileError | ParameterError) or not isinstance(first, str | Path):
        raise error
    if not Path(first).is_file():
        raise error
    rows = isinstance(error, UnreadableLogError)
    proposal = proposed_layout(Path(first), channels, units, is_refused=rows)
    if proposal is None or (proposal.is_doubtful and (len(files) > 1 or isinstance(error, UnitError))):
        raise error
    if proposal.is_doubtful:
        raise _with_advice(error, Path(first)) from None
    return proposal


def layout_recognized(layout: LogLayout) -> Warning:
    """Return that a file was read by a layout which nobody stated."""
    if layout.preset:
        of = PRESETS[layout.preset].of
        words = "recognized as {instrument}"
        return Warning(LAYOUT_RECOGNIZED, words, severity="watch", instrument=of, layout=in_words(layout))
    return Warning(
        LAYOUT_RECOGNIZED,
        "read by the layout that the file shows: {layout}",
        severity="watch",
        layout=in_words(layout),
    )


def first_of_each_file_with(found: Warning, files: Sequence[LogFile]) -> tuple[LogFile, ...]:
    """Return the runs, the first of each file with a warning that concerns the whole file."""
    first = {run.sha256: at for at, run in reversed(list(enumerate(files)))}
    return tuple(
        replace(run, warnings=(found, *run.warnings)) if first[run.sha256] == at else run
        for at, run in enumerate(files)
    )


def in_words(layout: LogLayout) -> str:
    """Return a layout on one line, as its keys stand in a mapping."""
    return "; ".join(layout.keys())


def _with_advice(error: HerseyError, path: Path) -> HerseyError:
    """The error with the advice to describe the layout in the place of its remedy."""
    again = error.saying(error.reason)
    again.setting, again.likely, again.remedy = None, "", _advice(path)
    return again


def _advice(path: Path) -> str:
    if way_in() == "python":
        return (
            "its layout can be described: write the text of hersey.log.proposal.propose_mapping(path) to "
            "hersey.toml beside it, and use hersey.read_with_mapping"
        )
    if way_in() == "page":
        return "type hersey inspect in a terminal to describe its layout in a hersey.toml, and add that"
    typed = f"hersey inspect {shlex.quote(str(path))} {_SAVE_MAPPING.to()}"
    return f"to describe its layout in hersey.toml, run '{typed}' and try again"
