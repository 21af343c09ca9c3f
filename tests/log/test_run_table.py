"""A table of runs: speed, load, radius and temperature of each file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.damping.recipe import Recipe
from hersey.errors import HerseyError, ParameterError
from hersey.log.derived.run_table import read_run_table
from hersey.log.mapping import read_with_mapping
from hersey.schema.domain import Domain
from tests.cli.command import run

LOADS, RADII = (5.0, 10.0, 20.0), (12.5, 25.0, 50.0)
SPEEDS = np.repeat([0.01, 0.02, 0.05, 0.1, 0.2], 60)
#: Semicolons and decimal commas, a note, and rows in another order than the files.
TABLE = "File;Load [N];Track radius [mm];Note\n" + "".join(
    f"runs/{i}.csv;{load:g};{str(radius).replace('.', ',')};{'first' if not i else ''}\n"
    for i, (load, radius) in reversed(list(enumerate(zip(LOADS, RADII, strict=True))))
)


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    """Torques of a coefficient of 0.12 at three loads and radii, and their table."""
    for i, (load, radius) in enumerate(zip(LOADS, RADII, strict=True)):
        noise = np.random.default_rng(i).normal(1.0, 0.005, SPEEDS.size)
        arm = 1e-3 * radius
        table = {"Time [s]": 0.1 * np.arange(SPEEDS.size), "Torque [N*m]": 0.12 * load * arm * noise}
        pl.DataFrame(table | {"Speed [rad/s]": SPEEDS / arm}).write_csv(tmp_path / f"{i}.csv")
    (tmp_path / "runs.csv").write_text(TABLE)
    return tmp_path


def test_each_file_has_the_load_and_radius_of_its_row(rig: Path) -> None:
    files = [rig / f"{i}.csv" for i in range(3)]
    (rig / "m.toml").write_text('[names]\ntable = "runs.csv"\n')
    made = Recipe(logs=tuple(files), run_table=rig / "runs.csv", isothermal=True)
    made.save(rig / "recipe.toml")
    logs = [
        hersey.read(files, run_table=rig / "runs.csv", isothermal=True),
        read_with_mapping(files, mapping=rig / "m.toml", isothermal=True).log,
        Recipe.from_file(rig / "recipe.toml").log(),
    ]
    for log in logs:
        assert log.domain == Domain("friction coefficient", "sliding speed")
        for each, load in zip(log.runs, LOADS, strict=True):
            assert each.load is not None
            assert (each.load == load).all()
            np.testing.assert_allclose(each.speed, SPEEDS, rtol=1e-6)
    fitted = run("fit", *(f"{i}.csv" for i in range(3)), "--isothermal", "--run-table", "runs.csv", cwd=rig)
    assert fitted.words.startswith("Friction coefficient is constant: 0.1199")


def test_a_speed_and_a_temperature_are_those_of_the_row_and_that_is_said(tmp_path: Path) -> None:
    frame = pl.DataFrame({"Time [s]": 0.1 * np.arange(60), "COF": np.linspace(0.1, 0.11, 60)})
    frame.write_csv(tmp_path / "a.csv")
    (tmp_path / "runs.csv").write_text("log,speed [mm/s],temperature [degC]\na.csv,30,40\n")
    log = hersey.read(tmp_path / "a.csv", run_table=tmp_path / "runs.csv")
    (only,) = log.runs
    assert only.temperature is not None
    assert (only.speed[0], only.temperature[0]) == (pytest.approx(0.03), pytest.approx(313.15))
    said = [str(each) for each in log.files[0].warnings if each.kind == "value of a run table"]
    assert said == [
        "speed is 30.0 mm/s, from runs.csv; it was not measured",
        "temperature is 40.0 degC, from runs.csv; it was not measured",
    ]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("", "needs a column 'file', and others with units"),
        ("file\na.csv\n", "needs a column 'file', and others with units"),
        ("file,load\na.csv,3\n", "column 'load' has no unit. Write 'load [N]'"),
        ("file,load [rpm]\na.csv,3\n", "column 'load [rpm]': unit 'rpm' is not a unit of force"),
        ("file,load [N]\na.csv,high\n", "row 1: a.csv has no number in 'load [N]'"),
        ("file,load [N]\na.csv,3\nx/a.csv,4\n", "row 2: a.csv has a row already. Delete one"),
        ("file,Fn [N],Fz [N]\na.csv,3,4\n", "may both be the load. Call one of them 'load'"),
    ],
)
def test_tables_that_cannot_be(content: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "runs.csv").write_text(content)
    with pytest.raises(HerseyError, match=r"^runs\.csv") as refused:
        read_run_table(tmp_path / "runs.csv")
    assert said in str(refused.value)


def test_a_file_without_a_row_and_a_value_given_twice_are_refused(rig: Path) -> None:
    pl.read_csv(rig / "2.csv").head(100).write_csv(rig / "22.csv")
    table = {"run_table": rig / "runs.csv", "isothermal": True}
    with pytest.raises(ParameterError, match=r"list 22\.csv\. Did you mean '2\.csv' there\? Add a row"):
        hersey.read(rig / "22.csv", **table)
    with pytest.raises(ParameterError, match="run_table both give the load"):
        hersey.read(rig / "2.csv", load=5.0, **table)
    with pytest.raises(ParameterError, match="the table of runs and the file names both give the load"):
        hersey.read(rig / "2.csv", name_pattern="{load:N}.csv", **table)
