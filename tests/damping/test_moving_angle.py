"""Moving logs whose angle is known: its slope is the speed, gravity goes with it; what no law fits."""

from __future__ import annotations

from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
import hersey.verdict.warnings
from hersey.damping.driving_torque import driving_torque
from hersey.damping.moving.gravity import gravity_of
from hersey.damping.moving.result import MovingFit
from hersey.errors import InsufficientDataError
from tests.damping.moving_logs import COULOMB, INERTIA, OFFSET, RATE, VISCOUS, read, times, waves

#: Amplitude of gravity, N m, and the angle at which the load hangs, rad.
GRAVITY, HANGING = 0.9, 0.4


def swing(hertz: float, size: float) -> tuple[Any, Any, Any]:
    """Angle, speed and acceleration of two sines."""
    t, out = times(), np.zeros((3, times().size))
    for share, of in ((1.0, hertz), (0.6, 0.43 * hertz)):
        w = 2.0 * np.pi * of
        out += share * size * np.array([np.sin(w * t), w * np.cos(w * t), -(w**2) * np.sin(w * t)])
    return out[0], out[1], out[2]


def torque_of(speed: Any, rate: Any, angle: Any = None, gravity: float = 0.0) -> Any:
    noise = np.random.default_rng(3).normal(0.0, 0.01, speed.size)
    friction = COULOMB * np.sign(speed) + VISCOUS * speed
    load = 0.0 if angle is None else gravity * np.sin(angle - HANGING)
    return INERTIA * rate + OFFSET + friction + load + noise


def of_position(angle: Any, torque: Any, *, bits: int = 14) -> hersey.TorqueLog:
    step = 2.0 * np.pi / 2**bits
    columns = {"time (s)": times(), "torque (N m)": torque, "position (rad)": np.floor(angle / step) * step}
    return hersey.read(pl.DataFrame(columns), channels={"position": "position"}, isothermal=True)


def holds(fit: MovingFit, **truth: float) -> None:
    for name, value in truth.items():
        assert abs(fit[name].value - value) < 3.0 * fit[name].error, name


@pytest.mark.parametrize("hertz", [0.4, 3.0])
def test_a_fast_position_biases_nothing(hertz: float) -> None:
    """A window of 0.2 s halves a sine of 3 Hz: T_C was 28 % low."""
    angle, speed, rate = swing(hertz, 0.4)
    fit = of_position(angle, torque_of(speed, rate)).moving()
    assert fit.law == "Coulomb and viscous friction"
    holds(fit, T_C=COULOMB, k_v=VISCOUS, J=INERTIA, offset=OFFSET)
    assert fit["T_C"].value == pytest.approx(COULOMB, rel=0.02)


def test_friction_that_builds_up_near_standstill_is_left_out() -> None:
    """T_C tanh(w/w_0) + k_v w, as joints with soft gears have it: sliding begins at some w_0."""
    _, speed, rate = swing(0.4, 0.8)
    builds_up = 0.3
    torque = torque_of(speed, rate) + COULOMB * (np.tanh(speed / builds_up) - np.sign(speed))
    fit = read(speed, torque).moving()
    assert fit.law == "Coulomb and viscous friction"
    assert builds_up < fit.least_speed < 5.0 * builds_up
    assert fit["T_C"].value == pytest.approx(COULOMB, rel=0.02)
    holds(fit, k_v=VISCOUS, J=INERTIA, offset=OFFSET)
    assert fit.misfit is None


def test_a_position_that_counts_too_coarsely_is_refused() -> None:
    angle, speed, rate = swing(0.4, 0.05)
    with pytest.raises(InsufficientDataError) as error:
        of_position(angle, torque_of(speed, rate), bits=9).moving()
    assert "the position counts in steps of 0.7°, too coarse" in str(error.value)


def test_gravity_goes_with_a_recorded_angle() -> None:
    angle, speed, rate = swing(0.4, 0.8)
    fit = of_position(angle, torque_of(speed, rate, angle, GRAVITY)).moving()
    assert fit.law == "Coulomb and viscous friction; gravity"
    holds(fit, T_C=COULOMB, k_v=VISCOUS, J=INERTIA, G=GRAVITY, q_0=HANGING)
    assert "the angle q is the position in the log" in fit.summary()
    points = fit.points()
    speed = points.column("speed")
    assert points.column("torque") == pytest.approx(COULOMB * np.sign(speed) + VISCOUS * speed, rel=0.05)


def test_gravity_goes_with_what_the_speed_adds_up_to() -> None:
    """The angle counts from the first row, so the load hangs at 0.4 rad less the angle there."""
    angle, speed, rate = swing(0.4, 0.8)
    fit = read(speed, torque_of(speed, rate, angle, GRAVITY)).moving()
    holds(fit, T_C=COULOMB, k_v=VISCOUS, G=GRAVITY, q_0=HANGING - angle[0])
    assert "counted from the start of the log" in fit.summary()


def test_without_gravity_none_is_found() -> None:
    _, speed, rate = swing(0.4, 0.8)
    assert "G" not in read(speed, torque_of(speed, rate)).moving()


