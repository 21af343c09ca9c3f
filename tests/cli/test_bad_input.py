"""Bad input ends in one clear line and exit code 2, without a traceback, and touches nothing."""

from __future__ import annotations

import os
import re
import shlex
from pathlib import Path

import pytest

from tests.cli.command import Done, run

HEADER = "Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n"


def staircase(
    speeds: tuple[float, ...] = (10, 20, 40, 80), temperatures: tuple[float, ...] = (100, 150)
) -> list[str]:
    rows, time = [], 0.0
    for temperature in temperatures:
        for speed in speeds:
            for i in range(60):
                torque = 1.0 + 0.01 * speed + 0.002 * ((i * 7) % 5)
                rows.append(f"{time:.1f},{torque:.4f},{speed},{temperature}")
                time += 0.1
    return rows


def text(rows: list[str], header: str = HEADER) -> bytes:
    return (header + "\n".join(rows) + "\n").encode()


def altered(line: int, cell: int, value: str) -> bytes:
    rows = staircase()
    cells = rows[line - 2].split(",")
    cells[cell] = value
    rows[line - 2] = ",".join(cells)
    return text(rows)


FILES: dict[str, tuple[bytes, list[str]]] = {
    "empty file": (b"", ["is empty"]),
    "blank file": (b"\n \n", ["is empty"]),
    "header only": (HEADER.encode(), ["no rows"]),
    "a column of words": (
        text([",".join([*row.split(",")[:2], "fast", row.split(",")[3]]) for row in staircase()]),
        ["line 2", "'Speed'", "'fast'", "the first of 480 such rows, of 480", "Name another column"],
    ),
    "missing unit": (text(staircase(), HEADER.replace(" [N*m]", "")), ["'Torque' has no unit"]),
    "unknown unit": (text(staircase(), HEADER.replace("N*m", "Nmz")), ["unknown unit 'Nmz'"]),
    "unit of the wrong dimension": (text(staircase(), HEADER.replace("N*m", "V")), ["'V'", "not a unit"]),
    "ambiguous speed unit": (text(staircase(), HEADER.replace("rpm", "Hz")), ["revolutions or radians"]),
    "no torque column": (text(staircase(), HEADER.replace("Torque [N*m]", "Force [N]")), ["--torque"]),
    "time running backwards": (
        text([*staircase()[:80], *staircase()[70:40:-1]]),
        ["line 82", "backwards"],
    ),
    "many NaN rows": (
        text([",".join([*r.split(",")[:2], "NaN,150"]) if i > 440 else r for i, r in enumerate(staircase())]),
        ["line 443", "'Speed'", "the first of 39 such rows, of 480", "--drop-missing"],
    ),
    "constant speed only": (text(staircase(speeds=(30,))), ["speed", "three or more speeds"]),
    "one temperature only": (text(staircase(temperatures=(150,))), ["one temperature", "--isothermal"]),
    "two rows": (text(staircase()[:2]), ["2 rows"]),
    "nothing steady": (text([f"{i / 10},1,{i},100" for i in range(400)]), ["no dwell found"]),
    "numbers without a header": ("\n".join(staircase()).encode(), ["header"]),
    "one row": (text(staircase()[:1]), ["1 row"]),
    "one time for all": (text([r.replace(r.split(",")[0], "5.0", 1) for r in staircase()]), ["same time"]),
    "zero torque": (
        text([",".join([r.split(",")[0], "0", *r.split(",")[2:]]) for r in staircase()]),
        ["zero"],
    ),
    "signs against each other": (
        text([",".join([r.split(",")[0], "-1", *r.split(",")[2:]]) for r in staircase()]),
        ["opposite signs", "--torque-sign"],
    ),
    "binary file": (bytes(range(256)) * 40, ["binary"]),
    "text that is no table": (b"Dear sir,\nthe log is late.\nYours\n", ["table"]),
}


def assert_one_clear_line(result: Done, says: list[str]) -> None:
    assert result.returncode == 2, result
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("hersey: ")
    assert "Traceback" not in line
    for words in says:
        assert words in line


