"""A machine that heats up: heat balance, drag, and temperatures outside the log."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.quantities import temperature_of
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from hersey.damping.surface import DampingSurface
    from hersey.machine.machine import Machine
    from hersey.motion.drag import Drag
    from hersey.motion.heat import HeatBalance
    from hersey.schema.warning import Warning


def heat_of(machine: Machine, file: Path, start: str) -> HeatBalance:
    """Return the heat balance of a machine, starting at the temperature of ``--from`` or of its file."""
    if machine.heat is None:
        raise ParameterError(
            f"{file.name} has no heat balance: add [heat] with film_capacity, roll_capacity, exchange, "
            "surroundings and heater_power"
        )
    kelvin = temperature_of(start, "--from")
    if kelvin is None:
        return machine.heat
    return replace(machine.heat, film_temperature=kelvin, roll_temperature=kelvin)


def warming_drag(surface: DampingSurface, machine: Machine) -> Drag:
    """Return the fitted drag with its temperature dependence."""
    if surface.b is None:
        raise ParameterError("the fit is isothermal, but a warm-up needs drag at several temperatures")
    return replace(surface.drag(**machine.belt), measured=None)


def beyond_the_log(surface: DampingSurface, kelvin: ArrayLike) -> list[Warning]:
    """Return a warning if temperatures (K) lie outside the log."""
    import numpy as np

    from hersey.schema.warning import Warning

    if surface.temperature_range is None:
        return []
    low, high = surface.temperature_range
    lowest, highest = np.min(kelvin), np.max(kelvin)
    if low - 1.0 <= lowest and highest <= high + 1.0:
        return []
    return [
        Warning(
            "drag extrapolated",
            "the log covers {low:.4g degC} to {high:.4g degC}: drag at {lowest:.4g degC} to "
            "{highest:.4g degC} is extrapolated",
            severity="watch",
            low=low,
            high=high,
            lowest=float(lowest),
            highest=float(highest),
        )
    ]
