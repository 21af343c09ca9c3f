"""Write the campaign that ships in life/: eight virtual units of the machine in machine.toml, which age.

Each is followed over 170,000 pages, about 60 % of the life of the middle unit. What they end by, in truth:
most reach the torque of the motor cold and fast, some starve of oil before, and one wears into stick-slip at
the speed of thick paper. ``life/truth.json`` holds every number and every age at which a limit is reached;
``life/runs.csv`` names the tables of means, unit and age. The no-load torque is that of bench_drive.py.

Usage: python examples/life_units.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

from hersey.damping.no_load_torque import NoLoadTorque
from hersey.machine.machine import read_machine
from hersey.testbench import VirtualCampaign, population

HERE = Path(__file__).parent
#: One of a few seeds tried, in which units end in three ways.
SEED = 3
AGES = (0.0, 35e3, 70e3, 105e3, 140e3, 170e3)
REST = NoLoadTorque.stated(constant="180 mN*m", per_speed="1 mN*m*s/rad")


def campaign() -> VirtualCampaign:
    """Return the campaign that ships."""
    units = population(read_machine(HERE / "machine.toml"), REST, units=8, seed=SEED)
    return VirtualCampaign(units, AGES, SEED)


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "life"
    folder.mkdir(exist_ok=True)
    files = campaign().files()
    for name, text in files.items():
        (folder / name).write_text(text)
    print(f"{folder}: {len(files)} files, {sum(map(len, files.values())) / 1e3:.0f} kB")
