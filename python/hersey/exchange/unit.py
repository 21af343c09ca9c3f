"""A drive as a Functional Mock-up Unit: the core in a library, its drive file, and its description."""

from __future__ import annotations

import hashlib
import io
import uuid
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, cast

from hersey import _core
from hersey.arguments.door import Words
from hersey.arguments.frozen import explained
from hersey.damping.fitted_law import FittedLaw
from hersey.errors import ParameterError, printable
from hersey.exchange.description import Model, description
from hersey.exchange.documentation import LICENSE_TEXT, page
from hersey.exchange.drive_file import drive_text, drive_values
from hersey.exchange.platforms import own_library, platform_named, read_library, this_platform
from hersey.exchange.variables import Variable, variables_of
from hersey.files.writing import write_atomically
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag, PowersOfTemperature, Wire
from hersey.motion.simulation import TOLERANCE, simulate
from hersey.result import json_record
from hersey.units import celsius, rpm, takes_si

#: Versions of the Functional Mock-up Interface that the library speaks.
VERSIONS = ("3.0", "2.0")
#: The input of each kind of drive; of a speed it is that of the port.
DRIVES = {"speed": "drive_speed", "torque": "drive_torque"}
#: How a drive that is given a speed is coupled, and the input of each.
TRANSLATIONAL, ROTATIONAL = "translational", "rotational"
PORTS = {TRANSLATIONAL: "drive_speed", ROTATIONAL: "roll_speed"}
#: Time of a motion by which the numbers are tried before a unit is made of them, s.
_TRIAL = 1e-9
#: All files of a unit bear this time: the same input gives the same bits.
_TIME = (1980, 1, 1, 0, 0, 0)
_NONE: Mapping[str, str | Path] = MappingProxyType({})


