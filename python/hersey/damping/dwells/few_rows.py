"""Speeds that are held for too few rows to be dwells: the logger is slow, or the dwells are short."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import MIN_SAMPLES
from hersey.damping.dwells.segments import BLOCK_DURATION, SPEED_TOLERANCE
from hersey.errors import InsufficientDataError
from hersey.log.roles import MEANS
from hersey.log.torque_log import Run, TorqueLog

#: Rows of a held speed at the least, and how many such speeds make a log of them.
_FEWEST_ROWS, _FEWEST = 3, 3
#: Median change from row to row, as share of the mean one, below which the speed changes in steps.
_FEW = 0.2
#: A sweep of points: s between rows at the least, steps from row to row, as share of the speed, greatest by
#: least speed, and share of the rows and rows that belong to it at the least.
_APART, _STEP, _SWEPT, _SHARE, _POINTS = 1.0, 0.05, 2.0, 0.25, 6
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


def rows_of_means(log: TorqueLog) -> InsufficientDataError | None:
    """Return the error of a sweep whose rows are far apart, each at its own speed; None of another log."""
    interval = float(np.median([run.sampling_interval for run in log.runs]))
    if interval < _APART:
        return None
    own = [_own_speeds(np.abs(run.speed)) for run in log.runs]
    rows = sum(each.size for each in own)
    speeds = np.concatenate(own)
    if rows < max(_POINTS, _SHARE * log.rows) or not speeds.max() > _SWEPT * speeds.min():
        return None
    return InsufficientDataError(
        f"{log.files[0].name}: {rows} rows, {interval:.3g} s apart, have each a speed of their own, so they "
        "are no dwells",
        remedy=f"if each row is the mean of a point, use {MEANS.to()}",
        setting=MEANS,
    )


def _own_speeds(speed: FloatArray) -> FloatArray:
    """The speeds, but standstill, that differ from those of both neighbours."""
    far = np.abs(np.diff(speed)) > _STEP * np.maximum(speed[1:], speed[:-1])
    return np.asarray(speed[np.append(True, far) & np.append(far, True) & (speed > 0)])


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
