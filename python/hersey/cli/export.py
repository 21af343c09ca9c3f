"""The fitted drive for other tools: ``hersey export``."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hersey.cli.options import AsJson, Force, Reading, target_of, temperature_of
from hersey.cli.outputs import NOT_FOUND, may_write, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.surface import DampingSurface
    from hersey.lubrication.mixed_drag import MixedDrag
    from hersey.machine.machine import Machine
    from hersey.motion.drag import Drag

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


@export.command("fmu")
def fmu(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="[JSON] TOML",
            help="Fit that hersey fit --machine --json printed, then the machine file. The machine file "
            "alone exports its mixed contact.",
        ),
    ],
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="Unit to write, .fmu.")],
    fmi: Annotated[str, typer.Option("--fmi", help="3.0, or 2.0 for older tools.")] = "3.0",
    drive: Annotated[str, typer.Option(help="What moves the drive, an input: speed, or torque.")] = "speed",
    port: Annotated[
        str,
        typer.Option(
            help="Coupling of a drive by speed: translational (m/s in), or rotational (shaft speed in rad/s "
            "in, reaction torque in N*m out)."
        ),
    ] = "translational",
    drive_speed: Annotated[
        str, typer.Option(help="Speed of the drive until the tool gives another, as '30 mm/s'.  [default: 0]")
    ] = "",
    temperature: Annotated[
        str, typer.Option(help="Temperature until the tool gives another, as '180 degC'.")
    ] = "",
    start: Annotated[str, typer.Option(help="rest, or steady (sliding with the drive).")] = "rest",
    closure: Annotated[
        str,
        typer.Option(help="What happens below the stick speed: retained, stiction, stribeck or lugre."),
    ] = "retained",
    bristle_stiffness: Annotated[
        str | None, typer.Option(help="Of lugre: force per deflection of the bristles, as '1000 N/mm'.")
    ] = None,
    bristle_damping: Annotated[
        str | None, typer.Option(help="Of lugre: force per rate of deflection, as '10 N*s/m'.")
    ] = None,
    name: Annotated[str, typer.Option(help="Name of the model, as tools show it.")] = "Belt drive",
    library: Annotated[
        list[str] | None,
        typer.Option(
            "--library",
            metavar="PLATFORM=FILE",
            help="The library built for another platform, as x86_64-windows=win/hersey.dll; again for each.",
        ),
    ] = None,
    check: Annotated[
        bool,
        typer.Option(
            "--check", help="Have FMPy validate the unit and run it beside the core, before it is kept."
        ),
    ] = False,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Write a Functional Mock-up Unit for co-simulation, from a fit and a machine file.

    Example: [bold]hersey export fmu fit.json examples/machine.toml --temperature '180 degC'
    --out drive.fmu[/bold]

    Exit code 1 says that --check found something; then nothing is written.
    """
    if drive != "speed" and drive_speed:
        raise ParameterError("--drive-speed goes with --drive speed: leave one of them out")
    others = _libraries(library or [])
    if len(files) > 2:
        raise ParameterError(
            f"{len(files)} files are given: name a fit and a machine file, or the latter alone"
        )
    overwrite = may_write(out, force, [*files, *others.values()], ends=[".fmu"])

    from tempfile import TemporaryDirectory

    from hersey.exchange.unit import export_fmu
    from hersey.files.writing import write_atomically
    from hersey.machine.machine import read_machine
    from hersey.result import json_value

    *fits, machine_file = files
    machine = read_machine(machine_file)
    surface = Reading().surface(None, fits[0], machine) if fits else None
    kelvin = temperature_of(temperature, "--temperature")
    if surface is None:
        drag: Drag | MixedDrag = _contact(machine, machine_file, kelvin)
    else:
        drag = _fitted(surface, machine, machine_file, kelvin)
    # a torque acts on the roll itself: there is none beyond it that could slip
    train = machine.train if drive == "speed" else replace(machine.train, grip=None)
    near = {"bristle_stiffness": bristle_stiffness, "bristle_damping": bristle_damping}
    drag = replace(drag, closure=closure, **near)  # type: ignore[arg-type]  # the drag reads the texts
    settings: dict[str, Any] = {
        "fmi": fmi,
        "drive": drive,
        "port": port,
        "drive_speed": target_of(drive_speed, machine, "--drive-speed") if drive_speed else 0.0,
        "temperature": kelvin if drag.varies_with_temperature else None,
        "start": start,
        "roll_radius": machine.roll_radius,
        "fitted": surface,
        "name": name,
        "libraries": others,
    }
    tried = None
    with TemporaryDirectory() as folder:
        unit = export_fmu(Path(folder) / "drive.fmu", train, drag, **settings)
        if check:
            from hersey.exchange.trial import try_unit

            with working("running the unit beside the core"):
                tried = try_unit(unit, train, drag)
        if tried is None or tried.ok:
            write_atomically(out, unit.path.read_bytes(), overwrite=overwrite)
    unit = replace(unit, path=out)
    if as_json:
        print_json("export", unit.to_dict() | {"check": json_value(tried)})
    else:
        say(
            *([unit.summary()] if tried is None or tried.ok else []),
            *([] if tried is None else [tried.summary()]),
        )
    if tried is not None and not tried.ok:
        raise typer.Exit(NOT_FOUND)


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


def _fitted(surface: DampingSurface, machine: Machine, file: Path, temperature: float | None) -> Drag:
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
            f"{file.name} has a stick speed that is fixed: the unit holds at this one temperature",
            file=sys.stderr,
        )
    return surface.drag(**machine.belt, temperature=at_one)


def _contact(machine: Machine, file: Path, temperature: float | None) -> MixedDrag:
    """Drag of the contact that a machine file describes, where there is no fit."""
    if machine.mixed is None:
        raise ParameterError(
            f"{file.name} has no [asperities] and [boundary], so its drag is not known without a fit: give "
            "the fit before it (hersey fit LOG --machine TOML --json > fit.json), or add both tables"
        )
    if temperature is None:
        raise ParameterError(
            "a mixed contact varies with temperature: give one to start with, --temperature '180 degC'"
        )
    return machine.mixed_drag(temperature)