@explained
@dataclass(frozen=True)
class ExportedUnit:
    """A written FMU: file, version, drive, start, token, platforms, variables and their start values.

    ``facts`` says what it was made from, by topic; ``port`` is the coupling of a speed-controlled drive.
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
    port: str = TRANSLATIONAL

    @property
    def drive_input(self) -> str:
        """Name of the input that moves the belt."""
        return PORTS[self.port] if self.drive == "speed" else DRIVES[self.drive]

    def summary(self) -> str:
        """Return inputs, outputs and origin of the FMU as text."""
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
        """Return the FMU and its variables, start values in SI."""
        rows = [
            {name: getattr(v, name) for name in ("reference", "name", "causality", "unit", "description")}
            | {"start": self.starts.get(v.name)}
            for v in self.variables
        ]
        own = ("fmi", "drive", "start", "token", "platforms", "facts")
        port = self.port if self.drive == "speed" else None
        return json_record(
            {"file": str(self.path), "port": port, **{n: getattr(self, n) for n in own}, "variables": rows}
        )


@takes_si(
    drive_speed="belt speed",
    drive_torque="torque",
    temperature="temperature",
    roll_radius="length",
    drive=Words(DRIVES),
    port=Words(PORTS),
    fmi=Words(VERSIONS),
)
def export_fmu(
    out: str | Path,
    train: Drivetrain,
    drag: AnyDrag,
    *,
    drive: str = "speed",
    port: str = TRANSLATIONAL,
    drive_speed: float = 0.0,
    drive_torque: float = 0.0,
    temperature: float | None = None,
    start: str | tuple[float, float] = "rest",
    roll_radius: float | None = None,
    fitted: FittedLaw | None = None,
    name: str = "Sliding drive",
    fmi: str = "3.0",
    libraries: Mapping[str, str | Path] = _NONE,
    tolerance: float = TOLERANCE,
    overwrite: bool = False,
) -> ExportedUnit:
    """Write a drive as a Functional Mock-up Unit (FMU) for co-simulation, and return its content.

    The same input gives the same bits. Variables, events and platforms: ``docs/reference/exchange.md``.

    Parameters
    ----------
    out
        File to write, ``.fmu``.
    train, drag
        As for `simulate`, in SI.
    drive
        ``speed`` (of the far end of the spring) or ``torque`` (on a roll that a spring holds to the ground).
    port
        For drive ``speed``. ``translational``: the input is the belt-side speed ``drive_speed``, m/s.
        ``rotational``: the input is the speed of the roll's shaft, ``roll_speed`` (rad/s), and the output
        ``reaction_torque`` (N m) brakes that shaft, so it can be coupled to a motor; needs ``roll_radius``.
    drive_speed, drive_torque, temperature
        Start values of the inputs, m/s, N m and K. If the drag depends on temperature, temperature is an
        input and must be given.
    start
        ``rest``, ``steady`` (sliding at the drive speed at the end of initialization), or a pair of belt
        speed and stretch.
    roll_radius
        Radius at which a torque acts, m. Needed for drive ``torque``, for a rotational port, and to check the
        speed range of ``fitted``.
    fitted
        Fit behind the drag. Its logs and data range are recorded, and the FMU warns outside that range. For a
        `MixedDrag` the range is the temperatures of its lubricant.
    name
        Name of the model in tools.
    fmi
        ``3.0``, or ``2.0`` for older tools.
    libraries
        Files of the library built for other platforms, by name (``x86_64-windows``, ``aarch64-darwin``).
    tolerance
        Relative tolerance of the steps.
    overwrite
        Whether a file of that name may be replaced.

    Raises
    ------
    ParameterError
        If a value is out of range, or a library is for another platform.
    MissingFileError
        If this installation has no library, or a named one does not exist.
    OutputError
        If the file exists, or cannot be written.
    """
    _refuse(out, name, drive, port, fmi, roll_radius)
    given = {"drive_speed": drive_speed, "drive_torque": drive_torque, "temperature": temperature}
    of_log = drag if isinstance(drag, PowersOfTemperature) else None
    drag = drag if of_log is None else cast("AnyDrag", of_log.unwarned())
    _try(train, drag, drive, given, start, roll_radius, tolerance)
    if of_log is not None:
        speed = drive_speed if drive == "speed" else None
        of_log.warned(temperature, stacklevel=3, drive_speed=speed)
    values = _values(train, drag, drive, port, given, start, roll_radius, tolerance)
    values |= _measured(drag, fitted, roll_radius)
    variables = _own(variables_of(own_library()), values, fmi)
    binaries, platforms = _binaries(libraries, fmi)
    facts = _facts(drag, fitted, roll_radius, drive, port)
    description_text = printable(
        " ".join([f"{name}, driven by a {drive}.", *(f"{k}: {v}." for k, v in facts.items())])
    )
    starts = {key: value for key, value in values.items() if isinstance(value, int | float)}
    model = Model(name, description_text, str(values["start"]), tolerance, starts)
    files = {
        "documentation/index.html": page(model, variables, facts, fmi).encode(),
        "documentation/licenses/license.txt": LICENSE_TEXT.encode(),
        **binaries,
    }
    token, contents = _contents(model, variables, fmi, values, facts, files)
    write_atomically(Path(out), _packed(contents), overwrite=overwrite)
    return ExportedUnit(
        Path(out), fmi, drive, str(values["start"]), token, platforms, variables, starts, facts, port
    )


def _contents(
    model: Model,
    variables: tuple[Variable, ...],
    fmi: str,
    values: Mapping[str, Wire],
    facts: Mapping[str, str],
    files: Mapping[str, bytes],
) -> tuple[str, dict[str, bytes]]:
    """The token of a unit, and its files with the two in which the token stands."""
    remarks = [f"{key}: {fact}" for key, fact in facts.items()]
    token = _token(
        [description(model, variables, fmi, ""), drive_text(values, remarks).encode(), *files.values()]
    )
    return token, {
        "modelDescription.xml": description(model, variables, fmi, token),
        "resources/drive.txt": drive_text({"format": "1", "token": token, **values}, remarks).encode(),
        **files,
    }


def _try(
    train: Drivetrain,
    drag: AnyDrag,
    drive: str,
    given: Mapping[str, float | None],
    start: str | tuple[float, float],
    roll_radius: float | None,
    tolerance: float,
) -> None:
    """Refuse what a motion cannot start with; ``given`` are the inputs in the units of the belt."""
    if drive == "torque" and start == "steady":
        raise ParameterError("start 'steady' needs drive 'speed'")
    temperature, torque = given["temperature"], given["drive_torque"]
    if temperature is not None and temperature <= drag.temperature_zero:
        raise ParameterError(
            f"temperature is {celsius(temperature):.6g} degC: the law needs temperatures above "
            f"{celsius(drag.temperature_zero):.6g} degC"
        )
    simulate(
        train,
        drag,
        drive_speed=given["drive_speed"] if drive == "speed" else None,
        drive_torque=torque / roll_radius
        if drive == "torque" and roll_radius and torque is not None
        else None,
        temperature=temperature,
        start=start,
        duration=_TRIAL,
        samples=2,
        tolerance=tolerance,
    )


def _refuse(out: str | Path, name: str, drive: str, port: str, fmi: str, roll_radius: float | None) -> None:
    """Refuse what no core is asked about."""
    choices = (("drive", drive, tuple(DRIVES)), ("port", port, tuple(PORTS)), ("fmi", fmi, VERSIONS))
    for said, value, known in choices:
        if value not in known:
            raise ParameterError(f"{said} is '{value}': it must be {' or '.join(known)}")
    if not (name.strip() and name.isprintable()):
        raise ParameterError(f"name is '{name}': it must be one line of visible characters")
    if Path(out).suffix != ".fmu":
        raise ParameterError(f"{out} is not the name of an FMU. Name a file that ends in .fmu")
    if drive == "torque" and roll_radius is None:
        raise ParameterError("drive 'torque' needs the roll_radius at which it acts")
    if port == ROTATIONAL and drive != "speed":
        raise ParameterError(
            "port 'rotational' needs drive 'speed', because a torque already acts on the shaft"
        )
    if port == ROTATIONAL and roll_radius is None:
        raise ParameterError("a rotational port needs the roll_radius")
    if roll_radius is not None and not 0 < roll_radius < float("inf"):
        raise ParameterError(f"roll_radius is {roll_radius}: it must be greater than 0")


def _values(
    train: Drivetrain,
    drag: AnyDrag,
    drive: str,
    port: str,
    given: Mapping[str, float | None],
    start: str | tuple[float, float],
    roll_radius: float | None,
    tolerance: float,
) -> dict[str, Wire]:
    """All that the library reads of the motion; ``given`` are the inputs in the units of the belt."""
    values = drive_values(train, drag) | {"drive": drive, "tolerance": tolerance}
    moved, rotates = given[DRIVES[drive]] or 0.0, drive == "speed" and port == ROTATIONAL
    if rotates and roll_radius is not None:
        values |= {"port": port, PORTS[port]: moved / roll_radius}
    else:
        values[DRIVES[drive]] = moved
    if roll_radius is not None and (rotates or drive == "torque"):
        values["roll_radius"] = roll_radius
    if (temperature := given["temperature"]) is not None:
        values["temperature"] = temperature
    if isinstance(start, str):
        return values | {"start": start}
    return values | {"start": "given", "start_belt_speed": start[0], "start_stretch": start[1]}


def _measured(drag: AnyDrag, fitted: FittedLaw | None, roll_radius: float | None) -> dict[str, Wire]:
    """Belt speeds and temperatures beyond which the library warns, as far as they are known."""
    found: dict[str, Wire] = {}
    if fitted is not None and roll_radius is not None:
        found["measured_speeds"] = [speed * roll_radius for speed in fitted.speed_range]
    temperatures = _measured_temperatures(drag, fitted)
    if temperatures is not None and drag.varies_with_temperature:
        found["measured_temperatures"] = list(temperatures)
    return found


def _measured_temperatures(drag: AnyDrag, fitted: FittedLaw | None) -> tuple[float, float] | None:
    """Temperatures at which the fit was measured, or the lubricant of a contact."""
    if fitted is not None:
        return fitted.temperature_range
    if isinstance(drag, MixedDrag) and len(drag.contact.lubricant.points) > 1:
        return drag.contact.lubricant.temperature_range
    return None


def _own(variables: tuple[Variable, ...], values: Mapping[str, Wire], fmi: str) -> tuple[Variable, ...]:
    """The variables that this drive has: of inputs and parameters those that it gives a value.

    Outputs of a port are those of this one; of a drive by a torque there is none. FMI 2.0 needs no time
    among them, and an importer of it finds fault with one.
    """
    always = ("output",) if fmi == "2.0" else ("independent", "output")
    port = values.get("port", TRANSLATIONAL) if values["drive"] == "speed" else ""
    computed = [v for v in variables if v.causality in always and v.port in ("", port)]
    return tuple(v for v in variables if v in computed or v.name in values)


def _binaries(libraries: Mapping[str, str | Path], fmi: str) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Paths in the unit with their content, and the platforms."""
    here = this_platform()
    files = {here.name: own_library()} | {name: Path(file) for name, file in libraries.items()}
    found: dict[str, bytes] = {}
    for name, file in files.items():
        where = (wanted := platform_named(name)).path(fmi)
        if where in found:
            raise ParameterError(
                f"FMI {fmi} keeps the libraries of both processors in {where}. Give one file with both"
            )
        found[where] = read_library(file, wanted, fmi)
    return found, tuple(files)


