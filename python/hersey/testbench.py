"""A virtual test stand: logs of a drive whose true damping surface is known, with what real logs suffer from.

The lubricant follows B = a T^b w^c above a transition speed and a steeper exponent below it; the transition
sits at a fixed Hersey number and so moves with temperature. What it writes is synthetic, and says so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
import polars as pl

from hersey import _core
from hersey.drag import Drag
from hersey.errors import ParameterError
from hersey.log.torque_log import FloatArray
from hersey.motion import Drivetrain, simulate

RPM = 2.0 * np.pi / 60.0
KELVIN = 273.15

#: First line of every log.
PREAMBLE = "# SYNTHETIC log of the hersey virtual test stand (not a measurement)"
COLUMNS = ("Time [s]", "Drive torque [N*m]", "Drive speed [rpm]", "Heater temperature [degC]")
#: Decimal places written of each column.
DIGITS = (2, 4, 3, 2)


@dataclass(frozen=True)
class Truth:
    """The lubricant: B in N m s/rad from T in degC and w in rad/s, and its transition."""

    a: float = 62.0
    b: float = -0.9
    c: float = -0.7
    mixed_exponent: float = -1.2
    transition_speed_rpm: float = 12.0  #: at the reference temperature
    reference_temperature_degC: float = 150.0  # noqa: N815 (the unit is spelt so)

    @property
    def temperature_exponent(self) -> float:
        """Exponent of the transition speed in temperature: a fixed Hersey number."""
        return -self.b / (1.0 + self.c)

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the transition speed in rad/s at temperatures in degC."""
        ratio = temperature / self.reference_temperature_degC
        return np.asarray(self.transition_speed_rpm * RPM * ratio**self.temperature_exponent)

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s) and temperatures (degC)."""
        w = np.abs(speed)
        w_t = self.transition_speed(temperature)
        level = self.a * temperature**self.b * w_t ** (1.0 + self.c)
        exponent = 1.0 + np.where(w >= w_t, self.c, self.mixed_exponent)
        ratio = np.where(w > 0, w, 1.0) / w_t
        return np.asarray(np.where(w > 0, np.sign(speed) * level * ratio**exponent, 0.0))


@dataclass(frozen=True)
class ThermalTruth(Truth):
    """A lubricant of another law of temperature, equal to `Truth` at the reference temperature.

    Its viscosity varies as T^b in K or degC, as Arrhenius's or as Vogel's law (VFT) has it, and torque above
    the transition as viscosity to the power 1 + c.
    """

    law: str = "Arrhenius"  #: ``degC``, ``K``, ``Arrhenius`` or ``VFT``
    activation_energy: float = 39_584.0  #: J/mol, apparent, of torque at the reference temperature
    vogel_temperature: float = 200.0  #: K, of VFT
    transition_share: float = 1.0  #: the transition moves as 1/viscosity to this power; 1: one Hersey number
    exponent_drift: float = 0.0  #: change of c for each kelvin from the reference, 1/K
    pivot_speed_rpm: float = 30.0  #: where such a change leaves torque alone

    def log_torque_ratio(self, temperature: FloatArray) -> FloatArray:
        """Return ln of torque over that at the reference temperature, at temperatures in degC."""
        kelvin, reference = temperature + KELVIN, self.reference_temperature_degC + KELVIN
        slope = self.activation_energy / (_core.GAS_CONSTANT * reference**2)  # of -ln torque, 1/K, there
        if self.law == "degC":
            scale = self.reference_temperature_degC
            return np.asarray(-slope * scale * np.log(temperature / scale))
        if self.law == "K":
            return np.asarray(-slope * reference * np.log(kelvin / reference))
        if self.law not in ("Arrhenius", "VFT"):
            raise ParameterError(f"law '{self.law}' is not known: degC, K, Arrhenius or VFT")
        zero = self.vogel_temperature if self.law == "VFT" else 0.0
        shape = 1.0 / (kelvin - zero) - 1.0 / (reference - zero)
        return np.asarray(slope * (reference - zero) ** 2 * shape)

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the transition speed in rad/s at temperatures in degC."""
        viscosity = self.log_torque_ratio(temperature) / (1.0 + self.c)
        return np.asarray(self.transition_speed_rpm * RPM * np.exp(-self.transition_share * viscosity))

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s) and temperatures (degC)."""
        w = np.where(speed == 0, 1.0, np.abs(speed))
        pivot = self.pivot_speed_rpm * RPM
        c = self.c + self.exponent_drift * (temperature - self.reference_temperature_degC)
        level = self.a * self.reference_temperature_degC**self.b * pivot ** (1.0 + self.c)
        bend = np.minimum(np.log(w / self.transition_speed(temperature)), 0.0)
        log_ratio = self.log_torque_ratio(temperature) + (1.0 + c) * np.log(w / pivot)
        return np.asarray(np.sign(speed) * level * np.exp(log_ratio + (self.mixed_exponent - c) * bend))


@dataclass(frozen=True)
class StribeckTruth(ThermalTruth):
    """A Stribeck curve at its Hersey number; ``activation_energy`` is that of viscosity.

    ``transition_speed_rpm`` is the Stribeck speed, and the coefficients of the branches have no part in it.
    """

    coulomb_torque: float = 0.25  #: N m
    stribeck_peak: float = 0.8  #: over Coulomb's torque
    viscous: float = 0.12  #: torque over Coulomb's at the Stribeck speed

    def transition_speed(self, temperature: FloatArray) -> FloatArray:
        """Return the Stribeck speed in rad/s at temperatures in degC."""
        return np.asarray(self.transition_speed_rpm * RPM * np.exp(-self.log_torque_ratio(temperature)))

    def torque(self, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return torque in N m at speeds (rad/s) and temperatures (degC)."""
        h = np.abs(speed) / self.transition_speed(temperature)
        size = self.coulomb_torque * (1.0 + self.stribeck_peak * np.exp(-(h**2)) + self.viscous * h)
        return np.asarray(np.sign(speed) * size)


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
    stick_speed: float = 0.0003  #: m/s


