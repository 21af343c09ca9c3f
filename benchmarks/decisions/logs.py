"""Files of a machine as its owner would have them: a log of slow dwells, a fast trace, a machine file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.decisions.curves import Random
from benchmarks.decisions.machines import Machine, Start
from benchmarks.decisions.motion import recorded, start_drive

Array = NDArray[np.float64]

HEADER = "Time [s],Drive torque [N*m],Drive speed [rpm],Heater temperature [degC]"
#: Seconds between samples of a log, and samples of a dwell and of a standstill.
_STEP, _DWELL, _STANDING = 0.2, 60, 120
#: Seconds between samples of a trace, and of the motion from which they are taken.
_FAST_STEP, _FINE = 0.005, 10
#: Seconds of standstill before and after a start, of a start, and of a stretch of stick-slip.
_BEFORE, _START, _STRETCH = 5.0, 10.0, 20.0
#: Share of the noise of a sample that stays in the next one.
_MEMORY = 0.5
#: Offset of the torque sensor, and the level at which its noise is least, as shares of the least drag.
_OFFSET, _FLOOR = 0.003, 0.02


@dataclass(frozen=True)
class Files:
    """Where the files of a machine are."""

    log: Path
    machine: Path
    trace: Path | None


def write(machine: Machine, folder: Path, random: Random) -> Files:
    """Write the files of a machine into a folder."""
    log, file, trace = folder / "log.csv", folder / "machine.toml", folder / "trace.csv"
    _save(log, _dwells(machine, random))
    file.write_text(machine_file(machine))
    if not machine.trace:
        return Files(log, file, None)
    _save(trace, _trace(machine, random))
    return Files(log, file, trace)


def _save(path: Path, rows: Array) -> None:
    lines = [",".join(f"{value:.5f}" for value in row) for row in rows.tolist()]
    path.write_text("\n".join([HEADER, *lines, ""]))


def _dwells(machine: Machine, random: Random) -> Array:
    """Return samples of standstills, and of dwells at each temperature."""
    order = list(machine.temperatures)
    if random.random() < 0.5:
        order.append(order[0])
    pieces = [(_STANDING, 0.0, 0.0, order[0])]  # samples, belt speed, torque, temperature
    for visit, temperature in enumerate(order):
        if visit:
            warming = np.linspace(order[visit - 1], temperature, 20).tolist()
            pieces += [(6, 0.0, 0.0, passed) for passed in warming]
            pieces.append((30, 0.0, 0.0, temperature))
        belt = machine.unlimited(temperature)
        for speed in machine.speeds[:: -1 if visit % 2 else 1]:
            torque = belt.drag(speed) * machine.radius * math.exp(machine.repeats * random.standard_normal())
            pieces.append((_DWELL, speed, torque, temperature))
    pieces.append((_STANDING // 2, 0.0, 0.0, order[-1]))
    counts = [piece[0] for piece in pieces]
    columns = [np.repeat([float(piece[n]) for piece in pieces], counts) for n in (1, 2, 3)]
    return _sampled(machine, random, _STEP, columns[1], columns[0], columns[2])


def _trace(machine: Machine, random: Random) -> Array:
    """Return samples of starts from rest, between standstills with a relaxed spring."""
    duration = _STRETCH if machine.evidence == "stick-slip" else _START
    still = np.zeros(round(_BEFORE / _FAST_STEP))
    torques, speeds = [still], [still]
    for start in machine.trace:
        torque, speed = _started(machine, start, duration)
        torques += [torque, still]
        speeds += [speed, still]
    torque, speed = np.concatenate(torques), np.concatenate(speeds)
    return _sampled(machine, random, _FAST_STEP, torque, speed, np.full(torque.size, machine.hottest))


def _started(machine: Machine, start: Start, duration: float) -> tuple[Array, Array]:
    """Return torque behind the sensor's bandwidth, and speed of the drive, at each sample of a start."""
    drive = start_drive(start.speed, start.acceleration)
    fine: Array = _FAST_STEP / _FINE * np.arange(1.0, round(duration / _FAST_STEP) * _FINE + 1.0)
    pull = _filtered(recorded(machine.rig, drive, fine), machine.bandwidth, _FAST_STEP / _FINE)
    speed = np.array([drive.piece(time)[0] for time in fine[_FINE - 1 :: _FINE].tolist()])
    return pull[_FINE - 1 :: _FINE] * machine.radius, speed


