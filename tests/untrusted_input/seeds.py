"""One sound file of every reader, small enough that a damaged byte often hits what matters.

The numbers are the same in all: torque 1 to 1.1 N m, speed 60 to 61 rpm, temperature 150 degC, over 0.59 s.
"""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.untrusted_input.mdf_blocks import Channel, formula, mdf3, mf4
from tests.untrusted_input.other_blocks import lvm, mat4, mat5, matrix, tdms, xlsx

ROWS = 60
TIME = np.arange(ROWS) * 0.01
TORQUE = 1.0 + 0.1 * np.arange(ROWS) / ROWS
SPEED = 60.0 + np.arange(ROWS) / ROWS
TEMPERATURE = 150.0 + 0.5 * TIME
TABLE = (("Torque", "N*m", TORQUE), ("Speed", "rpm", SPEED), ("Temp", "degC", TEMPERATURE))
COLUMNS = {"t_s": TIME, "torque_Nm": TORQUE, "speed_rpm": SPEED, "temp_degC": TEMPERATURE}

MACHINE = """[drivetrain]
stiffness = "11 N/mm"
mass = "11 kg"
roll_radius = "15 mm"
stick_speed = "0.3 mm/s"
[limits]
motor_torque = "8 N*m"
roll_friction = 0.6
nip_load = "300 N"
[contact]
rubber_thickness = "3.5 mm"
modulus = "1 MPa"
poisson_ratio = 0.48
length = "220 mm"
roughness = "1.5 um"
[lubricant]
name = "invented"
model = "walther"
viscosities = [["40 degC", "500 mm^2/s"], ["100 degC", "47 mm^2/s"]]
density = "1.9 g/cm^3"
[uncertainty]
stiffness = "10 %"
[[points]]
name = "full speed"
speed = "120 mm/s"
temperature = "180 degC"
"""
MAPPING = """[torque]
channel = "Torque"
unit = "N*m"
sign = -1
tare = "4 mN*m"
gear_ratio = 12.5
efficiency = 0.9
[speed]
channel = "Speed"
unit = "rpm"
[temperature]
offset = "-1.5 K"
"""
SCENARIO = """[parameters]
stiffness = { from = "2 N/mm", to = "40 N/mm", count = 4, spacing = "log" }
mass = "1 kg"
transition_force = ["10 N", "20 N"]
transition_speed = "25 mm/s"
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = "0.3 mm/s"
drive_speed = { from = "5 mm/s", to = "80 mm/s", count = 4 }
[options]
closure = "retained"
start = "rest"
"""


def csv(separator: str = ",", decimal: str = ".", *, head: str = "", foot: str = "") -> str:
    lines = [separator.join(["Time [s]", "Torque [N*m]", "Speed [rpm]", "Temp [degC]"])]
    for row in zip(*COLUMNS.values(), strict=True):
        lines.append(separator.join(f"{number:.6f}".replace(".", decimal) for number in row))
    return head + "\n".join(lines) + "\n" + foot


def stamped() -> str:
    lines = ["Time;Torque [N*m];Speed [rpm];Temp [degC]"]
    for i in range(ROWS):
        stamp = f"2024-03-01T08:{i // 60:02}:{i % 60:02}.5"
        lines.append(f"{stamp};{TORQUE[i]:.6f};{SPEED[i]:.6f};{TEMPERATURE[i]:.6f}")
    return "\n".join(lines) + "\n"


def mf4_file() -> bytes:
    raw = np.arange(ROWS, dtype="<u2")
    return mf4(
        [
            Channel("t", TIME, "s", kind=2),
            Channel("Torque", raw, "N*m", formula(f"1 + 0.1 * X / {ROWS}")),
            Channel("Speed", SPEED, "rpm"),
            Channel("Temp", TEMPERATURE, "degC"),
        ],
        comment="<HDcomment><TX>rig 3</TX></HDcomment>",
    )


def mf4_packed() -> bytes:
    channels = [Channel("t", TIME, "s", kind=2), *(Channel(n, v, u) for n, u, v in TABLE)]
    return mf4(channels, packed_length=4 * 8 * ROWS)


def mdf3_file() -> bytes:
    raw = np.arange(ROWS, dtype="<u2")
    return mdf3(
        [
            ("t", "s", TIME, None),
            ("Torque", "N*m", raw, f"1+0.1*X1/{ROWS}".encode()),
            ("Speed", "rpm", SPEED, None),
            ("Temp", "degC", TEMPERATURE, None),
        ]
    )


