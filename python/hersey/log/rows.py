"""Which rows of a file can be used, and where one run ends and the next begins."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.errors import DROP_MISSING, ISOTHERMAL, Setting, TimeOrderError, UnreadableLogError
from hersey.log.given_twice import refuse_rows_repeated
from hersey.log.long_arrays import rows_before, rows_where, without
from hersey.log.slow_channels import LONGEST_INTERVAL, SlowChannel, is_slow
from hersey.log.text.dated_numbers import numbers_lost
from hersey.log.torque_log import LogFile, Run
from hersey.schema.warning import Warning

#: Rows that may be left out unasked, as a share of a file; one may be in any, unless it is misread.
FEW = 0.02
#: Rows left out that are listed one by one, at the most.
_LISTED = 10
#: A clock that falls back into this part of what it has passed starts anew.
_START = 0.1
#: Runs in a file at the most.
_MOST_RUNS = 10_000


@dataclass(frozen=True)
class Rows:
    """Rows of a run: those from the first to that before the end, but those left out, which are in order."""

    first: int
    end: int
    left_out: IntArray

    def of(self, values: FloatArray) -> FloatArray:
        """Return the numbers of the run from those of the whole."""
        return without(values[self.first : self.end], self.left_out - self.first)

    def among(self, place: Callable[[int], str]) -> Callable[[int], str]:
        """Return what puts a row of the run in words, where ``place`` does so with one of the whole."""
        return lambda row: place(self.first + rows_before(row, self.left_out - self.first))


@dataclass
class LeftOut:
    """Rows that cannot be used because a cell of them holds no number that is believed."""

    rows: int = 0
    words: list[str] = field(default_factory=list)  #: for the first of them: place, and what is wrong there
    out_of_order: int = 0  #: those among them whose time is
    units: str = ""  #: what to do about cells that hold a number with its unit
    dates: str = ""  #: a column in which a spreadsheet has made dates of numbers
    misread: int = 0  #: cells of a number in another style, and rows of more cells than the header
    rewrite: str = ""  #: what to do about these

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
        misread = self.misread > FEW * rows
        if not self.rows or allowed or (self.rows <= max(1.0, FEW * rows) and not misread):
            return
        how_many = f" (the first of {self.rows} such rows, of {rows})" if self.rows > 1 else ""
        few = f"too few rows remain. {f'{without}. Otherwise n' if without else 'N'}ame another column, or "
        way_out = (
            (self.units or f"{few}correct the file") if most else _way_out(self.rewrite if misread else "")
        )
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


def _way_out(rewrite: str) -> str:
    first = rewrite or "correct the file"
    return f"{first}, or exclude such rows with {DROP_MISSING.to()} (they will be counted)"


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
    gone: set[int] = set()
    starts = [0]

    def changes(row: int) -> bool:
        return numbers is not None and row < time.size and numbers[row] - numbers[row - 1] != 0

    for row in _breaks(time, numbers):
        last = _last_kept(gone, row, starts[-1])
        if changes(row):
            starts.append(row)
        elif time[row] >= time[last]:  # the row before was the odd one
            continue
        elif row + 1 < time.size and time[row + 1] >= time[last] and not changes(row + 1):
            gone.add(row)
            by = time[last] - time[row]
            left_out.add(
                1, [f"{place(row)}: time runs backwards by {by:.6g} s in this row"], out_of_order=True
            )
        elif last > starts[-1] and time[row] >= time[_last_kept(gone, last, starts[-1])]:
            gone.add(last)
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
    left = np.array(sorted(gone), dtype=np.intp)
    edges = [*starts, time.size]
    parts = np.split(left, np.searchsorted(left, edges[1:-1]))
    return [Rows(*run, part) for run, part in zip(itertools.pairwise(edges), parts, strict=True)]


def _breaks(time: FloatArray, numbers: FloatArray | None) -> list[int]:
    """Rows in which time falls back, or the number of the run changes."""

    def broken(block: slice) -> BoolArray:
        rows = slice(block.start, block.stop + 1)
        back = np.diff(time[rows]) < 0
        return np.asarray(back if numbers is None else back | (np.diff(numbers[rows]) != 0))

    channels = (time,) if numbers is None else (time, numbers)
    return [row + 1 for row in rows_where(broken, time.size - 1, *channels).tolist()]


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
    if gone.size:
        left_out.add(gone.size, itertools.chain.from_iterable(each.words for each in lacking.values()))
        whole = Rows(0, arrays["time"].size, gone)
        arrays, place = {role: whole.of(values) for role, values in arrays.items()}, whole.among(place)
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
    runs = [{role: part.of(values) for role, values in arrays.items()} for part in parts]
    runs = [_bridged(run, slow, part.among(place)) for run, part in zip(runs, parts, strict=True)]
    for channel in slow:
        gaps = LeftOut(channel.in_gaps, [f"{channel.first_gap}: {channel.role} '{channel.name}' has a gap"])
        gaps.refuse_many(file.name, rows, allowed=drop_missing)
    begins = [part.among(place)(0) for part in parts]
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
    record = replace(file, name=name, rows=run["time"].size, warnings=warnings)
    torque = run["torque"] if "torque" in run else np.full(run["time"].size, np.nan)
    others = run.get("temperature"), run.get("load")
    return Run(name, run["time"], torque, run["speed"], *others, position=run.get("position")), record


def _slow(
    file: LogFile, arrays: dict[str, FloatArray], lacking: Mapping[str, LeftOut]
) -> tuple[list[SlowChannel], IntArray]:
    """The slow channels, and the rows that lack a number of a channel that is not slow."""
    time, slow, gone = arrays["time"], [], np.empty(0, dtype=np.intp)
    names = {channel.role: channel.name for channel in file.channels}
    for role in (role for role, of_role in lacking.items() if of_role.rows):
        known = np.isfinite(arrays[role])
        if is_slow(known.size, int(known.sum())):
            channel = SlowChannel.of(role, names[role], time, known)
            if channel.interval <= LONGEST_INTERVAL:
                slow.append(channel)
                continue
        gone = np.union1d(gone, np.flatnonzero(~known))
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


def _last_kept(gone: set[int], row: int, start: int) -> int:
    """The row before this one that is used, in the run that begins at ``start``."""
    before = row - 1
    while before > start and before in gone:
        before -= 1
    return max(before, start)
