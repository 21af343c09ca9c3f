"""Corrections of a log: what lies between sensor and film is subtracted, and each step leaves a record.

Every function takes a log, or one already corrected, and returns it corrected with one more record; nothing
is corrected unless it is asked for. Their order matters: what happens at the motor (current, sign, tare,
no-load torque) comes before gears, and inertia, which is that seen at the roll, after them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.log.torque_log import CHANNEL_UNITS, STANDING, Correction, Effect, Run, TorqueLog
from hersey.schema.warning import Warning

#: Time over which a derivative is taken, s: ramps and heaters are slower, noise is faster.
DERIVATIVE_WINDOW = 0.5
#: Fewest samples under the polynomial of second degree that gives the derivative.
_LEAST_WINDOW = 5
#: Two speeds of a no-load test are one if they differ by less than this share.
_SAME_SPEED = 0.02

#: Corrections that are about the torque or the rotation of a drive.
_OF_A_TORQUE = ("torque from current", "tare", "no-load torque", "gears", "inertia")


@dataclass(frozen=True)
class Corrected:
    """A log with the record of every correction that was made, in their order."""

    log: TorqueLog
    corrections: tuple[Correction, ...] = ()


def torque_from_current(log: TorqueLog | Corrected, *, motor_constant: float) -> Corrected:
    """Turn a motor current, read in A in the place of torque, into the torque of the motor.

    Parameters
    ----------
    motor_constant
        Torque of the motor for each ampere, N m/A.

    Raises
    ------
    ParameterError
        If the constant is not greater than 0.
    """
    _require_positive("motor_constant", motor_constant, "N m/A")

    def turned(run: Run) -> Run:
        return replace(run, torque=run.torque * motor_constant)

    done = _corrected(log, "torque from current", turned, ("motor_constant", f"{motor_constant:g} N m/A"))
    typical = float(np.median(np.abs(np.concatenate([run.torque for run in done.log.runs]))))
    was_current = Warning(
        "torque from current",
        "the torque channel was a motor current in A; after conversion the median torque is {torque:.3g} N m",
        torque=typical,
    )
    return _warned(done, was_current, effects=())


def sign(log: TorqueLog | Corrected, *, torque: int = 1, speed: int = 1) -> Corrected:
    """Turn the sign of torque or speed: 1 leaves it, -1 turns it.

    Raises
    ------
    ParameterError
        If a sign is neither 1 nor -1.
    """
    for name, value in (("torque", torque), ("speed", speed)):
        if value not in (1, -1):
            raise ParameterError(f"sign of {name} is {value}: it must be 1 or -1")

    def turned(run: Run) -> Run:
        at = None if run.position is None else run.position * speed
        return replace(run, torque=run.torque * torque, speed=run.speed * speed, position=at)

    return _corrected(log, "sign", turned, ("torque", f"{torque:+d}"), ("speed", f"{speed:+d}"))


def tare(log: TorqueLog | Corrected, *, torque: float) -> Corrected:
    """Subtract what the torque sensor shows without load, N m.

    Raises
    ------
    ParameterError
        If it is not finite.
    """
    _require_finite("tare", torque, "N m")

    def tared(run: Run) -> Run:
        return replace(run, torque=run.torque - torque)

    return _corrected(log, "tare", tared, ("torque", f"{torque:g} N m"))


def no_load(log: TorqueLog | Corrected, *, torque: float | TorqueLog | Corrected) -> Corrected:
    """Subtract the torque that the drive takes without the film, in the direction of the speed.

    Parameters
    ----------
    torque
        N m at every speed; or a log of the drive without the film, whose dwells give it against speed.
        Between its speeds it is interpolated, beyond them held (and the rows counted).

    Raises
    ------
    ParameterError
        If a constant is negative or not finite.
    InsufficientDataError
        If the log without the film has no dwell.
    """
    if isinstance(torque, int | float):
        if not 0 <= torque < np.inf:
            raise ParameterError(f"no-load torque is {torque:g} N m: it must not be negative")
        speeds, levels = np.zeros(1), np.array([float(torque)])
        source = ("torque", f"{torque:g} N m")
    else:
        speeds, levels, name = _no_load_curve(torque)
        source = (
            "torque",
            (
                f"{levels.min():.3g} to {levels.max():.3g} N m, from dwells of {name} at {speeds[0]:.3g} to "
                f"{speeds[-1]:.3g} rad/s"
            ),
        )
    beyond = 0

    def freed(run: Run) -> Run:
        nonlocal beyond
        size = np.abs(run.speed)
        moving = size > STANDING
        if speeds.size > 1:
            beyond += int(np.count_nonzero(moving & ((size < speeds[0]) | (size > speeds[-1]))))
        level = np.interp(size, speeds, levels) * moving
        return replace(run, torque=run.torque - np.sign(run.speed) * level)

    done = _corrected(log, "no-load torque", freed, source)
    held = Warning(
        "speeds beyond the no-load log",
        "{rows} {rows:row lies|rows lie} outside the speed range of the no-load log; the nearest "
        "no-load torque was used",
        rows=beyond,
    )
    return _warned(done, held) if beyond else done


def at_roll(
    log: TorqueLog | Corrected,
    *,
    torque_ratio: float = 1.0,
    speed_ratio: float = 1.0,
    efficiency: float = 1.0,
) -> Corrected:
    """Carry torque and speed from the shaft where they were measured to the roll.

    Parameters
    ----------
    torque_ratio, speed_ratio
        Turns of the shaft where torque, or speed, is measured for each turn of the roll.
    efficiency
        Share of the power that passes the gears, 0 to 1: the roll gets that share of the torque while the
        motor drives, and the motor that share while the roll drives it.

    Raises
    ------
    ParameterError
        If a ratio is not greater than 0, or the efficiency not between 0 and 1.
    """
    _require_positive("torque_ratio", torque_ratio, "")
    _require_positive("speed_ratio", speed_ratio, "")
    if not 0 < efficiency <= 1:
        raise ParameterError(f"efficiency is {efficiency:g}: it must be greater than 0 and at most 1")
    back = 0

    def geared(run: Run) -> Run:
        nonlocal back
        driven = run.torque * run.speed < 0
        back += int(np.count_nonzero(driven))
        passed = np.where(driven, 1.0 / efficiency, efficiency)
        at = None if run.position is None else run.position / speed_ratio
        torque, speed = run.torque * torque_ratio * passed, run.speed / speed_ratio
        return replace(run, torque=torque, speed=speed, position=at)

    ratios = (("torque_ratio", f"{torque_ratio:g}"), ("speed_ratio", f"{speed_ratio:g}"))
    done = _corrected(log, "gears", geared, *ratios, ("efficiency", f"{efficiency:.4g}"))
    backwards = Warning(
        "roll drives the motor", "in {rows} {rows:row|rows} the load drives the motor", rows=back
    )
    return _warned(done, backwards) if back and efficiency != 1.0 else done


def inertia(
    log: TorqueLog | Corrected, *, moment_of_inertia: float, window: float = DERIVATIVE_WINDOW
) -> Corrected:
    """Subtract J dw/dt, the torque that speeds up what turns between sensor and film.

    The derivative is that of a polynomial of second degree in a moving window (Savitzky and Golay, Analytical
    Chemistry 36 (1964) 1627).

    Parameters
    ----------
    moment_of_inertia
        J, kg m^2, seen at the shaft of the speed.
    window
        Time under the polynomial, s.

    Raises
    ------
    ParameterError
        If either is not greater than 0.
    """
    _require_positive("moment_of_inertia", moment_of_inertia, "kg m^2")
    _require_positive("window", window, "s")
    left = 0

    def freed(run: Run) -> Run:
        nonlocal left
        rate = _derivative(run, run.speed, window)
        left += int(np.count_nonzero(np.isnan(rate)))
        return replace(run, torque=run.torque - moment_of_inertia * np.nan_to_num(rate))

    stated = (("moment_of_inertia", f"{moment_of_inertia:g} kg m^2"), ("window", f"{window:g} s"))
    done = _corrected(log, "inertia", freed, *stated)  # counts what is left
    return _without_derivative(done, left)


def thermal_lag(
    log: TorqueLog | Corrected, *, time_constant: float, window: float | None = None
) -> Corrected:
    """Undo the lag of a temperature sensor of first order: T + tau dT/dt.

    Parameters
    ----------
    time_constant
        tau, s, in which the sensor makes 63 % of a step.
    window
        Time under the polynomial that gives the derivative, s; a quarter of tau if not given.

    Raises
    ------
    ParameterError
        If either is not greater than 0.
    InsufficientDataError
        If the log has no temperature.
    """
    _require_positive("time_constant", time_constant, "s")
    over = max(0.25 * time_constant, DERIVATIVE_WINDOW) if window is None else window
    _require_positive("window", over, "s")
    left = 0

    def hurried(run: Run) -> Run:
        nonlocal left
        temperature = _temperature(run)
        rate = _derivative(run, temperature, over)
        left += int(np.count_nonzero(np.isnan(rate)))
        return replace(run, temperature=temperature + time_constant * np.nan_to_num(rate))

    stated = (("time_constant", f"{time_constant:g} s"), ("window", f"{over:g} s"))
    done = _corrected(log, "thermal lag", hurried, *stated)  # counts what is left
    return _without_derivative(done, left)


def temperature_offset(log: TorqueLog | Corrected, *, offset: float) -> Corrected:
    """Add what the sensor shows too little, K: the film minus the reading.

    Raises
    ------
    ParameterError
        If it is not finite.
    InsufficientDataError
        If the log has no temperature.
    """
    _require_finite("offset", offset, "K")

    def moved(run: Run) -> Run:
        return replace(run, temperature=_temperature(run) + offset)

    return _corrected(log, "temperature offset", moved, ("offset", f"{offset:+g} K"))


def _corrected(
    log: TorqueLog | Corrected, name: str, correct: Callable[[Run], Run], *parameters: tuple[str, str]
) -> Corrected:
    before = log if isinstance(log, Corrected) else Corrected(log)
    if name in _OF_A_TORQUE:
        before.log.domain.require_torque(f"the correction '{name}'")
    runs = tuple(correct(run) for run in before.log.runs)
    effects = tuple(
        effect for role in CHANNEL_UNITS if (effect := _effect(role, before.log.runs, runs)) is not None
    )
    record = Correction(name, tuple(parameters), effects)
    return Corrected(replace(before.log, runs=runs), (*before.corrections, record))


def _effect(role: str, before: tuple[Run, ...], after: tuple[Run, ...]) -> Effect | None:
    pairs = [(getattr(b, role), getattr(a, role)) for b, a in zip(before, after, strict=True)]
    pairs = [(b, a) for b, a in pairs if b is not None and b is not a]
    if not pairs:
        return None
    change = np.concatenate([a - b for b, a in pairs])
    largest = float(np.max(np.abs(change)))
    if not largest > 0.0:  # nor has a torque that was not recorded
        return None
    typical = float(np.sqrt(np.mean(change**2)))
    level = float(np.median(np.abs(np.concatenate([b for b, _ in pairs]))))
    return Effect(role, largest, typical, typical / level if level > 0 else None)


def _warned(done: Corrected, warning: Warning, **changed: Any) -> Corrected:
    """The same with a warning and other changes to the last record."""
    *before, last = done.corrections
    return Corrected(done.log, (*before, replace(last, warnings=(warning,), **changed)))


def _without_derivative(done: Corrected, rows: int) -> Corrected:
    """The same with a warning of the rows that have no derivative, if there are any."""
    alone = Warning(
        "rows alone between gaps",
        "{rows} {rows:row stands|rows stand} alone between gaps, so no derivative can be computed "
        "there; {rows:it was|they were} not corrected",
        rows=rows,
    )
    return _warned(done, alone) if rows else done


def _derivative(run: Run, values: FloatArray, window: float) -> FloatArray:
    """Change of a channel with time, per s, shape (rows,); NaN where gaps leave too few samples.

    An uneven clock is brought onto an even one first; the channel is not bridged over gaps longer than the
    window.
    """
    time, index = np.unique(run.time, return_inverse=True)
    from scipy.signal import savgol_filter  # takes long to import

    level = np.bincount(index, values) / np.bincount(index)
    step = run.sampling_interval
    length = max(_LEAST_WINDOW, 2 * round(0.5 * window / step) + 1)
    cuts = np.flatnonzero(np.diff(time) > max(window, 3.0 * step)) + 1
    rate = np.full(time.size, np.nan)
    for first, last in zip([0, *cuts], [*cuts, time.size], strict=True):
        count = int((time[last - 1] - time[first]) / step + 1e-6) + 1
        if count < length or last - first < _LEAST_WINDOW:
            continue
        even = np.linspace(time[first], time[last - 1], count)
        stretch = np.interp(even, time[first:last], level[first:last])
        slope = savgol_filter(stretch, length, 2, deriv=1, delta=float(even[1] - even[0]))
        rate[first:last] = np.interp(time[first:last], even, slope)
    return rate[index]


def _no_load_curve(log: TorqueLog | Corrected) -> tuple[FloatArray, FloatArray, str]:
    """Speeds (rad/s, rising) and no-load torques (N m) of dwells of both directions, and the log's name."""
    other = log.log if isinstance(log, Corrected) else log
    points = other.steady()
    speed, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
    order = np.argsort(speed)
    groups = np.split(order, np.flatnonzero(np.diff(speed[order]) > _SAME_SPEED * speed[order][1:]) + 1)
    speeds = np.array([speed[group].mean() for group in groups])
    levels = np.array([torque[group].mean() for group in groups])
    return speeds, levels, ", ".join(file.name for file in other.files)


def _temperature(run: Run) -> FloatArray:
    if run.temperature is None:
        raise InsufficientDataError(f"{run.name} has no temperature channel to correct")
    return run.temperature


def _require_positive(name: str, value: float, unit: str) -> None:
    if not 0 < value < np.inf:
        raise ParameterError(f"{name} is {value:g} {unit}".rstrip() + ": it must be greater than 0")


def _require_finite(name: str, value: float, unit: str) -> None:
    if not np.isfinite(value):
        raise ParameterError(f"{name} is {value:g} {unit}: it must be finite")
