"""Motor current, its constant, gears and inertia as arguments: the same as in a mapping."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.cli.options import Reading
from hersey.damping.recipe import Recipe
from hersey.errors import ParameterError, UnitError
from hersey.log.mapping import read_with_mapping

MAPPING = """[torque]
channel = "Iq"
motor_constant = "0.11 N*m/A"
gear_ratio = 50
inertia = "2e-4 kg*m^2"
[speed]
gear_ratio = 50
"""


@pytest.fixture
def log(tmp_path: Path) -> Path:
    time = np.arange(400) * 0.05
    rpm = np.interp(time, [0, 8, 12, 20], [1000, 1000, 3000, 3000])
    rows = "".join(f"{t:.2f},{900 + t:.3f},{w:.3f}\n" for t, w in zip(time, rpm, strict=True))
    path = tmp_path / "log.csv"
    path.write_text("Time [s],Iq [mA],Speed [rpm]\n" + rows)
    return path


def test_a_current_as_arguments_is_that_of_a_mapping(log: Path, tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(MAPPING)
    (stated,) = read_with_mapping(log, mapping=tmp_path / "m.toml", isothermal=True).log.runs
    (run,) = read_with_mapping(
        log,
        channels={"torque": "Iq"},
        torque_constant="110 mN*m/A",  # type: ignore[arg-type]
        gear_ratio=50,
        speed_gear_ratio=50,
        inertia="2 kg*cm^2",  # type: ignore[arg-type]
        isothermal=True,
    ).log.runs
    np.testing.assert_allclose(run.torque, stated.torque, rtol=1e-12)
    np.testing.assert_array_equal(run.speed, stated.speed)
    held = run.time < 7
    np.testing.assert_allclose(run.torque[held], 50 * 0.11e-3 * (900 + run.time[held]), rtol=1e-9)
    rising = (run.time > 9) & (run.time < 11)
    slope = 2000 * np.pi / 30 / 50 / 4
    expected = 50 * 0.11e-3 * (900 + run.time[rising]) - 2e-4 * slope
    np.testing.assert_allclose(run.torque[rising], expected, rtol=1e-6)


def test_options_recipe_and_file_agree(log: Path, tmp_path: Path) -> None:
    typed = Reading(
        current="Iq",
        torque_constant="0.11 N*m/A",
        gear_ratio="50:1",
        moving=True,
        inertia="2e-4 kg*m^2",
        isothermal=True,
    ).recipe([log])
    written = Recipe(
        logs=(log,),
        channels={"torque": "Iq"},
        torque_constant="0.11 N*m/A",  # type: ignore[arg-type]
        gear_ratio=50.0,
        moving=True,
        inertia=2e-4,
        isothermal=True,
    )
    assert typed == written
    written.save(tmp_path / "recipe.toml")
    assert Recipe.from_file(tmp_path / "recipe.toml") == written
    again, logs = Reading(recipe_file=str(tmp_path / "recipe.toml")).completed(set())
    assert again.recipe(logs) == written
    inspection = hersey.inspect(log, channels={"torque": "Iq"}, torque_constant=0.11, isothermal=True)
    assert [each.name for each in inspection.corrections] == ["torque from current"]


def test_what_contradicts_itself_is_refused(log: Path) -> None:
    with pytest.raises(ParameterError, match=r"--torque-constant '0.11 N\*m/A'"):
        Reading(current="Iq").recipe([log])
    with pytest.raises(ParameterError, match="--torque and --current both name the torque"):
        Reading(current="Iq", torque="Tq", torque_constant="1 N*m/A").recipe([log])
    with pytest.raises(ParameterError, match="--gear-ratio is '1/50': write a number"):
        Reading(gear_ratio="1/50").recipe([log])
    with pytest.raises(ParameterError, match="gear_ratio is -1"):
        read_with_mapping(log, gear_ratio=-1)
    with pytest.raises(UnitError, match="'rpm' is not a unit of current"):
        read_with_mapping(log, channels={"torque": "Speed"}, units={"torque": "rpm"}, torque_constant=0.1)