def _facts(
    drag: AnyDrag, fitted: FittedLaw | None, roll_radius: float | None, drive: str, port: str
) -> dict[str, str]:
    """What the unit was made of."""
    shaft = drive == "speed" and port == ROTATIONAL
    moved = "speed of the shaft" if shaft else f"{drive} of the drive"
    facts = {"Input": moved, "Made by": f"hersey {_core.VERSION}"}
    temperatures = _measured_temperatures(drag, fitted)
    if fitted is None:
        if isinstance(drag, MixedDrag):
            facts["Law"] = (
                f"mixed contact: film of {drag.contact.lubricant.name} and asperities share the load"
            )
            if temperatures is not None:
                facts["Viscosity known at"] = f"{_degrees(temperatures)}; extrapolated outside"
        return facts
    facts["Law"] = " ".join(fitted.headline().split())
    facts["Fitted by"] = f"hersey {fitted.version}"
    facts["Logs (SHA-256)"] = ", ".join(fitted.data_sha256) or "unknown"
    low, high = fitted.speed_range
    ranges = f"speeds of {rpm(low):.4g} to {rpm(high):.4g} rpm"
    if roll_radius is not None:
        ranges += f" ({1e3 * low * roll_radius:.4g} to {1e3 * high * roll_radius:.4g} mm/s where it slides)"
    if temperatures is not None:
        ranges += f" and {_degrees(temperatures)}"
    facts["Measured at"] = f"{ranges}; extrapolated outside"
    if fitted.rest is not None:
        facts["No-load torque"] = " ".join(fitted.rest.headline().split())
    return facts


def _degrees(temperatures: tuple[float, float]) -> str:
    cold, hot = map(celsius, temperatures)
    return f"{cold:.4g} to {hot:.4g} degC"


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
