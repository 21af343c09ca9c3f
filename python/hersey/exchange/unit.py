"""A drive as a Functional Mock-up Unit: the core in a library, what it is told, what tools are told."""

from __future__ import annotations

import hashlib
import io
import uuid
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hersey import _core
from hersey.damping.fitted_law import FittedLaw
from hersey.errors import ParameterError
from hersey.exchange.description import Model, description
from hersey.exchange.documentation import LICENSE_TEXT, page
from hersey.exchange.drive_file import Value, drive_text, drive_values
from hersey.exchange.platforms import own_library, platform_named, read_library, this_platform
from hersey.exchange.variables import Variable, variables_of
from hersey.files.writing import write_atomically
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.motion.simulation import TOLERANCE, simulate
from hersey.result import json_record
from hersey.spelling import printable
from hersey.units import celsius, rpm, takes_si

#: Versions of the Functional Mock-up Interface that the library speaks.
VERSIONS = ("3.0", "2.0")
#: The input of each kind of drive.
DRIVES = {"speed": "drive_speed", "torque": "drive_torque"}
#: Time of a motion by which the numbers are tried before a unit is made of them, s.
_TRIAL = 1e-9
#: All files of a unit bear this time: the same input gives the same bits.
_TIME = (1980, 1, 1, 0, 0, 0)
_NONE: Mapping[str, str | Path] = MappingProxyType({})


