"""Motion of the belt: names, units and results over the core's physics.

Arguments are in SI, or in any consistent set of units (the paper's baseline is in inches, ounces and
seconds).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey import _core
from hersey.errors import ParameterError
from hersey.log.torque_log import FloatArray

P = ParamSpec("P")
R = TypeVar("R")

#: Relative tolerance of the Taylor steps.
TOLERANCE = 1e-9
#: Share of the drive speed by which a steady start is off.
NUDGE = 1e-3


@dataclass(frozen=True)
class Drag:
    """Drag force against belt speed at one temperature (Eqs. 17-30).

    ``F = F_t (v/v_t)^(1+n)`` with n the damping exponent of the branch: ``ehl_exponent`` above the
    transition speed v_t, ``mixed_exponent`` below; below ``stick_speed`` the ``closure`` holds.
    ``retained`` is the paper's rule: A exp(-|v|/v_s), and a belt that sticks keeps its small speed.

    Raises
    ------
    ParameterError
        If a force or speed is not positive, or the stick speed exceeds the transition speed.
    """

    transition_force: float
    transition_speed: float
    ehl_exponent: float
    mixed_exponent: float
    stick_speed: float
    closure: str = "retained"

    def __post_init__(self) -> None:
        """Let the core check the values."""
        _core_call(_core.breakaway_force, self._arguments)

    @property
    def _arguments(self) -> tuple[float, float, float, float, float, str]:
        return (
            float(self.transition_force),
            float(self.transition_speed),
            float(self.ehl_exponent),
            float(self.mixed_exponent),
            float(self.stick_speed),
            self.closure,
        )

    @property
    def breakaway_force(self) -> float:
        """The drag A that a belt at rest can bear (Eq. 29)."""
        return _core.breakaway_force(self._arguments)

    def force(self, speed: ArrayLike) -> FloatArray:
        """Return the drag force at each speed, with its sign."""
        speeds = np.asarray(speed, dtype=float)
        return _core.drag_force(self._arguments, speeds.ravel().tolist()).reshape(speeds.shape)


@dataclass(frozen=True)
class Drivetrain:
    """Spring (gear train, roll core and rubber) of ``stiffness`` and moving ``mass``."""

    stiffness: float
    mass: float

    @property
    def _arguments(self) -> tuple[float, float]:
        return float(self.stiffness), float(self.mass)


@dataclass(frozen=True)
class Event:
    """A change of mode: when, from and to which, the condition crossed, and the state there."""

    time: float
    from_mode: str
    to_mode: str
    guard: str
    stretch: float
    belt_speed: float


@dataclass(frozen=True)
class Trajectory:
    """Motion at equally spaced times: arrays of shape (samples,), and every change of mode."""

    time: FloatArray
    belt_speed: FloatArray
    stretch: FloatArray
    spring_force: FloatArray
    mode: NDArray[np.str_]
    events: tuple[Event, ...]


@dataclass(frozen=True)
class StickSlipCycle:
    """What the motion settles to.

    ``kind`` is ``steady_sliding``, ``oscillation`` (without sticking), ``stick_slip``, or ``unsettled`` if
    no orbit closed within the laps allowed. Frequency is in laps per unit of time, 0 in steady sliding.
    """

    kind: str
    frequency: float
    slip_duration: float
    stick_duration: float
    speed_min: float
    speed_max: float
    stretch_min: float
    stretch_max: float
    laps: int

    @property
    def stuck_fraction(self) -> float:
        """Share of a lap during which the belt sticks."""
        return self.stick_duration * self.frequency


def simulate(
    train: Drivetrain,
    drag: Drag,
    *,
    drive_speed: float,
    duration: float,
    samples: int = 2001,
    start: str = "rest",
    tolerance: float = TOLERANCE,
) -> Trajectory:
    """Return the motion at constant drive speed, its events located to rounding.

    Parameters
    ----------
    start
        ``rest`` (belt at rest, spring slack) or ``steady`` (sliding with the drive).

    Raises
    ------
    ParameterError
        If a value is out of range.

    Examples
    --------
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> run = simulate(Drivetrain(1000, 1), drag, drive_speed=1.0, duration=1.0)
    >>> run.events[0].guard, round(run.events[0].time, 6)
    ('holding_force', 0.341401)
    """
    if samples < 2:
        raise ParameterError(f"samples is {samples}: at least 2 are needed")
    state = _start(train, drag, drive_speed, start)
    time, speed, stretch, mode, events = _core_call(
        _core.simulate,
        train._arguments,
        drag._arguments,
        float(drive_speed),
        state,
        float(duration),
        int(samples),
        float(tolerance),
    )
    names = np.array(_core.MODES)[mode]
    rows = tuple(Event(*row) for row in events)
    return Trajectory(time, speed, stretch, train.stiffness * stretch, names, rows)


def stick_slip(
    train: Drivetrain, drag: Drag, *, drive_speed: float, start: str = "rest", tolerance: float = TOLERANCE
) -> StickSlipCycle:
    """Return what the motion settles to at constant drive speed, coming from ``start``.

    Between the transition speed and the fold both sliding and stick-slip exist, and the start decides.
    ``steady`` starts sliding with the drive but for a nudge of 0.1 % in speed, since an unstable balance is
    nothing that a belt can keep.

    Raises
    ------
    ParameterError
        If a value is out of range.

    Examples
    --------
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> cycle = stick_slip(Drivetrain(1000, 1), drag, drive_speed=1.0)
    >>> cycle.kind, round(cycle.frequency, 5)
    ('stick_slip', 3.94031)
    """
    speed, stretch = _start(train, drag, drive_speed, start)
    state = speed * (1.0 + NUDGE), stretch
    return StickSlipCycle(
        *_core_call(
            _core.stick_slip,
            train._arguments,
            drag._arguments,
            float(drive_speed),
            state,
            float(tolerance),
        )
    )


def _start(train: Drivetrain, drag: Drag, drive_speed: float, start: str) -> tuple[float, float]:
    if start == "rest":
        return 0.0, 0.0
    if start == "steady":
        return float(drive_speed), float(drag.force(drive_speed)) / train.stiffness
    raise ParameterError(f"start '{start}' is not known: rest or steady")


def _core_call(function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
    """Call the core; what it refuses is a mistake of the user's."""
    try:
        return function(*args, **kwargs)
    except ValueError as error:
        raise ParameterError(str(error)) from None
