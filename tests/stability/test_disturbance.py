"""Steps, ramps and kicks from steady sliding."""

from __future__ import annotations

from dataclasses import replace
from math import inf, pi, sqrt

import pytest

import hersey
from hersey.errors import ParameterError

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


@pytest.mark.parametrize(("to_speed", "sticks"), [(1.2, True), (1.3, False), (1.5, False), (1.0, True)])
def test_sudden_steps_of_the_notes(to_speed: float, sticks: bool) -> None:
    """From steady 2.5 a sudden step to 1.2 falls back into stick-slip, one to 1.3 does not (physics.md)."""
    step = hersey.safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=to_speed)
    assert step.sticks == sticks
    assert (step.ramp_time > 0) == sticks


def test_the_shortest_safe_ramp() -> None:
    """2.5 to 1.0 in 0.12 s sticks, in 0.15 s stays smooth."""
    step = hersey.safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=1.0)
    assert 0.12 < step.ramp_time < 0.15
    for factor, sticks in ((0.99, True), (1.01, False)):
        ramp = hersey.Schedule([0, factor * step.ramp_time], [2.5, 1.0])
        run = hersey.simulate(TRAIN, DRAG, drive_speed=ramp, duration=20.0, start="steady")
        assert any(event.to_mode == "stuck" for event in run.events) == sticks


def test_no_ramp_helps_below_the_lower_edge() -> None:
    assert hersey.safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=0.9).ramp_time == inf


@pytest.mark.parametrize("drive_speed", [1.0, 1.2, 1.9])
@pytest.mark.parametrize("closure", ["retained", "stiction"])
def test_a_disturbance_is_a_threshold(drive_speed: float, closure: str) -> None:
    drag = replace(DRAG, closure=closure)
    most = hersey.disturbance(TRAIN, drag, drive_speed=drive_speed)
    assert 0 < most.kick < drive_speed
    pull = float(drag.force(drive_speed))
    for factor, kind in ((0.999, "steady_sliding"), (1.001, "stick_slip")):
        kicked = (drive_speed - factor * most.kick, pull / TRAIN.stiffness)
        assert hersey.stick_slip(TRAIN, drag, drive_speed=drive_speed, start=kicked).kind == kind
        fast = drive_speed + factor * most.step
        stepped = (fast, float(drag.force(fast)) / TRAIN.stiffness)
        assert hersey.stick_slip(TRAIN, drag, drive_speed=drive_speed, start=stepped).kind == kind


def test_where_nothing_or_everything_disturbs() -> None:
    below = hersey.disturbance(TRAIN, DRAG, drive_speed=0.95)
    above = hersey.disturbance(TRAIN, DRAG, drive_speed=2.2)
    assert (below.kick, below.step) == (0.0, 0.0)
    assert (above.kick, above.step) == (inf, inf)


def test_what_makes_no_sense_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"from_speed is 0\.5, below the transition speed 1\."):
        hersey.safe_step(TRAIN, DRAG, from_speed=0.5, to_speed=1.0)
    with pytest.raises(ParameterError, match="to_speed is -1"):
        hersey.safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=-1.0)
    with pytest.raises(ParameterError, match="drive_speed is NaN"):
        hersey.disturbance(TRAIN, DRAG, drive_speed=float("nan"))


def test_the_slowest_speed_is_that_of_the_motion() -> None:
    for to_speed, ramp in ((1.5, 0.0), (1.2, 0.0), (1.35, 0.0)):
        step = hersey.safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=to_speed)
        run = hersey.simulate(
            TRAIN,
            DRAG,
            drive_speed=hersey.Schedule([0, ramp], [2.5, to_speed]),
            duration=2.0,
            samples=40_001,
            start=(2.5, float(DRAG.force(2.5)) / 1000),
        )
        assert step.slowest == pytest.approx(run.belt_speed.min(), abs=3e-3)
        assert (step.from_speed, step.to_speed) == (2.5, to_speed)


def test_a_step_up_is_safe_at_once() -> None:
    step = hersey.safe_step(TRAIN, DRAG, from_speed=1.1, to_speed=2.5)
    assert (step.sticks, step.ramp_time) == (False, 0.0)
    assert step.slowest == pytest.approx(1.1, rel=1e-2)


def test_every_longer_ramp_is_safe_too() -> None:
    """With little damping there are safe windows among short ramps: they do not count."""
    train, drag = hersey.Drivetrain(4000.0, 1.0), replace(DRAG, transition_force=20.0)
    step = hersey.safe_step(train, drag, from_speed=2.5, to_speed=1.01)
    period = 2 * pi / sqrt(4000.0)
    assert 0 < step.ramp_time < 8 * period
    for factor in (1.001, 1.3, 2.0, 3.7):
        run = hersey.simulate(
            train,
            drag,
            drive_speed=hersey.Schedule([0, factor * step.ramp_time], [2.5, 1.01]),
            duration=15 * period + factor * step.ramp_time,
            start="steady",
        )
        assert not any(event.to_mode == "stuck" for event in run.events), factor


def test_a_belt_warms_the_same_way_in_all_answers() -> None:
    warm = replace(
        DRAG, reference_temperature=400.0, force_temperature_exponent=-2.0, speed_temperature_exponent=0.5
    )
    kelvin = 440.0
    law = warm.at(kelvin)
    assert hersey.safe_step(
        TRAIN, warm, from_speed=2.5, to_speed=1.2, temperature=kelvin
    ) == hersey.safe_step(TRAIN, law, from_speed=2.5, to_speed=1.2)
    hot, same = (
        hersey.disturbance(TRAIN, d, drive_speed=1.2, temperature=t) for d, t in ((warm, kelvin), (law, None))
    )
    assert (hot.kick, hot.step) == pytest.approx((same.kick, same.step), rel=1e-9)


def test_a_disturbance_names_its_drive_speed_and_refuses_nonsense() -> None:
    assert hersey.disturbance(TRAIN, DRAG, drive_speed=0.95).drive_speed == 0.95
    for wrong in (0.0, -1.0, inf):
        with pytest.raises(ParameterError, match=r"^drive_speed is .*: it must be greater than 0$"):
            hersey.disturbance(TRAIN, DRAG, drive_speed=wrong)
        with pytest.raises(ParameterError, match=r"^from_speed is .*: it must be greater than 0$"):
            hersey.safe_step(TRAIN, DRAG, from_speed=wrong, to_speed=1.0)


def test_between_transition_and_lower_edge_no_steady_start() -> None:
    band = hersey.hysteresis(TRAIN, DRAG, sensitivity=False)
    assert hersey.safe_step(TRAIN, DRAG, from_speed=band.transition, to_speed=2.5).ramp_time == 0.0
    inside = 0.5 * (band.lower + band.transition)
    swings = hersey.safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=inside)
    assert 0 < swings.ramp_time < inf  # a small swing without sticking survives there
