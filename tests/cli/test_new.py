"""``hersey new``: asks in a terminal or takes answers from a pipe, and writes all or nothing."""

from __future__ import annotations

import json
import os
import re
import select
import shlex
import signal
import subprocess
from pathlib import Path

import pytest

from hersey.cli.asking import Asking
from hersey.log.mapping import read_mapping
from hersey.machine.machine import read_machine
from tests.cli.command import HERSEY, run
from tests.cli.test_bad_input import staircase, text
from tests.life.test_campaign import means

#: Eight answers about channels, all as proposed; then what slides, the machine, one point.
CHANNELS = [""] * 8
MACHINE = [
    "",
    "11 N/mm ± 10 %",
    "11 kg",
    "15 mm",
    "0.1 mm/s to 1 mm/s",
    "300 N",
    "200 mm/s",
    "180 degC",
    "full",
    "",
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "log.csv").write_bytes(text(staircase()))
    return tmp_path


def lines(*answers: str) -> str:
    return "".join(f"{answer}\n" for answer in answers)


@pytest.mark.usefixtures("roughly")
def test_answers_from_a_pipe_become_two_files_with_comments(folder: Path) -> None:
    done = run("new", "log.csv", cwd=folder, answers=lines(*CHANNELS, *MACHINE))
    assert done.returncode == 0, done.stderr
    assert "channel of the torque [Torque]" in done.stderr
    assert done.stdout.splitlines() == [
        "hersey.toml", "machine.toml", "Next: hersey report log.csv --machine machine.toml",
    ]  # fmt: skip
    assert read_mapping(folder / "hersey.toml").channels["speed"] == "Speed"
    machine = read_machine(folder / "machine.toml")
    assert (machine.stiffness, machine.limits.nip_load, machine.points[0].name) == (11000, 300, "full")
    assert "# motor_torque" in (folder / "machine.toml").read_text()
    report = run("report", "log.csv", "--machine", "machine.toml", "--json", cwd=folder)
    assert report.returncode == 0, report.stderr


def test_a_dash_leaves_out_and_the_end_leaves_out_the_rest(folder: Path) -> None:
    answers = ["", "", "", "", "-", "", "", "", "", ""]
    done = run("new", "log.csv", "--mapping", "own.toml", cwd=folder, answers=lines(*answers))
    assert done.returncode == 0, done.stderr
    assert read_mapping(folder / "own.toml").channels == {
        "torque": "Torque",
        "speed": "Speed",
        "time": "Time",
    }
    assert "No machine file is written" in done.stderr
    assert done.stdout.endswith("Next: hersey report log.csv --mapping own.toml\n")


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        ([], "hersey new asks questions: type it in a terminal, or pipe the answers"),
        (["Moment"], "answer 1, channel of the torque: log.csv: there is no column 'Moment' (torque)"),
        (["", "rpm"], "answer 2, unit of the torque: unit 'rpm' is not a unit of torque"),
        ([*CHANNELS, "", "11"], "answer 10, k stiffness: '11' has no unit: write '11 N/mm', for example"),
        ([*CHANNELS, "", "11 N/mm", ""], "answer 11, m mass: this answer is required. Estimate it"),
        ([*CHANNELS, "", "11 N/mm", "11 kg"], "the answers end before 'R radius'"),
    ],
)
def test_a_wrong_answer_from_a_pipe_writes_nothing(folder: Path, answers: list[str], said: str) -> None:
    done = run("new", "log.csv", cwd=folder, answers=lines(*answers))
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert [path.name for path in folder.iterdir()] == ["log.csv"]


def test_what_the_answers_do_not_fit_is_said_at_once(folder: Path) -> None:
    machine = [*MACHINE[:5], "", MACHINE[5], *[""] * 9]
    oil = ["", "40 degC: 400 mm^2/s, 100 degC: 40 mm^2/s"]
    done = run("new", "--all", cwd=folder, answers=lines(*machine, *oil))
    assert (done.returncode, done.stdout) == (2, "")
    assert "a kinematic viscosity. Add e.g. density" in done.stderr


def can_be_fitted(folder: Path) -> bool:
    found = json.loads(run("inspect", "log.csv", "--json", cwd=folder).stdout)
    return found["support"] is not None and found["support"]["dwells"] > 0


