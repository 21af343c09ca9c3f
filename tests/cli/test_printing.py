"""What a command prints: its conclusion on a screen, all of it with --verbose, files with --quiet."""

from __future__ import annotations

import importlib
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

import click
import pytest

from hersey.cli import printing as printing_module
from hersey.cli.application import PANELS, VERBS, load
from hersey.cli.figures import columns, three, within
from hersey.cli.options import READ, REDUCED
from hersey.cli.progress import bar, working
from hersey.cli.terminal import WIDTH, hush, wrapped
from hersey.log.formats.recognition import READERS
from hersey.schema.warning import Warning
from tests.cli.command import HERSEY, run
from tests.conftest import ROOT

BENCH, MACHINE = ROOT / "examples" / "bench.csv", ROOT / "examples" / "machine.toml"
REPORT = ["report", BENCH, "--machine", MACHINE, "--tare", "standing"]
#: Lines of a screen.
SCREEN = 24
#: Commands that take a moment, and print prose, tables and warnings.
QUICK = [
    "fit BENCH --tare standing",
    "inspect BENCH",
    "film MACHINE",
    "hysteresis --drive-speed 1.2 --from-speed 2.5 --to-speed 1.2",
    "simulate --check",
    "simulate --machine MACHINE --transition-force 14N --transition-speed 25mm/s --drive-speed 30mm/s",
    "cycles TRACE --drive-speed '20 mm/s'",
    "explain",
    "explain closure",
]


def words(command: str) -> list[str]:
    import shlex

    trace = str(ROOT / "examples" / "stick-slip.csv")
    named = {"BENCH": str(BENCH), "MACHINE": str(MACHINE), "TRACE": trace}
    return [named.get(word, word) for word in shlex.split(command)]


def assert_narrow(text: str) -> None:
    for line in text.splitlines():
        assert len(line) <= WIDTH, line


