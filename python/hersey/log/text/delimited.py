"""Reading delimited text (CSV and its relatives) in blocks, so that memory holds only the numbers used."""

from __future__ import annotations

import hashlib
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.errors import ChannelError, Setting, UnitError, UnreadableLogError, printable
from hersey.files.reading import OpenFile, appended
from hersey.log.believed import in_si
from hersey.log.channels import (
    ChannelChoice,
    Stated,
    clocks_passed_over,
    constant_channel,
    find_channel,
    is_dead,
    no_channel,
    refuse_two_roles,
    taken_columns,
)
from hersey.log.constant_temperature import constant_temperature
from hersey.log.derived.direction import without_sign
from hersey.log.friction import (
    Chosen,
    beside,
    computed,
    in_domain,
    is_converted,
    rotating,
    slow_roles,
    unused,
)
from hersey.log.impossible import Impossible, Reading, impossible_rows
from hersey.log.lacking_roles import asking_all, stated
from hersey.log.long_arrays import Filling, rows_before, without
from hersey.log.replaced import replaced_units
from hersey.log.role_units import example_unit
from hersey.log.rows import LeftOut, runs_with_records
from hersey.log.text.blocks import Block, blocks
from hersey.log.text.cells import CellReader
from hersey.log.text.column import Column
from hersey.log.text.footer import end_of_table
from hersey.log.text.layout import SNIFFED, Layout, find_layout
from hersey.log.text.numbers import is_missing
from hersey.log.text.split_seconds import refuse_split_seconds
from hersey.log.text.stamps import refuse_whole_minutes
from hersey.log.text.units_in_cells import numbers_only
from hersey.log.torque_log import NO_CLOCK, Channel, LogFile, Run
from hersey.log.wanted import Wanted
from hersey.log.wrapped import COUNTED, with_signs
from hersey.schema.warning import Warning
from hersey.units import Conversion

Progress = Callable[[int, int], None]


def read_delimited(path: Path, wanted: Wanted, progress: Progress | None = None) -> list[tuple[Run, LogFile]]:
    """Read the runs in one file; ``progress`` is called with bytes done and bytes in all.

    Raises
    ------
    MissingFileError, UnreadableLogError, ChannelError, UnitError
        Each names the file, and the line and column where that applies.
    """
    name, stated = printable(path.name), wanted.stated
    with open_delimited(path) as file:
        layout, end, size = file.layout, file.end, file.opened.size
        dead = _Dead(file)
        channels = _channels(layout, wanted, name, dead)
        excluded = _excluded(file, channels) if wanted.isothermal else []
        not_used = unused(layout.named, channels, stated, file.as_far_as_known)
        table = _Table(name, layout, channels, wanted.drop_missing, stated)
        table.slow = slow_roles(channels, wanted.stated)
        table.read(file.opened, end.byte, progress)
        growth = file.opened.growth(table.digest.hexdigest())
    arrays, impossible = table.arrays()
    if (time := channels.get("time")) and (stamps := table.reader.stamps.get(time[0].index)):
        refuse_whole_minutes(f"{name}: column '{time[0].name}'", stamps, arrays["time"])
        refuse_split_seconds(f"{name}: column '{time[0].name}'", arrays["time"], layout.columns)
    used = tuple(Channel(role, column.name, si.unit) for role, (column, si) in table.channels.items())
    if stated.every is not None:
        used = (Channel("time", NO_CLOCK, f"{stated.every:g} s"), *used)
    log = LogFile(
        name,
        table.digest.hexdigest(),
        size,
        0,
        table.impossible_rows,
        used,
        layout.comments,
        end.cut_off,
        (
            *layout.warnings,
            *table.reader.warnings(),
            *table.warnings,
            *clocks_passed_over(layout.named, stated),
            *computed(channels, stated),
            *replaced_units(table.channels),
            *dead.warnings,
            *excluded,
            *not_used,
            *without_sign((column.name for column in layout.named), arrays["speed"]),
            *end.warnings,
            *growth,
            *(each.warning() for each in impossible),
        ),
        impossible,
    )
    return runs_with_records(
        log, arrays, table.place, table.left_out, table.lacking, drop_missing=wanted.drop_missing
    )


