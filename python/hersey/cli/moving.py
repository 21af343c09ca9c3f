"""The fit of a log that moves all the time, as ``hersey fit`` prints it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.options import Reading
from hersey.cli.terminal import note
from hersey.errors import MOVING, HerseyError, InsufficientDataError, ParameterError
from hersey.log import TorqueLog

if TYPE_CHECKING:
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.moving.result import MovingFit, MovingParameter
    from hersey.log.means import MeansTable
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


def reduced(
    logs: list[Path], log: TorqueLog | MeansTable, reading: Reading, machine: Machine | None
) -> tuple[SteadyPoints | None, MovingFit | None]:
    """Return the points of a log, and its fit as it moves if that is asked for or nothing else can be done.

    There are no points if the windows of a moving log are too few.
    """
    if reading.inertia and not reading.moving:
        raise ParameterError("--inertia is for --moving: add it, or omit --inertia")
    if reading.moving and isinstance(log, TorqueLog):
        return _windows(logs, log, reading, machine, reading.recipe(logs).moving_fit(log))
    try:
        return reading.points(logs, log, machine), None
    except InsufficientDataError as error:
        if error.setting != MOVING or not isinstance(log, TorqueLog) or reading.tare != "none":
            raise
        try:
            fit = reading.recipe(logs).moving_fit(log)
        except HerseyError:
            raise error from None
    note("The speed never holds, so friction is fitted to every sample, as with --moving.")
    return _windows(logs, log, reading, machine, fit)


def _windows(
    logs: list[Path], log: TorqueLog, reading: Reading, machine: Machine | None, fit: MovingFit
) -> tuple[SteadyPoints | None, MovingFit]:
    try:
        return reading.points(logs, log, machine, fit), fit
    except InsufficientDataError as error:
        note(f"{error}")
        return None, fit


def fitted_lines(fit: MovingFit) -> list[str]:
    """Return law and numbers with their intervals, and what was not used."""
    from hersey.cli.figures import labelled, three

    rows = [(each.name, _shown(each)) for each in fit.parameters]
    if fit.inertia_given is not None:
        rows.append(("J", f"{three(fit.inertia_given)} kg·m² (given)"))
    head = "torque = J dw/dt + offset + friction(w), w in rad/s (value, 95 % interval)"
    return [fit.law, "", head, *labelled(rows), fit.cost()]


def _shown(parameter: MovingParameter) -> str:
    from hersey.cli.figures import within

    known = parameter.estimate
    large, small = _SMALL[parameter.unit]
    is_small = max(abs(known.value), abs(known.low), abs(known.high)) < _BELOW
    values = (known.value, known.low, known.high)
    return within(values, small, factor=1e3) if is_small else within(values, large)
