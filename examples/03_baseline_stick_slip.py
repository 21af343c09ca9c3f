"""The paper's baseline: what it settles to, from below and from above, for several drive speeds.

Usage: python examples/03_baseline_stick_slip.py [FOLDER]: the figure is written into FOLDER (build/examples).
"""

from __future__ import annotations

import sys
from pathlib import Path

import altair as alt

import hersey

FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "build/examples")

drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
train = hersey.Drivetrain(stiffness=1000, mass=1)
for speed in (0.4, 1.0, 1.6, 1.9, 2.2):
    below = hersey.stick_slip(train, drag, drive_speed=speed)
    above = hersey.stick_slip(train, drag, drive_speed=speed, start="steady")
    found = f"{below.frequency:.6f} Hz, stuck {below.stuck_fraction:.1%}" if below.frequency else "smooth"
    print(f"drive {speed} in/s: from below {below.kind} ({found}); from above {above.kind}")

run = hersey.simulate(train, drag, drive_speed=1.0, duration=2.0)
rows = [
    {"time": t, "belt speed": v, "spring force": f}
    for t, v, f in zip(run.time.tolist(), run.belt_speed.tolist(), run.spring_force.tolist(), strict=True)
]
chart = (
    alt.Chart(alt.Data(values=rows))
    .mark_line(color="#1f4e9c")
    .encode(x=alt.X("time:Q", title="Time (s)"), y=alt.Y("belt speed:Q", title="Belt speed (in/s)"))
    .properties(width=640, height=240, title="Baseline of the paper (Fig. 9)")
)
FOLDER.mkdir(parents=True, exist_ok=True)
chart.save(FOLDER / "03_baseline.png", scale_factor=2)
