"""The commands models, compare and design."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hersey.cli.compare
import hersey.cli.design
import hersey.cli.models  # noqa: F401
from hersey import testbench
from hersey.cli import app
from hersey.errors import ParameterError, UnitError

BENCH = ["--tare", "standing"]


def run(*arguments: str) -> str:
    result = CliRunner().invoke(app, list(arguments), catch_exceptions=False)
    assert result.exit_code == 0
    return result.stdout


def test_models_of_a_log(bench_csv: Path) -> None:
    text = run("models", str(bench_csv), *BENCH, "--bootstrap", "20", "--seed", "9")
    assert "* power law in degC" in text or "* VFT" in text
    assert "20 resampled fits by level, seed 9" in text
    assert "cal/mol" in text
    assert "collapse onto one" in text


def test_models_as_json(bench_csv: Path) -> None:
    plain = json.loads(run("models", str(bench_csv), *BENCH, "--bootstrap", "0", "--isothermal", "--json"))
    assert plain["chosen"].startswith("isothermal/")
    assert plain["bootstrap"] == {"draws": 0, "seed": 1}
    assert {"name", "reason"} == set(plain["refused"][0])
    assert plain["command"].startswith("hersey")


def test_design_of_a_log(bench_csv: Path) -> None:
    flags = ["--speeds", "2 to 200 rpm", "--temperatures", "60 to 200 degC", "--count", "2", "--json"]
    plain = json.loads(run("design", str(bench_csv), *BENCH, "--quantity", "transition", *flags))
    assert plain["quantity"] == "transition speed"
    assert len(plain["points"]) == 2
    assert 333.0 < plain["points"][0]["kelvin"] < 474.0
    assert plain["points"][-1]["error"] < plain["error_now"]


@pytest.mark.parametrize(("flag", "text"), [("--speeds", "2-200 rpm"), ("--temperatures", "hot")])
def test_a_range_that_is_none(bench_csv: Path, flag: str, text: str) -> None:
    with pytest.raises((ParameterError, UnitError), match=f"{flag} '{text}' is no range"):
        run("design", str(bench_csv), *BENCH, flag, text)


def test_compare_two_logs(bench_csv: Path, tmp_path: Path) -> None:
    other = tmp_path / "aged.csv"
    testbench.run(seed=5, truth=testbench.Truth(a=80.0)).write(other)
    plain = json.loads(run("compare", str(bench_csv), str(other), *BENCH, "--json"))
    assert f"{other} drags more than {bench_csv} throughout the shared range" in plain["verdict"]
    assert plain["mean_ratio"]["low"] < 80.0 / 62.0 < plain["mean_ratio"]["high"]
