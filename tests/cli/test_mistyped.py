"""Command lines with a slip: the message names an option of the command, or a line that can be typed."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from hersey.cli.application import load
from tests.cli.command import run
from tests.conftest import ROOT

#: Dashes of word processors.
EN, EM = "\N{EN DASH}", "\N{EM DASH}"


def options(verb: str) -> set[str]:
    """The options of a command."""
    return {name for each in load(verb).params for name in each.opts}


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        (["report", "a.csv", "--temp", "T"], ["--temperature"]),
        (["report", "a.csv", "--torque_unit=Nm"], ["--torque-unit"]),
        (["report", "a.csv", "-machine", "m.toml"], ["--machine"]),
        (["report", "a.csv", "-o", "x.html"], ["--out"]),
        (["fit", "a.csv", "--out", "fit.json"], ["--each", "--json > fit.json"]),
        (["compare", "a.csv", "b.csv", "--out", "x.json"], ["--json > x.json"]),
        (["simulate", "--out", "x.csv"], ["--csv"]),
        (["simulate", "--out", "x.png"], ["--figure"]),
        (["simulate", "--speed", "5"], ["--drive-speed"]),
        (["cycles", "a.csv", "--torque", "T"], ["--value"]),
        (["campaign", "add", "l.hersey", "a.csv", "--specimen", "F1"], ["--unit"]),
    ],
)
def test_an_unknown_option_names_the_one_that_was_meant(
    typed: list[str], meant: list[str], tmp_path: Path
) -> None:
    done = run(*typed, cwd=tmp_path)
    assert done.returncode == 2
    proposed = re.fullmatch(r"hersey: .* has no option .*\. Did you mean (.*)\?\n", done.stderr)
    assert proposed, done.stderr
    assert proposed[1].split(" or ") == meant
    if typed[0] != "campaign":
        assert {each.split()[0] for each in meant} <= options(typed[0])


def test_an_option_of_other_commands_is_omitted_with_its_value(tmp_path: Path) -> None:
    done = run("report", "a.csv", "--fit", "f.json", cwd=tmp_path)
    assert done.returncode == 2
    assert ". Omit --fit f.json. " in done.stderr
    named = re.findall(r"hersey (\w+)(?:,|$)", done.stderr.partition("option of")[2].strip())
    assert named
    assert all("--fit" in options(verb) for verb in named)


@pytest.mark.parametrize(
    ("typed", "line"),
    [
        ("plan a.csv --machine m.toml --target '60 mm/s'", "plan m.toml a.csv --target '60 mm/s'"),
        ("plan --machine=m.toml a.csv", "plan m.toml a.csv"),
        ("export fmu --fit f.json m.toml --out x.fmu", "export fmu f.json m.toml --out x.fmu"),
        (
            "export f.json m.toml --out x.fmu",
            "export fmu f.json m.toml --out x.fmu --temperature '180 degC'",
        ),
        (
            "export m.toml f.json --out x.slx",
            "export fmu f.json m.toml --out x.fmu --temperature '180 degC'",
        ),
        ("report --log a.csv --tare standing", "report --tare standing a.csv"),
        ("--machine m.toml report a.csv", "report --machine m.toml a.csv"),
        ("--machine m.toml a.csv", "report --machine m.toml a.csv"),
        ("a.csv report --machine m.toml", "report a.csv --machine m.toml"),
        ("m.toml report a.csv", "report a.csv --machine m.toml"),
        ("m.toml plan a.csv", "plan m.toml a.csv"),
        ("film m.toml a.csv", "film m.toml --log a.csv"),
        ("film a.csv m.toml --at '90 degC'", "film m.toml --log a.csv --at '90 degC'"),
        ("plan a.csv m.toml --target '60 mm/s'", "plan m.toml a.csv --target '60 mm/s'"),
        ("report m.toml a.csv -v", "report a.csv --machine m.toml -v"),
        ("report m.toml --machine a.csv", "report a.csv --machine m.toml"),
        ("inspect m.toml a.csv", "inspect a.csv"),
        ("sweep s.toml m.toml", "sweep s.toml --machine m.toml"),
        ("compare a.csv b.csv c.csv", "fit a.csv b.csv c.csv --each fits.csv"),
        (
            "export simulink f.json m.toml",
            "export fmu f.json m.toml --out drive.fmu --temperature '180 degC'",
        ),
        ("export simulink", "export fmu --help"),
        ("life c.hersey m.toml", "life c.hersey --machine m.toml"),
        ("campaign a.csv --unit F1", "campaign add life.hersey a.csv --unit F1"),
        ("campaign l.hersey a.csv --unit F1", "campaign add l.hersey a.csv --unit F1"),
        ("campaign l.hersey", "campaign list l.hersey"),
        ("campaign lst l.hersey", "campaign list l.hersey"),
    ],
)
def test_words_in_the_wrong_place_are_put_right(typed: str, line: str, tmp_path: Path) -> None:
    done = run(*shlex.split(typed), cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.endswith(f": hersey {line}\n")


@pytest.mark.parametrize(
    ("typed", "line"),
    [
        ("map m.toml f.json", "map m.toml --fit f.json"),
        ("map f.json m.toml --json", "map m.toml --fit f.json --json"),
        (
            "plan m.toml a.csv f.json --tare standing --torque-sign -1 --target '60 mm/s'",
            "plan m.toml --fit f.json --target '60 mm/s'",
        ),
        ("warmup f.json", "warmup MACHINE --fit f.json"),
        ("simulate m.toml f.json --heat", "simulate --machine m.toml --fit f.json --heat"),
        ("report f.json --tare standing", "report LOG --tare standing"),
        ("report m.toml f.json", "report LOG --machine m.toml"),
        ("fit a.csv f.json", "fit a.csv"),
        ("compare f.json a.csv", "compare a.csv B"),
        ("film m.toml f.json", "film m.toml --log LOG"),
    ],
)
def test_a_saved_fit_in_the_place_of_a_log_is_given_its_option(typed: str, line: str, tmp_path: Path) -> None:
    (tmp_path / "f.json").write_text('{"hersey_version": "0.1.0", "fit": {"values": [1]}}')
    done = run(*shlex.split(typed), cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("hersey: f.json is a saved fit, not a log. ")
    assert done.stderr.endswith(f": hersey {line}\n")


def test_json_is_no_log(tmp_path: Path) -> None:
    """A result under another name, and any other JSON, which no line of numbers in it makes a table."""
    numbers = '"values": [\n' + "1, 2, 3,\n" * 20 + "1, 2, 3]}"
    (tmp_path / "f.txt").write_text('{\n "hersey_version": "0.1.0",\n "fit": {' + numbers + "}")
    for verb in ("report", "fit"):
        done = run(verb, "f.txt", cwd=tmp_path)
        assert (done.returncode, done.stderr) == (
            2,
            "hersey: f.txt is a result of hersey, not a log. Give the log itself; where a command takes a "
            "saved fit, use --fit\n",
        )
    (tmp_path / "f.json").write_text("{" + numbers)
    done = run("report", "f.json", cwd=tmp_path)
    assert done.stderr == "hersey: f.json is JSON, not a table. Export the channels as text (CSV)\n"


@pytest.mark.parametrize(
    ("typed", "advice"),
    [
        ("simulate --stiffness 11 N/mm --mass '11 kg'", "--stiffness '11 N/mm'"),
        ("plan m.toml a.csv --target 60 mm/s", "--target '60 mm/s'"),
        ("report a.csv --json result.json", "--json > result.json"),
        ("report a.csv --json=result.json", "--json > result.json"),
    ],
)
def test_words_that_belong_together_or_apart(typed: str, advice: str, tmp_path: Path) -> None:
    done = run(*shlex.split(typed), cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.endswith(f": {advice}\n") or done.stderr.endswith(f" type {advice}\n")


@pytest.mark.parametrize(
    ("typed", "name"),
    [
        ("report a.csv --tare", "--tare"),
        ("report a.csv --tare --machine m.toml", "--tare"),
        ("life l.hersey", "--machine TOML"),
        ("plan", "MACHINE"),
    ],
)
def test_what_is_missing_is_named_with_its_help(typed: str, name: str, tmp_path: Path) -> None:
    done = run(*shlex.split(typed), cwd=tmp_path)
    assert done.returncode == 2
    parameters = load(typed.split()[0]).params
    known = next(each for each in parameters if name.split()[0] in (*each.opts, each.metavar))
    assert f"{name} needs a value: " in done.stderr or f" needs {name}: " in done.stderr
    written = ". To write one, type: hersey new LOG" if typed == "plan" else ""
    assert done.stderr.rstrip().endswith(f"{known.help.rstrip('.')}{written}")


def drive(tmp_path: Path, *header: str, torque: float = 0.2) -> None:
    """A log of a steady drive, 20 s long."""
    rows = [f"{0.1 * i:.1f},{torque + 0.001 * (i % 3)},30" for i in range(200)]
    (tmp_path / "a log.csv").write_text("\n".join([",".join(header), *rows]))


@pytest.mark.parametrize(
    ("typed", "says"),
    [
        ("app --port 8080x", "--port must be a whole number, not 8080x"),
        ("life c.hersey --machine m.toml --seed 1.5", "--seed must be a whole number, not 1.5"),
        ("plan m.toml --confidence high", "--confidence must be a number, not high"),
        ("sweep s.toml --threads 0", "--threads must be at least 1, not 0"),
        ("testbench --units 2000", "--units must be at most 1000, not 2000"),
    ],
)
def test_a_number_that_an_option_does_not_take(typed: str, says: str, tmp_path: Path) -> None:
    done = run(*shlex.split(typed), cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"hersey: {says}\n")


def test_a_folder_is_needed_where_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("")
    done = run("app", "--no-browser", "--reports", "notes.txt", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("hersey: notes.txt is a file, but reports are saved in a folder")
    done = run("examples", "my files.zip", cwd=tmp_path)
    assert (done.returncode, (tmp_path / "my files.zip").exists()) == (2, False)
    line = done.stderr.partition("Type: ")[2]
    assert run(*shlex.split(line)[1:], cwd=tmp_path).returncode == 0
    assert (tmp_path / "my files" / "bench.csv").exists()


def test_cycles_finds_the_torque_of_a_log_and_names_the_command_for_steady_sliding(tmp_path: Path) -> None:
    drive(tmp_path, "Time [s]", "Drive torque [N*m]", "Drive speed [rpm]")
    done = run("cycles", "a log.csv", cwd=tmp_path)
    assert done.returncode == 0
    assert "type: hersey report 'a log.csv'" in done.stdout
    done = run("cycles", "a log.csv", "--json", cwd=tmp_path)
    assert '"unit": "N*m"' in done.stdout


def test_a_trace_in_the_place_of_a_log_is_sent_to_cycles(tmp_path: Path) -> None:
    drive(tmp_path, "time [s]", "force [N]", "remark")
    for verb in ("report", "inspect"):
        done = run(verb, "a log.csv", cwd=tmp_path)
        line = re.search(r"type: (hersey cycles .*)", done.stdout + done.stderr)
        assert line
        assert run(*shlex.split(line[1])[1:], cwd=tmp_path).returncode == 0


@pytest.mark.parametrize("verb", ["report", "inspect"])
def test_a_log_with_another_fault_is_not_sent_to_cycles(verb: str, tmp_path: Path) -> None:
    """The rows twice, or a column that is not there: no stick-slip trace explains that."""
    header = ("Time [s]", "Drive torque [N*m]", "Drive speed [rpm]", "Temperature [degC]")
    rows = [f"{0.1 * i:.1f},{0.2 + 0.001 * (i % 7)},30,{20 + i % 3}" for i in range(200)]
    (tmp_path / "a log.csv").write_text("\n".join([",".join(header), *rows, *rows]))
    done = run(verb, "a log.csv", cwd=tmp_path)
    said = done.stdout + done.stderr
    assert "the rows from line 202 to line 401 repeat those from line 2" in " ".join(said.split())
    assert "hersey cycles" not in said
    done = run(verb, "a log.csv", "--torque", "Load", cwd=tmp_path)
    assert "hersey cycles" not in done.stdout + done.stderr


def test_a_log_without_a_dwell_may_be_a_trace(tmp_path: Path) -> None:
    rows = [f"{0.1 * i:.1f},{i % 5},30,20" for i in range(200)]
    header = "Time [s],Drive torque [N*m],Drive speed [rpm],Temperature [degC]"
    (tmp_path / "slips.csv").write_text("\n".join([header, *rows]))
    said = run("inspect", "slips.csv", cwd=tmp_path).stdout
    assert "0 dwells" in said
    assert said.endswith("type: hersey cycles slips.csv\n")


def test_a_log_without_torque_and_force_is_not_sent_to_cycles(tmp_path: Path) -> None:
    drive(tmp_path, "time [s]", "x [V]", "speed [V]")
    assert "hersey cycles" not in run("report", "a log.csv", cwd=tmp_path).stderr


def test_a_missing_folder_comes_with_the_line_that_makes_it(tmp_path: Path) -> None:
    typed = ["testbench", "--out", "my results/log.csv"]
    refused = run(*typed, cwd=tmp_path)
    assert refused.returncode == 2
    line = refused.stderr.rpartition(": ")[2]
    assert shlex.split(line) == ["mkdir", "-p", "my results"]
    (tmp_path / "my results").mkdir()
    assert run(*typed, cwd=tmp_path).returncode == 0


def test_assumed_numbers_are_printed_with_units(tmp_path: Path) -> None:
    text = run("simulate", "--stiffness", "2000", cwd=tmp_path).words
    assert "mass 1 ozf*s^2/in" in text
    assert "stiffness" not in text
    whole = ["--mass", "1", "--transition-force", "50", "--transition-speed", "1", "--stick-speed", "0.01"]
    text = run("simulate", "--stiffness", "2000", *whole, "--drive-speed", "1", cwd=tmp_path).words
    assert "ozf" not in text


def staircase(sign: int) -> str:
    """A log of three speeds and two temperatures."""
    rows = []
    for i in range(6):
        for j in range(60):
            time = 6.0 * i + 0.1 * j
            speed = (10, 30, 90)[i % 3]
            torque = sign * (0.2 + 0.05 * (i % 3) + 1e-3 * (j % 2))
            rows.append(f"{time:.1f},{torque},{speed},{100 + 20 * (i // 3)}")
    return "\n".join(["time [s],torque [N*m],speed [rpm],temperature [degC]", *rows])


@pytest.mark.parametrize(
    "typed",
    ["compare {0} {1}", "report {0} --against {1}", "report {1} --against {0}", "fit {0} {1} --each t.csv"],
)
def test_one_of_several_logs_takes_its_sign_from_a_mapping(typed: str, tmp_path: Path) -> None:
    (tmp_path / "logs").mkdir()
    for name, sign in (("a", 1), ("b", -1)):
        (tmp_path / "logs" / f"{name}.csv").write_text(staircase(sign))
    line = shlex.split(typed.format("logs/a.csv", "logs/b.csv"))
    refused = run(*line, cwd=tmp_path)
    assert refused.returncode in (1, 2)
    file = re.search(r"write (sign = -1) under (\[torque\]) in (\S+[.]toml)", refused.stderr)
    assert file, refused.stderr
    given = run(*line, "--torque-sign", "-1", cwd=tmp_path)
    assert given.returncode in (1, 2)
    assert f"omit --torque-sign -1 and {file[0].rsplit(' in ', 1)[0]} in " in given.stderr
    (tmp_path / file[3]).write_text(f"{file[2]}\n{file[1]}\n")
    assert run(*line, cwd=tmp_path).returncode == 0


@pytest.mark.parametrize("typed", ["compare {0} {1}", "report {1} --against {0}", "fit {0} {1} --each t.csv"])
def test_one_of_several_logs_takes_its_unit_from_a_mapping(typed: str, tmp_path: Path) -> None:
    """Where the other log states its own unit, which an option would replace."""
    for name, unit in (("a", "N*m"), ("b", "kg-cm")):
        (tmp_path / f"{name}.csv").write_text(staircase(1).replace("N*m", unit))
    line = shlex.split(typed.format("a.csv", "b.csv"))
    refused = run(*line, cwd=tmp_path)
    assert refused.returncode in (1, 2)
    assert "--torque-unit" not in refused.stderr
    file = re.search(r'[Ww]rite (unit = "kgf\*cm") under (\[torque\]) in (b.hersey.toml), or', refused.stderr)
    assert file, refused.stderr
    (tmp_path / file[3]).write_text(f"{file[2]}\n{file[1]}\n")
    read = run(*line, cwd=tmp_path)
    assert read.returncode == 0
    assert "is read in" not in " ".join(read.stdout.split())


@pytest.mark.parametrize("typed", ["compare a.csv b.csv", "report a.csv", "report b.csv --against a.csv"])
def test_a_unit_of_a_file_that_an_option_replaces_is_said(typed: str, tmp_path: Path) -> None:
    for name, unit in (("a", "N*m"), ("b", "kg-cm")):
        (tmp_path / f"{name}.csv").write_text(staircase(1).replace("N*m", unit))
    done = run(*shlex.split(typed), "--torque-unit", "kgf*cm", cwd=tmp_path)
    said = " ".join(done.stdout.split())
    assert said.count("a.csv: 'torque' is in N*m, but it is read in kgf*cm") == 1
    assert "b.csv: 'torque' is in" not in said
    for unit, times in (("Nm", 0), ("mN*m", 1)):
        said = " ".join(run("fit", "a.csv", "--torque-unit", unit, cwd=tmp_path).stdout.split())
        assert said.count(f"is in N*m, but it is read in {unit}") == times


@pytest.mark.parametrize(
    ("typed", "flag"),
    [
        ("plan m.toml a.csv --target 60", "--target"),
        ("film m.toml --at 150", "--at"),
        ("fit a.csv --min-dwell 2", "--min-dwell"),
    ],
)
def test_a_number_without_a_unit_names_its_option(typed: str, flag: str, tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_bytes((ROOT / "examples" / "machine.toml").read_bytes())
    (tmp_path / "no-load.csv").write_bytes((ROOT / "examples" / "no-load.csv").read_bytes())
    done = run(*shlex.split(typed), cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(f"hersey: {flag}: '")


@pytest.mark.parametrize("typed", [r"logs\\a.csv", "logsa.csv"])
def test_a_path_of_windows_is_written_with_slashes(typed: str, tmp_path: Path) -> None:
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "a.csv").write_text(staircase(1))
    done = run("fit", typed.replace("\\\\", "\\"), cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.endswith(" 'logs/a.csv'\n")


def test_a_time_between_rows_goes_before_a_clock_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(staircase(1))
    done = run("inspect", "a.csv", "--every", "100 ms", cwd=tmp_path)
    assert done.returncode == 0
    assert "Column 'time' is not used: --every sets the time between rows" in done.words


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("2 to 40 N/mm", '{ from = "2 N/mm", to = "40 N/mm", count = 10 }'),
        ("2 N/mm, 4 N/mm", '["2 N/mm", "4 N/mm"]'),
    ],
)
def test_a_range_or_a_list_in_words_is_shown_as_it_is_written(
    written: str, meant: str, tmp_path: Path
) -> None:
    text = (ROOT / "examples" / "scenario.toml").read_text()
    for value, code in ((f'"{written}"', 2), (meant, 0)):
        lines = re.sub(r"(?m)^drive_speed = .*", 'drive_speed = "5 mm/s"', text)
        lines = re.sub(r"(?m)^stiffness = .*", lambda _, v=value: f"stiffness = {v}", lines)
        (tmp_path / "s.toml").write_text(lines)
        done = run("sweep", "s.toml", cwd=tmp_path)
        assert done.returncode == code
        assert code == 0 or done.stderr.endswith(f" Write {meant}\n")


def test_a_machine_file_is_no_scenario(tmp_path: Path) -> None:
    done = run("sweep", ROOT / "examples" / "machine.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert "--machine" in done.stderr


def test_a_machine_file_alone_comes_with_the_log_to_add(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text((ROOT / "examples" / "machine.toml").read_text())
    for typed, line in ((["machine.toml"], ["LOG"]), (["a.csv", "machine.toml"], ["a.csv"])):
        done = run("posterior", *typed, cwd=tmp_path)
        assert done.returncode == 2
        assert done.stderr.endswith(f"Type: hersey posterior {line[0]} --machine machine.toml\n")


@pytest.mark.parametrize("verb", ["fit", "inspect", "cycles"])
def test_a_table_of_runs_is_no_log(verb: str, tmp_path: Path) -> None:
    (tmp_path / "runs.csv").write_text("log,unit,age\na.csv,U1,0 pages\n")
    done = run(verb, "runs.csv", cwd=tmp_path)
    assert done.returncode == 2
    assert "runs.csv is a table of the runs of a life test, not a log" in " ".join(done.stderr.split())


@pytest.mark.parametrize("verb", ["fit", "cycles", "report"])
def test_a_scenario_is_no_log(verb: str, tmp_path: Path) -> None:
    done = run(verb, ROOT / "examples" / "scenario.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.endswith(
        f"is a scenario, not a log. To run it, type: hersey sweep {ROOT}/examples/scenario.toml\n"
    )


@pytest.mark.parametrize("verb", ["hysteresis", "simulate"])
def test_verbose_prints_the_conclusion_once(verb: str, tmp_path: Path) -> None:
    usual, whole = (run(verb, *more, cwd=tmp_path).stdout for more in ([], ["-v"]))
    first = usual.splitlines()[0]
    assert first not in whole
    assert whole.count("Assumed, as not given") == 1


@pytest.mark.parametrize("typed", ["film a.csv", "map a.csv", "plan a.csv --target '60 mm/s'", "film"])
def test_where_there_is_no_machine_file_the_line_that_writes_one_is_named(typed: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(staircase(1))
    refused = run(*shlex.split(typed), cwd=tmp_path)
    assert refused.returncode == 2
    assert "machine.toml" not in refused.stderr
    line = shlex.split(refused.stderr.rpartition("type: ")[2].replace("LOG", "a.csv"))
    assert line == ["hersey", "new", "a.csv"]
    answers = ["", "", "", "", "", "", "", "", "belt", "11 N/mm", "11 kg", "15 mm", "3 mm/s", ""]
    written = run(*line[1:], cwd=tmp_path, answers="\n".join([*answers, *[""] * 12, ""]))
    assert written.returncode == 0, written.stderr
    assert (tmp_path / "machine.toml").is_file()
    (tmp_path / "machine.toml").rename(
        tmp_path / "drive.toml"
    )  # beside the mapping, which is no machine file
    again = run(*shlex.split(typed), cwd=tmp_path)
    assert "hersey new" not in again.stderr
    assert "a.csv" not in typed or f"Type: hersey {typed.split()[0]} drive.toml " in again.stderr


def test_a_file_of_another_kind_is_not_proposed(tmp_path: Path) -> None:
    for name in ("joined.html", "hersey.toml", "a.csv", "machin.csv"):
        (tmp_path / name).write_text("1,2\n" if name.endswith("csv") else "")
    refused = run("report", "a.csv", "--machine", "machine.toml", cwd=tmp_path)
    assert refused.stderr.endswith("File not found: machine.toml. To write one, type: hersey new LOG\n")
    refused = run("report", "a.csv", "--machine", "my drives/m.toml", cwd=tmp_path)
    assert refused.stderr.endswith("type: hersey new LOG --machine 'my drives/m.toml'\n")
    (tmp_path / "machin.toml").write_text("[drivetrain]\n")
    refused = run("report", "a.csv", "--machine", "machine.toml", cwd=tmp_path)
    assert refused.stderr.endswith(" Did you mean 'machin.toml'?\n")
    for name in ("bench.html", "bench.tdms"):
        (tmp_path / name).write_text("")
    refused = run("report", "benh.csv", cwd=tmp_path)
    assert refused.stderr.endswith(" Did you mean 'bench.tdms'?\n")


@pytest.mark.parametrize(
    ("typed", "plain"),
    [
        ([f"{EN}machine", "examples/machine.toml"], ["--machine", "examples/machine.toml"]),
        ([f"{EM}tare", "standing"], ["--tare", "standing"]),
        ([f"{EN}{EN}tare=standing"], ["--tare=standing"]),
        ([f"{EN}q", f"-{EM}tare", "standing"], ["-q", "--tare", "standing"]),
    ],
)
def test_a_long_dash_is_named_and_the_line_has_plain_ones(typed: list[str], plain: list[str]) -> None:
    done = run("fit", "examples/bench.csv", *typed, cwd=ROOT)
    assert done.returncode == 2
    line = shlex.join(["hersey", "fit", "examples/bench.csv", *plain])
    assert done.stderr.endswith(f" has a long dash, as word processors write. Type: {line}\n")
    assert run(*shlex.split(line)[1:], cwd=ROOT).returncode == 0


def test_a_long_dash_is_kept_where_it_begins_a_file_or_a_value(tmp_path: Path) -> None:
    (tmp_path / f"{EM}log.csv").write_text("")
    assert "long dash" not in run("fit", f"{EM}log.csv", cwd=tmp_path).stderr
    assert "long dash" not in run("fit", "a.csv", "--torque", f"{EN}Tq", cwd=tmp_path).stderr
