"""What to do, in the document: the instruction, its signal, and what stands against it."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.damping.design import TestDesign
from hersey.decision.edges import Edge
from hersey.schema.part import Numbers, Part, Sentences
from hersey.schema.record import part_of
from hersey.schema.warning import Warning
from hersey.stability.disturbance import Disturbance, SafeStep
from hersey.stability.plan.result import Plan

#: Good: nothing to do. Watch: it depends, or a number is not sure. Act: something does not work as it is.
Signal = Literal["good", "watch", "act"]


class StartPart(Part):
    """A start as the plan has it, and straight up beside it: times in s, speeds in m/s, shape (samples,)."""

    time: Numbers
    drive_speed: Numbers
    belt_speed: Numbers
    straight: Numbers = Field(description="speed if the drive goes straight to the point")


class PointDecisionPart(Part):
    """An operating point of the machine file: speed in m/s, temperature in K."""

    name: str
    speed: float
    temperature: float
    signal: Signal
    words: str = Field(description="e.g. 'smooth from any start (sticks: under 1 %)'")
    brief: str = Field(default="", description="the verdict in a few words, e.g. 'smooth from any start'")
    verdict: Literal["smooth", "depends", "sticks", "not started", "stalls", "too fast", "unknown"] = Field(
        default="unknown", description="'smooth' is from any start; 'depends' on how the speed is reached"
    )
    smooth: float | None = Field(default=None, description="probability: smooth from any start")
    from_above: float | None = Field(
        default=None, description="probability: smooth only if already sliding, or if started by the profile"
    )
    sticks: float | None = Field(default=None, description="probability: sticks from any start")
    disturbance: Disturbance | None = Field(default=None, description="disturbance that sliding withstands")
    steps: list[SafeStep] = Field(default=[], description="steps from the other points to this one")
    plan: Plan | None = Field(default=None, description="start-up profile, if a direct start may fail")
    motion: StartPart | None = Field(
        default=None, description="motion under the profile, with nominal parameters"
    )
    reason: Sentences = Field(default="", description="why a profile or a number is missing")


class MissingPart(Part):
    """What would let the report say more: lines to add to a file."""

    purpose: str = Field(description="what the report would add")
    file: str
    lines: str = Field(description="TOML to copy; the user's values are named in comments")


class MeasurementPart(Part):
    """The measurement that would narrow V* most."""

    kind: Literal["starts", "break-away", "stick-slip", "dwell"]
    text: Sentences = Field(description="what to do, and what it would bring")
    temperature: float | None = Field(description="K")
    speeds: Numbers = Field(description="m/s, of starts, of a dwell or of a stretch of stick-slip")
    left: float = Field(
        description="expected width of the interval of V*, relative to the present one, in logarithms"
    )


class DecisionPart(Part):
    """The first screen of the report."""

    signal: Signal
    instruction: Sentences = Field(description="one imperative sentence, on the safe side")
    interval: Sentences = Field(description="estimate and 95 % interval behind the instruction; may be empty")
    otherwise: Sentences = Field(description="what happens otherwise")
    next: Sentences = Field(
        default="", description="what to do next; empty where the instruction or ``otherwise`` says it"
    )
    temperature: float | None = Field(default=None, description="K, at which the safe speed and V* hold")
    safe_speed: float | None = Field(
        default=None, description="m/s; above it it is smooth from any start with 97.5 % probability"
    )
    fold: Edge | None = Field(default=None, description="V*")
    closures: dict[str, float] = Field(default={}, description="probability of each closure")
    measurement: MeasurementPart | None = None
    points: list[PointDecisionPart]
    flags: list[Warning] = Field(
        description="at most three, the most serious first; ``where`` is a section of the page"
    )
    missing: list[MissingPart]


class DesignPart(part_of(TestDesign)):  # type: ignore[misc]  # made as it runs
    """The next dwells, or measurements that narrow V*, in the order of their worth."""

    fold: Edge | None = Field(default=None, description="V* of the stated machine, m/s")
    measurements: list[MeasurementPart] = Field(default=[], description="measurements that would narrow V*")
