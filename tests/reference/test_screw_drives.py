"""Two screw drives measured by others (data of a paper in IEEE T-RO 37 (2021)).

Torque comes in percent of 9.84 mN m, one file per speed, semicolons, nine to thirteen lines of preamble, and
the recorded signs are opposite to the commanded ones.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import least_squares

import hersey
from hersey import _core
from hersey.arrays import FloatArray, pointwise
from hersey.log.torque_log import TorqueLog
from tests.cli.command import run
from tests.conftest import shared

RPM = np.pi / 30
UNITS = {"torque": "-9.84 mN*m / 100", "speed": "-1 rpm"}


def files(drive: int) -> list[Path]:
    return sorted(shared(f"data/friction/tro2021_screw_drives/driveNo{drive}/steady_state").glob("*.csv"))


@pytest.fixture(scope="module", params=[1, 2])
def drive(request: pytest.FixtureRequest) -> tuple[int, TorqueLog]:
    return request.param, hersey.read(files(request.param), units=UNITS, isothermal=True)


def test_files_are_read_as_they_are(drive: tuple[int, TorqueLog]) -> None:
    number, log = drive
    assert len(log.runs) == {1: 32, 2: 30}[number]
    assert {run.time.size for run in log.runs} == {500}
    commanded = {run.name: float(run.name[:-4].replace("n", "-")) for run in log.runs}
    for run_ in log.runs:
        if abs(commanded[run_.name]) >= 10:
            assert np.mean(run_.speed) / RPM == pytest.approx(commanded[run_.name], abs=2)


def test_least_torque_of_drive_1() -> None:
    log = hersey.read(files(1), units=UNITS, isothermal=True)
    points = log.steady(rotation="forward")
    least = points.table.sort("torque").row(0, named=True)
    assert least["speed"] / RPM == pytest.approx(50, abs=1)
    assert least["torque"] == pytest.approx(2.526e-3, rel=0.01)


def test_drive_1_has_a_falling_and_a_rising_branch() -> None:
    points = hersey.read(files(1), units=UNITS, isothermal=True).steady(rotation="forward")
    surface = hersey.fit(points)
    assert surface.transition is not None
    # published: exponent -1.055 for 10-50 rpm, -0.81 for 60-199 rpm, Stribeck speed 61 rpm
    assert surface.transition.mixed_exponent.value == pytest.approx(-1.055, abs=0.01)
    assert surface.c.value == pytest.approx(-0.81, abs=0.015)
    assert surface.transition.gradual
    assert 45 < surface.transition.speed.value / RPM < 65
    assert surface.transition.speed.low < 50 * RPM  # where the dwell of least torque was held
    assert surface.transition_torque() == pytest.approx(2.56e-3, rel=0.015)
    assert surface.transition.speed.low < 61 * RPM < surface.transition.speed.high
    verdict = hersey.regime(points, surface).verdict
    assert "stick-slip is possible" in verdict


@pytest.mark.parametrize("rotation", ["forward", "reverse", "both"])
def test_drive_2_announces_no_transition(rotation: str) -> None:
    points = hersey.read(files(2), units=UNITS, isothermal=True).steady(rotation=rotation)
    surface = hersey.fit(points)
    assert surface.transition is None
    assert "no transition" in hersey.regime(points, surface).verdict


def test_friction_of_drive_1() -> None:
    """Published: Stribeck speed 61 rpm; the dwell of least torque, 2.526 mN m, is at 50 rpm."""
    curve = hersey.fit_friction(hersey.read(files(1), units=UNITS, isothermal=True).steady())
    assert (curve.kind, curve.apart, curve.scatter) == ("stribeck", True, 0.0)
    for least in curve.least:
        assert least.speed.low < 61 * RPM < least.speed.high
    torque = {least.direction: least.torque for least in curve.least}
    assert torque["forward"] == pytest.approx(2.526e-3, rel=0.01)


def test_friction_of_drive_2() -> None:
    curve = hersey.fit_friction(hersey.read(files(2), units=UNITS, isothermal=True).steady())
    assert (curve.kind, curve.apart, curve.rises) == ("coulomb_viscous", True, True)


def test_through_the_command(tmp_path: Path) -> None:
    options = ["--torque-unit", UNITS["torque"], "--speed-unit", UNITS["speed"], "--isothermal"]
    result = run("report", *files(1), *options, "--rotation", "forward", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "torque rises as the drive slows" in result.words
    assert (tmp_path / "report.html").stat().st_size < 2_000_000
    document = json.loads(run("report", *files(1), *options, "--json", cwd=tmp_path).stdout)
    friction = document["friction"]
    assert (friction["kind"], friction["directions"]["differ"]) == ("stribeck", True)
    # one law per direction describes both: nothing is left to warn of
    assert not any("reverse rotation" in w["text"] for w in document["warnings"])


def test_percent_is_asked_about(tmp_path: Path) -> None:
    result = run("report", files(1)[0], "--isothermal", cwd=tmp_path)
    assert result.returncode == 2
    assert "--torque-unit" in result.stderr


@pytest.mark.parametrize(("rotation", "least"), [("forward", 61.0), ("reverse", 50.0)])
def test_drive_1_follows_the_law_of_mixed_lubrication(rotation: str, least: float) -> None:
    """The measured Stribeck curve within the errors of its 15 dwells: it falls, bends and rises as the law.

    Given: speed and torque. Fitted: reference, boundary and shear torque, and a constant for the rest of the
    drive. Chosen among four values, after a look: asperities that press 20 times as hard as the mean (the
    faces were not measured). The exponents are those of a soft film. Published: Stribeck speed 61 rpm.
    """
    points = hersey.read(files(1), units=UNITS, isothermal=True).steady(rotation=rotation)
    speed, torque, error = (np.abs(points.column(name)) for name in ("speed", "torque", "torque_error"))

    def law(logs: FloatArray, at: FloatArray = speed) -> FloatArray:
        reference, boundary, shear, rest = np.exp(logs)
        forces = (boundary, shear, 0.0, 0.0)  # of a film under its share of the load
        state = pointwise(_core.mixed_contact, at, reference, 0.6, 0.2, 0.0, 1.0, 20.0, *forces)
        return np.asarray(state.boundary + state.shear + rest)

    start = np.log([2.0, 1e-3, 0.7e-3, 1.5e-3])
    fitted = least_squares(lambda logs: (law(logs) - torque) / error, start, x_scale=0.3)
    assert fitted.success
    assert np.max(np.abs(fitted.fun)) < 2.5
    assert 2 * fitted.cost < 1.5 * (speed.size - 4)
    fine = np.linspace(20.0, 120.0, 1001) * RPM
    assert fine[np.argmin(law(fitted.x, fine))] / RPM == pytest.approx(least, abs=5)
