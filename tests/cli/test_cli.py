"""The commands: their help teaches, their results can be piped, and they leave nothing half done."""

from __future__ import annotations

import contextlib
import json
import re
import shlex
import signal
import time
from pathlib import Path

import pytest

from hersey.cli.application import VERBS, load
from tests.cli.command import run, start
from tests.conftest import ROOT, mostly_nightly
from tests.life import shipped

#: Verbs that wait for a person: tests/app types them.
LASTING = {"app", "new"}


def example(*command: str) -> str:
    text = run(*command, "--help", cwd=ROOT).stdout
    lines = " ".join(line.strip(" │") for line in text.splitlines())
    found = re.search(r"Example:\s+(hersey .*?)\s{2,}", lines)
    assert found, text
    return re.sub(r"\s+", " ", found[1])


#: Verbs that take seconds, and work with a log, a machine or a campaign in tests of their own.
LONG = ("models", "map", "posterior", "plan", "warmup", "life")
ASKED = ["", *(verb for verb in VERBS if verb not in LASTING)]


@pytest.mark.parametrize("verb", LONG)
def test_the_example_of_a_long_verb_can_be_typed(verb: str, examples_here: Path) -> None:
    """Its words are those of the verb; what it does with them is the matter of other tests."""
    _, named, *typed = shlex.split(example(verb))
    assert named == verb
    with contextlib.chdir(examples_here), load(verb).make_context(verb, typed) as context:
        assert context.params
    assert all((examples_here / word).exists() for word in typed if word.startswith("examples/"))


@pytest.mark.parametrize("verb", mostly_nightly(ASKED, *(each for each in ASKED if each not in LONG)))
def test_the_example_in_the_help_works_as_typed(
    verb: str, examples_here: Path, request: pytest.FixtureRequest
) -> None:
    if verb not in ("report", "design"):  # which tries all, and which asks for one of them
        request.getfixturevalue("few_laws")
    if verb == "life":
        shipped.write(examples_here / "life.hersey", 1)
    if verb == "export":
        told = ["--tare", "standing", "--no-load", "examples/no-load.csv"]
        fit = run("fit", "examples/bench.csv", *told, "--json", cwd=examples_here).stdout
        (examples_here / "fit.json").write_text(fit)
    typed = shlex.split(example(*verb.split()))
    result = run(*typed[1:], cwd=examples_here)
    assert result.returncode == 0, result.stderr
    assert result.stdout


def test_report_prints_verdict_and_path(bench_csv: Path, tmp_path: Path) -> None:
    result = run("report", bench_csv, "--out", "page.html", cwd=tmp_path)
    assert result.returncode == 0
    assert "AICc" not in result.stdout
    assert result.stdout.endswith("\npage.html\n")
    verbose = run("report", bench_csv, "--out", "page.html", "--force", "-v", cwd=tmp_path)
    assert "AICc" in verbose.stdout
    assert (tmp_path / "page.html").exists()


@pytest.mark.usefixtures("roughly")
def test_json_goes_to_a_pipe_alone(bench_csv: Path, tmp_path: Path) -> None:
    result = run("report", bench_csv, "--json", cwd=tmp_path)
    document = json.loads(result.stdout)
    assert document["schema_version"] == "2"
    assert document["command"].startswith("hersey report")
    assert list(tmp_path.iterdir()) == []
    fit = json.loads(run("fit", bench_csv, "--json", cwd=tmp_path).stdout)
    assert fit["fit"]["coefficients"]["c"] == document["fit"]["coefficients"]["c"]
    cycle = json.loads(run("simulate", "--json", cwd=tmp_path).stdout)
    assert cycle["frequency"] == pytest.approx(3.940314, rel=1e-6)


def test_the_band_is_printed_and_piped(tmp_path: Path) -> None:
    """V* of the baseline, its dependence on each parameter, and the step of the paper's Fig. 14."""
    steps = ["--drive-speed", "1.2", "--from-speed", "2.5", "--to-speed", "1.2"]
    text = run("hysteresis", *steps, cwd=tmp_path).words
    assert text.startswith("Smooth from any start above 2.17 (V*). Sticks from any start below 0.982.")
    assert "A sudden step from 2.5 to 1.2 makes the drive stick. Use a ramp of at least 0.0698." in text
    assert text.endswith("transition force 50 ozf, transition speed 1 in/s, stick speed 0.01 in/s.")
    verbose = run("hysteresis", *steps, "--verbose", cwd=tmp_path).stdout
    assert "upper fold V*     2.1734934" in verbose
    assert all(name in verbose for name in ("stick_speed", "mixed_exponent"))
    band = json.loads(run("hysteresis", *steps, "--json", cwd=tmp_path).stdout)
    assert band["upper"] == pytest.approx(2.173493478, rel=1e-7)
    assert band["step"]["sticks"]
    assert band["disturbance"]["kick"] == pytest.approx(0.902, abs=1e-3)
    half = run("hysteresis", "--from-speed", "2.5", cwd=tmp_path)
    assert (half.returncode, half.stderr) == (
        2,
        "hersey: --from-speed is one end of a step of the drive speed: add --to-speed with the speed after "
        "the step\n",
    )


def test_simulation_is_written_as_csv(tmp_path: Path) -> None:
    assert run("simulate", "--csv", "motion.csv", cwd=tmp_path).returncode == 0
    assert (
        (tmp_path / "motion.csv")
        .read_text()
        .startswith("time,belt_speed,stretch,spring_force,mode,roll_slips\n")
    )
    assert run("simulate", "--csv", "motion.csv", cwd=tmp_path).returncode == 2


def test_the_test_bench_writes_log_and_truth(tmp_path: Path) -> None:
    result = run("testbench", "--out", "log.csv", "--truth", "truth.json", "--seed", "7", cwd=tmp_path)
    assert result.stdout == "Synthetic log, seed 7\nlog.csv\ntruth.json\n"
    assert json.loads((tmp_path / "truth.json").read_text())["seed"] == 7
    assert (tmp_path / "log.csv").read_text().startswith("# SYNTHETIC")


@pytest.mark.usefixtures("roughly")
def test_a_long_log_is_as_long_as_asked(tmp_path: Path) -> None:
    assert run("testbench", "--out", "log.csv", "--size", "5 MB", cwd=tmp_path).returncode == 0
    assert 5e6 <= (tmp_path / "log.csv").stat().st_size < 7e6
    assert run("fit", "log.csv", cwd=tmp_path).returncode == 0


def test_an_interrupt_leaves_no_half_written_file(tmp_path: Path) -> None:
    process = start("testbench", "--out", "log.csv", "--size", "100 MB", cwd=tmp_path)
    while not any(part.stat().st_size for part in tmp_path.glob(".*.part")):
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, stderr = process.communicate()
    assert process.returncode == 130
    assert stderr.decode() == "hersey: interrupted\n"
    assert list(tmp_path.iterdir()) == []


def test_version() -> None:
    assert run("--version", cwd=ROOT).stdout == f"hersey {ROOT_VERSION}\n"


ROOT_VERSION = re.search(r'^version = "(.*)"', (ROOT / "Cargo.toml").read_text(), re.MULTILINE)[1]  # type: ignore[index]
