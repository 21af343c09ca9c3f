"""Coulomb, viscous and Stribeck friction: values written out, and derivatives by differences."""

import numpy as np
import pytest

from hersey.damping.friction_curve.law import FrictionLaw


def test_values_written_out() -> None:
    """Stribeck friction at its Stribeck speed: T_C + (T_S - T_C)/e + k_v w."""
    law = FrictionLaw(stribeck=True)
    assert law.names == ("T_C", "T_S", "w_S", "k_v")
    values, speed = np.array([0.2, 0.5, 2.0, 0.1]), np.array([-2.0, 0.0, 2.0])
    at = 0.2 + 0.3 / np.e + 0.2
    assert law.torque(values, speed) == pytest.approx([-at, 0.0, at])


def test_each_direction_has_its_own() -> None:
    """Forward 1 + 2 w, reverse 3 + 4 w, thinned by half per ln 2 / s kelvin."""
    law = FrictionLaw(apart=True, reference_kelvin=300.0)
    assert law.names == ("T_C+", "k_v+", "T_C-", "k_v-", "s")
    values = np.array([1.0, 2.0, 3.0, 4.0, np.log(2.0) / 10.0])
    torque = law.torque(values, np.array([1.0, -1.0, 1.0]), np.array([300.0, 300.0, 310.0]))
    assert torque == pytest.approx([3.0, -7.0, 2.0])


@pytest.mark.parametrize("stribeck", [False, True])
@pytest.mark.parametrize("apart", [False, True])
@pytest.mark.parametrize("reference", [None, 300.0])
def test_derivatives(stribeck: bool, apart: bool, reference: float | None) -> None:
    """By parameters and by speed, against central differences."""
    law = FrictionLaw(stribeck, apart, reference)
    size = len(law.names)
    values = np.random.default_rng(1).uniform(0.5, 1.5, size)
    if reference is not None:
        values[-1] = 0.02
    speed, kelvin, step = np.linspace(-3.0, 3.0, 14), 290.0 + np.arange(14.0), 1e-6
    ends = [(values + step * each, values - step * each) for each in np.eye(size)]
    numeric = [(law.torque(a, speed, kelvin) - law.torque(b, speed, kelvin)) / (2 * step) for a, b in ends]
    assert pytest.approx(np.array(numeric), rel=1e-6, abs=1e-6) == law.jacobian(values, speed, kelvin).T
    slope = (law.torque(values, speed + step, kelvin) - law.torque(values, speed - step, kelvin)) / (2 * step)
    assert law.slope(values, speed, kelvin) == pytest.approx(slope, rel=1e-6, abs=1e-6)
