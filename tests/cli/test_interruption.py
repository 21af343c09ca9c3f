"""Ctrl-C in every command at random moments: gone at once, outputs whole or absent, nothing left behind."""

from __future__ import annotations

import itertools
import json
import os
import random
import signal
import subprocess
import sys
import time
import tomllib
import zipfile
from pathlib import Path

import pytest

from hersey.cli.application import VERBS
from tests.cli.command import run
from tests.conftest import ROOT, mostly_nightly
from tests.life import shipped

EXAMPLES = ROOT / "examples"
BENCH = [str(EXAMPLES / "bench.csv"), "--tare", "standing"]
COAST = [str(EXAMPLES / "coast-down.csv"), "--inertia", "0.012 kg*m^2"]
MACHINE = str(EXAMPLES / "machine.toml")
#: Each verb with an input that keeps it busy, and roughly how long on a quiet machine, s.
TYPED: dict[str, tuple[list[str], float]] = {
    "app": (["--no-browser"], 1.5),
    "new": ([BENCH[0], "--mapping", "h.toml", "--machine", "m.toml"], 1.5),
    "explain": (["dwell"], 0.2),
    "examples": (["copied"], 0.5),
    "report": ([*BENCH, "--machine", MACHINE, "--out", "r.html", "--figures", "pictures"], 4.0),
    "inspect": ([BENCH[0], "--figure", "i.png"], 2.0),
    "fit": ([*BENCH, "--json"], 1.5),
    "models": (BENCH, 3.0),
    "film": ([MACHINE, "--figure", "f.svg"], 2.0),
    "map": ([MACHINE, *BENCH, "--out", "m.png"], 4.0),
    "plan": (
        [MACHINE, *BENCH, "--target", "60 mm/s", "--at", "150 degC", "--out", "p.csv", "--figure", "p.png"],
        8.0,
    ),
    "posterior": ([BENCH[0], "--machine", MACHINE, "--tare", "standing"], 6.0),
    "warmup": ([MACHINE, *BENCH, "--target", "200 mm/s", "--from", "20 degC", "--out", "w.csv"], 3.0),
    "coastdown": ([*COAST, "--points", "c.csv", "--figure", "c.png"], 2.5),
    "trend": ([BENCH[0], "--at", "60 rpm", "--out", "t.csv", "--figure", "t.png"], 3.0),
    "compare": ([*BENCH, BENCH[0], "--json"], 2.5),
    "campaign": (["add", "life.hersey", *BENCH, "--unit", "F12", "--age", "120000 pages"], 2.0),
    "weibull": ([str(EXAMPLES / "failures.csv"), "--out", "w.csv", "--figure", "w.png"], 2.5),
    "life": (["units.hersey", "--machine", MACHINE, "--out", "l.html", "--figures", "pictures"], 6.0),
    "design": (BENCH, 2.0),
    "cycles": ([str(EXAMPLES / "stick-slip.csv"), "--drive-speed", "20 mm/s", "--identify"], 3.0),
    "simulate": (["--csv", "s.csv", "--duration", "3000"], 1.0),
    "sweep": ([str(EXAMPLES / "scenario.toml"), "--out", "s.parquet"], 0.8),
    "hysteresis": (["--closure", "lugre", "--bristle-stiffness", "1e5", "--bristle-damping", "100"], 2.0),
    "export": (["fmu", "fit.json", MACHINE, "--temperature", "150 degC", "--out", "d.fmu", "--check"], 2.0),
    "testbench": (["--size", "60 MB", "--out", "log.csv"], 3.0),
}
#: Says when the program can be interrupted: what Python does before is not ours.
READY = "import sys; from hersey.cli import interruption, main; print('ready', flush=True); main()"
#: Processor time that ending may take, s: half a second by the clock, in which two cores may work.
LONGEST = 1.0


def test_every_verb_is_tried() -> None:
    assert TYPED.keys() == VERBS.keys()


#: Verb and moment, of which the second is that of another signal. All verbs end by the same handler; those
#: that `make test` interrupts write files of each kind, answer on stdout, or start workers.
INTERRUPTED = mostly_nightly(
    itertools.product(TYPED, range(2)),
    ("report", 0),
    ("fit", 1),
    ("campaign", 0),
    ("sweep", 1),
    ("testbench", 0),
)


