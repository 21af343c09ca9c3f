"""What a motion asks of the motor: the torque at the roll against the greatest that the motor gives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.errors import ParameterError
from hersey.motion.trajectory import Trajectory
from hersey.result import Means, Record
from hersey.units import takes_si


@dataclass(frozen=True)
class MotorUse(Record):
    """The greatest ``torque`` (N m) of a motion, at which ``time`` (s), and the ``limit`` of the motor.

    ``exceeded_from`` is the time at which the limit is first passed (s; None if it never is), and
    ``exceeded`` the share of the motion during which it is.
    """

    torque: float
    time: Annotated[float, Means(unit="s")]
    limit: float
    exceeded_from: float | None
    exceeded: float

    def __str__(self) -> str:
        """Return it in words."""
        if self.exceeded_from is None:
            return f"the motor is strong enough: the motion needs {self.torque:.4g} of {self.limit:.4g} N m"
        return (
            f"the motor gives {self.limit:.4g} N m, but this motion needs up to {self.torque:.4g} N m "
            f"(at {self.time:.4g} s) and exceeds the limit from {self.exceeded_from:.4g} s on, "
            f"{100 * self.exceeded:.2g} % of the time"
        )


@takes_si(motor_torque="torque", roll_radius="length")
def motor_use(run: Trajectory, *, motor_torque: float, roll_radius: float) -> MotorUse:
    """Return the torque that a motion needs from a motor of ``motor_torque`` (N m) at a roll (radius in m).

    The motor carries the spring force: film, contact and the no-load torque act beyond the spring. The
    inertia of the drive itself is not in the model. Between samples the torque is a straight line.

    Raises
    ------
    ParameterError
        If torque or radius is not positive.

    Examples
    --------
    >>> from hersey import Drag, Drivetrain, simulate
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> run = simulate(Drivetrain(1000, 1), drag, drive_speed=1.0, duration=1.0)
    >>> use = motor_use(run, motor_torque=3.0, roll_radius=0.01)
    >>> round(use.torque, 3), round(use.exceeded_from, 6)
    (3.435, 0.3)
    """
    for name, value in (("motor_torque", motor_torque), ("roll_radius", roll_radius)):
        if not (math.isfinite(value) and value > 0):
            raise ParameterError(f"{name} is {value}: it must be greater than 0")
    torque = np.abs(run.spring_force) * roll_radius
    most, over = int(np.argmax(torque)), torque - motor_torque
    beyond = np.flatnonzero(over > 0)
    first = None
    if beyond.size:
        i = int(beyond[0])
        ends = float(over[i - 1]), float(over[i])
        first = float(run.time[i])
        if i > 0:
            first -= float(run.time[i] - run.time[i - 1]) * ends[1] / (ends[1] - ends[0])
    return MotorUse(
        torque=float(torque[most]),
        time=float(run.time[most]),
        limit=float(motor_torque),
        exceeded_from=first,
        exceeded=float(np.mean(over > 0)),
    )
