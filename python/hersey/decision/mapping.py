"""The operating map of a posterior: its edges, and the motion of its typical drive."""

from __future__ import annotations

from hersey.posterior import Posterior
from hersey.posterior.typical import typical_of_all_temperatures
from hersey.stability.operating_map import OperatingMap, given_map


def map_of(found: Posterior, *, threads: int = 1) -> OperatingMap:
    """Return the map of the machine that a posterior is of, with its operating points."""
    machine = found.model.machine
    return given_map(
        found.model.surface,
        machine.train,
        typical_of_all_temperatures(found),
        lambda kelvin: found.map_edges(kelvin, threads=threads),
        roll_radius=machine.roll_radius,
        stick_speed_rule=machine.stick_speed_rule,
        limits=machine.limits,
        points=machine.points,
    )
