"""Stretches of a log with an even clock, as filters need them.

Where the angle was recorded, the speed is its difference over five rows here, whatever window made the speed
of the log: the low-pass that follows is the same for torque and speed, a window of the speed alone is not.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.clock import GAP, GAP_OF_UNEVEN
from hersey.log.derived.position import smallest_step
from hersey.log.torque_log import Run, TorqueLog

#: Rows that are filtered as they are; of a longer log, means of neighbours.
MOST_ROWS = 60_000
#: First difference over five rows, exact up to the fourth power.
FIRST = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
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
    angle: FloatArray | None = None  #: rad, if it is known

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
                found.append(_of_its_angle(_averaged(stretch, together)))
    return [each for each in found if each.torque.size > 1]


def counting_step(log: TorqueLog) -> float:
    """Return the step in which the angle counts, rad; 0 if none was recorded or it has none."""
    steps = [smallest_step(run.position) for run in log.runs if run.position is not None]
    return max(steps, default=0.0)


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
    recorded = (run.torque, run.speed, run.temperature, run.position)
    channels = [None if each is None else each[rows] for each in recorded]
    even = time[0] + interval * np.arange(time.size)
    if np.max(np.abs(time - even)) > _EVEN * interval:
        even = np.arange(time[0], time[-1] + 1e-6 * interval, interval)
        channels = [None if each is None else np.interp(even, time, each) for each in channels]
    torque, speed, kelvin, angle = channels
    assert torque is not None
    assert speed is not None
    return Stretch(index, float(time[0]), interval, torque, speed, kelvin, time.size, angle)


def _averaged(stretch: Stretch, together: int) -> Stretch:
    """Means of so many neighbours each; a filter as any other, and the same for all channels."""
    if together == 1:
        return stretch

    def means(values: FloatArray) -> FloatArray:
        return np.asarray(values[: values.size // together * together].reshape(-1, together).mean(axis=1))

    kelvin, angle = stretch.temperature, stretch.angle
    return Stretch(
        stretch.run,
        stretch.start + 0.5 * (together - 1) * stretch.interval,
        together * stretch.interval,
        means(stretch.torque),
        means(stretch.speed),
        None if kelvin is None else means(kelvin),
        stretch.rows,
        None if angle is None else means(angle),
    )


def _of_its_angle(stretch: Stretch) -> Stretch:
    """The same with the speed from the angle, without two rows at each end."""
    if stretch.angle is None:
        return stretch
    edge = FIRST.size // 2
    inner = slice(edge, -edge)
    return replace(
        stretch,
        start=stretch.start + edge * stretch.interval,
        torque=stretch.torque[inner],
        speed=np.correlate(stretch.angle, FIRST, "valid") / stretch.interval,
        temperature=None if stretch.temperature is None else stretch.temperature[inner],
        angle=stretch.angle[inner],
    )
