"""The warm-up typed: what it writes, and one line for each mistake."""

from __future__ import annotations

import json
import shlex
from dataclasses import replace
from pathlib import Path

import pytest

import hersey
from hersey.cli.warming import warming_drag
from hersey.document.saved_fit import read_fit
from hersey.errors import ParameterError
from hersey.machine import read_temperature_profile
from tests.cli.command import run
from tests.conftest import ROOT

MACHINE = (ROOT / "examples" / "machine.toml").read_text().replace('"1 N*m"', '"0.3 N*m"')
TYPED = ["warmup", "machine.toml", "--fit", "fit.json", "--target", "200 mm/s", "--from", "20 degC"]
HEATED = ["simulate", "--machine", "machine.toml", "--fit", "fit.json", "--heat", "--drive-speed", "30 mm/s"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("warm")
    bench = str(ROOT / "examples" / "bench.csv")
    (folder / "no-load.csv").write_bytes((ROOT / "examples" / "no-load.csv").read_bytes())
    typed = ["fit", bench, "--tare", "standing", "--no-load", "no-load.csv", "--json"]
    (folder / "fit.json").write_text(run(*typed, cwd=folder).stdout)
    (folder / "machine.toml").write_text(MACHINE)
    (folder / "bare.toml").write_text(MACHINE[: MACHINE.index("# What the machine can bear")])
    (folder / "weak.toml").write_text(MACHINE.replace('"900 W"', '"10 W"'))
    head, _, tail = MACHINE.partition("[limits]")
    (folder / "free.toml").write_text(
        head + tail[tail.index("\n[") :].replace("[contact]", '[contact]\nload = "300 N"')
    )
    return folder


def test_the_course_is_written_and_serves_a_plan(folder: Path) -> None:
    done = run(*TYPED, "--out", "course.csv", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert done.words.startswith(
        "Start at once and run slowly until warm. Full speed 200 mm/s is reached after "
    )
    assert "(limit of the motor torque, " in done.words
    assert "extrapolated" in done.stdout
    course = read_temperature_profile(folder / "course.csv")
    assert course.first == pytest.approx(293.15)
    assert "exists: use --force" in run(*TYPED, "--out", "course.csv", cwd=folder).stderr


def test_where_full_speed_is_not_reached_nothing_is_written(folder: Path) -> None:
    done = run(*TYPED[:1], "weak.toml", *TYPED[2:], "--out", "none.csv", "--longest", "20 s", cwd=folder)
    assert done.returncode == 1
    assert "not reached within 20 s" in done.words
    assert not (folder / "none.csv").exists()


def test_a_motion_with_heat_is_told_and_written(folder: Path) -> None:
    done = run(*HEATED, "--from", "20 degC", "--duration", "5 s", "--csv", "run.csv", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("In 5 s the film heats from 20 to ")
    assert done.stdout.endswith("\nrun.csv\n")
    header, first = (folder / "run.csv").read_text().splitlines()[:2]
    assert header.endswith("mode,roll_slips,film_temperature,roll_temperature")
    assert first.endswith("293.15,293.15")


def test_a_start_above_the_setpoint_warms_nothing_up(folder: Path) -> None:
    done = run(*TYPED[:6], "--from", "250 degC", cwd=folder)
    assert done.returncode == 2
    assert done.stderr.startswith("hersey: --from is 250 degC, above the setpoint of the heater, 180 degC, ")
    line = done.stderr.rstrip().partition(" type: ")[2]
    assert shlex.split(line) == ["hersey", *TYPED[:6], "--from", "25 degC"]
    assert run(*shlex.split(line)[1:], cwd=folder).returncode == 0


@pytest.mark.parametrize(
    ("typed", "says"),
    [
        ([*TYPED[:1], "bare.toml", *TYPED[2:]], "bare.toml has no heat balance: add [heat]"),
        ([*TYPED[:1], "free.toml", *TYPED[2:]], "free.toml has no force limit"),
        ([*TYPED[:4], "--from", "20 degC"], "the target speed is missing"),
        ([*TYPED, "--margin", "0.1"], "--margin is '0.1'"),
        ([*TYPED, "--longest", "30"], "is not a number with a unit"),
        ([*TYPED[:6], "--from", "-300 degC"], "--from is -300 degC"),
        ([*TYPED, "--out", "w.svg", "--figure", "w.svg"], "name two different files"),
        (HEATED[:5] + HEATED[6:], "--heat"),
        ([*HEATED, "--stiffness", "11 N/mm"], "omit the other options of the drive"),
        (HEATED[:6], "--drive-speed"),
        (["simulate", "--from", "20 degC"], "--from needs --heat"),
        ([*HEATED[:2], "bare.toml", *HEATED[3:]], "add [heat]"),
    ],
)
def test_a_mistake_ends_in_one_line(typed: list[str], says: str, folder: Path) -> None:
    done = run(*typed, cwd=folder)
    assert done.returncode == 2
    assert done.stderr.startswith("hersey: ")
    assert done.stderr.count("\n") == 1
    assert says in done.stderr


def test_an_isothermal_fit_warms_nothing(folder: Path) -> None:
    flat = replace(read_fit(folder / "fit.json"), b=None)
    with pytest.raises(ParameterError, match="the fit is isothermal"):
        warming_drag(flat, hersey.read_machine(folder / "machine.toml"))


def test_the_least_force_is_named() -> None:
    limits = hersey.Limits(motor_torque=3.0, roll_friction=0.6, nip_load=300.0)
    assert limits.force(0.015) == ("grip", 180.0)
    assert limits.force(0.02) == ("motor torque", pytest.approx(150.0))
    assert hersey.Limits().force(0.02) is None


@pytest.mark.parametrize(
    "typed",
    [
        [*TYPED[:-1], "-20 degC"],
        [*HEATED, "--from", "-20 degC"],
        ["plan", *TYPED[1:6], "--at", "-20 degC"],
        ["plan", *TYPED[1:6], "--heat", "--from", "-20 degC"],
    ],
)
def test_below_zero_a_fit_in_kelvin_is_asked_for(folder: Path, typed: list[str]) -> None:
    done = run(*typed, cwd=folder)
    assert done.returncode == 2
    assert f"{typed[-2]} is -20 degC, " in done.stderr
    assert "--temperature-scale K" in done.stderr


def test_a_start_just_above_zero_is_not_refused_for_a_colder_trial(folder: Path) -> None:
    done = run(*TYPED[:-1], "1 degC", "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert min(json.loads(done.stdout)["film_temperature"]) == pytest.approx(274.15)
