"""Units of hersey in the importers and checkers of others: what each says, and its numbers beside the core's.

    python -m benchmarks.importers [--vdmcheck FOLDER]

Whatever is not installed is told and left out: `pip install ecospy tbb libcosimpy`, `cargo install fmi-sim`;
VDMCheck is built from its public sources (docs/reference/exchange.md); FOLDER has
VDMCheck2.sh or VDMCheck3.sh.
"""

from __future__ import annotations

import argparse
import csv
import ctypes
import importlib.metadata
import re
import shutil
import subprocess
import zipfile
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import hersey
from hersey.arrays import FloatArray

TRAIN = hersey.Drivetrain("11 N/mm", "11 kg")  # type: ignore[arg-type]
DRAG = hersey.Drag(
    14.0,
    0.025,
    ehl_exponent=-0.7,
    mixed_exponent=-1.2,
    stick_speed=3e-4,
    reference_temperature=405.0,
    temperature_zero=273.15,
    force_temperature_exponent=-0.3,
    speed_temperature_exponent=2.5,
)
DRIVE = {"drive_speed": 0.05, "temperature": 420.0}
#: Communication step in ms, and how many.
STEP, STEPS = 10, 60
COMPARED = ("belt_speed", "spring_force")


class AbsentError(Exception):
    """An importer that is not installed here."""


def unit(folder: Path, fmi: str) -> Path:
    """A unit that sticks and slips, with a temperature."""
    return hersey.export_fmu(folder / f"drive{fmi[0]}.fmu", TRAIN, DRAG, fmi=fmi, **DRIVE).path  # type: ignore[arg-type]


def core() -> FloatArray:
    """What the core makes of it: a row each step, from the first on."""
    run = hersey.simulate(TRAIN, DRAG, duration=STEP * STEPS / 1e3, samples=STEPS + 1, **DRIVE)  # type: ignore[arg-type]
    assert len(run.events) > 3
    return np.column_stack([getattr(run, name) for name in COMPARED])[1:]


def _imported(module: str) -> Any:
    try:
        return import_module(module)
    except (ImportError, OSError) as error:
        raise AbsentError(f"{module} is not installed: {error}") from None


def fmpy(path: Path) -> FloatArray:
    """FMPy, in Python."""
    got = _imported("fmpy").simulate_fmu(str(path), stop_time=STEP * STEPS / 1e3, output_interval=STEP / 1e3)
    return np.column_stack([got[name] for name in COMPARED])[1:]


def ecos(path: Path) -> FloatArray:
    """Ecos, in C++ with fmi4c."""
    for file in importlib.metadata.files("tbb") or [] if _has("tbb") else []:
        if file.name.startswith("libtbb.so.12") and not file.name.endswith("12.so"):
            ctypes.CDLL(str(file.locate()), mode=ctypes.RTLD_GLOBAL)
    ecospy = _imported("ecospy")
    structure = ecospy.EcosSimulationStructure()
    structure.add_model("drive", str(path))
    simulation = ecospy.EcosSimulation(structure=structure, step_size=STEP / 1e3)
    simulation.init()
    rows = []
    for _ in range(STEPS):
        simulation.step()
        rows.append([simulation.get_real(f"drive::{name}") for name in COMPARED])
    simulation.terminate()
    return np.array(rows)


def _has(name: str) -> bool:
    try:
        importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


def libcosim(path: Path) -> FloatArray:
    """libcosim, in C++ over the FMI Library, which checks descriptions of FMI 2.0."""
    execution = _imported("libcosimpy.CosimExecution").CosimExecution.from_step_size(STEP * 1_000_000)
    slave = import_module("libcosimpy.CosimSlave").CosimLocalSlave(fmu_path=str(path), instance_name="drive")
    index = execution.add_local_slave(slave)
    observer = import_module("libcosimpy.CosimObserver").CosimObserver.create_last_value()
    execution.add_observer(observer)
    with zipfile.ZipFile(path) as archive:
        text = archive.read("modelDescription.xml").decode()
    numbers = [int(re.findall(rf'name="{name}" valueReference="(\d+)"', text)[0]) for name in COMPARED]
    rows = []
    for i in range(1, STEPS + 1):
        execution.simulate_until(i * STEP * 1_000_000)
        rows.append(observer.last_real_values(index, numbers))
    return np.array(rows)


