"""Each run in a few numbers: how its torque differs from that of all runs, in level, speed and temperature.

What all runs have in common, a cubic in ln speed and temperature, is taken away; the rest of ln torque of a
run is
projected on level, slopes and curvatures that are orthogonal over all dwells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.diagnostics.measured import MeasuredRuns

#: Kelvin that count as much as one unit of ln speed.
_KELVIN = 50.0
#: Powers of ln speed and temperature of a run's own terms, and of those that all runs share.
_OWN = ((0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2))
_SHARED = ((1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
#: Fewest dwells of a run that is compared with others.
_FEWEST = 4
#: Standard deviation of a run's own terms as far as its dwells do not show them.
_USUAL = 0.3
#: Least scatter of dwells, relative.
_LEAST_SCATTER = 1e-3
#: A direction over which dwells spread less than this, relative, is none.
_FLAT = 1e-3


@dataclass(frozen=True)
class Fingerprints:
    """Numbers of each run, shape (runs, terms), and their variances; the first is the level of ln torque.

    ``known`` marks runs with dwells enough; the others are zero. ``scatter`` is the usual
    one of dwells about their run, relative.
    """

    value: FloatArray
    variance: FloatArray
    known: BoolArray
    scatter: float


def fingerprints(runs: MeasuredRuns) -> Fingerprints:
    """Return the numbers of each run; those without positive torque at enough dwells are not known."""
    count = len(runs.number)
    usable = (runs.torque > 0.0) & (runs.speed > 0.0)
    dwells = np.bincount(runs.of_run[usable], minlength=count)
    known = dwells >= _FEWEST
    usable &= known[runs.of_run]
    if not usable.any():
        return Fingerprints(np.zeros((count, 1)), np.ones((count, 1)), known, _LEAST_SCATTER)
    place, value = runs.of_run[usable], np.log(runs.torque[usable])
    kelvin = np.where(
        np.isfinite(runs.kelvin[usable]),
        runs.kelvin[usable],
        np.nanmean(runs.kelvin[usable]) if np.isfinite(runs.kelvin[usable]).any() else 0.0,
    )
    speed = np.log(runs.speed[usable])
    u, t = speed - speed.mean(), (kelvin - kelvin.mean()) / _KELVIN
    left = value - _shared(_terms(u, t, _SHARED), value, place, count)
    left = left - np.median(left)
    basis = _orthogonal(_terms(u, t, _OWN))
    return _projected(basis, left, place, known)


def _terms(u: FloatArray, t: FloatArray, powers: tuple[tuple[int, int], ...]) -> FloatArray:
    return np.stack([u**i * t**j for i, j in powers], axis=1)


def _orthogonal(terms: FloatArray) -> FloatArray:
    """Terms made orthogonal, of mean square 1; those that depend on earlier ones are left out."""
    kept = np.empty((len(terms), 0))
    for term in terms.T:
        new = term.copy()
        for _ in range(2):
            new = new - kept @ (kept.T @ new) / len(terms)
        size = float(np.sqrt(np.mean(new**2)))
        if size > max(_FLAT * float(np.sqrt(np.mean(term**2))), 1e-9):
            kept = np.column_stack([kept, new / size])
    return kept


def _shared(terms: FloatArray, value: FloatArray, place: IntArray, count: int) -> FloatArray:
    """What all runs have in common, a level of each apart; runs that do not follow it count less."""
    number = np.maximum(np.bincount(place, minlength=count), 1)

    def centred(column: FloatArray) -> FloatArray:
        return np.asarray(column - (np.bincount(place, column, count) / number)[place])

    inside = np.stack([centred(column) for column in terms.T], axis=1)
    about = centred(value)
    weight = np.ones(count)
    slopes = np.zeros(terms.shape[1])
    for _ in range(4):
        root = np.sqrt(weight[place])
        slopes[:] = np.linalg.lstsq(inside * root[:, None], about * root, rcond=1e-6)[0]
        size = np.sqrt(np.bincount(place, (about - inside @ slopes) ** 2, count) / number)
        usual = float(np.median(size[number > 1]))
        weight = np.ones(count) / np.maximum(1.0, size / max(usual, 1e-9)) ** 2
    return np.asarray(terms @ slopes)


def _projected(basis: FloatArray, left: FloatArray, place: IntArray, known: BoolArray) -> Fingerprints:
    count, terms = known.size, basis.shape[1]
    square = np.zeros((count, terms, terms))
    right = np.zeros((count, terms))
    for i in range(terms):
        right[:, i] = np.bincount(place, basis[:, i] * left, count)
        for j in range(i + 1):
            square[:, i, j] = square[:, j, i] = np.bincount(place, basis[:, i] * basis[:, j], count)
    number = np.bincount(place, minlength=count)
    scatter = 0.02
    # What dwells do not show of a shape is taken to be none; the level is never drawn to that of others.
    for _ in range(3):
        ridge = np.diag([0.0, *[(scatter / _USUAL) ** 2] * (terms - 1)])
        inverse = np.linalg.inv(np.where(known[:, None, None], square + ridge, np.eye(terms)))
        value = np.where(known[:, None], (inverse @ right[..., None])[..., 0], 0.0)
        off = left - np.einsum("di,di->d", basis, value[place])
        freedom = np.maximum(number - terms, 1)
        sizes = np.sqrt(np.bincount(place, off**2, count) / freedom)[known & (number > terms)]
        scatter = max(float(np.median(sizes)) if sizes.size else scatter, _LEAST_SCATTER)
    variance = scatter**2 * np.diagonal(inverse, axis1=1, axis2=2)
    return Fingerprints(value, np.where(known[:, None], variance, 1.0), known, scatter)
