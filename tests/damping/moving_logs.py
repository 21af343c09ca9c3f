"""Logs of a drive that moves all the time, made by hand."""

from __future__ import annotations

import numpy as np
import polars as pl

import hersey
from hersey.arrays import FloatArray

#: What the drive is: kg m^2, N m, N m s/rad, N m.
INERTIA, COULOMB, VISCOUS, OFFSET = 0.01, 0.3, 0.02, 0.015
#: Rows per second, and steps of the encoder.
RATE, STEPS = 100.0, 4096


def made(
    speed: FloatArray, rate: FloatArray, friction: FloatArray, *, seed: int = 1, noise: float = 0.01
) -> hersey.TorqueLog:
    """A log of a motion at even times, torque with noise."""
    rng = np.random.default_rng(seed)
    torque = INERTIA * rate + OFFSET + friction + rng.normal(0.0, noise, speed.size)
    return read(speed, torque)


def read(speed: FloatArray, torque: FloatArray, kelvin: FloatArray | None = None) -> hersey.TorqueLog:
    """A log of these channels."""
    columns = {"time (s)": np.arange(speed.size) / RATE, "torque (N m)": torque, "speed (rad/s)": speed}
    if kelvin is not None:
        columns["temperature (K)"] = kelvin
    return hersey.read(pl.DataFrame(columns), isothermal=kelvin is None)


def times(last: float = 60.0) -> FloatArray:
    """Times of the rows, s."""
    return np.arange(0.0, last, 1.0 / RATE)


def waves(time: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Speed and acceleration of two sines."""
    speed = 6.0 * np.sin(1.3 * time) + 3.0 * np.sin(3.1 * time + 1.0)
    return speed, 7.8 * np.cos(1.3 * time) + 9.3 * np.cos(3.1 * time + 1.0)


def counted(speed: FloatArray) -> FloatArray:
    """The speed as a 12-bit encoder gives it: differences of whole steps, over the interval just past."""
    step = 2.0 * np.pi / STEPS
    position = 0.4 + np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) / RATE)])
    read_at = np.floor(position / step) * step
    return np.diff(read_at, prepend=read_at[0]) * RATE


def sine(*, hot: bool = False) -> hersey.TorqueLog:
    """Coulomb and viscous friction, an encoder, and temperature if that is asked for."""
    speed, rate = waves(times())
    friction = COULOMB * np.sign(speed) + VISCOUS * speed
    log = made(counted(speed), rate, friction)
    if not hot:
        return log
    kelvin = 300.0 + times() / 2.0
    thin = friction + VISCOUS * speed * (np.exp(-0.02 * (kelvin - 315.0)) - 1.0)
    noise = np.random.default_rng(2).normal(0.0, 0.01, speed.size)
    return read(counted(speed), INERTIA * rate + OFFSET + thin + noise, kelvin)