@dataclass(frozen=True)
class VirtualLog:
    """What the stand recorded (columns as `COLUMNS`), and the truth behind it."""

    table: pl.DataFrame
    truth: Truth
    stand: Stand
    seed: int

    def truth_document(self) -> dict[str, object]:
        """Return truth, stand and seed as plain data."""
        return {
            "synthetic": True,
            "seed": self.seed,
            "version": _core.VERSION,
            "truth": asdict(self.truth),
            "stand": asdict(self.stand),
        }

    def write(self, file: TextIO | Path) -> None:
        """Write the log as CSV, headed by a line that calls it synthetic."""
        if isinstance(file, Path):
            with file.open("w", encoding="utf-8") as opened:
                return self.write(opened)
        file.write(f"{PREAMBLE}, seed {self.seed}\n")
        file.write(self.table.write_csv())
        return None


def run(*, seed: int = 0, truth: Truth | None = None, stand: Stand | None = None) -> VirtualLog:
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
    shown = zip(COLUMNS, columns, digits, strict=True)
    table = pl.DataFrame({name: np.round(values[kept], places) for name, values, places in shown})
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
    truth: Truth,
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


def _stick_slip(stand: Stand, truth: Truth, level: float, speed: float) -> tuple[FloatArray, FloatArray]:
    """Speed and torque of a stretch of stick-slip at half the slowest speed: the torque is the spring's."""
    w_t = float(truth.transition_speed(np.array(level)))
    drag = Drag(
        transition_force=float(truth.torque(np.array(w_t), np.array(level))) / stand.roll_radius,
        transition_speed=w_t * stand.roll_radius,
        ehl_exponent=truth.c,
        mixed_exponent=truth.mixed_exponent,
        stick_speed=stand.stick_speed,
    )
    count = round(2 * stand.dwell / stand.sampling_interval)
    slow = 0.5 * speed
    motion = simulate(
        Drivetrain(stand.stiffness, stand.mass),
        drag,
        drive_speed=slow * stand.roll_radius,
        duration=count * stand.sampling_interval,
        samples=count,
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
    shown = torque * ripple + inertial + scale * _noise(stand, random, time.size) + stand.torque_offset
    if stand.torque_step > 0:
        shown = np.round(shown / stand.torque_step) * stand.torque_step
    return np.asarray(shown)


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
