"""Logs of others that cannot answer, and what is said instead: one speed, and no torque.

The data are read in place from ../shared/data/friction and are not part of this repository: one run of a
screw drive at constant speed (MIT licence), and a home-made Couette cell (GPLv3) that records a motor
current but no torque.

Usage: python examples/07_what_logs_cannot_tell.py [FOLDER]: the figure goes into FOLDER (build/examples).
"""

from __future__ import annotations

import sys
from pathlib import Path

import altair as alt

import hersey

DATA = Path(__file__).parents[2] / "shared" / "data" / "friction"
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "build/examples")

if not DATA.exists():
    sys.exit("skipped: the measurements are not beside the repository")

drive = DATA / "tro2021_screw_drives" / "driveNo1" / "steady_state"
one = drive / "100.csv"
log = hersey.read(one, units={"torque": "-9.84 mN*m / 100", "speed": "-1 rpm"}, isothermal=True)
try:
    print(hersey.fit(log.steady()).summary())
    sys.exit("a log at one speed was given an exponent")
except hersey.HerseyError as error:
    print(error)

for path in sorted((DATA / "couette_rheometer_pi").glob("*.csv")):
    try:
        hersey.read(path)
        sys.exit(f"{path.name} was given a torque")
    except hersey.HerseyError as error:
        print(error)

(run,) = log.runs
rows = [
    {"time": t, "torque": 1e3 * m}
    for t, m in zip(run.time[::20].tolist(), run.torque[::20].tolist(), strict=True)
]
chart = (
    alt.Chart(alt.Data(values=rows))
    .mark_line(color="#1f4e9c", strokeWidth=1)
    .encode(x=alt.X("time:Q", title="Time (s)"), y=alt.Y("torque:Q", title="Torque (mN m)"))
    .properties(width=640, height=240, title="One speed: no exponent can be had from this log")
)
FOLDER.mkdir(parents=True, exist_ok=True)
chart.save(FOLDER / "07_one_speed.png", scale_factor=2)
