"""Steps, ramps and kicks from steady sliding."""

from __future__ import annotations

from dataclasses import replace
from math import inf

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
    with pytest.raises(ParameterError, match=r"from_speed is 0\.5: below the transition speed 1"):
        hersey.safe_step(TRAIN, DRAG, from_speed=0.5, to_speed=1.0)
    with pytest.raises(ParameterError, match="to_speed is -1"):
        hersey.safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=-1.0)
    with pytest.raises(ParameterError, match="drive_speed is nan"):
        hersey.disturbance(TRAIN, DRAG, drive_speed=float("nan"))
