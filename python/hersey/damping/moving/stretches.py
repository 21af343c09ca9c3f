"""Stretches of a log with an even clock, as filters need them."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.clock import GAP, GAP_OF_UNEVEN
from hersey.log.torque_log import Run, TorqueLog

#: Rows that are filtered as they are; of a longer log, means of neighbours.
MOST_ROWS = 60_000
#: A clock that differs from an even one by less than this share of its interval is taken as it is.
_EVEN = 0.01


@dataclass(frozen=True)
class Stretch:
    """Rows of a run without a gap, at one interval; arrays of shape (rows,) in N m, rad/s and K."""

    run: int
    start: float  #: time of the first row, s
    interval: float  #: s
    torque: FloatArray
    speed: FloatArray
    temperature: FloatArray | None
    rows: int  #: of the log, before neighbours were averaged

    @property
    def time(self) -> FloatArray:
        """Times of the rows, s."""
        return np.asarray(self.start + self.interval * np.arange(self.torque.size), dtype=np.float64)


def stretches_of(log: TorqueLog) -> list[Stretch]:
    """Return the log cut at its gaps, with all stretches at the same interval."""
    interval = max(run.sampling_interval for run in log.runs)
    together = max(1, log.rows // MOST_ROWS)
    found = []
    for index, run in enumerate(log.runs):
        for first, last in _without_gaps(run):
            stretch = _even(index, run, slice(first, last), interval)
            if stretch.torque.size >= 2 * together:
                found.append(_averaged(stretch, together))
    return found


def _without_gaps(run: Run) -> list[tuple[int, int]]:
    """First row and row after the last of each part without a gap."""
    beyond = GAP_OF_UNEVEN if run.clock.is_uneven else GAP
    steps = np.diff(run.time)
    ends = np.flatnonzero((steps > beyond * run.sampling_interval) | (steps < 0.0)) + 1
    edges = [0, *ends.tolist(), run.time.size]
    return [(a, b) for a, b in itertools.pairwise(edges) if b - a > 1]


def _even(index: int, run: Run, rows: slice, interval: float) -> Stretch:
    """Rows at even times: as they are if they come so, else between neighbours."""
    time = run.time[rows]
    channels = [run.torque[rows], run.speed[rows], None if run.temperature is None else run.temperature[rows]]
    even = time[0] + interval * np.arange(time.size)
    if np.max(np.abs(time - even)) > _EVEN * interval:
        even = np.arange(time[0], time[-1] + 1e-6 * interval, interval)
        channels = [None if each is None else np.interp(even, time, each) for each in channels]
    torque, speed, kelvin = channels
    assert torque is not None
    assert speed is not None
    return Stretch(index, float(time[0]), interval, torque, speed, kelvin, time.size)


def _averaged(stretch: Stretch, together: int) -> Stretch:
    """Means of so many neighbours each; a filter as any other, and the same for all channels."""
    if together == 1:
        return stretch

    def means(values: FloatArray) -> FloatArray:
        return np.asarray(values[: values.size // together * together].reshape(-1, together).mean(axis=1))

    kelvin = stretch.temperature
    return Stretch(
        stretch.run,
        stretch.start + 0.5 * (together - 1) * stretch.interval,
        together * stretch.interval,
        means(stretch.torque),
        means(stretch.speed),
        None if kelvin is None else means(kelvin),
        stretch.rows,
    )
