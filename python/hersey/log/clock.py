"""The clock of a log: rate, gaps, unevenness, stamps that stand still or step back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.result import OPEN, Means, Record
from hersey.schema.warning import Warning

#: Rows are missing where an interval is longer than so many usual ones (of an uneven clock: more).
GAP, GAP_OF_UNEVEN = 1.5, 5.0
#: A clock is uneven if more than this share of its intervals are off the usual one by more than this share of
#: it, beyond what the resolution of its stamps makes. Lost rows alone stay far below.
UNEVEN_SHARE, UNEVEN = 0.02, 0.10
#: So few different intervals are those of a clock that counts in steps.
_FEW = 12
#: Intervals looked at before all of them are.
_LOOKED_AT = 10_000


@dataclass(frozen=True)
class Clock(Record):
    """The times of a log's rows, in s.

    Attributes
    ----------
    name
        Channel that holds them.
    interval
        Usual time between rows (median; the mean where stamps repeat).
    resolution
        Step in which the stamps count, None where it is not known.
    uneven
        Share of the intervals that are off the usual one.
    gaps, longest_gap, lost
        Intervals in which rows are missing, the longest of them, and their sum beyond the usual interval.
    back, first_back
        Steps back in time, and the row (from 0) of the first, or None.
    repeated
        Rows with the time of the row before.
    """

    also_stated = ("warnings",)

    name: str
    rows: int
    missing: int
    duration: Annotated[float, OPEN]
    interval: Annotated[float, OPEN]
    resolution: float | None
    uneven: Annotated[float, Means("share of intervals that differ from the usual one", open=True)]
    gaps: int
    longest_gap: Annotated[float, OPEN]
    lost: Annotated[float, OPEN]
    back: int
    first_back: int | None
    repeated: int

    @property
    def is_uneven(self) -> bool:
        """Whether intervals differ by more than lost rows explain."""
        return self.uneven > UNEVEN_SHARE

    @property
    def warnings(self) -> Annotated[tuple[Warning, ...], Means("what is wrong with this clock")]:
        """What one must know of this clock."""
        found = (self._back(), self._uneven(), self._gaps(), self._repeated(), self._without_time())
        return tuple(each for each in found if each is not None)

    def _back(self) -> Warning | None:
        if not self.back:
            return None
        return Warning(
            "time steps back",
            "time steps back "
            + ("once" if self.back == 1 else "{times} times")
            + ("" if self.first_back is None else ", first at row {row}"),
            severity="act",
            remedy="split or sort the file there",
            times=self.back,
            row=None if self.first_back is None else self.first_back + 1,
        )

    def _uneven(self) -> Warning | None:
        if not self.is_uneven:
            return None
        return Warning(
            "clock uneven",
            "the clock is uneven: {share:.1f %} of its intervals are off by more than {limit:.0f %}",
            severity="watch",
            share=self.uneven,
            limit=UNEVEN,
        )

    def _gaps(self) -> Warning | None:
        if not self.gaps:
            return None
        return Warning(
            "rows missing",
            "rows are missing at {places} {places:place|places}: {lost:.3g} s in total, at most "
            "{longest:.3g} s at once",
            severity="watch",
            places=self.gaps,
            lost=self.lost,
            longest=self.longest_gap,
        )

    def _repeated(self) -> Warning | None:
        if not self.repeated:
            return None
        return Warning(
            "times repeated",
            "{rows} {rows:row repeats|rows repeat} the time of the previous row",
            rows=self.repeated,
        )

    def _without_time(self) -> Warning | None:
        if not self.missing:
            return None
        return Warning("rows without a time", "{rows} {rows:row has|rows have} no time", rows=self.missing)


def clock_of(name: str, time: FloatArray) -> Clock:
    """Return what the times of a log's rows (s, NaN where missing) show of their clock."""
    known = time[np.isfinite(time)]
    steps = np.diff(known)
    if not steps.size:
        return Clock(name, time.size, time.size - known.size, 0.0, 0.0, None, 0.0, 0, 0.0, 0.0, 0, None, 0)
    forward = steps[steps > 0]
    usual = float(np.median(steps))
    if usual <= 0:
        usual = float(np.sum(forward)) / max(1, steps.size)
    resolution = _resolution(known, forward)
    often = float(np.mean(np.abs(steps - usual) > UNEVEN * usual)) > UNEVEN_SHARE
    coarse = (resolution or 0.0) if often else 0.0  # rounded stamps alone make intervals one step longer
    allowed = max(UNEVEN * usual, 1.01 * coarse)
    gap = max(GAP * usual, usual + 1.5 * coarse)
    far = np.abs(steps - usual) > allowed
    whole_intervals = np.abs(steps / usual - np.round(steps / usual)) < UNEVEN if usual > 0 else far
    lost_rows = (steps > gap) & whole_intervals
    uneven = float(np.mean(far & ~lost_rows & (steps > 0)))
    if uneven > UNEVEN_SHARE:
        gap = max(gap, GAP_OF_UNEVEN * usual)
    gaps = steps > gap
    back = np.flatnonzero(steps < 0)
    return Clock(
        name=name,
        rows=time.size,
        missing=time.size - known.size,
        duration=float(known.max() - known.min()),
        interval=usual,
        resolution=resolution,
        uneven=uneven,
        gaps=int(np.count_nonzero(gaps)),
        longest_gap=float(steps[gaps].max()) if gaps.any() else 0.0,
        lost=float(np.sum(steps[gaps] - usual)),
        back=back.size,
        first_back=int(np.flatnonzero(np.isfinite(time))[back[0] + 1]) if back.size else None,
        repeated=int(np.count_nonzero(steps == 0)),
    )


def _resolution(time: FloatArray, forward: FloatArray) -> float | None:
    """Step in which stamps count: the least interval, if all others are multiples of it."""
    if not forward.size:
        return None
    precision = float(np.spacing(np.abs(time).max()))
    digits = max(0, int(-np.log10(max(4.0 * precision, 1e-9))))
    for steps in (forward[:_LOOKED_AT], forward):  # the first alone show most clocks that count in no steps
        levels = np.unique(np.round(steps, digits))
        levels = levels[levels > 0]
        if levels.size > _FEW:
            return None
    if not levels.size:
        return None
    step = float(np.min(np.diff(levels, prepend=0.0)))
    ratio = levels / step
    return step if step > 0 and np.all(np.abs(ratio - np.round(ratio)) < 0.05) else None
