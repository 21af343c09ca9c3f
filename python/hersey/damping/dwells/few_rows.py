"""Speeds that are held for too few rows to be dwells: the logger is slow, or the dwells are short."""

from __future__ import annotations

import numpy as np

from hersey.damping.dwells.groups import MIN_SAMPLES
from hersey.damping.dwells.segments import BLOCK_DURATION, SPEED_TOLERANCE
from hersey.log.torque_log import Run, TorqueLog

#: Rows of a held speed at the least, and how many such speeds make a log of them.
_FEWEST_ROWS, _FEWEST = 3, 3
#: Median change from row to row, as share of the mean one, below which the speed changes in steps.
_FEW = 0.2
#: A speed is held if it lasts, s.
LASTS = 5 * BLOCK_DURATION


def held_for_few_rows(log: TorqueLog) -> str:
    """Return that most speeds of a log are held for too few rows, and what to do; empty if they are not."""
    interval = float(np.median([run.sampling_interval for run in log.runs]))
    if interval * MIN_SAMPLES <= LASTS:
        return ""
    lengths = [length for run in log.runs for length in rows_held(run) if length * interval >= LASTS]
    few = [length for length in lengths if length < MIN_SAMPLES]
    if not any(map(changes_in_steps, log.runs)):
        return ""
    if len(few) < _FEWEST or 2 * len(few) < len(lengths):
        return ""
    typical = float(np.median(few))
    return (
        f"{log.files[0].name}: {len(few)} of {len(lengths)} held speeds have fewer than {MIN_SAMPLES} rows "
        f"(typically {typical:.0f}), which one dwell needs. Log at least every "
        f"{0.5 * typical / MIN_SAMPLES * interval:.2g} s, or hold each speed for at least "
        f"{2 * MIN_SAMPLES * interval:.3g} s"
    )


def changes_in_steps(run: Run) -> bool:
    """Return whether the speed of a run changes at a few places, and not all the time."""
    changes = np.abs(np.diff(run.speed))
    return float(np.median(changes)) < _FEW * float(np.mean(changes))


def rows_held(run: Run) -> list[int]:
    """Return for how many rows each speed is held, for those that are held."""
    lengths = []
    start = 0
    for row in range(1, run.speed.size + 1):
        level = abs(float(run.speed[start]))
        near = (
            row < run.speed.size and abs(float(run.speed[row] - run.speed[start])) <= SPEED_TOLERANCE * level
        )
        if not near:
            if row - start >= _FEWEST_ROWS and level > run.domain.standing:
                lengths.append(row - start)
            start = row
    return lengths
