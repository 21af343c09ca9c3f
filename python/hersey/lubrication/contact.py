"""The nip of a rubber-covered roll on a heater: geometry, moduli, width and pressure."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arguments.door import Words
from hersey.arrays import FloatArray, pointwise
from hersey.errors import ParameterError
from hersey.lubrication import paper
from hersey.result import Means, Record
from hersey.units import takes_si

#: Rules for the width of a nip.
RULES = ("layer", "hertz", "paper")
#: Walls of the film.
SIDES = ("heater", "roll")
#: Kinds of what describes a contact.
_KINDS = {
    **dict.fromkeys(
        ("roll_radius", "rubber_thickness", "length", "heater_radius", "roughness", "supply"), "length"
    ),
    "modulus": "pressure",
    "load": "force",
    "heat_flow": "power",
}
#: Poisson's ratio of a rigid body does not matter.
_RIGID = (math.inf, 0.5)


@dataclass(frozen=True)
class Nip(Record):
    """The contact of the roll, dry: rigid heater on a bonded elastic layer, plane strain."""

    also_stated = ("layer_factor",)

    width: Annotated[float, Means(unit="m")]
    pressure_mean: Annotated[float, Means("load / (width x length)", "Pa")]
    pressure_max: Annotated[float, Means("at the centre", "Pa")]
    edge: Annotated[
        float, Means("slope of pressure there, relative to that of a half-space contact of the same width")
    ]
    curvature: Annotated[
        float, Means("c in the pressure K sqrt(x) (1 + c x/a) at the edge; -1/4 on a half-space")
    ]
    width_over_hertz: Annotated[
        float, Means("width relative to that of the half-space contact under the same load")
    ]
    paper_width: Annotated[float, Means("Eq. 8", "m")]
    paper_in_range: Annotated[bool, Means("whether Eq. 8 applies here")]
    strain: Annotated[float, Means("a^2/(2 R h), a nominal strain of the layer")]

    @property
    def half_width(self) -> float:
        """Half of the width, m."""
        return 0.5 * self.width

    @property
    def layer_factor(self) -> float:
        """Soft film of the layer over that of a half-space under the same load."""
        return _core.layer_factor(self.edge, self.width_over_hertz)


@takes_si(**_KINDS)
@dataclass(frozen=True)
class Contact(Record):
    """A belt between a rubber-covered roll and a heater, in SI.

    Parameters
    ----------
    roll_radius, rubber_thickness
        Outer radius of the roll and thickness of its rubber, m.
    modulus, poisson_ratio
        Young's modulus (Pa) and Poisson's ratio (0 to 0.5) of the rubber at its temperature.
    length, load
        Length of the nip along the roll, m, and the whole load, N.
    heater_radius
        Radius of the heater, m; infinite if flat, negative if concave.
    roughness
        Composite rms roughness of both surfaces, sqrt(Rq1^2 + Rq2^2), m.
    nip_uncertainty
        Relative uncertainty of the nip width, e.g. 0.1.
    supply
        Thickness of the lubricant layer on the inlet side, m. Default: flooded inlet.
    heat_flow
        Heat flow from the heater through the film to the roll over the whole nip, W. If given, the film
        temperature is computed (`hersey.lubrication.film_temperature`).
    sensor_side
        Wall of the film whose temperature is recorded: ``heater`` or ``roll``. Needed with ``heat_flow``.

    Raises
    ------
    ParameterError
        If a value is impossible.
    """

    also_stated = ("effective_modulus", "reduced_radius")

    roll_radius: Annotated[float, Means(unit="m")]
    rubber_thickness: Annotated[float, Means(unit="m")]
    modulus: Annotated[float, Means("Young's modulus of the layer", "Pa")]
    poisson_ratio: float
    length: Annotated[float, Means(unit="m")]
    load: Annotated[float, Means(unit="N")]
    heater_radius: Annotated[float, Means(unit="m", open=True)] = math.inf
    roughness: Annotated[float | None, Means("rms", "m")] = None
    nip_uncertainty: float | None = None
    supply: Annotated[float | None, Means("oil layer on the inlet side", "m")] = None
    heat_flow: Annotated[float | None, Means("through the film", "W")] = None
    sensor_side: Annotated[str | None, Means("wall of the film whose temperature the sensor reads")] = None

    def __post_init__(self) -> None:
        """Check the values."""
        positive = ("roll_radius", "rubber_thickness", "modulus", "length", "load", "roughness", "supply")
        for name in (*positive, "nip_uncertainty"):
            value = getattr(self, name)
            if value is not None and not 0 < value < math.inf:
                raise ParameterError(f"{name} is {value:g}: it must be greater than 0")
        if self.heat_flow is not None and not 0 <= self.heat_flow < math.inf:
            raise ParameterError(f"heat_flow is {self.heat_flow:g}: it must not be negative")
        if (self.heat_flow is None) != (self.sensor_side is None):
            missing = "heat_flow" if self.heat_flow is None else "sensor_side"
            raise ParameterError(f"{missing} is missing. Give heat_flow and sensor_side together")
        if self.sensor_side not in (None, *SIDES):
            raise ParameterError(f"sensor_side is '{self.sensor_side}': it must be {' or '.join(SIDES)}")
        if self.rubber_thickness >= self.roll_radius:
            raise ParameterError(
                f"rubber_thickness is {self.rubber_thickness:g} m: it must be less than roll_radius, "
                f"{self.roll_radius:g} m"
            )
        _ = self.effective_modulus, self.reduced_radius

    @property
    def effective_modulus(self) -> float:
        """E' = 2 E/(1 - nu^2), Pa: the heater is rigid against rubber."""
        return _core.effective_modulus((self.modulus, self.poisson_ratio), _RIGID)

    @property
    def contact_modulus(self) -> float:
        """E* = E'/2, Pa."""
        return 0.5 * self.effective_modulus

    @property
    def reduced_radius(self) -> float:
        """R with 1/R = 1/R_roll + 1/R_heater, m."""
        return _core.reduced_radius(self.roll_radius, self.heater_radius)

    @property
    def load_per_length(self) -> float:
        """Load per length, N/m."""
        return self.load / self.length

    @cached_property
    def nip(self) -> Nip:
        """Width of the nip and the pressure in it (solved in about a millisecond)."""
        load = self.load_per_length
        rubber = (self.rubber_thickness, self.modulus, self.poisson_ratio)
        nip = pointwise(_core.layer, load, self.reduced_radius, *rubber)
        width = float(nip.width)
        low, high = _core.NIP_RATIO_RANGE
        by_paper = float(nip_width(self, rule="paper"))
        return Nip(
            width=width,
            pressure_mean=load / width,
            pressure_max=float(nip.pressure_max),
            edge=float(nip.edge),
            curvature=float(nip.curvature),
            width_over_hertz=float(nip.width_over_hertz),
            paper_width=by_paper,
            paper_in_range=low <= by_paper / self.rubber_thickness <= high,
            strain=width**2 / (8.0 * self.reduced_radius * self.rubber_thickness),
        )

    @takes_si(load="force")
    def loaded(self, load: float) -> Contact:
        """Return the contact under another load, N."""
        return replace(self, load=load)


