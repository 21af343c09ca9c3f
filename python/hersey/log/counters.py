"""The step in which a sensor counts, as its readings show it.

===========================  ====================================================================
quantisation_step            any reading: differences between its levels are multiples of a step
step_of_levels               a speed that falls through its levels: the median between them
step_of_counts               an encoder whose reading flickers by one count
step_of_few_counts           an encoder that reads 0 or few counts a row
===========================  ====================================================================

That of a position, which counts on, is in `hersey.log.derived.position`.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray

#: Share of the differences between values that must be multiples of a step.
STEP_SHARE = 0.98
#: How near to a multiple, in steps: random numbers would be that near in a tenth of the cases.
STEP_TOLERANCE = 0.05
#: So few levels are all steps.
FEW_LEVELS = 4
#: A falling reading counts in steps if its values are fewer than this share of the rows.
_FEW_OF_A_FALL = 0.5
#: Rows that show whether readings are counts, by how much two of them may differ, in steps, and the share of
#: rows in which they then change by one count.
_COUNTED, _SAME_COUNT, _FLICKERING = 1 << 20, 0.05, 0.01
#: Counts in one row at the most, where some rows have none.
FEW_COUNTS = 2


def quantisation_step(values: FloatArray) -> float | None:
    """Return the step of which all differences between values are multiples, or None if there is none.

    Values that were rounded to decimals after the converter may stray from its steps by those.
    """
    levels = np.unique(values)
    gaps = np.diff(levels)
    gaps = gaps[gaps > 1e-9 * float(np.max(np.abs(levels)))]
    if not gaps.size or levels.size > 0.9 * values.size:
        return None
    if levels.size <= FEW_LEVELS:
        return float(f"{gaps.min():.6g}") if values.size > 20 * levels.size else None
    decimals = _decimals(levels)
    for candidate in np.quantile(gaps, [0.0, 0.02, 0.1], method="lower"):
        step = float(np.mean(gaps[gaps < 1.5 * candidate]))
        tolerance = max(STEP_TOLERANCE, min(0.35, decimals / step)) if gaps.size > 20 else STEP_TOLERANCE
        ratio = gaps / step
        near = np.abs(ratio - np.round(ratio)) <= tolerance
        if np.mean(near) >= STEP_SHARE and float(np.median(ratio)) < 1e4:
            return float(f"{step:.4g}")
    return None


def _decimals(levels: FloatArray) -> float:
    """The least decimal place to which all values are rounded, as a number; 0 if there is none above 1e-9."""
    for places in range(7):
        if np.allclose(levels, np.round(levels, places), rtol=0.0, atol=1e-9):
            return float(10.0**-places)
    return 0.0


def step_of_levels(values: FloatArray) -> float:
    """Return the step in which a falling reading counts, or 0 if it does not show."""
    levels = np.unique(values)
    if levels.size < 2 or levels.size > _FEW_OF_A_FALL * values.size:
        return 0.0
    steps = np.diff(levels)
    steps = steps[steps > 1e-9 * np.abs(levels).max()]
    return float(np.median(steps)) if steps.size else 0.0


def step_of_counts(values: FloatArray) -> float:
    """Return the step in which readings of an encoder count, 0 if they do not go up and down by it."""
    size = np.abs(values[:_COUNTED])
    moving = size > 0.0
    if not moving.any():
        return 0.0
    step = float(size[moving].min())
    by_one = np.abs(np.abs(np.diff(size)) - step) <= _SAME_COUNT * step
    flickers = np.count_nonzero(by_one & moving[1:] & moving[:-1])
    return step if flickers >= _FLICKERING * size.size else 0.0


def step_of_few_counts(size: FloatArray) -> float:
    """Return the step of readings without sign, some of which are 0; 0 if they count in none."""
    counted = size[size > 0]
    if not counted.size or counted.size == size.size:
        return 0.0
    step = float(counted.min())
    ratio = counted[counted <= (FEW_COUNTS + 0.5) * step] / step
    return step if np.mean(np.abs(ratio - np.round(ratio)) <= STEP_TOLERANCE) >= STEP_SHARE else 0.0