def fmi_sim(path: Path, *options: str) -> FloatArray:
    """The simulator fmi-sim, in Rust; of FMI 3.0 it reads no units, so that it gets a copy without."""
    if (command := shutil.which("fmi-sim")) is None:
        raise AbsentError("fmi-sim is not installed, or not on the path")
    with TemporaryDirectory() as folder:
        copy, out = Path(folder) / path.name, Path(folder) / "out.csv"
        _without_units(path, copy)
        step = str(STEP / 1e3)
        typed = [command, "--model", str(copy), "-o", str(out), "co-simulation", "--step", step]
        typed += ["--output-interval", step, "-f", str(STEP * STEPS / 1e3), *options]
        done = subprocess.run(typed, capture_output=True, text=True, check=False, timeout=60)
        if done.returncode:
            raise RuntimeError(f"fmi-sim: {(done.stderr or done.stdout).splitlines()[0]}")
        with out.open() as file:
            rows = {round(float(row["time"]) * 1e9): row for row in csv.DictReader(file)}
    at = [rows[i * STEP * 1_000_000] for i in range(1, STEPS + 1)]
    return np.array([[float(row[name]) for name in COMPARED] for row in at])


def fmi_sim_events(path: Path) -> FloatArray:
    """The same in event mode, with early return."""
    return fmi_sim(path, "--event-mode-used", "--early-return-allowed")


def _without_units(path: Path, copy: Path) -> None:
    with zipfile.ZipFile(path) as whole, zipfile.ZipFile(copy, "w") as bare:
        for name in whole.namelist():
            content = whole.read(name)
            if name == "modelDescription.xml" and b'fmiVersion="3' in content:
                content = re.sub(rb"<UnitDefinitions>.*?</UnitDefinitions>", b"", content, flags=re.S)
                content = re.sub(rb' (unit|displayUnit)="[^"]*"', b"", content)
            bare.writestr(name, content)


#: Importers with the versions that they run.
IMPORTERS: dict[str, tuple[Callable[[Path], FloatArray], tuple[str, ...]]] = {
    "FMPy": (fmpy, ("3.0", "2.0")),
    "Ecos": (ecos, ("3.0", "2.0")),
    "libcosim": (libcosim, ("2.0",)),
    "fmi-sim": (fmi_sim, ("3.0", "2.0")),
    "fmi-sim, event mode": (fmi_sim_events, ("3.0",)),
}


def difference(name: str, path: Path) -> float:
    """Greatest difference of an importer's numbers from the core's, as a share of the greatest value."""
    expected = core()
    got = IMPORTERS[name][0](path)
    return float(np.max(np.max(np.abs(got - expected), axis=0) / np.max(np.abs(expected), axis=0)))


def vdmcheck(folder: Path, path: Path, fmi: str) -> str:
    """What VDMCheck, rules of the standard in a language of specification, says of a unit."""
    script = folder / f"VDMCheck{fmi[0]}.sh"
    done = subprocess.run(["bash", str(script), str(path)], capture_output=True, text=True, check=False)
    return " ".join(done.stdout.split())


def main() -> None:
    """Print what each says."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--vdmcheck", type=Path, action="append", default=[])
    folders = parser.parse_args().vdmcheck
    with TemporaryDirectory() as home:
        units = {fmi: unit(Path(home), fmi) for fmi in ("3.0", "2.0")}
        for fmi, path in units.items():
            problems = import_module("fmpy.validation").validate_fmu(str(path))
            print(f"FMPy's validation, FMI {fmi}: {problems or 'nothing found'}")
            for folder in folders:
                if (folder / f"VDMCheck{fmi[0]}.sh").exists():
                    print(f"VDMCheck, FMI {fmi}: {vdmcheck(folder, path, fmi)}")
        for name, (_, versions) in IMPORTERS.items():
            for fmi in versions:
                try:
                    print(f"{name}, FMI {fmi}: differs by {difference(name, units[fmi]):.1e} from the core")
                except AbsentError as absent:
                    print(f"{name}, FMI {fmi}: left out, {absent}")


if __name__ == "__main__":
    main()
