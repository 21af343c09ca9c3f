"""The film's temperature where a heater and the plan itself make it, as a course to plan on."""

from __future__ import annotations

import numpy as np

from hersey.arrays import corners
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.motion.heat import HeatBalance
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import simulate

#: Rounds of plan and temperature at most.
ROUNDS = 8
#: What the film's temperature may change by in the last, K.
ALIKE = 0.05
#: Time over which the film is followed, s.
_LONGEST = 1800.0
#: Samples of it.
_SAMPLES = 18_001
#: Greatest error of a course of straight lines, K.
_ERROR = 0.01


def course_of(
    train: Drivetrain, drag: AnyDrag, heat: HeatBalance, drive_speed: float | Schedule = 0.0
) -> Schedule:
    """Return the film's temperature (K) against time under a drive, up to where it stays.

    From the start of the heat balance on, for half an hour at the most.
    """
    run = simulate(
        train, drag, drive_speed=drive_speed, temperature=heat, duration=_LONGEST, samples=_SAMPLES
    )
    assert run.film_temperature is not None
    last = float(run.film_temperature[-1])
    moving = np.flatnonzero(np.abs(run.film_temperature - last) > ALIKE)
    count = int(moving[-1]) + 2 if moving.size else 1
    time, film = run.time[:count], np.append(run.film_temperature[: count - 1], last)
    kept = corners(time, film, _ERROR)
    return Schedule(time[kept], film[kept])


def apart(one: Schedule, other: Schedule) -> float:
    """Return how far two courses are apart at the most, K."""
    times = np.union1d(np.asarray(one.times), np.asarray(other.times))
    return float(np.max(np.abs([one.at(t) - other.at(t) for t in times.tolist()])))