@pytest.mark.parametrize("case", FILES)
def test_bad_file(case: str, tmp_path: Path) -> None:
    content, says = FILES[case]
    (tmp_path / "log.csv").write_bytes(content)
    result = run("report", "log.csv", cwd=tmp_path)
    assert_one_clear_line(result, says)
    assert [p.name for p in tmp_path.iterdir()] == ["log.csv"]
    assert (tmp_path / "log.csv").read_bytes() == content


ONE_ROW: dict[str, tuple[bytes, list[str]]] = {
    "text in a number column": (altered(57, 1, "high"), ["line 57", "'Torque'", "'high'"]),
    "text in the first row": (altered(2, 1, "high"), ["line 2", "'Torque'", "'high'"]),
    "a time that lies apart": (
        altered(80, 0, "0.5"),
        ["line 80", "impossible time 0.5 s (once)", "out of line"],
    ),
    "an endless cell": (altered(99, 2, "1" * 200_000), ["line 99", "'Speed'"]),
    "NaN row": (altered(99, 2, "NaN"), ["line 99", "'Speed'"]),
    "empty cell": (altered(99, 2, ""), ["line 99", "'Speed'"]),
    "infinite": (altered(99, 2, "inf"), ["line 99", "'Speed'"]),
    "row too short": (text([*staircase(), "48.0,1.0"]), ["line 482"]),
}


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("case", ONE_ROW)
def test_a_bad_cell_costs_its_row_and_is_told(case: str, tmp_path: Path) -> None:
    content, says = ONE_ROW[case]
    (tmp_path / "log.csv").write_bytes(content)
    result = run("report", "log.csv", cwd=tmp_path)
    assert result.returncode == 0, result
    line = " ".join(result.stderr.split())
    assert line.startswith("log.csv: 1 row was excluded")
    for words in says:
        assert words in line
        assert words in (tmp_path / "report.html").read_text()


@pytest.fixture
def good(tmp_path: Path) -> Path:
    (tmp_path / "log.csv").write_bytes(text(staircase()))
    return tmp_path


@pytest.mark.usefixtures("roughly")
def test_the_good_file_is_good(good: Path) -> None:
    assert run("report", "log.csv", cwd=good).returncode == 0
    assert (good / "report.html").stat().st_size < 2_000_000


def test_missing_file(good: Path) -> None:
    assert_one_clear_line(run("report", "other.csv", cwd=good), ["File not found: other.csv"])


def test_no_ordinary_file(good: Path) -> None:
    os.mkfifo(good / "pipe")
    assert_one_clear_line(run("report", "pipe", cwd=good), ["not a regular file"])
    assert_one_clear_line(run("report", "log.csv/x", cwd=good), ["cannot be read"])
    (good / "loop").symlink_to("loop")
    assert_one_clear_line(run("report", "loop", cwd=good), ["loop"])


def test_links_are_not_replaced(good: Path) -> None:
    (good / "report.html").symlink_to("elsewhere.html")
    assert_one_clear_line(run("report", "log.csv", "--force", cwd=good), ["not an ordinary file"])
    assert (good / "report.html").is_symlink()


def test_directory(good: Path) -> None:
    assert_one_clear_line(run("report", ".", cwd=good), ["folder"])


@pytest.mark.usefixtures("roughly")
def test_existing_report_is_kept(good: Path) -> None:
    (good / "report.html").write_text("mine")
    assert_one_clear_line(run("report", "log.csv", cwd=good), ["report.html exists", "--force"])
    assert (good / "report.html").read_text() == "mine"
    assert run("report", "log.csv", "--force", cwd=good).returncode == 0
    assert (good / "report.html").read_text() != "mine"


def test_no_place_to_write(good: Path) -> None:
    assert_one_clear_line(run("report", "log.csv", "--out", "no/r.html", cwd=good), ["no directory"])
    assert_one_clear_line(run("report", "log.csv", "--out", ".", cwd=good), ["directory"])


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_no_write_permission(good: Path) -> None:
    (good / "locked").mkdir(mode=0o500)
    assert_one_clear_line(run("report", "log.csv", "--out", "locked/r.html", cwd=good), ["cannot be written"])