@pytest.mark.parametrize(("verb", "moment"), INTERRUPTED)
def test_ctrl_c_ends_a_command(verb: str, moment: int, tmp_path: Path) -> None:
    typed, lasts = TYPED[verb]
    if verb == "life":
        shipped.write(tmp_path / "units.hersey", 1)
    if verb == "export":
        fit = run("fit", *BENCH, "--no-load", EXAMPLES / "no-load.csv", "--json", cwd=tmp_path).stdout
        (tmp_path / "fit.json").write_text(fit)
    process = subprocess.Popen(
        [sys.executable, "-c", READY, verb, *typed],
        cwd=tmp_path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout is not None
    assert process.stderr is not None
    assert process.stdout.readline() == b"ready\n"
    time.sleep(random.Random(f"{verb} {moment}").uniform(0, 0.9 * lasts))
    before = processor_time(process.pid)
    os.kill(process.pid, signal.SIGTERM if moment == 1 else signal.SIGINT)
    stdout, stderr = process.stdout.read(), process.stderr.read()
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # it has ended, and can still be looked at
    used = processor_time(process.pid) - before
    process.wait()
    ended = (0, -signal.SIGINT, -signal.SIGTERM)  # it may have come to its end
    assert process.returncode in (130, *ended), stderr.decode()
    if process.returncode == 130:
        assert stderr.decode().splitlines()[-1] == "hersey: interrupted"
        assert "Traceback" not in stderr.decode()
        assert used < LONGEST
        assert not stdout or verb not in ("fit", "compare"), "a part of its JSON"
    for path in tmp_path.rglob("*"):
        assert path.is_dir() or is_whole(path), path


def test_an_interrupted_question_leaves_its_line(tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", READY, "new", BENCH[0], "--mapping", "h.toml", "--machine", "m.toml"],
        cwd=tmp_path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stderr is not None
    asked = b""
    while not asked.endswith(b"[Drive torque]: "):
        asked += process.stderr.read(1)
    process.send_signal(signal.SIGINT)
    assert process.communicate()[1] == b"\nhersey: interrupted\n"
    assert process.returncode == 130


@pytest.mark.parametrize("moment", range(6))
def test_an_interrupt_while_the_core_loads(moment: int) -> None:
    """The signal comes in the middle of an import of NumPy's that the core makes."""
    halted = f"""
import os, signal, sys
from hersey.cli.interruption import end
left = {moment + 1} * 12
class Halts:
    def find_spec(self, name, path=None, target=None):
        global left
        left -= 1
        if not left:
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Halts())
try:
    import hersey._core
except KeyboardInterrupt:
    end()
"""
    ended = subprocess.run([sys.executable, "-c", halted], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (130, "hersey: interrupted\n")


def processor_time(process: int) -> float:
    """Processor time of a process itself, s."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def is_whole(path: Path) -> bool:
    """Whether a file ends as one of its kind does."""
    content = path.read_bytes()
    ends = {
        ".html": lambda: content.rstrip().endswith(b"</html>"),
        ".png": lambda: content.endswith(b"IEND\xaeB`\x82"),
        ".svg": lambda: content.rstrip().endswith(b"</svg>"),
        ".pdf": lambda: content.rstrip().endswith(b"%%EOF"),
        ".csv": lambda: content.endswith(b"\n"),
        ".parquet": lambda: content.endswith(b"PAR1"),
        ".json": lambda: bool(json.loads(content)),
        ".hersey": lambda: content.startswith(b"SQLite format 3\0") or not content,
        ".hersey-wal": lambda: True,  # SQLite's own, whole or mended at the next opening
        ".hersey-shm": lambda: True,
        ".fmu": lambda: zipfile.is_zipfile(path),
        ".md": lambda: content.endswith(b"\n"),
        ".toml": lambda: bool(tomllib.loads(content.decode())),
    }
    return ends[path.suffix]()


def test_an_interrupt_while_a_class_is_made_is_one() -> None:
    """Python up to 3.11 raises `RuntimeError` from what ends `__set_name__`, be it Ctrl-C."""
    in_a_class = """
import hersey.cli.application as application
from hersey.cli import main

class Name:
    def __set_name__(self, owner, name):
        raise KeyboardInterrupt

def interrupted():
    class Made:
        name = Name()

application.main = interrupted
main()
"""
    done = subprocess.run([sys.executable, "-c", in_a_class], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, "hersey: interrupted\n")
