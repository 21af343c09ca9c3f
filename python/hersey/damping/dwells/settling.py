"""Where a dwell has settled."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.segments import BLOCK_DURATION, SPEED_NOISE, Segment
from hersey.damping.dwells.shared_noise import Powers, SharedNoise
from hersey.damping.dwells.steadiness import MAX_SPEED_DRIFT, SIGNIFICANT
from hersey.log.torque_log import Run


def settled(run: Run, segment: Segment, noise: SharedNoise | None = None) -> tuple[int, int]:
    """Rows of the dwell without its edges and its settling; what the noise alone would do is no settling."""
    rows = segment.end - segment.start
    size = max(1, rows // 200)
    count = rows // size
    blocks = slice(segment.start, segment.start + count * size)
    # the first and last block of a dwell may hold the end of a ramp, a slow ramp many more
    edge = -(-round(BLOCK_DURATION / run.sampling_interval) // size) if count > 20 else 0
    held = run.speed[blocks].reshape(count, size).mean(axis=1)
    jitter = float(np.median(np.abs(np.diff(held)))) if count > 1 else 0.0
    away = np.abs(held - np.median(held))
    near = np.flatnonzero(away <= max(MAX_SPEED_DRIFT * abs(segment.speed), SPEED_NOISE * jitter))
    first, last = (int(near[0]), count - 1 - int(near[-1])) if near.size else (0, 0)
    first, last = max(first, edge), max(last, edge)
    cut, interval = first, size * run.sampling_interval
    for channel in (run.torque, run.temperature):
        if channel is not None:
            means = channel[blocks].reshape(count, size).mean(axis=1)[first : count - last]
            dropped = _settling_blocks(means)
            if channel is run.torque and noise is not None and _is_chance(means, dropped, noise, interval):
                continue
            cut = max(cut, first + dropped)
    return segment.start + cut * size, segment.end - last * size


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
