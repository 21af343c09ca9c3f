"""How long the command takes to start, against the import of what it stands on.

Each line is a process of its own, run ``RUNS`` times in turn with the others; medians of its processor time
(user and system) and of its wall time. Run alone, it writes START.md.

Usage: python -m benchmarks.start
"""

from __future__ import annotations

import platform
import resource
import shutil
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

from benchmarks.lines import Line
from hersey.cli.application import VERBS

RUNS = 20
#: Most times the import of typer that the help of a verb takes.
VERB = 2.5
TYPER, NUMPY = "import typer", "import numpy"
MODULE = [sys.executable, "-m", "hersey.cli"]
SCRIPT = [shutil.which("hersey", path=str(Path(sys.executable).parent)) or ""]


@dataclass
class Start:
    """One command, what it is measured against, and how many times that it may take."""

    name: str
    command: list[str]
    against: str = ""
    bound: float | None = None
    processor: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)

    def run(self) -> None:
        """Run it once more."""
        before, start = _children(), time.perf_counter()
        subprocess.run(self.command, stdout=subprocess.DEVNULL, check=True)
        self.wall.append(time.perf_counter() - start)
        self.processor.append(_children() - before)


def _children() -> float:
    """Processor time of all processes that have ended, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def starts() -> list[Start]:
    """Every command that is measured, peers first."""
    python = [sys.executable, "-c"]
    listed = [Start("python", [*python, "pass"])]
    listed += [Start(text, [*python, text]) for text in (TYPER, NUMPY)]
    listed.append(Start("import hersey", [*python, "import hersey"], NUMPY, 1.2))
    for way, hersey in (("python -m hersey.cli", MODULE), ("hersey", SCRIPT)):
        if not hersey[0]:
            continue
        listed.append(Start(f"{way} --version", [*hersey, "--version"], TYPER, 2.0))
        listed.append(Start(f"{way} --help", [*hersey, "--help"], TYPER, 4.0))
    listed += [Start(f"hersey {verb} --help", [*MODULE, verb, "--help"], TYPER, VERB) for verb in VERBS]
    listed += [Start(f"hersey {verb}", [*MODULE, verb], NUMPY) for verb in ("simulate", "hysteresis")]
    return listed


def measure(runs: int) -> list[Start]:
    """Run every command so many times, in turn."""
    measured = starts()
    for _ in range(runs):
        for line in measured:
            line.run()
    return measured


def lines(runs: int) -> list[Line]:
    """Return version, list of verbs and the slowest help of a verb, by processor time."""
    seconds = {each.name: (statistics.median(each.processor), each) for each in measure(runs)}
    typer = seconds[TYPER][0]
    verbs = [f"hersey {verb} --help" for verb in VERBS]
    slowest = max(verbs, key=lambda name: seconds[name][0])
    named = {
        "python -m hersey.cli --version": "`hersey --version`",
        "python -m hersey.cli --help": "`hersey --help`",
        slowest: f"`{slowest}`, the slowest of {len(verbs)}",
    }
    return [
        Line(words, seconds[name][0], f"`{TYPER}`", typer, slower=seconds[name][1].bound)
        for name, words in named.items()
    ]


def table(measured: list[Start]) -> list[str]:
    """Medians in ms, ratios to the peer of the same run, and the most that each may be."""
    peers = {line.name: line for line in measured}
    rows = [
        "| command | processor, ms | wall, ms | of | ratio, processor | ratio, wall | at most |",
        "|---|---|---|---|---|---|---|",
    ]
    for line in measured:
        own = [statistics.median(times) for times in (line.processor, line.wall)]
        cells = [f"`{line.name}`", *(f"{1e3 * value:.0f}" for value in own)]
        if line.against:
            peer = peers[line.against]
            theirs = [statistics.median(times) for times in (peer.processor, peer.wall)]
            ratios = [f"{mine / other:.2f}" for mine, other in zip(own, theirs, strict=True)]
            cells += [f"`{line.against}`", *ratios, "" if line.bound is None else f"{line.bound:g}"]
        else:
            cells += [""] * 4
        rows.append(f"| {' | '.join(cells)} |")
    return rows


def main() -> None:
    """Measure, print and write."""
    measured = measure(RUNS)
    text = "\n".join(
        [
            "# How long the command takes to start",
            "",
            f"Medians of {RUNS} processes each, in turn, in one run of `python -m benchmarks.start`; "
            f"Python {platform.python_version()}.",
            "Ratios are to the import named, measured in the same run.",
            "",
            *table(measured),
            "",
        ]
    )
    print(text)
    Path(__file__).with_name("START.md").write_text(text)


if __name__ == "__main__":
    main()
