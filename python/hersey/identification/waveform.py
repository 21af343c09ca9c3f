"""The mean cycle: of a trace, each lap laid on its slip, and of the model, exact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError, UnfinishedError
from hersey.identification.cycle_record import CycleRecord
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.motion.simulation import simulate, stick_slip

#: Fewest laps of which a mean and its error are taken.
FEWEST_LAPS = 6
#: Points over a slip (two falls long), and over the rest of the lap.
_POINTS = 48, 32
#: Samples of one lap of the model.
_SAMPLES = 1200
#: The next slip begins this many falls before its middle.
_ONSET = 0.8


@dataclass(frozen=True)
class Waveform:
    """Force over a lap against the time from the middle of its fall.

    ``offset`` (s) and ``force`` have the shape (points,), ``laps`` (laps, points) with NaN where a lap was
    over; ``error`` is the standard error of ``force``. ``period`` has one value per lap, NaN before a gap.
    """

    offset: FloatArray
    force: FloatArray
    error: FloatArray
    laps: FloatArray
    period: FloatArray

    @property
    def number(self) -> int:
        """Number of laps."""
        return int(self.laps.shape[0])


def mean_waveform(record: CycleRecord) -> Waveform:
    """Return the mean lap of a trace; a linear drift of the level is subtracted.

    Raises
    ------
    InsufficientDataError
        If there are too few laps.
    """
    samples, middle = record.samples, record.slip_time
    following = np.full(middle.size, np.nan)
    following[:-1] = np.diff(middle)
    lap = float(np.median(record.period)) if record.period.size else 0.0
    following[following > 1.5 * lap] = np.nan
    fall = float(np.median(record.fall_duration)) if record.slips else 0.0
    ahead = min(fall, 0.45 * lap)
    offset = _offsets(ahead, fall, lap)
    end = samples.start + samples.interval * (samples.value.size - 1)
    inside = (middle - ahead > samples.start) & (middle + lap < end) & np.isfinite(following)
    if int(np.sum(inside)) < FEWEST_LAPS:
        raise InsufficientDataError(
            f"the record has {int(np.sum(inside))} whole cycles; at least {FEWEST_LAPS} are needed to "
            "fit a drive"
        )
    middle, following = middle[inside], following[inside]
    at = middle[:, None] + offset
    laps = np.interp(at, samples.time, samples.value) - (record.drift * (middle - np.mean(middle)))[:, None]
    laps[offset > (following - _ONSET * min(fall, ahead))[:, None]] = np.nan
    hidden = np.interp(at, samples.time, samples.bridged.astype(float)) > 0
    laps[hidden] = np.nan
    seen = np.sum(np.isfinite(laps), axis=0)
    kept = seen >= max(FEWEST_LAPS, middle.size // 2)
    laps = laps[:, kept]
    error = np.nanstd(laps, axis=0, ddof=1) / np.sqrt(seen[kept])
    floor = 0.3 * float(np.median(error))
    return Waveform(offset[kept], np.nanmean(laps, axis=0), np.maximum(error, floor), laps, following)


def _offsets(ahead: float, fall: float, lap: float) -> FloatArray:
    slip_end = min(1.2 * fall, lap - ahead)
    slip = np.linspace(-ahead, slip_end, _POINTS[0], endpoint=False)
    rest = np.linspace(slip_end, lap - ahead, _POINTS[1], endpoint=False)
    return np.concatenate([slip, rest]) if lap - ahead > slip_end else slip


@dataclass(frozen=True)
class ModelLap:
    """One exact lap of the model, from the greatest force on; ``middle`` (s) is half down its fall."""

    force: CubicHermiteSpline
    period: float
    middle: float

    def at(self, offset: FloatArray) -> FloatArray:
        """Force at times from the middle of the fall."""
        return np.asarray(self.force((self.middle + offset) % self.period))


def model_lap(train: Drivetrain, drag: AnyDrag, drive_speed: float) -> ModelLap | None:
    """Return the lap that the model settles to from rest; none if it settles to steady sliding.

    At the greatest stretch the belt moves exactly with the drive: that point of the cycle is known, and one
    lap from it is the whole cycle.
    """
    try:
        cycle = stick_slip(train, drag, drive_speed=drive_speed)
        if cycle.kind not in ("stick_slip", "oscillation") or not cycle.frequency > 0:
            return None
        run = simulate(
            train,
            drag,
            drive_speed=drive_speed,
            duration=1.0 / cycle.frequency,
            samples=_SAMPLES,
            start=(drive_speed, cycle.stretch_max),
        )
    except (ParameterError, UnfinishedError):
        return None
    # The slope of the force is known too, so that the curve is smooth in the parameters.
    force = CubicHermiteSpline(run.time, run.spring_force, train.stiffness * (drive_speed - run.belt_speed))
    level = 0.5 * train.stiffness * (cycle.stretch_max + cycle.stretch_min)
    bottom = int(np.argmin(run.spring_force))
    if bottom < 2:
        return None
    middle = float(np.interp(-level, -run.spring_force[: bottom + 1], run.time[: bottom + 1]))
    for _ in range(3):
        middle -= float((force(middle) - level) / force(middle, 1))
    return ModelLap(force, 1.0 / cycle.frequency, middle)
