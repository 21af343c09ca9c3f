"""What the machine can bear, and the states in which it is run."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from pydantic.dataclasses import dataclass

from hersey.files.toml import Quantity, Share, Table, Text
from hersey.machine.at_belt import AtBelt
from hersey.motion.belt import Drivetrain
from hersey.units import takes_si

_Speed = Annotated[float, AtBelt("belt speed", 1e-6, 1e3)]


@takes_si(
    motor_torque="torque",
    nip_load="force",
    acceleration="acceleration",
    speed="belt speed",
    spring_force="force",
)
@dataclass(frozen=True)
class Limits(Table):
    """Limits of the machine, in SI; None where not stated.

    ``motor_torque`` (N m) at the roll, ``roll_friction`` (coefficient) and ``nip_load`` (N), whose product is
    the drag at which the belt slips on the roll, ``acceleration`` (m/s^2) and ``speed`` (m/s) of the drive,
    ``spring_force`` (N) in the gear train.
    """

    motor_torque: Annotated[float, AtBelt("torque", 1e-6, 1e6)] | None = None
    roll_friction: Annotated[float, Quantity(None, 1e-3, 10.0)] | None = None
    nip_load: Annotated[float, AtBelt("force", 1e-3, 1e7)] | None = None
    #: Greatest acceleration of the drive, at the belt.
    acceleration: Annotated[float, Quantity("acceleration", 1e-6, 1e5)] | None = None
    #: Greatest speed of the drive, at the belt.
    speed: _Speed | None = None
    #: Greatest force in the gear train, at the belt.
    spring_force: Annotated[float, AtBelt("force", 1e-6, 1e7)] | None = None

    def force(self, roll_radius: float) -> tuple[str, float] | None:
        """Return the least of grip, motor torque over the roll's radius (m) and spring force, with its name.

        In N; None if none of them is stated.
        """
        motor = None if self.motor_torque is None else self.motor_torque / roll_radius
        stated = {"grip": self.grip, "motor torque": motor, "spring force": self.spring_force}
        forces = {name: force for name, force in stated.items() if force is not None}
        return min(forces.items(), key=lambda item: item[1], default=None)

    @property
    def grip(self) -> float | None:
        """Drag at which the belt slips on the roll (N), if friction and load are stated."""
        if self.roll_friction is None or self.nip_load is None:
            return None
        return self.roll_friction * self.nip_load

    def gripping(self, train: Drivetrain) -> Drivetrain:
        """Return the drivetrain with the grip of its roll; one that states a grip keeps it."""
        return train if train.grip is not None else replace(train, grip=self.grip)


@takes_si(speed="belt speed", temperature="temperature")
@dataclass(frozen=True)
class OperatingPoint(Table):
    """A named state of the machine: belt speed (m/s) and temperature (K).

    ``share`` is the fraction of the running time; None if no point states one.
    """

    name: Text
    #: Belt speed.
    speed: _Speed
    #: Temperature of the belt.
    temperature: Annotated[float, Quantity("temperature", 150.0, 1000.0)]
    #: Share of the running time; state it for all points or for none.
    share: Share | None = None
