"""A slider pulled through a spring at three speeds, measured by others: stick-slip turns into oscillation.

The data (Colas et al., Phys. Rev. E 2019, CeCILL-B licence) are read in place from ../shared/data/stick-slip
and are not part of this repository: 30.7 g pulled through 1002 N/m, force as a share of the weight, 2 kHz.
Known results: 477 slips, period 0.72 s, at 42 um/s; 206, 0.0555 s, at 1100; 130, 0.0285 s, at 4300, where
the period nears 2 pi sqrt(m/k) = 0.0348 s; loading slope at 42 um/s 0.1393 per s, where k v/(m g) is 0.1397.

Slips have all sizes, so the count depends on the least fall that is counted: the known results hold for 0.05
of the weight; the record itself shows all that are beyond its noise.

Usage: python examples/06_pulled_slider.py [FOLDER]: the figures are written into FOLDER (build/examples).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from hersey.charts.cycles import trace_chart
from hersey.identification import cycles
from hersey.identification.trace_file import read_trace

DATA = Path(__file__).parents[2] / "shared" / "data" / "stick-slip"
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "build/examples")
KNOWN = {42: (477, 0.72), 1100: (206, 0.0555), 4300: (130, 0.0285)}

if not DATA.exists():
    sys.exit("skipped: the measurements of the slider are not beside the repository")
FOLDER.mkdir(parents=True, exist_ok=True)
for speed, (slips, period) in KNOWN.items():
    trace = read_trace(DATA / f"k1002Nm_v{speed}.mat", time_unit="s", unit="1")
    everything = cycles(trace.time, trace.value, drive_speed=speed * 1e-6)
    record = cycles(trace.time, trace.value, drive_speed=speed * 1e-6, least_drop=0.05)
    kind = record.kind.replace("_", " ")
    print(f"{speed} um/s: {kind}, loading slope {record.loading_slope:.4g} per s")
    print(f"  {record.slips} slips of at least 0.05 (known {slips}), {everything.slips} beyond noise")
    print(f"  period {np.median(record.period):.4g} s (known {period:g} s)")
    chart = trace_chart(record, unit="share of the weight")
    chart.save(FOLDER / f"06_pulled_slider_{speed}.png", scale_factor=2)
