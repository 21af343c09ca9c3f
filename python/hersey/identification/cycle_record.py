"""Cycles of a trace: how many slips, how long and how deep, and whether the belt sticks at all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.damping.estimate import quantile
from hersey.errors import ParameterError
from hersey.identification.detection import (
    FEWEST_OF_RHYTHM,
    FEWEST_SLIPS,
    beyond_noise,
    of_at_least,
    of_one_rhythm,
)
from hersey.identification.motion_kind import Motion, is_regular, motion_of
from hersey.identification.sampling import Samples, even_samples
from hersey.identification.slip_figures import slip_figures
from hersey.identification.turning_points import least_turn
from hersey.result import OPEN, Means, Record, Result, json_record
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: What a trace may hold.
QUANTITIES = ("force", "speed")
#: Half width of the 95 % interval of a drive speed of which nothing is stated, as a share of it.
DRIVE_SPEED_UNCERTAINTY = 1e-3
#: A channel of the drive speed is known to what the means of so many parts of it differ.
_PARTS = 10
#: A greater one would tell no drive.
_GREATEST_UNCERTAINTY = 0.5
#: Samples that a fall must last for its duration to be trusted.
_FEW_SAMPLES = 6


@dataclass(frozen=True)
class Scatter(Record):
    """A figure that each cycle has: median, mean, standard deviation, and standard error of the mean."""

    median: Annotated[float, OPEN]
    mean: Annotated[float, OPEN]
    deviation: Annotated[float, OPEN]
    error: Annotated[float, Means("of the mean", open=True)]

    @classmethod
    def of(cls, values: FloatArray) -> Scatter:
        """Return the figures of ``values``; without any, not a number."""
        if values.size == 0:
            return cls(*[float("nan")] * 4)
        deviation = float(np.std(values, ddof=1)) if values.size > 1 else float("nan")
        return cls(
            float(np.median(values)),
            float(np.mean(values)),
            deviation,
            deviation / float(np.sqrt(values.size)),
        )


@dataclass(frozen=True, repr=False)
class CycleRecord(Result):
    """Cycles of a trace at one drive speed.

    ``kind`` is ``steady_sliding`` (no cycles), ``inertial`` (an oscillation near the free period in which the
    belt sticks for less than 15 % of the time) or ``stick_slip``; like all of ``motion`` it follows from all
    falls beyond the noise, whatever slips are counted. Arrays have one value per slip counted, ``period`` one
    per pair of slips with no gap between, ``rise_slope`` (of the steepest part of a rise) up to 4000 of them.
    ``fall_duration`` is the time from maximum to minimum, ``steep_duration`` that of half a cosine as steep.
    Force is in the unit of the trace, time in s; for a trace of speed the "force" is the stretch of the
    spring, m, from an unknown zero.
    """

    motion: Motion
    quantity: str
    samples: Samples
    drive_speed: float | None
    drive_speed_uncertainty: float
    least_drop: float
    slip_time: FloatArray
    force_max: FloatArray
    force_min: FloatArray
    fall_duration: FloatArray
    steep_duration: FloatArray
    period: FloatArray
    rise_slope: FloatArray
    drift: float
    notes: tuple[str, ...]

    @property
    def slips(self) -> int:
        """Number of slips."""
        return int(self.slip_time.size)

    @property
    def drop(self) -> FloatArray:
        """Fall of the force in each slip."""
        return self.force_max - self.force_min

    @property
    def kind(self) -> str:
        """``steady_sliding``, ``inertial`` or ``stick_slip``."""
        return self.motion.kind

    @property
    def falls(self) -> int:
        """Number of falls beyond the noise, counted as slips or not."""
        return self.motion.falls

    @property
    def loading_slope(self) -> float:
        """Slope of the force while the belt is held, per s: the steepest part of the rises.

        Creep before a slip and the rounded ends only lower a slope. Where the oscillation is inertial no
        part is straight, and the greatest slope of the ellipse is given.
        """
        return self.motion.loading_slope

    @property
    def free_period(self) -> float:
        """Period of the free oscillation, 2 pi sqrt(m/k), s: twice the typical fall, from its steep part.

        Good to 5 % where drag varies little in a slip; creep and drag that grows with speed cost up to 25 %.
        Not a number, and a note says why, where it would be longer than a lap or shorter than the samples
        resolve.
        """
        return self.motion.free_period

    @property
    def stuck_fraction(self) -> float:
        """Share of the typical lap during which the belt sticks."""
        return self.motion.stuck_fraction

    @property
    def stiffness(self) -> float | None:
        """Loading slope over drive speed, unit of the trace per m; none without a drive speed."""
        if self.drive_speed is None or self.kind == "steady_sliding" or self.quantity != "force":
            return None
        return self.loading_slope / self.drive_speed

    def slips_of_at_least(self, drop: float) -> int:
        """Return the number of slips whose fall is at least ``drop``; smaller ones part their neighbours."""
        return int(np.sum(self.drop >= drop))

    def to_dict(self) -> dict[str, Any]:
        """Return the figures, time in s and force in the unit of the trace."""
        per_cycle = {
            "period": self.period,
            "drop": self.drop,
            "force_max": self.force_max,
            "force_min": self.force_min,
            "fall_duration": self.fall_duration,
        }
        figures: dict[str, Any] = {
            "kind": self.kind,
            "quantity": self.quantity,
            "slips": self.slips,
            "falls": self.falls,
            "drive_speed": self.drive_speed,
            "drive_speed_uncertainty": self.drive_speed_uncertainty,
            "loading_slope": self.loading_slope,
            "stiffness": self.stiffness,
            "free_period": self.free_period,
            "stuck_fraction": self.stuck_fraction,
            "least_drop": self.least_drop,
            "noise": self.samples.noise,
            "drift": self.drift,
            "spikes": self.samples.spikes,
            "missing": self.samples.missing,
            "slip_time": self.slip_time,
            "notes": list(self.notes),
        }
        typical = {name: Scatter.of(values) for name, values in per_cycle.items()}
        return json_record(figures | typical)

    def to_frame(self) -> pl.DataFrame:
        """Return one row per slip; force in the unit of the trace."""
        import polars as pl

        return pl.DataFrame(
            {
                "time (s)": self.slip_time,
                "force max (unit of the trace)": self.force_max,
                "force min (unit of the trace)": self.force_min,
                "fall duration (s)": self.fall_duration,
                "steep duration (s)": self.steep_duration,
            }
        )

    def headline(self, unit: str = "") -> str:
        """Return the kind and the number of slips, or of the falls that are none."""
        words = self.kind.replace("_", " ")
        beyond = f"{self.falls} falls beyond the noise"
        if self.kind == "steady_sliding":
            return (
                f"{words}: no cycles" if self.falls < FEWEST_SLIPS else f"wandering: {beyond}, but no cycles"
            )
        if self.slips >= FEWEST_SLIPS:
            return f"{words}: {self.slips} slips"
        number = self.slips or "none"
        least, greatest = (_amount(amount, unit) for amount in (self.least_drop, self.motion.greatest))
        return f"{words}: {beyond}, {number} of {least} or more: the greatest is {greatest}"

    def summary(self, unit: str = "") -> str:
        """Return the figures in words, a line each; ``unit`` is that of the trace, for the words."""
        of = f" {unit}" if unit not in ("", "1") else ""
        heading = self.headline(unit)
        if self.kind == "steady_sliding" or self.slips < FEWEST_SLIPS:
            return "\n".join([heading, *(f"- {note}" for note in self.notes)])
        period, drop = Scatter.of(self.period), Scatter.of(self.drop)
        free = f"; free period {self.free_period:.4g} s" if np.isfinite(self.free_period) else ""
        turning = "rad" if unit == "N m" else "m"
        stiff = (
            f"stiffness     {self.stiffness:.5g}{of or ' 1'}/{turning} (slope / speed)"
            if self.stiffness
            else ""
        )
        lines = [
            heading,
            f"period        {period.median:.4g} s (scatter {period.deviation:.2g} s){free}",
            f"drop          {drop.median:.4g}{of} (scatter {drop.deviation:.2g}{of})",
            f"force         {np.median(self.force_min):.4g} to {np.median(self.force_max):.4g}{of}",
            f"loading slope {self.loading_slope:.5g}{of or ' 1'}/s",
            f"stuck         {self.stuck_fraction:.0%} of the time",
            *([stiff] if stiff else []),
            *(f"- {note}" for note in self.notes),
        ]
        return "\n".join(lines)


@takes_si(time="time", drive_speed=("belt speed", "speed"))
def cycles(
    time: ArrayLike,
    value: ArrayLike,
    *,
    drive_speed: ArrayLike | None = None,
    drive_speed_uncertainty: float | None = None,
    quantity: str = "force",
    least_drop: float | None = None,
) -> CycleRecord:
    """Find the slips of a trace and say what kind of motion it is.

    A slip is a fall of the force between two rises, each greater than noise alone could make in the whole
    trace.

    Parameters
    ----------
    time
        s, shape (samples,); even or not, with gaps or not.
    value
        Force of the spring, or torque, in any unit; NaN where missing. With ``quantity="speed"`` the belt
        speed.
    drive_speed
        Constant speed of the drive, m/s; gives the stiffness. A channel of it, of shape (samples,), counts by
        its mean. A trace of speed without it takes its own mean.
    drive_speed_uncertainty
        How far that may be off, as a share of it: half the width of its 95 % interval. `identify` carries it
        into every interval. If it is not stated, 0.001, and for a channel what its mean is not known to.
    least_drop
        Count only falls and rises of at least this. Slips of real surfaces have all sizes, so a count means
        little without it; by default it is what noise could make.

    What kind of motion it is does not depend on that: it follows from all falls beyond the noise. Where those
    are the jitter of a slower noise on greater falls that have a rhythm, from these.

    Raises
    ------
    ParameterError, InsufficientDataError
        If the trace cannot be read as one.

    Examples
    --------
    >>> from hersey import Drag, Drivetrain, simulate
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> run = simulate(Drivetrain(1000, 1), drag, drive_speed=1.0, duration=10, samples=20001)
    >>> record = cycles(run.time, run.spring_force, drive_speed=1.0)
    >>> record.kind, record.slips, round(float(np.median(record.period)), 3)
    ('stick_slip', 37, 0.254)
    """
    if quantity not in QUANTITIES:
        raise ParameterError(f"quantity '{quantity}' is not known: {', '.join(QUANTITIES)}")
    speed, uncertainty = _driven(drive_speed, drive_speed_uncertainty, np.shape(time))
    for name, given in (("drive_speed", speed), ("least_drop", least_drop)):
        if given is not None and not (np.isfinite(given) and given > 0):
            raise ParameterError(f"{name} is {given}: it must be greater than 0")
    if not 0 < uncertainty <= _GREATEST_UNCERTAINTY:
        raise ParameterError(
            f"drive_speed_uncertainty is {uncertainty:.4g}: it must be greater than 0, and at most "
            f"{_GREATEST_UNCERTAINTY} of the drive speed"
        )
    samples = even_samples(time, value, name=quantity)
    if quantity == "speed":
        samples = _stretch(samples, speed)
    return _record(samples, quantity, speed, uncertainty, least_drop)


def _driven(
    given: ArrayLike | None, stated: float | None, shape: tuple[int, ...]
) -> tuple[float | None, float]:
    """The drive speed and its uncertainty; of a channel from the means of its parts."""
    speed = np.asarray(given, dtype=float) if given is not None else None
    if speed is None or speed.ndim == 0:
        stated = DRIVE_SPEED_UNCERTAINTY if stated is None else stated
        return None if speed is None else float(speed), stated
    if speed.shape != shape or speed.size < _PARTS:
        raise ParameterError(
            f"drive_speed has the shape {speed.shape} and time {shape}: give a number or equal lengths"
        )
    held = speed[np.isfinite(speed)]
    if held.size < _PARTS:
        raise ParameterError(f"drive_speed holds {held.size} numbers: give a number, or a channel of it")
    means = np.array([np.mean(part) for part in np.array_split(held, _PARTS)])
    mean = float(np.mean(means))
    if stated is None and mean:
        error = float(np.std(means, ddof=1)) / float(np.sqrt(_PARTS))
        stated = DRIVE_SPEED_UNCERTAINTY + quantile(_PARTS - 1) * error / abs(mean)
    return mean, DRIVE_SPEED_UNCERTAINTY if stated is None else stated


def _stretch(samples: Samples, drive_speed: float | None) -> Samples:
    """The stretch of the spring from the belt speed: what the drive gains on the belt."""
    speed = float(np.mean(samples.value)) if drive_speed is None else drive_speed
    gained = np.concatenate([[0.0], np.cumsum(speed - 0.5 * (samples.value[1:] + samples.value[:-1]))])
    noise = samples.noise * samples.interval
    return Samples(
        samples.start,
        samples.interval,
        gained * samples.interval,
        samples.bridged,
        noise,
        samples.spikes,
        samples.missing,
    )


def _record(
    samples: Samples,
    quantity: str,
    drive_speed: float | None,
    uncertainty: float,
    least_drop: float | None,
) -> CycleRecord:
    found = beyond_noise(samples)
    figures = slip_figures(samples, found)
    motion = motion_of(samples, figures, found.least)
    notes = list(motion.notes)
    if motion.kind == "steady_sliding" and (greater := of_one_rhythm(samples, found, is_regular)):
        slower = slip_figures(samples, greater)
        if slower.period.size >= FEWEST_OF_RHYTHM - 1 and is_regular(slower.period):
            jitter = _jitter(motion.falls, greater.least)
            found, figures = greater, slower
            motion = motion_of(samples, figures, found.least)
            notes = [*motion.notes, jitter]
    if least_drop is not None and least_drop > found.least:
        found = of_at_least(samples, found, least_drop)
        figures = slip_figures(samples, found)
    middle, drop = figures.middle, figures.drop
    level = 0.5 * (figures.high + figures.low)
    drift = _slope(middle, level) if middle.size >= FEWEST_SLIPS else 0.0
    lasts = figures.steep / samples.interval
    notes += _notes(samples, found.least, least_drop, lasts, figures.period, drift, drop)
    return CycleRecord(
        motion,
        quantity,
        samples,
        drive_speed,
        uncertainty,
        found.least,
        samples.start + middle,
        figures.high,
        figures.low,
        figures.duration,
        figures.steep,
        figures.period,
        figures.slope,
        drift,
        tuple(notes),
    )


def _jitter(falls: int, least: float) -> str:
    return (
        f"{falls} falls are beyond the noise from sample to sample, without a rhythm; those of {least:.3g} "
        f"or more have one: the rest is taken for a slower noise"
    )


def _amount(amount: float, unit: str) -> str:
    """An amount of force; of a share of the weight, in per cent."""
    if unit == "1":
        return f"{100 * amount:.3g} % of the load"
    return f"{amount:.3g} {unit}".strip()


def _slope(x: FloatArray, y: FloatArray) -> float:
    lever = x - np.mean(x)
    return float(lever @ y / (lever @ lever))


def _notes(
    samples: Samples,
    least: float,
    least_drop: float | None,
    lasts: FloatArray,
    period: FloatArray,
    drift: float,
    drop: FloatArray,
) -> list[str]:
    notes: list[str] = []
    if drop.size < FEWEST_SLIPS:
        return notes
    if float(np.median(lasts)) < _FEW_SAMPLES:
        notes.append(f"a fall lasts {np.median(lasts):.1f} samples: sample faster to see the slip")
    floor = least_turn(samples.noise, samples.value.size, 1)
    if least_drop is not None and least > least_drop:
        notes.append(f"least_drop {least_drop:g} is within the noise: {least:.3g} was taken")
    small = int(np.sum(drop < 0.5 * np.median(drop)))
    if least_drop is None and small > 0.05 * drop.size:
        notes.append(
            f"{small} of {drop.size} slips fall by less than half the median: their number depends "
            f"on the least fall counted, {least:.3g} here (samples scatter by {floor:.3g}); give least_drop"
        )
    if samples.missing:
        notes.append(
            f"{samples.missing} samples are missing; no cycle across a gap that hides part of it is used"
        )
    if samples.spikes:
        notes.append(f"{samples.spikes} spikes of one or two samples were removed")
    rise = float(np.median(period) if period.size else 0.0) - float(np.median(lasts)) * samples.interval
    if period.size and rise < 0.5 * float(np.median(lasts)) * samples.interval:
        notes.append("the force rises faster than it falls: is its sign turned?")
    swing = abs(drift) * samples.interval * samples.value.size
    if swing > 0.5 * float(np.median(drop)):
        notes.append(f"the level drifts by {swing:.3g} over the trace")
    return notes
