"""The friction of a moving log: the numbers, without the log and what was made of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from hersey.arrays import FloatArray
from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.estimate import Estimate
from hersey.damping.friction_curve.fitted import DirectionTest
from hersey.damping.friction_curve.law import FrictionLaw
from hersey.damping.moving.gravity import AMPLITUDE
from hersey.damping.moving.misfit import Misfit
from hersey.result import Means, Record
from hersey.units import rpm


@dataclass(frozen=True)
class MovingParameter(Record):
    """A number of the law; the names of one direction end in + (forward) or - (reverse)."""

    name: Annotated[str, Means("T_C, T_S, w_S, k_v, s, J, offset, G, q_0 or delay")]
    unit: Annotated[str, Means("SI")]
    estimate: Annotated[Estimate, Means("with its interval at 95 %")]


@dataclass(frozen=True)
class LawTried(Record):
    """A law that was fitted."""

    name: str
    numbers: Annotated[int, Means("how many are fitted")]
    delta_aicc: Annotated[float, Means("AICc above the least")]
    determined: Annotated[bool, Means("whether all of its numbers can be determined")]


@dataclass(frozen=True)
class Moments(Record):
    """Some of the moments to which a law is fitted: friction alone, without inertia and offset."""

    speed: Annotated[FloatArray, Means("", "rad/s")]
    torque: Annotated[FloatArray, Means("with the sign of the speed", "N m")]


@dataclass(frozen=True, repr=False)
class MovingFriction(Record):
    """Friction, inertia, gravity and offset of a log that moves all the time, with what was used of it."""

    not_stated: ClassVar[tuple[str, ...]] = ("friction_law", "values", "covariance", "moments")
    also_stated: ClassVar[tuple[str, ...]] = ("cost",)

    law: Annotated[str, Means("law of friction that was chosen")]
    parameters: Annotated[
        tuple[MovingParameter, ...], Means("friction first, then inertia, offset, gravity, delay")
    ]
    inertia_given: Annotated[float | None, Means("moment of inertia if it was given", "kg m^2")]
    laws: Annotated[tuple[LawTried, ...], Means("all laws, the simplest first")]
    directions: Annotated[DirectionTest | None, Means("null where one direction was measured")]
    bandwidth: Annotated[float, Means("frequency above which the low-pass halves power", "Hz")]
    used: Annotated[float, Means("share of the log that is used")]
    near_standstill: Annotated[float, Means("share of the log that is slower than least_speed")]
    least_speed: Annotated[float, Means("slower rows are not used: presliding, or sign unsure", "rad/s")]
    speed_range: Annotated[tuple[float, float], Means("least and greatest speed used", "rad/s")]
    temperature_range: Annotated[tuple[float, float] | None, Means("least and greatest", "K")]
    scatter: Annotated[float, Means("standard deviation of what the law leaves, within bandwidth", "N m")]
    explained: Annotated[
        float, Means("share of the mean square of the torque, without inertia, that the law explains")
    ]
    effective_rows: Annotated[float, Means("independent moments")]
    misfit: Annotated[Misfit | None, Means("how friction departs from the law; null if it does not")]
    angle_recorded: Annotated[bool, Means("whether q is a position in the log, or counted from its start")]
    friction_law: FrictionLaw
    values: FloatArray  #: of that law, SI
    covariance: FloatArray  #: of these
    moments: Moments

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the intervals."""
        return self.parameters[0].estimate.freedom

    @property
    def named(self) -> str:
        """The law in words, or that none fits."""
        if self.misfit is None:
            return self.law
        share, at = 100.0 * abs(self.misfit.share), rpm(abs(self.misfit.speed))
        return f"No law of friction fits. The nearest is off by {share:.2g} % near {at:.2g} rpm: {self.law}"

    def gravity_in_words(self) -> str:
        """Return what G and q_0 are; empty without gravity."""
        if all(each.name != AMPLITUDE for each in self.parameters):
            return ""
        angle = "the position in the log" if self.angle_recorded else "counted from the start of the log"
        return f"Gravity takes G sin(q - q_0): the load hangs at rest at q_0; the angle q is {angle}."

    def cost(self) -> str:
        """Return a sentence on what the filter and standstill cost."""
        return (
            f"{100 * self.used:.0f} % of the log used, below {self.bandwidth:.2g} Hz; "
            f"{100 * self.near_standstill:.0f} % is slower than {rpm(self.least_speed):.2g} rpm, where "
            "friction before sliding and the sign of speed are unsure."
        )


@dataclass(frozen=True, repr=False)
class MovingPoints(SteadyPoints):
    """Windows of a moving log as steady points, with the ``friction`` that was fitted to every sample."""

    friction: MovingFriction = field(kw_only=True)
