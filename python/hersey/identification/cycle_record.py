"""Cycles of a trace: how many slips, how long and how deep, and whether the belt sticks at all."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.identification.detection import FEWEST_SLIPS, found_falls, steep_lasts
from hersey.identification.sampling import Samples, even_samples
from hersey.identification.slip_shape import SHARE, held_slope, slip_duration, stick_angle
from hersey.identification.turning_points import Falls, crossing, curved, least_turn, smoothed
from hersey.result import Result, json_record
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: What a trace may hold.
QUANTITIES = ("force", "speed")
#: Half width of the 95 % interval of a drive speed of which nothing is stated, as a share of it.
DRIVE_SPEED_UNCERTAINTY = 1e-3
#: A greater one would tell no drive.
_GREATEST_UNCERTAINTY = 0.5
#: A belt that sticks for a smaller share of the lap merely touches rest: the oscillation is inertial.
LEAST_STUCK = 0.15
#: An oscillation is more regular than this (deviation of the period over its mean); drift and wear are not.
_REGULAR = 0.25
#: Rises of which the slope is taken, at most, spread over the trace.
_RISES = 4000
#: Samples that a fall must last for its duration to be trusted.
_FEW_SAMPLES = 6


class Scatter(NamedTuple):
    """A figure that each cycle has: median, mean, standard deviation, and standard error of the mean."""

    median: float
    mean: float
    deviation: float
    error: float

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
    belt sticks for less than 15 % of the time) or ``stick_slip``. Arrays have one value per slip, ``period``
    one per pair of slips with no gap between, ``rise_slope`` (of the steepest part of a rise) up to 4000 of
    them.
    ``fall_duration`` is the time from maximum to minimum, ``steep_duration`` that of half a cosine as steep.
    Force is in the unit of the trace, time in s; for a trace of speed the "force" is the stretch of the
    spring, m, from an unknown zero.
    """

    kind: str
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
    def loading_slope(self) -> float:
        """Slope of the force while the belt is held, per s: the steepest part of the rises.

        Creep before a slip and the rounded ends only lower a slope. Where the oscillation is inertial no
        part is straight, and the greatest slope of the ellipse is given.
        """
        if self.kind == "inertial":
            return held_slope(float(np.median(self.drop)), float(np.median(self.fall_duration)), 0.0)
        return float(np.median(self.rise_slope)) if self.kind == "stick_slip" else float("nan")

    @property
    def free_period(self) -> float:
        """Period of the free oscillation, 2 pi sqrt(m/k), s: twice the typical fall, from its steep part.

        Good to 5 % where drag varies little in a slip; creep and drag that grows with speed cost up to 25 %.
        """
        return 2.0 * float(np.median(self.steep_duration)) if self.slips else float("nan")

    @property
    def stuck_fraction(self) -> float:
        """Share of the typical lap during which the belt sticks."""
        if self.kind == "steady_sliding":
            return 0.0
        return _stuck_fraction(self.drop, self.fall_duration, self.rise_slope, self.period)

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
        typical = {name: Scatter.of(values)._asdict() for name, values in per_cycle.items()}
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

    def summary(self, unit: str = "") -> str:
        """Return the figures in words, a line each; ``unit`` is that of the trace, for the words."""
        words = self.kind.replace("_", " ")
        if self.kind == "steady_sliding":
            return "\n".join([f"{words}: no cycles", *(f"- {note}" for note in self.notes)])
        period, drop = Scatter.of(self.period), Scatter.of(self.drop)
        free = f"free period {self.free_period:.4g} s"
        of = f" {unit}" if unit not in ("", "1") else ""
        turning = "rad" if unit == "N m" else "m"
        stiff = (
            f"stiffness     {self.stiffness:.5g}{of or ' 1'}/{turning} (slope / speed)"
            if self.stiffness
            else ""
        )
        lines = [
            f"{words}: {self.slips} slips",
            f"period        {period.median:.4g} s (scatter {period.deviation:.2g} s); {free}",
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
    drive_speed: float | None = None,
    drive_speed_uncertainty: float = DRIVE_SPEED_UNCERTAINTY,
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
        Constant speed of the drive, m/s; gives the stiffness. A trace of speed without it takes its mean.
    drive_speed_uncertainty
        How far that may be off, as a share of it: half the width of its 95 % interval. `identify` carries it
        into every interval.
    least_drop
        Count only falls and rises of at least this. Slips of real surfaces have all sizes, so a count means
        little without it; by default it is what noise could make.

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
    for name, given in (("drive_speed", drive_speed), ("least_drop", least_drop)):
        if given is not None and not (np.isfinite(given) and given > 0):
            raise ParameterError(f"{name} is {given}: it must be greater than 0")
    if not 0 < drive_speed_uncertainty <= _GREATEST_UNCERTAINTY:
        raise ParameterError(
            f"drive_speed_uncertainty is {drive_speed_uncertainty}: it must be greater than 0, and at most "
            f"{_GREATEST_UNCERTAINTY} of the drive speed"
        )
    samples = even_samples(time, value, name=quantity)
    if quantity == "speed":
        samples = _stretch(samples, drive_speed)
    slips, least, window = found_falls(samples, least_drop)
    record = _record(samples, slips, window, least, quantity, drive_speed, least_drop)
    return replace(record, drive_speed_uncertainty=drive_speed_uncertainty)


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
    slips: Falls,
    window: int,
    least: float,
    quantity: str,
    drive_speed: float | None,
    least_drop: float | None,
) -> CycleRecord:
    value, bridged = samples.value, np.concatenate([[0], np.cumsum(_long(samples.bridged, window))])
    whole = bridged[slips.bottom] == bridged[slips.top]
    top, bottom = slips.top[whole], slips.bottom[whole]
    kept = Falls(top, bottom)
    smooth = smoothed(value, window)
    middle = crossing(smooth, kept, 0.5) if top.size else np.empty(0)
    lasts = steep_lasts(value, kept, window) if top.size else np.empty(0)
    pair = (bridged[bottom[1:]] == bridged[top[:-1]]) & (top[1:] > bottom[:-1] + 1)
    pair &= np.searchsorted(slips.top, top[1:]) - np.searchsorted(slips.top, top[:-1]) == 1
    period = np.diff(middle)[pair] * samples.interval
    slopes = _rise_slopes(samples, bottom[:-1][pair], top[1:][pair])
    crown = curved(value, window)
    high, low = crown[top], crown[bottom]
    drift = _slope(samples.interval * middle, 0.5 * (high + low)) if top.size >= FEWEST_SLIPS else 0.0
    duration = (bottom - top) * samples.interval
    kind, notes = _kind(high - low, duration, slopes, period)
    notes += _notes(samples, least, least_drop, lasts, period, drift, high - low)
    return CycleRecord(
        kind,
        quantity,
        samples,
        drive_speed,
        DRIVE_SPEED_UNCERTAINTY,
        least,
        samples.start + samples.interval * middle,
        high,
        low,
        duration,
        lasts * samples.interval,
        period,
        slopes,
        drift,
        tuple(notes),
    )


