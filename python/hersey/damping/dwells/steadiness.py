"""Whether a stretch is a steady dwell."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import MIN_SAMPLES
from hersey.damping.dwells.noise import AT_ONCE, mean_and_error, thinned
from hersey.damping.dwells.reasons import Reason
from hersey.damping.dwells.ripple import turned, without_ripple
from hersey.damping.dwells.shared_noise import Powers, SharedNoise
from hersey.log.long_arrays import blocks, deviation, each_block, mean
from hersey.log.torque_log import Run

#: Largest drift of temperature within a dwell, K.
MAX_TEMPERATURE_DRIFT = 2.0
#: Of speed, as a share.
MAX_SPEED_DRIFT = 0.01
#: Of torque, as a share.
MAX_TORQUE_DRIFT = 0.03
#: Of torque, in standard deviations of what fluctuates about it: a turning shaft makes slow waves of its own.
MAX_DRIFT_TO_NOISE = 2.0
#: Largest standard deviation within a dwell as a share of the mean, of torque and of speed. A speed that
#: swings more has no torque of its own: the law is not straight over what it swings through.
MAX_TORQUE_SWING, MAX_SPEED_SWING = 0.35, 0.5
#: Drift of torque, in steps of its sensor, that one reading next to another makes.
MAX_STEP_DRIFT = 1.5
#: In stick-slip torque swings by more than this share.
STICK_SLIP_SWING = 0.05
#: Its changes are this skewed (slow rises, sudden drops).
STICK_SLIP_SKEWNESS = -3.0
#: A cycle with few samples shows less: this counts where changes go on, which those of noise do not.
COARSE_SKEWNESS = -1.0
#: Drift counts as real beyond this many standard errors.
SIGNIFICANT = 3.0


def unsteady(
    run: Run,
    start: int,
    end: int,
    min_dwell: float,
    tare: float,
    noise: SharedNoise | None = None,
    ripple: bool = False,
    step: float = 0.0,
) -> Reason | None:
    """Why rows [start, end) are not a steady dwell, or None; ``step`` is that of the torque, N m."""
    time, speed, torque = run.time[start:end], run.speed[start:end], subtracted(run.torque[start:end], tare)
    if end - start < MIN_SAMPLES or time[-1] - time[0] < min_dwell:
        lasted = float(time[-1] - time[0]) if end > start else 0.0
        return Reason("too short", lasts=lasted, rows=end - start, needed=min_dwell)
    if mean(torque) == 0.0:
        return Reason("zero torque")
    temperature = None if run.temperature is None else run.temperature[start:end]
    if deviation(speed) > MAX_SPEED_SWING * abs(mean(speed)):
        slow, fast = sorted(abs(float(end)) for end in np.quantile(speed, (0.01, 0.99)))
        share = deviation(speed) / abs(mean(speed))
        return Reason("speed not held", share=share, slow=slow, fast=fast)
    swing = deviation(torque) / abs(mean(torque))
    if swing > STICK_SLIP_SWING and _rises_slowly_and_drops(torque):
        return Reason("stick-slip", share=swing)
    if swing > MAX_TORQUE_SWING:
        return Reason("swing", share=swing)
    if ripple:
        angle = turned(time, speed)
        speed, torque = without_ripple(angle, speed), without_ripple(angle, torque)
    drift, _ = drift_over(time, speed, least=MAX_SPEED_DRIFT * abs(mean(speed)))
    if drift:
        return Reason("speed drift", share=drift / mean(speed))
    if temperature is not None and (drift := drift_over(time, temperature, least=MAX_TEMPERATURE_DRIFT)[0]):
        return Reason("temperature drift", kelvin=drift)
    least = max(MAX_TORQUE_DRIFT * abs(mean(torque)), MAX_STEP_DRIFT * step)
    drift, scatter = drift_over(time, torque, noise, least=least)
    if abs(drift) > MAX_DRIFT_TO_NOISE * scatter:
        return Reason("torque drift", share=drift / mean(torque))
    return None


def _rises_slowly_and_drops(torque: FloatArray) -> bool:
    """Whether the changes of torque (taken positive) from block to block say so, at some block length."""
    direction = np.sign(mean(torque))
    for count in (100, 400, 1600):
        size = max(1, torque.size // count)
        parts = blocks(torque.size // size * size, torque, size=max(1, AT_ONCE // size) * size)
        loads = [(torque[part] * direction).reshape(-1, size).mean(axis=1) for part in parts]
        changes = np.diff(np.concatenate(loads))
        changes -= changes.mean()
        variance = float(np.mean(changes**2))
        if variance <= 0.0:
            continue
        skewness = float(np.mean(changes**3)) / variance**1.5
        go_on = float(np.mean(changes[1:] * changes[:-1])) > 0.0
        if skewness < (COARSE_SKEWNESS if go_on else STICK_SLIP_SKEWNESS):
            return True
    return False


def drift_over(
    time: FloatArray, values: FloatArray, noise: SharedNoise | None = None, *, least: float = 0.0
) -> tuple[float, float]:
    """Change along a straight line over the dwell, and the deviation about the line.

    The change is 0 if within chance (what the values themselves show, or the noise given) or ``least``.
    """
    interval = float(time[-1] - time[0]) / max(time.size - 1, 1)
    every = values
    time, values = thinned(time), thinned(values)
    slope = _slope(time, values)
    residual = values - values.mean() - slope * (time - time.mean())
    scatter = float(np.std(residual))
    rise = slope * float(time[-1] - time[0])
    if abs(rise) <= least:
        return 0.0, scatter
    if noise is not None and scatter > 1e-12 * abs(float(values.mean())):
        error = noise.rise_error(Powers.of(every, interval))
    else:
        error = mean_and_error(residual)[1] * np.sqrt(12.0)  # of a line's rise, uniform times
    return (rise if abs(rise) > SIGNIFICANT * error else 0.0), scatter


def subtracted(values: FloatArray, constant: float) -> FloatArray:
    """Return values without a constant."""
    return each_block(lambda part: part - constant, values) if constant else values


def straightened(time: FloatArray, values: FloatArray) -> FloatArray:
    """Return values without the straight line through them, mean kept."""
    slope, middle = _slope(time, values), mean(time)
    return each_block(lambda t, value: value - slope * (t - middle), time, values)


def _slope(time: FloatArray, values: FloatArray) -> float:
    t = time - time.mean()
    spread = float(np.sum(t * t))
    return float(np.sum(t * values)) / spread if spread else 0.0