def _filtered(values: Array, bandwidth: float, step: float) -> Array:
    """Return values behind a low-pass filter of first order that starts at 0."""
    share = -math.expm1(-math.tau * bandwidth * step)
    state, passed = 0.0, []
    for value in values.tolist():
        state += share * (value - state)
        passed.append(state)
    return np.array(passed)


def _sampled(
    machine: Machine, random: Random, step: float, torque: Array, belt_speed: Array, temperature: Array
) -> Array:
    """Return what sensors read of torque, speed and temperature."""
    full = machine.curve.force * machine.radius
    kicks = random.standard_normal(torque.size) * np.maximum(np.abs(torque), _FLOOR * full)
    kicks *= machine.noise * math.sqrt(1.0 - _MEMORY**2)
    error, errors = 0.0, []
    for kick in kicks.tolist():
        error = _MEMORY * error + kick
        errors.append(error)
    rpm = belt_speed / machine.radius * 60.0 / math.tau
    return np.column_stack(
        [
            step * np.arange(torque.size),
            torque + np.array(errors) + _OFFSET * full,
            rpm * (1.0 + 0.002 * random.standard_normal(torque.size)),
            temperature + 0.1 * random.standard_normal(torque.size),
        ]
    )


def machine_file(machine: Machine) -> str:
    """Return the machine file."""
    return "\n".join(
        [*_drivetrain(machine), *_limits(machine), *_uncertainty(machine), *_points(machine), ""]
    )


def _drivetrain(machine: Machine) -> list[str]:
    low, high = machine.stated.stick
    rule = "fixed" if machine.fixed_stick else "with transition"
    return [
        "[drivetrain]",
        f'stiffness = "{machine.stated.stiffness:.8g} N/m"',
        f'mass = "{machine.stated.mass:.8g} kg"',
        f'roll_radius = "{1e3 * machine.radius:.8g} mm"',
        f'stick_speed = "{1e3 * math.sqrt(low * high):.6g} mm/s"',
        f'stick_speed_temperature = "{machine.hottest:.6g} degC"',
        f'stick_speed_rule = "{rule}"',
    ]


def _limits(machine: Machine) -> list[str]:
    if machine.motor is None or machine.grip is None or machine.fastest is None:
        return []
    return [
        "[limits]",
        f'motor_torque = "{machine.motor:.6g} N*m"',
        "roll_friction = 0.5",
        f'nip_load = "{2.0 * machine.grip:.6g} N"',
        f'acceleration = "{machine.acceleration:.6g} m/s^2"',
        f'speed = "{1e3 * machine.fastest:.8g} mm/s"',
    ]


def _uncertainty(machine: Machine) -> list[str]:
    low, high = machine.stated.stick
    stiffness, mass = machine.stated.share
    lines = [
        "[uncertainty]",
        f'stiffness = "{100 * stiffness:.3g} %"',
        f'mass = "{100 * mass:.3g} %"',
        f'stick_speed = "{1e3 * low:.6g} mm/s to {1e3 * high:.6g} mm/s"',
    ]
    if machine.rest:
        lines += ["[rest]", f'torque = "{machine.rest * machine.radius:.6g} N*m"', 'uncertainty = "3 %"']
    return lines


def _points(machine: Machine) -> list[str]:
    return [
        line
        for number, point in enumerate(machine.points)
        for line in (
            "[[points]]",
            f'name = "point {number}"',
            f'speed = "{1e3 * point.speed:.6g} mm/s"',
            f'temperature = "{point.temperature:.6g} degC"',
        )
    ]
