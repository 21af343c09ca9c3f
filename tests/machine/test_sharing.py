"""What shares the load, as the machine file states it: the contact, and the drag of its belt."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.machine import Machine, read_machine
from tests.conftest import ROOT

TABLES = """
[asperities]
modulus = "3 GPa"
[boundary]
friction = 0.1
temperature_slope = "-0.1 %/K"
at = "180 degC"
static_friction = 0.15
[rest]
torque = "15 mN*m"
"""


def machine(folder: Path, tables: str = TABLES) -> Machine:
    path = folder / "machine.toml"
    path.write_text((ROOT / "tests" / "stand" / "machine.toml").read_text() + tables)
    return read_machine(path)


def test_the_file_makes_the_contact(tmp_path: Path) -> None:
    stated = machine(tmp_path)
    mixed = stated.mixed
    assert mixed is not None
    assert (mixed.asperities.modulus, mixed.asperities.sigma_beta_density) == (3e9, 0.05)
    assert mixed.friction.at("170 degC") == pytest.approx(0.101)
    thick = mixed.at(speed="500 rad/s", temperature="180 degC")
    assert stated.contact is not None
    assert stated.lubricant is not None
    cool = replace(stated.lubricant, conductivity=None)  # the law knows no heat of the inlet
    alone = hersey.drag_torque(stated.contact, cool, speed="500 rad/s", temperature="180 degC")
    assert thick.lambda_ratio > 5
    assert thick.torque == pytest.approx(alone, rel=5e-3)


def test_the_drag_has_rest_static_force_and_the_stick_speed_of_its_temperature(tmp_path: Path) -> None:
    drag = machine(tmp_path).mixed_drag("180 degC")
    assert drag.static_force == pytest.approx(0.15 * 300)
    assert drag.rest_force == pytest.approx(1.0)
    assert drag.stick_speed == 0.3e-3
    path = tmp_path / "machine.toml"
    path.write_text(path.read_text().replace("# stick_speed_temperature", "stick_speed_temperature"))
    warm = read_machine(path)
    assert warm.lubricant is not None
    cold, hot = warm.lubricant.viscosity(["150 degC", "180 degC"])
    assert warm.mixed_drag("180 degC").stick_speed == pytest.approx(0.3e-3 * cold / hot)
    still = machine(tmp_path, TABLES.replace("static_friction = 0.15", "")).mixed_drag("180 degC")
    assert still.static_force is None


def test_a_machine_that_states_nothing_shares_nothing(tmp_path: Path) -> None:
    plain = machine(tmp_path, "")
    assert plain.mixed is None
    with pytest.raises(hersey.errors.ParameterError, match=r"\[asperities\] modulus"):
        plain.mixed_drag("180 degC")


def test_the_transition_moves_with_roughness_as_is_said(tmp_path: Path) -> None:
    stated = machine(tmp_path)
    assert stated.contact is not None
    rough = 1.5e-6 * np.exp([-0.01, 0.0, 0.01])
    turns = []
    for sigma in rough:
        mixed = replace(stated, contact=replace(stated.contact, roughness=float(sigma))).mixed
        assert mixed is not None
        turns.append(mixed.transition("180 degC"))
    shift = np.log(float(turns[2].speed / turns[0].speed)) / 0.02
    assert float(turns[1].by_roughness) == pytest.approx(shift, rel=1e-3)
    assert float(turns[1].sensitivity["boundary"]) > 0
