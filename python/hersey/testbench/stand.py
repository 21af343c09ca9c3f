"""A virtual test stand: logs of a drive whose true damping surface is known, with what real logs suffer from.

The lubricant follows B = a T^b w^c above a transition speed and a steeper exponent below it; the transition
sits at a fixed Hersey number and so moves with temperature. Or film, contact and the no-load torque make
the torque (`PhysicalTruth`). What it writes is synthetic, and says so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
import polars as pl

from hersey import _core
from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.files.writing import write_atomically
from hersey.motion.belt import Drivetrain
from hersey.motion.simulation import simulate
from hersey.result import json_value
from hersey.testbench.physical import PhysicalTruth
from hersey.testbench.truth import RPM, Truth
from hersey.units import ZERO_CELSIUS

#: First line of every log.
PREAMBLE = "# SYNTHETIC log of the hersey virtual test stand (not a measurement)"
COLUMNS = ("Time [s]", "Drive torque [N*m]", "Drive speed [rpm]", "Heater temperature [degC]")
#: Decimal places written of each column.
DIGITS = (2, 4, 3, 2)


@dataclass(frozen=True)
class Stand:
    """The stand and its sensors; every disturbance can be set to zero."""

    temperatures_degC: tuple[float, ...] = (90.0, 120.0, 150.0, 180.0)  # noqa: N815
    speeds_rpm: tuple[float, ...] = (5.0, 7.0, 10.0, 14.0, 20.0, 30.0, 45.0, 65.0, 95.0, 140.0)
    dwell: float = 16.0  #: s
    ramp: float = 1.5  #: s from one speed to the next
    standing: float = 20.0  #: s of standing, clutch open, at the start
    sampling_interval: float = 0.05  #: s
    torque_noise: float = 0.03  #: relative standard deviation of a sample
    noise_time: float = 0.15  #: s over which the noise is correlated
    repeatability: float = 0.01  #: relative standard deviation from dwell to dwell
    torque_offset: float = 0.004  #: N m, of the sensor
    torque_step: float = 0.0005  #: N m, of the converter
    speed_ripple: float = 0.004  #: relative amplitude of the encoder, once a revolution
    mesh_ripple: float = 0.01  #: relative amplitude of the gear mesh
    mesh_teeth: int = 17
    inertia: float = 2e-4  #: kg m^2, seen in the ramps
    thermal_time: float = 15.0  #: s, of the heater
    overshoot: float = 0.06  #: of a temperature step
    temperature_noise: float = 0.1  #: K
    dropped: float = 0.002  #: share of samples lost
    stick_slip: bool = True  #: a stretch at the slowest speed and highest temperature
    roll_radius: float = 0.015  #: m
    stiffness: float = 11_000.0  #: N/m, of the drivetrain at the belt
    mass: float = 1.0  #: kg
    stick_speed: float = 0.0003  #: m/s, at the temperature of its stick-slip


@dataclass(frozen=True)
class VirtualLog:
    """What the stand recorded (columns as `COLUMNS`), and the truth behind it."""

    table: pl.DataFrame
    truth: Truth | PhysicalTruth
    stand: Stand
    seed: int

    def truth_document(self) -> dict[str, object]:
        """Return truth, its transition speed at each temperature, stand and seed as plain data."""
        levels = np.array(self.stand.temperatures_degC)
        speeds = np.round(self.truth.transition_speed(levels) / RPM, 4)
        return {
            "synthetic": True,
            "seed": self.seed,
            "version": _core.VERSION,
            "truth": self.truth.to_dict(),
            "transition_speeds_rpm": json_value(speeds),
            "stand": asdict(self.stand),
        }

    def write(self, file: TextIO | Path) -> None:
        """Write the log as CSV, headed by a line that calls it synthetic."""
        text = f"{PREAMBLE}, seed {self.seed}\n{self.table.write_csv()}"
        if isinstance(file, Path):
            write_atomically(file, text, overwrite=True)
        else:
            file.write(text)


def run(
    *, seed: int = 0, truth: Truth | PhysicalTruth | None = None, stand: Stand | None = None
) -> VirtualLog:
    """Run the staircase up and down at every temperature and return the log.

    Parameters
    ----------
    seed
        Of all random draws: the same seed gives the same log to the bit.

    Examples
    --------
    >>> log = run(seed=1)
    >>> log.table.columns[1]
    'Drive torque [N*m]'
    """
    truth, stand = truth or Truth(), stand or Stand()
    _check(stand)
    random = np.random.default_rng(seed)
    parts = [_standing(stand)]
    for index, level in enumerate(stand.temperatures_degC):
        before = stand.temperatures_degC[index - 1] if index else 25.0
        hottest = level == max(stand.temperatures_degC)
        parts.append(_staircase(stand, truth, random, before, level, stand.stick_slip and hottest))
    speed, temperature, torque, scatter = (np.concatenate(c) for c in zip(*parts, strict=True))
    time: FloatArray = np.arange(speed.size, dtype=np.float64) * stand.sampling_interval
    measured = _measured_torque(stand, random, time, speed, torque * scatter)
    angle = np.cumsum(speed) * stand.sampling_interval
    shown_speed = speed * (1.0 + stand.speed_ripple * np.sin(angle)) / RPM
    shown_temperature = temperature + stand.temperature_noise * random.standard_normal(time.size)
    kept = random.random(time.size) >= stand.dropped
    columns = (time, measured, shown_speed, shown_temperature)
    digits = (DIGITS[0] + max(0, int(-np.log10(stand.sampling_interval))), *DIGITS[1:])
    channels = zip(COLUMNS, columns, digits, strict=True)
    table = pl.DataFrame({name: np.round(values[kept], places) for name, values, places in channels})
    return VirtualLog(table, truth, stand, seed)


Part = tuple[FloatArray, FloatArray, FloatArray, FloatArray]


def _check(stand: Stand) -> None:
    for name in ("dwell", "ramp", "sampling_interval", "roll_radius", "stiffness", "mass", "stick_speed"):
        if not getattr(stand, name) > 0:
            raise ParameterError(f"{name} is {getattr(stand, name)}: it must be greater than 0")
    if not stand.temperatures_degC or len(stand.speeds_rpm) < 1:
        raise ParameterError("the stand needs at least one temperature and one speed")


def _standing(stand: Stand) -> Part:
    count = round(stand.standing / stand.sampling_interval)
    zero = np.zeros(count)
    return zero, np.full(count, 25.0), zero, np.ones(count)


def _staircase(
    stand: Stand,
    truth: Truth | PhysicalTruth,
    random: np.random.Generator,
    before: float,
    level: float,
    sticks: bool,
) -> Part:
    """Speed, temperature (degC), torque (N m) and relative scatter of one temperature, up and down."""
    steps = [*stand.speeds_rpm, *stand.speeds_rpm[-2::-1]]
    dt = stand.sampling_interval
    dwell, ramp = round(stand.dwell / dt), round(stand.ramp / dt)
    warm_up = round(6.0 * stand.thermal_time / dt)
    speeds, scatters = [np.full(warm_up, steps[0] * RPM)], [np.ones(warm_up)]
    last = steps[0]
    for step in steps:
        speeds += [np.linspace(last, step, ramp, endpoint=False) * RPM, np.full(dwell, step * RPM)]
        scatters += [np.ones(ramp), np.full(dwell, 1.0 + stand.repeatability * random.standard_normal())]
        last = step
    speed, scatter = np.concatenate(speeds), np.concatenate(scatters)
    temperature = before + (level - before) * _heater(stand, np.arange(speed.size, dtype=np.float64) * dt)
    torque = truth.torque(speed, temperature)
    if sticks:
        slip_speed, slip = _stick_slip(stand, truth, level, min(stand.speeds_rpm) * RPM)
        speed, torque = np.append(speed, slip_speed), np.append(torque, slip)
        temperature = np.append(temperature, np.full(slip.size, level))
        scatter = np.append(scatter, np.ones(slip.size))
    return speed, temperature, torque, scatter


def _heater(stand: Stand, time: FloatArray) -> FloatArray:
    """Response of the heater to a step of one: second order, with the overshoot asked for."""
    decay = time / stand.thermal_time
    if stand.overshoot <= 0:
        return np.asarray(1.0 - np.exp(-decay) * (1.0 + decay))
    swing = np.pi / -np.log(stand.overshoot)
    return np.asarray(1.0 - np.exp(-decay) * (np.cos(swing * decay) + np.sin(swing * decay) / swing))


def _stick_slip(
    stand: Stand, truth: Truth | PhysicalTruth, level: float, speed: float
) -> tuple[FloatArray, FloatArray]:
    """Speed and torque of a stretch of stick-slip at half the slowest speed: the torque is the spring's."""
    count = round(2 * stand.dwell / stand.sampling_interval)
    slow = 0.5 * speed
    drag = truth.drag(level, stand.roll_radius, stand.stick_speed)
    motion = simulate(
        Drivetrain(stand.stiffness, stand.mass),
        drag,
        drive_speed=slow * stand.roll_radius,
        duration=count * stand.sampling_interval,
        samples=count,
        temperature=level + ZERO_CELSIUS if drag.varies_with_temperature else None,
        tolerance=1e-8,
    )
    return np.full(count, slow), motion.spring_force * stand.roll_radius


