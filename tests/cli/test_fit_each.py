"""``hersey fit --each``: a row per log, what fails left out only when asked, nothing half-written."""

from __future__ import annotations

from pathlib import Path

import polars as pl
import pytest

import hersey
from tests.cli.command import Done, run
from tests.conftest import ROOT
from tests.life.test_campaign import means

pytestmark = pytest.mark.usefixtures("roughly")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "logs").mkdir()
    for number in range(2):
        means(tmp_path / "logs" / f"{number}.csv", 5.0 + number)
    return tmp_path


def typed(folder: Path, *arguments: str) -> Done:
    done = run("fit", *arguments, cwd=folder)
    assert "Traceback" not in done.stderr
    return done


def test_each_log_is_a_row(folder: Path) -> None:
    done = typed(folder, "logs/*.csv", "--each", "fits.csv")
    assert (done.returncode, done.stdout, done.stderr) == (0, "2 of 2 logs are fitted.\nfits.csv\n", "")
    table = pl.read_csv(folder / "fits.csv")
    assert table["log"].to_list() == [f"logs/{number}.csv" for number in range(2)]
    assert table["dwells"].to_list() == [10] * 2
    surface = hersey.fit(hersey.SteadyPoints.from_table(folder / "logs" / "1.csv"))
    assert table["c"][1] == surface.c.value
    assert table["c low"][1] == surface.c.low
    assert table["transition speed (rad/s)"].null_count() == 2
    assert table["regime"][1] == "exponent as expected for Dowson-Higginson EHL"
    assert typed(folder, "logs/1.csv", "--each", "fits.parquet").returncode == 0
    assert pl.read_parquet(folder / "fits.parquet").rows() == table[1:2].rows()


def test_the_rest_of_the_drive_is_taken_off_each(folder: Path) -> None:
    machine = folder / "machine.toml"
    machine.write_text(
        (ROOT / "tests" / "stand" / "machine.toml").read_text() + '\n[rest]\ntorque = "1 mN*m"\n'
    )
    done = typed(folder, "logs/1.csv", "--each", "fits.csv", "--machine", "machine.toml", "--isothermal")
    assert done.returncode == 0, done.stderr
    points = hersey.SteadyPoints.from_table(folder / "logs" / "1.csv", isothermal=True)
    surface = hersey.fit(points.without(hersey.read_machine(machine).rest))
    assert pl.read_csv(folder / "fits.csv")["c"][0] == surface.c.value


def test_a_unit_that_an_option_replaces_is_said_once_with_the_logs(folder: Path) -> None:
    for number in range(2, 5):
        means(folder / "logs" / f"{number}.csv", 5.0)
    means(folder / "other.csv", 5.0)
    other = (folder / "other.csv").read_text().replace("mN*m", "N*m")
    (folder / "other.csv").write_text(other)
    option = ["--torque-unit", "N*m"]
    done = typed(folder, "logs/*.csv", "other.csv", "--each", "fits.csv", *option)
    assert done.returncode == 0, done.stderr
    _, said = done.words.split(" - ")
    assert said.startswith("logs/0.csv, logs/1.csv, logs/2.csv and 2 more: ")
    assert "is in mN*m, but it is read in N*m. If the file is right, omit --torque-unit" in said
    alone = typed(folder, "logs/0.csv", *option).words
    assert said.partition(": ")[2].partition(" fits.csv")[0] in alone


def test_what_fails_is_left_out_only_when_asked(folder: Path) -> None:
    (folder / "logs" / "0b.csv").write_text("no log at all\n")
    done = typed(folder, "logs/*.csv", "none.csv", "--each", "fits.csv")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert "0b.csv" in done.stderr
    assert not (folder / "fits.csv").exists()
    done = typed(folder, "logs/*.csv", "none.csv", "--each", "fits.csv", "--keep-going")
    assert (done.returncode, done.stdout) == (1, "2 of 4 logs are fitted.\nfits.csv\n")
    assert [line.split(": ")[0] for line in done.stderr.splitlines()] == ["- logs/0b.csv", "- none.csv"]
    (folder / "fits.csv").unlink()
    done = typed(folder, "none.csv", "--each", "fits.csv", "--keep-going")
    assert (done.returncode, done.stdout) == (1, "")
    assert not (folder / "fits.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--each", "fits.xlsx"], "ends in .csv or .parquet"),
        (["--each", "logs/0.csv"], "is an input"),
        (["--each", "fits.csv", "--json"], "give one of them"),
        (["--keep-going"], "need --each TABLE"),
        (["--workers", "2"], "need --each TABLE"),
        (["--each", "fits.csv", "--workers", "2", "--scheduler", "tcp://x:1"], "give one"),
        (["x*.csv", "--each", "fits.csv"], "no file matches"),
        (["logs/0.csv", "--each", "fits.csv"], "is given twice"),
    ],
)
def test_a_mistake_is_one_line(folder: Path, arguments: list[str], said: str) -> None:
    done = typed(folder, "logs/*.csv", *arguments)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert said in done.stderr
    assert not (folder / "fits.csv").exists()


def test_a_pattern_that_matches_its_own_table_can_be_typed_again(folder: Path) -> None:
    again = ["--each", "logs/fits.csv", "--force"]
    first = typed(folder, "logs/*.csv", *again)
    assert (first.returncode, first.stderr) == (0, "")
    written = (folder / "logs" / "fits.csv").read_bytes()
    what = "a table of the fits that 'hersey fit' wrote, not a log"
    by_shell = ["logs/0.csv", "logs/1.csv", "logs/fits.csv"]
    for logs in (["logs/*.csv"], by_shell):
        done = typed(folder, *logs, *again)
        assert (done.returncode, done.stdout) == (0, "2 of 2 logs are fitted.\nlogs/fits.csv\n")
        assert " ".join(done.stderr.split()) == f"logs/fits.csv is skipped: it is {what}."
        assert (folder / "logs" / "fits.csv").read_bytes() == written
    assert typed(folder, "logs/*.csv", "--each", "other.csv").returncode == 0
    done = typed(folder, *by_shell, "--each", "third.csv")
    refusal = f"fits.csv is {what}. Give the logs without it"
    assert (done.returncode, done.stderr) == (2, f"hersey: {refusal}\n")
    done = run("inspect", "logs/fits.csv", cwd=folder)
    assert f"No fit is possible: {refusal}" in done.words
    done = typed(folder, "logs/*.csv", "--each", "logs/1.csv", "--force")
    assert done.stderr.endswith("hersey: logs/1.csv is an input: name another file for the output\n")


def test_every_table_that_hersey_writes_beside_logs_is_skipped_in_a_pattern(folder: Path) -> None:
    age = ["--unit", "F1", "--age", "1 h"]
    assert run("campaign", "add", "life.hersey", "logs/*.csv", *age, cwd=folder).returncode == 0
    assert run("campaign", "export", "life.hersey", "--out", "logs/dwells.csv", cwd=folder).returncode == 0
    assert typed(folder, "logs/?.csv", "--each", "logs/fits.parquet").returncode == 0
    draws = "stick_speed (m/s),closure,fold_speed (m/s)\n0.003,retained,0.1\n"
    (folder / "logs" / "draws.csv").write_text(draws)
    done = typed(folder, "logs/*", "--each", "fits.csv")
    assert (done.returncode, done.stdout) == (0, "2 of 2 logs are fitted.\nfits.csv\n")
    assert done.stderr.count(" is skipped: ") == 3
