"""A profile of the drive as a file: followed as the library follows it, or refused by line and column."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hersey import Drag, Drivetrain, Schedule, simulate, stick_slip
from hersey.cli.columns import read_profile
from hersey.errors import HerseyError
from tests.cli.command import run

BELT = ["--stiffness", "11 N/mm", "--mass", "11 kg", "--transition-force", "14 N"]
BELT += ["--transition-speed", "25 mm/s", "--stick-speed", "1 mm/s"]


def test_it_is_followed_to_its_end(tmp_path: Path) -> None:
    (tmp_path / "profile.csv").write_text("speed (m/min),time (ms)\n0,0\n6,400\n\n1.8,1000\n")
    done = run("simulate", *BELT, "--profile", "profile.csv", "--duration", "3 s", "--json", cwd=tmp_path)
    answer = json.loads(done.stdout)
    train = Drivetrain(11e3, 11.0)
    drag = Drag(14.0, 0.025, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.001)
    drive = Schedule([0.0, 0.4, 1.0], [0.0, 0.1, 0.03])
    motion = simulate(train, drag, drive_speed=drive, duration=3.0)
    assert answer["energy"]["work"] == pytest.approx(motion.energy.work, rel=1e-6)
    state = float(motion.belt_speed[-1]), float(motion.stretch[-1])
    settled = stick_slip(train, drag, drive_speed=0.03, start=state)
    assert answer["kind"] == settled.kind
    assert answer["frequency"] == pytest.approx(settled.frequency)


def test_a_remark_in_windows_1252_does_no_harm(tmp_path: Path) -> None:
    (tmp_path / "profile.csv").write_bytes("time (s),speed (m/s),für\n0,0,ü\n1,2,ü\n".encode("cp1252"))
    assert read_profile(tmp_path / "profile.csv").values == pytest.approx([0.0, 2.0])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", r"'time \(s\),speed \(mm/s\)' in line 1"),
        ("time (s)\n0\n", r"'time \(s\),speed \(mm/s\)' in line 1"),
        ("0,1\n1,2\n", r"'time \(s\),speed \(mm/s\)' in line 1"),
        ("time (s),n (rpm)\n0,0\n", r"no column is named speed.*'n \[rpm\]'.*'speed \(mm/s\)'"),
        ("time (s),speed\n0,0\n", r"column 'speed' has no unit. Write 'speed \(mm/s\)'"),
        ("time (s),speed (rpm)\n0,0\n", r"column 'speed \[rpm\]': unit 'rpm' is that of a speed of rotation"),
        ("time (s),speed (mm/s),speed (m/s)\n0,0,0\n", "more than one column is named speed"),
        ("time (s),speed (mm/s)\n", "no rows"),
        ("time (s),speed (mm/s)\n0,1\n1,x\n", "line 3, column 'speed': 'x' is not a number"),
        ("time (s),speed (mm/s)\n0,1\n1\n", "line 3, column 'speed': an empty cell"),
        ("time (s),speed (mm/s)\n0,1\n1,nan\n", "line 3, column 'speed': 'nan'"),
        ("time (s),speed (mm/s)\n1,1\n0,1\n", "times must ascend"),
        ("time (s),speed (mm/s)\n0,1\n1,0\n", "the last must be greater than 0"),
        ("time (s),speed (mm/s)\n0,-1\n1,2\n", "speeds must not be negative"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, told: str) -> None:
    file = tmp_path / "profile.csv"
    file.write_text(text)
    with pytest.raises(HerseyError, match=rf"^profile\.csv.*{told}"):
        read_profile(file)


@pytest.mark.parametrize(
    "text", ["time (s);speed (mm/s)\r\n0,0;5\r\n0,5;22,5\r\n", "time (s)\tspeed (mm/s)\n0\t5\n.5\t22.5\n"]
)
def test_it_is_read_as_a_spreadsheet_saves_it(tmp_path: Path, text: str) -> None:
    (tmp_path / "profile.csv").write_text(text)
    profile = read_profile(tmp_path / "profile.csv")
    assert profile.at(0.5) == pytest.approx(0.0225)


def test_one_speed_or_a_profile(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("time (s),speed (mm/s)\n0,5\n")
    done = run("simulate", "--profile", "p.csv", "--drive-speed", "1 mm/s", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (
        2,
        "hersey: --profile and --drive-speed exclude each other: give one of them\n",
    )
