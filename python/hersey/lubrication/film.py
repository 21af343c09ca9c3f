"""Film thickness and drag of a nip: every law beside the others, which holds, and what else thins the film.

Conventions: ``speed`` is the angular speed of the roll (rad/s); the belt moves at U = speed roll_radius over
a heater at rest, so the entrainment speed is u = U/2 (the MEAN) and the sliding speed U. E' = 2 E/(1 - nu^2).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey import _core
from hersey.arrays import FloatArray, pointwise
from hersey.errors import ParameterError
from hersey.lubrication import paper
from hersey.lubrication.contact import RULES, Contact, Nip, nip_width
from hersey.lubrication.lubricant import Lubricant
from hersey.result import Record, Result, json_record
from hersey.units import celsius, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Regimes of a line contact, in the order of the core.
REGIMES = tuple(_core.REGIMES)
#: Laws a film can be computed by: that which holds, one of the regimes', or Eq. 5 of the paper.
LAWS = ("governing", *REGIMES, "paper")
#: Both walls slide past each other at U while the mean speed is U/2: slide-to-roll ratio of a heater at rest.
SLIDE_TO_ROLL = 2.0
#: Index of the soft regime, whose drag has a rolling part.
_SOFT = 2
_STARVATION = "starvation"
#: The inlet must be this much shorter than layer and half-width for the soft law of a layer.
_SHORT = 0.25


@dataclass(frozen=True)
class Constant:
    """A number in a law, with the convention that it belongs to."""

    law: str
    formula: str
    convention: str
    source: str


_LOW = [low for low, _ in _core.FILM_CONSTANTS]
_MID = [mid for _, mid in _core.FILM_CONSTANTS]
_MEAN = (
    "mean speed u = (u1 + u2)/2, E' = 2/sum[(1-nu^2)/E], H = h/R, U = eta u/(E'R), W = w/(E'R), G = alpha E'"
)
#: The laws, as printed beside their results.
CONSTANTS: tuple[Constant, ...] = (
    Constant(REGIMES[0], f"h = {_LOW[0]:g} eta u R/w", _MEAN, "Martin 1916; 4.895 by integration"),
    Constant(REGIMES[1], f"H = {_LOW[1]:g} (G U)^(2/3)", _MEAN, "Blok 1950; 1.666 by integration"),
    Constant(
        REGIMES[2],
        f"(H_min, H_centre) = ({_LOW[2]:.3g}, {_MID[2]:.3g}) U^0.6 W^-0.2, times the factor of the layer",
        _MEAN,
        "Herrebrugh 1968, Hooke 1977; numerical solutions 3.05 and 3.78",
    ),
    Constant(
        REGIMES[3],
        f"H_min = {_LOW[3]:g} U^0.70 G^0.54 W^-0.13, H_centre = {_MID[3]:g} U^0.69 G^0.56 W^-0.10",
        _MEAN,
        "Dowson and Higginson 1966; Dowson and Toyoda 1978",
    ),
    Constant(
        "paper", "delta = 1.6 alpha^0.6 R^0.43 E'^0.03 (eta u)^0.7 (N/L)^-0.13", _MEAN, "NIP31 (2015), Eq. 5"
    ),
)


@dataclass(frozen=True)
class Correction(Record):
    """A factor on the film, and where the rule behind it holds; arrays of the shape of the film."""

    factor: FloatArray
    valid: NDArray[np.bool_]


@dataclass(frozen=True, repr=False)
class Film(Result):
    """The film at operating points; arrays of one shape.

    ``speed`` (rad/s), ``temperature`` (K), ``viscosity`` (Pa s, unsheared), ``g_v`` and ``g_e`` (the axes of
    the regime chart), ``regime`` (index into `REGIMES`), ``minimum`` and ``central`` (m) by the governing
    law, flooded, isothermal and Newtonian, before ``corrections``; ``minima`` and ``centres`` hold them by
    each law (Eq. 5 under ``paper``, where alpha is known). ``inlet_short`` says whether the soft law of a
    layer holds. ``shear_factor`` (1) and ``rolling_force`` (N/m, flooded) are what inlet and pressure make
    of a soft film's drag, 1 and 0 in other regimes. ``contact`` and ``lubricant`` are those it was computed
    for.
    """

    speed: FloatArray
    temperature: FloatArray
    entrainment_speed: FloatArray
    viscosity: FloatArray
    g_v: FloatArray
    g_e: FloatArray
    regime: NDArray[np.intp]
    minimum: FloatArray
    central: FloatArray
    minima: Mapping[str, FloatArray]
    centres: Mapping[str, FloatArray]
    inlet_short: NDArray[np.bool_]
    shear_factor: FloatArray
    rolling_force: FloatArray
    contact: Contact
    lubricant: Lubricant
    nip: Nip
    corrections: Mapping[str, Correction] = field(default_factory=dict)

    @property
    def factor(self) -> FloatArray:
        """Product of the corrections, those outside the validity of their rules too."""
        product = np.ones_like(self.central)
        for correction in self.corrections.values():
            product = product * correction.factor
        return product

    def lambda_ratio(self, roughness: float) -> FloatArray:
        """Corrected minimum film over composite rms roughness (m)."""
        return np.asarray(self.minimum * self.factor / roughness)

    def regime_names(self) -> list[str]:
        """Return the regime of each point, flattened."""
        return [REGIMES[i] for i in self.regime.ravel()]

    @property
    def shear(self) -> FloatArray:
        """Torque on the roll by sliding, N m: eta U/h_c over the nip, times ``shear_factor``."""
        thickness = self.central * self.factor
        rate = 2.0 * self.entrainment_speed / thickness
        viscosity = self.lubricant.viscosity(self.temperature, rate)
        return np.asarray(_torque_of(self, thickness, viscosity) * self.shear_factor)

    @property
    def rolling(self) -> FloatArray:
        """Torque on the roll by the gradient of pressure in the film, N m.

        It goes as viscosity^0.8 where the film goes as viscosity^0.6, so what thins the film by a thinner
        lubricant takes the power 4/3 of its factor; as h^3 where the film is starved.
        """
        contact, force = self.contact, self.rolling_force
        for name, correction in self.corrections.items():
            force = force * correction.factor ** (3.0 if name == _STARVATION else 4.0 / 3.0)
        return np.asarray(force * contact.length * contact.roll_radius)

    @property
    def torque(self) -> FloatArray:
        """Torque on the roll that the film takes, N m, ``shear`` and ``rolling``: see `drag_torque`."""
        return np.asarray(self.shear + self.rolling)

    def summary(self, names: Sequence[str] = ()) -> str:
        """Return nip, film and laws as text; ``names`` of the points, numbered if not given."""
        return "\n".join([*_nip_lines(self), "", *_point_lines(self, names), "", *_law_lines(self)])

    def headline(self) -> str:
        """Return how many points, in which regime, and the range of the film."""
        film = 1e6 * np.ravel(self.minimum * self.factor)
        regimes = " and ".join(dict.fromkeys(self.regime_names()))
        return f"{film.size} points, {regimes}, minimum film {film.min():.3g} to {film.max():.3g} um"

    def to_dict(self) -> dict[str, Any]:
        """Return contact, lubricant, nip, laws and the states, in SI."""
        nip = {rule: float(nip_width(self.contact, rule=rule)) for rule in RULES}
        return json_record(
            {
                "contact": self.contact,
                "lubricant": self.lubricant,
                "nip": self.nip.to_dict() | nip,
                "laws": CONSTANTS,
                "film": self.states(),
            }
        )

    def states(self) -> dict[str, Any]:
        """Return the states alone, in SI; arrays of shape (points,)."""
        others = ("contact", "lubricant", "nip", "corrections", "regime", "minima", "centres")
        hidden = {*others, "shear_factor", "rolling_force"}
        arrays = {name: np.ravel(values) for name, values in vars(self).items() if name not in hidden}
        by_law = {
            name: {law: np.ravel(film) for law, film in getattr(self, name).items()}
            for name in ("minima", "centres")
        }
        corrections = {
            name: {"factor": np.ravel(c.factor), "valid": np.ravel(c.valid)}
            for name, c in self.corrections.items()
        }
        torque = {name: np.ravel(getattr(self, name)) for name in ("shear", "rolling", "torque")}
        regimes = {"regime": self.regime_names()}
        return json_record({**arrays, **by_law, **regimes, **torque, "corrections": corrections})

    def to_frame(self) -> pl.DataFrame:
        """Return one row per point; films with all corrections."""
        import polars as pl

        columns = {
            "speed (rad/s)": self.speed,
            "temperature (K)": self.temperature,
            "entrainment speed (m/s)": self.entrainment_speed,
            "viscosity (Pa s)": self.viscosity,
            "g_V (1)": self.g_v,
            "g_E (1)": self.g_e,
            "minimum film (m)": self.minimum * self.factor,
            "central film (m)": self.central * self.factor,
            "shear (N m)": self.shear,
            "rolling (N m)": self.rolling,
            "torque (N m)": self.torque,
        }
        table = pl.DataFrame({name: np.ravel(values) for name, values in columns.items()})
        return table.with_columns(pl.Series("regime", self.regime_names()))


@takes_si(speed="speed", temperature="temperature", supply="length")
def film_thickness(
    contact: Contact,
    lubricant: Lubricant,
    *,
    speed: ArrayLike,
    temperature: ArrayLike,
    supply: float | None = None,
    starvation_sharpness: float = 3.0,
) -> Film:
    """Return the film of a nip by all laws at operating points, and the law that holds.

    Parameters
    ----------
    contact, lubricant
        The nip and what is in it. A lubricant without a pressure-viscosity coefficient counts as one that
        pressure does not thicken.
    speed, temperature
        Of the roll (rad/s) and of the film (K), broadcast together.
    supply
        Thickness of the layer on the inlet side, m; that of the contact if not given, a flooded inlet if it
        has none.
    starvation_sharpness
        Rounds the corner between flooded and starved, 2 to 5.

    Raises
    ------
    ParameterError
        If a speed is zero or a value impossible.

    Examples
    --------
    >>> from hersey.lubrication.lubricant import EXAMPLES
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48,
    ...                length=0.22, load=250.0)
    >>> film = film_thickness(roll, EXAMPLES["cylinder oil"], speed=4.0, temperature=373.15)
    >>> print(film.regime_names()[0], f"{1e6 * film.central:.1f} um")
    isoviscous-elastic 2.2 um
    """
    speeds, temperatures = np.broadcast_arrays(
        np.abs(np.asarray(speed, dtype=float)), np.asarray(temperature, dtype=float)
    )
    nip = contact.nip
    viscosity = lubricant.viscosity(temperatures)
    alpha = lubricant.alpha(temperatures) if lubricant.pressure_viscosity else np.zeros_like(viscosity)
    entrainment = 0.5 * speeds * contact.roll_radius
    laws = pointwise(
        _core.line_film,
        alpha,
        viscosity,
        entrainment,
        contact.load_per_length,
        contact.reduced_radius,
        contact.effective_modulus,
        nip.layer_factor,
    )
    minima, centres = dict(laws.minimum), dict(laws.central)
    if np.all(alpha > 0):
        minima["paper"] = centres["paper"] = paper.film_thickness(
            pressure_viscosity=alpha,
            viscosity=viscosity,
            entrainment_speed=entrainment,
            load=contact.load,
            length=contact.length,
            radius=contact.reduced_radius,
            effective_modulus=contact.effective_modulus,
        )
    regime = laws.regime.astype(np.intp)
    inlet = pointwise(
        _core.inlet_length,
        viscosity,
        entrainment,
        contact.reduced_radius,
        contact.effective_modulus,
        nip.edge,
        nip.half_width,
    )
    central = np.choose(regime, list(laws.central.values()))
    force = _soft_traction(contact, viscosity, entrainment)
    soft = regime == _SOFT
    film = Film(
        speed=speeds,
        temperature=temperatures,
        entrainment_speed=entrainment,
        viscosity=viscosity,
        g_v=laws.g_v,
        g_e=laws.g_e,
        regime=regime,
        minimum=np.choose(regime, list(laws.minimum.values())),
        central=central,
        minima=minima,
        centres=centres,
        inlet_short=np.asarray(inlet < _SHORT * min(contact.rubber_thickness, nip.half_width)),
        shear_factor=np.where(soft, force.shear_factor, 1.0),
        rolling_force=np.where(soft, force.rolling, 0.0),
        contact=contact,
        lubricant=lubricant,
        nip=nip,
    )
    layer = contact.supply if supply is None else supply
    corrections = _corrections(film, lubricant, layer, starvation_sharpness)
    return Film(**{**vars(film), "corrections": corrections})


def soft_force_beyond(contact: Contact, product: FloatArray) -> FloatArray:
    """Return what a soft film takes beyond eta U/h_c over the nip, N: inlet shear and rolling, flooded.

    ``product`` is that of viscosity and belt speed, Pa m.
    """
    one, entrainment = np.ones_like(product), 0.5 * product
    nip = contact.nip
    laws = pointwise(
        _core.line_film,
        0.0,
        one,
        entrainment,
        contact.load_per_length,
        contact.reduced_radius,
        contact.effective_modulus,
        nip.layer_factor,
    )
    force = _soft_traction(contact, one, entrainment)
    plain = product / laws.central[REGIMES[_SOFT]] * nip.width
    return np.asarray(contact.length * (plain * (force.shear_factor - 1.0) + force.rolling))


def _soft_traction(contact: Contact, viscosity: FloatArray, entrainment: FloatArray) -> _core.Traction:
    nip = contact.nip
    return pointwise(
        _core.soft_traction,
        viscosity,
        entrainment,
        contact.reduced_radius,
        contact.effective_modulus,
        nip.edge,
        nip.curvature,
        nip.half_width,
        contact.rubber_thickness,
    )


def _corrections(
    film: Film, lubricant: Lubricant, supply: float | None, sharpness: float
) -> dict[str, Correction]:
    corrections = {}
    if lubricant.thinning is not None:
        carreau = lubricant.thinning
        exponent = np.asarray(_core.FILM_SPEED_EXPONENTS)[film.regime]
        answer = pointwise(
            _core.shear_thinning,
            film.central,
            2.0 * film.entrainment_speed,
            exponent,
            carreau.relaxation_time,
            carreau.exponent,
            carreau.limit,
        )
        corrections["shear thinning"] = _correction(answer)
    if lubricant.conductivity is not None:
        fall = -lubricant.temperature_exponent(film.temperature) / film.temperature
        answer = pointwise(
            _core.inlet_heating,
            film.viscosity,
            fall,
            film.entrainment_speed,
            lubricant.conductivity,
            SLIDE_TO_ROLL,
        )
        corrections["inlet heating"] = _correction(answer)
    if supply is not None:
        corrections[_STARVATION] = _correction(pointwise(_core.starvation, supply, film.central, sharpness))
    return corrections


def _correction(answer: _core.Correction) -> Correction:
    return Correction(answer.factor, answer.valid)


@takes_si(speed="speed", temperature="temperature", supply="length")
def drag_torque(
    contact: Contact,
    lubricant: Lubricant,
    *,
    speed: ArrayLike,
    temperature: ArrayLike,
    law: str = "governing",
    supply: float | None = None,
) -> FloatArray:
    """Return the torque (N m) that the film takes: shear (eta U/h_c) nip L R, Eq. 7, and rolling.

    A soft film's inlet, and the gradient of pressure in it, add up to half of the shear: see `Film.shear` and
    `Film.rolling`, and docs/film.md for their range.

    Parameters
    ----------
    contact, lubricant, speed, temperature, supply
        As in `film_thickness`.
    law
        ``governing``: the film of the regime that holds, on the nip of a bonded layer, with all corrections;
        the name of a regime: its film on that nip, shear alone; ``paper``: Eq. 9.

    Raises
    ------
    ParameterError
        If the law is not known, or the paper's asked for without a pressure-viscosity coefficient.

    Examples
    --------
    >>> from hersey.lubrication.lubricant import EXAMPLES
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48,
    ...                length=0.22, load=250.0)
    >>> torque = drag_torque(roll, EXAMPLES["cylinder oil"], speed=[4.0, 8.0], temperature=373.15)
    >>> print(f"torque grows as speed to the power {np.log2(torque[1] / torque[0]):.2f}")
    torque grows as speed to the power 0.42
    """
    if law not in LAWS:
        raise ParameterError(f"law '{law}' is not known: {', '.join(LAWS)}")
    if law == "paper":
        kelvin = np.asarray(temperature, dtype=float)
        return paper.torque(
            pressure_viscosity=lubricant.alpha(kelvin),
            viscosity=lubricant.viscosity(kelvin),
            entrainment_speed=0.5 * np.abs(np.asarray(speed, dtype=float)) * contact.roll_radius,
            load=contact.load,
            length=contact.length,
            rubber_thickness=contact.rubber_thickness,
            radius=contact.reduced_radius,
            effective_modulus=contact.effective_modulus,
        )
    film = film_thickness(contact, lubricant, speed=speed, temperature=temperature, supply=supply)
    if law == "governing":
        return film.torque
    if np.any(film.centres[law] <= 0):
        raise ParameterError(f"law '{law}' needs the pressure-viscosity coefficient of {lubricant.name}")
    return _torque_of(film, film.centres[law], film.viscosity)


def _torque_of(film: Film, thickness: FloatArray, viscosity: FloatArray) -> FloatArray:
    return paper.torque_of_film(
        viscosity=viscosity,
        sliding_speed=2.0 * film.entrainment_speed,
        film_thickness=thickness,
        nip_width=film.nip.width,
        length=film.contact.length,
        radius=film.contact.roll_radius,
    )


@takes_si(sliding_speed="belt speed", temperature="temperature")
def shear_heating(lubricant: Lubricant, *, sliding_speed: ArrayLike, temperature: ArrayLike) -> FloatArray:
    """Return the greatest rise of temperature in a sheared film between walls of one temperature, K.

    It is eta U^2/(8 k).

    Raises
    ------
    ParameterError
        If the conductivity of the lubricant is not known.
    """
    if lubricant.conductivity is None:
        raise ParameterError(f"the thermal conductivity of {lubricant.name} is not known: state it")
    viscosity = lubricant.viscosity(temperature)
    return pointwise(_core.shear_heating, viscosity, sliding_speed, lubricant.conductivity).greatest


def _nip_lines(film: Film) -> list[str]:
    contact, lubricant, nip = film.contact, film.lubricant, film.nip
    rules = ", ".join(f"{rule} {1e3 * float(nip_width(contact, rule=rule)):.3g}" for rule in RULES)
    return [
        f"nip       {1e3 * nip.width:.3g} mm wide (by rule, mm: {rules}); "
        f"pressure {1e-6 * nip.pressure_mean:.3g} MPa mean, {1e-6 * nip.pressure_max:.3g} MPa at the centre",
        f"moduli    E' = {1e-6 * contact.effective_modulus:.4g} MPa = 2 E/(1 - nu^2), E* = E'/2; "
        f"the layer's soft film is {nip.layer_factor:.3g} of a half-space's",
        f"lubricant {lubricant.name}, {lubricant.model}",
    ]


def _point_lines(film: Film, names: Sequence[str]) -> list[str]:
    table = film.to_frame()
    lines = [
        f"  {'point':16s} {'degC':>6s} {'eta mPa s':>10s} {'g_V':>9s} {'g_E':>9s} {'h_min um':>9s} "
        f"{'h_c um':>9s} {'torque N m':>11s} {'rolling':>8s}  regime"
    ]
    titles = names or [str(number) for number in range(1, table.height + 1)]
    for name, row in zip(titles, table.iter_rows(named=True), strict=True):
        lines.append(
            f"  {name[:16]:16s} {celsius(row['temperature (K)']):6.1f} {1e3 * row['viscosity (Pa s)']:10.4g} "
            f"{row['g_V (1)']:9.3g} {row['g_E (1)']:9.3g} {1e6 * row['minimum film (m)']:9.3g} "
            f"{1e6 * row['central film (m)']:9.3g} {row['torque (N m)']:11.3g} "
            f"{row['rolling (N m)']:8.3g}  {row['regime']}"
        )
    return lines


def _law_lines(film: Film) -> list[str]:
    lines = ["minimum film by every law, um"]
    for law in CONSTANTS:
        if law.law in film.minima:
            values = " ".join(f"{1e6 * h:9.3g}" for h in np.ravel(film.minima[law.law]))
            lines.append(f"  {law.law:22s} {values}  {law.formula}")
    lines.append(f"  all with {CONSTANTS[0].convention}")
    for name, correction in film.corrections.items():
        values = " ".join(f"{value:9.4g}" for value in np.ravel(correction.factor))
        where = "" if np.all(correction.valid) else "  (outside the validity of its rule)"
        lines.append(f"  factor, {name:14s} {values}{where}")
    return lines
