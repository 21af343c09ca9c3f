"""Type a command on a file, follow its advice to the letter, and compare what is read with the truth."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tests.cli import command

from benchmarks.advice import followed
from benchmarks.layouts.truth import Made
from hersey.errors import HerseyError, speak
from hersey.log.mapping import read_with_mapping
from hersey.log.torque_log import TorqueLog

#: Commands at the most.
_MOST = 4
_TYPED = re.compile(r"run '(hersey inspect .* --save-mapping)'")
_ROLE_FLAGS = ("time", "torque", "speed", "temperature")


@dataclass(frozen=True)
class Outcome:
    """Commands that were typed until the log was read, what each said, and what was read wrong."""

    commands: tuple[str, ...]
    said: tuple[str, ...]
    wrong: str = ""
    read: bool = False

    @property
    def right(self) -> bool:
        """Whether every number is the one that was written."""
        return self.read and not self.wrong


def tried(path: Path, made: Made, *, inspected: bool = False) -> Outcome:
    """Return what comes of a file, its advice followed; ``inspected``: first of `hersey inspect`."""
    flags: list[str] = []
    typed: list[str] = []
    said: list[str] = []
    if inspected:
        done = command.run("inspect", path.name, "--save-mapping", cwd=path.parent)
        typed.append(f"hersey inspect {path.name} --save-mapping")
        said.append(done.stdout + done.stderr)
        flags = _with_options(_advised(said[-1], path.name), made)
    while len(typed) < _MOST:
        typed.append(shlex.join(["hersey", "fit", path.name, *flags]))
        speak("terminal")
        try:
            log = read_with_mapping(path, **_keywords(flags)).log
        except HerseyError as error:
            said.append(str(error))
        else:
            return Outcome(tuple(typed), tuple(said), wrong_with(log, made), read=True)
        finally:
            speak("python")
        if match := _TYPED.search(said[-1]):
            line = match[1]
            done = command.run(*shlex.split(line)[1:], cwd=path.parent)
            typed.append(line)
            said.append(done.stdout + done.stderr)
            if done.returncode:
                break
            continue
        proposals = followed(["fit", path.name, *flags], f"hersey: {said[-1]}")
        if not proposals:
            break
        flags = _with_options(proposals[0][2:], made)
    return Outcome(tuple(typed), tuple(said))


def _advised(said: str, name: str) -> list[str]:
    """The options that the output of inspect says to add."""
    lines = [line for line in said.splitlines() if "--" in line]
    proposals = followed(["fit", name], f"hersey: {' '.join(lines)}") if lines else []
    return proposals[0][2:] if proposals else []


def _with_options(flags: list[str], made: Made) -> list[str]:
    """The options, with what a user knows in the place of examples."""
    known = list(flags)
    for at, flag in enumerate(flags[:-1]):
        known[at + 1] = made.options.get(flag, flags[at + 1])
    return known


def _keywords(flags: list[str]) -> dict[str, object]:
    """The keywords of Python that options stand for."""
    channels: dict[str, str] = {}
    units: dict[str, str] = {}
    others: dict[str, object] = {}
    at = 0
    while at < len(flags) - 1 or flags[at:] in (["--isothermal"], ["--drop-missing"]):
        flag = flags[at].removeprefix("--")
        if flag in ("isothermal", "drop-missing"):
            others[flag.replace("-", "_")] = True
            at += 1
            continue
        if flag in _ROLE_FLAGS or flag == "run":
            channels[flag] = flags[at + 1]
        elif flag.endswith("-unit"):
            units[flag.removesuffix("-unit")] = flags[at + 1]
        else:
            others[flag] = flags[at + 1]
        at += 2
    return {"channels": channels, "units": units, **others}


def wrong_with(log: TorqueLog, made: Made) -> str:
    """Return what differs from the truth, or nothing."""
    for name in ("torque", "speed", "temperature"):
        expected = getattr(made.truth, name)
        parts = [getattr(run, name) for run in log.runs]
        if expected is None:
            continue
        if any(part is None for part in parts):
            return f"{name} is not read"
        found = np.concatenate(parts)
        if found.shape != expected.shape:
            return f"{found.size} rows instead of {expected.size}"
        if not np.allclose(found, expected, rtol=1e-9, atol=1e-12):
            row = int(np.argmax(~np.isclose(found, expected, rtol=1e-9, atol=1e-12)))
            return f"{name} of row {row + 1} is {found[row]:.6g} instead of {expected[row]:.6g} (SI)"
    first = 0
    for run in log.runs:
        expected = made.truth.time[first : first + run.time.size]
        if not np.allclose(run.time - run.time[0], expected - expected[0], rtol=1e-9, atol=1e-6):
            return "the time differs"
        first += run.time.size
    return ""
