"""Stretches of a run in which the speed holds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import MIN_SAMPLES
from hersey.log.long_arrays import means_of
from hersey.log.torque_log import Run

#: Length of the blocks in which speed is judged, s, and how many a run may have at most.
BLOCK_DURATION, MAX_BLOCKS = 0.2, 200_000
#: Speed may stray from the mean of a dwell by this share, or by this many standard deviations of a block.
SPEED_TOLERANCE, SPEED_NOISE = 0.05, 4.0
#: An excursion of the speed shorter than this, s, does not end a dwell.
MAX_EXCURSION = 1.0


@dataclass(frozen=True)
class Segment:
    """Rows [start, end) of a run; ``steady`` if the speed holds, ``speed`` its mean.

    A dwell whose speed ripples with the shaft (``ripple``) is whole revolutions.
    """

    start: int
    end: int
    speed: float
    steady: bool
    standing: bool
    ripple: bool = False


def segments_of(run: Run) -> list[Segment]:
    """Cut a run where the speed changes, judged on block means against the noise about them."""
    rows, standing = run.time.size, run.domain.standing
    duration = float(run.time[-1] - run.time[0])
    per_second = rows / duration if duration > 0 else rows
    block = max(1, round(per_second * BLOCK_DURATION), -(-rows // MAX_BLOCKS))
    means = means_of(run.speed, block)
    noise = local_noise(means)
    cuts = [0]
    total, count = means[0], 1
    for i in range(1, means.size):
        mean = total / count
        if abs(means[i] - mean) <= max(SPEED_TOLERANCE * abs(mean), SPEED_NOISE * noise[i], standing):
            total, count = total + means[i], count + 1
        else:
            cuts.append(i)
            total, count = means[i], 1
    segments = []
    for first, last in zip(cuts, [*cuts[1:], means.size], strict=True):
        start, end = first * block, min(last * block, rows)
        speed = float(np.mean(run.speed[start:end]))
        run.passed(start, end)
        long = run.time[end - 1] - run.time[start] >= 5 * BLOCK_DURATION and end - start >= MIN_SAMPLES
        chance = 3.0 * float(np.median(noise[first:last])) / (last - first) ** 0.5
        still = abs(speed) <= max(standing, chance)
        segments.append(Segment(start, end, speed, bool(long), still))
    return _joined(run, _surely_standing(segments))


def local_noise(means: FloatArray) -> FloatArray:
    """Standard deviation of block means about the speed held, near each block.

    Three quarters of the changes between neighbours are noise: 1.627 turns that quantile into a deviation.
    """
    changes = np.abs(np.diff(means, prepend=means[:1]))
    window = min(25, changes.size)
    # as `scipy.ndimage.percentile_filter`, which takes longer to import than this to run
    around = np.pad(changes, (window // 2, window - 1 - window // 2), mode="symmetric")
    place = 3 * window // 4
    return np.partition(sliding_window_view(around, window), place, axis=1)[:, place] / 1.627


def _surely_standing(segments: list[Segment]) -> list[Segment]:
    """A drive stands only if it is far slower than wherever it surely moves."""
    moving = [abs(s.speed) for s in segments if s.steady and not s.standing]
    slowest = min(moving, default=np.inf)
    return [replace(s, standing=s.standing and abs(s.speed) <= 0.05 * slowest) for s in segments]


def _joined(run: Run, segments: list[Segment]) -> list[Segment]:
    """Join pieces of changing speed into one stretch, and dwells that only an excursion parts."""
    joined: list[Segment] = []
    for segment in segments:
        joined.append(segment)
        while len(joined) > 1 and not joined[-1].steady and not joined[-2].steady:
            last = joined.pop()
            joined[-1] = replace(joined[-1], end=last.end)
        if not segment.steady:
            continue
        for apart in (2, 3):
            if len(joined) >= apart and _same_dwell(run, joined[-apart], segment):
                first = joined[-apart]
                speed = float(np.mean(run.speed[first.start : segment.end]))
                joined[-apart:] = [replace(first, end=segment.end, speed=speed)]
                break
        run.passed(joined[-1].start, segment.end)
    return joined


def _same_dwell(run: Run, before: Segment, after: Segment) -> bool:
    apart = run.time[after.start] - run.time[before.end - 1]
    strayed = abs(after.speed - before.speed)
    near = strayed <= SPEED_TOLERANCE * max(abs(before.speed), abs(after.speed))
    return before.steady and apart <= MAX_EXCURSION and (near or (before.standing and after.standing))
