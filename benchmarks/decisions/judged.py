"""One report against its machine: what the first screen says, and whether it holds.

Speeds are read from the sentences as a user reads them. What cannot be read counts as another instruction,
which the table tells by its first words, so that a change of words does not pass for success.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.decisions.belt import Belt, Drive, fold, from_above, from_rest, moved
from benchmarks.decisions.machines import Machine, Point, write

#: Over the speed of an instruction, or of a bound, at which it is tried.
_BEYOND, _BELOW = 1.02, 0.9
_SLOW_LAPS = 400
_PATIENCE = 600


@dataclass
class Judged:
    """What came of one machine; claims are counted as (held, false)."""

    number: int
    said: str = ""
    fault: str = ""
    poor: bool = False
    limits: str = ""
    holds_fold: bool | None = None  #: whether V* is in its interval, if one is told
    over: float | None = None  #: X over V*, of "run above X"
    claims: dict[str, list[bool]] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)

    def claim(self, kind: str, holds: bool, words: str) -> None:
        """Count a statement; a false one is kept in words."""
        self.claims.setdefault(kind, []).append(holds)
        if not holds:
            self.wrong.append(f"machine {self.number}: {kind}: {words}")


def judged(machine: Machine, number: int, seed: int, folder: Path) -> Judged:
    """Write a machine's files, have the report made, and try on the machine what it says."""
    out = Judged(number, poor=machine.poor, limits=machine.limits)
    log, file = write(machine, folder, np.random.default_rng([seed, number, 1]))
    command = [sys.executable, "-m", "hersey.cli", "report", str(log), "--machine", str(file)]
    command += ["--tare", "standing", "--json", *(["--isothermal"] if machine.hottest is None else [])]
    made = subprocess.run(
        command, capture_output=True, text=True, timeout=_PATIENCE, check=False, env={**os.environ}
    )
    if made.returncode:
        out.fault = made.stderr.strip()[-300:]
        return out
    (folder / "document.json").write_text(made.stdout)
    return tried(out, machine, json.loads(made.stdout)["decision"])


def tried(out: Judged, machine: Machine, decision: dict[str, Any]) -> Judged:
    """Try what a decision says on its machine."""
    _instruction(out, machine, decision)
    for point, part in zip(machine.points, decision["points"], strict=True):
        _point(out, machine, point, part)
    return out


def _instruction(out: Judged, machine: Machine, decision: dict[str, Any]) -> None:
    text = out.said = decision["instruction"]
    belt = machine.at(_named(machine, text))
    if interval := re.search(r"V\* is [\d.]+ \[([\d.]+), ([\d.]+)\]", decision["interval"]):
        low, high = (1e-3 * float(end) for end in interval.groups())
        out.holds_fold = low <= fold(belt) <= high
    if above := re.search(r"run above ([\d.]+) mm/s", text, re.IGNORECASE):
        speed = 1e-3 * float(above[1])
        out.over = speed / fold(belt)
        _smooth(out, machine, belt, _BEYOND * speed, text, sure="make sure that it starts" not in text)
    if "nothing sticks" in text or "nothing sticks" in decision["otherwise"]:
        slow = min(machine.speeds)
        out.claim("nothing sticks", from_rest(belt, slow).outcome == "slides", text)
    if below := re.search(r"Below ([\d.]+) mm/s it sticks", decision["otherwise"]):
        speed = _BELOW * 1e-3 * float(below[1])
        fate = from_above(belt, speed, laps=_SLOW_LAPS)
        out.claim("sticks below", fate.outcome in ("sticks", "stalls"), decision["otherwise"])
    if down := re.search(r"goes on sliding down to ([\d.]+) rpm", decision["otherwise"]):
        speed = _BEYOND * float(down[1]) * 2.0 * np.pi / 60.0 * machine.radius
        fates = [from_above(machine.at(t), speed, laps=_SLOW_LAPS) for t in machine.temperatures]
        out.claim("slides on down to", all(f.outcome == "slides" for f in fates), decision["otherwise"])
    if on := re.search(r"goes on sliding above ([\d.]+) mm/s", decision["otherwise"]):
        fate = from_above(belt, _BEYOND * 1e-3 * float(on[1]), laps=_SLOW_LAPS)
        out.claim("slides on above", fate.outcome == "slides", decision["otherwise"])
    if "do not start a belt at rest" in text or "it slips on a belt at rest" in text:
        out.claim("does not start", not _starts(machine, belt), text)


def _named(machine: Machine, text: str) -> float | None:
    """The temperature that a sentence names, of points and dwells; the hottest where it names none."""
    named = re.search(r"[Aa]t (\d+) °C", text)
    if machine.hottest is None or named is None:
        return machine.hottest
    known = {p.temperature for p in machine.points} | set(machine.temperatures)
    return min((t for t in known if t is not None), key=lambda t: abs(t - float(named[1])))


def _starts(machine: Machine, belt: Belt) -> bool:
    motor = np.inf if machine.motor is None else machine.motor / machine.radius
    return belt.start <= min(motor, belt.grip)


def _smooth(out: Judged, machine: Machine, belt: Belt, speed: float, words: str, *, sure: bool) -> None:
    """Try a speed that is to be smooth from any start; from rest where it starts, or is said to."""
    fates = {"from above": from_above(belt, speed)}
    starts = _starts(machine, belt)
    if sure:
        out.claim("starts", starts, words)
    if sure or starts:
        fates |= {"ramp": from_rest(belt, speed, machine.acceleration), "step": from_rest(belt, speed)}
    for name, fate in fates.items():
        out.claim(f"run above, {name}", fate.outcome == "slides", f"{words} ({fate.outcome})")


def _point(out: Judged, machine: Machine, point: Point, part: dict[str, Any]) -> None:
    belt, words = machine.at(point.temperature), part["words"]
    what = f"{words} at {1e3 * point.speed:.3g} mm/s"
    rest = from_rest(belt, point.speed, machine.acceleration), from_rest(belt, point.speed)
    from_anywhere = all(fate.outcome == "slides" for fate in rest) and _starts(machine, belt)
    above = from_above(belt, point.speed, laps=_SLOW_LAPS).outcome
    if "smooth from any start" in words:
        out.claim("point: smooth from any start", from_anywhere and above == "slides", what)
    elif words.startswith(("smooth", "slides on", "depends")):
        out.claim(f"point: {words.split()[0]}", above == "slides", f"{what} ({above})")
    elif words.startswith("sticks"):
        sticks = above != "slides" or any(fate.outcome != "slides" for fate in rest)
        out.claim("point: sticks", sticks, what)
    elif words.startswith("not started"):
        out.claim("point: not started", not _starts(machine, belt), what)
    if rows := (part["plan"] or {}).get("rows"):
        _plan(out, machine, belt, part["plan"], [(row["time"], row["drive_speed"]) for row in rows], what)


def _plan(
    out: Judged,
    machine: Machine,
    belt: Belt,
    plan: dict[str, Any],
    corners: list[tuple[float, float]],
    words: str,
) -> None:
    """Drive a plan on the true machine: it slides once ready, within what motor and drive give."""
    fate = moved(belt, Drive(*corners))
    late = any(time > plan["duration"] + 1e-9 for time in fate.stuck)
    out.claim("plan slides", fate.outcome == "slides" and not late, f"{words} ({fate.outcome})")
    if machine.motor is not None and machine.fastest is not None:
        within = fate.pull * machine.radius <= 1.0001 * machine.motor
        within &= max(speed for _, speed in corners) <= 1.0001 * machine.fastest
        out.claim("plan within limits", within, words)
