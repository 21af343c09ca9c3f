"""What a motion asks of the motor: how much, when first, and for how long."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey.errors import ParameterError
from hersey.machine import Limits, motor_use

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


def test_a_belt_at_rest_asks_more_from_a_moment_that_is_known() -> None:
    """Held at rest the spring takes 1000 N a second: 200 N after 0.2 s, wherever the samples lie."""
    for samples in (41, 4001):
        run = hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=0.3, samples=samples)
        use = motor_use(run, motor_torque=4.0, roll_radius=0.02)
        assert use.exceeded_from == pytest.approx(0.2, rel=1e-9)
        assert (use.torque, use.time, use.limit) == (pytest.approx(6.0), 0.3, 4.0)
        assert use.exceeded == pytest.approx(1 / 3, abs=0.05)
        assert "needs up to 6 N m (at 0.3 s) and exceeds the limit from 0.2 s on" in str(use)
    enough = motor_use(run, motor_torque=7.0, roll_radius=0.02)
    assert (enough.exceeded_from, enough.exceeded) == (None, 0.0)
    assert str(enough) == "the motor is strong enough: the motion needs 6 of 7 N m"


def test_the_motor_bears_no_more_than_the_roll_grips() -> None:
    slips = hersey.simulate(replace(TRAIN, grip=150.0), DRAG, drive_speed=1.0, duration=0.3)
    assert motor_use(slips, motor_torque=4.0, roll_radius=0.02).torque == pytest.approx(3.0)
    assert slips.roll_slips == [(pytest.approx(0.15), 0.3)]
    assert "the drive slips for 0.15, starting at 0.15" in slips.summary()
    stalled = hersey.stick_slip(replace(TRAIN, grip=150.0), DRAG, drive_speed=1.0)
    assert stalled.summary().startswith("stalled: the drive slips and moves nothing")


def test_a_motion_already_beyond_is_beyond_from_its_start() -> None:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=0.1, start=(0.0, 0.2))
    assert motor_use(run, motor_torque=1.0, roll_radius=0.02).exceeded_from == 0.0
    assert np.all(run.spring_force > 50.0)


@pytest.mark.parametrize(("torque", "radius"), [(0.0, 0.02), (1.0, -1.0), (float("nan"), 0.02)])
def test_a_motor_that_cannot_be_is_refused(torque: float, radius: float) -> None:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=0.1, samples=3)
    with pytest.raises(ParameterError, match="it must be"):
        motor_use(run, motor_torque=torque, roll_radius=radius)


def test_limits_give_a_roll_its_grip() -> None:
    limits = Limits(roll_friction=0.6, nip_load=300.0)
    assert limits.gripping(TRAIN).grip == 180.0
    assert limits.gripping(replace(TRAIN, grip=50.0)).grip == 50.0
    assert Limits().gripping(TRAIN).grip is None


def test_a_drive_backwards_asks_as_much() -> None:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=-1.0, duration=0.3, samples=301)
    use = motor_use(run, motor_torque=4.0, roll_radius=0.02)
    assert (use.torque, use.time) == (pytest.approx(6.0), 0.3)
    assert use.exceeded_from == pytest.approx(0.2, rel=1e-9)
