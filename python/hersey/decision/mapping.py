"""The operating map of a posterior: its edges, its verdicts, and the drag of its typical draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hersey.decision.judge import Kind, judge
from hersey.posterior import Posterior
from hersey.posterior.typical import typical_of_all_temperatures
from hersey.stability.operating_map import OperatingMap, given_map


def map_of(found: Posterior, *, judged: Sequence[Kind] | None = None, threads: int = 1) -> OperatingMap:
    """Return the map of the machine that a posterior is of, with its operating points.

    ``judged`` are the verdicts on the points, where they are known already.
    """
    machine, drag = found.model.machine, typical_of_all_temperatures(found)
    map_ = given_map(
        found.model.surface,
        machine.train,
        drag,
        lambda kelvin: found.map_edges(kelvin, threads=threads),
        roll_radius=machine.roll_radius,
        stick_speed_rule=machine.stick_speed_rule,
        limits=machine.limits,
        points=machine.points,
    )
    if judged is None:
        varies = drag.varies_with_temperature
        judged = [judge(found, p.temperature if varies else None, p.speed).kind for p in map_.points]
    points = (replace(point, judged=kind) for point, kind in zip(map_.points, judged, strict=True))
    return replace(map_, points=tuple(points))
