"""One report against its machine: what the report claims, and whether the machine agrees."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import traceback
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchmarks.decisions.belt import Belt, Drive
from benchmarks.decisions.fold import fold
from benchmarks.decisions.logs import Files, write
from benchmarks.decisions.machines import Kind, Machine, Point, drawn
from benchmarks.decisions.motion import Outcome, from_above, from_rest, moved
from benchmarks.decisions.said import Plan, PointSaid, Said, read

#: Factors on the safe speed X at which it is tried.
_BEYOND = (1.0, 1.01, 1.02)
#: Factors from which the drive steps down to a speed, where it is tried from above.
_ABOVE = (1.001, 2.0)
#: Free periods for which a belt near its transition speed is followed.
_SLOW_LAPS = 400
#: Seconds that a report may take.
_PATIENCE = 600
#: Characters that are kept of an error message.
_MESSAGE = 600
#: Libraries that would start threads of their own beside the workers.
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "POLARS_MAX_THREADS", "RAYON_NUM_THREADS")


@dataclass
class Judged:
    """What came of one machine; each claim is kept with whether it holds."""

    number: int
    shape: str
    closure: str
    evidence: str
    said: str = ""
    fault: str = ""
    fold_held: bool | None = None  #: whether V* lies in its 95 % interval
    width: float | None = None  #: upper over lower end of that interval
    over: float | None = None  #: safe speed over V*
    measurement: str | None = None
    verdicts: list[str] = field(default_factory=list)
    claims: dict[str, list[bool]] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)

    def claim(self, kind: str, holds: bool, words: str) -> None:
        """Count a claim; a false one is kept in words."""
        self.claims.setdefault(kind, []).append(holds)
        if not holds:
            self.wrong.append(f"machine {self.number} ({self.shape}, {self.closure}): {kind}: {words}")


def draw_and_judge(seed: int, wanted: Kind, keep: Path | None, number: int) -> Judged:
    """Draw and judge one machine; an error of the judge itself counts as a fault of that machine."""
    machine = drawn(seed, number, wanted)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) if keep is None else keep / str(number)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            return judged(machine, number, seed, folder)
        except Exception:
            words = f"the judge failed: {traceback.format_exc(limit=-3)}"
            return Judged(number, machine.curve.family, machine.closure, machine.evidence, fault=words)


def judged(machine: Machine, number: int, seed: int, folder: Path) -> Judged:
    """Write the files of a machine, ask for a report, and try on the machine what it says."""
    out = Judged(number, machine.curve.family, machine.closure, machine.evidence)
    files = write(machine, folder, np.random.default_rng([seed, number, 1]))
    try:
        made = reported(files)
    except subprocess.TimeoutExpired:
        out.fault = f"no report after {_PATIENCE} s"
        return out
    if made.returncode:
        out.fault = f"exit {made.returncode}: {made.stderr.strip()[-_MESSAGE:]}"
        return out
    (folder / "document.json").write_text(made.stdout)
    return tried(out, machine, read(json.loads(made.stdout)))


def reported(files: Files) -> subprocess.CompletedProcess[str]:
    """Run `hersey report --json` on the files of a machine."""
    return subprocess.run(
        _command(files),
        capture_output=True,
        text=True,
        timeout=_PATIENCE,
        check=False,
        env={**dict.fromkeys(_THREADS, "1"), **os.environ},
    )


def _command(files: Files) -> list[str]:
    command = [sys.executable, "-m", "hersey.cli", "report", str(files.log), "--machine", str(files.machine)]
    command += ["--trace", str(files.trace)] if files.trace else []
    return [*command, "--tare", "standing", "--json"]


def tried(out: Judged, machine: Machine, said: Said) -> Judged:
    """Try what a report says on its machine."""
    out.said, out.measurement = said.instruction, said.measurement
    temperature = machine.hottest if said.temperature is None else said.temperature
    belt = machine.at(_nearest(machine, temperature))
    _fold(out, belt, said)
    if said.safe_speed is not None:
        _safe_speed(out, machine, belt, said.safe_speed)
    if len(said.points) != len(machine.points):
        out.fault = f"{len(said.points)} points in the document, {len(machine.points)} in the machine file"
    for point, part in zip(machine.points, said.points, strict=False):
        _point(out, machine, point, part)
    return out


def _nearest(machine: Machine, temperature: float) -> float:
    """Return the temperature that a rounded one means: that of a dwell or point within 1 degC, or itself."""
    known = {*machine.temperatures, *(point.temperature for point in machine.points)}
    nearest = min(known, key=lambda t: abs(t - temperature))
    return nearest if abs(nearest - temperature) < 1.0 else temperature


def _fold(out: Judged, belt: Belt, said: Said) -> None:
    """Compare interval of V* and safe speed with the true V*."""
    true = fold(belt)
    if said.fold is not None:
        low, high = said.fold
        out.fold_held, out.width = low <= true <= high, high / low
        if not out.fold_held:
            words = f"V* is {1e3 * true:.4g} mm/s, said {1e3 * low:.4g} to {1e3 * high:.4g}"
            out.wrong.append(f"machine {out.number} ({out.shape}, {out.closure}): {words}")
    if said.safe_speed is not None:
        out.over = said.safe_speed / true


def _safe_speed(out: Judged, machine: Machine, belt: Belt, safe: float) -> None:
    """Try the safe speed and a little more, from every start."""
    for factor in _BEYOND:
        fates = {**_from_above(belt, factor * safe)}
        if machine.starts(belt):
            fates |= _from_rest(machine, belt, factor * safe)
        failed = [f"{name} {outcome}" for name, outcome in fates.items() if outcome != "slides"]
        if failed:
            out.claim("X smooth", False, f"{1e3 * factor * safe:.4g} mm/s: {', '.join(failed)}; {out.said}")
            return
    out.claim("X smooth", True, out.said)


def _from_rest(machine: Machine, belt: Belt, speed: float) -> dict[str, Outcome]:
    return {
        "step": from_rest(belt, speed).outcome,
        "ramp": from_rest(belt, speed, machine.acceleration).outcome,
    }


def _from_above(belt: Belt, speed: float) -> dict[str, Outcome]:
    return {f"from {over:g} times": from_above(belt, speed, over).outcome for over in _ABOVE}


def _point(out: Judged, machine: Machine, point: Point, part: PointSaid) -> None:
    """Try the verdict on an operating point, and its plan."""
    belt = machine.at(point.temperature)
    out.verdicts.append(part.verdict)
    what = f"{part.words} (at {1e3 * point.speed:.4g} mm/s, V* is {1e3 * fold(belt, 1e-3):.4g})"
    rest, starts = _from_rest(machine, belt, point.speed), machine.starts(belt)
    near = from_above(belt, point.speed, laps=_SLOW_LAPS).outcome
    if part.verdict == "smooth":
        every = [*rest.values(), *_from_above(belt, point.speed).values()]
        words = what if starts else f"{what}; the belt cannot be started"
        out.claim("smooth", starts and set(every) == {"slides"}, words)
    elif part.verdict == "depends":
        out.claim("depends", near == "slides", f"{what} ({near})")
    elif part.verdict == "sticks":
        sticks = not starts or any(outcome != "slides" for outcome in rest.values())
        out.claim("sticks", sticks, what)
    elif part.verdict in ("not started", "stalls"):
        out.claim(part.verdict, not starts or near == "stalls", what)
    elif part.verdict == "too fast":
        out.claim("too fast", machine.fastest is not None and point.speed > machine.fastest, what)
    if part.plan is not None:
        _plan(out, machine, belt, part.plan, what)


def _plan(out: Judged, machine: Machine, belt: Belt, plan: Plan, words: str) -> None:
    """Drive a plan on the machine: the belt slides once it is ready, within what motor and drive give."""
    fate = moved(belt, Drive(*plan.corners))
    late = any(time > plan.ready + 1e-9 for time in fate.stuck)
    works = fate.outcome == "slides" and not late
    out.claim("plan works", works, f"{words} ({fate.outcome}{', sticks late' if late else ''})")
    if machine.motor is not None and machine.fastest is not None:
        within = fate.pull * machine.radius <= 1.0001 * machine.motor
        within &= max(speed for _, speed in plan.corners) <= 1.0001 * machine.fastest
        out.claim("plan within limits", within, words)
