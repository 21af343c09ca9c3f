"""Channels that are slower than the rows of their table: blank cells between the values.

A temperature, or a load from which no torque is computed, changes slowly: it is interpolated linearly between
its own values. Torque, speed, radius and time never are: a row that lacks one of them is no row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.schema.warning import Warning

#: A channel is slow if it has a value in this share of the rows at the most.
SLOW = 0.5
#: Fewest values of a slow channel, and its longest usual interval, s: a temperature that is written where it
#: changes alone, or by hand, tells nothing of what lies between.
FEWEST, LONGEST_INTERVAL = 10, 10.0
#: Longest gap that is bridged, in usual intervals between the values of the channel.
LONGEST_GAP = 3.0


def is_slow(rows: int, known: int) -> bool:
    """Return whether a channel with so many values in so many rows is slower than its table."""
    return FEWEST <= known <= SLOW * rows


@dataclass
class SlowChannel:
    """A slow channel: the usual time between its values, s, and what became of its rows."""

    role: str
    name: str
    interval: float
    rows_per_value: float
    outside: int = 0  #: rows before its first value of a run, or after its last
    in_gaps: int = 0  #: rows in gaps that are too long
    first_gap: str = ""  #: where the first of those gaps begins

    @classmethod
    def of(cls, role: str, name: str, time: FloatArray, known: BoolArray) -> SlowChannel:
        """Return a channel with values in the rows that are ``known``; ``time`` in s, shape (rows,)."""
        steps = np.diff(time[known])
        forward = steps[steps > 0]
        interval = float(np.median(forward)) if forward.size else 0.0
        return cls(role, name, interval, known.size / int(known.sum()))

    def filled(self, time: FloatArray, values: FloatArray, place: Callable[[int], str]) -> FloatArray:
        """Return the values of a run, NaN in rows that no two near values enclose; rows lost are counted.

        ``place`` gives a row of the run in words.
        """
        known = np.flatnonzero(np.isfinite(values))
        if known.size < 2:
            self.outside += values.size - known.size
            return values
        filled = np.interp(time, time[known], values[known], left=np.nan, right=np.nan)
        filled[known] = values[known]
        self.outside += int(np.count_nonzero(np.isnan(filled)))
        steps = np.diff(time[known])
        wide = steps > LONGEST_GAP * self.interval
        for before, after in zip(known[:-1][wide], known[1:][wide], strict=True):
            filled[before + 1 : after] = np.nan
            self.first_gap = self.first_gap or place(int(before) + 1)
            self.in_gaps += int(after - before - 1)
        return filled

    @property
    def lost(self) -> int:
        """Rows that have no value."""
        return self.outside + self.in_gaps

    def warnings(self) -> list[Warning]:
        """Return what was done to the channel, and the rows that it cost."""
        out = [
            Warning(
                "slow channel interpolated",
                "{role} '{channel}' has 1 value per {rows_per_value:.3g} rows (every {interval:.3g} s) "
                "and was interpolated linearly",
                role=self.role,
                channel=self.name,
                rows_per_value=self.rows_per_value,
                interval=self.interval,
            )
        ]
        if self.outside:
            out.append(
                Warning(
                    "rows outside a slow channel",
                    "{rows} {rows:row|rows} before the first or after the last value of {role} "
                    "'{channel}' {rows:was|were} excluded",
                    rows=self.outside,
                    role=self.role,
                    channel=self.name,
                )
            )
        if self.in_gaps:
            out.append(
                Warning(
                    "gaps of a slow channel",
                    "{rows} {rows:row was|rows were} excluded in gaps of {role} '{channel}' longer "
                    "than {longest:.3g} s, the first at {first}",
                    rows=self.in_gaps,
                    role=self.role,
                    channel=self.name,
                    longest=LONGEST_GAP * self.interval,
                    first=self.first_gap,
                )
            )
        return out
