"""The film at operating points: its thickness and drag by every law, as numbers, table and words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from hersey import _core
from hersey.arrays import FloatArray
from hersey.lubrication import paper
from hersey.lubrication.contact import RULES, Contact, Nip, nip_width
from hersey.lubrication.lubricant import Lubricant
from hersey.result import Means, Record, Result, json_record
from hersey.units import celsius

if TYPE_CHECKING:
    import polars as pl

#: Regimes of a line contact, in the order of the core.
REGIMES = tuple(_core.REGIMES)
#: Index of the soft regime, whose drag has a rolling part.
SOFT = REGIMES.index("isoviscous-elastic")
#: Name of the correction of a film that is starved.
STARVATION = "starvation"


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

    factor: Annotated[FloatArray, Means("by which the film is multiplied", shape="(points,)")]
    valid: Annotated[NDArray[np.bool_], Means("whether the rule holds there", shape="(points,)")]


@dataclass(frozen=True, repr=False)
class Film(Result):
    """Film at operating points; all arrays have the same shape.

    ``speed`` (rad/s), ``temperature`` (K), ``viscosity`` (Pa s, unsheared), ``g_v`` and ``g_e`` (the axes of
    the regime chart), ``regime`` (index into `REGIMES`), ``minimum`` and ``central`` (m) by the governing
    law, flooded, isothermal and Newtonian, before ``corrections``; ``minima`` and ``centres`` hold them for
    each law (Eq. 5 under ``paper``, if alpha is known). ``inlet_short`` says whether the soft law of a layer
    applies. ``shear_factor`` (1) and ``rolling_force`` (N/m, flooded) are the effects of inlet and pressure
    on the drag of a soft film; they are 1 and 0 in other regimes. ``contact`` and ``lubricant`` are the
    inputs.
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
        """Product of all corrections, including those outside their valid range."""
        product = np.ones_like(self.central)
        for correction in self.corrections.values():
            product = product * correction.factor
        return product

    def lambda_ratio(self, roughness: float) -> FloatArray:
        """Corrected minimum film divided by composite rms roughness."""
        return np.asarray(self.minimum * self.factor / roughness)

    def regime_names(self) -> list[str]:
        """Return the regime of each point, flattened."""
        return [REGIMES[i] for i in self.regime.ravel()]

    @property
    def shear(self) -> FloatArray:
        """Torque on the roll due to sliding, N m: eta U/h_c over the nip, times ``shear_factor``."""
        thickness = self.central * self.factor
        rate = 2.0 * self.entrainment_speed / thickness
        viscosity = self.lubricant.viscosity(self.temperature, rate)
        return np.asarray(torque_of(self, thickness, viscosity) * self.shear_factor)

    @property
    def rolling(self) -> FloatArray:
        """Torque on the roll due to the pressure gradient in the film, N m.

        It varies as viscosity^0.8 and the film as viscosity^0.6, so a factor on the film from a thinner
        lubricant counts with power 4/3 here. In a starved film it varies as h^3.
        """
        contact, force = self.contact, self.rolling_force
        for name, correction in self.corrections.items():
            force = force * correction.factor ** (3.0 if name == STARVATION else 4.0 / 3.0)
        return np.asarray(force * contact.length * contact.roll_radius)

    @property
    def torque(self) -> FloatArray:
        """Torque of the film on the roll, N m: ``shear`` plus ``rolling``; see `drag_torque`."""
        return np.asarray(self.shear + self.rolling)

    def summary(self, names: Sequence[str] = ()) -> str:
        """Return nip, film and laws as text; ``names`` of the points, numbered if not given."""
        return "\n".join([*_nip_lines(self), "", *_point_lines(self, names), "", *_law_lines(self)])

    def headline(self) -> str:
        """Return number of points, regimes and range of the film."""
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
        """Return only the states, in SI; arrays of shape (points,)."""
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


def torque_of(film: Film, thickness: FloatArray, viscosity: FloatArray) -> FloatArray:
    """Return the torque of sheared films (m) of these viscosities (Pa s) over the nip, N m: Eq. 7."""
    return paper.torque_of_film(
        viscosity=viscosity,
        sliding_speed=2.0 * film.entrainment_speed,
        film_thickness=thickness,
        nip_width=film.nip.width,
        length=film.contact.length,
        radius=film.contact.roll_radius,
    )


def _nip_lines(film: Film) -> list[str]:
    contact, lubricant, nip = film.contact, film.lubricant, film.nip
    rules = ", ".join(f"{rule} {1e3 * float(nip_width(contact, rule=rule)):.3g}" for rule in RULES)
    return [
        f"nip       {1e3 * nip.width:.3g} mm wide (by rule, mm: {rules}); "
        f"pressure {1e-6 * nip.pressure_mean:.3g} MPa mean, {1e-6 * nip.pressure_max:.3g} MPa at the centre",
        (
            f"moduli    E' = {1e-6 * contact.effective_modulus:.4g} MPa = 2 E/(1 - nu^2), E* = E'/2; the "
            f"soft film of the layer is {nip.layer_factor:.3g} times that of a half-space"
        ),
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
    lines = ["minimum film by each law, um"]
    for law in CONSTANTS:
        if law.law in film.minima:
            values = " ".join(f"{1e6 * h:9.3g}" for h in np.ravel(film.minima[law.law]))
            lines.append(f"  {law.law:22s} {values}  {law.formula}")
    lines.append(f"  all with {CONSTANTS[0].convention}")
    for name, correction in film.corrections.items():
        values = " ".join(f"{value:9.4g}" for value in np.ravel(correction.factor))
        where = "" if np.all(correction.valid) else "  (outside the valid range of its rule)"
        lines.append(f"  factor, {name:14s} {values}{where}")
    return lines
