"""Drag laws against their formulas: both branches, temperature, tables and rolls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hersey.errors import ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag, DragTable

PLAIN = Drag(50, 2, ehl_exponent=-0.7, mixed_exponent=-1.3, stick_speed=0.01)
WARM = replace(
    PLAIN,
    reference_temperature=400.0,
    force_temperature_exponent=-2.0,
    speed_temperature_exponent=0.5,
    temperature_zero=273.15,
)


def test_both_branches() -> None:
    speeds = np.array([[0.02, 0.5], [2.0, 6.0]])
    expected = [[50 * 0.01**-0.3, 50 * 0.25**-0.3], [50.0, 50 * 3**0.3]]
    np.testing.assert_allclose(PLAIN.force(speeds), expected, rtol=1e-12)
    np.testing.assert_allclose(PLAIN.force(-speeds), -np.array(expected), rtol=1e-12)
    assert float(PLAIN.force(6.0)) == pytest.approx(50 * 3**0.3, rel=1e-12)


def test_what_a_belt_at_rest_bears() -> None:
    """Eq. 29."""
    peak = float(PLAIN.force(PLAIN.stick_speed))
    assert peak == pytest.approx(50 * (0.01 / 2) ** -0.3, rel=1e-9)
    assert PLAIN.breakaway_force >= peak * (1 - 1e-9)
    assert PLAIN.breakaway_force == pytest.approx(replace(PLAIN, ehl_exponent=-0.4).breakaway_force)
    assert replace(PLAIN, transition_force=100).breakaway_force == pytest.approx(2 * PLAIN.breakaway_force)


@pytest.mark.parametrize("kelvin", [373.15, 400.0, 450.0])
def test_all_forces_and_all_speeds_move_with_temperature(kelvin: float) -> None:
    ratio = (kelvin - 273.15) / (400.0 - 273.15)
    law = WARM.at(kelvin)
    assert law.transition_force == pytest.approx(50 * ratio**-2.0, rel=1e-12)
    assert law.transition_speed == pytest.approx(2 * ratio**0.5, rel=1e-12)
    assert law.stick_speed == pytest.approx(0.01 * ratio**0.5, rel=1e-12)
    assert (law.ehl_exponent, law.mixed_exponent, law.closure) == (-0.7, -1.3, "retained")
    assert not law.varies_with_temperature
    assert law.temperature_zero == 0.0
    speeds = np.array([0.02, 0.5, 6.0])
    np.testing.assert_allclose(WARM.force(speeds, temperature=kelvin), law.force(speeds), rtol=1e-12)


def test_a_law_in_kelvin_counts_from_zero() -> None:
    law = replace(WARM, temperature_zero=0.0).at(420.0)
    assert law.transition_force == pytest.approx(50 * (420 / 400) ** -2.0, rel=1e-12)


def test_temperature_is_given_where_it_is_needed() -> None:
    assert WARM.varies_with_temperature
    assert not PLAIN.varies_with_temperature
    assert PLAIN.at(None) is PLAIN
    with pytest.raises(ParameterError, match=r"^the drag depends on temperature. Give temperature$"):
        WARM.at(None)
    with pytest.raises(ParameterError, match=r"^temperature is given, but the drag does not depend on it$"):
        PLAIN.at(400.0)


def test_drag_of_a_roll() -> None:
    drag = Drag.rotational(
        transition_torque=2.0,
        transition_speed=10.0,
        roll_radius=0.04,
        ehl_exponent=-0.7,
        mixed_exponent=-1.2,
        stick_speed=0.003,
    )
    assert (drag.transition_force, drag.transition_speed) == (50.0, 0.4)
    assert drag.stick_speed == 0.003
    with pytest.raises(ParameterError, match=r"^roll_radius is 0: it must be greater than 0$"):
        Drag.rotational(transition_torque=2.0, transition_speed=10.0, roll_radius=0)
    train = Drivetrain.rotational(stiffness=2.0, inertia=4e-4, roll_radius=0.04)
    assert (train.stiffness, train.mass) == (pytest.approx(1250.0), pytest.approx(0.25))


def test_a_table_is_straight_in_logarithms() -> None:
    table = DragTable((0.01, 0.1, 1.0, 3.0), (120.0, 80.0, 50.0, 70.0), stick_speed=0.01)
    outer = np.log(70 / 50) / np.log(3)
    cases = {
        0.1: 80.0,
        np.sqrt(0.1 * 1.0): np.sqrt(80.0 * 50.0),
        np.sqrt(0.01 * 0.1): np.sqrt(120.0 * 80.0),
        9.0: 50.0 * 9.0**outer,
        -1.0: -50.0,
    }
    np.testing.assert_allclose(table.force(list(cases)), list(cases.values()), rtol=1e-9)
    assert table.law().transition_speed == 1.0
    assert table.law().stick_speed == 0.01
    for wrong in (((0.1,), (1.0,)), ((0.2, 0.1), (1.0, 2.0)), ((0.1, 0.2), (1.0, -2.0))):
        with pytest.raises(ParameterError):
            DragTable(*wrong, stick_speed=0.01)


def test_bristles_reach_the_law() -> None:
    soft, stiff = (
        Drag(
            50,
            1,
            ehl_exponent=-0.7,
            mixed_exponent=-1.2,
            stick_speed=0.01,
            closure="lugre",
            bristle_stiffness=stiffness,
            bristle_damping=10.0,
        )
        for stiffness in (1e4, 1e5)
    )
    from hersey.motion.simulation import simulate

    train = Drivetrain(1000, 1)
    runs = [simulate(train, d, drive_speed=0.4, duration=0.05, samples=5) for d in (soft, stiff)]
    assert runs[0].stretch[-1] != pytest.approx(runs[1].stretch[-1], rel=1e-4)


def test_a_table_varies_with_temperature_as_two_branches_do() -> None:
    """Two power laws as a law and as a table, at three temperatures; the no-load torque changes by itself."""
    warm = {
        "reference_temperature": 423.15,
        "temperature_zero": 273.15,
        "force_temperature_exponent": -0.4,
        "speed_temperature_exponent": 2.9,
        "rest_force": 3.0,
        "rest_damping": 20.0,
        "rest_temperature_slope": -0.002,
    }
    law = Drag(14.0, 0.025, -0.7, -1.2, stick_speed=1e-3, **warm)  # type: ignore[arg-type]
    speeds = np.array([5e-4, 0.025, 0.4])
    shape = tuple((14.0 * (speeds / 0.025) ** np.where(speeds < 0.025, -0.2, 0.3)).tolist())
    table = DragTable(tuple(speeds.tolist()), shape, stick_speed=1e-3, **warm)  # type: ignore[arg-type]
    asked = np.geomspace(2e-3, 0.3, 7)
    for kelvin in (363.15, 423.15, 463.15):
        # T^-0.4 and T^2.9 in degC, by hand
        ratio = (kelvin - 273.15) / 150.0
        scaled = asked / ratio**2.9
        film = 14.0 * ratio**-0.4 * (scaled / 0.025) ** np.where(scaled < 0.025, -0.2, 0.3)
        rest = (3.0 + 20.0 * asked) * (1.0 - 0.002 * (kelvin - 423.15))
        assert table.force(asked, temperature=kelvin) == pytest.approx(film + rest, rel=1e-12)
        assert table.at(kelvin).force(asked) == pytest.approx(film + rest, rel=1e-12)
        assert law.force(asked, temperature=kelvin) == pytest.approx(film + rest, rel=1e-12)
        assert table.at(kelvin).stick_speed == pytest.approx(1e-3 * ratio**2.9, rel=1e-12)
        assert not table.at(kelvin).varies_with_temperature