def delimited_columns(path: Path) -> tuple[Column, ...]:
    """Return the columns of a text file that hold numbers or time stamps.

    Raises
    ------
    MissingFileError, UnreadableLogError
        If it cannot be opened, or holds no table.
    """
    with open_delimited(path) as file:
        return tuple(column for column in file.layout.columns if column.index not in file.layout.texts)


class DelimitedFile:
    """A text table while its file is open: whoever looks at it sees the same bytes."""

    def __init__(self, opened: OpenFile) -> None:
        """Find where the table starts, what its columns are, and where it ends."""
        file, size = opened.file, opened.size
        self.opened, self.layout = opened, find_layout(file.read(min(size, SNIFFED)), opened.path.name)
        self.end = end_of_table(file, size, self.layout)

    def text(self) -> tuple[bytes, list[Warning]]:
        """Return the file up to the end of the table, and a warning if a logger appends to it.

        Raises
        ------
        UnreadableLogError
            If the file is no longer what it was, unless it has only grown.
        """
        self.opened.file.seek(0)
        text = self.opened.file.read(self.opened.size)
        return text[: self.end.byte], self.opened.growth(hashlib.sha256(text).hexdigest())

    def numbers(
        self, chosen: Sequence[Column], *, complete: bool, odd_as_missing: bool = False
    ) -> list[FloatArray]:
        """Return columns as written (time stamps in s), shape (rows,), NaN where a number is missing.

        With ``odd_as_missing`` also where something else stands.

        Raises
        ------
        UnreadableLogError
            If a cell is no number, naming line and column; if ``complete``, also if one is missing; if the
            file is no longer what it was, unless it has only grown.
        """
        as_written = {str(i): (column, Conversion(column.unit, 1.0, 0.0)) for i, column in enumerate(chosen)}
        name, strict = self.opened.path.name, not odd_as_missing
        table = _Table(name, self.layout, as_written, drop_missing=not complete, strict=strict)
        numbers = table.numbers(self.opened, self.end.byte)
        self.opened.growth(table.digest.hexdigest())
        return numbers

    def as_far_as_known(self, column: Column) -> FloatArray:
        """Return a column as written, NaN where no number stands, whatever else does."""
        (values,) = self.numbers([column], complete=False, odd_as_missing=True)
        return values


@contextmanager
def open_delimited(path: Path) -> Iterator[DelimitedFile]:
    """Open a text table once.

    Raises
    ------
    MissingFileError, UnreadableLogError
        If it cannot be opened, or holds no table.
    """
    with appended(path) as opened:
        yield DelimitedFile(opened)


def _excluded(file: DelimitedFile, channels: Chosen) -> list[Warning]:
    """What is to be known of a temperature that is excluded."""
    return constant_temperature(file.layout.named, channels, file.opened.path.name, file.as_far_as_known)


class _Dead:
    """Which columns of an open file say nothing; there is a warning of each that was passed over."""

    def __init__(self, file: DelimitedFile) -> None:
        self.file, self.warnings, self._known = file, list[Warning](), dict[int, bool]()

    def __call__(self, column: Column) -> bool:
        if column.index not in self._known:
            self._known[column.index] = is_dead(self.file.as_far_as_known(column))
            if self._known[column.index]:
                self.warnings.append(constant_channel(column))
        return self._known[column.index]


def _by_number(
    layout: Layout, lacking: list[str], used: Sequence[str], choices: Mapping[str, ChannelChoice]
) -> str:
    """Why columns must be named, and the options that name those that are not, as an example."""
    if len(layout.columns) < len(used):
        needed = f"{', '.join(used[:-1])} and {used[-1]}"
        return f"{layout.headless}, and there are only {len(layout.columns)} columns. A log needs {needed}"
    columns = [(Setting(role, "channel"), f"#{used.index(role) + 1}") for role in lacking]
    without_unit = [role for role in lacking if not choices[role].unit]
    units = [(Setting(role, "unit"), example_unit(role, layout.columns[0])) for role in without_unit]
    return (
        f"{layout.headless}. Add a line there with the name and unit of each column, e.g. 'Torque "
        f"[N*m]' (without '{layout.comment}' before it), or name the columns by number, e.g. "
        f"{stated(columns + units)}, with your units"
    )


