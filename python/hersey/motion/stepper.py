"""The motion from call to call: drive and temperature are given on the way, and it can be saved."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from hersey import _core
from hersey.errors import ExtrapolationWarning, ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.motion.parameters import MOST_STEPS, whole
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import TOLERANCE, check_inputs, start_state
from hersey.motion.trajectory import Event
from hersey.units import takes_si


@dataclass(frozen=True)
class StepperState:
    """Where a motion stands; in SI, or in the units of its arguments.

    ``drag`` is all of it, of a held belt what holds it. ``stretch`` and ``spring_force`` are as of
    `Trajectory`, ``event`` is the change of mode that has just happened, if it ended the call.
    """

    time: float
    mode: str
    slipping: bool
    belt_speed: float
    stretch: float
    spring_force: float
    drag: float
    event: Event | None = None

    @property
    def stuck(self) -> bool:
        """Whether the belt is held."""
        return self.mode == "stuck"


class _Given(NamedTuple):
    train: Drivetrain
    drag: AnyDrag
    is_torque: bool
    drive: float
    temperature: float | None
    start: tuple[float, float]
    tolerance: float
    most_steps: float


class Stepper:
    """A motion that is continued from call to call, with drive and temperature that may change in between.

    Where and how often it stops does not change the motion; only a change of drive or temperature does. At a
    jump of either, belt speed and spring stretch stay, and the mode follows from the law. A stepper can be
    pickled; only one thread at a time may use it.

    Parameters
    ----------
    drive_speed, drive_torque, temperature, start, tolerance
        As for `simulate`, at time 0; drive and temperature as numbers, which hold until others are set.
    most_steps
        Limit of work per call, as for `simulate`.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name.

    Examples
    --------
    >>> from hersey import Drag
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> stepper = Stepper(Drivetrain(1000, 1), drag, drive_speed=1.0)
    >>> state = stepper.advance(2.0)
    >>> round(state.time, 6), state.event.guard, state.mode
    (0.341401, 'holding_force', 'microslip')
    >>> saved = stepper.save()
    >>> stepper.set_inputs(drive=2.0)  # no change of mode at once
    >>> while (state := stepper.advance(2.0)).event:
    ...     pass
    >>> state.time, state.mode
    (2.0, 'ehl')
    >>> stepper.restore(saved)
    >>> round(stepper.state.time, 6)
    0.341401
    """

    @takes_si(drive_speed="belt speed", drive_torque=("force", "torque"), temperature="temperature")
    def __init__(
        self,
        train: Drivetrain,
        drag: AnyDrag,
        *,
        drive_speed: float | None = None,
        drive_torque: float | None = None,
        temperature: float | None = None,
        start: str | tuple[float, float] = "rest",
        tolerance: float = TOLERANCE,
        most_steps: float = MOST_STEPS,
    ) -> None:
        check_inputs(drag, drive_speed, drive_torque, temperature)
        is_torque = drive_speed is None
        drive = _number("drive_torque", drive_torque) if is_torque else _number("drive_speed", drive_speed)
        warm = None if temperature is None else _number("temperature", temperature)
        course = None if warm is None else Schedule.of(warm - drag.temperature_zero)
        state = start_state(train, drag.law(), Schedule.of(drive), course, start, is_torque=is_torque)
        given = _Given(train, drag, is_torque, drive, warm, state, float(tolerance), most_steps)
        self._take(given)
        self._warn(drive, warm)

    def _take(self, given: _Given) -> None:
        self._given = given
        self._steps = whole("most_steps", given.most_steps)
        self._core = _core.Stepper(
            given.train._arguments,
            given.drag.law(),
            ("torque" if given.is_torque else "speed", given.drive),
            None if given.temperature is None else given.temperature - given.drag.temperature_zero,
            given.start,
            given.tolerance,
        )
        self._outside: frozenset[str] = frozenset()

    def _warn(self, drive: float | None, temperature: float | None) -> None:
        """Warn where drive speed or temperature leave the range of the log; what is None stays as it is."""
        measured = getattr(self._given.drag, "measured", None)
        if measured is None:
            return
        speeds = {} if drive is None or self._given.is_torque else {"drive_speed": drive}
        found = measured.outside(temperature, speeds)
        for name, text in found.items():
            if name not in self._outside:
                warnings.warn(text, ExtrapolationWarning, stacklevel=4)
        given = {*speeds, *(() if temperature is None else ("temperature",))}
        self._outside = frozenset((self._outside - given) | found.keys())

    @property
    def state(self) -> StepperState:
        """Current state of the motion."""
        return self._state(None)

    def _state(self, event: Event | None) -> StepperState:
        time, mode, slipping, belt_speed, stretch, drag = self._core.state()
        spring_force = self._given.train.stiffness * stretch
        return StepperState(time, mode, slipping, belt_speed, stretch, spring_force, drag, event)

    @takes_si(until="time")
    def advance(self, until: float) -> StepperState:
        """Continue to ``until`` (s), or to the first change of mode before it, and return the state.

        The state is just after the change, ``state.event``; the next call continues from there.

        Raises
        ------
        ParameterError
            If ``until`` is in the past, or there is no drag law at the temperature reached.
        UnfinishedError
            If the allowed work is exceeded, or the motion cannot be continued; the state is then the last one
            reached.
        """
        return self._state(_event(self._core.advance(_number("until", until), self._steps)))

    @takes_si(drive=("belt speed", "force", "torque"), temperature="temperature")
    def set_inputs(
        self,
        *,
        drive: float | None = None,
        temperature: float | None = None,
        drive_rate: float = 0.0,
        temperature_rate: float = 0.0,
    ) -> Event | None:
        """Set drive and temperature from now on, and return the immediate change of mode, if any.

        Warns with `ExtrapolationWarning` each time that one of them leaves the range of the log. Inputs
        that are not given continue unchanged; giving the current value changes nothing.

        Parameters
        ----------
        drive
            Speed, m/s, or force or torque, N or N m, as at creation.
        temperature
            K.
        drive_rate, temperature_rate
            Rates of change from now on, per s.

        Raises
        ------
        ParameterError
            If a number is not finite or out of range; nothing is changed then.
        """
        given = self._given
        if temperature is not None and given.temperature is None:
            raise ParameterError("temperature is given, but the drag does not depend on it")
        for name, rate, value in (
            ("drive_rate", drive_rate, drive),
            ("temperature_rate", temperature_rate, temperature),
        ):
            if value is None and rate != 0.0:
                raise ParameterError(f"{name} is given, but has no initial value")
        warm = None if temperature is None else _number("temperature", temperature)
        event = self._core.set_inputs(
            None if drive is None else _course("drive", drive, drive_rate),
            None
            if warm is None
            else _course("temperature", warm - given.drag.temperature_zero, temperature_rate),
        )
        self._warn(None if drive is None else _number("drive", drive), warm)
        return _event(event)

    def save(self) -> tuple[float, ...]:
        """Return the complete state as finite numbers, from which `restore` continues exactly."""
        return tuple(self._core.numbers())

    def restore(self, saved: Sequence[float]) -> None:
        """Continue from the result of `save`, of this stepper or another with the same drivetrain and drag.

        Drive and temperature are part of what was saved.

        Raises
        ------
        ParameterError
            If the numbers are not a possible state; nothing is changed then.
        """
        self._core.restore([_number("numbers of a moment", number) for number in saved])

    def __getstate__(self) -> tuple[_Given, tuple[float, ...]]:
        """Return the arguments and where the motion stands."""
        return self._given, self.save()

    def __setstate__(self, state: tuple[_Given, tuple[float, ...]]) -> None:
        """Take them back."""
        given, saved = state
        self._take(given)
        self.restore(saved)


def _number(name: str, given: Any) -> float:
    try:
        return float(given)
    except (TypeError, ValueError):
        raise ParameterError(f"{name} is {given!r}: it must be a number", quantity=name) from None


def _course(name: str, value: float, rate: float) -> list[float]:
    return [_number(name, value), _number(f"{name}_rate", rate), 0.0, 0.0]


def _event(change: _core._Change | None) -> Event | None:
    return None if change is None else Event(*change)
