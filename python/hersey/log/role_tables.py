"""The tables of a mapping: what it says of each role, values in SI."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, ValidationInfo
from pydantic.dataclasses import dataclass

from hersey.errors import ParameterError, UnitError
from hersey.files.toml import Quantity, Table, Text
from hersey.log.derived.set_points import SetPoints
from hersey.log.quantities import Amount, amount
from hersey.log.sensor_tables import SpeedErrors, TemperatureErrors, TorqueErrors


class _NoLoad(Quantity):
    """A torque, or a log of it beside the mapping, unless its path is absolute."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> Any:
        """Return the torque in SI or the path."""
        if info.context is None or not isinstance(given, str) or amount(given):
            return super().checked(given, info)
        named = info.context.path.parent / given
        if not os.path.isfile(named):  # noqa: PTH113 - a name too long for the system is none
            raise ParameterError(
                f"is '{given}', which is neither a torque nor an existing file. "
                'Write e.g. "4 mN*m", or the name of a log'
            )
        return named


class Beside(Quantity):
    """A file beside the mapping, unless its path is absolute."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> Any:
        """Return the path."""
        if given is None or info.context is None:
            return given
        if not isinstance(given, str) or not given.strip():
            raise ParameterError(f"is {given!r}: write the name of a file")
        return info.context.path.parent / given


def _sign(given: object) -> object:
    if isinstance(given, bool) or given not in (1, -1):
        raise ParameterError(f"is {given!r}: it must be 1 or -1")
    return given


_Sign = Annotated[int, BeforeValidator(_sign)]
_GearRatio = Annotated[float, Quantity(None, 1e-4, 1e4, "12.5")]


@dataclass(frozen=True)
class RoleMapping(Table):
    """What a mapping says of one role; ``channel`` and ``unit`` are empty where the log is to tell."""

    #: Name of the channel.
    channel: Text = ""
    #: Unit of the channel, if the log states none or a wrong one.
    unit: Text = ""


@dataclass(frozen=True)
class TimeMapping(RoleMapping):
    """What it says of the time; ``every`` is that between rows, s, where no channel is a clock."""

    every: Annotated[float, Quantity("time", 1e-9, 1e6, "2 ms")] | None = None


@dataclass(frozen=True)
class LoadMapping(RoleMapping):
    """What it says of the normal load, N: a channel, a ``value``, or ``values``, one for each run."""

    #: Normal load, instead of a channel.
    value: Annotated[float, Quantity("force", 1e-9, 1e9, "50 N")] | None = None
    #: Normal load of each run.
    values: tuple[Annotated[float, Quantity("force", 1e-9, 1e9, "50 N")], ...] = ()


@dataclass(frozen=True)
class RadiusMapping(RoleMapping):
    """What it says of the radius of a friction force, m: as `LoadMapping`."""

    #: Radius at which the friction force acts, instead of a channel.
    value: Annotated[float, Quantity("length", 1e-6, 1e3, "25 mm")] | None = None
    #: Radius of each run.
    values: tuple[Annotated[float, Quantity("length", 1e-6, 1e3, "25 mm")], ...] = ()


@dataclass(frozen=True)
class PositionMapping(RoleMapping):
    """What it says of a position in the place of a speed."""

    #: Time over which speed is the slope of the position.
    window: Annotated[float, Quantity("time", 1e-6, 1e4, "0.2 s")] | None = None


@dataclass(frozen=True)
class NamesMapping(Table):
    """What it says of the names of the files."""

    #: Pattern of the names with speed, load, radius or temperature, e.g. "{speed} rpm {load} N.txt".
    pattern: Text = ""
    #: Decimal mark of their numbers, e.g. "-".
    decimal: Text = "."
    #: Table beside the mapping with a row for each file, instead: file, load [N], radius [mm] and so on.
    table: Annotated[Path | None, Beside(None)] = None


class Steps(Quantity):
    """The steps of a schedule, each a table with from, to and e.g. speed, with units."""

    def checked(self, given: Any, _: ValidationInfo[Any]) -> Any:
        """Return the schedule."""
        if given is None or isinstance(given, SetPoints):
            return given
        if not isinstance(given, list) or not all(isinstance(step, dict) for step in given):
            raise ParameterError('is no list of steps. Write [[schedule]], then from = "0 s" and so on')
        for step in given:
            if bare := [key for key, value in step.items() if not isinstance(value, str)]:
                example = f"{step[bare[0]]} {_STEP_UNITS.get(bare[0], 's')}"
                raise UnitError(
                    f"has a step whose {bare[0]} is {step[bare[0]]!r}, without a unit. Write it in quotes "
                    f'with its unit, e.g. "{example}"'
                )
        return SetPoints.of(given)


_STEP_UNITS = {"speed": "rpm", "temperature": "degC", "load": "N"}


@dataclass(frozen=True)
class TorqueMapping(TorqueErrors, RoleMapping):
    """What it says of the torque, in SI; ``no_load`` is a torque or a log."""

    #: -1 reverses the sign of the torque.
    sign: _Sign = 1
    #: Torque of the motor per ampere, if the channel is its current.
    motor_constant: Annotated[float, Amount("motor constant", 1e-6, 1e3, "35 mN*m/A")] | None = None
    #: Reading of the sensor without load.
    tare: Annotated[float, Quantity("torque", -1e6, 1e6, "4 mN*m")] = 0.0
    #: No-load torque, or a log of it beside the mapping.
    no_load: Annotated[float | Path, _NoLoad("torque", 0.0, 1e6, "4 mN*m")] = 0.0
    #: Turns of the sensor's shaft per turn of the roll.
    gear_ratio: _GearRatio = 1.0
    #: Efficiency of these gears.
    efficiency: Annotated[float, Quantity(None, 0.05, 1.0, "0.9")] = 1.0
    #: Moment of inertia, at the roll.
    inertia: Annotated[float, Amount("moment of inertia", 1e-12, 1e6, "2e-4 kg*m^2")] = 0.0


@dataclass(frozen=True)
class SpeedMapping(SpeedErrors, RoleMapping):
    """What it says of the speed."""

    #: -1 reverses the sign of the speed.
    sign: _Sign = 1
    #: Turns of the sensor's shaft per turn of the roll.
    gear_ratio: _GearRatio = 1.0


@dataclass(frozen=True)
class TemperatureMapping(TemperatureErrors, RoleMapping):
    """What it says of the temperature, in SI: film minus reading, the lag of the sensor, their bounds."""

    #: Temperature of the film minus reading.
    offset: Annotated[float, Amount("temperature difference", -100.0, 100.0, "-1.5 K")] = 0.0
    #: Time constant of the lag of the sensor.
    time_constant: Annotated[float, Quantity("time", 1e-3, 1e4, "4 s")] = 0.0
