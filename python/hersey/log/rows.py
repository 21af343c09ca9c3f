"""Which rows of a file can be used, and where one run ends and the next begins."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.errors import DROP_MISSING, ISOTHERMAL, Setting, TimeOrderError, UnreadableLogError
from hersey.log.given_twice import refuse_rows_repeated
from hersey.log.slow_channels import LONGEST_INTERVAL, SlowChannel, is_slow
from hersey.log.text.dated_numbers import numbers_lost
from hersey.log.torque_log import LogFile, Run
from hersey.schema.warning import Warning

#: Rows of a run.
Rows = slice | IntArray

#: Rows that may be left out unasked, as a share of a file; one may be in any.
FEW = 0.02
#: Rows left out that are listed one by one, at the most.
_LISTED = 10
#: A clock that falls back into this part of what it has passed starts anew.
_START = 0.1
#: Runs in a file at the most.
_MOST_RUNS = 10_000


@dataclass
class LeftOut:
    """Rows that cannot be used because a cell of them holds no number that is believed."""

    rows: int = 0
    words: list[str] = field(default_factory=list)  #: for the first of them: place, and what is wrong there
    out_of_order: int = 0  #: those among them whose time is
    units: str = ""  #: what to do about cells that hold a number with its unit
    dates: str = ""  #: a column in which a spreadsheet has made dates of numbers

    def add(self, rows: int, words: Iterable[str], *, out_of_order: bool = False) -> None:
        """Count rows; of ``words``, one for each of them, no more are taken than are shown."""
        self.rows += rows
        self.out_of_order += rows if out_of_order else 0
        self.words += itertools.islice(words, max(0, _LISTED - len(self.words)))

    def refuse_many(self, file: str, rows: int, *, allowed: bool, without: str = "") -> None:
        """Raise unless few rows of a file, of ``rows`` in all, are left out, or that is ``allowed``.

        ``without`` says how to do without the channel that most of them lack, if that is possible.

        Raises
        ------
        UnreadableLogError
            It names the first of them; also if most rows are of no use, whatever is allowed.
        """
        most = 2 * self.rows > rows
        allowed = allowed and not most and not self.dates  # what has become a date are not any numbers
        if not self.rows or allowed or self.rows <= max(1.0, FEW * rows):
            return
        how_many = f" (the first of {self.rows} such rows, of {rows})" if self.rows > 1 else ""
        few = f"too few rows remain. {f'{without}. Otherwise n' if without else 'N'}ame another column, or "
        way_out = (self.units or f"{few}correct the file") if most else _way_out()
        said = f"{file}, {self.words[0]}{how_many}"
        if self.dates:
            way_out = numbers_lost(self.dates)
        if self.out_of_order == self.rows:
            raise TimeOrderError(said, remedy=way_out, setting=Setting("time", "channel"))
        raise UnreadableLogError(said, remedy=way_out)

    def warnings(self) -> list[Warning]:
        """Return what was left out."""
        if not self.rows:
            return []
        return [
            Warning(
                "rows left out",
                "{rows} {rows:row was|rows were} excluded: {faults}"
                + ("; and {others} more" if self.rows > len(self.words) else ""),
                remedy=(
                    "A spreadsheet has made dates of numbers in column '{dates}', and this file has lost "
                    "these numbers. Export it again from the original file, with the column formatted as "
                    "number"
                )
                if self.dates
                else "",
                dates=self.dates,
                rows=self.rows,
                faults="; ".join(self.words),
                others=self.rows - len(self.words),
            )
        ]


def _way_out() -> str:
    return f"correct the file, or exclude such rows with {DROP_MISSING.to()} (they will be counted)"


def runs_of(
    time: FloatArray, numbers: FloatArray | None, file: str, place: Callable[[int], str], left_out: LeftOut
) -> list[Rows]:
    """Return the rows of each run.

    A run ends where its number (``numbers``, shape of ``time``) changes, or where the clock starts anew:
    falls back into the first tenth of what it has passed. A single row whose time lies apart is left out.

    Parameters
    ----------
    time
        In s, shape (rows,).
    place
        A row in words, such as ``line 12``.

    Raises
    ------
    UnreadableLogError
        If time runs backwards in any other way.
    """
    kept = np.ones(time.size, dtype=bool)
    starts = [0]
    change = np.zeros(time.size, dtype=bool)
    if numbers is not None and time.size:
        change[1:] = np.diff(numbers) != 0
    for row in map(int, np.flatnonzero(change | np.append(False, np.diff(time) < 0))):
        last = _last_kept(kept, row, starts[-1])
        if change[row]:
            starts.append(row)
        elif time[row] >= time[last]:  # the row before was the odd one
            continue
        elif row + 1 < time.size and time[row + 1] >= time[last] and not change[row + 1]:
            kept[row] = False
            by = time[last] - time[row]
            left_out.add(
                1, [f"{place(row)}: time runs backwards by {by:.6g} s in this row"], out_of_order=True
            )
        elif last > starts[-1] and time[row] >= time[_last_kept(kept, last, starts[-1])]:
            kept[last] = False
            by = time[last] - time[row]
            left_out.add(1, [f"{place(last)}: time runs ahead by {by:.6g} s in this row"], out_of_order=True)
        elif time[row] <= time[starts[-1]] + _START * (time[last] - time[starts[-1]]):
            starts.append(row)
        else:
            raise TimeOrderError(
                f"{file}, {place(row)}: time runs backwards by {time[last] - time[row]:.6g} s",
                remedy=(
                    "split the file there, sort its rows, or name the column with the run number with "
                    f"{Setting('run', 'channel').to()}"
                ),
                setting=Setting("time", "channel"),
            )
        if len(starts) > _MOST_RUNS:
            raise TimeOrderError(
                f"{file}: the time column restarts more than {_MOST_RUNS} times, so it is not a clock",
                remedy="sort the rows by time, or name another column with "
                f"{Setting('time', 'channel').to()}",
                setting=Setting("time", "channel"),
            )
    return [_rows(kept, start, end) for start, end in itertools.pairwise([*starts, kept.size])]


def runs_with_records(
    file: LogFile,
    arrays: dict[str, FloatArray],
    place: Callable[[int], str],
    left_out: LeftOut,
    lacking: Mapping[str, LeftOut],
    *,
    drop_missing: bool,
) -> list[tuple[Run, LogFile]]:
    """Return the runs in a file, each with its record: that of the file with rows and warnings of its own.

    ``arrays`` holds, in SI, time, torque and speed, and temperature, load and number of the run where known.
    A role of ``lacking`` may lack numbers (NaN): if few rows have one it is a slow channel, interpolated
    between them, otherwise these rows are left out.

    Raises
    ------
    UnreadableLogError
        If too many rows were left out, time runs backwards, rows repeat earlier ones, or no run has two rows.
    """
    rows = arrays["time"].size + left_out.rows
    slow, gone = _slow(file, arrays, lacking)
    if gone.any():
        left_out.add(int(gone.sum()), itertools.chain.from_iterable(each.words for each in lacking.values()))
        arrays = {role: values[~gone] for role, values in arrays.items()}
        place = _among(place, np.flatnonzero(~gone))
    time = arrays["time"]
    refuse_rows_repeated(arrays, file.name, place)
    parts = runs_of(time, arrays.pop("run", None), file.name, place, left_out)
    cold = lacking.get("temperature", LeftOut()).rows
    without = f"If the log has no temperature, use {ISOTHERMAL.to()}" if 2 * cold > rows else ""
    left_out.refuse_many(file.name, rows, allowed=drop_missing, without=without)
    if time.size < 2:
        raise UnreadableLogError(
            f"{file.name} has only {time.size} row(s) with a number in every required column"
        )
    runs = [{role: values[part] for role, values in arrays.items()} for part in parts]
    runs = [_bridged(run, slow, _among(place, part)) for run, part in zip(runs, parts, strict=True)]
    for channel in slow:
        gaps = LeftOut(channel.in_gaps, [f"{channel.first_gap}: {channel.role} '{channel.name}' has a gap"])
        gaps.refuse_many(file.name, rows, allowed=drop_missing)
    begins = [place(_first(part)) for part in parts]
    long = [i for i, run in enumerate(runs) if run["time"].size > 1 and run["time"][-1] > run["time"][0]]
    warnings = [each for channel in slow for each in channel.warnings()]
    if not long:
        raise UnreadableLogError(
            f"{file.name}: {'; '.join(map(str, warnings)) or 'all rows carry the same time'}"
        )
    for i in set(range(len(runs))) - set(long):
        if count := runs[i]["time"].size:  # what is lost to a slow channel, that counts
            left_out.add(count, [f"{begins[i]}: {count} row(s) with the same time, between two runs"] * count)
    lost = file.missing_rows + left_out.rows + sum(channel.lost for channel in slow)
    warnings = [*file.warnings, *warnings, *left_out.warnings()]
    first = replace(file, missing_rows=lost, warnings=tuple(warnings))
    other = replace(file, missing_rows=0, impossible=(), warnings=())
    return [
        _recorded(runs[i], other if number else first, number + 1, len(long), begins[i])
        for number, i in enumerate(long)
    ]


def _recorded(
    run: dict[str, FloatArray], file: LogFile, number: int, runs: int, begins: str
) -> tuple[Run, LogFile]:
    """One of the runs in a file, with the record of that file as its own."""
    name, warnings = file.name, file.warnings
    if runs > 1:
        name = f"{file.name}, run {number} of {runs}"
        start = Warning(
            "run of a file",
            "run {run} of {runs} in {file} begins at {begins}",
            run=number,
            runs=runs,
            file=file.name,
            begins=begins,
        )
        warnings = (*warnings, start)
    optional = {role: run.get(role) for role in ("temperature", "load")}
    record = replace(file, name=name, rows=run["time"].size, warnings=warnings)
    return Run(name, run["time"], run["torque"], run["speed"], **optional), record


def _slow(
    file: LogFile, arrays: dict[str, FloatArray], lacking: Mapping[str, LeftOut]
) -> tuple[list[SlowChannel], BoolArray]:
    """The slow channels, and the rows that lack a number of a channel that is not slow."""
    time, slow = arrays["time"], []
    gone = np.zeros(time.size, dtype=bool)
    names = {channel.role: channel.name for channel in file.channels}
    for role in lacking:
        known = np.isfinite(arrays[role])
        if is_slow(known.size, int(known.sum())):
            channel = SlowChannel.of(role, names[role], time, known)
            if channel.interval <= LONGEST_INTERVAL:
                slow.append(channel)
                continue
        gone |= ~known
    return slow, gone


def _bridged(
    run: dict[str, FloatArray], slow: list[SlowChannel], place: Callable[[int], str]
) -> dict[str, FloatArray]:
    """A run without the rows for which a slow channel has no value."""
    if not slow:
        return run
    for channel in slow:
        run[channel.role] = channel.filled(run["time"], run[channel.role], place)
    kept = np.logical_and.reduce([np.isfinite(run[channel.role]) for channel in slow])
    return {role: values[kept] for role, values in run.items()}


def _among(place: Callable[[int], str], rows: Rows) -> Callable[[int], str]:
    """What puts a row in words that is counted among these."""
    if isinstance(rows, slice):
        start = _first(rows)
        return lambda row: place(start + row)
    return lambda row: place(int(rows[row]))


def _first(rows: Rows) -> int:
    return int(rows.start) if isinstance(rows, slice) else int(rows[0])


def _last_kept(kept: BoolArray, row: int, start: int) -> int:
    """The row before this one that is used, in the run that begins at ``start``."""
    before = row - 1
    while before > start and not kept[before]:
        before -= 1
    return max(before, start)


def _rows(kept: BoolArray, start: int, end: int) -> Rows:
    return slice(start, end) if kept[start:end].all() else start + np.flatnonzero(kept[start:end])
