"""Torques of runs at different loads, which one law cannot describe: refused."""

from __future__ import annotations

import numpy as np

from hersey.damping.dwells.points import SteadyPoints
from hersey.errors import InsufficientDataError, Setting

#: Ratio of the loads of two runs above which they differ.
_DIFFERENT = 1.1


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
    if len(loads) < 2 or max(loads) <= _DIFFERENT * min(loads):
        return
    raise InsufficientDataError(
        f"the runs have loads of {min(loads):.3g} to {max(loads):.3g} N, so their torques cannot be fitted "
        "together",
        remedy=f"give the radius, e.g. {Setting('radius').to('25 mm')}, to fit the friction coefficient, or "
        "fit each load separately",
    )
