"""A log whose torque only rises: report, map and posterior answer, and claim only what was measured."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.cli.command import run

MACHINE = """
[drivetrain]
stiffness = "9 N/mm"
mass = "8 kg"
roll_radius = "20 mm"
stick_speed = "1 mm/s"
[[points]]
name = "fast"
speed = "250 mm/s"
temperature = "100 degC"
"""


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Torque 0.3 (w/1 rad/s)^0.4 N m from 4 to 140 rpm, 1 % scatter, isothermal."""
    folder = tmp_path_factory.mktemp("rising")
    speeds = np.repeat(np.geomspace(4.0, 140.0, 10), 3) * np.pi / 30.0
    noise = np.random.default_rng(2).standard_normal(speeds.size)
    torques = 0.3 * speeds**0.4 * np.exp(0.01 * noise)
    rows = [f"{w:.9g},{t:.9g}" for w, t in zip(speeds.tolist(), torques.tolist(), strict=True)]
    (folder / "means.csv").write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows, ""]))
    (folder / "machine.toml").write_text(MACHINE)
    return folder


def test_the_report_says_what_the_machine_does(here: Path) -> None:
    done = run(
        "report", "means.csv", "--means", "--isothermal", "--machine", "machine.toml", "--json", cwd=here
    )
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["fit"]["transition"] is None
    assert (document["fit"]["trend"]["rises"], document["fit"]["trend"]["falls"]) == (True, False)
    decision = document["decision"]
    # whatever the closure: V* of a film that only rises is near the slowest dwell (8.4 mm/s) or below
    assert decision["fold"]["low"] < 0.0084 < 4.0 * decision["fold"]["high"]
    assert decision["safe_speed"] < 0.25
    assert decision["points"][0]["verdict"] == "smooth"
    assert decision["instruction"] == "250 mm/s runs smoothly"
    curve = document["fit"]["curves"][0]
    speed = np.array(curve["speed"])
    assert speed * np.array(curve["damping"]) == pytest.approx(0.3 * speed**0.4, rel=0.02)


def test_map_and_posterior_need_no_transition(here: Path) -> None:
    given = ("means.csv", "--means", "--isothermal")
    done = run("map", "machine.toml", *given, "--out", "map.svg", cwd=here)
    assert done.returncode == 0, done.stderr
    assert "fast (250 mm/s" in done.stdout
    assert "Smooth" in done.stdout
    drawn = run("posterior", *given, "--machine", "machine.toml", "--draws", "100", cwd=here)
    assert drawn.returncode == 0, drawn.stderr
    assert "constant torque plus a power of speed" in drawn.stdout
    page = run("report", *given, "--machine", "machine.toml", "--out", "r.html", cwd=here)
    assert page.returncode == 0, page.stderr
