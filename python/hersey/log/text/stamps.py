"""Times as text files write them: dates, times of day, elapsed times, seconds since 1970, days of Excel."""

from __future__ import annotations

import datetime
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.roles import EVERY
from hersey.log.text.numbers import NumberStyle, is_missing, with_thousands
from hersey.schema.warning import Warning

_CLOCK = r"[0-9]{1,2}:[0-9]{2}:[0-9]{2}([.,][0-9]{1,9})?"
_HALF = r" ?[AaPp]\.?[Mm]\.?"
_DAY, _HOUR = 86400.0, 3600.0
#: Days, hours, minutes, seconds of a clock without a date, and thousandths of a second behind a colon.
_PARTS = r"^(?:([0-9]+) days? )?(?:([0-9]+):)??([0-9]+):([0-9]{1,2}(?:\.[0-9]+)?)$"
_THOUSANDTHS = r":([0-9]{3})$"
#: The day of clocks without a date, ns since 1970.
_START = int(datetime.datetime(2000, 1, 1, tzinfo=datetime.UTC).timestamp()) * 10**9
#: Units of a count since 1970 by its size, between 2001 and 2049.
_EPOCHS = ((1e9, "s"), (1e12, "ms"), (1e15, "us"), (1e18, "ns"))
_EPOCH_NAME = re.compile(r"t|.*time.*|.*epoch.*|.*unix.*|zeit", re.IGNORECASE)
_DAYS_NAME = re.compile(r".*(date|datum|excel|serial).*", re.IGNORECASE)


@dataclass(frozen=True)
class StampStyle:
    """One way to write a time: ``format`` reads it once its separators are those of ISO.

    Without a ``format`` it is a clock without a date; ``period``, s, is the time after which it starts anew.
    """

    name: str
    pattern: str
    format: str = ""
    period: float = 0.0

    @property
    def is_time_of_day(self) -> bool:
        """Whether it lacks the day."""
        return self.period == _DAY

    def stamps(self, cells: pl.Series) -> pl.Series:
        """Return cells as time stamps in ns, null where one is missing or is none."""
        text = cells.str.strip_chars().str.replace(",", ".", literal=True)
        if not self.format:
            return _on_a_clock(text)
        if "%p" in self.format:  # 10:31:05 p.m. as 10:31:05 PM
            text = text.str.replace(r" ?([AaPp])\.?[Mm]\.?$", " ${1}M").str.to_uppercase()
        if self.name != "a German date":
            text = (
                text.str.replace(". ", " ", literal=True)
                .str.replace_all("/", "-", literal=True)
                .str.replace("T", " ", literal=True)
            )
        if "%b" in self.format:
            text = text.str.replace(r"^([0-9]{1,2})[- ]([A-Za-z]{3})[a-z]*[- ]", "$1-$2-")
        if self.is_time_of_day:
            text = "2000-01-01 " + text
        if self.format.endswith("%z"):
            text = text.str.replace("Z$", "+0000").str.replace(r" ?([+-][0-9]{2}):?([0-9]{2})$", "$1$2")
        stamps = text.str.to_datetime(self.format, time_unit="ns", strict=False)
        return stamps.dt.replace_time_zone(None) if self.format.endswith("%z") else stamps


