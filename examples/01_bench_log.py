"""Fit the shipped log of the virtual test stand and compare with its truth.

Usage: python examples/01_bench_log.py [FOLDER]: the figure is written into FOLDER (build/examples).
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import hersey
from hersey.charts.analysis import charts
from hersey.document.assembly import analyse

HERE = Path(__file__).parent
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "build/examples")

log = hersey.read(HERE / "bench.csv")
points = log.steady(tare="standing")
surface = hersey.fit(points)
truth = json.loads((HERE / "bench-truth.json").read_text())["truth"]

print(hersey.regime(points, surface).verdict)
for name, estimate in (("a", surface.a), ("b", surface.b), ("c", surface.c)):
    print(f"{name}: {estimate}, in truth {truth[name]}")

FOLDER.mkdir(parents=True, exist_ok=True)
charts(analyse(log, points))["damping"].save(FOLDER / "01_bench_damping.png", scale_factor=2)
