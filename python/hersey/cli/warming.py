"""A machine that warms up: what heats it, its drag, and temperatures that the log does not cover."""

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
    """Return what warms a machine, from the temperature that ``--from`` names, or as its file states."""
    if machine.heat is None:
        raise ParameterError(
            f"{file.name} does not say what warms the nip: add [heat], with film_capacity, roll_capacity, "
            "exchange, surroundings and heater_power"
        )
    kelvin = temperature_of(start, "--from")
    if kelvin is None:
        return machine.heat
    return replace(machine.heat, film_temperature=kelvin, roll_temperature=kelvin)


def warming_drag(surface: DampingSurface, machine: Machine) -> Drag:
    """Return the fitted drag as it varies with temperature."""
    if surface.b is None:
        raise ParameterError("the log is isothermal: drag against temperature is needed for a warm-up")
    return surface.drag(**machine.belt)


def beyond_the_log(surface: DampingSurface, kelvin: ArrayLike) -> list[Warning]:
    """Return the warning of temperatures (K) that the log does not cover."""
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
