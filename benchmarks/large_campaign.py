"""How long a life test of 5,000 runs takes: list, add one run, check, and follow it to its failures.

Specimens of the virtual test stand at ten ages each, 95 dwells a run, in a campaign file. Each command is a
process of its own; its time is compared with a limit. On two busy cores (2026-11-27): list 0.5 to 1.1 s wall
(0.6 s of processor), life 83 s wall (70 s of processor; 95 s wall before).

Usage: python -m benchmarks.large_campaign [--specimens 500] [--file build/large.hersey] [--only list,add]
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import hersey
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.life.age import Age
from hersey.life.campaign import Entry
from hersey.life.campaign.conversion import entry_of
from hersey.life.campaign.entry import COLUMNS
from hersey.testbench import RPM, population
from hersey.testbench.ageing import Unit
from hersey.testbench.campaign import STAND

MACHINE = Path("examples/machine.toml")
AGES = tuple(np.linspace(0.0, 170e3, 10).round(-2).tolist())
REST = NoLoadTorque.stated(constant="180 mN*m", per_speed="1 mN*m*s/rad")
SPEEDS = np.tile([*STAND.speeds_rpm, *STAND.speeds_rpm[-2::-1]], len(STAND.temperatures_degC))
LEVELS = np.repeat(STAND.temperatures_degC, len(SPEEDS) // len(STAND.temperatures_degC))
TORQUE, ERROR = list(COLUMNS).index("torque"), list(COLUMNS).index("torque_error")
#: Most wall time of each command, s.
LIMITS = {"list": 1.0, "add": 3.0, "check": 20.0, "life": 60.0}


def table(unit: Unit, age: float, seed: int) -> str:
    """Return a run as a table of means."""
    torque = unit.at(age).torque(SPEEDS * RPM, LEVELS)
    shown = torque * (1.0 + STAND.repeatability * np.random.default_rng(seed).standard_normal(torque.size))
    head = "speed [rpm],temperature [degC],torque [N*m],torque error [N*m]"
    rows = zip(SPEEDS.tolist(), LEVELS.tolist(), shown.tolist(), strict=True)
    return "\n".join([head, *(f"{v:g},{t:g},{q:.5f},{0.01 * q:.5f}" for v, t, q in rows), ""])


def made(file: Path, specimens: int) -> None:
    """Write the campaign: all runs keep the fit and the reduction of the first, which takes no time."""
    units = population(hersey.read_machine(MACHINE), REST, units=specimens, seed=3)
    first = file.with_suffix(".csv")
    first.write_text(table(units[0], 0.0, 0))
    points = hersey.SteadyPoints.from_table(first).without(REST)
    kept = entry_of(points, first)
    file.unlink(missing_ok=True)
    with hersey.Campaign.create(file) as campaign:
        campaign.add_entries(
            (_run(kept, unit, age, number * len(AGES) + i, file.parent), unit.name, Age(age, "pages"))
            for number, unit in enumerate(units)
            for i, age in enumerate(AGES)
        )


def _run(kept: Entry, unit: Unit, age: float, seed: int, folder: Path) -> Entry:
    """Return a run with torques of its own."""
    torque = unit.at(age).torque(SPEEDS * RPM, LEVELS) - REST.torque(SPEEDS * RPM)
    torque *= 1.0 + STAND.repeatability * np.random.default_rng(seed).standard_normal(torque.size)
    dwells = [list(row) for row in kept.dwells]
    for row, value in zip(dwells, torque.tolist(), strict=True):
        row[TORQUE], row[ERROR] = value, 0.01 * value
    return replace(kept, path=str(folder.absolute() / f"{seed}.csv"), sha256=f"{seed:064x}", dwells=dwells)


def commands(file: Path) -> dict[str, list[str]]:
    """Return each command that is measured."""
    added = file.with_name("added.csv")
    (unit,) = population(hersey.read_machine(MACHINE), REST, units=1, seed=3)
    added.write_text(table(unit, 180e3, int(time.time())))
    of_run = ["--unit", unit.name, "--age", f"{180000 + int(time.time()) % 9000} pages"]
    words = {
        "list": ["campaign", "list", str(file)],
        "add": [
            "campaign",
            "add",
            str(file),
            str(added),
            "--means",
            "--machine",
            str(MACHINE),
            "--force",
            *of_run,
        ],
        "check": ["campaign", "check", str(file)],
        "life": [
            "life",
            str(file),
            "--machine",
            str(MACHINE),
            "--out",
            str(file.with_suffix(".html")),
            "--force",
        ],
    }
    return {name: [sys.executable, "-m", "hersey.cli", *typed] for name, typed in words.items()}


def main() -> None:
    """Measure and print; the exit code is 1 if a limit is exceeded."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--specimens", type=int, default=500)
    parser.add_argument("--file", type=Path, default=Path("build/large.hersey"))
    parser.add_argument("--only", default=",".join(LIMITS))
    asked = parser.parse_args()
    asked.file.parent.mkdir(parents=True, exist_ok=True)
    if not asked.file.exists():
        made(asked.file, asked.specimens)
    late = False
    for name, command in commands(asked.file).items():
        if name in asked.only.split(","):
            before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
            if done.returncode not in ((0, 1) if name == "check" else (0,)):
                sys.exit(f"{name} failed with exit code {done.returncode}")
            wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
            used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            late |= wall > LIMITS[name]
            print(f"{name}: {wall:.1f} s wall, {used:.1f} s processor (limit {LIMITS[name]:g} s)", flush=True)
    sys.exit(late)


if __name__ == "__main__":
    main()
