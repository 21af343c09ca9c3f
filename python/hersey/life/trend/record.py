"""The rows of a log at one speed: age, friction, temperature.

Age counts while the drive turns: time, revolutions or distance. A stop adds nothing to it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.dwells.one_speed import SAME, only_speed, speeds_held
from hersey.errors import InsufficientDataError, ParameterError, Setting
from hersey.log.stating import MAY_PLAY
from hersey.log.torque_log import Run, TorqueLog
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.warning import Warning

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
    speed: float  #: mean without sign, in the unit of the domain
    domain: Domain = TORQUE  #: what friction and speed are
    restarts: FloatArray = field(default_factory=lambda: np.empty(0))  #: ages at which motion went on
    turns: FloatArray = field(default_factory=lambda: np.empty(0))  #: ages at which the direction changed
    other_speed: int = 0  #: rows left out: in motion at another speed
    apart: int = 0  #: rows left out at an end without friction
    not_used: tuple[Warning, ...] = ()  #: columns that may be a load that changes


def record_of(log: TorqueLog, by: str, at: float | None, radius: float | None) -> Record:
    """Return the rows of a log at its one speed, or at one that is chosen, SI.

    Raises
    ------
    ParameterError
        If a distance, or revolutions of what slides, are asked for without a radius.
    InsufficientDataError
        If the log has several speeds and none is chosen, or too few rows at one.
    """
    time, shift, of = [], 0.0, log.domain
    for run in log.runs:
        time.append(run.time - run.time[0] + shift)
        shift = float(time[-1][-1]) + run.sampling_interval
    times = np.concatenate(time)
    speed = np.concatenate([run.speed for run in log.runs])
    moving = np.abs(speed) > of.standing
    chosen = moving & _at_speed(np.abs(speed), moving, at, of)
    apart = _apart(values := np.concatenate([_friction(run) for run in log.runs]), chosen)
    chosen &= ~apart
    kept = np.flatnonzero(chosen)
    if kept.size < _FEWEST:
        raise InsufficientDataError(
            f"only {kept.size} rows are at one speed: a trend needs at least {_FEWEST}. Record more"
        )
    if float(np.ptp(values[kept])) == 0.0:
        raise InsufficientDataError(
            f"{of.quantity} always reads {of.amount(float(values[kept[0]]), '.4g')}. Check the sensor, or "
            f"name another column with {Setting('torque', 'channel').to()}"
        )
    age = _ages(times, np.abs(speed), moving, by, radius, of)
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
        domain=of,
        restarts=restarts - age[kept[0]],
        turns=age[kept[1:][speed[kept[1:]] * speed[kept[:-1]] < 0.0]] - age[kept[0]],
        other_speed=int(np.sum(moving) - kept.size - np.sum(apart)),
        apart=int(np.sum(apart)),
        not_used=tuple(
            w for f in log.files for w in f.warnings if (w.kind, w.severity) == (MAY_PLAY, "watch")
        ),
    )


def _friction(run: Run) -> FloatArray:
    """Friction against the motion: of a drive whose torque is recorded with the other sign, too."""
    against = run.torque * np.sign(run.speed)
    turning = against[np.abs(run.speed) > run.domain.standing]
    return -against if turning.size and np.median(turning) < 0.0 else against


def _at_speed(speed: FloatArray, moving: BoolArray, at: float | None, of: Domain) -> BoolArray:
    """Rows near the one speed."""
    if not moving.any():
        raise InsufficientDataError("the drive stands still throughout: friction needs motion")
    if at is not None:
        return np.abs(speed - abs(at)) <= SAME * abs(at)
    if (only := only_speed(speed, of.standing)) is not None:
        return np.abs(speed - only) <= SAME * only
    held = sorted(each for each in speeds_held(speed, of.standing) if each[1] >= _NAMED)
    if not held:
        raise InsufficientDataError(
            "the speed varies throughout, but a trend is followed at one speed. To follow the rows near "
            f"one, choose it, e.g. {_choice(float(np.median(speed[moving])), of)}"
        )
    named = ", ".join(f"{of.at(each)} ({100 * share:.0f} % of the rows)" for each, share in held)
    most = max(held, key=lambda each: each[1])[0]
    raise InsufficientDataError(
        f"the log has several speeds, but a trend is followed at one: {named}. Choose one, e.g. "
        f"{_choice(most, of)}"
    )


def _choice(speed: float, of: Domain) -> str:
    return AT.to(of.at(speed))


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
    time: FloatArray, speed: FloatArray, moving: BoolArray, by: str, radius: float | None, of: Domain
) -> FloatArray:
    """Age at each row, counted while the drive moves."""
    passed = np.diff(time, prepend=time[0]) * moving
    if by == "time":
        return np.cumsum(passed)
    gone = np.cumsum(passed * speed)
    own = "distance" if of.speed_unit == "m/s" else "revolutions"
    if by == own:
        return gone if own == "distance" else gone / (2.0 * np.pi)
    if radius is None:
        example, what = (
            RADIUS.to("22 mm", python="'22 mm'"),
            "a distance" if by == "distance" else "revolutions",
        )
        verb = "needs" if by == "distance" else "need"
        raise ParameterError(f"{what} {verb} the radius of the track: add {example}, or count {BY.to(own)}")
    return gone * radius if by == "distance" else gone / (2.0 * np.pi * radius)
