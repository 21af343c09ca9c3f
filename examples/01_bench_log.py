"""Fit the shipped log of the virtual test stand, and compare no-load torque and transition with the truth.

Usage: python examples/01_bench_log.py [FOLDER]: the figures are written into FOLDER (build/examples).
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import hersey
from hersey.charts.analysis import charts
from hersey.document.assembly import document_of
from hersey.study import study

HERE = Path(__file__).parent
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "build/examples")

machine = hersey.read_machine(HERE / "machine.toml")
log = hersey.read(HERE / "bench.csv")
points = log.steady(tare="standing").without(machine.rest)
document = document_of(study(points, machine))
told = json.loads((HERE / "bench-truth.json").read_text())

print(*document.verdict, sep="\n")
for name in ("constant", "per_speed"):
    print(f"no-load torque, {name}: {getattr(machine.rest, name)}, in truth {told['truth']['rest'][name]}")
transition = document.film.transition
ends = zip(transition.measured, transition.low, transition.high, strict=True)
for speeds, true in zip(ends, told["transition_speeds_rpm"], strict=True):
    value, low, high = (hersey.units.rpm(speed) for speed in speeds)
    print(f"transition: {value:.3g} rpm [{low:.3g}, {high:.3g}], in truth {true:.3g}")
print(*document.torque_budget.text, sep="\n")

FOLDER.mkdir(parents=True, exist_ok=True)
for name in ("damping", "torque_budget"):
    charts(document)[name].save(FOLDER / f"01_bench_{name}.png", scale_factor=2)
