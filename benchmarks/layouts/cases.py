"""The layouts: a function that writes each, and the ending of its file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from benchmarks.layouts import sections, tables, unseen, unseen_again, workbooks
from benchmarks.layouts.truth import Made

_SECTIONS = (
    *("rheocompass", "rheoplus", "trios", "rheowin", "umt", "mtm", "catman", "dewesoft", "epos"),
    *("pin_on_disc", "odrive", "in_band", "with_statistics", "other_units", "restarts", "other_order"),
    *("ini", "testxpert", "optimol", "lvm"),
)
_TABLES = (
    *("keyence", "gbk", "utf16", "blanks", "fixed", "quoted", "thousands", "swiss", "percent", "commented"),
    *("three_rows", "names_apart", "transposed", "wide", "wide_with_row", "unequal", "repeated_names"),
    *("twincat", "twincat_semicolons", "yokogawa", "wincc"),
)
_WORKBOOKS = (
    *("sheets", "named_sheets", "titled_sheets", "wide_sheet", "transposed_sheet", "side_by_side"),
    "timed_speeds",
)

CASES: dict[str, tuple[Callable[[Path], Made], str]] = {
    **{name: (getattr(sections, name), ".lvm" if name == "lvm" else ".txt") for name in _SECTIONS},
    **{name: (getattr(tables, name), ".csv") for name in _TABLES},
    **{name: (getattr(workbooks, name), ".xlsx") for name in _WORKBOOKS},
}
#: Exports on which nothing was developed before they were first tried.
UNSEEN = {**unseen.CASES, **unseen_again.CASES}
