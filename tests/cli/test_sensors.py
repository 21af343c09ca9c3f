"""Errors of the sensors from the machine file, and which count where the mapping states them too."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from hersey.cli.options import Reading
from hersey.log.sensors import Sensors
from hersey.machine import Machine, read_machine
from tests.cli.command import run
from tests.conftest import ROOT

#: A log that is read and not fitted: it holds no dwell.
LOG = "time [s],torque [N*m],speed [rpm],temp [degC]\n" + "".join(
    f"{0.1 * i:.1f},1,{i},{150 + i}\n" for i in range(60)
)
MEANS = "speed [rpm],torque [N*m],temp [degC]\n10,1,100\n20,1.1,100\n"
SENSORS = """
[sensors.torque]
gain_error = "3 %"
[sensors.speed]
gain_error = "0.5 %"
"""
BOTH = "The sensor errors of torque come from the mapping, not from the machine file."


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    text = (ROOT / "tests" / "stand" / "machine.toml").read_text()
    (tmp_path / "machine.toml").write_text(text + SENSORS)
    return read_machine(tmp_path / "machine.toml")


@pytest.mark.parametrize("text", [LOG, MEANS], ids=["log", "means"])
def test_the_mapping_outranks_the_machine_for_each_sensor(
    text: str, machine: Machine, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "log.csv"
    log.write_text(text)
    of_machine = Sensors(torque_gain=0.03, speed_gain=0.005, stated=("torque", "speed"))
    assert Reading().log([log]).sensors == Sensors()
    assert Reading().log([log], machine).sensors == of_machine
    assert "sensor errors of" not in capsys.readouterr().err
    (tmp_path / "hersey.toml").write_text('[torque]\ngain_error = "2 %"\n')
    assert Reading().log([log], machine).sensors == replace(of_machine, torque_gain=0.02)
    assert capsys.readouterr().err.splitlines()[-1] == BOTH


@pytest.mark.parametrize("command", ["report", "film", "map", "plan"])
@pytest.mark.usefixtures("machine")
def test_every_command_of_a_machine_takes_its_sensors(command: str, tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(LOG)
    (tmp_path / "hersey.toml").write_text('[torque]\ngain_error = "2 %"\n')
    arguments = {
        "report": ["log.csv", "--machine", "machine.toml"],
        "film": ["machine.toml", "--log", "log.csv"],
        "map": ["machine.toml", "log.csv"],
        "plan": ["machine.toml", "log.csv", "--target", "60 mm/s"],
    }
    done = run(command, *arguments[command], cwd=tmp_path)
    assert (done.returncode, BOTH in done.stderr) == (2, True), done.stderr


@pytest.mark.usefixtures("machine")
def test_a_finished_fit_keeps_its_own(tmp_path: Path) -> None:
    done = run("map", "machine.toml", "--fit", "none.json", cwd=tmp_path)
    assert "The sensor errors come from the fit, not from the machine file." in done.stderr
    done = run("map", ROOT / "tests" / "stand" / "machine.toml", "--fit", "none.json", cwd=tmp_path)
    assert "sensors" not in done.stderr
