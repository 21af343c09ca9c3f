"""Cycles of a trace: how many slips, how long and how deep, and whether the belt sticks at all."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.identification.cycle_warnings import warnings_of
from hersey.identification.detection import (
    FEWEST_OF_RHYTHM,
    FEWEST_SLIPS,
    Found,
    beyond_noise,
    of_at_least,
    of_one_rhythm,
)
from hersey.identification.drive_speed import driven
from hersey.identification.motion_kind import Motion, is_regular, motion_of
from hersey.identification.sampling import Samples, even_samples
from hersey.identification.slip_figures import SlipFigures, slip_figures
from hersey.result import Means, Record, Result, json_record
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: What a trace may hold.
QUANTITIES = ("force", "speed")
#: What drops in a slip, by what the trace holds: of a speed it is the stretch of the spring.
_CALLED = {"force": "force", "speed": "stretch"}
#: Figures of a record as JSON has them, some of its samples, and those of which each cycle has one.
_FIGURES = (
    *("kind", "quantity", "slips", "falls", "drive_speed", "drive_speed_uncertainty", "loading_slope"),
    *("stiffness", "free_period", "stuck_fraction", "least_drop", "noise", "drift", "spikes", "missing"),
    "slip_time",
)
_OF_SAMPLES = ("noise", "spikes", "missing")
_PER_CYCLE = ("period", "drop", "force_max", "force_min", "fall_duration")


@dataclass(frozen=True)
class Scatter(Record):
    """A figure that each cycle has: median, mean, standard deviation, and standard error of the mean."""

    median: Annotated[float, Means("over the cycles; null without any", open=True)]
    mean: Annotated[float, Means("over the cycles; null without any", open=True)]
    deviation: Annotated[float, Means("standard deviation of the cycles; null for one", open=True)]
    error: Annotated[float, Means("of the mean", open=True)]

    @classmethod
    def of(cls, values: FloatArray) -> Scatter:
        """Return the figures of ``values``; without any, not a number."""
        if values.size == 0:
            return cls(*[float("nan")] * 4)
        deviation = float(np.std(values, ddof=1)) if values.size > 1 else float("nan")
        error = deviation / float(np.sqrt(values.size))
        return cls(float(np.median(values)), float(np.mean(values)), deviation, error)


@dataclass(frozen=True, repr=False)
class CycleRecord(Result):
    """Cycles of a trace at one drive speed.

    ``kind`` is ``steady_sliding`` (no cycles), ``inertial`` (an oscillation near the free period in which the
    belt sticks for less than 15 % of the time) or ``stick_slip``. Like all of ``motion`` it follows from all
    drops that exceed the noise, whichever slips are counted. Arrays have one value per counted slip;
    ``period`` has one per pair of slips without a gap between them, ``rise_slope`` (of the steepest part of a
    rise) at most 4000. ``fall_duration`` is the time from maximum to minimum, ``steep_duration`` that of a
    half cosine of the same steepness. Force is in the unit of the trace, time in s; for a trace of speed the
    "force" is the stretch of the spring, m, from an unknown zero.
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
    warnings: tuple[Warning, ...]

    @property
    def slips(self) -> int:
        """Number of slips."""
        return int(self.slip_time.size)

    @property
    def drop(self) -> FloatArray:
        """Drop of the force in each slip."""
        return self.force_max - self.force_min

    @property
    def kind(self) -> str:
        """``steady_sliding``, ``inertial`` or ``stick_slip``."""
        return self.motion.kind

    @property
    def falls(self) -> int:
        """Number of drops that exceed the noise, counted as slips or not."""
        return self.motion.falls

    @property
    def loading_slope(self) -> float:
        """Slope of the force while the belt is held, per s, from the steepest part of the rises.

        Creep before a slip and rounded ends only lower the slope. In an inertial oscillation no part is
        straight, so the greatest slope of the ellipse is returned.
        """
        return self.motion.loading_slope

    @property
    def free_period(self) -> float:
        """Period of the free oscillation, 2 pi sqrt(m/k), s: twice the typical drop, from its steep part.

        Accurate to 5 % if drag varies little during a slip; creep, and drag that grows with speed, cause
        errors up to 25 %. NaN, with a warning, if it would be longer than a cycle or too short for the
        samples.
        """
        return self.motion.free_period

    @property
    def stuck_fraction(self) -> float:
        """Share of the typical cycle during which the belt sticks."""
        return self.motion.stuck_fraction

    @property
    def stiffness(self) -> float | None:
        """Loading slope divided by drive speed, unit of the trace per m; None without a drive speed."""
        if self.drive_speed is None or self.kind == "steady_sliding" or self.quantity != "force":
            return None
        return self.loading_slope / self.drive_speed

    def slips_of_at_least(self, drop: float) -> int:
        """Return the number of slips that drop by at least ``drop``; smaller ones separate others."""
        return int(np.sum(self.drop >= drop))

    def to_dict(self) -> dict[str, Any]:
        """Return the figures, time in s and force in the unit of the trace."""
        figures = {name: getattr(self.samples if name in _OF_SAMPLES else self, name) for name in _FIGURES}
        typical = {name: Scatter.of(getattr(self, name)) for name in _PER_CYCLE}
        return json_record({**figures, "warnings": self.warnings, **typical})

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

    def headline(self, unit: str = "", *, called: str = "") -> str:
        """Return the kind of motion and the number of slips or drops; ``called`` as in `summary`."""
        words = self.kind.replace("_", " ")
        beyond = f"{self.falls} drops exceed the noise"
        if self.kind == "steady_sliding":
            return (
                f"{words}: no cycles"
                if self.falls < FEWEST_SLIPS
                else f"irregular {called or _CALLED[self.quantity]}: {beyond}, but no cycles"
            )
        if self.slips >= FEWEST_SLIPS:
            return f"{words}: {self.slips} slips"
        number = self.slips or "none"
        least, greatest = (_amount(amount, unit) for amount in (self.least_drop, self.motion.greatest))
        return f"{words}: {beyond}, {number} of at least {least}; the largest is {greatest}"

    def summary(self, unit: str = "", *, called: str = "") -> str:
        """Return the results as text, one per line.

        ``unit`` is the unit of the trace and ``called`` the name of what drops in a slip, e.g. ``torque``.
        """
        called = called or _CALLED[self.quantity]
        of = f" {unit}" if unit not in ("", "1") else ""
        heading = self.headline(unit, called=called)
        if self.kind == "steady_sliding" or self.slips < FEWEST_SLIPS:
            return "\n".join([heading, *(f"- {each}" for each in self.warnings)])
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
            f"{called:<14}{np.median(self.force_min):.4g} to {np.median(self.force_max):.4g}{of}",
            f"loading slope {self.loading_slope:.5g}{of or ' 1'}/s",
            f"stuck         {self.stuck_fraction:.0%} of the time",
            *([stiff] if stiff else []),
            *(f"- {each}" for each in self.warnings),
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
    """Find the slips in a trace and classify its motion.

    A slip is a drop of the force between two rises, each larger than noise alone could cause in the whole
    trace.

    Parameters
    ----------
    time
        Times, s, shape (samples,); they may be uneven and have gaps.
    value
        Spring force or torque in any unit, shape (samples,), NaN where missing. With ``quantity="speed"``,
        belt speed.
    drive_speed
        Constant speed of the drive, m/s, from which the stiffness follows; or a channel of shape (samples,),
        whose mean is used. Default for a trace of speed: its own mean.
    drive_speed_uncertainty
        Relative uncertainty of the drive speed: half the width of its 95 % interval. `identify` includes it
        in every interval. Default: 0.001, and for a channel the uncertainty of its mean.
    least_drop
        Count only drops and rises of at least this size. Real surfaces slip by all sizes, so a count means
        little without it. Default: the size that noise could cause.

    The kind of motion does not depend on it: it follows from all drops that exceed the noise, or, if those
    are slower noise on larger rhythmic drops, from the latter.

    Raises
    ------
    ParameterError, InsufficientDataError
        If the data are not a valid trace.

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
        raise ParameterError(f"unknown quantity '{quantity}'. Use {', '.join(QUANTITIES)}")
    speed, uncertainty = driven(drive_speed, drive_speed_uncertainty, np.shape(time))
    if least_drop is not None and not (np.isfinite(least_drop) and least_drop > 0):
        raise ParameterError(f"least_drop is {least_drop}: it must be greater than 0")
    samples = even_samples(time, value, name=quantity)
    if quantity == "speed":
        samples = _stretch(samples, speed)
    return _record(samples, quantity, speed, uncertainty, least_drop)


def _amount(amount: float, unit: str) -> str:
    """An amount of force; of a share of the weight, in per cent."""
    if unit == "1":
        return f"{100 * amount:.3g} % of the load"
    return f"{amount:.3g} {unit}".strip()


def _stretch(samples: Samples, drive_speed: float | None) -> Samples:
    """The stretch of the spring from the belt speed: what the drive gains on the belt."""
    speed = float(np.mean(samples.value)) if drive_speed is None else drive_speed
    gained = np.concatenate([[0.0], np.cumsum(speed - 0.5 * (samples.value[1:] + samples.value[:-1]))])
    interval = samples.interval
    return replace(samples, value=gained * interval, noise=samples.noise * interval)


def _record(
    samples: Samples, quantity: str, drive_speed: float | None, uncertainty: float, least_drop: float | None
) -> CycleRecord:
    found, figures, motion, warnings = _motion(samples)
    if least_drop is not None and least_drop > found.least:
        found = of_at_least(samples, found, least_drop)
        figures = slip_figures(samples, found)
    middle = figures.middle
    drift = _slope(middle, 0.5 * (figures.high + figures.low)) if middle.size >= FEWEST_SLIPS else 0.0
    return CycleRecord(
        motion=motion,
        quantity=quantity,
        samples=samples,
        drive_speed=drive_speed,
        drive_speed_uncertainty=uncertainty,
        least_drop=found.least,
        slip_time=samples.start + middle,
        force_max=figures.high,
        force_min=figures.low,
        fall_duration=figures.duration,
        steep_duration=figures.steep,
        period=figures.period,
        rise_slope=figures.slope,
        drift=drift,
        warnings=(
            *warnings,
            *warnings_of(
                samples,
                figures,
                found.least,
                least_drop,
                drift,
                cyclic=motion.kind != "steady_sliding",
                zeroed=motion.kind == "stick_slip" and quantity == "force",
            ),
        ),
    )


def _motion(samples: Samples) -> tuple[Found, SlipFigures, Motion, tuple[Warning, ...]]:
    """The falls beyond the noise, or those with a rhythm where the others have none; figures and motion."""
    found = beyond_noise(samples)
    figures = slip_figures(samples, found)
    motion = motion_of(samples, figures, found.least)
    if motion.kind == "steady_sliding" and (greater := of_one_rhythm(samples, found, is_regular)):
        slower = slip_figures(samples, greater)
        if slower.period.size >= FEWEST_OF_RHYTHM - 1 and is_regular(slower.period):
            jitter = Warning(
                "slower noise",
                "{falls} drops exceed the sample-to-sample noise but have no rhythm; those of at least "
                "{least:.3g} do. The others are treated as slower noise",
                falls=motion.falls,
                least=greater.least,
            )
            motion = motion_of(samples, slower, greater.least)
            return greater, slower, motion, (*motion.warnings, jitter)
    return found, figures, motion, motion.warnings


def _slope(x: FloatArray, y: FloatArray) -> float:
    lever = x - np.mean(x)
    return float(lever @ y / (lever @ lever))
