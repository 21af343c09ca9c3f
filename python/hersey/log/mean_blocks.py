"""A table of means in blocks, each below the same header: what its lines state, and blocks at one speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.errors import InsufficientDataError, ParameterError, Setting
from hersey.log.cell_table import CellTable, cells_of
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.layouts.current import reading_by, stated_layout
from hersey.log.layouts.recognized import layout_recognized
from hersey.log.layouts.repeated import layout_of_blocks, titles_of
from hersey.log.layouts.stacking import SECTION, SET
from hersey.schema.warning import Warning

#: Greatest by least speed of a block from which on speed varies, and up to which it does not.
_VARIES, _HELD = 1.5, 1.1
#: Kind of the warning of a table in blocks, and what chooses among them.
IN_BLOCKS, BLOCKS = "table in blocks", Setting("blocks")
#: Titles that a message names at the most.
_NAMED = 9
#: Rows of a block at one speed at the least.
_FEWEST = 3


def blocks_of(table: Any, name: str, only: str = "") -> CellTable:
    """Return the cells of a table of means, of one in blocks by the layout that it shows.

    ``only`` is a pattern of the line below which blocks are read.

    Raises
    ------
    ParameterError
        If ``only`` is given, and the table is not in blocks.
    InsufficientDataError
        If the blocks are those of several tests.
    """
    layout = None
    if isinstance(table, str | Path) and Path(table).is_file():
        layout = stated_layout() or layout_of_blocks(Path(table))
    if layout is None:
        if only:
            raise ParameterError(
                f"{name}: no header is repeated above blocks of rows", remedy=f"omit {BLOCKS.to(only)}"
            )
        return cells_of(table, name)
    with reading_by(replace(layout, only=only) if only else layout):
        found = cells_of(table, name)
    if stated_layout():
        return found
    titles, are_tests = titles_of(Path(table), layout)
    if are_tests and len(titles) > 1 and not only:
        raise InsufficientDataError(
            f"{found.name} holds {len(titles)} tests ({', '.join(map(repr, titles[:_NAMED]))}), which need "
            "not be one curve",
            remedy=f"read one of them with {BLOCKS.to(titles[0])}, or all with {BLOCKS.to('*')}",
        )
    known = [layout_recognized(layout)]
    if len(titles) > 1 and not only:
        known.append(_in_blocks(titles))
    return replace(found, warnings=(*known, *found.warnings))


def _in_blocks(titles: tuple[str, ...]) -> Warning:
    """That a table stands in blocks with titles."""
    return Warning(
        IN_BLOCKS,
        "the table is in blocks: {titles}",
        titles=", ".join(map(repr, titles[:_NAMED])) + (", ..." if len(titles) > _NAMED else ""),
        first=_as_typed(titles[0]),
    )


def _as_typed(title: str) -> str:
    """A title as a pattern: what stands in brackets behind it may be anything."""
    start = title.partition("(")[0].strip()
    return title if set(title) & set("{}*") or start == title or not start else f"{start}*"


def with_set_points(
    choices: Mapping[str, ChannelChoice], cells: CellTable, stated: Stated
) -> dict[str, ChannelChoice]:
    """Return the choices with load and radius as lines above the blocks state them, if nobody else does."""
    columns = {column.name: column for column in cells.columns}
    found = dict(choices)
    for role in ("load", "radius"):
        column = columns.get(SET.format(role))
        if column is not None and not choices[role].name and getattr(stated, role) is None:
            found[role] = ChannelChoice(column.name, choices[role].unit)
    return found


def at_one_speed(cells: CellTable, speed: FloatArray) -> tuple[BoolArray, list[Warning]]:
    """Return which rows stand in a block at one speed where others vary it: a run-in, a traction curve."""
    column = next((c for c in cells.columns if c.name == SECTION), None)
    held = np.zeros(speed.size, dtype=bool)
    if column is None:
        return held, []
    section = cells.numbers(column)
    ratios = {number: _ratio(np.abs(speed[section == number])) for number in np.unique(section)}
    if max(ratios.values()) < _VARIES:
        return held, []
    blocks = [number for number, ratio in ratios.items() if 0 < ratio < _HELD]
    held = np.isin(section, blocks)
    if not blocks:
        return held, []
    words = (
        "{blocks} of {all} blocks ({rows} rows) {blocks:was|were} skipped because {blocks:its|their} speed "
    )
    words += "does not vary: {which}"
    said = Warning(
        "blocks at one speed",
        words,
        severity="watch",
        blocks=len(blocks),
        all=len(ratios),
        rows=int(held.sum()),
        which=", ".join(f"{number:.0f}" for number in blocks),
    )
    return held, [said]


def _ratio(speed: FloatArray) -> float:
    """The greatest by the least speed; 0 of too few rows."""
    known = speed[np.isfinite(speed)]
    if known.size < _FEWEST:
        return 0.0
    return float(known.max() / known.min()) if known.min() > 0 else np.inf