def hdf5(*, packed: bool = False, userblock: int = 0) -> bytes:
    import h5py

    memory = io.BytesIO()
    with h5py.File(memory, "w", userblock_size=userblock, track_order=False) as file:
        for name, values in COLUMNS.items():
            kept = {"chunks": (16,), "compression": "gzip", "shuffle": True} if packed else {}
            made = file.create_dataset(f"run/{name}", data=values, track_times=False, **kept)
            made.attrs["MATLAB_class" if userblock else "units"] = np.bytes_(
                "double" if userblock else name.partition("_")[2].replace("Nm", "N*m")
            )
    content = bytearray(memory.getvalue())
    if userblock:
        content[:128] = b"MATLAB 7.3 MAT-file, by a stranger".ljust(116) + bytes(8) + b"\x00\x02IM"
    return bytes(content)


def parquet(compression: str = "uncompressed") -> bytes:
    import polars

    memory = io.BytesIO()
    names = dict(zip(COLUMNS, ("Time [s]", "Torque [N*m]", "Speed [rpm]", "Temp [degC]"), strict=True))
    polars.DataFrame({names[key]: values for key, values in COLUMNS.items()}).write_parquet(
        memory, compression=compression
    )
    return memory.getvalue()


def workbook() -> bytes:
    head = ["Time [s]", "Torque [N*m]", "Speed [rpm]", "Temp [degC]"]
    rows = [list(row) for row in zip(*(values.tolist() for values in COLUMNS.values()), strict=True)]
    return xlsx({"Notes": [["Operator", "me"]], "Run": [["Rig 3"], head, *rows]})


def npz(*, packed: bool = False) -> bytes:
    memory = io.BytesIO()
    (np.savez_compressed if packed else np.savez)(memory, allow_pickle=False, **COLUMNS)
    return memory.getvalue()


def profile() -> bytes:
    return b"Time [s],Temperature [degC]\n" + b"".join(b"%d,%d\n" % (i, 150 + i) for i in range(20))


def fit() -> bytes:
    """A fit of the shipped log as the command prints it."""
    examples = Path(__file__).parents[2] / "examples"
    command = [sys.executable, "-m", "hersey.cli", "fit", "bench.csv", "--tare", "standing", "--json"]
    return subprocess.run(command, cwd=examples, check=True, capture_output=True).stdout


#: How a sound file is made, by its name, which tells the reader too.
SEEDS: dict[str, Callable[[], bytes]] = {
    "comma.csv": lambda: csv().encode(),
    "semicolon.csv": lambda: csv(";", ",", head="# rig 3\nDevice: X\n", foot="\nMax;1,1\n").encode("cp1252"),
    "quoted.csv": lambda: "\n".join(
        line if i == 0 else ",".join(f'"{cell}"' for cell in line.split(","))
        for i, line in enumerate(csv().splitlines())
    ).encode(),
    "tab.txt": lambda: csv("\t").encode("utf-16"),
    "stamps.csv": lambda: stamped().encode("utf-8-sig"),
    "run.lvm": lambda: lvm(TABLE),
    "run.tdms": lambda: tdms(TABLE),
    "run.mf4": mf4_file,
    "packed.mf4": mf4_packed,
    "run.mdf": mdf3_file,
    "v4.mat": lambda: mat4(COLUMNS),
    "v5.mat": lambda: mat5([matrix(name, values) for name, values in COLUMNS.items()]),
    "packed.mat": lambda: mat5([matrix(n, v) for n, v in COLUMNS.items()], packed=True),
    "v73.mat": lambda: hdf5(userblock=512),
    "run.h5": hdf5,
    "packed.h5": lambda: hdf5(packed=True),
    "run.parquet": parquet,
    "packed.parquet": lambda: parquet("zstd"),
    "run.xlsx": workbook,
    "run.npz": npz,
    "packed.npz": lambda: npz(packed=True),
    "blanks.txt": lambda: csv("   ").replace("Time [s]", "Time[s]").encode(),
    "machine.toml": lambda: MACHINE.encode(),
    "log.mapping.toml": lambda: MAPPING.encode(),
    "scenario.toml": lambda: SCENARIO.encode(),
    "profile.csv": profile,
    "fit.json": fit,
}