def _channels(
    layout: Layout, wanted: Wanted, name: str, dead: Callable[[Column], bool]
) -> dict[str, tuple[Column, Conversion]]:
    choices, used = wanted.choices, wanted.roles
    if layout.headless and (lacking := [role for role in used if not choices[role].name]):
        raise UnreadableLogError(_by_number(layout, lacking, used, choices))
    chosen: dict[str, tuple[Column, Conversion]] = {}
    for role in sorted(used, key=lambda r: r != "torque"):  # without it the rest is of no use
        taken = taken_columns(role, layout.named, choices, chosen)
        try:
            channel = find_channel(role, layout.named, choices[role], name, dead, taken)
            if channel is None:
                raise no_channel(role, layout.named, name, names=wanted.names)
        except (ChannelError, UnitError) as error:
            raise asking_all(
                error, used, layout.named, choices, name, dead=dead, names=wanted.names
            ) from None
        refuse_two_roles(role, channel[0], chosen, name)
        chosen[role] = channel
    others = beside(layout.named, choices, wanted.stated, chosen, name)
    return {role: chosen[role] for role in used} | others


class _Table:
    """The table of one file while it is being read."""

    def __init__(
        self,
        name: str,
        layout: Layout,
        channels: dict[str, tuple[Column, Conversion]],
        drop_missing: bool,
        stated: Stated = Stated(),  # noqa: B008 # frozen
        strict: bool = False,
    ) -> None:
        self.name, self.layout, self.channels, self.drop_missing = name, layout, channels, drop_missing
        self.columns, self.stated = [column for column, _ in channels.values()], stated
        self.reader = CellReader(name, layout, self.columns, strict=strict)
        self.slow: frozenset[str] = frozenset()  # roles that a row may lack until the whole is known
        self.lacking: dict[str, LeftOut] = {}  # rows that lack such a role alone
        self.parts: dict[str, Filling] = {}
        self.digest = hashlib.sha256()
        self.left_out = LeftOut()
        self.warnings: list[Warning] = []
        self.rows = 0  # so far, those that were left out among them
        self._kept_last = 0
        self._disbelieved = np.empty(0, dtype=np.intp)  # rows that were kept and are not believed
        self._lines: list[tuple[int, Sequence[int], IntArray | None]] = []  # first row, lines, those kept

    def read(self, opened: OpenFile, end: int, progress: Progress | None) -> None:
        """Read the table, which ends at byte ``end``."""
        for block, done in self._blocks(opened, end):
            self._add(block, done / max(1, end))
            if progress:
                progress(done, opened.size)

    def numbers(self, opened: OpenFile, end: int) -> list[FloatArray]:
        """The columns as written, NaN where a number is missing and may be."""
        parts: list[list[FloatArray]] = [[] for _ in self.columns]
        for block, _ in self._blocks(opened, end):
            self._keep(block, parts)
        return [np.concatenate(values) if values else np.empty(0) for values in parts]

    def _blocks(self, opened: OpenFile, end: int) -> Iterator[tuple[Block, int]]:
        return blocks(opened, end, self.layout, self.name, self.digest.update)

    def _keep(self, block: Block, parts: list[list[FloatArray]]) -> None:
        values = self.reader.numbers(block)
        gone = ~np.logical_and.reduce([np.isfinite(column) for column in values])
        if gone.any() and not self.drop_missing:
            row = int(np.argmax(gone))
            raise UnreadableLogError(f"{self.name}, {self._fault(block, values, row)}. Correct the file")
        for part, column in zip(parts, values, strict=True):
            part.append(np.where(np.isfinite(column), column, np.nan))

    def arrays(self) -> tuple[dict[str, FloatArray], tuple[Impossible, ...]]:
        """What the rows hold, by role, as a log has it, and readings that cannot be right, left out."""
        arrays = {role: part.whole() for role, part in self.parts.items()}
        self.parts.clear()
        for role in COUNTED:
            if role in arrays:
                column, si = self.channels[role]
                arrays[role], read = with_signs(arrays[role], si.scale, column.name)
                self.warnings += read
        readings = [
            Reading(role, *self.channels[role], values)
            for role, values in arrays.items()
            if role in self.channels
        ]
        gone, found = impossible_rows(
            readings,
            self.name,
            lambda row, column: f"{self.place(row)}, column '{column.name}'",
            allowed=self.drop_missing,
        )
        self._disbelieved = gone
        arrays = {role: without(values, gone) for role, values in arrays.items()}
        return in_domain(arrays, self.channels, self.stated), found

    @property
    def impossible_rows(self) -> int:
        """Rows that were left out because a reading cannot be right."""
        return self._disbelieved.size

    def place(self, row: int) -> str:
        """Where a row that was kept stands in the file."""
        row = rows_before(row, self._disbelieved)
        first, lines, kept = self._lines[bisect_right(self._lines, row, key=lambda block: block[0]) - 1]
        return f"line {lines[row - first if kept is None else int(kept[row - first])]}"

    def _add(self, block: Block, done: float) -> None:
        values = self.reader.numbers(block)
        by_role = self._in_si(values)
        needed = [numbers for role, numbers in by_role.items() if role not in self.slow]
        gone = ~np.logical_and.reduce([np.isfinite(numbers) for numbers in needed])
        if is_converted(self.channels, self.stated):
            gone |= ~self._has_radius(by_role)
        for role in self.slow & by_role.keys():
            known = np.isfinite(by_role[role])
            rows = np.flatnonzero(~known & ~gone)
            faults = (self._fault(block, values, int(row)) for row in rows)
            self.lacking.setdefault(role, LeftOut()).add(rows.size, faults)
        words = (self._fault(block, values, int(row)) for row in np.flatnonzero(gone))
        self.left_out.add(int(gone.sum()), words)
        self.left_out.dates = next((column.name for column in self.reader.dates.values()), "")
        self.left_out.misread, self.left_out.rewrite = self.reader.misread, self.reader.remedy
        kept = np.flatnonzero(~gone) if gone.any() else None
        first = self._lines[-1][0] + self._kept_last if self._lines else 0
        self._kept_last = len(block.lines) if kept is None else kept.size
        self._lines.append((first, block.lines, kept))
        for role, numbers in by_role.items():
            self.parts.setdefault(role, Filling()).add(numbers if kept is None else numbers[kept], done)
        self.rows += len(block.lines)

    def _in_si(self, values: list[FloatArray]) -> dict[str, FloatArray]:
        """What the columns hold, by role, in SI; NaN where a number is missing."""
        arrays = {
            role: in_si(numbers, si)
            for (role, (_, si)), numbers in zip(self.channels.items(), values, strict=True)
        }
        if self.stated.every is not None:
            numbers = self.rows + np.arange(values[0].size, dtype=float)
            arrays["time"] = numbers * self.stated.every
        return arrays

    def _has_radius(self, by_role: dict[str, FloatArray]) -> BoolArray:
        """Whether a row has a radius where torque or speed can be had only with one."""
        rotated = in_domain(dict(by_role), self.channels, self.stated)
        unknown = [np.isnan(rotated[role]) for role in rotating(self.channels)]
        return np.asarray(~np.logical_or.reduce(unknown))

    def _fault(self, block: Block, values: list[FloatArray], row: int) -> str:
        """Line and column of the first cell of a row that is of no use, and what is wrong with it."""
        cells = next(block.cells(self.layout.between, slice(row, None)))
        place, width = f"line {block.lines[row]}", len(self.layout.columns)
        if any(cells[width:]):
            return f"{place}: {len(cells)} cells, but the header has {width}"
        for (column, _), numbers in zip(self.channels.values(), values, strict=True):
            cell = cells[column.index] if column.index < len(cells) else ""
            in_column = f"{place}, column '{column.name}': "
            if not np.isfinite(numbers[row]):
                if is_missing(cell):
                    what = f"'{cell[:40]}'" if cell else "an empty cell"
                    return f"{in_column}{what} instead of a number"
                if remedy := numbers_only(column, cell):
                    self.left_out.units = self.left_out.units or remedy
                    return f"{in_column}the cell holds its unit, '{cell[:40]}'"
                return f"{in_column}'{cell[:40]}' is not a {self.reader.what(column)}"
        return f"{place}: torque and speed need a radius greater than zero"
