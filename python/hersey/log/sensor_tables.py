"""What a file says of the errors of the sensors: the tables that a mapping and a machine file share."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

from pydantic.dataclasses import dataclass

from hersey.files.toml import Quantity, Share, Table
from hersey.log.quantities import Amount
from hersey.log.sensors import OF_ROLE, Sensors


@dataclass(frozen=True)
class TorqueErrors(Table):
    """Half widths at 95 %: a share, and N m."""

    #: Error of the gain, half width at 95 %; 1 % if not stated.
    gain_error: Share | None = None
    #: Error of the zero, half width at 95 %; 0.1 % of the largest torque if not stated.
    zero_error: Annotated[float, Quantity("torque", 0.0, 1e6, "2 mN*m")] | None = None


@dataclass(frozen=True)
class SpeedErrors(Table):
    """Half width at 95 %, a share."""

    #: Error of the gain, half width at 95 %; 0.1 % if not stated.
    gain_error: Share | None = None


@dataclass(frozen=True)
class TemperatureErrors(Table):
    """Half width at 95 %, and bound on how much friction heats the film, K."""

    #: Error of the reading, half width at 95 %; 2 K if not stated.
    zero_error: Annotated[float, Amount("temperature difference", 0.0, 100.0, "2 K")] | None = None
    #: Upper bound on frictional heating of the film above the reading.
    film_heating: Annotated[float, Amount("temperature difference", 0.0, 100.0, "3 K")] | None = None


@dataclass(frozen=True)
class SensorTables(Table):
    """The three sensors."""

    torque: TorqueErrors = field(default_factory=TorqueErrors)
    speed: SpeedErrors = field(default_factory=SpeedErrors)
    temperature: TemperatureErrors = field(default_factory=TemperatureErrors)


def sensors_of(torque: TorqueErrors, speed: SpeedErrors, temperature: TemperatureErrors) -> Sensors:
    """Return the errors as stated, defaults for the others."""
    errors = {
        "temperature_zero": temperature.zero_error,
        "film_heating": temperature.film_heating,
        "torque_gain": torque.gain_error,
        "torque_zero": torque.zero_error,
        "speed_gain": speed.gain_error,
    }
    given = {name: value for name, value in errors.items() if value is not None}
    return Sensors(**given, stated=tuple(role for role, of in OF_ROLE.items() if given.keys() & set(of)))
