"""Sweeps described by a file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import HerseyError
from hersey.motion.scenario import read_scenario, rows, summary
from tests.cli.command import run
from tests.conftest import ROOT

PLAIN = """
[parameters]
stiffness = [500, 1000]
mass = 1
transition_force = 50
transition_speed = 1
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_speed = { from = 0.4, to = 1.6, count = 3 }
[options]
units = "consistent"
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "scenario.toml"
    path.write_text(text)
    return path


def test_a_scenario_is_the_sweep_it_describes(tmp_path: Path) -> None:
    result = read_scenario(write(tmp_path, PLAIN)).run()
    drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    same = hersey.sweep(hersey.Drivetrain(1000, 1), drag, stiffness=[500, 1000], drive_speed=[0.4, 1.0, 1.6])
    np.testing.assert_array_equal(result.frequency, same.frequency)
    counted = summary(result)
    assert counted["kinds"] == {"stick_slip": 6}
    assert counted["stick_slip"]["frequency"] == [float(same.frequency.min()), float(same.frequency.max())]


def test_units_are_read() -> None:
    scenario = read_scenario(ROOT / "examples" / "scenario.toml")
    assert scenario.parameters["stiffness"][0] == pytest.approx(2000.0)
    assert scenario.parameters["stiffness"][-1] == pytest.approx(40000.0)
    assert scenario.parameters["drive_speed"][0] == pytest.approx(0.005)
    assert scenario.sets == 24 * 3 * 32


def test_rows_hold_every_set(tmp_path: Path) -> None:
    result = read_scenario(write(tmp_path, PLAIN)).run()
    path = tmp_path / "rows.parquet"
    path.write_bytes(rows(result, ".parquet"))
    table = pl.read_parquet(path)
    assert table.shape[0] == 6
    row = table.filter((pl.col("stiffness") == 1000) & (pl.col("drive_speed") == 1.0))
    assert row["frequency"][0] == pytest.approx(3.940314, rel=1e-6)
    assert row["kind"][0] == "stick_slip"
    assert rows(result, ".csv").startswith(b"stiffness,mass,")


def test_the_command_writes_and_counts(tmp_path: Path) -> None:
    write(tmp_path, PLAIN)
    done = run("sweep", "scenario.toml", "--out", "sweep.csv", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.words.startswith("6 sets of parameters stick-slip 6 (100 %)")
    assert done.stdout.endswith("\nsweep.csv\n")
    assert run("sweep", "scenario.toml", "--out", "sweep.csv", cwd=tmp_path).returncode == 2
    counted = json.loads(run("sweep", "scenario.toml", "--json", cwd=tmp_path).stdout)
    assert counted["sets"] == 6
    refused = run("sweep", "scenario.toml", "--out", "sweep.xlsx", cwd=tmp_path)
    assert (refused.returncode, "parquet" in refused.stderr) == (2, True)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("mass = 1", "", "has no 'mass'"),
        ("mass = 1", "mass = -1", "mass is -1"),
        ("mass = 1", "mass = '1 kg'", "not a number"),
        ("mass = 1", "mass = true", "not a number"),
        ("mass = 1", "mass = []", "empty"),
        ("mass = 1", "mass = nan", "mass"),
        ("mass = 1", "weight = 1", "weight"),
        ("count = 3", "count = 0", "count"),
        ("count = 3", "count = 1000000000000", "count"),
        ("count = 3", "count = 3, spacing = 'cubic'", "cubic"),
        ("from = 0.4", "from = 0, spacing = 'log'", "log"),
        ("from = 0.4, ", "", "needs the key 'from'"),
        ('units = "consistent"', "", "with its unit"),
        ('units = "consistent"', 'units = "imperial"', "imperial"),
        ("[options]", "[option]", "option"),
        ("[parameters]", "parameters = 1", "parameters"),
        ("[options]", "[options]\nclosure = 'glue'", "glue"),
        ("[options]", "[options]\nstart = 'flying'", "flying"),
        ("[options]", "[options]\ntolerance = 1.0", "tolerance"),
        ("[options]", "[options]\nduration = -1", "duration"),
        ("stick_speed = 0.01", "stick_speed = 2", "stick_speed is 2"),
        ("[parameters]", "[parameters", "TOML"),
    ],
)
def test_what_is_no_scenario_gets_one_line(tmp_path: Path, old: str, new: str, says: str) -> None:
    assert old in PLAIN
    path = write(tmp_path, PLAIN.replace(old, new))
    with pytest.raises(HerseyError, match=says):
        read_scenario(path).run()


def test_a_missing_scenario_is_named(tmp_path: Path) -> None:
    with pytest.raises(HerseyError, match=r"nowhere\.toml"):
        read_scenario(tmp_path / "nowhere.toml")
