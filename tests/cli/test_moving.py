"""``hersey fit`` on a log that moves all the time: asked for, found by itself, and what it cannot do."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from hersey.cli.recipe_file import read_recipe
from tests.cli.command import run
from tests.conftest import ROOT, shared
from tests.damping.moving_logs import RATE, made, sine, times, waves

#: What is said where nobody asked for it.
_FOUND = "friction is fitted to every sample, as with --moving."

pytestmark = pytest.mark.usefixtures("roughly")


@pytest.fixture
def joint(tmp_path: Path) -> Path:
    """A log of sines."""
    sine().to_frame().drop("run").write_csv(tmp_path / "joint.csv")
    return tmp_path


def test_a_moving_log_is_found_by_itself(joint: Path) -> None:
    done = run("fit", "joint.csv", "--isothermal", cwd=joint)
    assert done.returncode == 0, done
    assert _FOUND in " ".join(done.stderr.split())
    for line in ("Coulomb and viscous friction. Torque rises with speed", "T_C", "k_v", "J", "offset"):
        assert line in done.words
    assert "B = a w^c" not in done.stdout


def test_a_report_of_a_moving_log_leads_with_its_friction_curve(joint: Path) -> None:
    """It finds by itself that the log moves, and the document holds one law, inertia and offset beside it."""
    done = run("report", "joint.csv", "--isothermal", "--json", cwd=joint)
    document = json.loads(done.stdout)
    assert _FOUND in " ".join(done.stderr.split())
    assert document["decision"]["instruction"].startswith("Torque rises with speed from ")
    friction = {each["name"]: each["estimate"]["value"] for each in document["friction"]["parameters"]}
    beside = {each["name"]: each["estimate"]["value"] for each in document["moving"]["parameters"]}
    assert friction == pytest.approx({"T_C": 0.3, "k_v": 0.02}, rel=0.02)
    assert {name: beside[name] for name in friction} == friction
    assert beside["J"] == pytest.approx(0.01, rel=0.02)
    assert document["friction"]["of_every_sample"] is True
    assert 300 < len(document["moments"]["speed"]) <= 800
    sign = np.sign(document["moments"]["speed"])
    line = sign * 0.3 + 0.02 * np.array(document["moments"]["speed"])
    assert document["moments"]["torque"] == pytest.approx(line, abs=0.02)


def test_dwells_and_motion_in_one_log(tmp_path: Path) -> None:
    """Plain, the motion beside the dwells is named; as advised, every sample gives the true numbers."""
    steps = np.repeat([2.0, 4.0, 6.0, 8.0, -2.0, -4.0, -6.0, -8.0], 300)
    ramps = np.convolve(np.pad(steps, 20, mode="edge"), np.full(41, 1.0 / 41.0), "valid")
    speed = np.concatenate([ramps, waves(times(30.0))[0]])
    log = made(speed, RATE * np.gradient(speed), 0.3 * np.sign(speed) + 0.02 * speed)
    log.to_frame().drop("run").write_csv(tmp_path / "both.csv")
    plain = run("fit", "both.csv", "--isothermal", cwd=tmp_path)
    assert "of the time the drive turns) are in no dwell and not used" in plain.words
    assert "To fit every sample, dwells included, use --moving." in plain.words
    every = run("fit", "both.csv", "--isothermal", "--moving", "--json", cwd=tmp_path)
    found = {each["name"]: each["estimate"] for each in json.loads(every.stdout)["moving"]["parameters"]}
    for name, truth in {"T_C": 0.3, "k_v": 0.02, "J": 0.01}.items():
        assert found[name]["value"] == pytest.approx(truth, rel=0.03), name


def test_the_error_of_a_given_inertia_is_read_and_kept(joint: Path) -> None:
    """As by coastdown; the recipe of a report keeps both numbers."""
    typed = ("fit", "joint.csv", "--isothermal", "--moving", "--inertia", "100 kg*cm^2 ± 20 %")
    assert "0.01 ± 0.002 kg·m² (given)" in run(*typed, cwd=joint).stdout
    run("inspect", *typed[1:], "--save-recipe", "recipe.toml", cwd=joint)
    assert read_recipe(joint / "recipe.toml")[1]["inertia"] == "0.01 kg*m^2 ± 0.002 kg*m^2"
    again = run("fit", "--recipe", "recipe.toml", cwd=joint)
    assert "0.01 ± 0.002 kg·m² (given)" in again.stdout, again.stderr


def test_a_given_inertia_and_json(joint: Path) -> None:
    typed = ("fit", "joint.csv", "--isothermal", "--moving", "--inertia", "100 kg*cm^2")
    done = run(*typed, "--json", cwd=joint)
    document = json.loads(done.stdout)
    assert document["moving"]["inertia_given"] == pytest.approx(0.01)
    found = {each["name"]: each["estimate"]["value"] for each in document["moving"]["parameters"]}
    assert found["T_C"] == pytest.approx(0.3, rel=0.01)
    assert "J" not in found
    assert document["fit"]["points"] > 10


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        (("--inertia", "0.01 kg*m^2"), "--inertia is for --moving: add it, or omit --inertia"),
        (("--moving", "--tare", "standing"), "the torque zero of a moving log is fitted. Omit --tare"),
        (("--moving", "--inertia", "3 kg"), "--inertia"),
    ],
)
def test_what_does_not_go_together(joint: Path, typed: tuple[str, ...], said: str) -> None:
    done = run("fit", "joint.csv", "--isothermal", *typed, cwd=joint)
    assert done.returncode == 2
    assert said in " ".join(done.stderr.split())


def test_other_commands_find_a_ramp_by_themselves(tmp_path: Path) -> None:
    """`models` says so, and gives what it gives with --moving."""
    time = np.arange(0.0, 60.0, 1.0 / RATE)
    speed = 1.0 + 8.0 * np.abs((time / 15.0) % 2.0 - 1.0)
    noise = np.random.default_rng(1).normal(0.0, 0.01, time.size)
    columns = {"time (s)": time, "torque (N m)": 0.3 + 0.02 * speed + noise, "speed (rad/s)": speed}
    pl.DataFrame(columns).write_csv(tmp_path / "ramp.csv")
    found = run("models", "ramp.csv", "--isothermal", cwd=tmp_path)
    assert found.returncode == 0, found.stderr
    assert _FOUND in " ".join(found.stderr.split())
    asked = run("models", "ramp.csv", "--isothermal", "--moving", cwd=tmp_path)
    assert (asked.stdout, asked.stderr) == (found.stdout, "")


def test_start_and_stop_of_a_screw_drive(tmp_path: Path) -> None:
    """Friction at both speeds, as in the steady logs of the same drive within 4 %."""
    folder = shared("data/friction/tro2021_screw_drives/driveNo1/start_stop")
    typed = ("--torque-unit", "9.84 mN*m / 100", "--isothermal", "--moving")
    done = run("fit", folder / "50.csv", folder / "200.csv", *typed, cwd=tmp_path)
    assert done.returncode == 0, done
    assert "Coulomb and viscous friction" in done.stdout
    assert "all windows of speed are at 50 rpm and 200 rpm" in " ".join(done.stderr.split())


def test_a_staircase_with_too_few_speeds_is_none(tmp_path: Path) -> None:
    """Two dwells of a usual log: the usual error, not a fit of its ramps."""
    lines = (ROOT / "examples" / "bench.csv").read_text().splitlines()
    kept = [line for line in lines if not line[:1].isdigit() or float(line.split(",")[0]) < 30.0]
    (tmp_path / "few.csv").write_text("\n".join([*kept, ""]))
    done = run("fit", "few.csv", "--isothermal", cwd=tmp_path)
    assert done.returncode == 2
    assert "--moving" not in done.stderr
