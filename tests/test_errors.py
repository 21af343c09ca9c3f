"""What an error of the core tells a program: its kind and its fields, on the way out and after pickling."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from hersey import Drag, Drivetrain, hysteresis, simulate, solve_line_contact, stick_slip, sweep
from hersey.errors import HerseyError, ParameterError, UnfinishedError
from hersey.lubrication.contact import shore_a_modulus
from hersey.lubrication.lubricant import Lubricant
from hersey.lubrication.reynolds import ThickeningFluid

TRAIN = Drivetrain(1000, 1)
PAPER = {"ehl_exponent": -0.7, "mixed_exponent": -1.2, "stick_speed": 0.01}
DRAG = Drag(50, 1, **PAPER)


def fields(error: ParameterError) -> tuple[object, ...]:
    return error.quantity, error.value, error.limit, error.unit


def test_a_refused_value_is_named_with_its_limit() -> None:
    with pytest.raises(ParameterError) as caught:
        Drag(50, 1, **PAPER | {"stick_speed": 2.0})
    assert fields(caught.value) == ("stick_speed", 2.0, 1.0, None)
    assert str(caught.value) == "stick_speed is 2: it must be less than 1"
    assert isinstance(caught.value, HerseyError)
    assert isinstance(caught.value, ValueError)
    with pytest.raises(ParameterError) as caught:
        shore_a_modulus(90.0)
    assert fields(caught.value) == ("Shore A hardness", 90.0, 80.0, None)
    with pytest.raises(ParameterError) as caught:
        solve_line_contact(0.015, 1136, 0.1, 0.1, effective_modulus=-2e6)
    assert fields(caught.value) == ("effective_modulus", -2e6, 0.0, "Pa")
    assert str(caught.value) == "effective_modulus is -2000000: it must be greater than 0"
    with pytest.raises(ParameterError) as caught:
        Drag(50, 1, **PAPER, closure="glue")
    assert caught.value.quantity == "closure"
    with pytest.raises(ParameterError) as caught:
        hysteresis(TRAIN, DRAG, tolerance=1.0)
    assert caught.value.quantity == "tolerance"


def test_fields_survive_pickling_and_a_word_on_the_place() -> None:
    points = [(313.15, -0.1), (373.15, 0.01)]
    with pytest.raises(ParameterError) as caught:
        Lubricant("arrhenius", points, name="oil")
    error = caught.value
    assert str(error) == "viscosities of oil: viscosity is -0.1: it must be greater than 0"
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), fields(again)) == (str(error), ("viscosity", -0.1, 0.0, "Pa*s"))


def test_one_of_many_sets_is_counted() -> None:
    with pytest.raises(ParameterError) as caught:
        sweep(TRAIN, DRAG, drive_speed=1.0, stick_speed=[0.01, 0.02, 3.0])
    assert caught.value.index == 2
    assert str(caught.value) == "set 2: stick_speed is 3: it must be less than 1"


def test_what_does_not_end_is_no_mistake_of_the_user() -> None:
    # bristles so stiff that no step of them ends in a number
    bristles = Drag(50, 1, **PAPER, closure="lugre", bristle_stiffness=1e308, bristle_damping=1e308)
    with pytest.raises(UnfinishedError) as caught:
        simulate(TRAIN, bristles, drive_speed=1.5, duration=1.0, samples=2)
    assert not isinstance(caught.value, ValueError)
    assert isinstance(caught.value, RuntimeError)
    assert caught.value.time is not None
    assert 0 <= caught.value.time < 1.0
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.time == caught.value.time


def test_a_lost_film_says_where() -> None:
    oil = ThickeningFluid(0.04, pressure_viscosity=2.2e-8, thickening="barus")
    with pytest.raises(UnfinishedError) as caught:
        solve_line_contact(0.01, 2e6, 0.01, oil, effective_modulus=4.6e11)
    assert caught.value.quantity in ("pressure_viscosity", "entrainment_speed")
    assert caught.value.value is not None
    assert caught.value.value >= 0
    assert caught.value.unit in ("1/Pa", "m/s")


def test_a_steady_start_stands_in_the_core_alone() -> None:
    nudged = stick_slip(TRAIN, DRAG, drive_speed=0.5, start="steady")
    assert nudged.kind == "stick_slip"
    run = simulate(TRAIN, DRAG, drive_speed=2.0, start="steady", duration=1.0, samples=11)
    assert np.ptp(run.belt_speed) < 1e-12
    with pytest.raises(ParameterError) as caught:
        simulate(Drivetrain(0.0, 1), DRAG, drive_speed=1.0, start="steady", duration=1.0)
    assert caught.value.quantity == "stiffness"


def test_speeds_of_a_force_are_the_inverse_of_the_law() -> None:
    slower, faster = DRAG.speeds_of(80.0)
    assert slower < 1.0 < faster
    assert DRAG.force([slower, faster]) == pytest.approx([80.0, 80.0], rel=1e-13)
    assert DRAG.speeds_of(1e3)[0] == 0.0
    warm = Drag(50, 1, **PAPER, reference_temperature=450.0, force_temperature_exponent=-2.0)
    at = warm.speeds_of(80.0, temperature=400.0)
    assert warm.force(at, temperature=400.0) == pytest.approx([80.0, 80.0], rel=1e-13)