@pytest.fixture(scope="module")
def reported(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What the report prints by default, with --verbose and with --quiet."""
    folder = tmp_path_factory.mktemp("report")
    shown = {}
    for flag in ("", "--verbose", "-q"):
        done = run(*REPORT, "--force", *([flag] if flag else []), cwd=folder)
        assert (done.returncode, done.stderr) == (0, "")
        shown[flag] = done.stdout
    return shown


def test_a_report_prints_its_decision_on_one_screen(reported: dict[str, str]) -> None:
    lines = reported[""].splitlines()
    assert len(lines) <= SCREEN
    assert_narrow(reported[""])
    assert lines[0] == "200 mm/s runs smoothly. 45 mm/s needs the start-up profile."
    assert "V*" in lines[1]
    assert lines[-1] == "report.html"
    assert "[[Fit Statistics]]" not in reported[""]
    assert re.search(r"^- ", reported[""], re.MULTILINE), "the warning of the log"


def test_verbose_adds_statistics_and_notes(reported: dict[str, str]) -> None:
    verbose = reported["--verbose"]
    assert verbose.splitlines()[0] == reported[""].splitlines()[0]
    assert "[[Fit Statistics]]" in verbose
    assert len(re.findall(r"^- ", verbose, re.MULTILINE)) > len(
        re.findall(r"^- ", reported[""], re.MULTILINE)
    )
    assert verbose.endswith("\nreport.html\n")
    assert verbose.count("Temperature and time changed together") == 1
    assert_narrow(verbose)


def test_quiet_prints_the_file_alone(reported: dict[str, str]) -> None:
    assert reported["-q"] == "report.html\n"


@pytest.mark.parametrize("command", QUICK)
def test_no_line_is_wider_than_the_terminal(command: str, tmp_path: Path) -> None:
    done = run(*words(command), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout
    assert_narrow(done.stdout + done.stderr)


@pytest.mark.parametrize("command", [each for each in QUICK if not each.startswith("explain")])
def test_verbose_says_more_and_quiet_nothing(command: str, tmp_path: Path) -> None:
    usual, verbose, quiet = (run(*words(command), *flags, cwd=tmp_path) for flags in ([], ["-v"], ["-q"]))
    assert len(verbose.stdout) > len(usual.stdout)
    assert_narrow(verbose.stdout)
    assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", "")


def test_quiet_leaves_errors_and_json(tmp_path: Path) -> None:
    done = run("fit", "missing.csv", "-q", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("hersey: ")
    usual, quiet = (run("simulate", "--json", *flags, cwd=tmp_path).stdout for flags in ([], ["-q"]))
    assert quiet.replace(" --json -q", " --json") == usual
    both = run("fit", BENCH, "-q", "-v", cwd=tmp_path)
    assert (both.returncode, "--quiet and --verbose exclude each other" in both.stderr) == (2, True)


def test_one_group_has_the_options_of_printing() -> None:
    """Every command that prints JSON takes all of them, and no command has its own."""
    for name in VERBS:
        loaded = load(name)
        for command in getattr(loaded, "commands", {name: loaded}).values():
            taken = {option for each in command.params for option in each.opts}
            if "--json" in taken:
                assert {"--verbose", "-v", "--quiet", "-q"} <= taken, f"{name} {command.name}"
            for each in command.params:
                if {"--json", "--verbose", "--quiet"} & set(each.opts):
                    assert getattr(each, "rich_help_panel", "") == printing_module.PANEL


def test_grave_warnings_come_first_and_notes_need_verbose() -> None:
    found = [Warning(kind, kind, severity=kind) for kind in ("note", "watch", "act", "good")]  # type: ignore[arg-type]
    usual, all_of_them = printing_module.Printing(), printing_module.Printing(verbose=True)
    assert [each.kind for each in usual.chosen(found)] == ["act", "watch"]
    assert [each.kind for each in all_of_them.chosen(found)] == ["act", "watch", "note", "good"]


def test_lines_break_between_words_and_continue_where_their_text_begins() -> None:
    assert wrapped("short", 10) == ["short"]
    assert wrapped("- one two three", 11) == ["- one two", "  three"]
    assert wrapped("  1. one two three", 12) == ["  1. one two", "     three"]
    assert wrapped("  c     one two", 11) == ["  c     one", "        two"]
    assert wrapped("above a speed of 75 mm/s it slides", 19) == ["above a speed of", "75 mm/s it slides"]
    assert wrapped("x" * 30, 10) == ["x" * 30], "a name that is to be copied stays whole"


def test_a_terminal_has_its_own_width(tmp_path: Path) -> None:
    """On a terminal of 60 columns prose ends before the 60th."""
    script = shutil.which("script")
    if script is None:
        pytest.skip("needs the program script, which opens a terminal")
    line = f"stty cols 60; {' '.join(HERSEY)} explain closure"
    environment = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    done = subprocess.run(
        [script, "-qec", line, "/dev/null"],
        cwd=tmp_path, capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL, env=environment,
    )  # fmt: skip
    lines = done.stdout.replace("\r", "").splitlines()
    assert 40 < max(map(len, lines)) <= 60


def test_three_figures_and_a_unit() -> None:
    assert [three(x) for x in (-0.5962, 59.5878, 7802.0, 0.1043, 0.0, 45.0)] == [
        "-0.596", "59.6", "7800", "0.104", "0", "45",
    ]  # fmt: skip
    assert (three(1.2345e-7), three(float("inf"), "mm/s")) == ("1.23e-07", "infinite")
    assert within((0.1042, 0.0964, 0.1176), "mm/s", factor=1e3) == "104 [96, 118] mm/s"
    assert within((-0.5962, -0.6202, -0.5722)) == "-0.596 [-0.620, -0.572]"
    assert "no interval" in within((1.0, float("-inf"), float("inf")))
    assert columns(("a", "b"), [("long", "1"), ("x", "10")]) == ["  a      b", "  long   1", "  x     10"]


def test_every_limit_of_a_plan_has_a_unit(tmp_path: Path) -> None:
    fit = run("fit", BENCH, "--tare", "standing", "--machine", MACHINE, "--json", cwd=tmp_path)
    (tmp_path / "fit.json").write_text(fit.stdout)
    done = run("plan", MACHINE, "--fit", "fit.json", "--target", "45 mm/s", "--at", "180 degC", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for name, unit in {"speed": "mm/s", "acceleration": "mm/s²", "motor torque": "N·m", "grip": "N"}.items():
        assert re.search(
            rf"^  {name} +[\d.]+ of [\d.]+ {re.escape(unit)} \(\d+ %\)$", done.stdout, re.MULTILINE
        )
    assert_narrow(done.stdout)


# ---- the help


def test_the_help_lists_the_commands_in_groups() -> None:
    text = run("--help", cwd=ROOT).stdout
    titles = re.findall(r"^╭─ (.+?) ─", text, re.MULTILINE)
    assert titles == ["Options", *PANELS]
    for title, group in PANELS.items():
        panel = text.split(f"╭─ {title} ─")[1].split("╰")[0]
        assert [name for name in re.findall(r"^│ (\S+)", panel, re.MULTILINE) if name in VERBS] == [*group]


@pytest.mark.parametrize("verb", ["fit", "report", "film", "plan"])
def test_the_options_of_a_log_have_panels_of_their_own(verb: str) -> None:
    text = run(verb, "--help", cwd=ROOT).stdout
    own, read, reduced = (text.split(f"╭─ {each} ─")[1].split("╰")[0] for each in ("Options", READ, REDUCED))
    for flag in ("--torque-unit", "--mapping", "--run", "--means", "--max-memory", "--recipe"):
        assert f" {flag} " in read
        assert f" {flag} " not in own
    assert all(f" {flag} " in reduced for flag in ("--tare", "--no-load", "--min-dwell"))


def test_help_shows_defaults_that_are_words() -> None:
    """In brackets, which are markup unless they are escaped."""
    text = " ".join(run("report", "--help", cwd=ROOT).stdout.replace("│", " ").split())
    assert "[default: report.html]" in text
    assert "[default: hersey.toml beside the log]" in text


@pytest.mark.parametrize("verb", VERBS)
def test_help_texts_are_short(verb: str) -> None:
    """A line of a wide terminal at most, and no 'as' where an example follows."""
    loaded = load(verb)
    commands: dict[str, click.Command] = getattr(loaded, "commands", {verb: loaded})
    for command in commands.values():
        for each in command.params:
            text = (getattr(each, "help", None) or "").split("  ")[0]
            assert len(text) <= 100, f"{command.name}: {text}"
            assert not re.search(r"\bas '", text), f"{command.name}: {text}"


# ---- what to type instead


@pytest.mark.parametrize(
    ("typed", "says"),
    [
        (["bench.csv"], "'bench.csv' is a file, not a command. For a report type: hersey report bench.csv"),
        (["my log.csv", "--tare", "standing"],
         "'my log.csv' is not a command. For a report type: hersey report 'my log.csv' --tare standing"),
        (["other.mf4"], "'other.mf4' is not a command. For a report type: hersey report other.mf4"),
        (["machine.toml"],
         "'machine.toml' is a file, not a command. For a report type: "
         "hersey report LOG --machine machine.toml"),
        (["reprot", "a.csv"], "There is no command 'reprot'. Did you mean: hersey report a.csv"),
        (["qqq"], "There is no command 'qqq'. For a list of all commands type: hersey --help"),
    ],
)  # fmt: skip
def test_a_log_or_a_misspelled_command_gets_a_line_to_type(
    typed: list[str], says: str, tmp_path: Path
) -> None:
    for name in ("bench.csv", "machine.toml"):
        (tmp_path / name).touch()
    done = run(*typed, cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"hersey: {says}\n")


def test_the_file_of_every_format_is_taken_for_a_log(tmp_path: Path) -> None:
    unknown = {".xlsb", ".hdf"}  # rare, and known only if the file is there
    for suffix in READERS.keys() - unknown:
        assert f"hersey report a{suffix}" in run(f"a{suffix}", cwd=tmp_path).stderr


# ---- progress, exit codes, completion


def test_progress_off_a_terminal_is_plain_lines(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("hersey.cli.progress.PATIENCE", 0.01)
    hush(False)
    with working("fitting"):
        time.sleep(0.3)
    with bar("reading") as progress:
        for done in range(4):
            time.sleep(0.02)
            progress(done, 4)
    assert capsys.readouterr().err == (
        "hersey: fitting ...\nhersey: reading: 0 %\nhersey: reading: 25 %\nhersey: reading: 50 %\n"
        "hersey: reading: 75 %\n"
    )
    hush(True)
    with working("fitting"), bar("reading") as progress:
        time.sleep(0.1)
        progress(1, 4)
    hush(False)
    assert capsys.readouterr().err == ""


def test_no_control_code_off_a_terminal(tmp_path: Path) -> None:
    done = run("fit", BENCH, "--tare", "standing", cwd=tmp_path, patience=0.0)
    assert "hersey: " in done.stderr
    assert all(sign.isprintable() or sign == "\n" for sign in done.stdout + done.stderr)


def test_exit_codes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """0 done, 1 the answer is no, 2 wrong use or input, 3 a fault; 130 has tests of its own."""
    assert run("explain", "dwell", cwd=tmp_path).returncode == 0
    slow = MACHINE.read_text().replace('speed = "400 mm/s"', 'speed = "20 mm/s"')
    (tmp_path / "machine.toml").write_text(slow)
    shutil.copy(ROOT / "examples" / "no-load.csv", tmp_path)
    fit = run("fit", BENCH, "--tare", "standing", "--machine", MACHINE, "--json", cwd=tmp_path)
    (tmp_path / "fit.json").write_text(fit.stdout)
    typed = ["plan", "machine.toml", "--fit", "fit.json", "--target", "45 mm/s", "--at", "180 degC"]
    refused = run(*typed, "--out", "profile.csv", cwd=tmp_path)
    assert (refused.returncode, (tmp_path / "profile.csv").exists()) == (1, False)
    for wrong in (
        ["fit"],
        ["fit", "no.csv"],
        ["fit", "--nonsense"],
        ["nonsense"],
        ["simulate", "--mass", "x"],
    ):
        assert run(*wrong, cwd=tmp_path).returncode == 2, wrong

    def fault(_name: str) -> None:
        raise ZeroDivisionError("planted")

    monkeypatch.setattr(importlib.import_module("hersey.report.glossary"), "find", fault)
    done = run("explain", "dwell", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (3, "")
    assert "ZeroDivisionError: planted" in done.stderr
    assert done.stderr.endswith("hersey: this is a fault of hersey. Please report it with the lines above.\n")


def test_help_and_docs_name_every_exit_code() -> None:
    text = " ".join(run("--help", cwd=ROOT).stdout.split())
    docs = (
        (ROOT / "docs" / "reference" / "commands.md").read_text().split("## Exit codes")[1].split("\n## ")[0]
    )
    for code in (0, 1, 2, 3, 130):
        assert re.search(rf"[:;] {code} \w", text), code
        assert f"| {code} |" in docs


def test_a_shell_completes_commands_and_options(tmp_path: Path) -> None:
    def completed(*words: str) -> str:
        environment = {
            **os.environ,
            "_HERSEY_COMPLETE": "complete_bash",
            "COMP_WORDS": " ".join(words),
            "COMP_CWORD": str(len(words) - 1),
        }
        code = "import sys; sys.argv = ['hersey']; from hersey.cli import main; main()"
        typed = [HERSEY[0], "-c", code]
        done = subprocess.run(
            typed, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        return done.stdout

    assert completed("hersey", "hyst").split() == ["hysteresis"]
    assert "--no-load" in completed("hersey", "fit", "--no").split()
    assert "--install-completion" in run("--help", cwd=ROOT).stdout
