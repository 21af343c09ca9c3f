"""How long the command takes to start, against the import of what it stands on.

Each line is a process of its own, run ``RUNS`` times in turn with the others; medians of its processor time
(user and system) and of its wall time. Writes START.md.

Usage: python benchmarks/start.py
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

from hersey.cli.application import VERBS

RUNS = 20
TYPER, NUMPY = "import typer", "import numpy"
MODULE = [sys.executable, "-m", "hersey.cli"]
SCRIPT = [shutil.which("hersey", path=str(Path(sys.executable).parent)) or ""]


@dataclass
class Line:
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


def lines() -> list[Line]:
    """Every command that is measured, peers first."""
    python = [sys.executable, "-c"]
    listed = [Line("python", [*python, "pass"])]
    listed += [Line(text, [*python, text]) for text in (TYPER, NUMPY)]
    listed.append(Line("import hersey", [*python, "import hersey"], NUMPY, 1.2))
    for way, hersey in (("python -m hersey.cli", MODULE), ("hersey", SCRIPT)):
        if not hersey[0]:
            continue
        listed.append(Line(f"{way} --version", [*hersey, "--version"], TYPER, 2.0))
        listed.append(Line(f"{way} --help", [*hersey, "--help"], TYPER, 4.0))
    listed += [Line(f"hersey {verb} --help", [*MODULE, verb, "--help"], TYPER) for verb in VERBS]
    listed += [Line(f"hersey {verb}", [*MODULE, verb], NUMPY) for verb in ("simulate", "hysteresis")]
    return listed


def table(measured: list[Line]) -> list[str]:
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
    measured = lines()
    for _ in range(RUNS):
        for line in measured:
            line.run()
    text = "\n".join(
        [
            "# How long the command takes to start",
            "",
            f"Medians of {RUNS} processes each, in turn, in one run of `python benchmarks/start.py`; "
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
