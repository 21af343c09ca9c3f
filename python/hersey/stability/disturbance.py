"""How one comes to a drive speed, and what a sliding belt bears: steps, ramps and kicks.

Between the transition speed and the fold a belt slides on only if nothing throws it out of the unstable
cycle around steady sliding. Each question here is answered by the exact motion itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, pi, sqrt
from typing import Annotated

from hersey.errors import ParameterError
from hersey.motion.belt import BeltDrag, Drivetrain, Train, belt_of
from hersey.motion.drag import AnyDrag
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import StickSlipCycle, simulate, steady_start, stick_slip
from hersey.result import OPEN, Means, Record
from hersey.stability.hysteresis import HysteresisBand, hysteresis
from hersey.units import takes_si

#: Ramps looked at per period of the free oscillation, and periods up to which they are.
_PER_PERIOD, _PERIODS = 20, 8
#: Halvings of a ramp time or of a kick.
_HALVINGS = 30
#: Periods for which the belt is watched after a ramp before what it settles to is asked.
_WATCHED = 10


@dataclass(frozen=True)
class SafeStep(Record):
    """A change of drive speed from steady sliding.

    ``sticks`` says whether the belt sticks after a sudden step, ``slowest`` is its lowest speed then.
    ``ramp_time`` (s) is the shortest ramp for which it and every longer ramp avoid sticking: 0 if a sudden
    step does, infinite if none does.
    """

    from_speed: float
    to_speed: float
    sticks: bool
    slowest: float
    ramp_time: Annotated[float, OPEN]


@dataclass(frozen=True)
class Disturbance(Record):
    """Disturbances that turn steady sliding at ``drive_speed`` into stick-slip.

    ``kick`` and ``step`` (m/s) are the largest that sliding survives: infinite if none is too large (a kick:
    down to a full stop), and 0 if steady sliding itself is unstable.
    """

    drive_speed: float
    kick: Annotated[float, Means("largest sudden loss of speed that sliding survives", "m/s", open=True)]
    step: Annotated[
        float,
        Means("largest sudden step of the drive down to this speed that sliding survives", "m/s", open=True),
    ]


@takes_si(from_speed="belt speed", to_speed="belt speed", temperature="temperature")
def safe_step(
    train: Train, drag: BeltDrag, *, from_speed: float, to_speed: float, temperature: float | None = None
) -> SafeStep:
    """Return whether a sudden change of drive speed makes a sliding belt stick, and the shortest safe ramp.

    Ramps are tested at 20 durations per period of the free oscillation, up to 8 periods; the shortest safe
    one is then refined by bisection. ``temperature`` (K) is needed if the drag depends on it.

    Raises
    ------
    ParameterError
        If a speed is not positive, or steady sliding at ``from_speed`` is unstable.

    Examples
    --------
    >>> from hersey import Drag
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> step = safe_step(Drivetrain(1000, 1), drag, from_speed=2.5, to_speed=1.2)
    >>> step.sticks, step.ramp_time < 0.1
    (True, True)
    """
    train, drag, temperature = belt_of(train, drag, temperature, from_speed=from_speed, to_speed=to_speed)
    for name, speed in (("from_speed", from_speed), ("to_speed", to_speed)):
        if not 0 < speed < inf:
            raise ParameterError(
                f"{name} is {speed}: it must be greater than 0", quantity=name, value=speed, limit=0.0
            )
    band = hysteresis(train, drag, temperature=temperature, sensitivity=False)
    return step_within(band, train, drag, from_speed=from_speed, to_speed=to_speed, temperature=temperature)


def step_within(
    band: HysteresisBand,
    train: Drivetrain,
    drag: AnyDrag,
    *,
    from_speed: float,
    to_speed: float,
    temperature: float | None = None,
) -> SafeStep:
    """Return the same as `safe_step` where the band of the belt is known."""
    if from_speed < band.transition:
        raise ParameterError(
            f"from_speed is {from_speed}, below the transition speed {band.transition:.6g}. Below it, "
            "sliding is unstable: start from a higher speed",
            quantity="from_speed",
            value=from_speed,
            limit=band.transition,
        )
    sticks, slowest = _sticks(train, drag, from_speed, to_speed, 0.0, temperature)
    if to_speed < band.lower:
        return SafeStep(from_speed, to_speed, sticks, slowest, inf)
    period = 2 * pi * sqrt(train.mass / train.stiffness)
    times = [period * i / _PER_PERIOD for i in range(_PER_PERIOD * _PERIODS + 1)]
    unsafe = [t for t in times if _sticks(train, drag, from_speed, to_speed, t, temperature)[0]]
    if not unsafe:
        return SafeStep(from_speed, to_speed, sticks, slowest, 0.0)
    if unsafe[-1] == times[-1]:
        return SafeStep(from_speed, to_speed, sticks, slowest, inf)
    low, high = unsafe[-1], unsafe[-1] + period / _PER_PERIOD
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if _sticks(train, drag, from_speed, to_speed, middle, temperature)[0]:
            low = middle
        else:
            high = middle
    return SafeStep(from_speed, to_speed, sticks, slowest, high)


@takes_si(drive_speed="belt speed", temperature="temperature")
def disturbance(
    train: Train, drag: BeltDrag, *, drive_speed: float, temperature: float | None = None
) -> Disturbance:
    """Return the largest kick and step that sliding at ``drive_speed`` survives.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name.

    Examples
    --------
    >>> from hersey import Drag
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> small = disturbance(Drivetrain(1000, 1), drag, drive_speed=1.2)
    >>> 1.2 < 1.2 + small.step < 2.5  # from 2.5 down to 1.2 at once is too much
    True
    """
    train, drag, temperature = belt_of(train, drag, temperature, drive_speed=drive_speed)
    if not 0 < drive_speed < inf:
        raise ParameterError(f"drive_speed is {drive_speed}: it must be greater than 0")
    band = hysteresis(train, drag, temperature=temperature, sensitivity=False)
    return disturbance_within(band, train, drag, drive_speed=drive_speed, temperature=temperature)


def disturbance_within(
    band: HysteresisBand,
    train: Drivetrain,
    drag: AnyDrag,
    *,
    drive_speed: float,
    temperature: float | None = None,
) -> Disturbance:
    """Return the same as `disturbance` where the band of the belt is known."""
    if drive_speed < band.transition:
        return Disturbance(drive_speed, 0.0, 0.0)
    if drive_speed > band.upper and not band.stalls:
        return Disturbance(drive_speed, inf, inf)
    law = drag.law_at(temperature)
    _, stretch = steady_start(train, drag, drive_speed, temperature)

    def kicked(loss: float) -> bool:
        start = (drive_speed - loss, stretch)
        cycle = stick_slip(train, drag, drive_speed=drive_speed, start=start, temperature=temperature)
        return _is_rough(cycle, law.stick_speed)

    def stepped(fall: float) -> bool:
        return _sticks(train, drag, drive_speed + fall, drive_speed, 0.0, temperature)[0]

    kick = _threshold(kicked, drive_speed) if kicked(drive_speed) else inf
    farthest = 4.0 * (max(band.upper, drive_speed) if band.upper < inf else 10 * law.transition_speed)
    step = _threshold(stepped, farthest) if stepped(farthest) else inf
    return Disturbance(drive_speed, kick, step)


def _threshold(too_large: Callable[[float], bool], largest: float) -> float:
    """The greatest size that is not too large, below one that is."""
    low, high = 0.0, largest
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if too_large(middle):
            high = middle
        else:
            low = middle
    return low


def _sticks(
    train: Drivetrain,
    drag: AnyDrag,
    from_speed: float,
    to_speed: float,
    ramp_time: float,
    temperature: float | None,
) -> tuple[bool, float]:
    """Whether the belt sticks in a ramp or after it, and its least speed."""
    watched = ramp_time + _WATCHED * 2 * pi * sqrt(train.mass / train.stiffness)
    run = simulate(
        train,
        drag,
        drive_speed=Schedule([0.0, ramp_time], [from_speed, to_speed]),
        temperature=temperature,
        duration=watched,
        samples=401,
        start=steady_start(train, drag, from_speed, temperature),
    )
    slowest = float(run.belt_speed.min())
    if any(event.to_mode in ("stuck", "microslip") for event in run.events):
        return True, min(slowest, *(event.belt_speed for event in run.events))
    end = (float(run.belt_speed[-1]), float(run.stretch[-1]))
    cycle = stick_slip(train, drag, drive_speed=to_speed, start=end, temperature=temperature)
    return _is_rough(cycle, drag.law_at(temperature).stick_speed), slowest


def _is_rough(cycle: StickSlipCycle, stick_speed: float) -> bool:
    """Whether the belt goes on to slow down to the stick speed: held, be it for good, or swinging back."""
    return cycle.kind != "steady_sliding" and cycle.speed_min <= stick_speed * (1 + 1e-9)
