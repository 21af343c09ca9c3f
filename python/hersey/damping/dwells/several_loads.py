"""What another column changes beside the speed, so that no one law of speed describes it: refused."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hersey.damping.dwells.points import SteadyPoints
from hersey.errors import InsufficientDataError, Setting, way_in
from hersey.log.rolling import ENTRAINMENT
from hersey.log.stating import CHANGED, MAY_PLAY, by_amount


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
