"""Two screw drives measured by others: one with a falling branch, one without.

The data (of a paper on dynamic modelling, IEEE Transactions on Robotics 37 (2021), MIT licence) are read in
place from ../shared/data/friction/tro2021_screw_drives and are not part of this repository. One file per
speed, torque in percent of 9.84 mN m, recorded signs opposite to the commanded ones.

The same from the command line, for one drive:

    hersey report FOLDER/*.csv --isothermal --rotation forward \
        --torque-unit "-9.84 mN*m / 100" --speed-unit "-1 rpm"

Usage: python examples/02_screw_drives.py [FOLDER]: the figures are written into FOLDER (build/examples).
"""

from __future__ import annotations

import sys
from pathlib import Path

import hersey
from hersey.charts.analysis import charts
from hersey.document.assembly import document_of
from hersey.files.writing import write_atomically
from hersey.report.page import render
from hersey.study import study

DATA = Path(__file__).parents[2] / "shared" / "data" / "friction" / "tro2021_screw_drives"
FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "build/examples")
UNITS = {"torque": "-9.84 mN*m / 100", "speed": "-1 rpm"}

if not DATA.exists():
    sys.exit("skipped: the measurements of the screw drives are not beside the repository")
FOLDER.mkdir(parents=True, exist_ok=True)
for drive in (1, 2):
    files = sorted((DATA / f"driveNo{drive}" / "steady_state").glob("*.csv"))
    log = hersey.read(files, units=UNITS, isothermal=True)
    points = log.steady(rotation="forward")
    document = document_of(study(points), command="python examples/02_screw_drives.py")
    print(f"drive {drive}: {document.regime.verdict}")
    if document.fit.no_transition:
        print(f"  no falling branch: {document.fit.no_transition}")
    charts(document)["torque"].save(FOLDER / f"02_screw_drive_{drive}_torque.png", scale_factor=2)
    write_atomically(FOLDER / f"02_screw_drive_{drive}.html", render(document), overwrite=True)
