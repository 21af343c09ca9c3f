"""Whether a stretch of a run is a dwell, and which rows of it are."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hersey.damping.dwells.disturbances import without_spikes, without_wave
from hersey.damping.dwells.points import Rejection
from hersey.damping.dwells.reasons import Kind, Reason
from hersey.damping.dwells.segments import Segment
from hersey.damping.dwells.settling import settled
from hersey.damping.dwells.shared_noise import SharedNoise
from hersey.damping.dwells.steadiness import unsteady
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
    start, end, reason = _steady_rows(run, segment, asked, tare, noise, common, step)
    if reason:
        again = _Again(run, segment, asked, tare, noise, common, step)
        return reject(_spoilt(again, reason) or reason)
    if np.mean(run.speed[start:end]) * (np.mean(run.torque[start:end]) - tare) <= 0:
        return reject(Reason("opposite signs"))
    return Dwell(stretch.run, segment, stretch.previous, start, end)


def _steady_rows(
    run: Run,
    segment: Segment,
    asked: Asked,
    tare: float,
    noise: SharedNoise | None,
    common: float,
    step: float,
) -> tuple[int, int, Reason | None]:
    """The rows [start, end) of a segment that may be a dwell, and why they are none."""
    if segment.ripple:
        start, end = segment.start, segment.end
    else:
        start, end = settled(run, segment, noise)
        later = segment.start + round(common / run.sampling_interval)
        if later > start and end - later >= max((end - start) / 2.0, asked.min_dwell / run.sampling_interval):
            start = later
    reason = unsteady(run, start, end, asked.min_dwell, tare, noise, segment.ripple, step)
    for share in LATER_STARTS:  # a warm-up at the same speed may come before what is steady
        later = start + round(share * (end - start))
        if (
            reason
            and reason.drifts
            and not segment.ripple
            and unsteady(run, later, end, asked.min_dwell, tare, noise, step=step) is None
        ):
            start, reason = later, None
    return start, end, reason


@dataclass(frozen=True)
class _Again:
    """How a segment was judged, so that it can be judged again with another torque."""

    run: Run
    segment: Segment
    asked: Asked
    tare: float
    noise: SharedNoise | None
    common: float
    step: float

    @property
    def alone(self) -> Run:
        """The rows of the segment as a run."""
        rows = slice(self.segment.start, self.segment.end)
        kelvin = None if self.run.temperature is None else self.run.temperature[rows]
        return replace(
            self.run,
            time=self.run.time[rows],
            torque=self.run.torque[rows],
            speed=self.run.speed[rows],
            temperature=kelvin,
            load=None,
        )

    def is_steady(self, run: Run) -> bool:
        """Whether the segment alone, its torque another, is a dwell."""
        segment = replace(self.segment, start=0, end=run.time.size)
        found = _steady_rows(run, segment, self.asked, self.tare, self.noise, self.common, self.step)
        return found[2] is None


def _spoilt(again: _Again, reason: Reason) -> Reason | None:
    """The spikes or the ripple without which a segment were a dwell, or None.

    A stick-slip is as periodic as a ripple: only spikes can look like it.
    """
    lasts = float(again.run.time[again.segment.end - 1] - again.run.time[again.segment.start])
    if reason.kind not in _OF_TORQUE or lasts < again.asked.min_dwell:
        return None
    run = again.alone
    level = abs(float(np.median(run.torque)) - again.tare)
    if level == 0.0:
        return None
    if found := without_spikes(run.torque):
        torque, spikes = found
        if again.is_steady(replace(run, torque=torque)):
            return Reason("spikes", share=spikes.size / level, count=spikes.count, seen_as=reason.kind)
    if reason.kind != "stick-slip" and (wavy := without_wave(run.time, run.torque)):
        torque, wave = wavy
        if again.is_steady(replace(run, torque=torque)):
            turns = abs(again.segment.speed) / (2.0 * np.pi)
            level = abs(float(np.mean(torque)) - again.tare)
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
