"""Temperature as a state: two bodies without motion, a heater with a setpoint, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

import hersey
from hersey.errors import HerseyError, ParameterError

_TRAIN = hersey.Drivetrain(1000, 1)
_DRAG = hersey.Drag(
    50,
    1,
    ehl_exponent=-0.7,
    mixed_exponent=-1.2,
    stick_speed=0.01,
    closure="stiction",
    reference_temperature=400.0,
    force_temperature_exponent=-2.0,
    speed_temperature_exponent=1.5,
)
_HEAT = hersey.HeatBalance(
    film_capacity=20.0,
    roll_capacity=200.0,
    exchange=5.0,
    film_loss=0.3,
    roll_loss=1.0,
    film_temperature=350.0,
    roll_temperature=300.0,
    surroundings=295.0,
    heater_power=100.0,
)


def test_two_bodies_at_rest_follow_the_exponential_of_their_matrix() -> None:
    """Nothing moves: T' = M T + c, whose solution is T* + exp(M t) (T_0 - T*)."""
    matrix = np.array([[-(5.0 + 0.3) / 20, 5.0 / 20], [5.0 / 200, -(5.0 + 1.0) / 200]])
    constant = np.array([(100.0 + 0.3 * 295 - 20) / 20, (1.0 * 295 - 10) / 200])
    heat = replace(_HEAT, film_load=20.0, roll_load=10.0)
    run = hersey.simulate(_TRAIN, _DRAG, drive_speed=0.0, temperature=heat, duration=100.0, samples=21)
    limit = np.linalg.solve(matrix, -constant)
    exact = np.array([limit + expm(matrix * t) @ (np.array([350.0, 300.0]) - limit) for t in run.time])
    assert run.film_temperature == pytest.approx(exact[:, 0], rel=1e-9)
    assert run.roll_temperature == pytest.approx(exact[:, 1], rel=1e-9)


def test_all_heat_is_accounted_for() -> None:
    """Friction, heater and losses make up what the two bodies hold more: closed, with no losses."""
    heat = replace(_HEAT, film_loss=0.0, roll_loss=0.0)
    run = hersey.simulate(
        _TRAIN, _DRAG, drive_speed=3.0, temperature=heat, duration=20.0, samples=3, start="steady"
    )
    assert run.film_temperature is not None
    assert run.roll_temperature is not None
    gained = 20.0 * np.ptp(run.film_temperature[[0, -1]]) + 200.0 * np.ptp(run.roll_temperature[[0, -1]])
    assert gained == pytest.approx(100.0 * 20.0 + run.energy.dissipated, rel=1e-8)


def test_the_rest_of_the_drive_does_not_heat_the_film() -> None:
    heat = replace(_HEAT, film_loss=0.0, roll_loss=0.0)
    drag = replace(_DRAG, rest_force=10.0, rest_damping=2.0)
    run = hersey.simulate(
        _TRAIN, drag, drive_speed=3.0, temperature=heat, duration=20.0, samples=3, start="steady"
    )
    assert run.film_temperature is not None
    assert run.roll_temperature is not None
    gained = 20.0 * np.ptp(run.film_temperature[[0, -1]]) + 200.0 * np.ptp(run.roll_temperature[[0, -1]])
    # at 3, 10 + 2 * 3 of the drag are the rest; the start of the swing moves the way by little
    assert gained == pytest.approx(2000.0 + run.energy.dissipated - 16.0 * 3.0 * 20.0, rel=1e-4)


def test_friction_of_a_belt_that_is_held_against_the_pull_never_cools() -> None:
    """The belt of the paper is thrown ahead and held while the spring pulls it back."""
    drag = replace(_DRAG, closure="retained")
    heat = replace(_HEAT, film_loss=0.0, exchange=0.0, heater_power=0.0, film_temperature=400.0)
    run = hersey.simulate(_TRAIN, drag, drive_speed=0.05, temperature=heat, duration=8.0, samples=2001)
    assert run.film_temperature is not None
    assert run.spring_force.min() < -100.0
    assert np.diff(run.film_temperature).min() > -1e-10
    gained = 20.0 * np.ptp(run.film_temperature)
    assert gained == pytest.approx(run.energy.dissipated + run.energy.owed, rel=1e-8)


