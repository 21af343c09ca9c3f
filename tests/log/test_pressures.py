"""Pressures of a cylinder and times of pulses: what a log holds in the place of a torque or a speed."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError
from tests.cli import command


def cylinder() -> pl.DataFrame:
    """Strokes of a cylinder whose seals rub with 100 N."""
    row = np.arange(600)
    out = row // 100 % 2 == 0
    back = np.full(600, 2.0)
    ahead = np.where(out, (back * 134.77 + 100.0) / 196.35, (back * 134.77 - 100.0) / 196.35)
    position = np.cumsum(np.where(out, 0.2, -0.2)) + 30.0
    names = ("Time [s]", "Position [mm]", "Pressure A [bar]", "Pressure B [bar]")
    return pl.DataFrame(dict(zip(names, (0.01 * row, position, ahead, back), strict=True)))


def test_a_force_is_to_be_computed_from_the_pressures_of_a_cylinder() -> None:
    log = cylinder()
    with pytest.raises(ChannelError) as refused:
        hersey.read(log)
    assert (
        "If 'Pressure A' and 'Pressure B' are the pressures in the chambers of a cylinder, add a column "
        "'Friction force [N]', 'Pressure A' x piston area A - 'Pressure B' x piston area B"
    ) in str(refused.value)
    force = 196.35 * log["Pressure A [bar]"] - 134.77 * log["Pressure B [bar]"]
    log = log.with_columns(force.alias("Friction force [N]"))
    channels = {"torque": "Friction force", "position": "Position"}
    run = hersey.read(log, channels=channels, isothermal=True).runs[0]
    assert np.abs(run.torque) == pytest.approx(100.0)
    assert run.speed[50] == pytest.approx(0.02)


@pytest.mark.parametrize("others", [["Pressure A [bar]"], ["Pressure A [bar]", "Oil [bar]", "Room [mbar]"]])
def test_pressures_of_anything_else_are_no_cylinder(others: list[str]) -> None:
    names = ["Time [s]", "Speed [mm/s]", *others]
    with pytest.raises(ChannelError) as refused:
        hersey.read(pl.DataFrame({name: np.arange(50) / 10 for name in names}))
    assert "cylinder" not in str(refused.value)


def wheel(path: Path, pulses: np.ndarray) -> Path:
    """Times of the pulses of six magnets on a wheel that Coulomb friction brakes, 0.5 rad/s2."""
    angle = 2 * np.pi * (np.arange(pulses.size) + 1) / 6
    start = 20.0
    time = (start - np.sqrt(start**2 - angle)) / 0.5
    rows = [f"{number:.0f},{1e6 * each:.0f}" for number, each in zip(pulses, time, strict=True)]
    path.write_text("\n".join(["pulse,micros", *rows]) + "\n")
    return path


def test_pulses_are_sent_to_a_coast_down_that_works(tmp_path: Path) -> None:
    path = wheel(tmp_path / "wheel.csv", np.arange(1, 351))
    refused = command.run("fit", path.name, cwd=tmp_path)
    assert refused.returncode != 0
    said = "The rows are the times of pulses. If the wheel coasts down without a drive, type, "
    assert said in refused.stderr
    line = refused.stderr.rpartition("hersey coastdown ")[2].strip()
    done = command.run("coastdown", *shlex.split(line.replace("0.012", "0.0935")), cwd=tmp_path)
    assert done.returncode == 0
    assert "Coulomb: 46" in done.stdout  # 0.0935 kg*m^2 times 0.5 rad/s2


def test_what_counts_otherwise_is_no_pulse(tmp_path: Path) -> None:
    path = wheel(tmp_path / "wheel.csv", np.arange(1, 351) // 2)
    assert "times of pulses" not in command.run("fit", path.name, cwd=tmp_path).stderr