def _long(bridged: NDArray[np.bool_], window: int) -> NDArray[np.bool_]:
    """Gaps longer than what resolves a fall; a straight line across a shorter one does no harm."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], bridged, [False]]).astype(np.int8)))
    long_gaps = np.zeros(bridged.size, dtype=bool)
    for first, last in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        long_gaps[first:last] = last - first > window
    return long_gaps


def _kind(
    drop: FloatArray, duration: FloatArray, slopes: FloatArray, period: FloatArray
) -> tuple[str, list[str]]:
    if period.size < FEWEST_SLIPS - 1:
        return "steady_sliding", []
    if _stuck_fraction(drop, duration, slopes, period) >= LEAST_STUCK:
        return "stick_slip", []
    if float(np.std(period)) > _REGULAR * float(np.mean(period)):
        return "steady_sliding", ["the force wanders irregularly without sticking: that is no cycle"]
    return "inertial", []


def _stuck_fraction(drop: FloatArray, duration: FloatArray, slopes: FloatArray, period: FloatArray) -> float:
    angle = stick_angle(*_typical(drop, duration, slopes))
    (fall, lap) = _typical(duration, period)
    return max(0.0, 1.0 - slip_duration(fall, angle) / lap) if angle > 0 else 0.0


def _typical(*columns: FloatArray) -> tuple[float, ...]:
    return tuple(float(np.median(column)) for column in columns)


def _rise_slopes(samples: Samples, bottom: np.ndarray, top: np.ndarray) -> FloatArray:
    """Slope of the steepest part of each rise, per s: the greatest of lines through `SHARE` of it."""
    if bottom.size > _RISES:
        spread = np.linspace(0, bottom.size - 1, _RISES).astype(int)
        bottom, top = bottom[spread], top[spread]
    slopes = [_steepest(samples.value[i : j + 1]) for i, j in zip(bottom.tolist(), top.tolist(), strict=True)]
    return np.array(slopes) / samples.interval


def _steepest(rise: FloatArray) -> float:
    width = max(2, int(SHARE * rise.size))
    lever = np.arange(width) - 0.5 * (width - 1)
    if rise.size * width < 20_000:
        fitted = np.correlate(rise, lever, "valid") / float(lever @ lever)
        return float(np.max(fitted))
    shifted = rise - rise[0]
    sums = np.concatenate([[0.0], np.cumsum(shifted)])
    moments = np.concatenate([[0.0], np.cumsum(shifted * np.arange(rise.size))])
    first = np.arange(rise.size - width + 1)
    total, moment = sums[first + width] - sums[first], moments[first + width] - moments[first]
    return float(np.max((moment - (first + 0.5 * (width - 1)) * total) / float(lever @ lever)))


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
    rise = float(np.median(period)) - float(np.median(lasts)) * samples.interval
    if rise < 0.5 * float(np.median(lasts)) * samples.interval:
        notes.append("the force rises faster than it falls: is its sign turned?")
    swing = abs(drift) * samples.interval * samples.value.size
    if swing > 0.5 * float(np.median(drop)):
        notes.append(f"the level drifts by {swing:.3g} over the trace")
    return notes