def test_an_arc_too_small_for_gravity_is_said() -> None:
    """Over 4 degrees gravity is a spring: friction is right, where the load hangs is not known."""
    angle, speed, rate = swing(1.0, 0.025)
    fit = of_position(angle, torque_of(speed, rate, angle, 1.0), bits=22).moving()
    holds(fit, T_C=COULOMB, k_v=VISCOUS)
    assert "gravity or offset" in [each.kind for each in fit.warnings]


def test_friction_that_follows_no_law_is_said_and_not_named() -> None:
    speed, rate = waves(times())
    friction = 0.3 * np.sign(speed) * np.abs(speed) ** 0.4
    noise = np.random.default_rng(1).normal(0.0, 0.01, speed.size)
    fit = read(speed, INERTIA * rate + friction + noise).moving()
    assert fit.misfit is not None
    assert fit.misfit.share < -0.03
    assert fit.headline().startswith("No law of friction fits. The nearest is off by ")
    assert "law does not fit" in [each.kind for each in fit.warnings]


@pytest.mark.parametrize("load", [lambda w: 5.0 * (1.0 - w / 9.0), lambda w: 1.0 / w])
def test_the_torque_of_a_motor_is_refused(load: Any) -> None:
    time = times()
    speed, rate = 5.0 + 3.0 * np.sin(1.3 * time), 3.9 * np.cos(1.3 * time)
    noise = np.random.default_rng(1).normal(0.0, 0.003, speed.size)
    with pytest.raises(InsufficientDataError, match="the torque of a motor or a brake"):
        read(speed, load(speed) + INERTIA * rate + noise).moving()


def test_a_torque_that_drives_is_told_from_friction() -> None:
    """5 (1 - n/4000) N m is zero at 4000 rpm, 200 W are the same everywhere; Stribeck's curve levels off."""
    speed = np.linspace(50.0, 360.0, 7)
    error = np.full(7, 0.01)
    line = driving_torque(speed, 5.0 * (1.0 - speed / 419.0), error)
    assert line is not None
    assert line.zero_speed == pytest.approx(419.0, rel=1e-3)
    assert "would be zero near 4000 rpm" in str(line)
    power = driving_torque(speed, 200.0 / speed, error)
    assert power is not None
    assert power.power == pytest.approx(200.0)
    assert "the power is 200 W at all speeds" in str(power)
    for rise in (0.5, 2.0, 8.0):
        for at in (30.0, 100.0, 300.0):
            stribeck = 1.0 + rise * np.exp(-((speed / at) ** 2)) + 1e-4 * speed
            assert driving_torque(speed, stribeck, error) is None


def test_a_staircase_of_a_motor_has_no_regime() -> None:
    speed = np.repeat(np.linspace(50.0, 360.0, 7), 300)
    noise = np.random.default_rng(1).normal(0.0, 0.01, speed.size)
    points = read(speed, 5.0 * (1.0 - speed / 419.0) + noise).steady()
    seen = hersey.regime(points, hersey.fit(points))
    assert seen.named is None
    assert seen.driving is not None
    assert seen.verdict.startswith("Torque falls with speed and would be zero near 4000 rpm.")
    assert seen.explanations == ()


def test_a_hoist_is_sent_to_a_fit_of_every_sample() -> None:
    """Followed, the advice finds the load as the offset."""
    level = np.array([10.0, 20.0, 40.0, 80.0, 160.0]) * np.pi / 30.0
    speed = np.repeat(np.concatenate([level, -level]), int(8 * RATE))
    noise = np.random.default_rng(1).normal(0.0, 0.02, speed.size)
    log = read(speed, 5.0 + 1.2 * np.sign(speed) + 0.05 * speed + noise)
    points = log.steady()
    found = {each.kind: each for each in hersey.verdict.warnings.warnings_of(points, None)}
    assert found["constant load"].sentence.endswith("To fit it as an offset, use moving=True.")
    fit = log.moving()
    assert fit["offset"].value == pytest.approx(5.0, abs=0.05)
    assert fit["T_C"].value == pytest.approx(1.2, abs=0.05)


def test_errors_of_gravity_by_hand() -> None:
    """At a_cos = 0, a_sin = 2: G is 2 with the error of a_sin, q_0 is 0 with half of that of a_cos."""
    values, covariance = gravity_of(np.array([0.0, 2.0]), np.diag([0.09, 0.04]))
    np.testing.assert_allclose(values, [2.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(covariance, np.diag([0.04, 0.0225]), atol=1e-15)


def test_a_departure_is_stated_as_a_share_of_the_friction_there() -> None:
    time = times()
    speed, rate = waves(time)
    friction = 0.3 * np.sign(speed) * np.abs(speed) ** 0.4
    noise = np.random.default_rng(5).normal(0.0, 0.002, speed.size)
    fit = read(speed, INERTIA * rate + friction + noise).moving()
    assert fit.misfit is not None
    at = abs(fit.misfit.speed)  # the mean about a knot, over which the departure is averaged
    law = float(fit.friction(np.array([at]))[0])
    assert fit.misfit.share == pytest.approx((0.3 * at**0.4 - law) / law, rel=0.35)
