"""The fit of a log that moves all the time, as ``hersey fit`` prints it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.options import Reading
from hersey.cli.terminal import note
from hersey.errors import InsufficientDataError

if TYPE_CHECKING:
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.estimate import Estimate
    from hersey.damping.moving.result import MovingFit
    from hersey.damping.surface import DampingSurface
    from hersey.log.means import MeansTable
    from hersey.log.torque_log import TorqueLog
    from hersey.machine.machine import Machine

#: Unit in which small numbers are shown, by that of large ones, and how many of it make one.
_SMALL = {
    "N m": ("N·m", "mN·m"),
    "N m s/rad": ("N·m·s/rad", "mN·m·s/rad"),
    "rad/s": ("rad/s", "mrad/s"),
    "kg m^2": ("kg·m²", "g·m²"),
    "s": ("s", "ms"),
    "1/K": ("1/K", "1/kK"),
}
#: A number below this is shown in the smaller unit.
_BELOW = 0.1


@dataclass(frozen=True)
class Fitted:
    """What is fitted to a log: the surface of its points, its friction as it moves, or both."""

    points: SteadyPoints | None
    surface: DampingSurface | None
    moving: MovingFit | None


def fitted(
    logs: list[Path], log: TorqueLog | MeansTable, reading: Reading, machine: Machine | None
) -> Fitted:
    """Fit the dwells of a log, or every sample if that is asked for or the log moves all the time."""
    from hersey.damping.fit import fit
    from hersey.damping.moving.result import MovingFit

    found = reading.found(logs, log)
    moving = found if isinstance(found, MovingFit) else None
    points = None
    try:
        points = reading.points(logs, log, machine, found)
        return Fitted(points, fit(points, temperature_scale=reading.temperature_scale), moving)
    except InsufficientDataError as error:
        if moving is None:
            raise
        note(f"No surface B = a w^c can be fitted to the windows of this log: {error}")
        return Fitted(points, None, moving)


def fitted_lines(fit: MovingFit, finding: str = "") -> list[str]:
    """Return law and numbers with their intervals, and what was not used.

    ``finding`` is what torque does as the drive slows.
    """
    from hersey.cli.figures import labelled, three
    from hersey.damping.inertia import NORMAL
    from hersey.units import rpm

    rows = [(each.name, _shown(each.estimate, each.unit)) for each in fit.parameters]
    if fit.inertia_given is not None:
        half = NORMAL * fit.fitted.law.inertia_error
        error = f" ± {three(half)}" if half else ""
        rows.append(("J", f"{three(fit.inertia_given)}{error} kg·m² (given)"))
    speed = fit.middle_speed
    rows.append(("friction", f"{_shown(fit.friction_at(speed), 'N m')} at {three(rpm(speed))} rpm"))
    gravity, angle = "", []
    if said := fit.gravity_in_words():
        gravity, angle = " + G sin(q - q_0)", [said]
    head = f"torque = J dw/dt + offset{gravity} + friction(w), w in rad/s (value, 95 % interval)"
    law = f"{fit.named}. {finding}" if finding else fit.named
    return [law, "", head, *labelled(rows), *angle, fit.cost()]


def _shown(known: Estimate, unit: str) -> str:
    import numpy as np

    from hersey.damping.estimate import rounded

    if unit == "rad":
        return f"{rounded(*np.degrees([known.value, known.low, known.high]).tolist())}°"
    large, small = _SMALL[unit]
    is_small = max(abs(known.value), abs(known.low), abs(known.high)) < _BELOW
    factor = 1e3 if is_small else 1.0
    shown = rounded(factor * known.value, factor * known.low, factor * known.high)
    return f"{shown} {small if is_small else large}"
