"""The measurement that would narrow V* most: what each draw would show, and what is left when it is known.

Each draw in turn is taken for the truth. The others are weighed by how well they agree with what it would
show, and the width of V* that they leave is averaged (expected posterior width; Lindley, Ann. Math. Stat. 27
(1956) 986, with a width in the place of entropy).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hersey.arrays import FloatArray
from hersey.posterior import Posterior

#: Draws of the posterior that are used, and those of them that are taken for the truth.
_DRAWS, _TRUTHS = 300, 60
#: Relative errors of a break-away force, of a slow dwell, and of the figures of a cycle.
_OF_FORCE, _OF_DWELL, _OF_CYCLE = 0.04, 0.03, 0.04
#: A log whose V* is known within this factor needs no further measurement.
NARROW = 1.25
#: A measurement that leaves more than this share of the width is not worth naming.
WORTH = 0.85
#: Starts of one measurement, and the quantiles of V* at which they are made.
_STARTS = (0.15, 0.5, 0.85)
#: Share of the transition at which stick-slip is recorded, and of the slowest dwell at which one more is
#: held.
_SLIPS_AT, _SLOWER = 0.5, 0.5

Kind = Literal["starts", "break-away", "stick-slip", "dwell"]


@dataclass(frozen=True)
class Measurement:
    """A measurement, and by how much it would narrow the interval of V*.

    ``speeds`` (m/s at the belt) are those of starts, of a dwell or of a stretch of stick-slip; ``left`` is
    the expected width of the interval (ratio of its ends) over that of today, in logarithms; ``factor`` the
    expected ratio of its ends.
    """

    kind: Kind
    temperature: float | None
    speeds: tuple[float, ...]
    left: float
    factor: float


def next_measurement(found: Posterior) -> Measurement | None:
    """Return the measurement that narrows V* most; None where V* is narrow, or none would help."""
    every = measurements(found)
    return every[0] if every and every[0].left <= WORTH else None


def measurements(found: Posterior) -> tuple[Measurement, ...]:
    """Return all kinds of measurement, the most useful first; none where V* is narrow already."""
    kelvin = found.temperature
    few = np.linspace(0, len(found.drives) - 1, min(_DRAWS, len(found.drives))).astype(np.intp)
    edges = found.edges(kelvin)
    fold = np.log(edges.fold[few])
    log_width = _width(fold, np.ones(fold.size))
    if log_width <= math.log(NARROW):
        return ()
    out = []
    for kind, speeds, shown, error in _shown(found, kelvin, few):
        left = _expected(fold, shown, error) / log_width
        out.append(Measurement(kind, kelvin, speeds, left, math.exp(left * log_width)))
    return tuple(sorted(out, key=lambda each: each.left))


def _shown(
    found: Posterior, kelvin: float | None, few: np.ndarray
) -> list[tuple[Kind, tuple[float, ...], FloatArray, float]]:
    """What each measurement would show of each draw, shape (draws, figures), with its error."""
    model, drives, edges = found.model, found.drives.take(few), found.edges(kelvin)
    fold = edges.fold[few]
    fastest = model.machine.limits.speed or math.inf
    starts = tuple(dict.fromkeys(min(float(v), fastest) for v in np.quantile(edges.fold, _STARTS)))
    slid = np.column_stack([fold < v for v in starts]).astype(np.float64)
    slow = _SLOWER * model.surface.speed_range[0] * model.machine.roll_radius
    dwell = np.log(model.force_at(drives, kelvin, slow))
    slips = _SLIPS_AT * float(np.median(edges.transition))
    stuck = model.starts(drives, kelvin, slips)
    figures = np.column_stack([stuck.period, stuck.pull_max, stuck.pull_max - stuck.pull_min])
    with np.errstate(invalid="ignore"):
        cycle = np.where(stuck.sticks[:, None], np.log(figures), -10.0)
    return [
        ("starts", starts, slid, 0.2),
        ("break-away", (), np.log(edges.holding[few])[:, None], _OF_FORCE),
        ("dwell", (slow,), dwell[:, None], _OF_DWELL),
        ("stick-slip", (slips,), cycle, _OF_CYCLE),
    ]


def _expected(fold: FloatArray, shown: FloatArray, error: float) -> float:
    """Expected width of ln V* once the figures are known."""
    widths = []
    for truth in np.linspace(0, fold.size - 1, min(_TRUTHS, fold.size)).astype(int).tolist():
        off = np.sum(((shown - shown[truth]) / error) ** 2, axis=1)
        widths.append(_width(fold, np.exp(-0.5 * np.nan_to_num(off, nan=1e9))))
    return float(np.mean(widths))


def _width(values: FloatArray, weight: FloatArray) -> float:
    """Width of the 95 % interval of weighed values."""
    order = np.argsort(values)
    share = np.cumsum(weight[order]) / weight.sum()
    low, high = np.interp([0.025, 0.975], share, values[order])
    return float(high - low)
