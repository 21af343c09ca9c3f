"""Machines drawn at random: the law of their drag, what their owner states of them, and a log of theirs.

What is stated is off by what is stated as its uncertainty at the most. A log is plain (ten speeds and more,
little noise) or poor (six to eight, much), so that some hold the falling branch by few dwells or none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.decisions.belt import Belt, fold

#: How the drive is limited: amply, not at all, barely, too little by the truth or by what is stated.
LIMITS = (
    "ample",
    "ample",
    "none",
    "tight grip",
    "weak motor",
    "motor in doubt",
    "grip in doubt",
    "slow drive",
)
#: Seconds between samples, samples of a dwell, of a standstill.
_STEP, _DWELL, _STANDING = 0.2, 60, 120
_ROOM = 25.0


@dataclass(frozen=True)
class Point:
    """An operating point: m/s, degC (None where temperature plays no part)."""

    speed: float
    temperature: float | None


@dataclass(frozen=True)
class Machine:
    """A machine as it is, and what its owner states."""

    radius: float
    belt: Belt  #: at ``reference``
    reference: float  #: degC
    by_temperature: float  #: exponent of the transition speed in degC there; 0 if it does not vary
    arrhenius: bool  #: how it goes elsewhere: by an activation energy, or as a power of degC
    fixed_stick: bool
    stated_stick: tuple[float, float, float]  #: middle, low, high
    stated_spring: tuple[float, float]  #: stiffness, mass
    doubt: tuple[float, float]  #: of both
    temperatures: tuple[float | None, ...]
    limits: str
    motor: float | None  #: N m
    grip: float | None  #: N
    fastest: float | None  #: m/s
    acceleration: float
    points: tuple[Point, ...]
    speeds: tuple[float, ...]
    noise: float  #: of a sample
    repeats: float  #: of a dwell
    poor: bool

    def at(self, temperature: float | None) -> Belt:
        """Return the belt at a temperature, its grip left as it is."""
        belt = self.belt
        turn = self._transition(temperature)
        stick = belt.stick if self.fixed_stick else belt.stick * turn / belt.transition
        grip = math.inf if self.grip is None else self.grip
        return Belt(
            belt.force,
            turn,
            belt.rising,
            belt.falling,
            min(stick, 0.9 * turn),
            belt.stiffness,
            belt.mass,
            grip,
            belt.rest,
        )

    def _transition(self, temperature: float | None) -> float:
        return _moved(self.belt.transition, temperature, self.reference, self.by_temperature, self.arrhenius)

    @property
    def hottest(self) -> float | None:
        """The temperature at which the transition is fastest."""
        return self.temperatures[-1]


def drawn(seed: int, number: int) -> Machine:
    """Return one machine; the same for the same seed and number."""
    random = np.random.default_rng([seed, number])
    thermal, poor = random.random() > 1 / 6, random.random() < 0.4
    radius, torque = random.uniform(0.010, 0.030), _between(random, 0.15, 1.5)
    turn, rest = _between(random, 0.008, 0.06), 0.0
    if random.random() < 1 / 3:
        rest = torque * random.uniform(0.05, 0.4) / radius
    stiff = torque / radius / (_between(random, 0.3, 4.0) * turn)
    quick, stick = _between(random, 8.0, 60.0), turn * _between(random, 0.015, 0.2)
    belt = Belt(
        torque / radius,
        turn,
        random.uniform(0.25, 0.5),
        -random.uniform(0.15, 0.9),
        stick,
        stiff * quick,
        stiff / quick,
        rest=rest,
    )
    spread = _between(random, 1.2, 3.0)
    middle = stick / spread ** random.uniform(-0.95, 0.95)
    doubt = float(random.choice([0.05, 0.1, 0.2])), float(random.choice([0.0, 0.1]))
    spring = tuple(
        value * (1.0 + share) ** random.uniform(-0.95, 0.95)
        for value, share in zip((belt.stiffness, belt.mass), doubt, strict=True)
    )
    temperatures: tuple[float | None, ...] = (None,)
    if thermal:
        ends = random.uniform(60.0, 100.0), random.uniform(150.0, 200.0)
        temperatures = tuple(np.linspace(*ends, int(random.integers(3, 5))).tolist())
    reference, by, arrhenius = random.uniform(140.0, 180.0), random.uniform(1.0, 3.0), random.random() < 0.25
    by = by if thermal else 0.0
    turns = [_moved(turn, t, reference, by, arrhenius) for t in temperatures]
    machine = Machine(
        radius=radius,
        belt=belt,
        reference=reference,
        by_temperature=by,
        arrhenius=arrhenius,
        fixed_stick=thermal and random.random() < 0.2,
        stated_stick=(middle, middle / spread, middle * spread),
        stated_spring=(spring[0], spring[1]),
        doubt=doubt,
        temperatures=temperatures,
        limits="none",
        motor=None,
        grip=None,
        fastest=None,
        acceleration=_between(random, 5.0, 50.0) * turn * quick / 10.0,
        points=(),
        speeds=_speeds(random, turns, poor=poor),
        noise=float(random.choice([0.04, 0.08] if poor else [0.01, 0.02, 0.04])),
        repeats=float(random.choice([0.015, 0.03] if poor else [0.003, 0.008, 0.015])),
        poor=poor,
    )
    return _limited(machine, random)


def _limited(machine: Machine, random: np.random.Generator) -> Machine:
    """The machine with limits about what its start takes, and operating points about its band."""
    hot = machine.at(machine.hottest)
    upper, start = fold(hot, 1e-3), hot.start
    stated = hot.hold * (machine.stated_stick[0] / machine.belt.stick) ** hot.falling + hot.rest
    limits = str(random.choice(LIMITS))
    motor, grip, fastest = 3.0 * start, 3.0 * start, max(4.0 * upper, 10.0 * hot.transition)
    if limits == "tight grip":
        grip = 1.15 * start
    elif limits == "weak motor":
        motor = float(random.choice([0.8, 1.2])) * start
    elif limits == "motor in doubt":
        motor = math.sqrt(start * stated)
    elif limits == "grip in doubt":
        grip = math.sqrt(start * stated)
    elif limits == "slow drive":
        fastest = max(hot.transition + 0.6 * (upper - hot.transition), 3.0 * hot.transition)
    between = hot.transition + random.uniform(0.2, 0.8) * (upper - hot.transition)
    speeds = [0.7 * hot.transition, between, 1.1 * upper, random.uniform(1.5, 3.0) * upper]
    count = int(random.integers(0, 4))
    chosen = random.choice(speeds, count, replace=False)
    points = []
    for speed in chosen:
        anywhere = machine.temperatures[int(random.integers(len(machine.temperatures)))]
        points.append(Point(float(speed), machine.hottest if random.random() < 2 / 3 else anywhere))
    told = replace(machine, limits=limits, points=tuple(points))
    if limits == "none":
        return told
    return replace(told, motor=motor * machine.radius, grip=grip, fastest=fastest)


def _speeds(random: np.random.Generator, turns: list[float], *, poor: bool) -> tuple[float, ...]:
    """Belt speeds of the dwells, the same at each temperature."""
    cold, hot = turns[0], turns[-1]
    if poor:
        ends = random.uniform(0.25, 0.6) * hot, 6.0 * hot
        return tuple(np.geomspace(*ends, int(random.integers(6, 9))).tolist())
    middle = math.sqrt(cold * hot)
    ends = min(0.4 * middle, 1.2 * cold), max(8.0 * middle, 5.0 * hot)
    return tuple(np.geomspace(*ends, int(random.integers(10, 13))).tolist())


def _moved(turn: float, temperature: float | None, reference: float, by: float, arrhenius: bool) -> float:
    """The transition speed at a temperature; both laws have the same slope at the reference."""
    if temperature is None:
        return turn
    if not arrhenius:
        return turn * math.pow(temperature / reference, by)
    kelvin = reference + 273.15
    return turn * math.exp(by * kelvin**2 / reference * (1.0 / kelvin - 1.0 / (temperature + 273.15)))


def _between(random: np.random.Generator, low: float, high: float) -> float:
    return math.exp(random.uniform(math.log(low), math.log(high)))


def write(machine: Machine, folder: Path, random: np.random.Generator) -> tuple[Path, Path]:
    """Write the log and the file of a machine."""
    log, file = folder / "log.csv", folder / "machine.toml"
    heads = ["Time [s]", "Drive torque [N*m]", "Drive speed [rpm]", "Heater temperature [degC]"]
    rows = _recorded(machine, random)
    if machine.hottest is None:
        heads, rows = heads[:3], rows[:, :3]
    lines = [",".join(f"{value:.5f}" for value in row) for row in rows.tolist()]
    log.write_text("\n".join([",".join(heads), *lines, ""]))
    file.write_text(_stated(machine))
    return log, file


def _recorded(machine: Machine, random: np.random.Generator) -> NDArray[np.float64]:
    """Samples of time, torque, speed (rpm) and temperature: standstills, and dwells at each temperature."""
    pieces: list[tuple[int, float, float, float | None]] = []  # samples, belt speed, torque, temperature
    order = list(machine.temperatures)
    if len(order) > 1 and random.random() < 0.5:
        order.append(order[0])
    pieces.append((_STANDING, 0.0, 0.0, order[0]))
    for visit, temperature in enumerate(order):
        before = order[visit - 1] if visit else temperature
        if temperature is not None and before is not None and visit:
            pieces += [
                (6, 0.0, 0.0, before + share * (temperature - before)) for share in np.linspace(0, 1, 20)
            ]
            pieces.append((30, 0.0, 0.0, temperature))
        belt, speeds = machine.at(temperature), machine.speeds[:: -1 if visit % 2 else 1]
        for speed in speeds:
            torque = belt.drag(speed) * machine.radius * math.exp(machine.repeats * random.standard_normal())
            pieces.append((_DWELL, speed, torque, temperature))
    pieces.append((_STANDING // 2, 0.0, 0.0, order[-1]))
    full = machine.belt.force * machine.radius
    error, of_torque = 0.0, list[float]()
    of_speed, of_heat = list[NDArray[np.float64]](), list[NDArray[np.float64]]()
    for samples, at, level, warm in pieces:
        for kick in random.standard_normal(samples).tolist():
            error = 0.5 * error + 0.8 * kick * machine.noise * max(level, 0.02 * full)
            of_torque.append(level + error + 0.003 * full)
        rpm = at / machine.radius * 60.0 / math.tau
        of_speed.append(rpm * (1.0 + 0.002 * random.standard_normal(samples)))
        of_heat.append((_ROOM if warm is None else warm) + 0.1 * random.standard_normal(samples))
    time = _STEP * np.arange(len(of_torque))
    others = [np.concatenate(each) for each in (of_speed, of_heat)]
    return np.column_stack([time, np.array(of_torque), *others])


def _stated(machine: Machine) -> str:
    """The machine file."""
    middle, low, high = (f'"{1e3 * value:.6g} mm/s' for value in machine.stated_stick)
    stiffness, mass = machine.stated_spring
    lines = [
        "[drivetrain]",
        f'stiffness = "{stiffness:.8g} N/m"',
        f'mass = "{mass:.8g} kg"',
        f'roll_radius = "{1e3 * machine.radius:.8g} mm"',
        f'stick_speed = {middle}"',
    ]
    if machine.hottest is not None:
        rule = "fixed" if machine.fixed_stick else "with transition"
        lines += [
            f'stick_speed_temperature = "{machine.reference:.6g} degC"',
            f'stick_speed_rule = "{rule}"',
        ]
    if machine.motor is not None and machine.grip is not None and machine.fastest is not None:
        lines += [
            "[limits]",
            f'motor_torque = "{machine.motor:.6g} N*m"',
            "roll_friction = 0.5",
            f'nip_load = "{2.0 * machine.grip:.6g} N"',
            f'acceleration = "{machine.acceleration:.6g} m/s^2"',
            f'speed = "{1e3 * machine.fastest:.8g} mm/s"',
        ]
    lines += [
        "[uncertainty]",
        f'stiffness = "{100 * machine.doubt[0]:g} %"',
        f'stick_speed = {low} to {high[1:]}"',
    ]
    if machine.doubt[1]:
        lines.append(f'mass = "{100 * machine.doubt[1]:g} %"')
    if machine.belt.rest:
        lines += ["[rest]", f'torque = "{machine.belt.rest * machine.radius:.6g} N*m"', 'uncertainty = "3 %"']
    for number, point in enumerate(machine.points):
        warm = _ROOM if point.temperature is None else point.temperature
        lines += [
            "[[points]]",
            f'name = "point {number}"',
            f'speed = "{1e3 * point.speed:.6g} mm/s"',
            f'temperature = "{warm:.5g} degC"',
        ]
    return "\n".join([*lines, ""])