def _measured_torque(
    stand: Stand, random: np.random.Generator, time: FloatArray, speed: FloatArray, torque: FloatArray
) -> FloatArray:
    """What the sensor shows: mesh ripple, inertia, correlated noise, offset and quantisation."""
    angle = np.cumsum(speed) * stand.sampling_interval
    ripple = 1.0 + stand.mesh_ripple * np.sin(stand.mesh_teeth * angle)
    inertial = stand.inertia * np.gradient(speed, stand.sampling_interval)
    scale = stand.torque_noise * np.where(speed > 0, np.abs(torque), 0.1 * float(np.max(torque)))
    reading = torque * ripple + inertial + scale * _noise(stand, random, time.size) + stand.torque_offset
    if stand.torque_step > 0:
        reading = np.round(reading / stand.torque_step) * stand.torque_step
    return np.asarray(reading)


def _noise(stand: Stand, random: np.random.Generator, count: int) -> FloatArray:
    """Noise of unit deviation, correlated over `noise_time` (first-order autoregression)."""
    from scipy.signal import lfilter

    memory = float(np.exp(-stand.sampling_interval / stand.noise_time)) if stand.noise_time > 0 else 0.0
    white = random.standard_normal(count) * np.sqrt(1.0 - memory**2)
    return np.asarray(lfilter([1.0], [1.0, -memory], white))


def long_log(
    *, bytes_wanted: int, seed: int = 0, progress: Callable[[int], None] | None = None
) -> Iterator[str]:
    """Yield the text of a log of at least ``bytes_wanted`` bytes: the staircase sampled ever faster."""
    stand = Stand()
    first = run(seed=seed, stand=stand)
    faster = max(1.0, bytes_wanted / len(first.table.write_csv())) * 1.01
    fine = run(seed=seed, stand=Stand(sampling_interval=stand.sampling_interval / faster))
    yield f"{PREAMBLE}, seed {seed}\n"
    rows = 1_000_000
    for start in range(0, fine.table.height, rows):
        part = fine.table.slice(start, rows)
        text = part.write_csv(include_header=start == 0)
        if progress:
            progress(len(text))
        yield text
