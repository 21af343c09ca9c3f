"""Grip, static force, no-load torque, bristles and temperature against a solution that shares no code."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey

_REFERENCE = json.loads(Path(__file__).with_name("independent.json").read_text())
_PLAIN = {case["setting"]["name"]: case for case in _REFERENCE["plain"]}
_TRAIN = hersey.Drivetrain(1000, 1)
#: The belt makes laps in these, and the independent solution followed them until they repeated themselves.
_SETTLED = [
    name for name, case in _PLAIN.items() if "frequency_lap" in case["settled"] and "ramp" not in name
]


def _drag(**beside: Any) -> hersey.Drag:
    return hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01, **beside)


def _belt(setting: dict[str, Any]) -> tuple[hersey.Drivetrain, hersey.Drag, Any]:
    drag = _drag(
        closure=setting["closure"],
        static_force=setting["static_force"],
        rest_force=setting.get("r0", 0.0),
        rest_damping=setting.get("r1", 0.0),
    )
    course = setting.get("w", 1.0)
    speed = hersey.Schedule(*zip(*course, strict=True)) if isinstance(course, list) else course
    return hersey.Drivetrain(1000, 1, grip=setting.get("G")), drag, speed


@pytest.mark.parametrize("name", _PLAIN)
def test_motion(name: str) -> None:
    case = _PLAIN[name]
    train, drag, speed = _belt(case["setting"])
    samples = np.array(case["samples"])
    count = round(case["duration"] / (samples[1, 0] - samples[0, 0]) * 4) + 1
    run = hersey.simulate(
        train, drag, drive_speed=speed, duration=case["duration"], samples=count, tolerance=1e-11
    )
    at = np.rint(samples[:, 0] / case["duration"] * (count - 1)).astype(int)
    assert run.belt_speed[at] == pytest.approx(samples[:, 1], abs=1e-7)
    assert run.spring_force[at] == pytest.approx(samples[:, 2], abs=1e-7 * np.abs(samples[:, 2]).max())
    assert run.energy.slipped == pytest.approx(case["energy"]["grip"], rel=1e-8, abs=1e-9)
    assert abs(run.energy.residual) < 1e-8


@pytest.mark.parametrize("name", _SETTLED)
def test_cycle(name: str) -> None:
    settled = _PLAIN[name]["settled"]
    train, drag, speed = _belt(_PLAIN[name]["setting"])
    drive = speed if isinstance(speed, float) else float(speed.at(10.0))
    cycle = hersey.stick_slip(train, drag, drive_speed=drive)
    assert cycle.frequency == pytest.approx(settled["frequency_lap"], rel=1e-6)
    assert cycle.speed_max == pytest.approx(settled["u_max"], rel=1e-6)
    slip = cycle.grip_slip_duration * cycle.frequency
    assert slip == pytest.approx(settled["grip_slip_fraction"], abs=1e-7)
    # over a lap the drive's work ends in drag, in the grip that slips, and in the stop
    spent = settled["drag_per_period"] + settled["rest_hold_per_period"] + settled["stop_loss_per_period"]
    assert cycle.drag_work == pytest.approx(spent, rel=1e-6)


def test_a_grip_that_cannot_start_the_belt_stalls() -> None:
    cycle = hersey.stick_slip(
        hersey.Drivetrain(1000, 1, grip=200.0), _drag(closure="stiction"), drive_speed=1.0
    )
    assert (cycle.kind, cycle.speed_max, cycle.stretch_max) == ("stalled", 0.0, 0.2)


def test_a_grip_below_the_drag_of_sliding_slides_slower() -> None:
    """F = 50 v^0.3 is 55 N at v = 1.374; the drive runs at 3, where drag asks for 69.5 N."""
    train = hersey.Drivetrain(1000, 1, grip=55.0)
    cycle = hersey.stick_slip(train, _drag(), drive_speed=3.0, start=(3.0, 0.05))
    assert cycle.kind == "grip_slip"
    assert cycle.speed_max == pytest.approx((55 / 50) ** (1 / 0.3), rel=1e-6)


@pytest.mark.parametrize("case", _REFERENCE["bristles"], ids=lambda c: f"{c['s0']:.0e}, {c['s2']}")
def test_bristles(case: dict[str, Any]) -> None:
    stiffness = case["s0"]
    drag = _drag(
        closure="lugre",
        bristle_stiffness=stiffness,
        bristle_damping=2 * stiffness**0.5,
        rest_damping=case["s2"],
    )
    cycle = hersey.stick_slip(_TRAIN, drag, drive_speed=1.0)
    if not case["periodic"]:
        assert cycle.kind == "steady_sliding"
        return
    assert (cycle.kind, cycle.laps_per_period) == ("stick_slip", case["laps_per_period"])
    assert cycle.frequency == pytest.approx(case["mean_lap_frequency_Hz"], rel=1e-6)
    assert cycle.speed_max == pytest.approx(case["u_max"], rel=1e-6)
    assert cycle.stuck_fraction == pytest.approx(case["stick_fraction_abs_u_below_vs"], rel=1e-4)
    slips = (1.0 - case["stick_fraction_abs_u_below_vs"]) / case["mean_lap_frequency_Hz"]
    assert cycle.slip_duration == pytest.approx(slips, rel=1e-5)


@pytest.mark.parametrize("case", _REFERENCE["heat"], ids=lambda c: c["name"][:12])
def test_heat(case: dict[str, Any]) -> None:
    given = case["thermal"]
    heat = hersey.HeatBalance(
        film_capacity=given["C1"],
        roll_capacity=given["C2"],
        exchange=given["H12"],
        roll_loss=given["H2a"],
        film_temperature=given["T1"],
        roll_temperature=given["T2"],
        surroundings=given["Ta"],
        heater_power=given["P"],
    )
    drag = _drag(
        closure=case["closure"],
        reference_temperature=given["Tref"],
        force_temperature_exponent=given["b"],
        speed_temperature_exponent=given["d"],
    )
    start = "rest" if case["start"] is None else (case["start"][0], case["start"][1] / 1000)
    samples = np.array(case["samples"])
    count = round(case["duration"] / (samples[1, 0] - samples[0, 0]) * 4) + 1
    run = hersey.simulate(
        _TRAIN,
        drag,
        drive_speed=case["drive_speed"],
        temperature=heat,
        duration=case["duration"],
        samples=count,
        start=start,
        tolerance=1e-11,
    )
    at = np.rint(samples[:, 0] / case["duration"] * (count - 1)).astype(int)
    assert run.film_temperature is not None
    assert run.roll_temperature is not None
    assert run.belt_speed[at] == pytest.approx(samples[:, 1], abs=1e-7)
    assert run.spring_force[at] == pytest.approx(samples[:, 2], abs=1e-7 * np.abs(samples[:, 2]).max())
    assert run.film_temperature[at] == pytest.approx(samples[:, 3], rel=1e-9)
    assert run.roll_temperature[at] == pytest.approx(samples[:, 4], rel=1e-9)
    assert abs(run.energy.residual) < 1e-8
