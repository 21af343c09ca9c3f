"""A roll that slips while its drive turns back, and jumps: nothing is lost or switches without end."""

from __future__ import annotations

import numpy as np
import pytest

import hersey

_DRAG = hersey.Drag(10.0, 0.03, ehl_exponent=-0.7, mixed_exponent=-1.4, stick_speed=0.003)


@pytest.mark.parametrize("closure", ["retained", "stiction"])
@pytest.mark.parametrize("grip", [11.0, 26.0, 80.0])
def test_a_drive_that_turns_back(closure: str, grip: float) -> None:
    random = np.random.default_rng(3)
    drag = hersey.Drag(**{**vars(_DRAG), "closure": closure, "rest_force": 3.0})
    train = hersey.Drivetrain(11e3, 2.0, grip=grip)
    for _ in range(12):
        times = np.concatenate([[0.0], np.cumsum(random.uniform(0.05, 1.0, 4))])
        speeds = [0.05, 0.05, *random.uniform(-0.1, 0.1, 2), random.uniform(0.0, 0.1)]
        drive = hersey.Schedule(times, speeds)
        run = hersey.simulate(train, drag, drive_speed=drive, duration=float(times[-1]) + 0.5, samples=401)
        assert abs(run.energy.residual) < 1e-8
        assert np.abs(run.spring_force).max() <= grip * (1 + 1e-9)


@pytest.mark.parametrize("after", [0.02, -0.02])
def test_a_drive_that_jumps_below_the_belt_does_not_take_it_along(after: float) -> None:
    drag = hersey.Drag(**{**vars(_DRAG), "rest_force": 0.0})
    train = hersey.Drivetrain(11e3, 2.0, grip=11.0)
    jump = hersey.Schedule([0.0, 1.0, 1.0], [0.06, 0.06, after])
    run = hersey.simulate(train, drag, drive_speed=jump, duration=2.0, samples=2001, start=(0.0412, 1e-3))
    assert run.slipping[900]
    assert run.belt_speed[1000] == pytest.approx(run.belt_speed[999], abs=1e-4)
    assert abs(run.energy.residual) < 1e-8


def test_a_spring_beyond_the_grip_slips_off_before_anything_moves() -> None:
    run = hersey.simulate(
        hersey.Drivetrain(11e3, 2.0, grip=11.0), _DRAG, drive_speed=0.06, duration=0.2, start=(0.05, 3e-3)
    )
    assert run.spring_force[0] == pytest.approx(11.0)
    assert abs(run.energy.residual) < 1e-8


@pytest.mark.parametrize("closure", ["retained", "stiction", "stribeck"])
def test_a_stall_is_told_from_slipping_and_from_an_unsettled_motion(closure: str) -> None:
    """A smooth closure never holds the belt: it creeps below the stick speed. That is a stall too."""
    drag = hersey.Drag(**{**vars(_DRAG), "closure": closure})
    train = hersey.Drivetrain(11e3, 2.0, grip=0.5 * drag.holding_force)
    for start in ("rest", (0.0, 2e-3)):
        assert hersey.stick_slip(train, drag, drive_speed=0.02, start=start).kind == "stalled"
    swept = hersey.sweep(train, drag, drive_speed=[0.02], duration=2.0)
    assert swept.kind.values.tolist() == ["stalled"]
    heavy = hersey.sweep(hersey.Drivetrain(11e3, 2.0, grip=10.5), drag, drive_speed=[0.5], start="steady")
    assert heavy.kind.values.tolist() == ["grip_slip"]


def test_a_roll_that_slips_from_the_start_on_slips_as_long() -> None:
    """At its grip, 11 N, a drive of 60 mm/s slips on a belt that comes to 36 mm/s, and never grips again."""
    train = hersey.Drivetrain(11e3, 2.0, grip=11.0)
    drag = hersey.Drag(**{**vars(_DRAG), "rest_force": 0.0})
    run = hersey.simulate(train, drag, drive_speed=0.06, duration=2.0, start=(0.04, 1e-3))
    assert run.roll_slips == [(0.0, 2.0)]
    assert run.belt_speed[-1] == pytest.approx(0.03 * 1.1 ** (1 / 0.3), rel=1e-3)
