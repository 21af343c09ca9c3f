"""The speed of least torque of a run, and how far it is known.

Its error has two parts. Noise of the dwells differs from run to run. What torque does between the dwells
is alike in all runs of a drive, whose dwells lie alike: a surface that smooths noise rounds the bend as well,
and the least moves to the faster side, where torque rises less. Taken to be twice as noisy, it moves on that
way: by so much the least of all runs is put back. That is about right where dwells scatter by 1 to 2 %, and
too far where they scatter less; what is left is among the errors.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.indicators.torque_surface import TorqueSurface

#: Runs that show what is alike in all, at the most; draws of each error.
RUNS, DRAWS = 24, 32
#: Share of the error between the dwells that is left once the least is put back, as found in life tests.
_LEFT = 1.0 / 3.0


class LeastTorque(NamedTuple):
    """The least torque of a run: in ln speed, NaN where it lies at an end.

    ``error`` is that of noise alone; ``whole`` also of what lies between the dwells, and ``moved`` how far
    twice the noise moves it: NaN where these were not asked.
    """

    log_speed: float
    error: float
    whole: float
    moved: float
    below: bool
    above: bool


def least_torque(
    surface: TorqueSurface,
    speed: FloatArray,
    temperature: float,
    median: FloatArray,
    drawn: FloatArray | None,
) -> LeastTorque:
    """Return the least torque of the ``median`` curve of a surface against speeds in rad/s.

    With draws of the curve also what is alike in all runs.
    """
    at = np.log(speed)
    repeated = surface.repeated(speed, temperature, DRAWS, seed=0)
    least, where = _least(at, np.vstack([median, repeated]))
    below, above = bool(where[0] == 0), bool(where[0] == at.size - 1)
    if below or above:
        return LeastTorque(np.nan, np.nan, np.nan, np.nan, below, above)
    whole = moved = np.nan
    if drawn is not None:
        whole = _spread(_least(at, drawn)[0], least[0])
        noisier, place = _least(at, surface.with_more_noise(2.0).curve(speed, temperature)[None])
        moved = np.nan if place[0] in (0, at.size - 1) else float(noisier[0] - least[0])
    return LeastTorque(float(least[0]), _spread(least[1:], least[0]), whole, moved, below, above)


def alike_in_all(found: list[LeastTorque]) -> tuple[float, float]:
    """Return how far smoothing has moved the least of all runs, in ln speed, and the error left of that."""
    known = np.array([(each.error, each.whole, each.moved) for each in found if np.isfinite(each.moved)])
    if not known.size:
        return 0.0, 0.0
    own, whole, moved = np.median(known, axis=0)
    return max(float(moved), 0.0), _LEFT * float(np.sqrt(max(whole**2 - own**2, 0.0)))


def _spread(values: FloatArray, about: float) -> float:
    return float(np.sqrt(np.mean((values - about) ** 2)))


def _least(at: FloatArray, torque: FloatArray) -> tuple[FloatArray, IntArray]:
    """Where curves are least, by a parabola through three points of ln torque; and the nearest point."""
    logs = np.log(torque)
    where = np.argmin(logs, axis=1)
    middle = np.clip(where, 1, at.size - 2)[:, None]
    before, here, after = (np.take_along_axis(logs, middle + step, axis=1)[:, 0] for step in (-1, 0, 1))
    bend = before - 2.0 * here + after
    step = np.clip(0.5 * (before - after) / np.where(bend > 0, bend, np.inf), -0.5, 0.5)
    inside = where == middle[:, 0]
    return at[where] + np.where(inside, step, 0.0) * (at[1] - at[0]), where
