"""A table of means is a row per dwell: from Python, and by the commands, without a clock."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pytest
from scipy.io import savemat

import hersey
from hersey.errors import ChannelError, InsufficientDataError, UnitError, UnreadableLogError
from hersey.log.mean_signs import is_means_table
from hersey.log.means import read_means
from tests.cli.command import run
from tests.damping.test_dwells import RPM

SPEEDS = (5.0, 10.0, 20.0, 40.0, 80.0, 140.0)


def torque(rpm: float, celsius: float) -> float:
    """Torque of B = 60 T^-1.2 w^-0.8, mN m."""
    return float(60e3 * celsius**-1.2 * (rpm * RPM) ** 0.2)


def table(header: str = "Temperature [degC],Speed [rpm],Torque [mN*m],Torque error [mN*m],n") -> str:
    rows = [f"{t:g},{v:g},{torque(v, t):.2f},2.5,12" for t in (90.0, 120.0, 150.0) for v in SPEEDS]
    return "\n".join([header, *rows]) + "\n"


def written(folder: Path, text: str, name: str = "means.csv") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_an_error_that_all_rows_of_a_table_share() -> None:
    """Rows of one table share it; two tables have one each; it follows the sign of the torque."""
    of = {"speed [rpm]": [10, -20], "torque [N*m]": [5.0, -6.0], "torque error [N*m]": [0.1, 0.2]}
    shared = of | {"shared torque error [mN*m]": [50, 60]}
    points = hersey.SteadyPoints.from_table(shared)
    assert points.column("torque_error").tolist() == [0.1, 0.2]
    assert points.window_errors.tolist() == [[0.05], [-0.06]]
    two = hersey.SteadyPoints.from_table([shared, of | {"shared torque error [%]": [1, 2]}])
    assert two.window_errors == pytest.approx(np.array([[0.05, 0], [-0.06, 0], [0, 0.05], [0, -0.12]]))
    assert not hersey.SteadyPoints.from_table(of).window_errors.size


def test_columns_by_name() -> None:
    points = hersey.SteadyPoints.from_table(
        {
            "speed [rpm]": [10, 20, -40],
            "torque [mN*m]": [5.0, 5.6, -6.3],
            "temperature [degC]": [20, 20, 60],
            "torque error [mN*m]": [0.1, 0.2, 0.3],
            "count": [7, 8, 9],
            "approach": ["up", "down", "sideways"],
            "run": ["a", "b", "a"],
        }
    )
    assert points.column("speed") / RPM == pytest.approx([10, 20, -40])
    assert points.column("torque") == pytest.approx([5.0e-3, 5.6e-3, -6.3e-3])
    assert points.column("torque_error") == pytest.approx([1e-4, 2e-4, 3e-4])
    assert points.column("temperature") == pytest.approx([293.15, 293.15, 333.15])
    assert points.column("effective_rows").tolist() == [7, 8, 9]
    assert points.table["approach"].to_list() == ["from below", "from above", "start"]
    assert points.column("run").tolist() == [0, 1, 0]
    assert points.tare_errors.shape == (3, 0)
    assert points.log.has_temperature


def test_a_frame_with_units_beside_it() -> None:
    frame = pl.DataFrame({"speed": [1.0, 2.0, 4.0], "torque": [1.0, 1.1, 1.2]})
    points = hersey.SteadyPoints.from_table(frame, units={"speed": "rad/s", "torque": "N*m"})
    assert points.column("speed").tolist() == [1.0, 2.0, 4.0]
    with pytest.raises(UnitError, match="no unit"):
        hersey.SteadyPoints.from_table(frame)
    with pytest.raises(ChannelError, match="no torque column"):
        hersey.SteadyPoints.from_table(frame.drop("torque"), units={"speed": "rad/s"})


def test_errors_in_percent_and_from_deviations() -> None:
    columns = {"speed [rpm]": [10.0, 20.0], "torque [N*m]": [2.0, 4.0]}
    percent = hersey.SteadyPoints.from_table(columns | {"uncertainty [%]": [1.0, 2.0]})
    assert percent.column("torque_error") == pytest.approx([0.02, 0.08])
    deviations = columns | {"torque std": [0.3, 0.6], "samples": [9, 36]}
    assert hersey.SteadyPoints.from_table(deviations).column("torque_error") == pytest.approx([0.1, 0.1])
    del deviations["samples"]  # a deviation without a count is no error of a mean
    points = hersey.SteadyPoints.from_table(deviations)
    assert points.column("torque_error").tolist() == [0.0, 0.0]
    assert "not stated; the scatter" in str(points.warnings[0])


def test_the_law_of_a_table_is_found(tmp_path: Path) -> None:
    surface = hersey.fit(hersey.SteadyPoints.from_table(written(tmp_path, table())))
    assert surface.c.value == pytest.approx(-0.8, abs=0.002)
    assert surface.b is not None
    assert surface.b.value == pytest.approx(-1.2, abs=0.005)
    assert surface.data_sha256[0] != ""


def test_without_errors_the_scatter_carries_all() -> None:
    random = np.random.default_rng(1)
    speed = np.repeat(np.geomspace(5.0, 200.0, 12), 2)
    level = (speed / 30.0) ** 0.2 * np.exp(0.03 * random.standard_normal(24))
    surface = hersey.fit(hersey.SteadyPoints.from_table({"speed [rpm]": speed, "torque [N*m]": level}))
    assert surface.statistics.scatter == pytest.approx(0.03, rel=0.4)
    assert surface.c.low < -0.8 < surface.c.high


def test_one_bad_cell_costs_its_row(tmp_path: Path) -> None:
    lines = table().splitlines()
    lines[3] = lines[3].replace(f"{torque(20.0, 90.0):.2f}", "n/a")
    lines[7] = lines[7].replace(",5,", ",,")
    points = hersey.SteadyPoints.from_table(written(tmp_path, "\n".join(lines)))
    assert len(points) == 16
    (file,) = points.log.files
    assert file.missing_rows == 2
    (warning,) = file.warnings
    assert (warning.kind, warning.values["rows"]) == ("rows of means left out", 2)
    assert (
        str(warning)
        == "2 rows were skipped because a cell is not a number: row 3 (torque 'n/a'), row 7 (no speed)"
    )


def test_rows_that_state_no_dwell_are_said() -> None:
    points = hersey.SteadyPoints.from_table(
        {"speed [rpm]": [0, 10, 20, 40, -5], "torque [N*m]": [0.1, 1.0, -1.1, 1.2, -1.3]}
    )
    assert [r.reason.split(".")[0] for r in points.rejected] == [
        "drive at standstill",
        "torque and speed have opposite signs",
    ]
    assert points.dropped().startswith("1 of 4 dwells (at 20 rpm) was excluded")
    forward = hersey.SteadyPoints.from_table(
        {"speed [rpm]": [10, 40, -5], "torque [N*m]": [1.0, 1.2, -1.3]}, rotation="forward"
    )
    assert len(forward) == 2
    with pytest.raises(InsufficientDataError, match="no row can be used"):
        hersey.SteadyPoints.from_table({"speed [rpm]": [10], "torque [N*m]": [-1.0]})


def test_loads_that_differ_are_said() -> None:
    columns = {"speed [rpm]": [10, 20, 40], "torque [N*m]": [1.0, 1.1, 1.2], "load [N]": [10, 20, 20]}
    points = hersey.SteadyPoints.from_table(columns, channels={"load": "load"})
    assert points.varying_load == (10.0, 20.0)
    (unnamed,) = hersey.SteadyPoints.from_table(columns).log.files[0].warnings
    assert (unnamed.kind, unnamed.values["role"]) == ("column may play a role", "load")
    assert "column 'load [N]' may be the normal load" in str(unnamed)


def test_decimal_commas_and_semicolons(tmp_path: Path) -> None:
    text = table().replace(",", ";").replace(".", ",")
    points = hersey.SteadyPoints.from_table(written(tmp_path, text))
    assert points.column("torque")[0] == pytest.approx(torque(5.0, 90.0) / 1e3, rel=1e-4)


@pytest.mark.parametrize("made", [dict, pl.DataFrame, pd.DataFrame])
def test_numbers_as_text_in_memory(made: Any) -> None:
    held = {"speed [rpm]": ["10,5", "20,5", "40,1"], "torque [mN*m]": ["25,1", "", "26,3"]}
    points = hersey.SteadyPoints.from_table(made(held))
    assert points.column("speed") / RPM == pytest.approx([10.5, 40.1])
    assert points.column("torque") == pytest.approx([25.1e-3, 26.3e-3])
    held["speed [rpm]"] = ["10 rpm", "20 rpm", "40 rpm"]
    with pytest.raises(InsufficientDataError, match=r"of torque and speed, e\.g\. row 1 \(speed '10 rpm'\)"):
        hersey.SteadyPoints.from_table(made(held))


def test_what_is_taken_for_a_table_of_means(tmp_path: Path) -> None:
    assert is_means_table(written(tmp_path, table()), {}, {})
    clock = table("Time [s],Speed [rpm],Torque [mN*m],Torque error [mN*m],n")
    assert not is_means_table(written(tmp_path, clock), {}, {})
    samples = "speed [rpm],torque [N*m]\n" + "30,1.0\n" * 100
    assert not is_means_table(written(tmp_path, samples), {}, {})
    long = "speed [rpm],torque [N*m]\n" + "".join(f"{10 + i},1.0\n" for i in range(400))
    assert not is_means_table(written(tmp_path, long), {}, {})
    assert not is_means_table(written(tmp_path, "speed [rpm],force [N]\n10,1\n20,2\n"), {}, {})
    assert not is_means_table(tmp_path / "gone.csv", {}, {})


def test_several_tables_are_runs(tmp_path: Path) -> None:
    one, two = (
        written(tmp_path, table(), "one.csv"),
        written(tmp_path, table() + "180,5,90,2,12\n", "two.csv"),
    )
    means = read_means([one, two])
    assert len(means.files) == 2
    assert {row.run for row in means.means} == {0, 1}
    assert means.summary().startswith("one.csv: table of means, 18 rows")
    assert means.to_frame().height == 37


@pytest.mark.usefixtures("roughly")
def test_the_commands_take_a_table_of_means(tmp_path: Path) -> None:
    written(tmp_path, table())
    fit = run("fit", "means.csv", "--json", cwd=tmp_path)
    assert fit.returncode == 0, fit.stderr
    document = json.loads(fit.stdout)
    stated = json.loads(run("fit", "means.csv", "--json", "--means", cwd=tmp_path).stdout)
    assert stated["fit"] == document["fit"]
    assert document["fit"]["coefficients"]["c"]["value"] == pytest.approx(-0.8, abs=0.002)
    report = run("report", "means.csv", "--verbose", cwd=tmp_path)
    assert report.returncode == 0, report.stderr
    assert "a table of means, one row per dwell: stick-slip" in report.words
    assert (tmp_path / "report.html").stat().st_size > 100_000
    for flags in ([], ["--means"]):
        inspected = run("inspect", "means.csv", *flags, cwd=tmp_path)
        assert "18 dwells" in inspected.stdout
        assert "no time column found" not in inspected.stdout
    models = run("models", "means.csv", "--bootstrap", "0", cwd=tmp_path)
    assert models.returncode == 0, models.stderr


@pytest.mark.usefixtures("roughly")
def test_a_table_of_means_has_no_tare_and_no_corrections(tmp_path: Path) -> None:
    written(tmp_path, table())
    refused = run("fit", "means.csv", "--tare", "standing", cwd=tmp_path)
    assert refused.returncode == 2
    assert "no standstill" in refused.stderr
    (tmp_path / "hersey.toml").write_text("[torque]\ngear_ratio = 2.0\n")
    refused = run("fit", "means.csv", cwd=tmp_path)
    assert refused.returncode == 2
    assert "contains corrections" in refused.stderr
    (tmp_path / "hersey.toml").write_text('[torque]\nchannel = "Torque"\nunit = "mN*m"\n')
    assert run("fit", "means.csv", cwd=tmp_path).returncode == 0


def test_only_the_columns_that_are_used_must_have_one_length(tmp_path: Path) -> None:
    held = {"speed_rpm": [10.0, 20.0, 40.0], "torque_Nm": [1.0, 1.1, 1.2], "trace": np.arange(500.0)}
    savemat(tmp_path / "a.mat", held | {"other_speed": np.arange(7.0)})
    named = {"speed": "speed", "torque": "torque"}
    for channels in (named, {"speed": "speed"}, {}):
        points = hersey.SteadyPoints.from_table(tmp_path / "a.mat", channels=channels)
        assert points.column("torque").tolist() == [1.0, 1.1, 1.2]
    with pytest.raises(
        UnreadableLogError, match=r"'other_speed' \(speed\) has 7 rows, but .* \(torque\) has 3"
    ):
        hersey.SteadyPoints.from_table(tmp_path / "a.mat", channels=named | {"speed": "other_speed"})


def test_three_runs_that_show_no_scatter_are_known_as_three_runs() -> None:
    """42 dwells of three runs alike: the level has not the 40 degrees of freedom of the dwells."""
    rng, speeds, parts = np.random.default_rng(12), np.geomspace(0.01, 1.0, 7), []
    for number in range(3):
        noise = rng.normal(0.0, 0.01, 14)
        friction = 0.12 * (1.0 + noise - noise.mean())
        there = np.concatenate([speeds, speeds[::-1]])
        parts.append(pl.DataFrame({"run": number, "speed [m/s]": there, "COF": friction}))
    level = hersey.fit(hersey.SteadyPoints.from_table(pl.concat(parts))).a
    assert level.freedom < 20.0
    assert level.low < 0.12 < level.high
