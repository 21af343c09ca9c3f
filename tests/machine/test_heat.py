"""The table [heat] of the machine file: SI, what is not stated, and who starts how warm."""

from __future__ import annotations

from pathlib import Path

import pytest

import hersey
from tests.conftest import ROOT

TEXT = (ROOT / "tests" / "stand" / "machine.toml").read_text()


def test_bodies_start_as_warm_as_the_surroundings_unless_stated(tmp_path: Path) -> None:
    heat = hersey.read_machine(ROOT / "tests" / "stand" / "machine.toml").heat
    assert heat == hersey.HeatBalance(
        film_capacity=150.0,
        roll_capacity=250.0,
        exchange=12.0,
        film_loss=0.5,
        roll_loss=1.5,
        film_temperature=298.15,
        roll_temperature=298.15,
        surroundings=298.15,
        heater_power=900.0,
        setpoint=453.15,
    )
    path = tmp_path / "machine.toml"
    path.write_text(TEXT.replace("[heat]", '[heat]\nroll_temperature = "40 degC"\nroll_load = "0.3 kW"'))
    warm = hersey.read_machine(path).heat
    assert warm is not None
    assert (warm.film_temperature, warm.roll_temperature) == pytest.approx((298.15, 313.15))
    assert (warm.film_load, warm.roll_load) == (0.0, 300.0)


def test_a_machine_without_the_table_has_no_heat(tmp_path: Path) -> None:
    head, _, tail = TEXT.partition("[heat]")
    path = tmp_path / "machine.toml"
    path.write_text(head + tail[tail.index("\n[") :])
    assert hersey.read_machine(path).heat is None