@dataclass(frozen=True)
class ExportedUnit:
    """A unit that was written: file, version, drive, start, token, platforms, variables and their starts.

    ``facts`` say what it was made of, by what they are about.
    """

    path: Path
    fmi: str
    drive: str
    start: str
    token: str
    platforms: tuple[str, ...]
    variables: tuple[Variable, ...]
    starts: Mapping[str, float]
    facts: Mapping[str, str]

    def summary(self) -> str:
        """Return the unit in words: what it takes, gives and is made of."""
        names = {
            kind: ", ".join(v.name for v in self.variables if v.causality == kind)
            for kind in ("input", "output")
        }
        return "\n".join(
            [
                f"{self.path.name}: FMI {self.fmi} for co-simulation, {', '.join(self.platforms)}",
                f"  inputs   {names['input']}",
                f"  outputs  {names['output']}",
                *(f"- {name}: {fact}" for name, fact in self.facts.items()),
            ]
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the unit, its variables with their starts in SI."""
        rows = [
            {name: getattr(v, name) for name in ("reference", "name", "causality", "unit", "description")}
            | {"start": self.starts.get(v.name)}
            for v in self.variables
        ]
        own = ("fmi", "drive", "start", "token", "platforms", "facts")
        return json_record({"file": str(self.path), **{n: getattr(self, n) for n in own}, "variables": rows})


@takes_si(drive_speed="belt speed", drive_torque="torque", temperature="temperature", roll_radius="length")
def export_fmu(
    out: str | Path,
    train: Drivetrain,
    drag: AnyDrag,
    *,
    drive: str = "speed",
    drive_speed: float = 0.0,
    drive_torque: float = 0.0,
    temperature: float | None = None,
    start: str | tuple[float, float] = "rest",
    roll_radius: float | None = None,
    fitted: FittedLaw | None = None,
    name: str = "Belt drive",
    fmi: str = "3.0",
    libraries: Mapping[str, str | Path] = _NONE,
    tolerance: float = TOLERANCE,
    overwrite: bool = False,
) -> ExportedUnit:
    """Write a drive as a Functional Mock-up Unit for co-simulation, and return what is in it.

    The same input gives the same bits. See ``docs/exchange.md`` for its variables, events and platforms.

    Parameters
    ----------
    out
        File to write, ``.fmu``.
    train, drag
        As of `simulate`, in SI.
    drive
        ``speed``: of the far end of the spring, or ``torque``: on a roll that a spring holds to the ground.
    drive_speed, drive_torque, temperature
        Values of the inputs until the tool gives others, m/s, N m and K; a temperature is needed, and an
        input, where the drag varies with it.
    start
        ``rest``, ``steady`` (sliding with the drive as it is when the initialization ends), or a pair of belt
        speed and stretch.
    roll_radius
        m, at which a torque acts; needed for that drive.
    fitted
        The fit that the drag is of: its logs and the range of its data are written down.
    name
        Of the model, as tools show it.
    fmi
        ``3.0``, or ``2.0`` for older tools.
    libraries
        Files of the library built for other platforms, by name (``x86_64-windows``, ``aarch64-darwin``).
    tolerance
        Relative, of the steps.
    overwrite
        Whether a file of that name may be replaced.

    Raises
    ------
    ParameterError
        If a value is out of range, or a library is not of its platform.
    MissingFileError
        If this install has no library, or one that is named is not there.
    OutputError
        If the file exists, or cannot be written.
    """
    _refuse(out, name, drive, fmi, roll_radius)
    if drive == "torque" and start == "steady":
        raise ParameterError("start 'steady' goes with drive 'speed'")
    if temperature is not None and temperature <= drag.temperature_zero:
        raise ParameterError(
            f"temperature is {celsius(temperature):.6g} degC: the law holds above "
            f"{celsius(drag.temperature_zero):.6g} degC"
        )
    simulate(
        train,
        drag,
        drive_speed=drive_speed if drive == "speed" else None,
        drive_torque=drive_torque / roll_radius if drive == "torque" and roll_radius else None,
        temperature=temperature,
        start=start,
        duration=_TRIAL,
        samples=2,
        tolerance=tolerance,
    )
    values = _values(
        train, drag, drive, (drive_speed, drive_torque), temperature, start, roll_radius, tolerance
    )
    variables = _own(variables_of(own_library()), values, fmi)
    binaries, platforms = _binaries(libraries, fmi)
    facts = _facts(fitted, roll_radius, drive)
    told = printable(" ".join([f"{name}, driven by a {drive}.", *(f"{k}: {v}." for k, v in facts.items())]))
    starts = {key: value for key, value in values.items() if isinstance(value, int | float)}
    model = Model(name, told, str(values["start"]), tolerance, starts)
    contents = {
        "documentation/index.html": page(model, variables, facts, fmi).encode(),
        "documentation/licenses/license.txt": LICENSE_TEXT.encode(),
        **binaries,
    }
    remarks = [f"{key}: {fact}" for key, fact in facts.items()]
    token = _token(
        [description(model, variables, fmi, ""), drive_text(values, remarks).encode(), *contents.values()]
    )
    contents = {
        "modelDescription.xml": description(model, variables, fmi, token),
        "resources/drive.txt": drive_text({"format": "1", "token": token, **values}, remarks).encode(),
    } | contents
    write_atomically(Path(out), _packed(contents), overwrite=overwrite)
    return ExportedUnit(
        Path(out), fmi, drive, str(values["start"]), token, platforms, variables, starts, facts
    )


def _refuse(out: str | Path, name: str, drive: str, fmi: str, roll_radius: float | None) -> None:
    """Refuse what no core is asked about."""
    for said, value, known in (("drive", drive, tuple(DRIVES)), ("fmi", fmi, VERSIONS)):
        if value not in known:
            raise ParameterError(f"{said} is '{value}': it must be {' or '.join(known)}")
    if not (name.strip() and name.isprintable()):
        raise ParameterError(f"name is '{name}': it must be a line of visible characters")
    if Path(out).suffix != ".fmu":
        raise ParameterError(f"{out}: name a file that ends in .fmu")
    if drive == "torque" and roll_radius is None:
        raise ParameterError("a drive by a torque needs the roll_radius at which it acts")
    if roll_radius is not None and not 0 < roll_radius < float("inf"):
        raise ParameterError(f"roll_radius is {roll_radius}: it must be greater than 0")


def _values(
    train: Drivetrain,
    drag: AnyDrag,
    drive: str,
    inputs: tuple[float, float],
    temperature: float | None,
    start: str | tuple[float, float],
    roll_radius: float | None,
    tolerance: float,
) -> dict[str, Value]:
    """All that the library is told."""
    values = drive_values(train, drag)
    values |= {"drive": drive, DRIVES[drive]: inputs[drive == "torque"], "tolerance": tolerance}
    if drive == "torque" and roll_radius is not None:
        values["roll_radius"] = roll_radius
    if temperature is not None:
        values["temperature"] = temperature
    if isinstance(start, str):
        return values | {"start": start}
    return values | {"start": "given", "start_belt_speed": start[0], "start_stretch": start[1]}


def _own(variables: tuple[Variable, ...], values: Mapping[str, Value], fmi: str) -> tuple[Variable, ...]:
    """The variables that this drive has: of inputs and parameters those that it gives a value.

    FMI 2.0 needs no time among them, and an importer of it finds fault with one.
    """
    always = ("output",) if fmi == "2.0" else ("independent", "output")
    return tuple(v for v in variables if v.causality in always or v.name in values)


def _binaries(libraries: Mapping[str, str | Path], fmi: str) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Paths in the unit with their content, and the platforms."""
    here = this_platform()
    files = {here.name: own_library()} | {name: Path(file) for name, file in libraries.items()}
    found: dict[str, bytes] = {}
    for name, file in files.items():
        where = (wanted := platform_named(name)).path(fmi)
        if where in found:
            raise ParameterError(
                f"FMI {fmi} keeps the libraries of both processors in {where}: give one file that holds both"
            )
        found[where] = read_library(file, wanted, fmi)
    return found, tuple(files)


def _facts(fitted: FittedLaw | None, roll_radius: float | None, drive: str) -> dict[str, str]:
    """What the unit was made of."""
    facts = {"Input": f"{drive} of the drive", "Made by": f"hersey {_core.VERSION}"}
    if fitted is None:
        return facts
    facts["Law"] = " ".join(fitted.headline().split())
    facts["Fitted by"] = f"hersey {fitted.version}"
    facts["Logs (SHA-256)"] = ", ".join(fitted.data_sha256) or "not known"
    low, high = fitted.speed_range
    ranges = f"roll speeds of {rpm(low):.4g} to {rpm(high):.4g} rpm"
    if roll_radius is not None:
        ranges += f" ({1e3 * low * roll_radius:.4g} to {1e3 * high * roll_radius:.4g} mm/s at the belt)"
    if fitted.temperature_range is not None:
        cold, hot = map(celsius, fitted.temperature_range)
        ranges += f" and {cold:.4g} to {hot:.4g} degC"
    facts["Measured at"] = f"{ranges}; beyond, the law is extrapolated"
    if fitted.rest is not None:
        facts["Beside it"] = " ".join(fitted.rest.headline().split())
    return facts


def _token(parts: list[bytes]) -> str:
    """A name that is that of the content."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(len(part).to_bytes(8, "big") + part)
    return f"{{{uuid.UUID(bytes=digest.digest()[:16])}}}"


def _packed(contents: Mapping[str, bytes]) -> bytes:
    """The files as an archive, the description first."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, content in contents.items():
            entry = zipfile.ZipInfo(name, _TIME)
            entry.create_system = 3  # so that rights are kept, whatever system packs it
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    return packed.getvalue()
