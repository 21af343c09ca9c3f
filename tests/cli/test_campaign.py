"""``hersey campaign`` as it is typed: runs, tables of runs, and mistakes."""

from __future__ import annotations

import json
import shlex
import time
from pathlib import Path

import polars as pl
import pytest

import hersey
from hersey.cli import campaign_reading
from hersey.cli.options import Reading
from hersey.life.campaign import Entry
from hersey.machine import machine
from tests.cli.command import Done, run
from tests.conftest import ROOT
from tests.life.test_campaign import means

F12 = ("--unit", "F12", "--age", "1000 pages")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for number in range(4):
        means(tmp_path / f"{number}.csv", 5.0 + number)
    return tmp_path


def typed(folder: Path, *arguments: str) -> Done:
    done = run("campaign", *arguments, cwd=folder)
    assert "Traceback" not in done.stderr
    return done


def test_runs_are_added_listed_shown_checked_and_exported(folder: Path) -> None:
    done = typed(folder, "add", "life.hersey", "0.csv", "1.csv", "--quiet", *F12)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    (folder / "life.hersey").unlink()
    done = typed(folder, "add", "life.hersey", "0.csv", "1.csv", *F12)
    assert (done.returncode, done.stderr.count(".")) == (0, 3)  # two sentences and runs.csv
    assert done.stdout.startswith("0.csv: added as run 1, F12 at 1000 pages, 10 dwells\n1.csv: added as")
    assert "already there as run 1" in typed(folder, "add", "life.hersey", "0.csv", *F12).stdout
    assert typed(folder, "list", "life.hersey").stdout == (
        "life.hersey: 2 runs of 1 specimen\nF12: 2 runs, at 1000 pages, 20 dwells\n"
    )
    shown = typed(folder, "show", "life.hersey", "F12").stdout.splitlines()
    assert [line.split()[0] for line in shown] == ["run", "1", "2"]
    assert "exponent" in shown[0]
    listed = json.loads(typed(folder, "list", "life.hersey", "--json").stdout)
    assert [each["log"] for each in listed["runs"]] == [str(folder / "0.csv"), str(folder / "1.csv")]
    assert json.loads(typed(folder, "show", "life.hersey", "F12", "--json").stdout)["runs"] == listed["runs"]
    assert typed(folder, "check", "life.hersey").stdout == "2 runs: no problems found\n"
    (folder / "0.csv").unlink()
    done = typed(folder, "check", "life.hersey", "--json")
    assert done.returncode == 1
    assert [each["kind"] for each in json.loads(done.stdout)["warnings"]] == ["log missing"]
    assert typed(folder, "export", "life.hersey", "--out", "dwells.parquet").stdout == "dwells.parquet\n"
    assert pl.read_parquet(folder / "dwells.parquet").height == 20


def test_a_specimen_that_is_not_there_is_named_with_those_that_are(folder: Path) -> None:
    typed(folder, "add", "life.hersey", "0.csv", *F12)
    (folder / "machine.toml").write_text((ROOT / "tests" / "stand" / "machine.toml").read_text())
    said = "life.hersey has no specimen 'U9'. Specimens: F12\n"
    done = run("life", "life.hersey", "--machine", "machine.toml", "--unit", "U9", cwd=folder)
    assert (done.returncode, done.stderr) == (2, f"hersey: --unit: {said}")
    assert typed(folder, "show", "life.hersey", "U9").stderr == f"hersey: {said}"


@pytest.mark.parametrize(
    ("typed_", "said"),
    [
        (["--share", "5 %"], "--share needs the age: add --until '200000 pages'"),
        (["--share", "5", "--until", "900 pages"], "--share is '5': write a percentage, e.g. '2 %'"),
        (
            ["--share", "0 %", "--until", "900 pages"],
            "--share is 0 %: it must be at least 1 % and below 100 %",
        ),
        (["--cost-of-failure", "1"], "--cost-of-failure is 1: it must be above 1 and at most 100. It is"),
    ],
)
def test_a_decision_that_cannot_be_asked_for_is_refused(folder: Path, typed_: list[str], said: str) -> None:
    typed(folder, "add", "life.hersey", "0.csv", *F12)
    (folder / "machine.toml").write_text((ROOT / "tests" / "stand" / "machine.toml").read_text())
    done = run("life", "life.hersey", "--machine", "machine.toml", *typed_, cwd=folder)
    assert done.returncode == 2
    assert said in " ".join(done.stderr.split())