def test_no_write_permission_on_a_system_folder(good: Path) -> None:
    assert_one_clear_line(run("report", "log.csv", "--out", "/proc/r.html", cwd=good), ["cannot be written"])


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--tare", "zero"], ["tare 'zero'"]),
        (["--tare", "standing"], ["never stands"]),
        (["--rotation", "left"], ["rotation 'left'"]),
        (["--rotation", "reverse"], ["no dwell found"]),
        (["--min-dwell", "soon"], ["'soon'"]),
        (["--min-dwell", "-5 s"], ["min_dwell is -5 s"]),
        (["--min-dwell", "2,5 s"], ["'2,5 s'"]),
        (["--isothermal", "--temperature", "Temperature"], ["--isothermal"]),
        (["--out", "log.csv", "--force"], ["is an input"]),
        (["--out", "/dev/null", "--force"], ["not an ordinary file"]),
        (["--out", "x" * 300], ["cannot be written"]),
        (["--temperature-scale", "F"], ["temperature scale 'F'"]),
        (["--torque", "Moment"], ["no column 'Moment'"]),
        (["--torque-unit", "V"], ["'V'"]),
        (["--nonsense"], ["--nonsense"]),
        (["--machine", "no.toml"], ["no.toml"]),
    ],
)
def test_bad_option(arguments: list[str], says: list[str], good: Path) -> None:
    assert_one_clear_line(run("report", "log.csv", *arguments, cwd=good), says)
    assert [p.name for p in good.iterdir()] == ["log.csv"]


@pytest.mark.parametrize(
    ("toml", "says"),
    [
        ("[drivetrain", ["not valid TOML"]),
        ("a = " + "[" * 5000, ["not valid TOML"]),
        ('[drivetrain]\nstiffness = "1e300 N/m"\n', ["drivetrain.stiffness", "must be within"]),
        ('[drivetrain]\nstiffness = "0,3 N/m"\n', ["drivetrain.stiffness"]),
        ("[roll]\n", ["[drivetrain]"]),
        ('[drivetrain]\nstiffness = "11 N/mm"\n', ["needs the key 'mass'"]),
        ("[drivetrain]\nstiffness = 11\n", ["drivetrain.stiffness", "unit"]),
        ('[drivetrain]\nstiffness = "11 kg"\n', ["drivetrain.stiffness"]),
        ('[drivetrain]\nstiffness = "-11 N/m"\n', ["greater than 0"]),
        ('[drivetrain]\nspring = "11 N/m"\n', ["unknown key 'spring'"]),
    ],
)
def test_bad_machine_file(toml: str, says: list[str], good: Path) -> None:
    (good / "machine.toml").write_text(toml)
    assert_one_clear_line(run("report", "log.csv", "--machine", "machine.toml", cwd=good), says)


def test_simulation_parameters_are_checked(tmp_path: Path) -> None:
    assert_one_clear_line(run("simulate", "--stiffness", "-1", cwd=tmp_path), ["stiffness is -1"])
    assert_one_clear_line(run("simulate", "--mass", "heavy", cwd=tmp_path), ["--mass", "number"])
    assert_one_clear_line(run("simulate", "--start", "up", cwd=tmp_path), ["start is 'up'"])


def test_the_units_that_all_columns_lack_are_options_of_one_line(tmp_path: Path) -> None:
    bare = re.sub(r" \[[^\]]*\]", "", text(staircase()).decode())
    (tmp_path / "log.csv").write_text(bare)
    said = run("fit", "log.csv", cwd=tmp_path).stderr
    assert_one_clear_line(
        run("fit", "log.csv", cwd=tmp_path),
        ["columns 'Time', 'Torque', 'Speed', 'Temperature' have no units"],
    )
    name, *command = shlex.split(said.partition(" In full: ")[2])
    typed = command[2:]
    assert (name, command[:2], len(typed)) == ("hersey", ["fit", "log.csv"], 8)
    done = run(*command, cwd=tmp_path)
    assert "no unit" not in done.stderr
    assert run("inspect", "log.csv", *typed, cwd=tmp_path).returncode == 0
