"""Write what ships of the machine in machine.toml, from seeds: bench.csv, no-load.csv and bench-truth.json.

The virtual test stand makes the torque of three parts, and the truth holds all their numbers:

- film and contact share the load of ``[contact]``, with ``[lubricant]``, ``[asperities]`` and ``[boundary]``,
  as a full numerical solution has it (benchmarks/MIXED.md), not by the law that is fitted to the log;
- the no-load torque is what an engineer would expect of such a drive: two plain bearings of 4 mm radius
  that carry the 300 N at a friction of 0.1 (120 mN m), the loss of the rubber rolled over, 1 % of the load at
  15 mm (45 mN m), and the gears (15 mN m, and 1 mN m s/rad).

The no-load log is the rest alone: a free-running roll is pressed on in the place of belt and heater.

Usage: python examples/bench_drive.py [FOLDER]
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path

from hersey import testbench
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.machine.machine import read_machine

HERE = Path(__file__).parent
SEED, NO_LOAD_SEED = 2016, 2017
REST = NoLoadTorque.stated(constant="180 mN*m", per_speed="1 mN*m*s/rad")
#: A stand whose dwells repeat within 0.5 %, and whose torque sensor was zeroed.
STAND = testbench.Stand(repeatability=0.005, torque_offset=0.001)
#: Coarser in speed and time, and back to the first temperature at the end.
NO_LOAD = replace(
    STAND,
    temperatures_degC=(90.0, 180.0, 90.0, 180.0),
    speeds_rpm=(5.0, 10.0, 20.0, 45.0, 95.0, 140.0),
    sampling_interval=0.2,
    stick_slip=False,
)


def write(folder: Path) -> None:
    """Write the three files into a folder; the no-load log first, for the machine file reads it."""
    free = testbench.PhysicalTruth(None, REST)
    testbench.run(seed=NO_LOAD_SEED, truth=free, stand=NO_LOAD).write(folder / "no-load.csv")
    machine = read_machine(HERE / "machine.toml")
    stand = replace(
        STAND,
        roll_radius=machine.roll_radius,
        stiffness=machine.stiffness,
        mass=machine.mass,
        stick_speed=machine.stick_speed,
    )
    log = testbench.run(seed=SEED, truth=testbench.FullTruth(machine.mixed, REST), stand=stand)
    log.write(folder / "bench.csv")
    (folder / "bench-truth.json").write_text(json.dumps(log.truth_document(), indent=1) + "\n")


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    write(folder)
    for name in ("bench.csv", "no-load.csv", "bench-truth.json"):
        print(f"{folder / name}: {(folder / name).stat().st_size / 1e3:.0f} kB")