@takes_si(load="force", rule=Words(RULES))
def nip_width(contact: Contact, *, load: ArrayLike | None = None, rule: str = "layer") -> FloatArray:
    """Return the width of the nip, m.

    Parameters
    ----------
    contact
        Contact with rubber, radii and length.
    load
        Load, N. Default: that of the contact.
    rule
        ``layer``: a rigid cylinder on a bonded elastic layer, solved numerically; ``hertz``: a half-space
        of the rubber; ``paper``: Eq. 8, a regression.

    Raises
    ------
    ParameterError
        If the rule is not known, a load is not positive, or the nip is wider than 80 thicknesses.

    Examples
    --------
    >>> roll = Contact(roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48,
    ...                length=0.22, load=250.0)
    >>> for rule in RULES:
    ...     print(f"{rule}: {1e3 * nip_width(roll, rule=rule):.2f} mm")
    layer: 6.28 mm
    hertz: 8.17 mm
    paper: 5.73 mm
    """
    if rule not in RULES:
        raise ParameterError(f"rule '{rule}' is not known: {', '.join(RULES)}")
    loads = np.asarray(contact.load if load is None else load, dtype=float)
    if rule == "paper":
        return paper.nip_width(
            load=loads,
            length=contact.length,
            rubber_thickness=contact.rubber_thickness,
            radius=contact.reduced_radius,
            effective_modulus=contact.effective_modulus,
        )
    per_length, radius = loads / contact.length, contact.reduced_radius
    if rule == "hertz":
        hertzian = pointwise(partial(_core.hertz, line=True), per_length, radius, contact.effective_modulus)
        return np.asarray(2.0 * hertzian.half_width)
    rubber = (contact.rubber_thickness, contact.modulus, contact.poisson_ratio)
    return pointwise(_core.layer, per_length, radius, *rubber).width


def shore_a_modulus(hardness: float) -> float:
    """Return Young's modulus of rubber, Pa, of a Shore A hardness from 20 to 80, by Gent (1958).

    Rules of this kind differ by 20 to 30 %.

    Examples
    --------
    >>> print(f"{shore_a_modulus(40) / 1e6:.2f} MPa")
    1.69 MPa
    """
    return _core.shore_a_modulus(hardness)