def test_a_heater_holds_its_setpoint() -> None:
    heat = replace(_HEAT, setpoint=400.0, heater_power=2000.0, heater_gain=500.0)
    run = hersey.simulate(_TRAIN, _DRAG, drive_speed=0.0, temperature=heat, duration=400.0, samples=401)
    film = run.film_temperature
    assert film is not None
    assert run.roll_temperature is not None
    assert np.max(film) < 400.0
    # what is missing to the setpoint, times the gain, makes up what leaves the film's body
    leaving = 5.0 * (film[-1] - run.roll_temperature[-1]) + 0.3 * (film[-1] - 295.0)
    assert 500.0 * (400.0 - film[-1]) == pytest.approx(leaving, rel=1e-3)
    # full power until 4 K are missing: T' = (2000 - ...)/20, nearly 100 K/s at the start
    assert film[1] > 395.0


@settings(max_examples=20, deadline=None)
@given(
    speed=st.floats(0.2, 4.0),
    power=st.floats(0.0, 500.0),
    capacity=st.floats(1.0, 1000.0),
    exchange=st.floats(0.0, 50.0),
)
def test_any_balance_keeps_the_energy(speed: float, power: float, capacity: float, exchange: float) -> None:
    heat = replace(_HEAT, heater_power=power, film_capacity=capacity, exchange=exchange)
    run = hersey.simulate(_TRAIN, _DRAG, drive_speed=speed, temperature=heat, duration=2.0, samples=3)
    assert abs(run.energy.residual) < 1e-8


@pytest.mark.parametrize(
    ("speed", "power"),
    [
        pytest.param(3.84765625, 399.0, id="held by what the heat of its stop has weakened"),
        pytest.param(3.3648347401690017, 825.3697774063324, id="turns at once where its friction ends"),
    ],
)
def test_a_film_that_heats_by_hundreds_of_kelvins_a_second_keeps_the_energy(
    speed: float, power: float
) -> None:
    heat = replace(_HEAT, heater_power=power, film_capacity=1.0, exchange=0.0)
    run = hersey.simulate(
        _TRAIN, _DRAG, drive_speed=speed, temperature=heat, duration=2.0, samples=3, tolerance=1e-12
    )
    assert abs(run.energy.residual) < 1e-11


def test_what_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"Write temperature=HeatBalance\(\.\.\.\)"):
        hersey.simulate(_TRAIN, _DRAG, drive_speed=1.0, heat=_HEAT, duration=1.0)  # type: ignore[call-arg]
    with pytest.raises(ParameterError, match=r"Did you mean tolerance\?"):
        hersey.simulate(_TRAIN, _DRAG, drive_speed=1.0, duration=1.0, tolerence=1e-3)  # type: ignore[call-arg]
    with pytest.raises(ParameterError, match="does not depend"):
        hersey.simulate(_TRAIN, _DRAG.at(400.0), drive_speed=1.0, temperature=_HEAT, duration=1.0)
    with pytest.raises(ParameterError, match="heat capacity is 0"):
        hersey.simulate(
            _TRAIN, _DRAG, drive_speed=1.0, temperature=replace(_HEAT, film_capacity=0.0), duration=1.0
        )
    with pytest.raises(ParameterError, match="gain"):
        replace(_HEAT, heater_gain=1.0)
    with pytest.raises(HerseyError, match="temperature"):
        # the heat that is taken away leads to 0 K
        hersey.simulate(
            _TRAIN, _DRAG, drive_speed=0.0, temperature=replace(_HEAT, film_load=1e4), duration=100.0
        )


def test_a_heater_without_a_gain_gives_full_power_until_a_tenth_of_a_kelvin_is_missing() -> None:
    """2 kW over 0.1 K: 20 kW/K times what is missing makes up what leaves the film's body."""
    heat = replace(_HEAT, setpoint=400.0, heater_power=2000.0)
    run = hersey.simulate(_TRAIN, _DRAG, drive_speed=0.0, temperature=heat, duration=400.0, samples=3)
    assert run.film_temperature is not None
    assert run.roll_temperature is not None
    film, roll = run.film_temperature[-1], run.roll_temperature[-1]
    assert 20e3 * (400.0 - film) == pytest.approx(5.0 * (film - roll) + 0.3 * (film - 295.0), rel=1e-3)
