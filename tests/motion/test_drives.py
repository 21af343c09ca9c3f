"""Drives: speed schedules, torque on a rotor, temperature that moves the law."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hersey
from hersey.errors import ParameterError

DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
TRAIN = hersey.Drivetrain(1000, 1)


def ramp(target: float, over: float) -> hersey.Schedule:
    return hersey.Schedule([0, over], [2.5, target])


@pytest.mark.parametrize(
    ("target", "over", "sticks"),
    [(1.2, 0.0, True), (1.3, 0.0, False), (1.0, 0.12, True), (1.0, 0.15, False)],
)
def test_how_one_comes_down_from_2_5_matters(target: float, over: float, sticks: bool) -> None:
    """Fig. 14 and physics.md, section 5: ramps from steady 2.5."""
    schedule = ramp(target, over) if over else hersey.Schedule([0.0], [target])
    start = (2.5, float(DRAG.force(2.5)) / 1000)
    run = hersey.simulate(TRAIN, DRAG, drive_speed=schedule, start=start, duration=20.0, samples=20001)
    assert any(e.to_mode == "stuck" for e in run.events) == sticks
    if (target, over) == (1.0, 0.15):
        assert run.belt_speed.min() == pytest.approx(0.553239, abs=2e-5)
    assert abs(run.energy.residual) < 1e-8


def test_a_schedule_against_an_ordinary_solver() -> None:
    """Above the transition the equation is smooth, and any solver will do."""
    times, speeds = np.array([0.0, 0.3, 0.8, 1.4]), np.array([3.0, 2.0, 4.0, 3.5])
    for smooth in (False, True):
        schedule = hersey.Schedule(times, speeds, smooth=smooth)
        run = hersey.simulate(TRAIN, DRAG, drive_speed=schedule, start="steady", duration=2.0, samples=21)

        def rates(t: float, y: np.ndarray, schedule: hersey.Schedule = schedule) -> list[float]:
            return [schedule.at(t) - y[1], 1000 * y[0] - 50 * y[1] ** 0.3]

        start = [float(DRAG.force(3.0)) / 1000, 3.0]
        parts, y = [], start
        for begin, end in zip([*times], [*times[1:], 2.0], strict=True):
            solution = solve_ivp(
                rates, (begin, end), y, method="DOP853", rtol=1e-11, atol=1e-13, dense_output=True
            )
            parts.append((begin, end, solution.sol))
            y = solution.y[:, -1]
        for t, v, s in zip(run.time, run.belt_speed, run.stretch, strict=True):
            dense = next(sol for begin, end, sol in parts if begin <= t <= end)
            assert dense(t) == pytest.approx([s, v], rel=1e-8)
        assert abs(run.energy.residual) < 1e-8


def test_the_same_schedule_in_pieces_is_the_same_motion() -> None:
    whole = hersey.Schedule([0, 2], [0.5, 2.5])
    pieces = hersey.Schedule(np.linspace(0, 2, 9), np.linspace(0.5, 2.5, 9))
    one, two = (hersey.simulate(TRAIN, DRAG, drive_speed=s, duration=3.0) for s in (whole, pieces))
    np.testing.assert_allclose(one.belt_speed, two.belt_speed, atol=2e-6)
    assert [e.guard for e in one.events] == [e.guard for e in two.events]


@pytest.mark.parametrize("torque", [60.0, 45.0])
def test_a_rotor_without_a_spring_spins_up_to_steady_state(torque: float) -> None:
    """Eq. 11 with K = 0: from rest to where drag equals torque; below the breakaway it stays at rest."""
    drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    rotor = hersey.Drivetrain(stiffness=0.0, mass=2.0)
    held = hersey.simulate(rotor, drag, drive_torque=torque, duration=50.0)
    assert held.belt_speed[-1] == 0.0
    kicked = hersey.simulate(rotor, drag, drive_torque=torque, duration=200.0, start=(1.5, 0.0))
    steady = (torque / 50) ** (1 / 0.3)
    expected = steady if torque > 50 else 0.0
    assert kicked.belt_speed[-1] == pytest.approx(expected, rel=1e-9, abs=0.0101)
    assert abs(kicked.energy.residual) < 1e-8


def test_a_rotor_on_a_spring_settles_at_its_twist() -> None:
    """Eq. 11: J theta'' + B theta' + K theta = tau, with linear drag known in closed form."""
    linear = hersey.Drag(0.5, 1, ehl_exponent=0.0, mixed_exponent=0.0, stick_speed=1e-9)
    rotor = hersey.Drivetrain(stiffness=4.0, mass=1.0)
    run = hersey.simulate(rotor, linear, drive_torque=2.0, duration=3.0, samples=31)
    decay, omega = 0.25, np.sqrt(4.0 - 0.0625)
    t = run.time[:15]  # up to the first reversal, where the tiny closure would come in
    twist = 0.5 * (1 - np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t)))
    np.testing.assert_allclose(run.stretch[:15], twist, atol=1e-7)
    assert run.spring_force == pytest.approx(4.0 * run.stretch)


