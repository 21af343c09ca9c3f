"""What another column changes beside the speed, so that no one law of speed describes it: refused."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.points import SteadyPoints
from hersey.errors import InsufficientDataError, Setting, way_in
from hersey.log.mean_blocks import BLOCKS, IN_BLOCKS
from hersey.log.pooling import SAME_LOAD
from hersey.log.rolling import ENTRAINMENT
from hersey.log.stating import CHANGED, MAY_PLAY, by_amount

#: Points of each curve at the least that are compared with others.
_FEWEST = 3
#: Distance of curves, in scatters of their points, beyond which they are apart; speeds that are compared.
_BEYOND, _GRID = 2.0, 50


def refuse_several_loads(points: SteadyPoints) -> None:
    """Raise if the points are torques of runs that were loaded differently.

    Raises
    ------
    InsufficientDataError
        It says which loads, and how the friction coefficient is fitted instead.
    """
    if not points.domain.is_torque or "load" not in points.table.columns:
        return
    known = points.table.select("run", "load").drop_nulls()
    loads = [float(np.median(part["load"].to_numpy())) for part in known.partition_by("run")]
    # a refusal ends all, so it takes more than the loads that count as one beside a coefficient
    if len(loads) < 2 or max(loads) <= CHANGED * min(loads):
        return
    raise InsufficientDataError(
        f"the runs have loads of {min(loads):.3g} to {max(loads):.3g} N, so their torques cannot be fitted "
        "together",
        remedy=f"give the radius, e.g. {Setting('radius').to('25 mm')}, to fit the friction coefficient, or "
        "fit each load separately",
    )


def refuse_curves_of_loads(points: SteadyPoints) -> None:
    """Raise if blocks of a table are friction coefficients at several loads that are no one curve of speed.

    Raises
    ------
    InsufficientDataError
        It says how far they lie apart, and how one of them is fitted.
    """
    loads, of = points.varying_load, points.domain
    seen = [each.values for file in points.log.files for each in file.warnings if each.kind == IN_BLOCKS]
    if not loads or not seen or of.quantity != "friction coefficient":
        return
    speed, friction, load = (np.abs(points.column(name)) for name in ("speed", "torque", "load"))
    heavy = np.round(np.log(load / load.min()) / np.log(SAME_LOAD))
    apart, scatter = _apart(np.log(speed), np.log(friction), heavy)
    if not apart > max(CHANGED - 1.0, _BEYOND * scatter):
        return
    raise InsufficientDataError(
        f"friction coefficients at {loads[0]:.4g} to {loads[1]:.4g} N lie {100.0 * apart:.2g} % "
        "apart at the same speed, so they are no one curve of speed",
        remedy=f"fit each load separately, e.g. with {BLOCKS.to(str(seen[0]['first']))}",
    )


def _apart(x: FloatArray, y: FloatArray, group: FloatArray) -> tuple[float, float]:
    """How far curves lie apart where all are known, and how far points lie off their neighbours, both RMS."""
    curves = [
        (x[mine][order := np.argsort(x[mine], kind="stable")], y[mine][order])
        for mine in (group == each for each in np.unique(group))
    ]
    low, high = max(of[0] for of, _ in curves), min(of[-1] for of, _ in curves)
    if low >= high or min(of.size for of, _ in curves) < _FEWEST:
        return 0.0, 0.0
    grid = np.linspace(low, high, _GRID)
    levels = np.array([np.interp(grid, *curve) for curve in curves])
    off = np.concatenate([f[1:-1] - 0.5 * (f[:-2] + f[2:]) for _, f in curves])
    return float(np.sqrt(np.mean(np.var(levels, axis=0)))), float(np.sqrt(np.mean(off**2) / 1.5))


def refuse_unused_load(points: SteadyPoints) -> None:
    """Raise if the points are friction forces, and a column that is called the normal load changes.

    A force that rises with the load would be said to rise with speed.

    Raises
    ------
    InsufficientDataError
        It says how to use the column, and how to say that the load is another.
    """
    if points.domain.quantity != "friction force":
        return
    found: list[tuple[str, Mapping[str, Any]]] = [
        (file.name, each.values)
        for file in points.log.files
        for each in file.warnings
        if each.kind == MAY_PLAY and each.values["role"] == "load" and each.values["unit"]
    ]
    low = min((seen["low"] for _, seen in found), default=0.0)
    high = max((seen["high"] for _, seen in found), default=0.0)
    if not high > CHANGED * low:
        return
    name, seen = next((n, v) for n, v in found if v["high"] == high)
    or_use = "" if way_in() == "page" else "use "
    raise InsufficientDataError(
        f"{name}: column '{seen['column']}' may be the normal load, and it changes from {low:.3g} to "
        f"{high:.3g}{seen['unit']}, so the friction force does not show what speed does",
        remedy=f"to fit the friction coefficient, {or_use}{seen['how']}. If the normal load is another, give "
        f"it, e.g. {by_amount('load')}",
    )


def refuse_traction_curve(points: SteadyPoints, held: str) -> None:
    """Raise if all dwells are at one entrainment speed (in words), and the slide-roll ratio varies.

    Raises
    ------
    InsufficientDataError
        It says how friction is fitted to the sliding speed.
    """
    if points.domain.speed != ENTRAINMENT:
        return
    warnings = [each for file in points.log.files for each in file.warnings]
    seen = next((w.values for w in warnings if w.kind == ENTRAINMENT and w.severity == "watch"), None)
    if seen is None:
        return
    raise InsufficientDataError(
        f"all dwells are at an entrainment speed of {held}, while '{seen['ratio']}' varies",
        remedy=f"to fit friction to the sliding speed, add a column of it, '{seen['ratio']}' times "
        f"'{seen['column']}', and name it with {Setting('speed', 'channel').to('Sliding speed')}",
    )
