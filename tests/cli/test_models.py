"""The commands models, compare and design, and film where the load is shared."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from typing import Any

import pytest

from hersey import testbench
from hersey.damping import curves
from hersey.damping.candidates import comparison
from tests.cli.command import run
from tests.conftest import ROOT

BENCH = ["--tare", "standing"]
STATED = '[asperities]\nmodulus = "3 GPa"\n[boundary]\nfriction = 0.1\n'


def printed(*arguments: str | Path) -> str:
    done = run(*arguments, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_models_of_a_log(bench_csv: Path) -> None:
    short = printed("models", bench_csv, *BENCH, "--bootstrap", "20", "--seed", "9")
    assert re.search(r"^\* +\d+\.\d +[\d.]+ %  (power law in degC|VFT)", short, re.MULTILINE)
    assert re.search(r"^  transition speed +[\d.]+ \[[\d.]+, [\d.]+\] rpm$", short, re.MULTILINE)
    text = printed("models", bench_csv, *BENCH, "--bootstrap", "20", "--seed", "9", "--verbose")
    assert "* power law in degC" in text or "* VFT" in text
    assert "20 fits resampled by level, seed 9" in text
    assert "cal/mol" in text
    assert "collapse onto one" in " ".join(text.split())


@pytest.mark.parametrize(("flags", "fits"), [((), 0), (("--verbose",), 1), (("--json",), 1)])
def test_what_is_not_printed_is_not_computed(
    flags: tuple[str, ...], fits: int, bench_csv: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    called: list[str] = []
    for module, name in ((curves, "fit_curves"), (comparison, "bootstrap_draws")):
        of = getattr(module, name)

        def counted(*given: Any, of: Any = of, name: str = name, **named: Any) -> Any:
            called.append(name)
            return of(*given, **named)

        monkeypatch.setattr(module, name, counted)
    printed("models", bench_csv, *BENCH, "--bootstrap", "2", *flags)
    assert called == ["bootstrap_draws", "fit_curves"] * fits


def test_models_as_json(bench_csv: Path, tmp_path: Path) -> None:
    machine = tmp_path / "machine.toml"
    machine.write_text((ROOT / "tests" / "stand" / "machine.toml").read_text() + STATED)
    flags = ["--bootstrap", "0", "--isothermal", "--json", "--machine", machine]
    plain = json.loads(printed("models", bench_csv, *BENCH, *flags))
    contact = [law for law in plain["refused"] if law["name"].startswith("film and asperities")]
    assert [law["reason"] for law in contact] == ["the log has no temperature"] * 2
    assert plain["chosen"].startswith("isothermal/")
    assert plain["bootstrap"] == {"draws": 0, "seed": 1}
    assert {"name", "reason"} == set(plain["refused"][0])
    assert plain["command"].startswith("hersey")


def test_design_of_a_log(bench_csv: Path) -> None:
    flags = ["--speeds", "2 to 200 rpm", "--temperatures", "60 to 200 degC", "--count", "2", "--json"]
    plain = json.loads(printed("design", bench_csv, *BENCH, "--quantity", "transition", *flags))
    assert plain["quantity"] == "transition speed"
    assert len(plain["points"]) == 2
    assert 333.0 < plain["points"][0]["kelvin"] < 474.0
    assert plain["points"][-1]["error"] < plain["error_now"]


@pytest.mark.parametrize(("flag", "text"), [("--speeds", "2-200 rpm"), ("--temperatures", "hot")])
def test_a_range_that_is_none(bench_csv: Path, flag: str, text: str) -> None:
    done = run("design", bench_csv, *BENCH, flag, text, cwd=ROOT)
    assert done.returncode == 2
    assert f"{flag} '{text}' is not a range" in done.stderr


@pytest.mark.parametrize("quantity", [("--quantity", "V*"), ("--quantity=v",)])
def test_a_design_for_the_safe_speed_names_the_line_to_type(
    bench_csv: Path, tmp_path: Path, quantity: tuple[str, ...]
) -> None:
    limits = ["--speeds", "2 to 200 rpm", *quantity, "--count", "4"]
    done = run("design", bench_csv, *limits, *BENCH, cwd=tmp_path)
    assert done.returncode == 2
    assert "Write machine.toml with hersey new" in done.stderr
    (tmp_path / "machine.toml").write_text((ROOT / "tests" / "stand" / "machine.toml").read_text())
    done = run("design", bench_csv, *limits, *BENCH, cwd=tmp_path)
    assert "hersey new" not in done.stderr
    typed = shlex.split(done.stderr.partition("Type: hersey ")[2])
    assert typed == ["design", str(bench_csv), *BENCH, "--machine", "machine.toml"]
    with_both = run("design", bench_csv, *limits[:2], *typed[2:], cwd=tmp_path)
    assert with_both.stderr.endswith("omit --speeds\n")


def test_compare_two_logs(bench_csv: Path, tmp_path: Path) -> None:
    other = tmp_path / "aged.csv"
    testbench.run(seed=5, truth=testbench.Truth(a=80.0)).write(other)
    plain = json.loads(printed("compare", bench_csv, other, *BENCH, "--json"))
    assert " is higher than that of " in plain["verdict"]
    assert plain["mean_ratio"]["low"] < 80.0 / 62.0 < plain["mean_ratio"]["high"]


def test_film_says_who_shares_the_load(bench_csv: Path, tmp_path: Path) -> None:
    machine = tmp_path / "machine.toml"
    machine.write_text((ROOT / "tests" / "stand" / "machine.toml").read_text() + STATED)
    text = printed("film", machine, "--log", bench_csv, *BENCH, "--verbose")
    assert "asperities carry 15 to 44.4 %" in text
    row = next(line for line in text.splitlines() if line.startswith("   180.0 ") and "[" in line)
    assert float(row.split()[1]) / float(row.split()[2]) == pytest.approx(float(row.split()[5]), rel=0.02)
