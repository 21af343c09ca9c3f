"""What is asked of failures at once: the law, one specimen, a fleet, when to replace, and the next test."""

from __future__ import annotations

from dataclasses import dataclass

from hersey.life.failures.forecast import FleetForecast, RemainingLife
from hersey.life.failures.law import FailureLaw
from hersey.life.failures.test_plan import LifeTestPlan
from hersey.life.replacement import Replacement
from hersey.result import Record


@dataclass(frozen=True)
class FailureAnswers(Record):
    """The law of failures, and what follows from it as far as it was asked."""

    law: FailureLaw | None
    remaining: RemainingLife | None
    forecast: FleetForecast | None
    replacement: Replacement | None
    plan: LifeTestPlan | None
