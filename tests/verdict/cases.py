"""What the tests of the verdict share: Holm's p-values by hand, and what a log alone says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import stats

import hersey
from hersey.damping.estimate import Estimate
from hersey.verdict.explanations import Explanation

#: The table of regimes, as the literature has it.
RANGES = {
    "constant film": (0.0, 0.0),
    "soft EHL": (-0.60, -0.56),
    "rigid piezoviscous film": (-2 / 3, -2 / 3),
    "Dowson-Higginson EHL": (-0.70, -0.70),
    "dry Coulomb friction or a rigid film": (-1.0, -1.0),
}


def alone(c: Estimate) -> dict[str, float]:
    """p-value of each regime by itself: the distance beyond what sensors may do, in standard errors."""
    out = {}
    for name, (low, high) in RANGES.items():
        away = max(low - c.value, c.value - high, 0.0) - c.systematic
        out[name] = min(1.0, 2.0 * float(stats.t.sf(max(away, 0.0) / c.error, c.freedom)))
    away = max(c.value + 1.0 - c.systematic, 0.0)  # only one side speaks against it
    side = float(stats.t.sf(away / c.error, c.freedom))
    out["falling branch"] = side
    return out


def holm(p_values: dict[str, float]) -> dict[str, float]:
    """Adjusted p-values: the k-th least times those not yet refuted, never less than one before it."""
    order = sorted(p_values, key=lambda name: p_values[name])
    raised = [min(1.0, (len(order) - k) * p_values[name]) for k, name in enumerate(order)]
    return dict(zip(order, np.maximum.accumulate(raised).tolist(), strict=True))


def seen(regime: hersey.Regime, named: str | None, *keys: str) -> hersey.Regime:
    """The same log, saying that."""
    others = tuple(Explanation(key, key) for key in keys or ((named,) if named else ()))
    return replace(regime, named=named, explanations=others)