_ISO = r"[0-9]{4}[-/][0-9]{1,2}[-/][0-9]{1,2}[T ]"
_AMERICAN = r"[0-9]{1,2}/[0-9]{1,2}/[0-9]{4},? "
_SHORT = r"[0-9]{1,2}/[0-9]{1,2}/[0-9]{2},? "
_MONTH = (
    "(?i:jan(uary)?|feb(ruary)?|mar(ch)?|apr(il)?|may|june?|july?|aug(ust)?|sep(tember)?|oct(ober)?"
    "|nov(ember)?|dec(ember)?)"
)
#: A millionth of a day, and the name of a clock of WinCC that counts them.
MILLIONTHS, OF_WINCC = "86.4 ms", "Time_ms"
#: More rows than this in what is written as a second are those of a minute.
_ROWS_OF_A_SECOND = 200
#: A time such as 0:05, which could be hours and minutes too.
_TWO_PARTS = "minutes and whole seconds"
_NAMED = rf"[0-9]{{1,2}}[- ]{_MONTH}[- ][0-9]{{4}} "
_STYLES = (
    StampStyle("a date with the month's name", _NAMED + _CLOCK, "%d-%b-%Y %H:%M:%S%.f"),
    StampStyle("an ISO date", _ISO + _CLOCK, "%Y-%m-%d %H:%M:%S%.f"),
    StampStyle("an ISO date", _ISO + _CLOCK + r"( ?Z| ?[+-][0-9]{2}:?[0-9]{2})", "%Y-%m-%d %H:%M:%S%.f%z"),
    StampStyle("a German date", r"[0-9]{1,2}\.[0-9]{1,2}\.[0-9]{4} " + _CLOCK, "%d.%m.%Y %H:%M:%S%.f"),
    StampStyle("a time of day", rf"{_CLOCK}|[0-9]{{1,2}}:[0-9]{{2}}:[0-9]{{2}}:[0-9]{{3}}", period=_DAY),
    StampStyle("a time of day, AM and PM", _CLOCK + _HALF, "%Y-%m-%d %I:%M:%S%.f %p", _DAY),
    StampStyle("days and a time", r"[0-9]+ days? " + _CLOCK),
    StampStyle("minutes and seconds", r"[0-9]{1,3}:[0-9]{2}[.,][0-9]{1,9}", period=_HOUR),
    StampStyle(_TWO_PARTS, r"[0-9]{1,3}:[0-9]{2}", period=_HOUR),
    StampStyle("an ISO date, AM and PM", _ISO + _CLOCK + _HALF, "%Y-%m-%d %I:%M:%S%.f %p"),
    StampStyle("a date, month first", _AMERICAN + _CLOCK, "%m-%d-%Y %H:%M:%S%.f"),
    StampStyle("a date, day first", _AMERICAN + _CLOCK, "%d-%m-%Y %H:%M:%S%.f"),
    StampStyle("a date, month first, AM and PM", _AMERICAN + _CLOCK + _HALF, "%m-%d-%Y %I:%M:%S%.f %p"),
    StampStyle("a date, day first, AM and PM", _AMERICAN + _CLOCK + _HALF, "%d-%m-%Y %I:%M:%S%.f %p"),
    StampStyle("a date, month first", _SHORT + _CLOCK, "%m-%d-%y %H:%M:%S%.f"),
    StampStyle("a date, day first", _SHORT + _CLOCK, "%d-%m-%y %H:%M:%S%.f"),
    StampStyle("a date, month first, AM and PM", _SHORT + _CLOCK + _HALF, "%m-%d-%y %I:%M:%S%.f %p"),
    StampStyle("a date, day first, AM and PM", _SHORT + _CLOCK + _HALF, "%d-%m-%y %I:%M:%S%.f %p"),
)
_DAY_FIRST = re.compile(r"(1[3-9]|2[0-9]|3[01])/")


def _on_a_clock(text: pl.Series) -> pl.Series:
    """Times without a date, in words such as 1:02:03.5 or 2:03.5, as stamps of the first day of 2000."""
    parts = text.str.replace(_THOUSANDTHS, ".$1").str.extract_groups(_PARTS).struct.unnest()
    days, hours, minutes, seconds = (parts.to_series(i).cast(pl.Float64) for i in range(4))
    sound = (seconds < 61.0) & (hours.is_null() | (minutes < 60.0))
    total = days.fill_null(0.0) * _DAY + hours.fill_null(0.0) * _HOUR + minutes * 60.0 + seconds
    since = pl.Series((total * 1e9).round().cast(pl.Int64)).set(~sound.fill_null(False), None)
    return (since + _START).cast(pl.Datetime("ns"))


def is_stamp(cell: str) -> bool:
    """Return whether a cell is a time stamp."""
    return ":" in cell and any(re.fullmatch(style.pattern, cell) for style in _STYLES)


def stamp_style(cells: list[str]) -> StampStyle | None:
    """Return how a column writes its time stamps, or None if most of its cells are none."""
    if 2 * sum(":" in cell for cell in cells) <= len(cells):
        return None
    for style in _STYLES:
        count = sum(re.fullmatch(style.pattern, cell) is not None for cell in cells)
        if 2 * count > len(cells):
            day_first = any(_DAY_FIRST.match(cell) for cell in cells)
            if "month first" not in style.name or not day_first:
                return style
    return None


class Stamps:
    """The time stamps of one column as s since the first of them, block after block."""

    def __init__(self, style: StampStyle) -> None:
        self.style = style
        self.first: int | None = None
        self.midnights = 0
        self._last = -np.inf

    def values(self, cells: pl.Series) -> FloatArray | None:
        """Return the times, NaN where one is missing, or None if a cell is no time stamp."""
        stamps = self.style.stamps(cells)
        gone = stamps.is_null().to_numpy()
        if not _readable(cells, stamps).all():
            return None
        ticks = stamps.dt.timestamp("ns").fill_null(0).to_numpy()
        if self.first is None and not gone.all():
            self.first = int(ticks[~gone][0])
        times = np.where(gone, np.nan, (ticks - (self.first or 0)) * 1e-9)
        return self._past_its_period(times) if self.style.period else times

    def readable(self, cells: pl.Series) -> pl.Series:
        """Return for each cell of text whether it is a time stamp or stands for a missing one."""
        return _readable(cells, self.style.stamps(cells))

    def warning(self, column: str) -> Warning:
        """Return how the stamps of a column were read."""
        first = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=(self.first or 0) // 1000)
        no_date = not self.style.format or self.style.is_time_of_day
        since = first.strftime("%H:%M:%S" if no_date else "%Y-%m-%d %H:%M:%S")
        unsure = self.style.name == _TWO_PARTS
        return Warning(
            "time stamps read",
            "'{column}' contains {style} and was read as seconds since {since}"
            + (", with {midnights} {midnights:change|changes} of {period}" if self.midnights else ""),
            severity="watch" if unsure else "note",
            remedy="if these are hours and minutes, export the column with seconds, e.g. 1:02:03, or give "
            "the time between rows, e.g. {every:50 ms}"
            if unsure
            else "",
            column=column,
            style=self.style.name,
            since=since,
            midnights=self.midnights,
            period="day" if self.style.is_time_of_day else "hour",
            every=EVERY,
        )

    def _past_its_period(self, times: FloatArray) -> FloatArray:
        """A clock that falls by more than half its period has started anew."""
        known = np.flatnonzero(np.isfinite(times))
        if known.size:
            steps = np.diff(times[known], prepend=self._last)
            midnights = self.midnights + np.cumsum(steps < -self.style.period / 2)
            self._last, self.midnights = float(times[known[-1]]), int(midnights[-1])
            times[known] += self.style.period * midnights
        return times


