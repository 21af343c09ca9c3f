"""The table [heat] of the machine file: what warms the nip, and what the rest takes away."""

from __future__ import annotations

from typing import Annotated

from pydantic.dataclasses import dataclass

from hersey.files.toml import Quantity, Table
from hersey.motion.heat import HeatBalance

_Temperature = Annotated[float, Quantity("temperature", 150.0, 1000.0, "25 degC")]
_Capacity = Annotated[float, Quantity("heat capacity", 1e-6, 1e8, "150 J/K")]
_Conductance = Annotated[float, Quantity("thermal conductance", 0.0, 1e8, "0.5 W/K")]
_Power = Annotated[float, Quantity("power", 0.0, 1e8, "900 W")]


@dataclass(frozen=True)
class HeatTable(Table):
    """Two bodies that exchange heat: that of the film (heater and belt), and the roll."""

    film_capacity: _Capacity
    roll_capacity: _Capacity
    exchange: _Conductance
    surroundings: _Temperature
    heater_power: _Power
    film_loss: _Conductance = 0.0
    roll_loss: _Conductance = 0.0
    setpoint: _Temperature | None = None
    heater_gain: Annotated[float, Quantity("thermal conductance", 1e-9, 1e12, "100 W/K")] | None = None
    film_load: _Power = 0.0
    roll_load: _Power = 0.0
    film_temperature: _Temperature | None = None
    roll_temperature: _Temperature | None = None

    def heat(self) -> HeatBalance:
        """Return the balance; a body whose start is not stated is as warm as the surroundings.

        Raises
        ------
        ParameterError
            If the values do not fit each other.
        """
        stated = dict(vars(self))
        for body in ("film_temperature", "roll_temperature"):
            if stated[body] is None:
                stated[body] = self.surroundings
        return HeatBalance(**stated)
