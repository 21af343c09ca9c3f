"""The fitted drive for other tools: ``hersey export``."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hersey.cli.groups import argument, grouped, option
from hersey.cli.mistyped import machine_here, retyped
from hersey.cli.options import BristleDamping, BristleStiffness, Force, Start, finished_fit
from hersey.cli.outputs import NOT_FOUND, Output, may_write
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.quantities import target_of, temperature_of
from hersey.cli.terminal import note
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.surface import DampingSurface
    from hersey.exchange.trial import Trial
    from hersey.exchange.unit import ExportedUnit
    from hersey.lubrication.mixed_drag import MixedDrag
    from hersey.machine.machine import Machine
    from hersey.motion.belt import Drivetrain
    from hersey.motion.drag import Drag

_FILES = "Fit printed by 'hersey fit --machine TOML --json', if there is one, and the machine file."
_PORT = "Input of a speed drive: translational (m/s) or rotational (rad/s at the shaft)."
_DRIVE_SPEED = "Speed of the drive until the tool sets it, e.g. '30 mm/s'.  [default: 0]"
_TEMPERATURE = "Temperature until the tool sets it, e.g. '180 degC'."
_FMI = "Version of the interface: 3.0, or 2.0 for older tools."
_DRIVE = "Input that moves the drive: speed or torque."
_CLOSURE = "Motion below the stick speed: retained, stiction, stribeck or lugre."
_LIBRARY = "Library built for another platform, e.g. x86_64-windows=win/hersey.dll; repeatable."
_CLOSING = ("closure", "bristle_stiffness", "bristle_damping")
_CHECK = "Validate and run the unit with FMPy, and compare it with hersey, before writing."
export = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    help=(
        "Export the drive for Simulink, Amesim, Modelica and other tools.\n\n"
        "Example: [bold]hersey export fmu fit.json examples/machine.toml --temperature '180 degC' "
        "--out drive.fmu[/bold]\n\n"
        "The exported unit moves exactly as in hersey simulate. Write the fit with "
        "hersey fit LOG --machine TOML --json > fit.json. Without a fit, the drag is that of the contact "
        "model in \\[asperities] and \\[boundary] of the machine file."
    ),
)


@export.callback()
def _root() -> None:
    """Keep ``fmu`` a subcommand although there is only one."""


@dataclass(frozen=True)
class _Unit:
    """Inputs, start and contents of an exported unit."""

    fmi: Annotated[str, option(_FMI)] = "3.0"
    drive: Annotated[str, option(_DRIVE)] = "speed"
    port: Annotated[str, option(_PORT)] = "translational"
    drive_speed: Annotated[str, option(_DRIVE_SPEED)] = ""
    temperature: Annotated[str, option(_TEMPERATURE)] = ""
    start: Start = "rest"
    closure: Annotated[str, option(_CLOSURE)] = "retained"
    bristle_stiffness: BristleStiffness = None
    bristle_damping: BristleDamping = None
    name: Annotated[str, option("Name of the model in the tool.")] = "Sliding drive"
    library: Annotated[list[str] | None, option(_LIBRARY, metavar="PLATFORM=FILE")] = None

    def drag(self, surface: DampingSurface | None, machine: Machine, file: str) -> Drag | MixedDrag:
        """Return the drag of a fit, or of the contact model, with the closure of the options."""
        kelvin = temperature_of(self.temperature, "--temperature")
        closing: dict[str, Any] = {name: getattr(self, name) for name in _CLOSING}
        if surface is None:
            return replace(_contact(machine, file, kelvin), **closing)
        return replace(_fitted(surface, machine, file, kelvin), **closing)

    def settings(self, machine: Machine, drag: Drag | MixedDrag) -> dict[str, Any]:
        """Return the other arguments of `hersey.export_fmu`."""
        speed = target_of(self.drive_speed, machine, "--drive-speed") if self.drive_speed else 0.0
        kelvin = temperature_of(self.temperature, "--temperature") if drag.varies_with_temperature else None
        given = {name: getattr(self, name) for name in ("fmi", "drive", "port", "start", "name")}
        return given | {"drive_speed": speed, "temperature": kelvin, "roll_radius": machine.roll_radius}


@export.command("fmu")
@grouped
def fmu(
    files: Annotated[list[Path], argument("[JSON] TOML", _FILES)],
    *,
    out: Annotated[Path, option("Unit to write, .fmu.", metavar="FILE")],
    unit: _Unit,
    check: Annotated[bool, option(_CHECK, "--check")] = False,
    printing: Printing,
    force: Force = False,
) -> None:
    """Write a Functional Mock-up Unit for co-simulation, from a fit and a machine file.

    Example: [bold]hersey export fmu fit.json examples/machine.toml --temperature '180 degC'
    --out drive.fmu[/bold]

    The exit code is 1 if --check finds a difference; then nothing is written.
    """
    if unit.drive != "speed" and unit.drive_speed:
        raise ParameterError("--drive-speed needs --drive speed: omit it for a torque drive")
    others = _libraries(unit.library or [])
    if len(files) > 2:
        raise ParameterError(
            f"{len(files)} files are given: name a fit and a machine file, or only a machine file"
        )
    file = may_write(out, force, [*files, *others.values()], ends=[".fmu"])

    from hersey.machine.machine import read_machine

    *fits, machine_file = _in_order(files)
    machine = read_machine(machine_file)
    surface = finished_fit(fits[0], machine, machine_file) if fits else None
    drag = unit.drag(surface, machine, machine_file.name)
    # a torque acts on the roll itself: there is none beyond it that could slip
    train = machine.train if unit.drive == "speed" else replace(machine.train, grip=None)
    settings = unit.settings(machine, drag) | {"fitted": surface, "libraries": others}
    made, tried = _made(file, train, drag, settings, check)
    kept = tried is None or tried.ok
    if not printing.json(made.to_dict(), check=tried):
        if kept:
            printing.text(*_lines(made))
            printing.details("", made.summary())
        printing.text(*([] if tried is None else [tried.summary()]))
        printing.files(file.path if kept else None)
    if not kept:
        raise typer.Exit(NOT_FOUND)


def _in_order(files: list[Path]) -> list[Path]:
    """The fit, if there is one, and the machine file, whichever was typed first."""
    from hersey.document.saved_fit import holds_fit

    if len(files) == 2 and holds_fit(files[1]):
        return files[::-1]
    if len(files) == 1 and holds_fit(files[0]):
        machine = machine_here() or "machine.toml"
        at = sys.argv.index(str(files[0])) + 1 if str(files[0]) in sys.argv else len(sys.argv)
        raise ParameterError(
            f"{files[0]} is a saved fit, which needs a machine file too. "
            f"Type: {retyped(*sys.argv[1:at], machine, *sys.argv[at:])}"
        )
    return files


def _lines(made: ExportedUnit) -> list[str]:
    """The version of the unit, its inputs and outputs."""
    from hersey.cli.figures import labelled

    names = {
        kind: ", ".join(each.name for each in made.variables if each.causality == kind)
        for kind in ("input", "output")
    }
    head = f"FMI {made.fmi} unit for co-simulation on {', '.join(made.platforms)}."
    return [head, *labelled([("inputs", names["input"]), ("outputs", names["output"])])]


def _made(
    file: Output, train: Drivetrain, drag: Drag | MixedDrag, settings: dict[str, Any], check: bool
) -> tuple[ExportedUnit, Trial | None]:
    """The unit, and the result of the check if asked for; it is written unless that finds a difference."""
    from tempfile import TemporaryDirectory

    from hersey.exchange.unit import export_fmu

    tried = None
    with TemporaryDirectory() as folder:
        unit = export_fmu(Path(folder) / "drive.fmu", train, drag, **settings)
        if check:
            from hersey.exchange.trial import try_unit

            with working("comparing the unit with hersey"):
                tried = try_unit(unit, train, drag)
        if tried is None or tried.ok:
            file.write(unit.path.read_bytes())
    return replace(unit, path=file.path or unit.path), tried


def _libraries(given: list[str]) -> dict[str, Path]:
    """Libraries by platform."""
    files: dict[str, Path] = {}
    for text in given:
        platform, mark, file = text.partition("=")
        if not mark or not file:
            raise ParameterError(
                f"--library is '{text}': write PLATFORM=FILE, e.g. x86_64-windows=win/hersey.dll"
            )
        if platform in files:
            raise ParameterError(f"--library names {platform} twice: give one file for each platform")
        files[platform] = Path(file)
    return files


def _fitted(surface: DampingSurface, machine: Machine, file: str, temperature: float | None) -> Drag:
    """Drag of a fit; with a fixed stick speed, at one temperature."""
    from hersey.damping.surface import FIXED

    if surface.b is not None and temperature is None:
        raise ParameterError(
            "the fit depends on temperature: add that at the start, --temperature '180 degC'"
        )
    if surface.b is None and temperature is not None:
        raise ParameterError("the fit is isothermal: omit --temperature")
    at_one = temperature if machine.stick_speed_rule == FIXED else None
    if at_one is not None:
        note(f"{file} has a fixed stick speed, so the unit holds at this temperature only.")
    return surface.drag(**machine.belt, temperature=at_one)


def _contact(machine: Machine, file: str, temperature: float | None) -> MixedDrag:
    """Drag of the contact model of a machine file, if there is no fit."""
    if machine.mixed is None:
        raise ParameterError(
            f"{file} has no [asperities] and [boundary], so its drag is not known without a fit. Name a fit "
            "before it (hersey fit LOG --machine TOML --json > fit.json), or add both tables"
        )
    if temperature is None:
        raise ParameterError(
            "a contact model depends on temperature: add that at the start, --temperature '180 degC'"
        )
    return machine.mixed_drag(temperature)
