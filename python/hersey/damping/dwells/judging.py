"""Whether a stretch of a run is a dwell, and which rows of it are."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hersey.damping.dwells.disturbances import without_spikes, without_wave
from hersey.damping.dwells.reasons import Kind, Reason
from hersey.damping.dwells.rejection import Rejection
from hersey.damping.dwells.segments import Segment
from hersey.damping.dwells.settling import settled
from hersey.damping.dwells.shared_noise import SharedNoise
from hersey.damping.dwells.steadiness import unsteady
from hersey.log.long_arrays import mean
from hersey.log.torque_log import Run

#: Where a dwell that drifts is tried again, as shares of it cut from its start.
LATER_STARTS = (0.3, 0.5, 0.65, 0.8, 0.9)
#: What a disturbance of the torque alone may cause.
_OF_TORQUE: tuple[Kind, ...] = ("too short", "stick-slip", "swing", "torque drift")


@dataclass(frozen=True)
class Asked:
    """What is asked of a dwell: its least duration, s, and ``both``, ``forward`` or ``reverse`` rotation."""

    min_dwell: float
    rotation: str


@dataclass(frozen=True)
class Stretch:
    """A segment of a run, and the speed held before it, rad/s without sign."""

    run: int
    segment: Segment
    previous: float | None

    @property
    def approach(self) -> str:
        """Whether the speed was come to ``from below``, ``from above``, or is the first (``start``)."""
        if self.previous is None:
            return "start"
        return "from below" if self.previous < abs(self.segment.speed) else "from above"


@dataclass(frozen=True)
class Dwell(Stretch):
    """Rows [start, end) of a stretch that are steady."""

    start: int
    end: int


def judged(
    run: Run,
    stretch: Stretch,
    asked: Asked,
    tare: float,
    noise: SharedNoise | None,
    common: float = 0.0,
    step: float = 0.0,
) -> Dwell | Rejection:
    """Return the dwell in a stretch, or why there is none.

    Parameters
    ----------
    tare
        Torque to subtract, N m.
    noise
        What the dwells of the log show; without it each is judged by its own noise.
    common
        How long dwells that are come to like this one take to settle, s.
    step
        In which the torque sensor counts, N m; 0 if not known.
    """
    segment = stretch.segment

    def reject(reason: Reason) -> Rejection:
        start, end = float(run.time[segment.start]), float(run.time[segment.end - 1])
        return Rejection(stretch.run, start, end, segment.end - segment.start, reason, segment.speed)

    if reason := _no_dwell(segment, asked):
        return reject(reason)
    judge = _Judge(run, segment, asked, tare, noise, common, step)
    start, end, reason = judge.steady_rows()
    if reason:
        return reject(_spoilt(judge, reason) or reason)
    if mean(run.speed[start:end]) * (mean(run.torque[start:end]) - tare) <= 0:
        return reject(Reason("opposite signs"))
    return Dwell(stretch.run, segment, stretch.previous, start, end)


@dataclass(frozen=True)
class _Judge:
    """What a segment is judged by; the numbers as of `judged`."""

    run: Run
    segment: Segment
    asked: Asked
    tare: float
    noise: SharedNoise | None
    common: float
    step: float

    def _unsteady(self, start: int, end: int, *, ripple: bool = False) -> Reason | None:
        asked, noise = self.asked, self.noise
        return unsteady(self.run, start, end, asked.min_dwell, self.tare, noise, ripple, self.step)

    def steady_rows(self) -> tuple[int, int, Reason | None]:
        """Return the rows [start, end) of the segment that may be a dwell, and why they are none."""
        segment, interval = self.segment, self.run.sampling_interval
        start, end = segment.start, segment.end
        if not segment.ripple:
            start, end = settled(self.run, segment, self.noise)
            later = segment.start + round(self.common / interval)
            if later > start and end - later >= max((end - start) / 2.0, self.asked.min_dwell / interval):
                start = later
        reason = self._unsteady(start, end, ripple=segment.ripple)
        for share in LATER_STARTS:  # a warm-up at the same speed may come before what is steady
            if reason is None or not reason.drifts or segment.ripple:
                break
            later = start + round(share * (end - start))
            if self._unsteady(later, end) is None:
                start, reason = later, None
        return start, end, reason

    @property
    def alone(self) -> Run:
        """The rows of the segment as a run."""
        rows = slice(self.segment.start, self.segment.end)
        kelvin = None if self.run.temperature is None else self.run.temperature[rows]
        parts = {name: getattr(self.run, name)[rows] for name in ("time", "torque", "speed")}
        return replace(self.run, **parts, temperature=kelvin, load=None)

    def is_steady(self, run: Run) -> bool:
        """Return whether the segment alone, its torque another, is a dwell."""
        segment = replace(self.segment, start=0, end=run.time.size)
        return replace(self, run=run, segment=segment).steady_rows()[2] is None


def _spoilt(judge: _Judge, reason: Reason) -> Reason | None:
    """The spikes or the ripple without which a segment were a dwell, or None.

    A stick-slip is as periodic as a ripple: only spikes can look like it.
    """
    lasts = float(judge.run.time[judge.segment.end - 1] - judge.run.time[judge.segment.start])
    if reason.kind not in _OF_TORQUE or lasts < judge.asked.min_dwell:
        return None
    run = judge.alone
    level = abs(float(np.median(run.torque)) - judge.tare)
    if level == 0.0:
        return None
    if found := without_spikes(run.torque):
        torque, spikes = found
        if judge.is_steady(replace(run, torque=torque)):
            return Reason("spikes", share=spikes.size / level, count=spikes.count, seen_as=reason.kind)
    if reason.kind != "stick-slip" and (wavy := without_wave(run.time, run.torque)):
        torque, wave = wavy
        if judge.is_steady(replace(run, torque=torque)):
            turns = abs(judge.segment.speed) / (2.0 * np.pi)
            level = abs(float(np.mean(torque)) - judge.tare)
            return Reason(
                "ripple",
                share=wave.amplitude / level,
                frequency=wave.frequency,
                per_turn=wave.frequency / turns,
                lasts=lasts,
                seen_as=reason.kind,
            )
    return None


def _no_dwell(segment: Segment, asked: Asked) -> Reason | None:
    """Why a stretch is no dwell whatever its torque, or None."""
    if not segment.steady:
        return Reason("changing", rows=segment.end - segment.start)
    if segment.standing:
        return Reason("standing")
    if asked.rotation != "both" and (segment.speed > 0) != (asked.rotation == "forward"):
        return Reason("other rotation", asked=asked.rotation)
    return None
