"""Where a dwell has settled: by what it shows itself, and by what all dwells show together.

A tail that is lost in the noise of one dwell stands out of the mean of many: torque beside its settled level,
averaged over the dwells that were come to in the same way, at the same time after the change of speed.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.noise import means_of_whole
from hersey.damping.dwells.segments import BLOCK_DURATION, SPEED_NOISE, Segment
from hersey.damping.dwells.shared_noise import Powers, SharedNoise
from hersey.damping.dwells.steadiness import MAX_SPEED_DRIFT, SIGNIFICANT, subtracted
from hersey.log.long_arrays import blocks, let_go, mean
from hersey.log.torque_log import Run

#: Fewest dwells that show a settling in common, and the steps in which it is reported.
FEWEST, STEPS = 5, 400
#: Share of the dwells that are long enough to be taken.
LONG_ENOUGH = 0.75
#: Shares of a dwell at its start that are held against the rest of it.
WINDOWS = (0.02, 0.05, 0.1, 0.2)


def settled(run: Run, segment: Segment, noise: SharedNoise | None = None) -> tuple[int, int]:
    """Rows of the dwell without its edges and its settling; what the noise alone would do is no settling."""
    rows = segment.end - segment.start
    size = max(1, rows // 200)
    count = rows // size
    whole = slice(segment.start, segment.start + count * size)
    # the first and last block of a dwell may hold the end of a ramp, a slow ramp many more
    edge = -(-round(BLOCK_DURATION / run.sampling_interval) // size) if count > 20 else 0
    held = means_of_whole(run.speed[whole], size)
    jitter = float(np.median(np.abs(np.diff(held)))) if count > 1 else 0.0
    away = np.abs(held - np.median(held))
    near = np.flatnonzero(away <= max(MAX_SPEED_DRIFT * abs(segment.speed), SPEED_NOISE * jitter))
    first, last = (int(near[0]), count - 1 - int(near[-1])) if near.size else (0, 0)
    first, last = max(first, edge), max(last, edge)
    cut, interval = first, size * run.sampling_interval
    for channel in (run.torque, run.temperature):
        if channel is not None:
            means = means_of_whole(channel[whole], size)[first : count - last]
            dropped = _settling_blocks(means)
            if channel is run.torque and noise is not None and _is_chance(means, dropped, noise, interval):
                continue
            cut = max(cut, first + dropped)
    return segment.start + cut * size, segment.end - last * size


def common_settling(dwells: list[tuple[Run, int, int, float]]) -> float:
    """Return how long dwells take to settle, s; 0 if they show nothing.

    Each is a run, the first row and that after the last at which the speed was held, settling included, and
    the tare of its torque, N m.
    """
    lasting = []
    for run, start, end, _ in dwells:
        lasting.append(run.time[end - 1] - run.time[start])
        let_go(run.time[start:end])
    if len(dwells) < FEWEST:
        return 0.0
    shown = float(np.quantile(lasting, 1.0 - LONG_ENOUGH))
    long = [dwell for dwell, time in zip(dwells, lasting, strict=True) if time >= shown]
    step = max(shown / STEPS, *(run.sampling_interval for run, *_ in long))
    count = int(shown / step)
    if count < 8 or len(long) < FEWEST:
        return 0.0
    each = np.array([_beside_level(*dwell, step, count) for dwell in long])
    dropped = 0
    while dropped < count // 2 and (wide := _still_settling(each[:, dropped:])):
        dropped += wide
    return dropped * step


def _still_settling(each: FloatArray) -> int:
    """Steps in which the dwells, shape (dwells, steps), begin unlike what follows; 0 if they do not."""
    steps: int = each.shape[1]
    for share in WINDOWS:
        wide = max(1, round(share * steps))
        beyond = each[:, :wide].mean(axis=1) - each[:, wide:].mean(axis=1)
        error = float(np.std(beyond, ddof=1)) / beyond.size**0.5
        if abs(float(beyond.mean())) > SIGNIFICANT * error:
            return max(1, wide // 2)
    return 0


def _beside_level(run: Run, start: int, end: int, tare: float, step: float, count: int) -> FloatArray:
    """Torque over its level in the second half of a dwell, in steps of time from its start."""
    time, torque = run.time[start:end], run.torque[start:end]
    level = mean(subtracted(torque[torque.size // 2 :], tare))
    rows, sums = np.zeros(count + 1, dtype=np.intp), np.zeros(count + 1)
    for block in blocks(time.size, time, torque):
        bins = np.minimum(((time[block] - time[0]) / step).astype(np.intp), count)
        rows += np.bincount(bins, minlength=count + 1)
        first = bins[0]  # whose sum goes on
        begun, added = np.append(first, bins), np.append(sums[first], torque[block] - tare)
        sums[first:] = np.bincount(begun, added, count + 1)[first:]
    with np.errstate(divide="ignore", invalid="ignore"):
        means = np.where(rows > 0, sums / rows, np.nan)[:count] / level
    known = np.isfinite(means)
    for seen in (time, torque):  # the next dwell of the kind may be far
        let_go(seen)
    return np.asarray(np.interp(np.arange(count), np.flatnonzero(known), means[known]))


def _is_chance(means: FloatArray, dropped: int, noise: SharedNoise, interval: float) -> bool:
    """Whether the blocks dropped differ from the rest by no more than noise; they last ``interval`` s."""
    if not dropped:
        return True
    rest = Powers.of(means[dropped:], interval)
    both = np.hypot(noise.mean_error(rest), noise.mean_error(rest, duration=dropped * interval))
    return bool(abs(means[:dropped].mean() - means[dropped:].mean()) < SIGNIFICANT * both)


def _settling_blocks(means: FloatArray) -> int:
    """Blocks to drop by the marginal standard error rule, at most half; none if that gains little."""
    count = means.size
    if count < 8:
        return 0
    left = np.arange(count, 0, -1)
    centred = means - means.mean()
    total = np.cumsum(centred[::-1])[::-1] / left
    square = np.cumsum(centred[::-1] ** 2)[::-1] / left
    error = np.sqrt(np.maximum(square - total**2, 0.0) / left)[: count // 2]
    best = int(np.argmin(error))
    return best if error[best] < 0.8 * error[0] else 0
