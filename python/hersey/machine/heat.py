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

    #: Heat capacity of the body of the film: heater, belt and film.
    film_capacity: _Capacity
    #: Heat capacity of the roll.
    roll_capacity: _Capacity
    #: Thermal conductance between the two bodies, through the nip.
    exchange: _Conductance
    #: Temperature of the surroundings.
    surroundings: _Temperature
    #: Power of the heater; with setpoint the greatest.
    heater_power: _Power
    #: Thermal conductance from the body of the film to the surroundings.
    film_loss: _Conductance = 0.0
    #: Thermal conductance from the roll to the surroundings.
    roll_loss: _Conductance = 0.0
    #: Temperature at which the heater holds the body of the film; without it heater_power is given all the
    #: time.
    setpoint: _Temperature | None = None
    #: Gain of that control; without it full power until 0.1 K below setpoint.
    heater_gain: Annotated[float, Quantity("thermal conductance", 1e-9, 1e12, "100 W/K")] | None = None
    #: Power that paper takes from the body of the film.
    film_load: _Power = 0.0
    #: Power that paper takes from the roll.
    roll_load: _Power = 0.0
    #: Temperature of the body of the film at the start; without it that of the surroundings.
    film_temperature: _Temperature | None = None
    #: Temperature of the roll at the start; without it that of the surroundings.
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
