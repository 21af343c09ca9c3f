"""Plans whose temperature a heater and the plan itself make."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import hersey
from hersey import Drivetrain, HeatBalance, simulate
from hersey.errors import ParameterError
from hersey.machine.limits import Limits
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.plan import Plan, plan_profile
from hersey.stability.plan.proof import Proof, Unknown
from hersey.stability.plan.trial import Follow, MachineSample, Shape, TemperatureProfile, outcomes
from hersey.stability.plan.warming import apart, course_of
from hersey.stability.warm_up import warm_up
from tests.machines import machine_of

TRAIN = Drivetrain(11e3, 11.0)
DRAG = hersey.Drag(50, 0.01, -0.7, -1.2, 3e-4, reference_temperature=400.0, force_temperature_exponent=-4.0)
HEAT = HeatBalance(150, 250, 12, 300.0, 300.0, 300.0, heater_power=900.0, setpoint=450.0)
#: The drive goes straight up or not at all, so that a search is quick.
LIMITS = Limits(speed=0.12, acceleration=0.5, spring_force=250.0)


@pytest.fixture(scope="module", autouse=True)
def _short_search() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hersey.stability.plan.search._TRIES", 4)
        patch.setattr("hersey.stability.plan.search._RANDOM", 20)
        patch.setattr("hersey.stability.plan.search._STEPS", (0.15, 0.01))
        yield


@pytest.fixture(scope="module")
def plan() -> Plan:
    return plan_profile(machine_of(TRAIN, limits=LIMITS), DRAG, target_speed=0.12, temperature=HEAT)


def test_a_cold_belt_is_waited_for(plan: Plan) -> None:
    """The motor cannot start the cold belt: under the plan it does, and some seconds sooner it does not."""
    assert plan.found
    assert plan.wait > 10.0
    assert plan.schedule is not None
    gripping = replace(TRAIN, grip=250.0)
    for sooner, slips in ((0.0, False), (5.0, True)):
        drive = hersey.Schedule([0.0, *(np.asarray(plan.schedule.times)[1:] - sooner)], plan.schedule.values)
        run = simulate(gripping, DRAG, drive_speed=drive, temperature=HEAT, duration=plan.duration + 2.0)
        assert any(event.guard == "grip_lost" for event in run.events) == slips
    assert run.events
    warm = warm_up(TRAIN, DRAG, HEAT, target_speed=0.12, force_limit=250.0, acceleration=0.5, margin=0.0)
    assert warm.full_speed_standing < plan.duration  # breaking away takes more than steady sliding


def test_the_course_is_that_of_the_plan_itself(plan: Plan) -> None:
    assert plan.course is not None
    assert plan.schedule is not None
    run = simulate(TRAIN, DRAG, drive_speed=plan.schedule, temperature=HEAT, duration=60.0, samples=601)
    assert run.film_temperature is not None
    said = [plan.course.at(t) for t in run.time.tolist()]
    np.testing.assert_allclose(run.film_temperature, said, atol=0.05 + 0.02)
    assert apart(plan.course, course_of(TRAIN, DRAG, HEAT)) > 0.3  # friction warms it, too
    assert "film: 26.85 degC initially" in plan.summary()
    assert plan.to_dict()["temperature"] == pytest.approx(plan.course.at(1e9))


def test_what_no_warmth_mends_is_named() -> None:
    limits = replace(LIMITS, spring_force=150.0)
    found = plan_profile(machine_of(TRAIN, limits=limits), DRAG, target_speed=0.12, temperature=HEAT)
    assert [obstacle.limit for obstacle in found.obstacles] == ["spring_force"]
    weak = replace(HEAT, heater_power=0.0, setpoint=None)
    cold = plan_profile(machine_of(TRAIN, limits=LIMITS), DRAG, target_speed=0.12, temperature=weak)
    assert [obstacle.limit for obstacle in cold.obstacles] == ["spring_force"]
    assert cold.obstacles[0].needed is not None
    assert cold.obstacles[0].needed > 400.0


def test_a_trial_with_heat_is_the_motion_with_heat() -> None:
    """A light film that friction warms by tens of kelvins within the ramp: no course given beforehand."""
    light, shape = (
        replace(HEAT, film_capacity=2.0, heater_power=0.0, setpoint=None),
        Shape(0.12, 0.12, 0.4, wait=0.5),
    )
    thermal = TemperatureProfile(course_of(TRAIN, DRAG, light, shape.schedule()), light)
    [found] = outcomes(
        [MachineSample(TRAIN, DRAG)], [shape], thermal, how=Follow(force=True, tolerance=1e-11)
    )
    run = simulate(
        TRAIN,
        DRAG,
        drive_speed=shape.schedule(),
        temperature=light,
        duration=2.0,
        samples=20_001,
        tolerance=1e-11,
    )
    released = [e.time for e in run.events if e.from_mode in ("stuck", "microslip")][-1]
    assert run.film_temperature is not None
    assert run.film_temperature.max() > 310.0
    assert found.ready == pytest.approx(max(released, 0.9), rel=1e-8)
    assert found.peak_force == pytest.approx(np.abs(run.spring_force).max(), rel=1e-5)


def test_draws_make_their_own_temperature(monkeypatch: pytest.MonkeyPatch) -> None:
    """The last proof has heat as a state: a course that is no longer true leaves it alone."""
    monkeypatch.setattr("hersey.stability.plan.proof._FRESH", 60)
    monkeypatch.setattr("hersey.stability.plan.proof._LONG", 1)
    seen = []
    verify = Unknown.verify

    def watched(self: Unknown, *given: Any) -> Proof:
        proof = verify(self, *given)
        seen.append((given[2].heat is HEAT, proof.draws))
        return proof

    monkeypatch.setattr(Unknown, "verify", watched)
    found = plan_profile(
        machine_of(
            TRAIN,
            limits=replace(LIMITS, spring_force=1000.0),
            uncertainty={"transition_force": Uncertainty(share=0.05)},
        ),
        DRAG,
        target_speed=0.12,
        temperature=HEAT,
        confidence=0.5,
    )
    assert (found.draws, found.wait) == (60, 0.0)
    assert found.share_low > 0.5
    assert seen[-1] == (True, 60)
    assert seen[0] == (False, 60)


def test_rounds_that_do_not_end_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hersey.stability.plan.planner.ROUNDS", 1)
    limits = replace(LIMITS, spring_force=1000.0)
    found = plan_profile(machine_of(TRAIN, limits=limits), DRAG, target_speed=0.12, temperature=HEAT)
    assert not found.found
    assert math.isnan(found.duration)
    [obstacle] = found.obstacles
    assert obstacle.limit == "temperature"
    assert "do not agree after 1 iterations" in obstacle.text


def test_heat_needs_a_drag_that_varies() -> None:
    with pytest.raises(ParameterError, match="does not depend on temperature"):
        plan_profile(TRAIN, DRAG.at(400.0), target_speed=0.12, temperature=HEAT)
