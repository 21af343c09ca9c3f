"""What temperature tells: activation energies, collapse on the Hersey number, laws of viscosity."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from hersey.damping.candidates import compare_models, hersey_collapse, temperature_collapse, viscosity_laws
from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.energy import CALORIE
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, GAS_CONSTANT, Thermal
from hersey.errors import InsufficientDataError, ParameterError
from tests.conftest import shared
from tests.damping.candidates.test_comparison import LAWS, REFERENCE, dwells

#: Apparent activation energy of torque in the paper, cal/mol, and torque's exponent in viscosity.
PAPER, POWER = 9460.77, 0.3


def test_the_paper_s_energy_of_torque_and_viscosity() -> None:
    e = PAPER * CALORIE / (GAS_CONSTANT * REFERENCE)
    law = Law(Thermal(ARRHENIUS, REFERENCE), HELD)
    data = dwells(law, [0.1, e, POWER - 1.0, -1.2, -6.0], scatter=0.01)
    found = compare_models(data, bootstrap=0, cross_validate=False).energies
    assert found.torque is not None
    assert found.viscosity is not None
    assert found.torque.low < PAPER * CALORIE < found.torque.high
    assert found.viscosity.low < PAPER * CALORIE / POWER < found.viscosity.high
    assert found.torque.value / CALORIE == pytest.approx(PAPER, rel=0.02)
    assert "cal/mol" in found.lines()[0]


@pytest.mark.parametrize(("share", "agree"), [(1.0, True), (0.6, False)])
def test_energy_of_the_transition_against_that_of_torque(share: float, agree: bool) -> None:
    d = -share * 2.8 / 0.3
    data = dwells(Law(Thermal(ARRHENIUS, REFERENCE), FREE), [0.1, 2.8, -0.7, -1.2, -0.9, d])
    found = compare_models(data, bootstrap=0, cross_validate=False).energies
    assert found.transition is not None
    assert found.transition.value == pytest.approx(-d * GAS_CONSTANT * REFERENCE, rel=0.06)
    assert found.p_value is not None
    assert (found.p_value > 0.05) is agree
    assert ("disagree" in found.verdict) is not agree


def test_energies_at_other_temperatures_differ_unless_arrhenius() -> None:
    of_power = compare_models(dwells(*LAWS["power-degC/one"]), bootstrap=0, cross_validate=False)
    cold, _, hot = (energy for _, energy in of_power.energies.local)
    assert of_power.chosen.candidate.key == "power-degC/one"
    # -b R T^2 / T_degC, by hand, at 363 K
    assert cold == pytest.approx(0.9 * GAS_CONSTANT * 363.0**2 / (363.0 - 273.15), rel=0.02)
    assert hot < cold


def test_no_energy_of_viscosity_where_torque_does_not_tell() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), ONE)
    found = compare_models(dwells(law, [0.1, 2.8, -1.0]), bootstrap=0, cross_validate=False).energies
    assert found.viscosity is None
    assert found.torque is not None
    assert "Record faster speeds" in found.verdict


def test_temperatures_of_one_stribeck_curve_collapse() -> None:
    law, values = LAWS["stribeck"]
    assert isinstance(law, StribeckLaw)
    data = dwells(law, values)
    found = temperature_collapse(data)
    assert found.collapses
    assert found.spread_before > 3 * found.deviation
    # viscosity falls as exp(e s(T))
    assert law.thermal is not None
    expected = values[1] * law.thermal.shape(data.temperatures)[0]
    assert found.shifts == pytest.approx(expected - expected[0], abs=0.15)


def test_temperatures_with_exponents_of_their_own_do_not_collapse() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), ONE, groups=4)
    found = temperature_collapse(dwells(law, [0.1, 2.8, -0.3, -0.5, -0.9, -1.2]))
    assert found.collapses is False
    assert "do NOT collapse" in found.verdict


def test_curves_without_a_common_number_are_not_judged() -> None:
    x = np.concatenate([np.linspace(0, 1, 6), np.linspace(5, 6, 6)])
    found = hersey_collapse(x, 0.3 * x, np.repeat([0, 1], 6))
    assert found.collapses is None
    assert "cannot be determined" in found.verdict


def test_collapse_refuses_what_it_cannot_judge() -> None:
    with pytest.raises(InsufficientDataError, match="one curve cannot collapse"):
        hersey_collapse(np.arange(5.0), np.arange(5.0), np.zeros(5))
    with pytest.raises(InsufficientDataError, match="fewer than 3"):
        hersey_collapse(np.arange(4.0), np.arange(4.0), [0, 0, 1, 1])
    with pytest.raises(ParameterError, match="must be positive"):
        hersey_collapse([0.0, np.nan, 1.0], np.zeros(3), np.zeros(3))


def test_the_newport_oil_contact_does_not_collapse() -> None:
    """16 loads at 3 speeds: friction against speed over load, each speed a curve."""
    number, friction, group = [], [], []
    for path in sorted(shared("data/friction/newport_oil_stribeck/Motor_oil_glass").glob("*.txt")):
        rows = np.genfromtxt(path, delimiter=";", skip_header=1)
        force, torque, speed = np.abs(rows[:, [2, 3, 5]]).T
        turning = np.flatnonzero((speed > 0.5 * np.median(speed)) & (torque > 1e-6) & (force > 0.05))
        late = turning[turning.size // 2 :]  # run in; torque is nil once the sphere is lifted
        load = np.median(force[late])
        number.append(np.log(np.median(speed[late]) / load))
        friction.append(np.log(np.median(torque[late]) / load))
        group.append(path.name.split("rps")[0])
    assert len(number) == 48
    found = hersey_collapse(number, friction, group)
    assert found.collapses is False
    assert found.deviation > 0.3
    assert "Do not draw one Stribeck curve" in found.verdict


def test_glycerol_is_given_vft_over_arrhenius() -> None:
    path = shared("data/tables/glycerol_water_viscosity_Segur1951.csv")
    rows = list(csv.reader(path.read_text().splitlines()))
    kelvin = np.array([float(name.split("C_")[0]) + 273.15 for name in rows[0][1:]])
    pure = next(r for r in rows[1:] if r[0] == "100")
    found = viscosity_laws(kelvin, np.array([float(v) for v in pure[1:]]))
    assert found.chosen.candidate.thermal == "VFT"
    by_law = {r.candidate.thermal: r for r in found.candidates}
    assert by_law["Arrhenius"].delta_aicc > 20
    # Arrhenius over the whole table: 56.3 kJ/mol, errors up to 36 % (least squares of ln viscosity on 1/T)
    assert found.activation_energy.value / 1e3 == pytest.approx(56.3, abs=1.0)
    assert np.max(np.abs(np.expm1(by_law["Arrhenius"].fit.residuals))) > 0.25
    assert np.max(np.abs(by_law["VFT"].fit.residuals)) < 0.05
    assert dict(found.refused)["power law in degC"] == "T^b is not defined at or below 0 degC"
    q = found.chosen.fit.values[2]
    assert 100.0 < by_law["VFT"].fit.law.thermal.reference - 1.0 / q < 250.0  # type: ignore[union-attr]


def test_viscosity_laws_refuse_what_is_no_table() -> None:
    with pytest.raises(ParameterError, match="must be positive"):
        viscosity_laws([300.0, 310.0, 320.0], [1.0, 0.0, 2.0])
    with pytest.raises(InsufficientDataError):
        viscosity_laws([300.0, 310.0, 320.0], [3.0, 2.0, 1.5])
