"""The tables ``[asperities]`` and ``[boundary]`` of `machine.toml`: what shares the load with the film."""

from __future__ import annotations

from typing import Annotated

from pydantic.dataclasses import dataclass

from hersey.errors import ParameterError
from hersey.files.toml import Quantity, Table
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.machine.no_load import PerKelvin


@dataclass(frozen=True)
class AsperitiesTable(Table):
    """Summits of the two faces that slide: contact modulus E*, and what their shape is."""

    #: Contact modulus E* of the faces of belt and heater that touch, not of the rubber.
    modulus: Annotated[float, Quantity("pressure", 1e6, 2e12, "3 GPa")]
    #: Roughness times radius of the asperities times their number per area.
    sigma_beta_density: Annotated[float, Quantity(None, 1e-3, 1.0, "0.05")] = Asperities.sigma_beta_density
    #: Roughness over radius of the asperities.
    sigma_over_beta: Annotated[float, Quantity(None, 1e-6, 1.0, "0.01")] = Asperities.sigma_over_beta

    def asperities(self) -> Asperities:
        """Return the summits."""
        return Asperities(**vars(self))


@dataclass(frozen=True)
class BoundaryTable(Table):
    """Friction where asperities carry all; ``temperature_slope`` is a share of it for each kelvin."""

    #: Friction coefficient where asperities carry all of the load.
    friction: Annotated[float, Quantity(None, 1e-6, 10.0, "0.1")]
    #: Change of the friction coefficient per kelvin, as a share of it.
    temperature_slope: PerKelvin | None = None
    #: Temperature at which friction holds; needed with temperature_slope.
    at: Annotated[float, Quantity("temperature", 150.0, 1000.0, "180 degC")] | None = None
    #: Friction coefficient of a belt at rest; without it, break-away drag is e times the drag at the stick
    #: speed.
    static_friction: Annotated[float, Quantity(None, 1e-6, 10.0, "0.15")] | None = None

    def boundary(self) -> BoundaryFriction:
        """Return the friction.

        Raises
        ------
        ParameterError
            If it has a slope and no temperature.
        """
        if self.temperature_slope is None:
            return BoundaryFriction(self.friction)
        if self.at is None:
            raise ParameterError(
                'has temperature_slope but no reference temperature. Add e.g. at = "180 degC"'
            )
        return BoundaryFriction(self.friction, self.friction * self.temperature_slope, self.at)


#: What each part of a machine that shares its load is to say, by table.
NEEDED = {
    "contact": 'rubber_thickness, modulus or shore_a, poisson_ratio, length, load and roughness = "0.4 um"',
    "lubricant": 'example = "cylinder oil", or model and viscosities',
    "asperities": 'modulus = "3 GPa"',
    "boundary": "friction = 0.1",
}
