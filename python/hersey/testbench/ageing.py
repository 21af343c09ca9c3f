"""Units that age: the machine's own physics, with less oil, thicker oil, rougher faces and a stiffer drive.

The layer of oil on the inlet side thins by side flow and by evaporation, and the film starves where the layer
is thinner than the film of a flooded inlet: torque, exponent and transition follow. Side flow alone is
``h = (h0^-2 + K t)^(-1/2)`` (van Zoelen, Venner and Lugt, Proc. IMechE J 223 (2009) 541). Viscosity grows as
``exp(g t)`` as light ends leave; roughness, boundary friction and the no-load torque grow in proportion to
age. The stand's own statements: no fit is used, and none of the laws that are fitted to a campaign.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray, pointwise
from hersey.damping.no_load_torque import NoLoadTorque, with_rest
from hersey.errors import ParameterError
from hersey.lubrication.film import film_thickness
from hersey.lubrication.mixed import MixedContact
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.motion.drag import DragTable
from hersey.testbench.physical import PhysicalTruth
from hersey.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from hersey.machine.machine import Machine

#: Rounds the corner between flooded and starved, as `film_thickness` has it.
_SHARPNESS = 3.0
#: Speeds (rad/s) among which the one of least torque of a starved contact is sought.
_SPEEDS = np.geomspace(1e-3, 1e3, 241)
#: Ages at which a limit is looked at before it is found between two of them.
_STEPS = 24


@dataclass(frozen=True)
class AgedTruth(PhysicalTruth):
    """`PhysicalTruth` with ``supply`` (m; None: flooded) on the inlet side and thicker oil.

    ``mixed`` is the contact with the roughness and the boundary friction of its age, but the oil when new;
    ``thickening`` is the factor on its viscosity.
    """

    supply: float | None = None
    thickening: float = 1.0

    @property
    def _contact(self) -> MixedContact:
        assert self.mixed is not None
        return self.mixed

    def starvation(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return the film over that of a flooded inlet at speeds (rad/s, not 0) and temperatures (degC)."""
        mixed = self._contact
        if self.supply is None or mixed.contact.roughness is None:
            return np.ones(np.broadcast_shapes(np.shape(speed), np.shape(temperature)))
        product = self.thickening * mixed.product(np.abs(speed), np.asarray(temperature) + ZERO_CELSIUS)
        flooded = mixed.contact.roughness * (product / mixed.reference) ** mixed.film_exponent
        return np.asarray(pointwise(_core.starvation, self.supply, flooded, _SHARPNESS).factor)

    def contact_torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque of film and asperities in N m at speeds (rad/s, above 0) and temperatures (degC).

        A starved film is that of a product of viscosity and speed so much smaller, but for its shear, which
        stays eta U/h, and for what inlet and pressure add (see `Film.rolling`).
        """
        mixed = self._contact
        kelvin = np.asarray(temperature) + ZERO_CELSIUS
        product = self.thickening * mixed.product(speed, kelvin)
        factor = self.starvation(speed, temperature)
        as_if = factor ** (1.0 / mixed.film_exponent)
        state = pointwise(_core.mixed_contact, product * as_if, *mixed.numbers(kelvin))
        beyond = state.rolling
        if mixed.rolling and self.supply is not None:
            # At this product the soft film knows neither speed nor viscosity apart.
            film = film_thickness(
                mixed.contact, mixed.lubricant, speed=speed * self.thickening, temperature=kelvin
            )
            plain = film.shear_factor * product / film.central * film.nip.width  # N/m of length
            sheared = plain * (1.0 - 1.0 / film.shear_factor)
            whole = sheared + film.rolling_force  # none where another law than the soft one holds by now
            share = np.divide(sheared, whole, out=np.ones_like(whole), where=whole > 0)
            beyond = beyond / as_if**mixed.rolling_exponent
            beyond = beyond * (share / factor + (1.0 - share) * factor**3)
        return np.asarray((state.boundary + state.shear / as_if + beyond) * mixed.contact.roll_radius)

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the speed of least torque of the contact in rad/s (NaN if none) at degC."""
        if self.supply is None:
            return np.asarray(super().transition_speed(temperature) / self.thickening)
        return np.array([self._least(float(level)) for level in np.ravel(temperature)]).reshape(
            np.shape(temperature)
        )

    def _least(self, temperature: float) -> float:
        from scipy.optimize import minimize_scalar

        def torque(log_speed: float) -> float:
            return float(self.contact_torque(np.exp(log_speed), np.asarray(temperature)))

        curve = self.contact_torque(_SPEEDS, np.asarray(temperature))
        dips = 1 + np.flatnonzero((curve[1:-1] < curve[:-2]) & (curve[1:-1] <= curve[2:]))
        if not dips.size:
            return float("nan")
        low, high = np.log(_SPEEDS[[dips[-1] - 1, dips[-1] + 1]]).tolist()
        return float(np.exp(minimize_scalar(torque, bounds=(low, high), options={"xatol": 1e-9}).x))

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s; none when standing) and temperatures (degC)."""
        w, level = np.broadcast_arrays(np.asarray(speed, dtype=float), np.asarray(temperature, dtype=float))
        moving = w != 0
        torque = np.array(self.rest.torque(w, temperature=level + ZERO_CELSIUS))
        torque[moving] += np.sign(w[moving]) * self.contact_torque(np.abs(w[moving]), level[moving])
        return torque

    def drag(self, temperature: float, roll_radius: float, stick_speed: float) -> MixedDrag | DragTable:
        """Return the drag of the belt at a temperature in degC, radius in m and stick speed in m/s."""
        if self.supply is None and self.thickening == 1.0:
            return super().drag(temperature, roll_radius, stick_speed)
        force = self.contact_torque(_SPEEDS, np.asarray(temperature)) / roll_radius
        speeds = tuple((_SPEEDS * roll_radius).tolist())
        contact = DragTable(speeds, tuple(force.tolist()), stick_speed=stick_speed)
        return with_rest(contact, self.rest, roll_radius, temperature + ZERO_CELSIUS)

    def to_dict(self) -> dict[str, Any]:
        """Return what it is made of as plain data, in SI."""
        return super().to_dict() | {"supply": self.supply, "thickening": self.thickening}


@dataclass(frozen=True)
class Ageing:
    """How a unit ages; rates are by the unit of age, here a page.

    Parameters
    ----------
    supply
        Layer of oil on the inlet side of a new unit, m; None: flooded, and no oil is lost.
    side_flow
        K of the layer that flows aside, 1/(m^2 page).
    evaporation
        Share of the layer that evaporates, 1/page.
    thickening
        Growth of ln viscosity, 1/page.
    roughening, boundary_growth, rest_growth
        Growth of roughness, of boundary friction and of the no-load torque, of those when new, 1/page.
    spread
        Standard deviation of the logarithm of each from unit to unit, by name; none for those not named.

    Raises
    ------
    ParameterError
        If a value is negative or not finite, or a spread has the name of none of them.
    """

    supply: float | None = 20e-6
    side_flow: float = 3e4
    evaporation: float = 1.5e-6
    thickening: float = 4.5e-6
    roughening: float = 2e-6
    boundary_growth: float = 1e-6
    rest_growth: float = 1e-6
    spread: Mapping[str, float] = field(
        default_factory=lambda: {
            "supply": 0.1,
            "side_flow": 0.7,
            "evaporation": 0.4,
            "thickening": 0.3,
            "roughening": 1.0,
            "boundary_growth": 0.4,
            "rest_growth": 0.4,
        }
    )

    def __post_init__(self) -> None:
        """Check the values."""
        for name, value in self.numbers().items():
            if not 0 <= value < np.inf or (name == "supply" and value == 0):
                raise ParameterError(
                    f"{name} is {value:g}: it must not be negative, and a supply must not be 0"
                )
        for name, deviation in self.spread.items():
            if name not in _RATES:
                raise ParameterError(f"spread of '{name}' is not known: {', '.join(_RATES)}")
            if not 0 <= deviation < np.inf:
                raise ParameterError(f"spread of {name} is {deviation:g}: it must not be negative")

    def numbers(self) -> dict[str, float]:
        """Return supply and rates by name, in SI; the supply only if it is stated."""
        own = {name: getattr(self, name) for name in _RATES}
        return {name: value for name, value in own.items() if value is not None}

    def drawn(self, random: np.random.Generator) -> Ageing:
        """Return the ageing of one unit: every number lognormal about that stated, which is the median."""
        steps = dict(zip(_RATES, random.standard_normal(len(_RATES)).tolist(), strict=True))
        own = {
            name: value * float(np.exp(self.spread.get(name, 0.0) * steps[name]))
            for name, value in self.numbers().items()
        }
        return replace(self, **own, spread={})

    def supply_at(self, age: float) -> float | None:
        """Return the layer at an age, m: side flow and evaporation together, in closed form.

        Of ``dh/dt = -K h^3/2 - e h``: ``h^-2 = h0^-2 exp(2 e t) + K (exp(2 e t) - 1)/(2 e)``.
        """
        if self.supply is None:
            return None
        gone = 2.0 * self.evaporation * age
        mean = float(np.expm1(gone) / gone) if gone else 1.0
        return float((self.supply**-2 * np.exp(gone) + self.side_flow * age * mean) ** -0.5)


#: The numbers of `Ageing`, in the order in which they are drawn.
_RATES = tuple(each.name for each in fields(Ageing) if each.name != "spread")


@dataclass(frozen=True)
class Unit:
    """A unit of a population: a machine, its no-load torque, and how it ages."""

    name: str
    machine: Machine
    rest: NoLoadTorque
    ageing: Ageing

    @cached_property
    def _new(self) -> MixedContact:
        if (mixed := self.machine.mixed) is None:
            raise ParameterError(
                "an ageing specimen needs a machine with mixed contact. Add [contact], [lubricant], "
                "[asperities] and [boundary]"
            )
        return mixed

    def at(self, age: float) -> AgedTruth:
        """Return the truth of the unit at an age.

        Raises
        ------
        ParameterError
            If the age is negative, or the machine does not say what shares its load.
        """
        if not 0 <= age < np.inf:
            raise ParameterError(f"age is {age:g}: it must not be negative")
        ageing, new = self.ageing, self._new
        rough, hard, stiff = (
            1.0 + rate * age for rate in (ageing.roughening, ageing.boundary_growth, ageing.rest_growth)
        )
        friction = replace(
            new.friction, coefficient=hard * new.friction.coefficient, slope=hard * new.friction.slope
        )
        # A rougher face meets its film at a greater product; the film itself stays what it was.
        contact = replace(new.contact, roughness=rough * (new.contact.roughness or 0.0))
        shift = rough ** (1.0 / new.film_exponent)
        mixed = replace(
            new,
            contact=contact,
            friction=friction,
            reference=new.reference * shift,
            edge=new.edge * shift**-0.2,  # over the square root of the inlet, which goes as (eta u)^0.4
            shear=new.shear * shift / rough,
            rolling=new.rolling * shift**new.rolling_exponent,
        )
        rest = NoLoadTorque.stated(
            constant=stiff * self.rest.constant.value,
            per_speed=stiff * self.rest.per_speed.value,
            temperature_slope=self.rest.temperature_slope.value,
            reference_temperature=self.rest.reference_temperature,
        )
        grown = float(np.exp(ageing.thickening * age))
        return AgedTruth(mixed, rest, supply=ageing.supply_at(age), thickening=grown)

    def age_where(self, excess: Callable[[AgedTruth], float], *, within: float) -> float | None:
        """Return the first age at which ``excess`` of the truth is no longer below 0; None if not within."""
        ages = np.linspace(0.0, within, _STEPS + 1).tolist()
        last = 0.0
        for age in ages:
            if excess(self.at(age)) >= 0:
                break
            last = age
        else:
            return None
        if age == 0.0:
            return 0.0
        while age - last > 1e-6 * within:
            middle = 0.5 * (last + age)
            last, age = (last, middle) if excess(self.at(middle)) >= 0 else (middle, age)
        return float(age)

    def age_at(self, torque: float, *, speed: float, temperature: float, within: float) -> float | None:
        """Return the age at which the torque (N m) at a speed (rad/s) and temperature (degC) is reached.

        The first such age, by bisection on the truth; None if it is not reached ``within`` that age.
        """
        at = np.array(speed), np.array(temperature)
        return self.age_where(lambda truth: float(truth.torque(*at)) - torque, within=within)


def population(
    machine: Machine, rest: NoLoadTorque, *, ageing: Ageing | None = None, units: int, seed: int = 0
) -> tuple[Unit, ...]:
    """Return units U1, U2, ... whose ageing is drawn; a unit is the same however many there are.

    Raises
    ------
    ParameterError
        If there is not at least one unit.
    """
    if units < 1:
        raise ParameterError(f"units is {units}: it must be at least 1")
    mean = ageing or Ageing()
    return tuple(
        Unit(f"U{number}", machine, rest, mean.drawn(np.random.default_rng([seed, number])))
        for number in range(1, units + 1)
    )
