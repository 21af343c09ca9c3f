"""A machine that heats up: heat balance, drag, and temperatures outside the log."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.mistyped import retyped, typed_without
from hersey.cli.quantities import temperature_of
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from hersey.damping.surface import DampingSurface
    from hersey.machine.machine import Machine
    from hersey.motion.drag import Drag
    from hersey.motion.heat import HeatBalance
    from hersey.schema.warning import Warning


#: The option that names the temperature at the start.
FROM = "--from"


def start_of(file: Path, start: str) -> str:
    """Return where the temperature at the start comes from."""
    return FROM if start else f"{file.name}: [heat]: the temperature at the start"


def heat_of(machine: Machine, file: Path, start: str) -> HeatBalance:
    """Return the heat balance of a machine, starting at the temperature of ``--from`` or of its file."""
    if machine.heat is None:
        raise ParameterError(
            f"{file.name} has no heat balance: add [heat] with film_capacity, roll_capacity, exchange, "
            "surroundings and heater_power"
        )
    kelvin = temperature_of(start, FROM)
    if kelvin is None:
        return machine.heat
    return replace(machine.heat, film_temperature=kelvin, roll_temperature=kelvin)


def refuse_above_setpoint(machine: Machine, file: Path, start: str) -> None:
    """Refuse a warm-up that starts above the temperature at which the heater is held."""
    from hersey.units import celsius

    heat = heat_of(machine, file, start)
    if heat.setpoint is None or heat.film_temperature <= heat.setpoint:
        return
    begins, held = (f"{celsius(kelvin):.4g} degC" for kelvin in (heat.film_temperature, heat.setpoint))
    stated = FROM if start else f"{file.name}: [heat]: the film at the start"
    said = f"{stated} is {begins}, above the setpoint of the heater, {held}, so nothing warms up"
    colder = f"{celsius(heat.surroundings):.4g} degC"
    if not start:
        raise ParameterError(f'{said}. Write film_temperature = "{colder}"')
    raise ParameterError(
        f"{said}. To start at the surroundings, type: {retyped(*typed_without([FROM]), FROM, colder)}"
    )


def refuse_below_zero(
    surface: DampingSurface, start: float | HeatBalance, given: str, fit_file: Path | None
) -> None:
    """Refuse a temperature at the start at which the law of temperature of a fit has no value.

    ``given`` is where it comes from.
    """
    from hersey.units import celsius

    coldest = start if isinstance(start, float) else min(start.film_temperature, start.roll_temperature)
    if surface.b is None or coldest > surface.temperature_zero:
        return
    how = "--temperature-scale K"
    raise ParameterError(
        f"{given} is {celsius(coldest):.4g} degC, but a fit B = a T^b in degC holds only above 0 degC. "
        + (f"Add {how}" if fit_file is None else f"Save the fit again, with {how} added to hersey fit")
    )


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
