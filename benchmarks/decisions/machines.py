"""Machines drawn at random: a true drag curve, closure, spring and mass, and what the owner states of them.

What is drawn depends only on seed, number and the two choices that the command line offers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from benchmarks.decisions.belt import CLOSURES, Belt, Closure
from benchmarks.decisions.curves import Curve, Random, draw, log_uniform, minimum
from benchmarks.decisions.fold import fold, lasts

#: Kinds of evidence: slow dwells alone, with a stretch of stick-slip, with a set of starts.
EVIDENCE = ("dwells", "stick-slip", "starts")
#: How the drive is limited: amply, not at all, barely, or too little by the truth or by what is stated.
LIMITS = (
    "ample",
    "ample",
    "ample",
    "none",
    "none",
    "tight grip",
    "weak motor",
    "motor in doubt",
    "grip in doubt",
    "slow drive",
)
#: The limits with which every belt can be started.
STARTING = ("ample", "none")
#: Temperatures and speeds of a log.
TEMPERATURES, SPEEDS = 5, 11
#: Factor by which drag may rise where it should fall, and that by which it must fall in all.
_RISE, _FALL = 1.02, 1.03
#: Least and greatest V* over the transition speed.
_FOLDS = (1.005, 25.0)
#: Machines that are drawn before it is a fault.
_ATTEMPTS = 400


@dataclass(frozen=True)
class Point:
    """An operating point: m/s and degC."""

    speed: float
    temperature: float


@dataclass(frozen=True)
class Start:
    """A start from rest in the set of starts: drive speed and acceleration (infinite for a step)."""

    speed: float
    acceleration: float


@dataclass(frozen=True)
class Stated:
    """What the machine file says of uncertain values."""

    stiffness: float
    mass: float
    share: tuple[float, float]  #: uncertainty of both, 95 %
    stick: tuple[float, float]  #: range of the stick speed at the hottest temperature


@dataclass(frozen=True)
class Machine:
    """A machine as it is, and what its owner states; temperatures in degC."""

    radius: float
    curve: Curve  #: at the hottest temperature
    closure: Closure
    stick: float  #: at the hottest temperature
    fixed_stick: bool  #: whether the stick speed is the same at all temperatures
    stiffness: float
    mass: float
    rest: float
    temperatures: tuple[float, ...]
    exponent: float  #: of the transition speed in degC, at the hottest temperature
    arrhenius: bool  #: whether viscosity follows an activation energy, or a power of degC
    stated: Stated
    speeds: tuple[float, ...]
    noise: float  #: of a sample
    repeats: float  #: of a dwell
    acceleration: float
    limits: str = "none"
    motor: float | None = None  #: N m
    grip: float | None = None  #: N
    fastest: float | None = None  #: m/s
    points: tuple[Point, ...] = ()
    evidence: str = "dwells"
    bandwidth: float = math.inf  #: of the torque sensor, Hz
    trace: tuple[Start, ...] = ()

    @property
    def hottest(self) -> float:
        """The temperature at which the transition is fastest."""
        return self.temperatures[-1]

    @cached_property
    def rig(self) -> Belt:
        """The belt at the hottest temperature, without limits of its drive."""
        return self.unlimited(self.hottest)

    def unlimited(self, temperature: float) -> Belt:
        """Return the belt at a temperature, without limits of its drive."""
        shift = self._shift(temperature)
        film = self.curve.at(shift)
        transition = minimum(film, 0.3 * shift * self.curve.speed, 3.0 * self.curve.speed)
        stick = self.stick
        if not self.fixed_stick and temperature != self.hottest:
            stick *= transition / self.curve.speed
        return Belt(film, transition, stick, self.stiffness, self.mass, self.closure, rest=self.rest)

    def at(self, temperature: float) -> Belt:
        """Return the belt at a temperature, with the grip of its roll."""
        belt = self.rig if temperature == self.hottest else self.unlimited(temperature)
        return belt if self.grip is None else replace(belt, grip=self.grip)

    def starts(self, belt: Belt) -> bool:
        """Return whether motor and roll can start a belt from rest."""
        motor = math.inf if self.motor is None else self.motor / self.radius
        return belt.start <= min(motor, belt.grip)

    def _shift(self, temperature: float) -> float:
        """Return the inverse of viscosity, relative to that at the hottest temperature."""
        if not self.arrhenius:
            return math.pow(temperature / self.hottest, self.exponent)
        kelvin = self.hottest + 273.15
        slope = self.exponent * kelvin**2 / self.hottest
        return math.exp(slope * (1.0 / kelvin - 1.0 / (temperature + 273.15)))


@dataclass(frozen=True)
class Kind:
    """Which machines are drawn; ``mixed`` stands for any."""

    evidence: str = "mixed"
    closure: str = "mixed"
    shape: str = "mixed"


def drawn(seed: int, number: int, wanted: Kind) -> Machine:
    """Return one machine; the same for the same arguments."""
    random = np.random.default_rng([seed, number])
    kind, way = str(random.choice(EVIDENCE)), str(random.choice(CLOSURES))
    kind = kind if wanted.evidence == "mixed" else wanted.evidence
    way = way if wanted.closure == "mixed" else wanted.closure
    for _ in range(_ATTEMPTS):
        machine = _drive(random, "stiction" if way == "stiction" else "retained", wanted.shape)
        if not _is_stribeck(machine):
            continue
        upper = fold(machine.rig, 1e-3)
        if not _FOLDS[0] < upper / machine.rig.transition < _FOLDS[1]:
            continue
        machine = _limited(replace(machine, evidence=kind), random, upper)
        if kind == "dwells":
            return machine
        trace = _stretch(machine, random, upper) if kind == "stick-slip" else _starts(machine, random, upper)
        if trace:
            bandwidth = log_uniform(random, 10.0, 20.0) / machine.rig.period
            return replace(machine, trace=trace, bandwidth=bandwidth)
    raise RuntimeError(f"no machine {number} of seed {seed} in {_ATTEMPTS} attempts")


def _drive(random: Random, closure: Closure, shape: str) -> Machine:
    """Draw drag, spring, mass and log; limits and points come later."""
    radius, torque = random.uniform(0.010, 0.030), log_uniform(random, 0.15, 1.5)
    curve = draw(random, torque / radius, log_uniform(random, 0.008, 0.06), shape)
    impedance = curve.force / (log_uniform(random, 0.3, 4.0) * curve.speed)
    frequency = log_uniform(random, 8.0, 60.0)
    rest = random.uniform(0.05, 0.4) * curve.force if random.random() < 0.25 else 0.0
    slowest = curve.speed * log_uniform(random, 0.08, 0.4)
    stick_range = _stick_range(random, slowest, curve.speed)
    stick = log_uniform(random, *stick_range)
    stiffness, mass = impedance * frequency, impedance / frequency
    ends = random.uniform(60.0, 100.0), random.uniform(150.0, 200.0)
    return Machine(
        radius=radius,
        curve=curve,
        closure=closure,
        stick=stick,
        fixed_stick=random.random() < 0.5,
        stiffness=stiffness,
        mass=mass,
        rest=rest,
        temperatures=tuple(np.linspace(*ends, TEMPERATURES).tolist()),
        exponent=random.uniform(1.0, 3.0),
        arrhenius=random.random() < 0.5,
        stated=_stated(random, stiffness, mass, stick_range),
        speeds=tuple(np.geomspace(slowest, random.uniform(5.0, 10.0) * curve.speed, SPEEDS).tolist()),
        noise=random.uniform(0.01, 0.04),
        repeats=log_uniform(random, 0.003, 0.03),
        acceleration=log_uniform(random, 0.5, 5.0) * curve.speed * frequency,
    )


def _stick_range(random: Random, slowest: float, transition: float) -> tuple[float, float]:
    """Draw a range of the stick speed: below the slowest dwell or around it, below the transition."""
    high = min(slowest * log_uniform(random, 0.3, 1.5), 0.7 * transition)
    return high / log_uniform(random, 2.0, 6.0), high


def _stated(random: Random, stiffness: float, mass: float, stick: tuple[float, float]) -> Stated:
    """State spring and mass with an error that is within the uncertainty in 95 % of the machines."""
    shares = tuple(float(share) for share in random.uniform(0.05, 0.10, size=2))
    sigmas = [math.log1p(share) / 1.96 for share in shares]
    errors = [math.exp(sigma * random.standard_normal()) for sigma in sigmas]
    return Stated(stiffness * errors[0], mass * errors[1], (shares[0], shares[1]), stick)


def _is_stribeck(machine: Machine) -> bool:
    """Whether drag falls from the stick speed to the transition and then rises, at every temperature."""
    if machine.stick >= machine.speeds[0]:
        return False
    for temperature in machine.temperatures:
        belt = machine.unlimited(temperature)
        slowest = belt.stick * machine.stated.stick[0] / machine.stick
        if belt.stick > 0.8 * belt.transition:
            return False
        falling = [belt.film(v) for v in np.geomspace(slowest, belt.transition, 60).tolist()]
        rising = [belt.film(v) for v in np.geomspace(belt.transition, 60.0 * belt.transition, 60).tolist()]
        lowest_yet = np.minimum.accumulate(falling)
        if (np.array(falling) > _RISE * lowest_yet).any() or np.diff(rising).min() < 0.0:
            return False
        if belt.film(belt.stick) < _FALL * falling[-1]:
            return False
    return True


def _limited(machine: Machine, random: Random, upper: float) -> Machine:
    """Return the machine with limits about what its start takes, and operating points about V*."""
    belt = machine.rig
    start = belt.start
    stated = math.e * belt.film(math.sqrt(math.prod(machine.stated.stick))) + belt.rest
    limits = str(random.choice(STARTING if machine.evidence != "dwells" else LIMITS))
    motor, grip, fastest = 3.0 * start, 3.0 * start, max(4.0 * upper, 10.0 * belt.transition)
    if limits == "tight grip":
        grip = 1.15 * start
    elif limits == "weak motor":
        motor = float(random.choice([0.8, 1.2])) * start
    elif limits == "motor in doubt":
        motor = math.sqrt(start * stated)
    elif limits == "grip in doubt":
        grip = math.sqrt(start * stated)
    elif limits == "slow drive":
        fastest = max(belt.transition + 0.6 * (upper - belt.transition), 3.0 * belt.transition)
    machine = replace(machine, limits=limits, points=_points(machine, random, upper))
    if limits == "none":
        return machine
    return replace(machine, motor=motor * machine.radius, grip=grip, fastest=fastest)


def _points(machine: Machine, random: Random, upper: float) -> tuple[Point, ...]:
    """Draw operating points below the transition, between it and V*, about V* and above."""
    turn = machine.rig.transition
    between = turn + random.uniform(0.2, 0.8) * (upper - turn)
    speeds = [0.7 * turn, between, 1.1 * upper, random.uniform(1.5, 3.0) * upper]
    chosen = random.choice(speeds, int(random.integers(0, 4)), replace=False).tolist()
    anywhere = [machine.temperatures[int(random.integers(TEMPERATURES))] for _ in chosen]
    return tuple(
        Point(speed, machine.hottest if random.random() < 2 / 3 else temperature)
        for speed, temperature in zip(chosen, anywhere, strict=True)
    )


def _stretch(machine: Machine, random: Random, upper: float) -> tuple[Start, ...]:
    """Draw a drive speed at which the belt sticks and slips."""
    belt = machine.rig
    for _ in range(10):
        speed = random.uniform(0.4 * belt.transition, 0.95 * upper)
        if speed > 2.0 * belt.stick and lasts(belt, speed):
            return (Start(speed, math.inf),)
    return ()


def _starts(machine: Machine, random: Random, upper: float) -> tuple[Start, ...]:
    """Draw three to five starts to speeds on both sides of V*, all by a step or all by a ramp."""
    acceleration = math.inf if random.random() < 0.5 else machine.acceleration
    below, above = upper * log_uniform(random, 0.55, 0.97), upper * log_uniform(random, 1.03, 1.8)
    others = [upper * log_uniform(random, 0.55, 1.8) for _ in range(int(random.integers(1, 4)))]
    speeds = sorted([below, above, *others])
    if speeds[0] < 2.0 * machine.rig.stick:
        return ()
    return tuple(Start(speed, acceleration) for speed in speeds)
