"""Nothing in a log steers the terminal: what is no visible character comes as its code, on both streams."""

from __future__ import annotations

import ast
import io
import json
import os
import subprocess
import warnings
from pathlib import Path

import pytest

from hersey.cli.application import VERBS
from hersey.cli.terminal import say, spelled, warnings_said
from hersey.errors import printable
from tests.cli.command import HERSEY, run
from tests.cli.test_bad_input import staircase
from tests.conftest import ROOT

CLI = ROOT / "python" / "hersey" / "cli"
#: Controls of both sets but the line end, marks of direction, signs without width, ends of paragraphs.
HOSTILE = (
    "".join(map(chr, [*range(1, 10), *range(11, 32), *range(0x7F, 0xA0)]))
    + "\u200b\u200c\u200d\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2060"
    + "\u2066\u2067\u2068\u2069\u2028\u2029\ufeff"
    + "[bold]x[/bold][link=file:///]y[/link]"
)
#: In a cell no line may end, and in a name of a file no folder.
IN_CELL = HOSTILE.replace("\r", "").replace("\x0b", "").replace("[", "<").replace("]", ">")
IN_FILE = HOSTILE.replace("/", "")


def assert_plain(*texts: str) -> None:
    for text in texts:
        assert all(char.isprintable() or char == "\n" for char in text), ascii(text)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hostile")
    header = f"Time {IN_CELL} [s],Torque {IN_CELL} [N*m],Speed {IN_CELL} [rpm],Temperature [degC]"
    other = f"a{IN_CELL} [{IN_CELL}],b{IN_CELL},{IN_CELL}"
    rows = [f"{row},1,{'high' if i == 7 else 2},{IN_CELL}" for i, row in enumerate(staircase())]
    log = "\n".join([f"# {IN_CELL}", f"{header},{other}", *rows]) + "\n"
    (folder / f"{IN_FILE}.csv").write_text(log, encoding="utf-8", newline="")
    (folder / f"{IN_FILE}2.csv").write_text(log.replace(",20,", ",20.5,"), encoding="utf-8", newline="")
    trace = (ROOT / "examples" / "stick-slip.csv").read_text().replace("force", f"force {IN_CELL}")
    (folder / f"{IN_FILE}-trace.csv").write_text(trace, encoding="utf-8", newline="")
    coasts = (ROOT / "examples" / "coast-down.csv").read_text()
    coasts = coasts.replace("time [s],speed [", f"Time {IN_CELL} [s],Speed {IN_CELL} [")
    (folder / f"{IN_FILE}-coast.csv").write_text(coasts, encoding="utf-8", newline="")
    failures = f"age [h],status,mode,{IN_CELL}\n" + "".join(
        f"{age},failed,{IN_CELL}{age % 2},1\n" for age in range(10, 20)
    )
    (folder / f"{IN_FILE}-failures.csv").write_text(failures, encoding="utf-8", newline="")
    for name, home in (("machine", ROOT / "tests" / "stand"), ("scenario", ROOT / "examples")):
        text = (home / f"{name}.toml").read_text()
        (folder / f"{IN_FILE}-{name}.toml").write_text(text, encoding="utf-8")
    (folder / f"{IN_FILE}-broken.toml").write_text(f"[drivetrain]\n{json.dumps(HOSTILE)} = 1\n")
    return folder


