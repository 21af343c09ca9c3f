"""The operating map of a posterior: its edges, its verdicts, and the drag of its typical draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hersey.cache.kept import kept
from hersey.decision.judge import Kind, judge, meaningless
from hersey.errors import HerseyError
from hersey.posterior import Posterior
from hersey.posterior.typical import typical_of_all_temperatures
from hersey.schema.warning import Warning
from hersey.stability.operating_map import OperatingMap, given_map


@kept(apart=("threads",))
def map_of(
    found: Posterior, *, judged: Sequence[Kind | None] | None = None, threads: int = 1
) -> OperatingMap:
    """Return the map of the machine that a posterior is of, with its operating points.

    ``judged`` are the verdicts on the points, where they are known already; None for one that cannot be
    judged. Points at whose temperature the fitted law has no meaning are named in the warnings.
    """
    model, drag = found.model, typical_of_all_temperatures(found)
    without = meaningless(model.surface, model.machine)
    points = tuple(p for p in model.machine.points if p not in [each.point for each in without])
    map_ = given_map(
        model.surface,
        replace(model.machine, points=points),
        drag,
        lambda kelvin: found.map_edges(kelvin, threads=threads),
    )
    if judged is None:
        varies = map_.temperature is not None
        judged = [_kind(found, point.temperature if varies else None, point.speed) for point in points]
    placed = (replace(point, judged=kind or "") for point, kind in zip(map_.points, judged, strict=True))
    not_judged = [
        Warning(
            "point not judged",
            "not judged, because {error}",
            severity="watch",
            where=each.point.name,
            error=str(each.error),
        )
        for each in without
    ]
    return replace(map_, points=tuple(placed), warnings=(*map_.warnings, *not_judged))


def _kind(found: Posterior, kelvin: float | None, speed: float) -> Kind | None:
    """The verdict; None where too many draws cannot be followed."""
    try:
        return judge(found, kelvin, speed).kind
    except HerseyError:
        return None
