"""The rows of a log at one speed: age, friction, temperature.

Age counts while the drive turns: time, revolutions or distance. A stop adds nothing to it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.dwells.one_speed import SAME, only_speed, speeds_held
from hersey.errors import InsufficientDataError, ParameterError, Setting
from hersey.log.torque_log import STANDING, Run, TorqueLog
from hersey.units import rpm

#: Share of the rows in motion from which a speed is named.
_NAMED = 0.05
#: Friction below this share of its median, at an end of the record, is that of faces apart.
_APART = 0.05
#: Fewest rows.
_FEWEST = 30
#: Ages, by what they are counted in.
AGES = {"time": "s", "distance": "m", "revolutions": "rev"}
AT = Setting("at")
BY = Setting("by")
RADIUS = Setting("radius")


@dataclass(frozen=True)
class Record:
    """Rows at one speed: arrays of shape (rows,), ascending."""

    age: FloatArray  #: in the unit of `AGES`
    time: FloatArray  #: s, runs one after another
    value: FloatArray
    temperature: FloatArray | None
    speed: float  #: mean without sign, rad/s
    quantity: str = "torque"
    unit: str = "N m"
    restarts: FloatArray = field(default_factory=lambda: np.empty(0))  #: ages at which motion went on
    other_speed: int = 0  #: rows left out: in motion at another speed
    apart: int = 0  #: rows left out at an end without friction


def record_of(log: TorqueLog, by: str, at: float | None, radius: float | None) -> Record:
    """Return the rows of a log at its one speed, or at one that is chosen, rad/s.

    Raises
    ------
    ParameterError
        If a distance is asked for without a radius.
    InsufficientDataError
        If the log has several speeds and none is chosen, or too few rows at one.
    """
    time, shift = [], 0.0
    for run in log.runs:
        time.append(run.time - run.time[0] + shift)
        shift = float(time[-1][-1]) + run.sampling_interval
    times = np.concatenate(time)
    speed = np.concatenate([run.speed for run in log.runs])
    moving = np.abs(speed) > STANDING
    chosen = moving & _at_speed(np.abs(speed), moving, at)
    apart = _apart(values := np.concatenate([_friction(run) for run in log.runs]), chosen)
    chosen &= ~apart
    kept = np.flatnonzero(chosen)
    if kept.size < _FEWEST:
        raise InsufficientDataError(
            f"only {kept.size} rows are at one speed: a trend needs at least {_FEWEST}. Record more"
        )
    if float(np.ptp(values[kept])) == 0.0:
        raise InsufficientDataError(
            f"torque always reads {values[kept[0]]:.4g} N m. Check the sensor, or name another column "
            f"with {Setting('torque', 'channel').to()}"
        )
    age = _ages(times, np.abs(speed), moving, by, radius)
    kelvin = None
    if log.has_temperature:
        kelvin = np.concatenate([r.temperature for r in log.runs if r.temperature is not None])[kept]
    pauses = np.flatnonzero(np.diff(moving.astype(int)) > 0) + 1
    begins = np.cumsum([run.time.size for run in log.runs])[:-1]
    restarts = age[np.union1d(pauses[pauses > kept[0]], begins).astype(int)]
    return Record(
        age=age[kept] - age[kept[0]],
        time=times[kept],
        value=values[kept],
        temperature=kelvin,
        speed=float(np.mean(np.abs(speed[kept]))),
        restarts=restarts - age[kept[0]],
        other_speed=int(np.sum(moving) - kept.size - np.sum(apart)),
        apart=int(np.sum(apart)),
    )


def _friction(run: Run) -> FloatArray:
    """Friction against the motion: of a drive whose torque is recorded with the other sign, too."""
    against = run.torque * np.sign(run.speed)
    turning = against[np.abs(run.speed) > STANDING]
    return -against if turning.size and np.median(turning) < 0.0 else against


def _at_speed(speed: FloatArray, moving: BoolArray, at: float | None) -> BoolArray:
    """Rows near the one speed."""
    if not moving.any():
        raise InsufficientDataError("the drive stands still throughout: friction needs motion")
    if at is not None:
        return np.abs(speed - abs(at)) <= SAME * abs(at)
    if (only := only_speed(speed)) is not None:
        return np.abs(speed - only) <= SAME * only
    held = sorted(each for each in speeds_held(speed) if each[1] >= _NAMED)
    if not held:
        raise InsufficientDataError(
            "the speed varies throughout, but a trend is followed at one speed. To follow the rows near "
            f"one, choose it, e.g. {_choice(float(np.median(speed[moving])))}"
        )
    named = ", ".join(f"{rpm(each):.3g} rpm ({100 * share:.0f} % of the rows)" for each, share in held)
    most = max(held, key=lambda each: each[1])[0]
    raise InsufficientDataError(
        f"the log has several speeds, but a trend is followed at one: {named}. Choose one, e.g. "
        f"{_choice(most)}"
    )


def _choice(speed: float) -> str:
    return AT.to(f"{rpm(speed):.3g} rpm")


def _apart(value: FloatArray, chosen: BoolArray) -> BoolArray:
    """Rows at either end of the record whose faces do not touch: they have hardly any friction."""
    rows = np.flatnonzero(chosen)
    out = np.zeros(value.size, dtype=bool)
    if rows.size:
        touching = np.abs(value[rows]) > _APART * abs(float(np.median(value[rows])))
        first, last = int(np.argmax(touching)), rows.size - int(np.argmax(touching[::-1]))
        out[rows[:first]] = out[rows[last:]] = True
    return out


def _ages(
    time: FloatArray, speed: FloatArray, moving: BoolArray, by: str, radius: float | None
) -> FloatArray:
    """Age at each row, counted while the drive turns."""
    passed = np.diff(time, prepend=time[0]) * moving
    if by == "time":
        return np.cumsum(passed)
    turned = np.cumsum(passed * speed)
    if by == "revolutions":
        return turned / (2.0 * np.pi)
    if radius is None:
        example = RADIUS.to("22 mm", python="'22 mm'")
        raise ParameterError(
            f"a distance needs the radius of the track: add {example}, or count {BY.to('revolutions')}"
        )
    return turned * radius
