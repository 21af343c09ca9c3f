"""What of the torque the film carries, what the contact, what the no-load torque."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from hersey.arrays import FloatArray
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.surface import DampingSurface
from hersey.lubrication import paper
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.mixed import MixedContact, MixedFilm
from hersey.machine.machine import Machine
from hersey.schema.part import Numbers, Part
from hersey.units import celsius, rpm

#: Speeds at which the parts are drawn.
_SPEEDS = 60
#: A prediction within this factor of what was measured agrees with it.
_AGREES = 2.0


class TorqueBudgetPart(Part):
    """Parts of the torque, N m at rad/s, at one temperature by the machine file; and the dwells."""

    temperature: float = Field(description="K, of the hottest dwells")
    speed: Numbers = Field(description="shape (speeds,)")
    rest: Numbers = Field(description="no-load torque, shape (speeds,)")
    contact: Numbers = Field(description="asperity contact, shape (speeds,)")
    shear: Numbers = Field(description="shear of the film, shape (speeds,)")
    inlet: Numbers = Field(description="inlet and pressure of the film, shape (speeds,)")
    measured_speed: Numbers = Field(description="of the dwells at this temperature")
    measured_torque: Numbers = Field(description="whole torque of these dwells")
    ratio: tuple[float, float, float] = Field(
        description="measured / predicted torque over all dwells: minimum, geometric mean, maximum"
    )
    text: list[str] = Field(description="in sentences")


def torque_budget(
    points: SteadyPoints, surface: DampingSurface, machine: Machine | None
) -> TorqueBudgetPart | None:
    """Return the parts of the torque at the hottest dwells; None if the machine does not state them all."""
    mixed = None if machine is None else machine.mixed
    if mixed is None or surface.b is None:
        return None
    speed, kelvin = np.abs(points.column("speed")), points.column("temperature")
    *_, hot = groups_of_temperature(kelvin)
    level = float(np.mean(kelvin[hot]))
    turn = float(mixed.transition(level).speed)
    ends = speed[hot].min(), speed[hot].max()
    taken = _rest(points, speed, kelvin)
    whole = np.abs(points.column("torque")) + taken
    logs = np.log(whole / (_at(mixed, speed, kelvin).torque + taken))
    ratio = (float(np.exp(logs.min())), float(np.exp(logs.mean())), float(np.exp(logs.max())))
    grid = np.geomspace(*ends, _SPEEDS)
    drawn = _at(mixed, grid, np.full(_SPEEDS, level))
    named = np.array([ends[0], turn, ends[1]] if ends[0] < turn < ends[1] else ends)
    return TorqueBudgetPart(
        temperature=level,
        speed=grid.tolist(),
        rest=_rest(points, grid, np.full(_SPEEDS, level)).tolist(),
        contact=drawn.boundary_torque.tolist(),
        shear=drawn.shear_torque.tolist(),
        inlet=drawn.rolling_torque.tolist(),
        measured_speed=speed[hot].tolist(),
        measured_torque=whole[hot].tolist(),
        ratio=ratio,
        text=[
            _shares(mixed, points, named, level),
            _agreement(ratio),
            *_paper(mixed, float(named[len(named) // 2]), level),
        ],
    )


def _shares(mixed: MixedContact, points: SteadyPoints, speed: FloatArray, level: float) -> str:
    """Who carries what at a few speeds."""
    kelvin = np.full(speed.size, level)
    rest, state = _rest(points, speed, kelvin), _at(mixed, speed, kelvin)
    parts = []
    for i, whole in enumerate((rest + state.torque).tolist()):
        film = float(state.shear_torque[i] + state.rolling_torque[i])
        shares = ((film, "film"), (float(state.boundary_torque[i]), "contact"), (float(rest[i]), "no-load"))
        listed = ", ".join(f"{name} {100 * torque / whole:.0f} %" for torque, name in shares)
        parts.append(f"{1e3 * whole:.3g} mN m at {rpm(float(speed[i])):.3g} rpm ({listed})")
    return f"Torque predicted at {celsius(level):.0f} degC by the machine file: {'; '.join(parts)}."


def _agreement(ratio: tuple[float, float, float]) -> str:
    """How the measured torque compares with it."""
    low, mean, high = ratio
    agrees = low > 1 / _AGREES and high < _AGREES
    return (
        f"Measured torque is {mean:.2f} times that ({low:.2f} to {high:.2f} for single dwells)"
        f"{'' if agrees else ', so the machine file does not describe this log'}."
    )


def _paper(mixed: MixedContact, speed: float, level: float) -> list[str]:
    """Where Eq. 9 stands; nothing where the lubricant has no pressure-viscosity coefficient."""
    contact, lubricant = mixed.contact, mixed.lubricant
    alpha = float(lubricant.alpha(level))
    if not alpha > 0:
        return []
    hard = float(
        paper.torque(
            pressure_viscosity=alpha,
            viscosity=lubricant.viscosity(level),
            entrainment_speed=0.5 * speed * contact.roll_radius,
            load=contact.load,
            length=contact.length,
            rubber_thickness=contact.rubber_thickness,
            radius=contact.roll_radius,
            effective_modulus=contact.effective_modulus,
        )
    )
    soft = float(_at(mixed, np.array([speed]), np.array([level])).torque[0])
    return [
        f"Eq. 9 gives {hard:.3g} N m at {rpm(speed):.3g} rpm, {hard / soft:.2g} times "
        "film and contact. It is for hard surfaces; no flooded film in a soft nip reaches this "
        "torque."
    ]


def _rest(points: SteadyPoints, speed: FloatArray, kelvin: FloatArray) -> FloatArray:
    """What was subtracted as the no-load torque, N m."""
    return np.zeros_like(speed) if points.rest is None else points.rest.torque(speed, temperature=kelvin)


def _at(mixed: MixedContact, speed: FloatArray, kelvin: FloatArray) -> MixedFilm:
    inside = film_temperature(mixed.contact, mixed.lubricant, speed=speed, temperature=kelvin)
    return mixed.at(speed=speed, temperature=inside)
