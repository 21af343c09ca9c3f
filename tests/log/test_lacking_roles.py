"""Several roles that a file leaves open are asked for in one message, whose advice works."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

import hersey
from hersey.errors import ISOTHERMAL, ChannelError, HerseyError, Setting, UnitError, speak
from tests.cli import command

JOINTS = "timestamp qd_0 qd_1 moment_0 moment_1 temp_0 temp_1"


def written(path: Path, header: str, joint: str = " ") -> Path:
    """Five speeds; the second joint turns ten times as fast."""
    rows = []
    for i in range(400):
        speed = (1, 2, 4, 8, 16)[i // 80] + 1e-3 * (i % 5)
        row = [
            0.1 * i,
            speed,
            10 * speed,
            0.4 * speed**0.4,
            4 * speed**0.4,
            40 + 0.01 * (i % 7),
            50.0 + i % 2,
        ]
        rows.append(joint.join(f"{cell:.4f}" for cell in row[: header.count(joint) + 1]))
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_columns_and_units_that_are_open_are_asked_for_at_once(tmp_path: Path) -> None:
    path = written(tmp_path / "log.txt", JOINTS)
    with pytest.raises(ChannelError) as refused:
        hersey.read(path)
    assert refused.value.reason == (
        "log.txt: the torque column could be 'moment_0' or 'moment_1'; no speed column found; the "
        "temperature column could be 'temp_0' or 'temp_1'; no unit for 'timestamp', 'moment_0', 'temp_0'. "
        "Columns: "
        "'timestamp', 'qd_0', 'qd_1', 'moment_0', 'moment_1', 'temp_0', 'temp_1'"
    )
    assert refused.value.examples == (
        (Setting("time", "unit"), "s"),
        (Setting("torque", "channel"), "moment_0"),
        (Setting("torque", "unit"), "N*m"),
        (Setting("speed", "channel"), "COLUMN"),
        (Setting("speed", "unit"), "rpm"),
        (Setting("temperature", "channel"), "temp_0"),
        (Setting("temperature", "unit"), "degC"),
    )
    channels = {"torque": "moment_1", "speed": "qd_1", "temperature": "temp_1"}
    units = {"time": "s", "torque": "N*m", "speed": "rad/s", "temperature": "degC"}
    log = hersey.read(path, channels=channels, units=units)
    assert log.runs[0].speed[-1] == pytest.approx(160, rel=1e-2)


def test_a_repeated_name_is_proposed_with_its_place(tmp_path: Path) -> None:
    path = written(tmp_path / "log.csv", "time [s],torque,torque,speed", ",")
    with pytest.raises(ChannelError) as refused:
        hersey.read(path)
    assert (Setting("torque", "channel"), "torque#1") in refused.value.examples


def test_the_whole_command_is_proposed_in_the_terminal(tmp_path: Path) -> None:
    path = written(tmp_path / "log.csv", "time,n_1 [rad/s],n_2 [rad/s],current_mot", ",")
    done = command.run("fit", path.name, cwd=tmp_path)
    assert "no unit for 'time'. " in done.stderr
    typed = shlex.split(done.stderr.partition("In full: hersey ")[2])
    assert typed[:2] == ["fit", "log.csv"]
    flags = dict(zip(typed[2:-1:2], typed[3::2], strict=True))
    assert flags == {
        "--time-unit": "s",
        "--torque": "current_mot",
        "--torque-unit": "35 mN*m/A",
        "--speed": "n_1",
    }
    assert typed[-1] == "--isothermal"
    assert command.run(*typed, cwd=tmp_path).returncode == 0


@pytest.mark.parametrize(
    ("header", "said"),
    [
        ("time [s],torque [N*m],speed", "has no unit"),  # one thing alone keeps its own words
        ("time [s],a,b", "no torque column found"),  # no log at all
    ],
)
def test_one_open_role_keeps_its_own_words(header: str, said: str, tmp_path: Path) -> None:
    path = written(tmp_path / "log.csv", header, ",")
    with pytest.raises(ChannelError if "found" in said else UnitError, match=said) as refused:
        hersey.read(path, isothermal=True)
    assert not getattr(refused.value, "examples", ())


def test_what_no_column_is_left_for_is_asked_for_elsewhere(tmp_path: Path) -> None:
    path = written(tmp_path / "log.csv", "t [s],M [Nm]", ",")
    speak("terminal")
    try:
        with pytest.raises(HerseyError, match=r"Use --schedule schedule\.csv --isothermal$"):
            hersey.read(path)
    finally:
        speak("python")


def test_a_log_without_any_column_for_a_torque_is_refused_in_words(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t [s],w [rpm]\n" + "\n".join(f"{0.1 * i:.1f},{20 + i % 3}" for i in range(400)))
    with pytest.raises(ChannelError, match="no torque column found"):
        hersey.read(path, channels={"speed": "w"}, isothermal=True)


def test_columns_without_names_are_asked_for_with_their_units(tmp_path: Path) -> None:
    path = written(tmp_path / "log.csv", "0.0,1.0,10.0,0.4", ",")
    speak("terminal")
    try:
        with pytest.raises(HerseyError, match=r"--torque '#2'.*--torque-unit 'N\*m'.*, with your units"):
            hersey.read(path)
    finally:
        speak("python")


def test_a_friction_coefficient_beside_a_torque_is_asked_about(tmp_path: Path) -> None:
    path = written(tmp_path / "log.csv", "time [s],speed [rpm],COF,Tz [N-mm]", ",")
    with pytest.raises(ChannelError, match=r"the torque column could be 'COF' or 'Tz \[N-mm\]'"):
        hersey.read(path, isothermal=True)
    torque = hersey.read(path, isothermal=True, channels={"torque": "Tz"})
    assert torque.domain.is_torque
    assert not hersey.read(path, isothermal=True, channels={"torque": "COF"}).domain.is_torque


def axis(path: Path) -> Path:
    """A log of a linear motor at one speed, as text or as a MATLAB file."""
    row = np.arange(400.0)
    columns = {
        "time_s": 0.01 * row,
        "enc_cnt": np.floor(row * (1 + row // 100)),
        "iq_A": 0.5 + 0.01 * (row % 3),
    }
    if path.suffix == ".mat":
        savemat(path, {name: np.asarray(values) for name, values in columns.items()})
    else:
        rows = [",".join(f"{cell:.10g}" for cell in each) for each in zip(*columns.values(), strict=True)]
        path.write_text("\n".join([",".join(columns), *rows]) + "\n")
    return path


@pytest.mark.parametrize("name", ["axis.csv", "axis.mat"])
def test_a_current_and_a_position_are_asked_for_at_once_in_any_format(name: str, tmp_path: Path) -> None:
    path = axis(tmp_path / name)
    with pytest.raises(ChannelError) as refused:
        hersey.read(path)
    assert refused.value.reason == (
        f"{name}: no torque column found ('iq' may be the motor current); no speed column found; no "
        "temperature column found. Columns: 'time [s]', 'enc_cnt', 'iq [A]'"
    )
    assert refused.value.examples == (
        (Setting("torque", "channel"), "iq"),
        (Setting("torque", "unit"), "35 mN*m/A"),
        (Setting("position", "channel"), "enc_cnt"),
        (Setting("position", "unit"), "rev/4096"),
        (ISOTHERMAL, ""),
    )
    assert "the counts of one turn of your encoder, or units={'position': '0.5 um'} for one of a line" in (
        refused.value.remedy
    )
    channels = {"torque": "iq", "position": "enc_cnt"}
    for unit, speed in (("rev/4096", 2 * np.pi * 100 / 4096), ("0.5 um", 5e-5)):
        force = "38.6 N/A" if unit == "0.5 um" else "35 mN*m/A"
        log = hersey.read(path, channels=channels, units={"torque": force, "position": unit}, isothermal=True)
        assert log.runs[0].speed[20] == pytest.approx(speed, rel=1e-6)
