"""Whether a stretch of a run is a dwell, and which rows of it are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.damping.dwells.groups import MIN_SAMPLES
from hersey.damping.dwells.points import Rejection
from hersey.damping.dwells.segments import Segment
from hersey.damping.dwells.settling import settled
from hersey.damping.dwells.shared_noise import SharedNoise
from hersey.damping.dwells.steadiness import unsteady
from hersey.log.torque_log import Run

#: Where a dwell that drifts is tried again, as shares of it cut from its start.
LATER_STARTS = (0.3, 0.5, 0.65, 0.8, 0.9)


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

    def reject(reason: str) -> Rejection:
        start, end = float(run.time[segment.start]), float(run.time[segment.end - 1])
        return Rejection(stretch.run, start, end, segment.end - segment.start, reason, segment.speed)

    reason = _no_dwell(segment, asked)
    if reason:
        return reject(reason)
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
            and not segment.ripple
            and reason.startswith(("temperature drifts", "torque drifts"))
            and unsteady(run, later, end, asked.min_dwell, tare, noise, step=step) is None
        ):
            start, reason = later, None
    if reason:
        return reject(reason)
    if np.mean(run.speed[start:end]) * (np.mean(run.torque[start:end]) - tare) <= 0:
        return reject("torque and speed have opposite signs: turn one with --torque-sign -1")
    return Dwell(stretch.run, segment, stretch.previous, start, end)


def _no_dwell(segment: Segment, asked: Asked) -> str | None:
    """Why a stretch is no dwell whatever its torque, or None."""
    if not segment.steady:
        few = segment.end - segment.start < MIN_SAMPLES
        return f"speed changing, or held for fewer than {MIN_SAMPLES} rows" if few else "speed changing"
    if segment.standing:
        return "drive standing"
    if asked.rotation != "both" and (segment.speed > 0) != (asked.rotation == "forward"):
        return f"rotation not {asked.rotation}, as asked"
    return None
