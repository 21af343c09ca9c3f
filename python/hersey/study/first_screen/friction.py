"""The first screen of a log of friction, which states no machine: what friction does, what to record next."""

from __future__ import annotations

from hersey.damping.trend import Trend
from hersey.study.findings import Findings
from hersey.study.first_screen.instruction import Instruction
from hersey.verdict.friction_verdict import friction_finding


def of_friction(known: Findings, trend: Trend) -> Instruction:
    """Return what a log of a friction force or coefficient says, and which dwells would say more."""
    of, (low, high) = known.points.domain, known.surface.speed_range
    further = (
        f"To extend the range, record dwells slower than {of.at(low)} and faster than {of.at(high)}. Whether "
        "a machine with this contact sticks also depends on its stiffness and mass, which this log lacks."
    )
    return Instruction(
        "watch" if trend.falls else "good", friction_finding(known.surface, trend), "", further
    )