def test_a_step_of_torque_is_a_jump_of_the_pull() -> None:
    rotor = hersey.Drivetrain(stiffness=0.0, mass=1.0)
    steps = hersey.Schedule([0, 1, 1, 2], [100.0, 100.0, 400.0, 400.0])
    run = hersey.simulate(rotor, DRAG, drive_torque=steps, duration=2.0, check=True)
    assert run.events[0].time == pytest.approx(1.0, abs=1e-12)
    assert run.check is not None
    assert run.check.same_events
    assert run.check.speed_difference < 1e-6


WARM = hersey.Drag(
    50,
    1,
    ehl_exponent=-0.7,
    mixed_exponent=-1.2,
    stick_speed=0.01,
    reference_temperature=400.0,
    force_temperature_exponent=-1.5,
    speed_temperature_exponent=2.0,
)


def test_a_steady_temperature_is_the_law_at_it() -> None:
    ratio = 440.0 / 400.0
    cold = hersey.Drag(
        50 * ratio**-1.5, ratio**2, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01 * ratio**2
    )
    one = hersey.simulate(TRAIN, WARM, drive_speed=1.0, temperature=440.0, duration=2.0)
    two = hersey.simulate(TRAIN, cold, drive_speed=1.0, duration=2.0)
    np.testing.assert_allclose(one.belt_speed, two.belt_speed, rtol=1e-9, atol=1e-12)
    warm_cycle = hersey.stick_slip(TRAIN, WARM, drive_speed=1.0, temperature=440.0)
    assert warm_cycle.frequency == pytest.approx(
        hersey.stick_slip(TRAIN, cold, drive_speed=1.0).frequency, rel=1e-9
    )


@pytest.mark.parametrize("closure", ["retained", "stiction", "stribeck"])
def test_the_guards_move_with_the_temperature(closure: str) -> None:
    """Two integrators, one by series of the moving law, one evaluating it afresh, see the same motion."""
    import dataclasses

    drag = dataclasses.replace(WARM, closure=closure)
    course = hersey.Schedule([0.0, 1.0, 2.0], [400.0, 430.0, 425.0], smooth=True)
    run = hersey.simulate(TRAIN, drag, drive_speed=1.0, temperature=course, duration=1.5, check=True)
    assert run.check is not None
    assert run.check.same_events
    assert run.check.speed_difference < 1e-6
    assert abs(run.energy.residual) < 1e-8
    crossings = [e for e in run.events if e.guard == "transition_speed"]
    assert len(crossings) > 4
    for event in crossings:
        assert event.belt_speed == pytest.approx((course.at(event.time) / 400.0) ** 2, rel=1e-9)


def test_warming_carries_the_belt_out_of_stick_slip() -> None:
    """The paper's ref. 1: with falling v_t the same drive speed becomes smooth."""
    import dataclasses

    drag = dataclasses.replace(WARM, speed_temperature_exponent=-6.0)
    course = hersey.Schedule([0.0, 5.0], [400.0, 520.0])
    run = hersey.simulate(TRAIN, drag, drive_speed=1.2, temperature=course, duration=10.0)
    sticks = [e.time for e in run.events if e.to_mode == "stuck"]
    assert sticks
    assert max(sticks) < 6.0
    assert run.belt_speed[-1] == pytest.approx(1.2, rel=1e-3)


