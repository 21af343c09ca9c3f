"""Where a dwell has settled."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.segments import BLOCK_DURATION, SPEED_NOISE, Segment
from hersey.damping.dwells.steadiness import MAX_SPEED_DRIFT
from hersey.log.torque_log import Run


def settled(run: Run, segment: Segment) -> tuple[int, int]:
    """Rows of the dwell without its edges and its settling."""
    rows = segment.end - segment.start
    size = max(1, rows // 200)
    count = rows // size
    blocks = slice(segment.start, segment.start + count * size)
    # the first and last block of a dwell may hold the end of a ramp, a slow ramp many more
    edge = -(-round(BLOCK_DURATION / run.sampling_interval) // size) if count > 20 else 0
    held = run.speed[blocks].reshape(count, size).mean(axis=1)
    noise = float(np.median(np.abs(np.diff(held)))) if count > 1 else 0.0
    away = np.abs(held - np.median(held))
    near = np.flatnonzero(away <= max(MAX_SPEED_DRIFT * abs(segment.speed), SPEED_NOISE * noise))
    first, last = (int(near[0]), count - 1 - int(near[-1])) if near.size else (0, 0)
    first, last = max(first, edge), max(last, edge)
    cut = first
    for channel in (run.torque, run.temperature):
        if channel is not None:
            means = channel[blocks].reshape(count, size).mean(axis=1)[first : count - last]
            cut = max(cut, first + _settling_blocks(means))
    return segment.start + cut * size, segment.end - last * size


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
