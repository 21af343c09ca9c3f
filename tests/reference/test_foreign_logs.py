"""Logs of other machines: what they cannot tell is said, not guessed."""

from __future__ import annotations

from pathlib import Path

from tests.cli.command import run
from tests.conftest import shared


def test_a_motor_dynamometer_with_a_units_row(tmp_path: Path) -> None:
    path = shared("data/friction/odrive_motor_dyno/odrive_data.csv")
    result = run("fit", path, "--json", cwd=tmp_path)
    assert result.returncode in (0, 2)
    if result.returncode == 2:
        assert len(result.stderr.splitlines()) == 1


def test_a_rheometer_without_a_torque_channel(tmp_path: Path) -> None:
    folder = shared("data/friction/couette_rheometer_pi")
    for path in sorted(folder.glob("*.csv")):
        result = run("report", path, cwd=tmp_path)
        assert result.returncode == 2
        assert len(result.stderr.splitlines()) == 1


def test_a_wear_test_at_constant_speed(tmp_path: Path) -> None:
    for path in sorted(shared("data/friction/te67_pin_on_disc").glob("*.tsv")):
        result = run("report", path, cwd=tmp_path)
        assert result.returncode == 2
        assert len(result.stderr.splitlines()) == 1
        assert list(tmp_path.iterdir()) == []
