"""Each percentage of the first screen is the share that its words name; all shares differ here."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hersey.decision.behaviour import Behaviour
from hersey.decision.judge import Verdict
from hersey.posterior.result import PointProbability
from hersey.study.first_screen.advice import _within_ratio
from tests.document.conftest import Decide


def test_a_smooth_point_says_how_likely_it_sticks(decide: Decide, found: Behaviour) -> None:
    """From rest it sticks where it depends on the start, and where it always sticks."""
    chances = PointProbability(smooth=0.85, from_above=0.04, sticks=0.03, stalls=0.06, unknown=0.02)
    point = replace(found.points[2], verdict=Verdict("smooth", chances, starts=0.99, bears=0.98), plan=None)
    (said,) = decide(replace(found, points=(point,))).points
    assert said.words == "smooth from any start (sticks: 7 %)"


def test_a_planned_point_says_both_chances(decide: Decide, found: Behaviour) -> None:
    chances = PointProbability(smooth=0.02, from_above=0.8, sticks=0.11, stalls=0.05, unknown=0.02)
    plan = found.points[1].plan
    assert plan is not None
    point = replace(
        found.points[1],
        verdict=Verdict("depends", chances, starts=1.0, bears=0.98),
        plan=replace(plan, share=0.93),
    )
    (said,) = decide(replace(found, points=(point,))).points
    assert said.words == "needs the start-up profile: sticks without it (91 %), slides with it (93 %)"


@pytest.mark.parametrize(("starts", "promised"), [(0.98, True), (0.97, False), (0.5, False)])
def test_a_start_that_may_fail_is_not_promised(
    starts: float, promised: bool, decide: Decide, found: Behaviour
) -> None:
    """The profile brings a belt to slide that the drive breaks away, and no other."""
    chances = PointProbability(smooth=0.02, from_above=0.8, sticks=0.11, stalls=0.05, unknown=0.02)
    verdict = Verdict("unknown", chances, starts=starts, bears=0.98)
    decided = decide(replace(found, points=(replace(found.points[1], verdict=verdict),)))
    headline, (said,) = decided.instruction, decided.points
    assert ("needs the start-up profile" in headline) == promised
    assert ("needs the start-up profile" in said.words) == promised
    assert ("may not start, or may stick" in headline) != promised
    chance = f"may not start ({100 * (1 - starts):.0f} %) or may stick (91 %)"
    assert (chance in said.words) != promised


@pytest.mark.parametrize(("ratio", "said"), [(1.21, "within about 10 %"), (1.5625, "within about 25 %")])
def test_half_the_width_of_an_interval_is_the_root_of_its_ratio(ratio: float, said: str) -> None:
    assert _within_ratio(ratio) == said
