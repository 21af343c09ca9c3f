"""Whether a file is a table of means though nobody called it one: by its columns and its speeds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, HerseyError
from hersey.log.channels import ChannelChoice, called, find_channel
from hersey.log.mean_blocks import blocks_of
from hersey.log.mean_roles import measured
from hersey.log.text.column import Column

#: Rows and bytes of a file that is taken for a table of means without being called one, at the most.
FEW_ROWS, FEW_BYTES = 300, 200_000
#: Share of neighbouring rows at one speed from which on rows are samples and no means.
SAMPLED = 0.7


def is_means_table(path: Path, channels: Mapping[str, str], units: Mapping[str, str]) -> bool:
    """Return whether a file is one: few rows with speed and torque, no clock, few speeds twice running."""
    try:
        if not path.is_file() or path.stat().st_size > FEW_BYTES:
            return False
        cells = blocks_of(path, path.name)
        lengths = {len(each) for each in cells.cells}
        if len(lengths) != 1 or not 0 < max(lengths) <= FEW_ROWS or _clock(cells.columns):
            return False
        if (clock := channels.get("time")) and called(clock, cells.columns):
            return False
        columns = measured(cells.columns)
        choices = {r: ChannelChoice(channels.get(r, ""), units.get(r, "")) for r in ("speed", "torque")}
        found = {role: _possible(role, columns, choice, cells.name) for role, choice in choices.items()}
    except (HerseyError, OSError):  # whoever reads it as a log says what is wrong
        return False
    return bool(found["speed"] and found["torque"]) and all(
        map(_is_of_dwells, map(cells.numbers, found["speed"]))
    )


def _possible(role: str, columns: tuple[Column, ...], choice: ChannelChoice, name: str) -> tuple[Column, ...]:
    """The column of a role, or those among which a person has to choose."""
    try:
        channel = find_channel(role, columns, choice, name)
    except ChannelError as several:
        return tuple(c for c in columns if c.index in several.columns)
    return () if channel is None else channel[:1]


def _is_of_dwells(speed: FloatArray) -> bool:
    """Whether few speeds stand twice running, as in rows of means."""
    same = np.abs(np.diff(speed)) <= 0.01 * np.abs(speed[1:])
    return bool(speed.size < 2 or np.mean(same) < SAMPLED)


def _clock(columns: tuple[Column, ...]) -> bool:
    """Whether a column may be a clock."""
    try:
        return find_channel("time", columns, ChannelChoice(), "") is not None
    except HerseyError:
        return True
