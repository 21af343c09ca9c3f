"""The paper's figures drawn of a machine, a log and the paper's model; each claim judged.

Usage: python examples/08_paper_figures.py [FOLDER] [--machine TOML] [--log FILE [--tare standing]]
"""

import argparse
from pathlib import Path

import hersey
import paper

asked = argparse.ArgumentParser(description="Draw the paper's figures and judge its claims.")
asked.add_argument("folder", nargs="?", type=Path, default="build/paper", help="where to write them")
asked.add_argument("--machine", help="your machine file, for Figs. 1, 5, 6 and 8")
asked.add_argument("--log", help="your log, for Figs. 2, 3, 4, 7 and 8")
asked.add_argument("--tare", default="none", help="'standing' subtracts the torque at standstill")
given = asked.parse_args()

if given.machine is None and given.log is None:
    measured, machine = paper.shipped()
else:
    machine = hersey.read_machine(given.machine) if given.machine else None
    measured = None
    if given.log:
        points = hersey.read(given.log).steady(tare=given.tare)
        known = machine is not None and machine.rest is not None
        measured = paper.Measured.of(points.without(machine.rest) if known else points)

of_drive, left_out = paper.drive_figures(measured, machine)
figures = [*of_drive, *paper.all_figures()]
for figure in figures:
    print(figure.heading)
    for claim in figure.claims:
        print(f"  {claim.verdict.value}: {claim.statement} ({claim.evidence})")
print(*left_out, sep="\n")
written = paper.write(figures, given.folder, overwrite=True)
print(f"{len(written)} files in {given.folder}")
