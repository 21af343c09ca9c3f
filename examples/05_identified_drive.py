"""The drive behind the shipped synthetic stick-slip trace, identified and compared with its truth.

Usage: python examples/05_identified_drive.py [FOLDER]: the figure is written into FOLDER (build/examples).
"""

from __future__ import annotations

import sys
from pathlib import Path

from hersey.charts.cycles import trace_chart
from hersey.identification import cycles, identify
from hersey.identification.trace_file import read_trace

HERE = Path(__file__).parent
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "build/examples")

path = HERE / "stick-slip.csv"
truth = dict(part.split(" ") for part in path.read_text().split("SI: ")[1].split(";")[0].split(", "))
trace = read_trace(path)
record = cycles(trace.time, trace.value, drive_speed=0.02)
print(record.summary())
drive = identify(record)
print(f"\nclosure {drive.closure}, {'decided' if drive.decided else 'not decided'}")
for name, value in truth.items():
    print(f"{name}: {drive.estimates.get(name, 'not estimable from this record')}, in truth {float(value):g}")
for each in drive.warnings:
    print(f"- {each}")

FOLDER.mkdir(parents=True, exist_ok=True)
trace_chart(record, drive, unit="N").save(FOLDER / "05_identified_drive.png", scale_factor=2)
