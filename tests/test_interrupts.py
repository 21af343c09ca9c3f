"""Ctrl-C in the midst of each call that can last: the call ends with KeyboardInterrupt, and soon.

Each call would last minutes or hours. It runs in a process beside this one, which is interrupted once it has
worked and then takes the next call; what is measured is its processor time after the interrupt, which a busy
machine does not lengthen.
"""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import ROOT

HEAD = """
import json, sys
from math import inf
import numpy as np, xarray
from hersey import Drag, Drivetrain, simulate, stick_slip, _core
from hersey.lubrication import paper
from hersey.lubrication.reynolds import ElasticLayer, solve_line_contact
from hersey.motion.sweep import sweep
from hersey.stability.disturbance import disturbance, safe_step
from hersey.stability.hysteresis import cycles_without_sticking, hysteresis
from hersey.motion.work import Work
from hersey.stability.hysteresis_sweep import hysteresis_sweep
PAPER = {"ehl_exponent": -0.7, "mixed_exponent": -1.2, "stick_speed": 0.01}
TRAIN, DRAG = Drivetrain(1000, 1), Drag(50, 1, **PAPER)
BRISTLES = Drag(50, 1, **PAPER, closure="lugre", bristle_stiffness=1e5, bristle_damping=100.0)
import hersey
from hersey import Limits, Machine, plan_profile
from hersey.study import study
from hersey.identification.trace_file import read_trace
BENCH = "examples/bench.csv"
PLANNED = Machine(1000, 1, 0.02, 0.01, limits=Limits(speed=4, acceleration=10))
NIP = {"effective_modulus": 2.63e6, "layer": ElasticLayer(3.5e-3, 0.49)}
made = set()
while typed := sys.stdin.readline():
    needed, call = json.loads(typed)
    for text in needed:
        if text not in made:
            exec(text)
            made.add(text)
    print("ready", flush=True)
    try:
        exec(compile(call, "call", "exec"))  # of a text, Python would end as if nobody had caught it
    except KeyboardInterrupt:
        print("interrupted", flush=True)
"""
#: What some calls are given, made once for all of them.
MADE = {
    "RECORD": (
        'TRACE = read_trace("examples/stick-slip.csv")\n'
        "RECORD = hersey.cycles(TRACE.time, TRACE.value, drive_speed=0.02)"
    ),
    "POINTS": 'POINTS = hersey.read(BENCH).steady(tare="standing")',
    "MACHINE": 'MACHINE = hersey.read_machine("examples/machine.toml")',
    "SURFACE": (
        'SURFACE = hersey.fit(hersey.read(BENCH).steady(tare="standing").without('
        'hersey.read_machine("examples/machine.toml").rest))'
    ),
}
#: Each with what would make it last for long.
CALLS = {
    "simulate": "simulate(TRAIN, DRAG, drive_speed=1.0, duration=1e9, most_steps=inf)",
    "simulate with bristles": "simulate(TRAIN, BRISTLES, drive_speed=1.0, duration=1e9, most_steps=inf)",
    "samples": "simulate(TRAIN, BRISTLES, drive_speed=0.0, duration=1.0, samples=20_000_000)",
    "stick_slip": "[stick_slip(TRAIN, BRISTLES, drive_speed=1.0) for _ in range(9999)]",
    "sweep": "sweep(TRAIN, DRAG, drive_speed=[0.5, 1.0], duration=1e300, work=Work(most_steps=inf))",
    "sweep with bristles": (
        "sweep(TRAIN, BRISTLES, drive_speed=np.linspace(0.5, 2, 5000), work=Work(threads=2))"
    ),
    "hysteresis": "hysteresis(TRAIN, BRISTLES, most_steps=inf)",
    "samples of a band": "hysteresis(TRAIN, DRAG, samples={'mass': np.linspace(1, 2, 3_000_000)})",
    "hysteresis_sweep": "hysteresis_sweep(TRAIN, BRISTLES, stiffness=np.linspace(500, 2000, 100))",
    "cycles": "cycles_without_sticking(TRAIN, DRAG, slowest=np.linspace(0.02, 0.9, 9_000_000))",
    "safe_step": "[safe_step(TRAIN, DRAG, from_speed=2.5, to_speed=1.2) for _ in range(9999)]",
    "disturbance": "[disturbance(TRAIN, DRAG, drive_speed=1.2) for _ in range(9999)]",
    "line_contact": "[solve_line_contact(0.015, 1136, 0.1, 0.1, **NIP, nodes=1601) for _ in range(999)]",
    "fine line_contact": "solve_line_contact(0.015, 1136, 0.1, 0.1, **NIP, nodes=4001)",
    "read": "[hersey.read(BENCH) for _ in range(9999)]",
    "models": "[hersey.compare_models(POINTS) for _ in range(9999)]",
    "identify": "[hersey.identify(RECORD) for _ in range(99)]",
    "study": "[study(POINTS) for _ in range(999)]",
    "map": "[hersey.operating_map(SURFACE, MACHINE) for _ in range(999)]",
    "plan": "[plan_profile(PLANNED, DRAG, target_speed=1.2) for _ in range(999)]",
    "films": "_core.layer(np.broadcast_arrays(np.linspace(900.0, 1300.0, 10**7), 0.015, 0.0035, 2e6, 0.48))",
}
#: Processor time before the interrupt, and the most that may follow it, s; what is promised is 0.5 s of time.
WORKED, MOST = 0.4, 2.0
PROCESSES = Path("/proc")


def processor_time(process: int) -> float:
    """Processor time of a process and its threads, s."""
    fields = (PROCESSES / str(process) / "stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.fixture(scope="module")
def children() -> Iterator[list[subprocess.Popen[str]]]:
    """The process that has ended every call so far, if there is one; it ends by itself after the last."""
    kept: list[subprocess.Popen[str]] = []
    yield kept
    for child in kept:
        told, _ = child.communicate(timeout=60.0)
        assert (child.returncode, told) == (0, "")


def started() -> subprocess.Popen[str]:
    """A process that runs what it is told on its standard input."""
    return subprocess.Popen(
        [sys.executable, "-c", HEAD],
        cwd=ROOT,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


@pytest.mark.skipif(not (PROCESSES / "self" / "stat").exists(), reason="processor time is read from /proc")
@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_an_interrupt_ends_the_call(call: str, children: list[subprocess.Popen[str]]) -> None:
    child = children.pop() if children else started()
    assert child.stdin is not None
    assert child.stdout is not None
    try:
        needed = [text for name, text in MADE.items() if name in call]
        print(json.dumps([needed, call]), file=child.stdin, flush=True)
        assert child.stdout.readline() == "ready\n"
        begun = processor_time(child.pid)
        while (worked := processor_time(child.pid) - begun) < WORKED and child.poll() is None:
            time.sleep(0.02)
        child.send_signal(signal.SIGINT)
        # two threads may work after it; a call that goes on is stopped here by its processor time
        while processor_time(child.pid) - begun - worked < 2 * MOST:
            if select.select([child.stdout], [], [], 0.02)[0]:
                break
        else:
            pytest.fail("the call goes on")
        assert child.stdout.readline() == "interrupted\n"
        children.append(child)
    finally:
        if not children:
            child.kill()
            child.communicate()