def refuse_whole_minutes(place: str, stamps: Stamps, time: FloatArray) -> None:
    """Raise if so many rows share each time that its seconds were lost: ``time`` in s, shape (rows,).

    Raises
    ------
    UnreadableLogError
        It says how long one row lasts if a time is a minute.
    """
    if stamps.style.name != _TWO_PARTS or not time.size:
        return
    rows = float(np.median(np.unique(time, return_counts=True)[1]))
    if rows > _ROWS_OF_A_SECOND and float(np.max(time)) + _seconds_of_day(stamps) < _DAY / 60.0:
        hours, minutes = (EVERY.to(f"{one / rows:.2g} s", python=f"{one / rows:.2g}") for one in (60.0, 1.0))
        raise UnreadableLogError(
            f"{place} shows only two numbers, each pair in {rows:.0f} rows",
            remedy=f"export it with decimals of the second, or give the time between rows: {hours} if it "
            f"shows hours and minutes, {minutes} if minutes and seconds",
        )


def _seconds_of_day(stamps: Stamps) -> float:
    """The first time of a clock without a date, s."""
    return ((stamps.first or _START) - _START) * 1e-9


def numbers_in(cells: pl.Series, written: NumberStyle | Stamps) -> tuple[FloatArray, pl.Series]:
    """Return cells of text as numbers, or times in s, and which of them are odd: these become NaN."""
    odd = ~written.readable(cells)
    if isinstance(written, NumberStyle) and odd.any():  # thousands marks may first come far down a file
        written = with_thousands(written, cells.filter(odd).str.strip_chars().to_list())
        odd = ~written.readable(cells)
    values = written.values(cells.set(odd, ""))
    assert values is not None
    return values, odd


def _readable(cells: pl.Series, stamps: pl.Series) -> pl.Series:
    missing = [cell is None or is_missing(cell.strip()) for cell in cells]
    return stamps.is_not_null() | pl.Series(missing, dtype=pl.Boolean)


def is_clock_name(name: str) -> bool:
    """Return whether a column so called could hold a count since 1970 or days of Excel."""
    return bool(_EPOCH_NAME.fullmatch(name) or _DAYS_NAME.fullmatch(name))


def counted_since(name: str, numbers: FloatArray) -> tuple[str, str]:
    """Return unit and meaning of a clock without unit that counts from a known day, or two empty words.

    Counts since 1970 show by their size. Days of Excel are believed only of a column whose name speaks of a
    date, because a stopwatch in ms shows such numbers too.
    """
    known = numbers[np.isfinite(numbers)]
    if not known.size or not is_clock_name(name):
        return "", ""
    low, high = float(known.min()), float(known.max())
    for scale, unit in _EPOCHS:
        if scale <= low and high < 2.5 * scale:
            return unit, f"{unit} since 1970"
    if _DAYS_NAME.fullmatch(name) and low > 3e4 and high < 7e4:
        return "d", "Excel days"
    if low > 3e10 and high < 7e10:  # WinCC calls this Time_ms; a count in ms would end in 1972
        return MILLIONTHS, "Excel days times a million"
    return "", ""


def counted_unit(name: str, unit: str, numbers: Callable[[], FloatArray]) -> tuple[str, str]:
    """Return unit and meaning of a clock as `counted_since` does, two empty words if its own unit holds.

    Only ``Time_ms`` may count otherwise than its unit says.
    """
    if unit and (name, unit) != (OF_WINCC, "ms"):
        return "", ""
    found, meaning = counted_since(name, numbers())
    return (found, meaning) if not unit or found == MILLIONTHS else ("", "")


def clock_without_unit(column: str, meaning: str) -> Warning:
    """Return the warning of a clock whose unit is not written, and was found by `counted_since`."""
    return Warning(
        "clock without unit",
        "'{column}' has no unit and was read as {meaning}",
        column=column,
        meaning=meaning,
    )
