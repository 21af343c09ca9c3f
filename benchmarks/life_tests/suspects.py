"""What the diagnostics alone say of many campaigns, with a mistake each or without: no file is written.

Dwells that take less than the constant no-load torque are missing, as hersey leaves them out.
"""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

import numpy as np

from benchmarks.life_tests import slips
from hersey.life.diagnostics.diagnosis import diagnosed
from hersey.life.diagnostics.measured import MeasuredRuns


def measured(runs: slips.Runs, least: float) -> MeasuredRuns:
    """Return the tables of runs as the diagnostics compare them; ``least`` is the torque without contact."""
    keys, dwells = sorted(runs), []
    for place, key in enumerate(keys):
        for line in runs[key].splitlines()[1:]:
            rpm, celsius, torque = (float(each) for each in line.split(",")[:3])
            if torque > least:
                dwells.append((place, rpm * math.pi / 30, celsius + 273.15, torque))
    place, speed, kelvin, torques = np.array(dwells).T
    return MeasuredRuns(
        tuple(range(1, len(keys) + 1)),
        tuple(unit for unit, _ in keys),
        np.array([float(age) for _, age in keys]),
        "pages",
        place.astype(np.intp),
        speed,
        kelvin,
        torques,
    )


def row(seed: int, *, slip: bool, number: int) -> dict[str, Any]:
    """Return what is said of the campaign of a seed, as `slips.row`."""
    one, runs, made = slips.made_of(seed, slip=slip, number=number)
    found = diagnosed(measured(runs, one.drive.rest[0]))
    said = [
        {"kind": each.kind, "values": {name: value for name, value in each.values.items() if name != "how"}}
        for each in found.warnings
    ]
    stated = {"seed": seed, "mechanism": one.mechanism.name, "slip": asdict(made) if made else None}
    return {**stated, "said": {"warnings": said}}