def test_a_tabulated_law_through_points_of_the_power_law_is_the_power_law() -> None:
    speeds = np.array([0.01, 0.1, 0.5, 1.0, 1.7, 4.0])
    table = hersey.DragTable(tuple(speeds), tuple(DRAG.force(speeds)), stick_speed=0.01)
    one, two = (hersey.stick_slip(TRAIN, law, drive_speed=1.0) for law in (DRAG, table))
    assert one.frequency == pytest.approx(two.frequency, rel=1e-8)
    assert one.speed_max == pytest.approx(two.speed_max, rel=1e-8)
    between = np.geomspace(0.02, 8, 40)
    np.testing.assert_allclose(table.force(between), DRAG.force(between), rtol=1e-12)


@pytest.mark.parametrize(
    ("times", "values", "says"),
    [
        ([], [], "no points"),
        ([0, 2, 1], [1, 2, 3], "must ascend"),
        ([0, 1], [1, float("nan")], "not finite"),
        ([0, 1], [1, 2, 3], "2 times, but 3 values"),
    ],
)
def test_what_is_no_schedule_is_refused(times: list[float], values: list[float], says: str) -> None:
    with pytest.raises(ParameterError, match=says):
        hersey.Schedule(times, values)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({}, "either drive_speed or drive_torque"),
        ({"drive_speed": 1.0, "drive_torque": 1.0}, "either"),
        ({"drive_speed": 1.0, "temperature": 300.0}, "does not depend"),
        ({"drive_speed": float("nan")}, "drive_speed is NaN"),
        ({"drive_speed": 1.0, "start": "nowhere"}, "nowhere"),
        ({"drive_torque": 1.0, "start": "steady"}, "steady"),
    ],
)
def test_drives_that_make_no_sense_are_refused(arguments: dict[str, object], says: str) -> None:
    with pytest.raises(ParameterError, match=says):
        hersey.simulate(TRAIN, DRAG, duration=1.0, **arguments)  # type: ignore[arg-type]


def test_impossible_trains_and_temperatures_are_refused() -> None:
    with pytest.raises(ParameterError, match="stiffness is 0"):
        hersey.simulate(hersey.Drivetrain(0, 1), DRAG, drive_speed=1.0, duration=1.0)
    with pytest.raises(ParameterError, match="mass is -1"):
        hersey.simulate(hersey.Drivetrain(1, -1), DRAG, drive_speed=1.0, duration=1.0)
    with pytest.raises(ParameterError, match="Give temperature"):
        hersey.simulate(TRAIN, WARM, drive_speed=1.0, duration=1.0)
    with pytest.raises(ParameterError, match="temperature is -5"):
        hersey.simulate(TRAIN, WARM, drive_speed=1.0, duration=1.0, temperature=-5.0)
    with pytest.raises(ParameterError, match="backwards"):
        hersey.DragTable((1.0, 0.5), (1.0, 2.0), stick_speed=0.1)


def test_rotational_values_convert_through_the_roll_radius() -> None:
    train = hersey.Drivetrain.rotational(stiffness=2.5, inertia=2e-4, roll_radius=0.02)
    assert (train.stiffness, train.mass) == (pytest.approx(6250.0), pytest.approx(0.5))
    drag = hersey.Drag.rotational(
        transition_torque=0.4,
        transition_speed=3.0,
        roll_radius=0.02,
        ehl_exponent=-0.7,
        mixed_exponent=-1.2,
        stick_speed=1e-3,
    )
    assert (drag.transition_force, drag.transition_speed) == (pytest.approx(20.0), pytest.approx(0.06))
    # power at the belt is power at the shaft
    assert float(drag.force(0.06)) * 0.06 == pytest.approx(0.4 * 3.0)