def test_hundreds_are_read_in_processes_of_their_own(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Here three in one process."""
    monkeypatch.setattr(campaign_reading, "FEW", 0)
    monkeypatch.setattr(campaign_reading, "_PROCESSES", 1)
    (folder / "broken.csv").write_text("no log at all\n")
    logs = [(folder / name, '{"a": 1}') for name in ("0.csv", "broken.csv", "1.csv")]
    first, broken, last = campaign_reading.entries(Reading(), logs, None)
    assert first == campaign_reading.entry(Reading(), *logs[0][:1], None, logs[0][1])
    assert "broken.csv" in str(broken)
    assert isinstance(last, Entry)
    assert last.path == str(folder / "1.csv")


def test_what_reads_many_begins_before_it_is_known_what_to_read(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign_reading, "FEW", 2)
    monkeypatch.setattr(campaign_reading, "_PROCESSES", 1)
    logs = [(folder / f"{number}.csv", "{}") for number in range(2)]
    alone = [campaign_reading.entry(Reading(), log, None, settings) for log, settings in logs]
    with campaign_reading.readers(None) as (child,):
        child.ask({"machine": None})  # which waits for what it loads
        assert child.running
        assert list(campaign_reading.entries(Reading(), logs, None, children=[child])) == alone
    with campaign_reading.readers(None) as (child,):
        assert list(campaign_reading.entries(Reading(), logs[:1], None, children=[child])) == alone[:1]
    assert not child.running


def test_what_reads_ends_with_the_command_though_it_has_just_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign_reading, "_PROCESSES", 3)
    with pytest.raises(RuntimeError, match="meanwhile"), campaign_reading.readers(None) as children:
        raise RuntimeError("meanwhile")
    time.sleep(0.2)  # a thread that is left would start its process by now
    assert not any(child.running for child in children)


def test_the_machine_file_is_read_once_for_all_runs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "machine.toml").write_text((ROOT / "tests" / "stand" / "machine.toml").read_text())
    read, read_machine = [], machine.read_machine

    def counted(path: Path) -> machine.Machine:
        read.append(path.name)
        return read_machine(path)

    monkeypatch.setattr(machine, "read_machine", counted)
    for number in range(3):
        log = folder / f"{number}.csv"
        settings = campaign_reading.settings_of(Reading(), log, folder / "machine.toml")
        campaign_reading.entry(Reading(), log, folder / "machine.toml", settings)
    assert read == ["machine.toml"]


def test_a_table_of_runs_leaves_out_what_fails_and_tells_it(folder: Path) -> None:
    (folder / "broken.csv").write_text("no log at all\n")
    rows = ["0.csv;F12;0", "1.csv;F12;1000", "broken.csv;F13;0", "none.csv;F13;5", "2.csv;F13;2e3"]
    (folder / "runs.csv").write_text("log;unit;age [pages]\n" + "\n".join(rows) + "\n")
    done = typed(folder, "add", "life.hersey", "--table", "runs.csv", "--isothermal")
    assert done.returncode == 1
    assert done.stdout == "life.hersey: 3 added, 2 failed\n"
    assert "broken.csv: " in done.stderr
    assert "none.csv: File not found" in done.stderr
    again = typed(folder, "add", "life.hersey", "--table", "runs.csv", "--isothermal")
    assert again.stdout == "life.hersey: 3 already there, 2 failed\n"
    with hersey.Campaign.open(folder / "life.hersey") as campaign:
        assert campaign.runs()["age"].to_list() == [0.0, 1000.0, 2000.0]
        assert campaign.settings(1)["recipe"] == {"isothermal": True}


def test_what_is_read_beside_the_log_is_kept(folder: Path) -> None:
    (folder / "hersey.toml").write_text('[torque]\nunit = "mN*m"\n')
    assert typed(folder, "add", "life.hersey", "0.csv", *F12).returncode == 0
    with hersey.Campaign.open(folder / "life.hersey") as campaign:
        assert len(campaign.settings(1)["files"]["mapping"]["sha256"]) == 64
    (folder / "hersey.toml").write_text('# other\n[torque]\nunit = "mN*m"\n')
    done = typed(folder, "add", "life.hersey", "0.csv", *F12)
    assert (done.returncode, "read with other settings. Use --force" in done.stderr) == (2, True)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("", "no column 'log'"),
        ("log,unit\n0.csv,F1\n", "no column 'age'"),
        ("log,unit,age,age\n", "more than one column 'age'"),
        ("log,unit,age\n0.csv,F1,5\n", "line 2, column 'age': age '5' has no unit"),
        ("log,unit,age [h]\n0.csv,F1,5\n1.csv,,6\n", "line 3: column 'unit' is empty"),
        ("log,unit,age [h]\n0.csv,F1,-5\n", "it must be 0 (new) or greater"),
        ("log,unit,age [h]\n", "lists no runs"),
    ],
)
def test_a_table_with_a_mistake_is_refused_whole(folder: Path, table: str, said: str) -> None:
    (folder / "runs.csv").write_text(table)
    done = typed(folder, "add", "life.hersey", "--table", "runs.csv")
    assert done.returncode == 2
    assert said in done.stderr
    assert not (folder / "life.hersey").exists()


def test_a_table_may_be_in_the_encodings_of_a_log(folder: Path) -> None:
    (folder / "runs.csv").write_bytes("log;unit;age;Prüfstand\n0.csv;F1;0 h;für 2\n".encode("cp1252"))
    assert typed(folder, "add", "life.hersey", "--table", "runs.csv").returncode == 0
    (folder / "runs.csv").write_bytes("Datei;unit;age;Prüfstand\n".encode("cp1252"))
    done = typed(folder, "add", "other.hersey", "--table", "runs.csv")
    assert done.returncode == 2
    for said in ("'Datei', 'unit', 'age', 'Prüfstand'", "'log;unit;age [pages]'"):
        assert said in done.stderr
    (folder / "runs.csv").write_bytes(b"PK\3\4\0\0\0\1\0\0\7")
    done = typed(folder, "add", "other.hersey", "--table", "runs.csv")
    assert (done.returncode, "Save the table as CSV" in done.stderr) == (2, True)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["add", "life.hersey", "0.csv"], "add --unit F12"),
        (["add", "life.hersey", "0.csv", "--unit", "F12"], "add --age '120000 pages'"),
        (["add", "life.hersey", *F12], "name the logs with --unit and --age, or a table of runs"),
        (
            ["add", "life.hersey", "--table", "0.csv", *F12],
            "the table holds unit and age: omit --unit",
        ),
        (["add", "0.csv", "1.csv", *F12], "0.csv is not a campaign: "),
        (["add", "life.hersey", "none.csv", *F12], "File not found: none.csv"),
        (["add", "life.hersey", "0.csv", "none.csv", *F12], "File not found: none.csv"),
        (["add", "life.hersey", "0.csv", "?.csv", *F12], "0.csv is given twice"),
        (["add", "life.hersey", "x*.csv", *F12], "no file matches x*.csv"),
        (["list", "life.hersey"], "life.hersey does not exist. Create it with"),
        (["export", "life.hersey", "--out", "x.xlsx"], "ends in .csv or .parquet"),
    ],
)
def test_a_mistake_is_one_line_and_leaves_nothing(folder: Path, arguments: list[str], said: str) -> None:
    done = typed(folder, *arguments)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert said in done.stderr
    assert not list(folder.glob("life*"))


def test_logs_by_a_pattern_go_with_the_rows_of_a_table(folder: Path) -> None:
    (folder / "tables").mkdir()
    rows = ["0.csv,F12,0", "1.csv,F12,1000", "../2.csv,F13,5", "9.csv,F13,7"]
    (folder / "tables" / "runs.csv").write_text("log,unit,age [pages]\n" + "\n".join(rows) + "\n")
    done = typed(folder, "add", "life.hersey", "?.csv", "--table", "tables/runs.csv")
    assert (done.returncode, done.stdout) == (1, "life.hersey: 3 added, 1 failed\n")
    assert done.stderr == (
        "3 of the 4 runs in runs.csv are among the given logs.\n"
        "- 3.csv: runs.csv has no row for it. Add one, or do not give this log\n"
    )
    with hersey.Campaign.open(folder / "life.hersey") as campaign:
        listed = campaign.runs().sort("run")
        assert listed.select("unit", "age").rows() == [("F12", 0.0), ("F12", 1000.0), ("F13", 5.0)]
        assert listed["log"].to_list() == [str(folder / f"{number}.csv") for number in range(3)]


def test_a_table_of_runs_among_the_logs_is_named_before_any_is_read(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "runs.csv").write_text("Unit;Age [h];log\nF12;0;0.csv\nF12;5;1.csv\n")
    with monkeypatch.context() as patched:
        patched.setattr(campaign_reading, "entries", lambda *_: pytest.fail("a log is read"))
        done = typed(folder, "add", "life.hersey", "*.csv", *F12, "--min-dwell=2 s", "--torque-sign", "1")
    assert done.returncode == 2
    said, line = done.stderr.split(". To add the logs that it lists, type: ")
    assert said == "hersey: runs.csv is a table of runs, not a log"
    assert "1000" not in line
    assert "--torque-sign 1" in line
    done = run(*shlex.split(line)[1:], cwd=folder)
    assert (done.returncode, done.stdout) == (0, "life.hersey: 2 added\n")


def test_the_table_itself_may_be_among_the_logs_and_no_other(folder: Path) -> None:
    for name in ("runs.csv", "others.csv"):
        rows = "".join(f"{number}.csv,F12,{number}\n" for number in range(4))
        (folder / name).write_text(f"log,unit,age [h]\n{rows}")
    done = typed(folder, "add", "life.hersey", "*.csv", "--table", "runs.csv")
    assert (done.returncode, "others.csv is a table of runs, not a log. Omit it" in done.stderr) == (2, True)
    (folder / "others.csv").unlink()
    done = typed(folder, "add", "life.hersey", "*.csv", "--table", "runs.csv")
    assert (done.returncode, done.stdout) == (0, "life.hersey: 4 added\n")


def test_several_logs_of_one_specimen_at_one_age_are_said_to_be_that(folder: Path) -> None:
    done = typed(folder, "add", "life.hersey", "0.csv", "1.csv", "--unit", "F12")
    assert "add --age '120000 pages'. All 2 logs get this specimen and age. " in done.stderr
    assert "--table runs.csv instead of --unit and --age" in done.stderr
    said = "The specimen of all 2 logs is F12, their age 1000 pages. If they differ, "
    for more in ([], ["--keep-going"]):
        done = typed(folder, "add", "life.hersey", "0.csv", "1.csv", *F12, *more)
        assert (done.returncode, " ".join(done.stderr.split()).startswith(said)) == (0, True), done.stderr
    assert typed(folder, "add", "life.hersey", "0.csv", *F12).stderr == ""
    assert "--table runs.csv --force" in " ".join(
        typed(folder, "add", "life.hersey", "0.csv", "1.csv", *F12).stderr.split()
    )
    (folder / "runs.csv").write_text("log,unit,age [pages]\n0.csv,F1,0\n1.csv,F2,500\n")
    assert typed(folder, "add", "life.hersey", "--table", "runs.csv", "--force").returncode == 0
    with hersey.Campaign.open(folder / "life.hersey") as campaign:
        assert campaign.runs().select("unit", "age").rows() == [("F1", 0.0), ("F2", 500.0)]


def test_of_logs_and_rows_of_one_name_paths_decide(folder: Path) -> None:
    (folder / "a").mkdir()
    means(folder / "a" / "0.csv", 9.0)
    (folder / "runs.csv").write_text("log,unit,age [h]\n0.csv,F12,0\n")
    done = typed(folder, "add", "life.hersey", "**/0.csv", "--table", "runs.csv")
    assert (done.returncode, done.stdout) == (1, "life.hersey: 1 added, 1 failed\n")
    assert (
        done.stderr
        == "- a/0.csv: runs.csv has several runs with this file name. Write the paths of the logs there\n"
    )
    (folder / "runs.csv").write_text("log,unit,age [h]\n0.csv,F12,0\na/0.csv,F13,0\n")
    done = typed(folder, "add", "life.hersey", "**/0.csv", "--table", "runs.csv")
    assert (done.returncode, done.stdout) == (0, "life.hersey: 1 added, 1 already there\n")


def test_of_logs_that_are_named_failing_ones_are_left_out_only_when_asked(folder: Path) -> None:
    (folder / "1b.csv").write_text("no log at all\n")
    done = typed(folder, "add", "life.hersey", "*.csv", *F12)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert "1b.csv" in done.stderr
    assert not (folder / "life.hersey").exists()
    done = typed(folder, "add", "life.hersey", "*.csv", *F12, "--keep-going")
    assert (done.returncode, done.stdout) == (1, "life.hersey: 4 added, 1 failed\n")
    assert done.stderr.startswith("- 1b.csv: ")


def test_a_missing_file_among_named_logs_costs_only_itself_when_asked(folder: Path) -> None:
    done = typed(folder, "add", "life.hersey", "0.csv", "none.csv", "2.csv", *F12)
    assert (done.returncode, done.stdout) == (2, "")
    assert "none.csv" in done.stderr
    assert not (folder / "life.hersey").exists()
    done = typed(folder, "add", "life.hersey", "0.csv", "none.csv", "2.csv", *F12, "--keep-going")
    assert (done.returncode, done.stdout) == (1, "life.hersey: 2 added, 1 failed\n")
    assert done.stderr.startswith("- none.csv: File not found. ")
    assert done.stderr.count("none.csv") == 1
    with hersey.Campaign.open(folder / "life.hersey") as campaign:
        assert [Path(log).name for log in campaign.runs()["log"]] == ["0.csv", "2.csv"]
