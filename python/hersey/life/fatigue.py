"""Fatigue of a part that carries torque: rainflow counts, S-N curve, Miner's sum.

Ranges are from valley to peak, amplitudes half of them. The curve is one in torque amplitude at the part, as
a gear's tooth or shaft is tested; the ``ratio`` of the gearing leads there from where torque is known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from hersey.arguments.frozen import explained
from hersey.arrays import FloatArray, numbers_of
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import takes_si

if TYPE_CHECKING:
    from hersey.motion.belt import Drivetrain
    from hersey.motion.simulation import StickSlipCycle


@explained
@dataclass(frozen=True, repr=False)
class RainflowCycles:
    """Cycles of a signal: arrays of shape (cycles,), ranges and means in its unit.

    A closed cycle has count 1, a half cycle 0.5.
    """

    ranges: FloatArray
    means: FloatArray
    counts: FloatArray

    @property
    def amplitudes(self) -> FloatArray:
        """Half the ranges, as an S-N curve needs."""
        return self.ranges / 2

    def __repr__(self) -> str:
        """Return their number and the greatest range."""
        greatest = f", greatest range {self.ranges.max():.6g}" if self.ranges.size else ""
        return f"<RainflowCycles: {self.counts.sum():g} cycles{greatest}>"


@takes_si(amplitude="torque", endurance="torque", ultimate="torque")
@dataclass(frozen=True)
class SNCurve:
    """Cycles to failure against amplitude: N = cycles (amplitude / a)^slope.

    Parameters
    ----------
    amplitude, cycles
        A point of the curve (amplitude in N m at the part); with a second slope, the knee.
    slope
        Slope k of the log-log line, positive. On its own it applies to every amplitude (Miner elementary).
    second_slope
        Slope below the knee, at least ``slope``; ``"haibach"`` means 2 k - 1.
    endurance
        Amplitude below which cycles do no damage, N m, at most ``amplitude`` (at ``amplitude`` itself: Miner
        original). None if there is none.
    ultimate
        Torque at which the part breaks at once, N m. If given, mean torque m counts by Goodman's line:
        amplitude a about m damages like a / (1 - abs(m) / ultimate) about zero. If None, means are ignored.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name.

    Examples
    --------
    >>> curve = SNCurve("20 N*m", 2e6, 5)
    >>> float(curve.life(40.0))
    62500.0
    """

    amplitude: float
    cycles: float
    slope: float
    second_slope: float | str | None = None
    endurance: float | None = None
    ultimate: float | None = None

    def __post_init__(self) -> None:
        """Refuse what is no curve."""
        for name in ("amplitude", "cycles", "slope"):
            _refuse_not_positive(name, getattr(self, name))
        for name in ("endurance", "ultimate"):
            if getattr(self, name) is not None:
                _refuse_not_positive(name, getattr(self, name))
        if self.second_slope is not None:
            object.__setattr__(self, "second_slope", self._told_second_slope())
        if self.endurance is not None and self.endurance > self.amplitude:
            raise ParameterError(
                f"endurance is {self.endurance:g} N m, above the point of the S-N curve at "
                f"{self.amplitude:g} N m. Give a point at or above the endurance limit",
                quantity="endurance",
            )
        if self.ultimate is not None and self.ultimate <= self.amplitude:
            raise ParameterError(
                f"ultimate is {self.ultimate:g} N m: the curve's amplitude of {self.amplitude:g} N m "
                "would break the part at once",
                quantity="ultimate",
            )

    def _told_second_slope(self) -> float:
        if isinstance(self.second_slope, str) and self.second_slope != "haibach":
            raise ParameterError(
                f"second_slope is '{self.second_slope}': it must be a number or 'haibach'",
                quantity="second_slope",
            )
        second = 2 * self.slope - 1 if self.second_slope == "haibach" else self.second_slope
        _refuse_not_positive("second_slope", second)
        if second < self.slope:  # type: ignore[operator]
            raise ParameterError(
                f"second_slope is {second:g}: it must be at least the slope {self.slope:g}, because the "
                "curve is flatter below the knee",
                quantity="second_slope",
            )
        return float(second)  # type: ignore[arg-type]

    @takes_si(amplitude="torque", mean="torque")
    def life(self, amplitude: ArrayLike, mean: ArrayLike = 0.0) -> FloatArray:
        """Return the cycles to failure at amplitudes about means, N m; infinite below the endurance limit.

        Raises
        ------
        ParameterError
            If an amplitude is negative, or peaks reach the ultimate torque: such a part breaks at once.
        """
        a, m = np.broadcast_arrays(numbers_of("amplitude", amplitude), np.abs(numbers_of("mean", mean)))
        if not (np.all(np.isfinite(a)) and np.all(np.isfinite(m)) and np.all(a >= 0)):
            raise ParameterError("amplitudes and means must be finite, and amplitudes not negative")
        if self.ultimate is not None:
            worst = float(np.max(a + m))
            if worst >= self.ultimate:
                raise ParameterError(
                    f"a peak of {worst:.6g} N m reaches the ultimate torque {self.ultimate:g} N m, so "
                    "the part breaks at once and has no fatigue life",
                    quantity="ultimate",
                    value=worst,
                    limit=self.ultimate,
                    unit="N*m",
                )
            a = a / (1 - m / self.ultimate)
        slope = np.where(a < self.amplitude, self.second_slope or self.slope, self.slope).astype(float)
        with np.errstate(divide="ignore", over="ignore"):
            life = self.cycles * np.power(self.amplitude / a, slope)
        return np.where(a < (self.endurance or 0.0), np.inf, life)


@takes_si()
def rainflow_cycles(signal: ArrayLike, *, repeating: bool = False) -> RainflowCycles:
    """Return the cycles of a signal by rainflow counting (ASTM E1049-85, 5.4.4), in the order they are found.

    The largest range is that from the lowest valley to the highest peak. Every reversal counts, also those of
    noise; with a steep curve these hardly matter.

    Parameters
    ----------
    signal
        Values in any unit, shape (samples,), in order of time.
    repeating
        Whether the signal repeats: it is then counted from its highest peak to the same peak (5.4.5), and
        every cycle closes.

    Raises
    ------
    ParameterError
        If a sample is not a finite number, with its index.

    Examples
    --------
    >>> cycles = rainflow_cycles([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    >>> cycles.ranges.tolist(), cycles.counts.tolist()
    ([3.0, 4.0, 4.0, 8.0, 9.0, 8.0, 6.0], [0.5, 0.5, 1.0, 0.5, 0.5, 0.5, 0.5])
    """
    import rainflow

    values = numbers_of("signal", signal)
    if values.ndim != 1:
        raise ParameterError(f"signal has {values.ndim} dimensions: it must have one")
    if not np.all(np.isfinite(values)):
        place = int(np.argmin(np.isfinite(values)))
        raise ParameterError(f"sample {place} of the signal is not a finite number", index=place)
    if repeating:
        highest = int(np.argmax(values))
        values = np.append(np.roll(values, -highest), values[highest])
    turning = _turning_points(values)
    if turning.size < 2:
        none = np.empty(0)
        return RainflowCycles(none, none, none)
    # The package takes the last sample as an end only behind a third one: repeated, it changes no count.
    found = rainflow.extract_cycles([*turning.tolist(), float(turning[-1])])
    ranges, means, counts = np.array([each[:3] for each in found], dtype=float).T
    return RainflowCycles(ranges, means, counts)


@takes_si()
def miner_damage(cycles: RainflowCycles, curve: SNCurve, *, ratio: float = 1.0) -> float:
    """Return Miner's sum of torque cycles in N m; the part is assumed to fail at 1.

    Parameters
    ----------
    ratio
        Torque at the part divided by the counted torque, e.g. the gear ratio.

    Raises
    ------
    ParameterError
        As `SNCurve.life`.
    """
    _refuse_not_positive("ratio", ratio)
    if cycles.ranges.size == 0:
        return 0.0
    return float(np.sum(cycles.counts / curve.life(ratio * cycles.amplitudes, ratio * cycles.means)))


@takes_si(signal="torque", duration="time")
def damage_rate(signal: ArrayLike, duration: float, curve: SNCurve, *, ratio: float = 1.0) -> float:
    """Return Miner's sum per unit of time or age, assuming that the recorded torque repeats.

    Parameters
    ----------
    signal
        Torque, N m, shape (samples,), over a representative span, which is assumed to repeat.
    duration
        Duration of the signal: s, or a plain number in any unit of age, e.g. pages.
    ratio
        As for `miner_damage`.

    Raises
    ------
    ParameterError
        If a sample, the duration or the ratio is out of range, or as `SNCurve.life`.
    InsufficientDataError
        If there are fewer than two samples.
    """
    _refuse_not_positive("duration", duration)
    if np.size(signal) < 2:
        raise InsufficientDataError("a signal of fewer than two samples has no cycles. Give a longer one")
    return miner_damage(rainflow_cycles(signal, repeating=True), curve, ratio=ratio) / duration


@takes_si(roll_radius="length")
def stick_slip_damage_rate(
    cycle: StickSlipCycle, train: Drivetrain, curve: SNCurve, *, roll_radius: float, ratio: float = 1.0
) -> float:
    """Return Miner's sum per second of stick-slip, without a recorded signal.

    The torque at the roll has the amplitude k (s_max - s_min) R / 2 about the mean k (s_max + s_min) R / 2,
    once per cycle. If the motion repeats only after several cycles, the extremes of all are used, which is an
    upper bound. Motion without cycles does no damage.

    Parameters
    ----------
    cycle, train
        The settled motion and its drivetrain, in SI.
    roll_radius
        R, m.
    ratio
        Torque at the part divided by that at the roll.

    Raises
    ------
    ParameterError
        As `SNCurve.life`, or if radius or ratio is out of range.
    """
    _refuse_not_positive("roll_radius", roll_radius)
    _refuse_not_positive("ratio", ratio)
    if not cycle.frequency > 0:
        return 0.0
    lever = ratio * train.stiffness * roll_radius / 2
    life = curve.life(
        lever * (cycle.stretch_max - cycle.stretch_min), lever * (cycle.stretch_max + cycle.stretch_min)
    )
    return float(cycle.frequency / life)


@takes_si()
def life_of(rate: float, *, spent: float = 0.0, limit: float = 1.0) -> float:
    """Return the time until Miner's sum reaches ``limit``, in the unit of the rate; infinite without damage.

    Parameters
    ----------
    rate
        Damage per s, per unit of age or per repeat, not negative.
    spent
        Earlier damage, not negative; above the limit, no life is left.
    limit
        Sum at which the part is assumed to fail.

    Raises
    ------
    ParameterError
        If a value is out of range.
    """
    _refuse_not_positive("limit", limit)
    for name, value in (("rate", rate), ("spent", spent)):
        if not (value >= 0 and math.isfinite(value)):
            raise ParameterError(f"{name} is {value}: it must not be negative", quantity=name)
    left = max(limit - spent, 0.0)
    return left / rate if rate > 0 else math.inf if left > 0 else 0.0


def _turning_points(values: FloatArray) -> FloatArray:
    """The first sample, each peak and valley, and the last: no two neighbours equal."""
    values = values[np.append(True, np.diff(values) != 0)]
    rises = np.diff(values) > 0
    return values[np.concatenate([[True], rises[1:] != rises[:-1], [True]])] if values.size > 2 else values


def _refuse_not_positive(name: str, value: object) -> None:
    try:
        fits = math.isfinite(value) and value > 0  # type: ignore[arg-type,operator]
    except TypeError:
        fits = False
    if not fits:
        raise ParameterError(f"{name} is {value}: it must be a number greater than 0", quantity=name)
