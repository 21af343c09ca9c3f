"""The greatest of a function of few parameters, many rows at once: Newton's method with differences.

Each row is a problem of its own. Differences are of fourth order for the slope, so that parameters come out
to about nine digits; steps are halved where they do not climb.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hersey.arrays import FloatArray, IntArray

#: Of parameters and the rows that they are of to values, shapes (rows, parameters), (rows,) and (rows,).
Function = Callable[[FloatArray, IntArray], FloatArray]
#: Half the distance of differences, steps at the most, the greatest step, and where it ends.
_APART, _STEPS, _STRIDE, _SETTLED = 2e-3, 60, 1.0, 1e-9
_HALVINGS = 12


def maximum(of: Function, start: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the parameters at which each row is greatest, and the greatest values."""
    at, rows = np.array(start, dtype=float), np.arange(len(start))
    value = of(at, rows)
    if at.shape[1] == 0:
        return at, value
    for _ in range(_STEPS):
        slope, curvature = _derivatives(of, at[rows], value[rows], rows)
        step = _step(slope, curvature)
        size = np.abs(step).max(axis=1)
        step *= np.minimum(1.0, _STRIDE / np.maximum(size, 1e-300))[:, None]
        there, new = _climbed(of, at[rows], value[rows], step, rows)
        moved = np.abs(there - at[rows]).max(axis=1)
        at[rows], value[rows] = there, new
        rows = rows[moved > _SETTLED]
        if not rows.size:
            break
    return at, value


def curvature_at(of: Function, at: FloatArray) -> FloatArray:
    """Return the second derivatives of each row, shape (rows, parameters, parameters)."""
    rows = np.arange(len(at))
    return _derivatives(of, at, of(at, rows), rows)[1]


def _derivatives(
    of: Function, at: FloatArray, value: FloatArray, rows: IntArray
) -> tuple[FloatArray, FloatArray]:
    count = at.shape[1]
    slope, curvature = np.empty(at.shape), np.empty((*at.shape, count))
    unit = np.eye(count) * _APART
    for i in range(count):
        near, far = of(at + unit[i], rows), of(at + 2 * unit[i], rows)
        nearer, further = of(at - unit[i], rows), of(at - 2 * unit[i], rows)
        slope[:, i] = (8 * (near - nearer) - (far - further)) / (12 * _APART)
        curvature[:, i, i] = (16 * (near + nearer) - (far + further) - 30 * value) / (12 * _APART**2)
        for j in range(i):
            up, down = unit[i] + unit[j], unit[i] - unit[j]
            mixed = of(at + up, rows) - of(at + down, rows) - of(at - down, rows) + of(at - up, rows)
            curvature[:, i, j] = curvature[:, j, i] = mixed / (4 * _APART**2)
    return slope, curvature


def _step(slope: FloatArray, curvature: FloatArray) -> FloatArray:
    """Newton's step, uphill along every principal direction; small where the function is flat."""
    values, vectors = np.linalg.eigh(np.where(np.isfinite(curvature), curvature, 0.0))
    along = np.einsum("rij,ri->rj", vectors, np.where(np.isfinite(slope), slope, 0.0))
    return np.asarray(np.einsum("rij,rj->ri", vectors, along / np.maximum(np.abs(values), 1e-8)))


def _climbed(
    of: Function, at: FloatArray, value: FloatArray, step: FloatArray, rows: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Parameters after the step or a half of it that does not fall, and values there."""
    there, new = at + step, of(at + step, rows)
    for _ in range(_HALVINGS):
        falls = ~(new >= value - 1e-12 * np.abs(value))
        if not falls.any():
            return there, new
        step[falls] *= 0.5
        there[falls] = at[falls] + step[falls]
        new[falls] = of(there[falls], rows[falls])
    falls = ~(new >= value - 1e-12 * np.abs(value))
    there[falls], new[falls] = at[falls], value[falls]
    return there, new
