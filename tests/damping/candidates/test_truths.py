"""Truths of the virtual test stand beyond the default, and candidates on their logs and on logs by others."""

from __future__ import annotations

import hashlib
import io

import numpy as np
import pytest

import hersey
from hersey import testbench
from hersey.damping.candidates import compare_models
from hersey.damping.candidates.thermal import GAS_CONSTANT
from hersey.errors import ParameterError
from tests.conftest import shared

HOT = np.array([90.0, 120.0, 150.0, 180.0])
#: Of `testbench.run(seed=3)` as written before these truths existed.
DIGEST = "af728917aeca3a6b0041659eedf9a375ab0b9fa5b22a35a9b12f87c3477e81f5"


def test_the_default_log_is_what_it_was() -> None:
    text = io.StringIO()
    testbench.run(seed=3).write(text)  # type: ignore[arg-type]
    assert hashlib.sha256(text.getvalue().encode()).hexdigest() == DIGEST
    assert "law" not in testbench.run(seed=3).truth_document()["truth"]  # type: ignore[operator]


def test_a_power_law_in_degrees_is_the_default() -> None:
    default = testbench.Truth()
    energy = 0.9 * GAS_CONSTANT * 423.15**2 / 150.0
    same = testbench.ThermalTruth(law="degC", activation_energy=energy)
    for speed in (0.3, 1.3, 9.0):
        w = np.full(HOT.size, speed)
        assert same.torque(w, HOT) == pytest.approx(default.torque(w, HOT), rel=1e-12)
    assert same.transition_speed(HOT) == pytest.approx(default.transition_speed(HOT), rel=1e-12)
    assert same.torque(np.zeros(4), HOT) == pytest.approx(np.zeros(4))


@pytest.mark.parametrize("law", ["degC", "K", "Arrhenius", "VFT"])
def test_the_apparent_energy_is_the_one_asked_for(law: str) -> None:
    truth = testbench.ThermalTruth(law=law, activation_energy=2.0e4)
    ends = np.array([149.99, 150.01])
    slope = np.diff(np.log(truth.torque(np.full(2, 9.0), ends))) / np.diff(1.0 / (ends + 273.15))
    assert GAS_CONSTANT * slope[0] == pytest.approx(2.0e4, rel=1e-5)


def test_torque_is_continuous_at_the_transition() -> None:
    truth = testbench.ThermalTruth(transition_share=0.5, exponent_drift=1e-3)
    at = truth.transition_speed(HOT)
    assert truth.torque(at * (1 - 1e-9), HOT) == pytest.approx(truth.torque(at * (1 + 1e-9), HOT), rel=1e-7)


def test_stribeck_truth_depends_on_speed_and_viscosity_together() -> None:
    truth = testbench.StribeckTruth(activation_energy=2.0e4)
    w = 1.7 * truth.transition_speed(HOT)
    assert np.ptp(truth.torque(w, HOT)) < 1e-12
    with pytest.raises(ParameterError, match="law 'none' is not known"):
        testbench.ThermalTruth(law="none").torque(w, HOT)


def test_the_paper_s_energy_from_a_log(tmp_path) -> None:  # type: ignore[no-untyped-def]
    truth = testbench.ThermalTruth(activation_energy=9460.77 * 4.184)
    stand = testbench.Stand(temperatures_degC=(140.0, 155.0, 170.0, 185.0), stick_slip=False)
    path = tmp_path / "log.csv"
    testbench.run(seed=2, truth=truth, stand=stand).write(path)
    found = compare_models(hersey.read(path).steady(), bootstrap=0, cross_validate=False)
    assert found.energies.torque is not None
    assert found.energies.torque.value / 4.184 == pytest.approx(9460.77, rel=0.03)
    assert found.energies.viscosity is not None
    assert found.energies.viscosity.value / 4184.0 == pytest.approx(31.5, rel=0.05)


def test_screw_drive_one_has_a_transition_and_drive_two_none() -> None:
    """Measured by others: a torque minimum at 50 rpm, published Stribeck speed 61 rpm; drive 2 shows none."""
    units = {"torque": "-9.84 mN*m / 100", "speed": "-1 rpm"}
    found = []
    for drive in (1, 2):
        folder = shared(f"data/friction/tro2021_screw_drives/driveNo{drive}/steady_state")
        log = hersey.read(sorted(folder.glob("*.csv")), units=units, isothermal=True)
        found.append(compare_models(log.steady(rotation="forward"), bootstrap=0))
    one, two = found
    assert one.data.clustered_by == "run"
    assert one.chosen.candidate.key in ("isothermal/stribeck", "isothermal/two-free")
    corner = one.candidate("isothermal/two-free").fit
    c, mixed = (corner.values[corner.law.index(name)] for name in ("c", "c_mixed"))
    assert mixed < -1.0 < c
    rpm = np.geomspace(20.0, 180.0, 200)
    least = rpm[np.argmin(one.predict(speed=rpm * testbench.RPM).torque)]
    assert 45.0 < least < 70.0
    # of the laws without a falling branch, friction and a viscous part is the likelier, not beyond doubt
    assert two.chosen.candidate.key == "isothermal/coulomb-viscous"
    assert two.candidate("isothermal/one").delta_aicc < 6.0
    assert np.all(np.diff(two.predict(speed=rpm * testbench.RPM).torque) > 0)
    assert two.energies.torque is None
