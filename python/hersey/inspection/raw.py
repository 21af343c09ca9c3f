"""Every channel of a log as it was written, whether or not the log can be read as one of torque."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import ChannelError, HerseyError, UnitError, followed_by, printable
from hersey.log.channels import (
    ChannelChoice,
    Stated,
    find_channel,
    find_column,
    is_dead,
    no_channel,
    taken_columns,
)
from hersey.log.friction import Chosen, beside
from hersey.log.layouts.current import format_of, opened
from hersey.log.roles import ROLES
from hersey.log.slow_channels import FEWEST
from hersey.log.text.column import Column, refuse_ragged
from hersey.log.text.delimited import open_delimited
from hersey.log.text.layout import Layout
from hersey.log.text.numbers import NULLS, is_missing
from hersey.log.text.separators import BLANKS, split, tabbed
from hersey.log.text.stamps import Stamps, counted_unit, numbers_in
from hersey.log.text.units_in_cells import numbers_only
from hersey.schema.warning import Warning


@dataclass(frozen=True)
class RawChannel:
    """One channel in its own unit: shape (rows,), NaN where no number stands.

    ``odd`` counts cells that are neither a number nor a word for a missing one; ``clock`` is the time of each
    row in s where the format has it, and channels with the same ``tick`` share it.
    """

    column: Column
    values: FloatArray
    odd: int = 0
    clock: FloatArray | None = None
    tick: str = ""


@dataclass(frozen=True)
class RawLog:
    """The channels of one file, the comments above them, and what was done to read it."""

    name: str
    format: str
    channels: tuple[RawChannel, ...]
    comments: tuple[str, ...]
    warnings: tuple[Warning, ...]
    cut_off: bool
    texts: tuple[tuple[Column, str], ...] = ()  #: columns of text alone, each with its first cell


def raw_channels(path: str | Path) -> RawLog:
    """Return every channel of numbers in a file.

    Raises
    ------
    HerseyError
        If it cannot be read at all.
    """
    path = Path(path)
    kind = format_of(path)
    if kind is None:
        return _of_text(path)
    with opened(path, kind) as recording:
        channels = []
        warnings = list(recording.warnings)
        clocks: dict[str, FloatArray] = {}  # each loaded once: a group of channels has one
        for index, signal in enumerate(recording.signals):
            column = Column(index, signal.name, signal.unit, signal.group)
            try:
                values = np.asarray(signal.load(), dtype=float)
                if signal.clock is not None and signal.tick not in clocks:
                    clocks[signal.tick] = signal.clock()
            except HerseyError as error:
                warnings.append(
                    Warning(
                        "channel unreadable",
                        "'{channel}' cannot be read: {error}",
                        severity="watch",
                        channel=column.path,
                        error=str(error),
                    )
                )
                continue
            unit, _ = counted_unit(signal.name, signal.unit, partial(np.asarray, values))
            column = Column(index, signal.name, unit or signal.unit, signal.group)
            clock = clocks.get(signal.tick) if signal.clock is not None else None
            channels.append(
                RawChannel(column, values, clock=clock, tick=signal.tick or f"{signal.rows} rows")
            )
        kind, comments, cut_off = recording.format, recording.comments, recording.cut_off
        warnings += [each for each in recording.warnings if each not in warnings]
    return RawLog(printable(path.name), kind, tuple(channels), comments, tuple(warnings), cut_off)


@dataclass(frozen=True)
class Lacking:
    """Why no column plays a role; ``columns`` are the indices of those that come near, none if none does.

    ``reason`` is the text without what to do, ``remedy`` what to do where no column comes near.
    """

    text: str
    columns: tuple[int, ...] = ()
    absent: bool = False  #: whether no column of the file comes near
    reason: str = ""
    remedy: str = ""

    def __str__(self) -> str:
        """Return why."""
        return self.text


def roles_of(
    log: RawLog, choices: dict[str, ChannelChoice], stated: Stated
) -> tuple[dict[str, Column], dict[str, Lacking]]:
    """Return the column that plays each role, and why each of the others has none."""
    columns = tuple(channel.column for channel in log.channels)
    values = {channel.column: channel.values for channel in log.channels}
    chosen: Chosen = {}
    without: dict[str, Lacking] = {}

    def dead(column: Column) -> bool:
        return is_dead(values[column])

    for role in ROLES:
        if role == "time" and (stated.every is not None or any(c.clock is not None for c in log.channels)):
            continue
        try:
            taken = taken_columns(role, columns, choices, chosen)
            channel = find_channel(role, columns, choices[role], log.name, dead, taken)
        except HerseyError as refused:
            without[role] = _lacking(refused, log)
            continue
        if channel is None:
            error = no_channel(role, columns, log.name)
            said = Lacking(f"there is no {role} channel", absent=True, remedy=error.remedy)
            said = _of_text_alone(role, log, choices[role]) or said
            without[role] = said if error.absent else _lacking(error, log)
        else:
            chosen[role] = channel
    try:
        chosen |= beside(columns, choices, stated, chosen, log.name)
    except HerseyError as error:
        without.setdefault("torque", _lacking(error, log))
    return {role: column for role, (column, _) in chosen.items()}, without


def _of_text_alone(role: str, log: RawLog, choice: ChannelChoice) -> Lacking | None:
    """Why a column of temperature is of no use whose cells are text; None if there is none."""
    if role != "temperature":
        return None
    try:
        column = find_column(role, tuple(column for column, _ in log.texts), choice, log.name)
    except HerseyError:
        return None
    if column is None:
        return None
    cell = dict(log.texts)[column]
    remedy = numbers_only(column, cell)
    holds = "the cells hold units" if remedy else "no cell is a number"
    reason = f"column '{column.name}': {holds}, e.g. '{cell[:40]}'"
    return Lacking(followed_by(reason, remedy), reason=reason, remedy=remedy)


def _lacking(error: HerseyError, log: RawLog) -> Lacking:
    columns = error.columns if isinstance(error, ChannelError | UnitError) else ()
    text, reason = (each.removeprefix(f"{log.name}: ") for each in (str(error), error.reason))
    return Lacking(text, columns, reason=reason)


def _of_text(path: Path) -> RawLog:
    with open_delimited(path) as file:
        layout, end = file.layout, file.end
        text, growth = file.text()
    refuse_ragged(path.name, text.count(b"\n"), len(layout.columns), len(text))
    if layout.encoding != "utf-8-sig":
        text = text.decode(layout.encoding, errors="replace").encode()
    text = tabbed(text) if layout.separator == BLANKS else text
    frame = _frame(text, layout)
    channels = [
        channel
        for column in layout.named
        if f"{column.index}" in frame.columns
        and (channel := _text_channel(layout, column, frame[f"{column.index}"])) is not None
    ]
    warnings = (*layout.warnings, *end.warnings, *growth)
    texts, name = _texts(layout, frame, {channel.column for channel in channels}), printable(path.name)
    return RawLog(name, "text", tuple(channels), layout.comments, warnings, end.cut_off, texts)


def _texts(layout: Layout, frame: pl.DataFrame, used: Set[Column]) -> tuple[tuple[Column, str], ...]:
    """The columns of text alone, each with its first cell that is not missing."""
    found = []
    for column in layout.named:
        if column in used or f"{column.index}" not in frame.columns:
            continue
        cells = frame[f"{column.index}"].cast(pl.String).fill_null("")
        if first := next((cell.strip() for cell in cells if not is_missing(cell)), ""):
            found.append((column, printable(first)))
    return tuple(found)


def _frame(text: bytes, layout: Layout) -> pl.DataFrame:
    """The table with a column of numbers where all its cells are plain ones, of text elsewhere."""
    numbers: dict[str, type[pl.DataType]] = {
        f"{column.index}": pl.Float64
        for column in layout.columns
        if column.index not in layout.texts and column.index not in layout.stamps
    }

    def read(types: dict[str, type[pl.DataType]]) -> pl.DataFrame:
        return pl.read_csv(
            text,
            has_header=False,
            skip_lines=layout.first_line - 1,
            separator=layout.between,
            comment_prefix=layout.comment,
            infer_schema=False,
            schema_overrides=types,
            null_values=NULLS if types else None,
            encoding="utf8-lossy",
            truncate_ragged_lines=True,
            new_columns=[f"{column.index}" for column in layout.columns],
        )

    # padded cells, or words among the numbers, are no plain ones: as text, then
    for types in (numbers, {}) if layout.style.is_plain else ({},):
        try:
            table = read(types)
        except pl.exceptions.PolarsError:
            continue
        lines = text.count(b"\n") + (not text.endswith(b"\n")) - (layout.first_line - 1)
        if b'"' in text and table.height < lines:
            break  # a quote without its end takes in the lines below it
        return table
    return _line_by_line(text, layout)


def _line_by_line(text: bytes, layout: Layout) -> pl.DataFrame:
    """The table with columns of text, where a quote may lack its end."""
    width, comment = len(layout.columns), layout.comment.encode()
    columns: list[list[str]] = [[] for _ in range(width)]
    for line in text.split(b"\n")[layout.first_line - 1 :]:
        if not line.strip() or line.startswith(comment):
            continue
        cells = split(line.decode("utf-8", errors="replace").rstrip("\r"), layout.between)
        for index, column in enumerate(columns):
            column.append(cells[index] if index < len(cells) else "")
    return pl.DataFrame({f"{index}": column for index, column in enumerate(columns)})


def _text_channel(layout: Layout, column: Column, cells: pl.Series) -> RawChannel | None:
    """A column as a channel; one of words is none, unless numbers stand among them, as of a slow one."""
    if cells.dtype == pl.Float64:
        numbers = cells.fill_null(np.nan).to_numpy()
        return RawChannel(column, np.where(np.isfinite(numbers), numbers, np.nan), tick="rows")
    style = layout.stamps.get(column.index)
    values, odd = numbers_in(cells.fill_null(""), layout.style if style is None else Stamps(style))
    if column.index in layout.texts and np.count_nonzero(np.isfinite(values)) < FEWEST:
        return None
    return RawChannel(column, values, odd=int(odd.sum()), tick="rows")
