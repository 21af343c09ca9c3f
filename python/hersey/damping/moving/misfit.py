"""Whether friction departs from the law with the speed: what is left is compared with a free curve.

The curve is straight between knots, at as many moments each, in each direction; its fit allows for noise that
lasts, as that of the law does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.distributions import ratio_above
from hersey.damping.moving.fitting import Fitting, MovingLawFit
from hersey.result import Means, Record

#: Knots of a direction, and moments that each needs.
_KNOTS, _MOMENTS = 7, 12
#: Chance below which a departure is no noise, share of friction from which on it matters, and standard errors
#: of a knot that departs.
_CHANCE, _MATTERS, _CLEAR = 1e-4, 0.03, 3.0


@dataclass(frozen=True)
class Misfit(Record):
    """How friction departs from the law."""

    share: Annotated[float, Means("largest departure, as a share of the friction there; negative: less")]
    speed: Annotated[float, Means("where", "rad/s")]
    p_value: Annotated[float, Means("of the law against a free curve of the speed, by an F test")]


def misfit_of(fitting: Fitting, fitted: MovingLawFit) -> Misfit | None:
    """Return how friction departs from the law; None if that is noise, or too little to matter."""
    equations, speed = fitting.equations, fitting.equations.speed
    hats = _hats(speed)
    known, free = fitting.whitened(fitted.columns), fitting.whitened(hats)
    scale = np.linalg.norm(known, axis=0)
    taken = np.linalg.lstsq(known / scale, free, rcond=1e-10)[0] / scale[:, None]
    free = free - known @ taken
    left = fitting.whitened(fitted.residuals)
    vectors, sizes, turn = np.linalg.svd(free, full_matrices=False)
    kept = sizes > 1e-6 * np.linalg.norm(fitting.whitened(hats))
    gained = vectors[:, kept].T @ left
    count, freedom = int(np.count_nonzero(kept)), left.size - known.shape[1] - int(np.count_nonzero(kept))
    if not count or freedom < _MOMENTS:
        return None
    variance = max(float(left @ left) - float(gained @ gained), 0.0) / freedom
    p_value = float(ratio_above(float(gained @ gained) / count / variance, count, freedom))
    if not p_value < _CHANCE:
        return None
    means = hats.T / hats.sum(axis=0)[:, None]
    curve = means @ (hats - fitted.columns @ taken) @ (turn[kept].T / sizes[kept])
    departs, errors = curve @ gained, np.sqrt(variance * np.sum(curve**2, axis=1))
    law = fitted.law.friction
    friction = means @ np.abs(law.torque(fitted.values[: len(law.names)], speed, equations.temperature))
    shares = np.where(np.abs(departs) > _CLEAR * errors, departs / friction, 0.0)
    shares = shares * np.sign(means @ speed)
    worst = int(np.argmax(np.abs(shares)))
    if abs(shares[worst]) < _MATTERS:
        return None
    return Misfit(float(shares[worst]), float((means @ speed)[worst]), p_value)


def _hats(speed: FloatArray) -> FloatArray:
    """Curves of the speed that are 1 at one knot and 0 at the next, of each direction, one a column."""
    out = []
    for way in (1.0, -1.0):
        size = way * speed[way * speed > 0.0]
        count = min(_KNOTS, size.size // _MOMENTS)
        if count < 3:
            continue
        knots = np.unique(np.quantile(size, np.linspace(0.0, 1.0, count)))
        each = np.array([np.interp(way * speed, knots, row) for row in np.eye(knots.size)]).T
        out.append(each * (way * speed > 0.0)[:, None])
    return np.column_stack(out) if out else np.empty((speed.size, 0))
