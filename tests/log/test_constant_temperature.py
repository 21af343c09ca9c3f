"""A temperature that never changes is seen where it is excluded, beside the points of a machine."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import polars as pl
import pytest

import hersey
from hersey import testbench
from hersey.log.constant_temperature import CONSTANT_TEMPERATURE, POOLED
from hersey.machine import read_machine
from hersey.study.findings import Findings
from hersey.study.first_screen.flags import flags
from hersey.study.first_screen.temperature import temperature_unknown
from hersey.verdict.regime import regime
from tests.conftest import ROOT

TEMPERATURE = testbench.COLUMNS[3]
SAID = "'Heater temperature' reads 25 degC in every row, so the sensor may be dead"


def written(folder: Path, ending: str, temperature: pl.Expr | None) -> Path:
    table = testbench.run(seed=3).table
    path = folder / f"log.{ending}"
    table = table if temperature is None else table.with_columns(temperature.alias(TEMPERATURE))
    table.write_csv(path) if ending == "csv" else table.write_parquet(path)
    return path


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_a_constant_temperature_that_is_excluded_is_a_warning(tmp_path: Path, ending: str) -> None:
    dead = hersey.read(written(tmp_path, ending, pl.lit(25.0)), isothermal=True)
    [found] = [each for each in dead.files[0].warnings if each.kind == CONSTANT_TEMPERATURE]
    assert str(found) == SAID
    assert found.values == {"column": "Heater temperature", "temperature": 298.15}
    for other in (None, pl.lit("25 °C"), pl.lit(None, pl.Float64)):
        log = hersey.read(written(tmp_path, ending, other), isothermal=True)
        assert CONSTANT_TEMPERATURE not in [each.kind for each in log.files[0].warnings]


@pytest.mark.parametrize("beside", ["", ",Edge temperature [degC]"])
def test_a_temperature_that_varies_and_is_excluded_is_a_warning(tmp_path: Path, beside: str) -> None:
    """40 to 60 degC but for a tenth at each end: viscosity halves. 19 K are no matter."""
    path = tmp_path / "log.csv"
    for span, is_said in ((25.0, True), (20.0, False)):
        rows = [f"{t},1,{1 + t // 20},{40 + span * t / 100}{',20' * bool(beside)}" for t in range(101)]
        path.write_text(
            f"time [s],torque [N*m],speed [rpm],Oil temperature [degC]{beside}\n" + "\n".join(rows)
        )
        found = [w for w in hersey.read(path, isothermal=True).files[0].warnings if w.kind == POOLED]
        assert [str(each) for each in found] == is_said * [
            "temperature 'Oil temperature' is excluded, but ranges from 42.5 degC to 62.5 degC: friction "
            "at all of them is taken as that at one"
        ]


def test_only_points_at_another_temperature_are_warned_of(tmp_path: Path) -> None:
    points = hersey.read(written(tmp_path, "csv", pl.lit(25.0)), isothermal=True).steady()
    machine = read_machine(ROOT / "examples" / "machine.toml")
    surface = hersey.fit(points)
    known = Findings(points=points, surface=surface, regime=regime(points, surface), machine=machine)
    [found] = [each for each in flags(known) if each.kind == "temperature of the log unknown"]
    assert found.text == (
        f"log.csv: {SAID}, and full speed is at 180 degC. Check the sensor and record again."
    )
    assert (found.severity, found.where) == ("act", "data")
    cold = tuple(replace(point, temperature=300.0) for point in machine.points)
    for other in (replace(machine, points=cold), replace(machine, points=()), None):
        assert not [*temperature_unknown(points, other)]
