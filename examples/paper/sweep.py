"""What the paper varies about its baseline, the cycles along it, and their trends."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag
from hersey.motion.simulation import StickSlipCycle, simulate, stick_slip
from hersey.motion.trajectory import Trajectory

#: Values per sweep, spaced evenly in logarithms so that every ratio counts alike.
VALUES = 61
#: Samples of a trace per second.
RATE = 1000


@dataclass(frozen=True)
class Case:
    """The paper's baseline or a change to it: k (ozf/in), B0 (ozf at 1 in/s), v2 and v_s (in/s)."""

    stiffness: float = 1000.0
    damping: float = 50.0
    drive_speed: float = 1.0
    stick_speed: float = 0.01

    @property
    def train(self) -> Drivetrain:
        """The spring, and the belt of unit mass (ozf s2/in)."""
        return Drivetrain(self.stiffness, 1.0)

    @property
    def drag(self) -> Drag:
        """The drag, with the exponents that the paper measured and leaves alone."""
        return Drag(self.damping, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=self.stick_speed)

    def cycle(self) -> StickSlipCycle:
        """What the motion settles to from rest."""
        return stick_slip(self.train, self.drag, drive_speed=self.drive_speed)

    def run(self, duration: float) -> Trajectory:
        """The motion from rest."""
        samples = round(duration * RATE) + 1
        return simulate(
            self.train, self.drag, drive_speed=self.drive_speed, duration=duration, samples=samples
        )


@dataclass(frozen=True)
class Parameter:
    """What a figure varies: a field of `Case`, its symbol, unit and axis, the values drawn as traces."""

    field: str
    symbol: str
    unit: str
    axis: str
    traced: tuple[float, float, float]
    ticks: tuple[float, ...]

    def case(self, value: float) -> Case:
        """Return the baseline but for this value."""
        return replace(Case(), **{self.field: value})

    def of(self, value: float) -> str:
        """Return the value with its symbol and unit."""
        return f"{self.symbol} = {value:g} {self.unit}"


STIFFNESS = Parameter(
    "stiffness", "k", "ozf/in", "Stiffness k (ozf/in)", (500, 1000, 2000), (500, 700, 1000, 1400, 2000)
)
DAMPING = Parameter(
    "damping", "B0", "ozf", "Damping constant B0 (ozf at 1 in/s)", (25, 50, 100), (25, 35, 50, 70, 100)
)
DRIVE_SPEED = Parameter(
    "drive_speed", "v2", "in/s", "Drive speed v2 (in/s)", (0.4, 1.0, 1.6), (0.4, 0.6, 0.8, 1.0, 1.3, 1.6)
)


@dataclass(frozen=True)
class Trend:
    """A positive quantity along a sweep: its ends, its power law, and whether it is monotone.

    ``exponent`` is p of ``y = c x^p`` by least squares in logarithms; the local p lie from low to high.
    """

    first: float
    last: float
    exponent: float
    exponent_low: float
    exponent_high: float
    rises: bool
    falls: bool

    @property
    def factor(self) -> float:
        """Last value over first."""
        return self.last / self.first

    def numbers(self, name: str) -> dict[str, float]:
        """Return its numbers, named after the quantity."""
        return {
            f"{name}_first": self.first,
            f"{name}_last": self.last,
            f"{name}_factor": self.factor,
            f"{name}_exponent": self.exponent,
            f"{name}_exponent_low": self.exponent_low,
            f"{name}_exponent_high": self.exponent_high,
        }


def trend_of(x: FloatArray, y: FloatArray) -> Trend:
    """Return the trend of y along x; of nan if there are not two values."""
    if x.size < 2:
        return Trend(math.nan, math.nan, math.nan, math.nan, math.nan, rises=False, falls=False)
    steps = np.diff(np.log(y))
    local = steps / np.diff(np.log(x))
    return Trend(
        first=float(y[0]),
        last=float(y[-1]),
        exponent=float(np.polyfit(np.log(x), np.log(y), 1)[0]),
        exponent_low=float(local.min()),
        exponent_high=float(local.max()),
        rises=bool((steps > 0).all()),
        falls=bool((steps < 0).all()),
    )


@dataclass(frozen=True)
class Sweep:
    """Cycles along a parameter: those of the values ``asked`` that end in stick-slip."""

    parameter: Parameter
    asked: int
    value: FloatArray
    cycles: tuple[StickSlipCycle, ...]

    @property
    def frequency(self) -> FloatArray:
        """Laps per second."""
        return np.array([cycle.frequency for cycle in self.cycles])

    @property
    def slip_speed(self) -> FloatArray:
        """Greatest belt speed (in/s)."""
        return np.array([cycle.speed_max for cycle in self.cycles])

    @property
    def stuck_fraction(self) -> FloatArray:
        """Share of the time stuck."""
        return np.array([cycle.stuck_fraction for cycle in self.cycles])

    def trend(self, y: FloatArray) -> Trend:
        """Return the trend of a quantity along the sweep."""
        return trend_of(self.value, y)

    def table(self) -> dict[str, tuple[float, ...]]:
        """Return its columns, named with their units."""
        return {
            f"{self.parameter.field} ({self.parameter.unit})": tuple(self.value.tolist()),
            "frequency (Hz)": tuple(self.frequency.tolist()),
            "greatest belt speed (in/s)": tuple(self.slip_speed.tolist()),
            "stuck fraction": tuple(self.stuck_fraction.tolist()),
        }


def sweep_over(parameter: Parameter, case_of: Callable[[float], Case] | None = None) -> Sweep:
    """Sweep between the outer values traced; ``case_of`` makes the case of a value, if not the plain one."""
    low, _, high = parameter.traced
    values = [float(value) for value in np.geomspace(low, high, VALUES)]
    settled = [(value, (case_of or parameter.case)(value).cycle()) for value in values]
    kept = [(value, cycle) for value, cycle in settled if cycle.kind == "stick_slip"]
    return Sweep(
        parameter, len(values), np.array([value for value, _ in kept]), tuple(cycle for _, cycle in kept)
    )