LOG, OTHER, TRACE = f"{IN_FILE}.csv", f"{IN_FILE}2.csv", f"{IN_FILE}-trace.csv"
COAST = [f"{IN_FILE}-coast.csv", "--inertia", "0.012 kg*m^2", "--isothermal"]
MACHINE, SCENARIO, BROKEN = (f"{IN_FILE}-{name}.toml" for name in ("machine", "scenario", "broken"))
TYPED: dict[str, list[list[str]]] = {
    "app": [["--port", "99999"], ["--port", HOSTILE]],
    "new": [[LOG, "--machine", f"{IN_FILE}-new.toml"], [HOSTILE], [LOG, "--machine", f"{IN_FILE}/x.toml"]],
    "explain": [["dwell"], [HOSTILE]],
    "examples": [[f"{IN_FILE}-copied"], [LOG]],
    "inspect": [[LOG], [LOG, "--json"], [LOG, "--torque", HOSTILE], [LOG, "--save-mapping", "--force"]],
    "fit": [[LOG], [LOG, "--json"], [LOG, "--torque-unit", HOSTILE], [HOSTILE]],
    "report": [[LOG, "--out", f"{IN_FILE}.html", "--force"], [LOG, "--json"], [LOG, "--machine", BROKEN]],
    "models": [[LOG, "--bootstrap", "0"]],
    "film": [[MACHINE, "--log", LOG], [BROKEN]],
    "map": [[BROKEN, LOG], [MACHINE, LOG, "--out", f"{IN_FILE}.bmp"]],
    "posterior": [[LOG, "--machine", BROKEN], [LOG, "--machine", MACHINE, "--trace", HOSTILE]],
    "plan": [[MACHINE, LOG, "--to", HOSTILE]],
    "warmup": [[MACHINE, LOG, "--target", HOSTILE], [BROKEN, LOG]],
    "coastdown": [
        COAST,
        [*COAST, "--json"],
        [*COAST, "--points", f"{IN_FILE}-points.csv"],
        [COAST[0], "--inertia", HOSTILE],
        [LOG, *COAST[1:]],
    ],
    "trend": [
        [LOG, "--at", "20 rpm"],
        [LOG, "--at", "20 rpm", "--json"],
        [LOG, "--at", "20 rpm", "--out", f"{IN_FILE}-trend.csv"],
        [LOG],
        [LOG, "--at", HOSTILE],
        [LOG, "--at", "20 rpm", "--by", HOSTILE],
    ],
    "compare": [[LOG, OTHER]],
    "campaign": [
        ["add", f"{IN_FILE}.hersey", LOG, "--unit", "F12", "--age", "1 h"],
        ["show", f"{IN_FILE}.hersey", "F12"],
        ["check", f"{IN_FILE}.hersey", "--json"],
        ["list", f"{IN_FILE}.hersey", "--json"],
        ["add", f"{IN_FILE}.hersey", LOG, "--unit", HOSTILE, "--age", "1 h"],
        ["add", f"{IN_FILE}.hersey", LOG, "--unit", "F12", "--age", f"1 {HOSTILE}"],
        ["list", LOG],
    ],
    "life": [[f"{IN_FILE}-units.hersey", "--machine", BROKEN], [LOG, "--machine", MACHINE]],
    "weibull": [
        [f"{IN_FILE}-failures.csv"],
        [f"{IN_FILE}-failures.csv", "--json"],
        [LOG],
        [f"{IN_FILE}-failures.csv", "--arrhenius", HOSTILE, "--use", "40 degC"],
        [f"{IN_FILE}-failures.csv", "--age", HOSTILE],
    ],
    "design": [[LOG], [LOG, "--speed", HOSTILE]],
    "cycles": [
        [TRACE, "--value", f"force {IN_CELL}", "--drive-speed", "20 mm/s"],
        [TRACE, "--value", HOSTILE],
        [LOG],
    ],
    "simulate": [["--start", HOSTILE], ["--duration", "1", "--out", f"{IN_FILE}.bmp"]],
    "sweep": [[SCENARIO, "--out", f"{IN_FILE}.bmp"], [BROKEN]],
    "hysteresis": [["--stiffness", HOSTILE]],
    "export": [
        ["fmu", LOG, MACHINE, "--out", f"{IN_FILE}.fmu"],
        ["fmu", LOG, BROKEN, "--out", f"{IN_FILE}.fmu"],
        ["fmu", LOG, MACHINE, "--out", "x.fmu", "--library", HOSTILE],
    ],
    "testbench": [["--out", f"{IN_FILE}-made.csv", "--force"], ["--out", f"{IN_FILE}/x.csv"]],
}