@pytest.mark.parametrize(
    ("unit", "asked", "answer", "written"),
    [
        ("%", "torque at 100 % (e.g. 9.84 mN*m)", "1.27 N*m", "1.27 N*m / 100"),
        ("%", "torque at 100 % (e.g. 9.84 mN*m)", "1.27 N*m / 100", "1.27 N*m / 100"),
        ("V", "torque per V (e.g. 2 N*m)", "2 N*m", "2 N*m/V"),
        ("mA", "torque per A (e.g. 35 mN*m)", "35 mN*m/A", "35 mN*m/A"),
    ],
)
def test_what_a_signal_stands_for_is_asked(
    unit: str, asked: str, answer: str, written: str, folder: Path
) -> None:
    log = folder / "log.csv"
    log.write_text(log.read_text().replace("Torque [N*m]", f"Torque [{unit}]", 1))
    done = run("new", "log.csv", cwd=folder, answers=lines("", answer, *CHANNELS[2:], ""))
    assert done.returncode == 0, done.stderr
    assert f"{asked} [skip]: " in done.stderr
    assert read_mapping(folder / "hersey.toml").units["torque"] == written
    assert can_be_fitted(folder)
    skipped = run("new", "log.csv", "--force", cwd=folder, answers=lines(*CHANNELS, ""))
    assert skipped.returncode == 0, skipped.stderr
    mapping = folder / "hersey.toml"
    left = mapping.read_text()
    example = re.search(r'unit = "" +# write the unit, e\.g\. (.*)', left)
    assert example
    mapping.write_text(left.replace('unit = ""', f'unit = "{example[1]}"'))
    assert can_be_fitted(folder)
    for wrong in ("9.84", "N*m", "5 rpm"):
        done = run("new", "log.csv", "--force", cwd=folder, answers=lines("", wrong, *CHANNELS))
        assert f"'{wrong}' is not a torque with its unit: write '" in done.stderr


def test_files_that_are_there_are_not_replaced_unasked(folder: Path) -> None:
    (folder / "machine.toml").write_text("mine")
    done = run("new", "log.csv", cwd=folder, answers=lines(*CHANNELS, *MACHINE))
    assert done.returncode == 2
    assert "use --force to replace it" in done.stderr
    assert (folder / "machine.toml").read_text() == "mine"
    assert run("new", "--force", cwd=folder, answers=lines(*MACHINE)).returncode == 0
    assert read_machine(folder / "machine.toml").mass == 11.0
    done = run("new", "--mapping", "x.toml", cwd=folder)
    assert "--mapping needs a LOG" in done.stderr


class Terminal:
    """A command in a terminal of its own."""

    def __init__(self, folder: Path, *typed: str) -> None:
        self._ours, theirs = os.openpty()
        self.process = subprocess.Popen(
            [*HERSEY, *typed], cwd=folder, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True
        )
        os.close(theirs)
        self.seen = ""

    def until(self, words: str) -> None:
        """Wait for what it says."""
        while words not in self.seen:
            assert select.select([self._ours], [], [], 120)[0], self.seen
            try:
                self.seen += os.read(self._ours, 4096).decode()
            except OSError:
                raise AssertionError(self.seen) from None

    def type(self, line: str) -> None:
        self.seen = ""
        os.write(self._ours, f"{line}\n".encode())


def test_by_hand_one_stick_speed_is_asked_for_its_range_and_a_point_gets_a_name(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Asking, "by_hand", True)
    answers = [*MACHINE[:4], "2 mm/s", "± 50 %", MACHINE[5], *MACHINE[6:8], "", ""]
    assert run("new", cwd=folder, answers=lines(*answers)).returncode == 0
    machine = read_machine(folder / "machine.toml")
    assert (machine.stick_speed, machine.uncertainty["stick_speed"].share) == (0.002, 0.5)
    assert machine.points[0].name == "200 mm/s at 180 degC"
    answers[5] = "1 mm/s to 4 mm/s"
    assert run("new", "--force", cwd=folder, answers=lines(*answers)).returncode == 0
    assert read_machine(folder / "machine.toml").uncertainty["stick_speed"].limits == (0.001, 0.004)


def test_in_a_terminal_a_wrong_answer_is_asked_again_and_ctrl_c_leaves_nothing(folder: Path) -> None:
    terminal = Terminal(folder, "new", "--machine", "m.toml")
    terminal.until("part (")
    terminal.type("bread")
    terminal.until("part is 'bread'. Write 'drive', 'belt', 'joint'")
    terminal.until("part (")
    terminal.type("")
    terminal.until("k stiffness")
    terminal.type("11")
    terminal.until("'11' has no unit: write '11 N/mm', for example")
    terminal.until("k stiffness")
    terminal.type("11 N/mm")
    terminal.until("m mass")
    terminal.process.send_signal(signal.SIGINT)
    terminal.until("hersey: interrupted")
    assert terminal.process.wait() == 130
    assert [path.name for path in folder.iterdir()] == ["log.csv"]


