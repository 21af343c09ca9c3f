"""Mixed lubrication: what the film carries, what the contact, and the torque that both make.

Film and asperities share the load; the force depends on x = eta U alone where boundary friction is constant,
U the sliding speed (belt speed). lambda is the central film over the composite rms roughness. The formulas
stand in the core and, with their sources and limits, in ``docs/theory/mixed.md``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey import _core
from hersey.arguments.door import Words
from hersey.arrays import FloatArray, pointwise
from hersey.errors import ParameterError
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.lubrication.checked_range import beyond_checked_range
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import film_thickness, inlet_length, operating_points, soft_force_beyond
from hersey.lubrication.film_result import REGIMES, SOFT
from hersey.lubrication.lubricant import Lubricant
from hersey.result import OPEN, Means, Record, Result, json_record, stated_names
from hersey.units import celsius, takes_si

if TYPE_CHECKING:
    import polars as pl

#: The core takes no film whose thickness depends on load less than so.
_LEAST_LOAD_EXPONENT = 0.01
#: Least roundness of the dry pressure that the core takes.
_FLATTEST = 0.01
#: Films over roughness, if alone, between which inlet and pressure make a power of eta U; its local
#: power falls slowly, and the drag of lambda 1 to 30 is met within 0.15 %, to 50 within 1 %.
_BETWEEN = (5.0, 20.0)


@dataclass(frozen=True)
class MixedTransition(Record):
    """Where the drag, falling with speed, begins to rise; arrays, not a number where it never falls.

    ``by_roughness`` is that with the summits of one shape; the derivative of the speed by boundary friction
    is ``sensitivity["boundary"]``, by viscosity -1.
    """

    not_stated = ("temperature",)

    temperature: FloatArray
    product: Annotated[FloatArray, Means("eta U, Pa m", open=True)]
    speed: Annotated[FloatArray, Means(unit="rad/s", open=True)]
    belt_speed: Annotated[FloatArray, Means(unit="m/s", open=True)]
    lambda_ratio: Annotated[FloatArray, OPEN]
    torque: Annotated[FloatArray, Means(unit="N m", open=True)]
    sensitivity: Annotated[
        Mapping[str, FloatArray], Means("d ln eta U by the logarithm of each number of the law", open=True)
    ]
    by_roughness: Annotated[FloatArray, Means("d ln speed by the logarithm of roughness", open=True)]


@dataclass(frozen=True)
class MixedContact(Record):
    """A contact in which film and asperities share the load; made by `mixed_contact`.

    ``regime`` is the law of the film. K of a soft film is the slope of pressure at the edge of the nip, l the
    length of the inlet there; other films have edge 0 and go as their share of the load to
    -``load_exponent``. ``stiffness`` is the pressure of the asperities over F(lambda) and over the mean
    pressure of the nip; ``rolling`` goes as eta U to the ``rolling_exponent``.
    """

    not_stated = ("contact", "lubricant")

    contact: Contact
    lubricant: Lubricant
    asperities: Asperities
    friction: BoundaryFriction
    regime: Annotated[str, Means("law of the film")]
    reference: Annotated[float, Means("eta U at which the film alone is as thick as the roughness, Pa m")]
    film_exponent: float
    load_exponent: Annotated[
        float, Means("a film that is not soft varies as its share of the load to minus this power")
    ]
    edge: Annotated[
        float, Means("mean pressure over K sqrt(l) of a soft nip at the reference; 0 if not soft")
    ]
    roundness: Annotated[float, Means("K^2 a/(2 p_max^2) of the dry pressure of a soft nip")]
    stiffness: Annotated[
        float, Means("pressure of the asperities over F(lambda), over the mean pressure of the nip")
    ]
    shear: Annotated[float, Means("for a film of lambda = 1 over the nip", "N")]
    rolling: Annotated[float, Means("contribution of inlet and pressure, at the reference", "N")]
    rolling_exponent: Annotated[float, Means("rolling varies as eta U to this power")]

    def numbers(self, temperature: FloatArray) -> list[Any]:
        """Return the numbers of the law, in the order of the core, at temperatures (K)."""
        boundary = self.contact.load * self.friction.at(temperature)
        own = vars(self) | {"boundary": boundary}
        return [own[name] for name in _core.SHARING]

    @property
    def stated(self) -> Mapping[str, float]:
        """Values that a log can correct: ``viscosity`` (a factor), ``roughness`` (m), ``boundary``."""
        roughness = self.contact.roughness or 0.0
        return {"viscosity": 1.0, "roughness": roughness, "boundary": self.friction.coefficient}

    @property
    def lever(self) -> float:
        """Roll radius, at which the force acts, m."""
        return self.contact.roll_radius

    def product(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return viscosity times belt speed, Pa m, at speeds of the roll (rad/s) and temperatures (K)."""
        return np.asarray(self.lubricant.viscosity(temperature) * speed * self.contact.roll_radius)

    def warming(self, temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return d ln viscosity/dT and d ln boundary friction/dT, 1/K, at temperatures (K)."""
        of_viscosity = self.lubricant.temperature_exponent(temperature) / temperature
        return of_viscosity, np.asarray(self.friction.slope / self.friction.at(temperature))

    @takes_si(speed="speed", temperature="temperature")
    def at(self, *, speed: ArrayLike, temperature: ArrayLike) -> MixedFilm:
        """Return film and asperity load at roll speeds (rad/s; 0: asperities only) and temperatures (K).

        Raises
        ------
        ParameterError
            If a value is impossible.
        """
        speeds, kelvin = operating_points(speed, temperature)
        if not np.all(np.isfinite(speeds)):
            raise ParameterError("speed is not a finite number")
        radius = self.lever
        state = pointwise(_core.mixed_contact, self.product(speeds, kelvin), *self.numbers(kelvin))
        return MixedFilm(
            speed=speeds,
            temperature=kelvin,
            viscosity=self.lubricant.viscosity(kelvin),
            lambda_ratio=state.lambda_ratio,
            minimum_ratio=state.minimum,
            share=state.share,
            boundary_torque=state.boundary * radius,
            shear_torque=state.shear * radius,
            rolling_torque=state.rolling * radius,
            mixed=self,
        )

    def beyond_checked_range(self, share: FloatArray, product: FloatArray) -> NDArray[np.bool_]:
        """Return whether shares of the asperities and products eta U (Pa m) are outside the checked range."""
        return beyond_checked_range(self.contact, share, product, self.stiffness if self.edge else None)

    def _by_roughness(self, shift: Mapping[str, FloatArray]) -> FloatArray:
        """The reference goes as roughness^(1/n); at one product shear, rolling and inlet are the film's."""
        rolled = self.rolling_exponent * shift["rolling"] if self.rolling else 0.0
        scaled = shift["reference"] + (1.0 - self.film_exponent) * shift["shear"] + rolled
        if self.edge:  # over the square root of the inlet, which goes as the film to 2/3
            scaled = scaled - self.film_exponent / 3.0 * shift["edge"]
        return np.asarray(scaled / self.film_exponent)

    @takes_si(temperature="temperature")
    def transition(self, temperature: ArrayLike) -> MixedTransition:
        """Return the transition at temperatures (K)."""
        kelvin = np.asarray(temperature, dtype=float)
        found = pointwise(_core.mixed_transition, *self.numbers(kelvin))
        belt_speed = found.product / self.lubricant.viscosity(kelvin)
        return MixedTransition(
            temperature=kelvin,
            product=found.product,
            speed=belt_speed / self.lever,
            belt_speed=belt_speed,
            lambda_ratio=found.lambda_ratio,
            torque=found.force * self.lever,
            sensitivity=found.sensitivity,
            by_roughness=self._by_roughness(found.sensitivity),
        )


@dataclass(frozen=True, repr=False)
class MixedFilm(Result):
    """Film and asperities at operating points; all arrays have the same shape."""

    also_stated = ("torque", "beyond_checked_range")
    not_stated = ("mixed",)

    speed: Annotated[FloatArray, Means(unit="rad/s")]
    temperature: Annotated[FloatArray, Means(unit="K")]
    viscosity: Annotated[FloatArray, Means(unit="Pa s")]
    lambda_ratio: FloatArray
    minimum_ratio: Annotated[
        FloatArray, Means("minimum film divided by roughness; null where its law is unknown", open=True)
    ]
    share: Annotated[FloatArray, Means("of the load carried by asperities")]
    boundary_torque: Annotated[FloatArray, Means(unit="N m")]
    shear_torque: Annotated[FloatArray, Means(unit="N m")]
    rolling_torque: Annotated[FloatArray, Means(unit="N m")]
    mixed: MixedContact = field(compare=False)

    @property
    def torque(self) -> FloatArray:
        """Torque on the roll, N m."""
        return np.asarray(self.boundary_torque + self.shear_torque + self.rolling_torque)

    @property
    def beyond_checked_range(self) -> NDArray[np.bool_]:
        """Points outside the range checked against the full numerical solution of a contact."""
        mixed = self.mixed
        return mixed.beyond_checked_range(self.share, mixed.product(self.speed, self.temperature))

    @cached_property
    def transition(self) -> MixedTransition:
        """Transition at the temperature of each point."""
        return self.mixed.transition(self.temperature)

    def headline(self) -> str:
        """Return number of points, and range of lambda and of the asperity load."""
        film, share = np.ravel(self.lambda_ratio), 100.0 * np.ravel(self.share)
        return (
            f"{film.size} points, lambda {film.min():.3g} to {film.max():.3g}, "
            f"asperities carry {share.min():.2g} to {share.max():.3g} %"
        )

    def summary(self, names: Sequence[str] = ()) -> str:
        """Return the points and the transition as text; ``names`` of the points, numbered if not given."""
        mixed, asperities = self.mixed, self.mixed.asperities
        under = f", varying as (its load)^-{mixed.load_exponent:g}"
        if mixed.edge:
            under = " if alone, formed where the dry pressure exceeds that of the asperities"
        lines = [
            self.headline(),
            (
                f"  film: {mixed.regime}, varying as speed^{mixed.film_exponent:g}{under}; alone, lambda = "
                f"1 at eta U = {mixed.reference:.3g} Pa m"
            ),
            f"  asperities: sigma beta D = {asperities.sigma_beta_density:g}, sigma/beta = "
            f"{asperities.sigma_over_beta:g}, E* = {1e-9 * asperities.modulus:.3g} GPa",
            f"  {'point':16s} {'degC':>6s} {'rad/s':>9s} {'lambda':>7s} {'share %':>8s} {'torque N m':>11s} "
            f"{'least at rad/s':>15s}",
        ]
        columns = (self.temperature, self.speed, self.lambda_ratio, self.share, self.torque)
        titles = names or [str(number) for number in range(1, self.share.size + 1)]
        for name, kelvin, speed, ratio, share, torque, least in zip(
            titles, *(np.ravel(each) for each in (*columns, self.transition.speed)), strict=True
        ):
            turn = "nowhere" if np.isnan(least) else f"{least:.3g}"
            lines.append(
                f"  {name[:16]:16s} {celsius(kelvin):6.1f} {speed:9.3g} {ratio:7.3g} "
                f"{100 * share:8.3g} {torque:11.3g} {turn:>15s}"
            )
        if beyond := int(np.count_nonzero(self.beyond_checked_range)):
            where = f"{beyond} of {self.share.size} points"
            lines.append(f"  {where} are outside the range in which the law was checked")
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Return the law and the points, in SI; arrays of shape (points,)."""
        turn = {name: getattr(self.transition, name) for name in stated_names(MixedTransition)}
        shifts = turn.pop("sensitivity")
        points = {name: getattr(self, name) for name in stated_names(type(self))}
        turn, shifts, points = (
            {name: np.ravel(value) for name, value in each.items()} for each in (turn, shifts, points)
        )
        return json_record(
            {"law": self.mixed, "points": points, "transition": turn | {"sensitivity": shifts}}
        )

    def to_frame(self) -> pl.DataFrame:
        """Return one row per point."""
        import polars as pl

        columns = {
            "speed (rad/s)": self.speed,
            "temperature (K)": self.temperature,
            "viscosity (Pa s)": self.viscosity,
            "lambda (1)": self.lambda_ratio,
            "least film over roughness (1)": self.minimum_ratio,
            "share of asperities (1)": self.share,
            "boundary torque (N m)": self.boundary_torque,
            "shear torque (N m)": self.shear_torque,
            "rolling torque (N m)": self.rolling_torque,
            "torque (N m)": self.torque,
            "transition speed (rad/s)": self.transition.speed,
            "beyond checked range": self.beyond_checked_range,
        }
        return pl.DataFrame({name: np.ravel(values) for name, values in columns.items()})


def _edge(contact: Contact, reference: float) -> tuple[float, float]:
    """Mean pressure over K sqrt(l) at a reference, Pa m, and K^2 a/(2 p_max^2); p = K sqrt(d) at the edge."""
    nip = contact.nip
    half = nip.half_width
    # K as of the core: edge E*/(2R) sqrt(2a), E* = E'/2
    slope = nip.edge * 0.25 * contact.effective_modulus / contact.reduced_radius * (2.0 * half) ** 0.5
    length = float(inlet_length(contact, 1.0, 0.5 * reference))
    roundness = slope**2 * half / (2.0 * nip.pressure_max**2)
    return nip.pressure_mean / (slope * length**0.5), float(np.clip(roundness, _FLATTEST, 1.0))


def _soft_numbers(contact: Contact, reference: float, exponent: float) -> dict[str, float]:
    """The numbers that only a soft film has, at a reference, Pa m; what inlet and pressure add is a power."""
    edge, roundness = _edge(contact, reference)
    ends = np.array(_BETWEEN) ** (1.0 / exponent)
    low, high = soft_force_beyond(contact, reference * ends).tolist()
    power = float(np.log(high / low) / np.log(ends[1] / ends[0]))
    rolling = low / float(ends[0]) ** power
    return {"edge": edge, "roundness": roundness, "rolling": rolling, "rolling_exponent": power}


def _check_carry(asperities: Asperities, pressure: float) -> None:
    """Refuse summits that do not carry the pressure of the nip, Pa, before the mean planes meet."""
    most = asperities.pressure * float(_core.asperity_integral(np.zeros(())))
    if most <= pressure:
        raise ParameterError(
            f"the asperities carry at most {1e-6 * most:.3g} MPa before the mean planes meet, but the "
            f"nip pressure is {1e-6 * pressure:.3g} MPa. Give stiffer or denser asperities, or a softer "
            "nip"
        )


@takes_si(speed="speed", temperature="temperature", regime=Words(("governing", *REGIMES)))
def mixed_contact(
    contact: Contact,
    lubricant: Lubricant,
    asperities: Asperities,
    friction: BoundaryFriction | float,
    *,
    speed: float,
    temperature: float,
    regime: str = "governing",
) -> MixedContact:
    """Return a contact in which film and asperities share the load.

    Parameters
    ----------
    contact, lubricant
        Nip with its roughness, and lubricant.
    asperities, friction
        Of the two sliding surfaces; a number if friction does not depend on temperature.
    speed, temperature
        Reference point (rad/s, K) through which the film law passes; for a soft film any point gives the same
        law.
    regime
        Film law: ``governing`` (the one that applies at the point), or the name of one.

    Raises
    ------
    ParameterError
        If the contact has no roughness, the regime is not known or needs a pressure-viscosity coefficient, or
        a value is impossible.

    Examples
    --------
    >>> from hersey.lubrication.lubricant import EXAMPLES
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=0.6e6, poisson_ratio=0.48,
    ...                length=0.22, load=300.0, roughness=0.4e-6)
    >>> mixed = mixed_contact(roll, EXAMPLES["cylinder oil"], Asperities(modulus=50e9), 0.1,
    ...                       speed=4.0, temperature=373.15)
    >>> turn = mixed.transition([373.15, 393.15])
    >>> print(f"least drag at {turn.speed[0]:.2f} rad/s, at 20 K more at {turn.speed[1]:.2f} rad/s")
    least drag at 1.87 rad/s, at 20 K more at 3.42 rad/s
    """
    if contact.roughness is None:
        raise ParameterError(
            "the contact has no roughness. Give the composite rms roughness of both surfaces"
        )
    if regime not in ("governing", *REGIMES):
        raise ParameterError(f"regime '{regime}' is not known: governing, {', '.join(REGIMES)}")
    film = film_thickness(contact, lubricant, speed=speed, temperature=temperature)
    name = film.regime_names()[0] if regime == "governing" else regime
    if not (central := float(film.centres[name])) > 0:
        raise ParameterError(f"regime '{name}' needs the pressure-viscosity coefficient of {lubricant.name}")
    index = REGIMES.index(name)
    exponent = _core.FILM_SPEED_EXPONENTS[index]
    product = float(film.viscosity) * 2.0 * float(film.entrainment_speed)
    reference = product * (contact.roughness / central) ** (1.0 / exponent)
    soft = index == SOFT
    _check_carry(asperities, film.nip.pressure_max if soft else film.nip.pressure_mean)
    of_hard = {"edge": 0.0, "roundness": 1.0, "rolling": 0.0, "rolling_exponent": exponent}
    mixed = MixedContact(
        contact=contact,
        lubricant=lubricant,
        asperities=asperities,
        friction=friction if isinstance(friction, BoundaryFriction) else BoundaryFriction(friction),
        regime=name,
        reference=reference,
        film_exponent=exponent,
        load_exponent=max(_core.FILM_LOAD_EXPONENTS[index], _LEAST_LOAD_EXPONENT),
        **(_soft_numbers(contact, reference, exponent) if soft else of_hard),
        stiffness=asperities.pressure / film.nip.pressure_mean,
        shear=reference / contact.roughness * film.nip.width * contact.length,
    )
    mixed.transition(temperature)
    return mixed


@takes_si(speed="speed", temperature="temperature")
def mixed_torque(mixed: MixedContact, *, speed: ArrayLike, temperature: ArrayLike) -> FloatArray:
    """Return the torque of film and asperities on the roll (N m) at speeds (rad/s) and temperatures (K).

    Examples
    --------
    >>> from hersey.lubrication.lubricant import EXAMPLES
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=0.6e6, poisson_ratio=0.48,
    ...                length=0.22, load=300.0, roughness=0.4e-6)
    >>> mixed = mixed_contact(roll, EXAMPLES["cylinder oil"], Asperities(modulus=50e9), 0.1,
    ...                       speed=4.0, temperature=373.15)
    >>> torque = mixed_torque(mixed, speed=[0.0, 0.5, 2.0, 8.0], temperature=373.15)
    >>> print(" ".join(f"{value:.3f}" for value in torque))
    0.450 0.170 0.014 0.024
    """
    return mixed.at(speed=speed, temperature=temperature).torque