#: Verbs of which only refusals are typed here: what they print otherwise holds no name.
REFUSED = {
    "app",
    "new",
    "life",
    "map",
    "posterior",
    "plan",
    "warmup",
    "simulate",
    "sweep",
    "hysteresis",
    "export",
}


def test_every_verb_is_typed() -> None:
    assert TYPED.keys() == VERBS.keys()


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("verb", VERBS)
def test_no_verb_prints_what_steers_a_terminal(verb: str, folder: Path) -> None:
    for number, typed in enumerate(TYPED[verb]):
        done = run(verb, *typed, cwd=folder)
        assert done.returncode == 0 or number or verb in REFUSED, done.stderr
        assert done.stdout or done.stderr
        assert "Traceback" not in done.stderr
        assert_plain(done.stdout, done.stderr)
        if "--json" in typed and done.returncode == 0:
            assert done.stdout.isascii()
            assert isinstance(json.loads(done.stdout), dict)


def test_names_stay_readable(folder: Path) -> None:
    shown = run("inspect", LOG, cwd=folder).stdout
    assert r"\x1b" in shown
    assert r"\u202e" in shown
    assert "[bold]x[bold][link=file:]y[link]" in shown


def test_the_proposed_mapping_can_be_read_back(folder: Path) -> None:
    from hersey.log.mapping import read_mapping
    from hersey.log.proposal import propose_mapping
    from hersey.log.reading import list_channels

    kept = folder / "kept.toml"
    kept.write_text(propose_mapping(folder / LOG), encoding="utf-8")
    named = {name for name, _ in list_channels(folder / LOG)}
    assert read_mapping(kept).channels.keys() >= {"torque", "speed"}
    assert set(read_mapping(kept).channels.values()) <= named


def test_codes_for_what_is_no_visible_character(capsys: pytest.CaptureFixture[str]) -> None:
    say("Drehzahl\u00a0µ\tn", "\x1b[2J\udcff")
    assert capsys.readouterr().out == "Drehzahl µ n\n\\x1b[2J\\udcff\n"
    assert_plain(printable(HOSTILE))


def test_a_terminal_without_the_signs_prints_letters(folder: Path) -> None:
    """Without any sign beyond ASCII, and with those of Latin-1 only."""
    said = "At 180 °C: \N{MINUS SIGN}0.60, 1.5 N·m, 3 µm, \N{INFINITY}, \u20ac"
    assert spelled(said, "ascii") == "At 180 degC: -0.60, 1.5 N m, 3 um, inf, ?"
    assert spelled(said, "latin-1") == "At 180 °C: -0.60, 1.5 N·m, 3 µm, inf, ?"
    assert spelled(said, "utf-8") == said
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    say("At 180 °C", file=stream)
    stream.flush()
    assert stream.buffer.getvalue() == b"At 180 degC\n"  # type: ignore[attr-defined]
    env = {**os.environ, "PYTHONIOENCODING": "ascii", "LANG": "C"}
    typed = [*HERSEY, "fit", "--torque", "Tq °C", LOG]
    done = subprocess.run(typed, cwd=folder, env=env, capture_output=True, check=False)
    assert b"'Tq degC'" in done.stderr, done.stderr


def test_warnings_too() -> None:
    with warnings_said():
        assert_plain(warnings.formatwarning(f"far {HOSTILE}", UserWarning, "x.py", 1))


def test_a_command_prints_through_one_function() -> None:
    """Only the function itself, JSON, which is ASCII, and the version print."""
    for path in CLI.glob("*.py"):
        calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
        printed = [ast.unparse(call.func) for call in calls]
        printed = [name for name in printed if name in ("print", "typer.echo", "sys.stdout.write")]
        allowed = {"terminal.py": 1, "outputs.py": 2, "__init__.py": 1}
        assert len(printed) <= allowed.get(path.name, 0), f"{path.name}: {printed}"