def test_an_unknown_unit_is_asked_for_with_the_likely_one_as_proposal(folder: Path) -> None:
    content = text(staircase()).decode()
    header = "Time [s],M (kg-cm),Speed [rpm],Temperature [degC]"
    (folder / "log.csv").write_text("\n".join([header, *content.splitlines()[1:]]) + "\n")
    done = run("new", "log.csv", cwd=folder, answers=lines("M", *CHANNELS[1:], ""))
    assert done.returncode == 0, done.stderr
    assert "[kgf*cm]" in done.stderr
    assert "--torque-unit" not in done.stderr
    assert read_mapping(folder / "hersey.toml").units["torque"] == "kgf*cm"
    (folder / "hersey.toml").unlink()
    done = run("new", "log.csv", cwd=folder, answers=lines("N"))
    assert (done.returncode, "'N' (torque)" in done.stderr, "--" in done.stderr) == (2, True, False)


#: What a person who knows the test stand writes into each line, by role and field.
KNOWN = {
    "torque": {"channel": "a1", "unit": "mN*m"},
    "speed": {"channel": "b1", "unit": "rpm"},
    "temperature": {"channel": "hot", "unit": "degC"},
    "time": {"channel": "when", "unit": "s"},
}


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize(
    ("heading", "lines_to_complete"),
    [
        (
            "time,torque,speed,temperature",
            "line 5 (unit of the torque), line 14 (unit of the speed), line 20 (unit of the temperature), "
            "line 26 (unit of the time)",
        ),
        ("Time [s],torque,Speed [rpm],Temperature [degC]", "line 5 (unit of the torque)"),
        (
            "when [s],a1,b1,hot [degC]",
            "line 4 (channel of the torque), line 5 (unit of the torque), line 13 (channel of the speed), "
            "line 14 (unit of the speed)",
        ),
    ],
)
def test_what_no_log_tells_is_left_to_be_completed(
    heading: str, lines_to_complete: str, tmp_path: Path
) -> None:
    """The file names the lines, guesses no unit, and with them the next command works as it is printed."""
    content = text(staircase()).decode()
    (tmp_path / "log.csv").write_text("\n".join([heading, *content.splitlines()[1:]]) + "\n")
    done = run("new", "log.csv", cwd=tmp_path, answers=lines(*CHANNELS, ""))
    assert done.returncode == 0, done.stderr
    first, complete, then = done.stdout.splitlines()
    assert (first, complete) == ("hersey.toml", f"First complete hersey.toml: {lines_to_complete}")
    assert then == "Then: hersey report log.csv"
    mapping = tmp_path / "hersey.toml"
    named = [int(number) for number in re.findall(r"line (\d+)", complete)]
    written = mapping.read_text().splitlines()
    assert [i for i, line in enumerate(written, 1) if re.match(r'\w+ = "" ', line)] == named
    refused = run("report", "log.csv", cwd=tmp_path)
    assert refused.returncode == 2
    assert re.search("hersey.toml, line [0-9]+: [a-z]+[.](unit|channel) is empty. Fill it in", refused.stderr)
    role = ""
    for i, line in enumerate(written):
        role = line.strip("[]") if line.startswith("[") else role
        if i + 1 in named:
            field = line.split()[0]
            written[i] = f'{field} = "{KNOWN[role][field]}"'
    mapping.write_text("\n".join(written))
    report = run(*shlex.split(then)[2:], cwd=tmp_path)
    assert report.returncode == 0, report.stderr
    assert (tmp_path / "report.html").is_file()


@pytest.mark.usefixtures("roughly")
def test_a_log_without_temperature_gets_a_command_that_works(tmp_path: Path) -> None:
    rows = [",".join(line.split(",")[:3]) for line in text(staircase()).decode().splitlines()]
    (tmp_path / "log.csv").write_text("\n".join(rows) + "\n")
    done = run("new", "log.csv", cwd=tmp_path, answers=lines(*CHANNELS, ""))
    assert done.stdout.splitlines()[1:] == ["Next: hersey report log.csv --isothermal"]
    assert run("report", "log.csv", "--isothermal", cwd=tmp_path).returncode == 0


def test_a_table_of_means_needs_no_time(tmp_path: Path) -> None:
    means(tmp_path / "log.csv")
    done = run("new", "log.csv", cwd=tmp_path, answers=lines(*CHANNELS, ""))
    assert done.stdout.splitlines() == ["hersey.toml", "Next: hersey report log.csv"]
