"""The fitted drive for other tools: ``hersey export``."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, BristleDamping, BristleStiffness, Force, Start, finished_fit
from hersey.cli.outputs import NOT_FOUND, Output, may_write, print_json
from hersey.cli.progress import working
from hersey.cli.quantities import target_of, temperature_of
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.surface import DampingSurface
    from hersey.exchange.trial import Trial
    from hersey.exchange.unit import ExportedUnit
    from hersey.lubrication.mixed_drag import MixedDrag
    from hersey.machine.machine import Machine
    from hersey.motion.belt import Drivetrain
    from hersey.motion.drag import Drag

_FILES = (
    "Fit that hersey fit --machine --json printed, then the machine file. The machine file alone exports its "
    "mixed contact."
)
_PORT = (
    "Coupling of a drive by speed: translational (m/s in), or rotational (shaft speed in rad/s in, reaction "
    "torque in N*m out)."
)
_DRIVE_SPEED = "Speed of the drive until the tool gives another, as '30 mm/s'.  [default: 0]"
_CLOSURE = "What happens below the stick speed: retained, stiction, stribeck or lugre."
_LIBRARY = "The library built for another platform, as x86_64-windows=win/hersey.dll; again for each."
_CLOSING = ("closure", "bristle_stiffness", "bristle_damping")
_CHECK = "Have FMPy validate the unit and run it beside the core, before it is kept."
export = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    help=(
        "Write the fitted drive for other tools: a unit that Simulink, Amesim or Modelica run.\n\n"
        "Example: [bold]hersey export fmu fit.json examples/machine.toml --temperature '180 degC' "
        "--out drive.fmu[/bold]\n\n"
        "The unit contains the core itself, so its motion is that of hersey simulate. Write the fit with "
        "hersey fit LOG --machine TOML --json > fit.json. Without a fit, drag is that of the mixed contact "
        "that \\[asperities] and \\[boundary] of the machine file describe."
    ),
)


@export.callback()
def _root() -> None:
    """Keep the verb of a verb, though there is one alone."""


@dataclass(frozen=True)
class _Unit:
    """What a unit takes and gives, how it starts and what it consists of."""

    fmi: Annotated[str, option("3.0, or 2.0 for older tools.")] = "3.0"
    drive: Annotated[str, option("What moves the drive, an input: speed, or torque.")] = "speed"
    port: Annotated[str, option(_PORT)] = "translational"
    drive_speed: Annotated[str, option(_DRIVE_SPEED)] = ""
    temperature: Annotated[str, option("Temperature until the tool gives another, as '180 degC'.")] = ""
    start: Start = "rest"
    closure: Annotated[str, option(_CLOSURE)] = "retained"
    bristle_stiffness: BristleStiffness = None
    bristle_damping: BristleDamping = None
    name: Annotated[str, option("Name of the model, as tools show it.")] = "Belt drive"
    library: Annotated[list[str] | None, option(_LIBRARY, metavar="PLATFORM=FILE")] = None

    def drag(self, surface: DampingSurface | None, machine: Machine, file: str) -> Drag | MixedDrag:
        """Return the drag of a fit, or of the machine's contact, closed as the options say."""
        kelvin = temperature_of(self.temperature, "--temperature")
        closing: dict[str, Any] = {name: getattr(self, name) for name in _CLOSING}
        if surface is None:
            return replace(_contact(machine, file, kelvin), **closing)
        return replace(_fitted(surface, machine, file, kelvin), **closing)

    def settings(self, machine: Machine, drag: Drag | MixedDrag) -> dict[str, Any]:
        """Return what `hersey.export_fmu` takes beside belt and drag."""
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
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Write a Functional Mock-up Unit for co-simulation, from a fit and a machine file.

    Example: [bold]hersey export fmu fit.json examples/machine.toml --temperature '180 degC'
    --out drive.fmu[/bold]

    Exit code 1 says that --check found something; then nothing is written.
    """
    if unit.drive != "speed" and unit.drive_speed:
        raise ParameterError("--drive-speed goes with --drive speed: leave one of them out")
    others = _libraries(unit.library or [])
    if len(files) > 2:
        raise ParameterError(
            f"{len(files)} files are given: name a fit and a machine file, or the latter alone"
        )
    file = may_write(out, force, [*files, *others.values()], ends=[".fmu"])

    from hersey.machine.machine import read_machine

    *fits, machine_file = files
    machine = read_machine(machine_file)
    surface = finished_fit(fits[0], machine) if fits else None
    drag = unit.drag(surface, machine, machine_file.name)
    # a torque acts on the roll itself: there is none beyond it that could slip
    train = machine.train if unit.drive == "speed" else replace(machine.train, grip=None)
    settings = unit.settings(machine, drag) | {"fitted": surface, "libraries": others}
    made, tried = _made(file, train, drag, settings, check)
    kept = tried is None or tried.ok
    if as_json:
        print_json(made.to_dict(), check=tried)
    else:
        say(*([made.summary()] if kept else []), *([] if tried is None else [tried.summary()]))
    if not kept:
        raise typer.Exit(NOT_FOUND)


def _made(
    file: Output, train: Drivetrain, drag: Drag | MixedDrag, settings: dict[str, Any], check: bool
) -> tuple[ExportedUnit, Trial | None]:
    """The unit, and what FMPy says of it if asked; it is kept unless that finds something."""
    from tempfile import TemporaryDirectory

    from hersey.exchange.unit import export_fmu

    tried = None
    with TemporaryDirectory() as folder:
        unit = export_fmu(Path(folder) / "drive.fmu", train, drag, **settings)
        if check:
            from hersey.exchange.trial import try_unit

            with working("running the unit beside the core"):
                tried = try_unit(unit, train, drag)
        if tried is None or tried.ok:
            file.write(unit.path.read_bytes())
    return replace(unit, path=file.path or unit.path), tried


def _libraries(given: list[str]) -> dict[str, Path]:
    """Files by platform, as ``PLATFORM=FILE`` names them."""
    files: dict[str, Path] = {}
    for text in given:
        platform, mark, file = text.partition("=")
        if not mark or not file:
            raise ParameterError(
                f"--library is '{text}': write PLATFORM=FILE, as x86_64-windows=win/hersey.dll"
            )
        if platform in files:
            raise ParameterError(f"--library names {platform} twice: give one file for each platform")
        files[platform] = Path(file)
    return files


def _fitted(surface: DampingSurface, machine: Machine, file: str, temperature: float | None) -> Drag:
    """Drag of a fit; with a stick speed that is fixed it is that of one temperature."""
    from hersey.damping.surface import FIXED

    if surface.b is not None and temperature is None:
        raise ParameterError(
            "the law varies with temperature: give one to start with, --temperature '180 degC'"
        )
    if surface.b is None and temperature is not None:
        raise ParameterError("the fit is isothermal, so that nothing varies: leave out --temperature")
    at_one = temperature if machine.stick_speed_rule == FIXED else None
    if at_one is not None:
        say(
            f"{file} has a stick speed that is fixed: the unit holds at this one temperature", file=sys.stderr
        )
    return surface.drag(**machine.belt, temperature=at_one)


def _contact(machine: Machine, file: str, temperature: float | None) -> MixedDrag:
    """Drag of the contact that a machine file describes, where there is no fit."""
    if machine.mixed is None:
        raise ParameterError(
            f"{file} has no [asperities] and [boundary], so its drag is not known without a fit: give "
            "the fit before it (hersey fit LOG --machine TOML --json > fit.json), or add both tables"
        )
    if temperature is None:
        raise ParameterError(
            "a mixed contact varies with temperature: give one to start with, --temperature '180 degC'"
        )
    return machine.mixed_drag(temperature)
