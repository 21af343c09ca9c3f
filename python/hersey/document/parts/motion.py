"""Motion in the document: in SI, or in the units of the arguments."""

from __future__ import annotations

from pydantic import Field

from hersey.machine.motor import MotorUse
from hersey.motion.simulation import StickSlipCycle
from hersey.motion.trajectory import Energy, SelfCheck, Trajectory
from hersey.schema.part import Part
from hersey.schema.record import part_of


class SweepPart(Part):
    """How many sets of a sweep have each outcome, and the range of numbers of those that stick and slip."""

    sets: int
    kinds: dict[str, int]
    stick_slip: dict[str, tuple[float, float]]
    failures: list[str]


class StickSlipPart(part_of(StickSlipCycle)):  # type: ignore[misc]  # made as it runs
    """What a motion settles to, with the energies of a run from the start if one was asked for."""

    energy: Energy | None = None
    check: SelfCheck | None = None
    motor: MotorUse | None = None
    warming: Trajectory | None = Field(
        default=None, description="run with temperature as a state; the rest describes its end"
    )
