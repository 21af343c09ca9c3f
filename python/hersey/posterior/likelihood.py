"""How likely the evidence is for each draw of a drive.

Whether a drive sticks or slides is taken to be read correctly but for one time in two hundred. Figures of
cycles and peaks are compared in logarithms; the model itself is taken to be good to a few per cent.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.posterior.drives import DriveModel, Drives
from hersey.posterior.evidence import BreakAway, CycleFigures, Evidence, Start

#: Probability that an outcome was read wrongly.
MISREAD = 0.005
#: Relative error of the model in the figures of a cycle, and in a peak of force.
OF_CYCLES, OF_PEAKS = 0.02, 0.02
#: ln-likelihood of each figure of a draw that has no cycle to compare.
_NO_CYCLE = -12.0
#: Rounding of a sum of logarithms.
_ROUNDING = 1e-6
#: Deviations beyond which a figure counts no more: one bad figure must not rule.
_FARTHEST = 8.0


def log_likelihood(
    model: DriveModel,
    drives: Drives,
    evidence: Sequence[Evidence],
    least: FloatArray | float = -np.inf,
    *,
    threads: int = 1,
) -> FloatArray:
    """Return ln of the likelihood of all evidence for each draw, shape (draws,).

    That of a draw which cannot come to its ``least``, shape (draws,), is minus infinity: its motion is not
    computed then.
    """
    out, left = np.zeros(len(drives)), sum(map(_most, evidence))
    for each in evidence:
        out[out + left < least - _ROUNDING] = -np.inf
        able = np.flatnonzero(np.isfinite(out))
        if able.size:
            out[able] += _of_one(model, drives.take(able), each, threads)
        left -= _most(each)
    return out


def _of_one(model: DriveModel, drives: Drives, evidence: Evidence, threads: int = 1) -> FloatArray:
    if isinstance(evidence, BreakAway):
        force = break_away_force(model, drives, evidence.temperature)
        return _normal(np.log(force / evidence.force), evidence.error)
    if isinstance(evidence, Start):
        return _of_start(model, drives, evidence, threads)
    found = model.starts(drives, evidence.temperature, evidence.drive_speed, threads=threads)
    sticks = np.asarray(found.sticks)
    out = _read(sticks, outcome=True)
    if evidence.figures is None:
        return out
    seen = {
        "period": found.period,
        "pull_max": found.pull_max,
        "drop": found.pull_max - found.pull_min,
        "slope": found.slope,
    }
    return out + _of_figures(seen, sticks, evidence.figures)


def _of_start(model: DriveModel, drives: Drives, evidence: Start, threads: int) -> FloatArray:
    """A start as the drive made it: one that comes up gently may slide where a sudden one sticks."""
    speed, rise = evidence.drive_speed, evidence.rise
    profile = [(0.0, 0.0), (rise, speed)] if rise > 0.0 else [(0.0, speed)]
    found = model.start_ups(drives, evidence.temperature, profile, threads=threads)
    out = _read(found.slides, evidence.slid)
    if evidence.peak is None:
        return out
    peak, error = evidence.peak
    return out + _normal(np.log(np.maximum(found.peak, 1e-300) / peak), float(np.hypot(error, OF_PEAKS)))


def _of_figures(seen: dict[str, FloatArray], sticks: BoolArray, figures: CycleFigures) -> FloatArray:
    out = np.zeros(sticks.size)
    for name, values in seen.items():
        known = getattr(figures, name)
        if known is None:
            continue
        value, error = known
        with np.errstate(invalid="ignore", divide="ignore"):
            off = np.log(np.maximum(values, 1e-300) / value)
        out += np.where(sticks, _normal(np.nan_to_num(off), float(np.hypot(error, OF_CYCLES))), _NO_CYCLE)
    return out


def _read(holds: BoolArray, outcome: bool) -> FloatArray:
    """Ln of the probability of reading an outcome, where it holds and where not."""
    return np.asarray(np.where(holds == outcome, np.log1p(-MISREAD), np.log(MISREAD)), dtype=np.float64)


def _normal(off: FloatArray, error: float) -> FloatArray:
    """Ln of the normal density, linear beyond some deviations."""
    size = np.abs(off) / error
    core = np.minimum(size, _FARTHEST)
    return np.asarray(-0.5 * core**2 - core * (size - core) - np.log(error))


def break_away_force(model: DriveModel, drives: Drives, kelvin: float | None) -> FloatArray:
    """Return the force (N) that starts each draw from rest at a temperature, no-load drag included."""
    sliding = model.force_at(drives, kelvin, model.stick_speed(drives, kelvin))
    return np.asarray(model.numbers(drives)[:, 3] * sliding + model.no_load(kelvin)[0])


def misfit(model: DriveModel, drives: Drives, evidence: Evidence) -> float:
    """Return how far evidence lies from what most draws show: the median of twice the lost ln-likelihood."""
    return float(np.median(2.0 * (_most(evidence) - _of_one(model, drives, evidence))))


def _most(evidence: Evidence) -> float:
    """Logarithm of the likelihood of a draw that shows just what was recorded."""
    if isinstance(evidence, BreakAway):
        return -float(np.log(evidence.error))
    read = float(np.log1p(-MISREAD))
    if isinstance(evidence, Start):
        return read if evidence.peak is None else read - float(np.log(np.hypot(evidence.peak[1], OF_PEAKS)))
    if evidence.figures is None:
        return read
    known = [figure for figure in vars(evidence.figures).values() if figure is not None]
    return read - float(sum(np.log(np.hypot(error, OF_CYCLES)) for _, error in known))
