"""A drive profile that ends smooth: ``hersey plan``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import (
    AsJson,
    FitFile,
    Force,
    Reading,
    SomeLogs,
    reads_logs,
    target_of,
    temperature_of,
)
from hersey.cli.outputs import may_draw, may_write, print_json
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.errors import OutputError, ParameterError

if TYPE_CHECKING:
    from hersey.arrays import FloatArray
    from hersey.damping.surface import DampingSurface
    from hersey.machine.machine import Machine
    from hersey.machine.uncertainty import Uncertainty
    from hersey.motion.drag import Drag


#: Draws of the fit from which those of the plan are taken.
_DRAWS = 4000
#: Exit code where no profile exists.
IMPOSSIBLE = 1


@reads_logs
def plan(
    machine_file: Annotated[
        Path,
        typer.Argument(metavar="MACHINE", help="TOML file of the drivetrain, its limits and uncertainty."),
    ],
    reading: Reading,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    target: Annotated[
        str, typer.Option(help="Target speed of the belt, as '60 mm/s', or of the roll, as '40 rpm'.")
    ] = "",
    at: Annotated[str, typer.Option(help="Temperature, as '150 degC'.")] = "",
    profile_file: Annotated[
        Path | None,
        typer.Option(
            "--temperature-profile",
            metavar="FILE",
            help="Instead: temperature against time, in any format that a log may have.",
        ),
    ] = None,
    confidence: Annotated[
        float, typer.Option("--confidence", help="Share of the belts that must run smoothly, 0.5 to 0.999.")
    ] = 0.95,
    seed: Annotated[int, typer.Option("--seed", help="Of all random draws.", min=0)] = 1,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="CSV", help="Write the profile for a motor controller.")
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Draw profile and motion: .html, .png, .svg or .pdf.")
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find the quickest profile of drive speed from rest that ends smooth, and say how surely it does.

    Example: [bold]hersey plan examples/machine.toml examples/bench.csv --tare standing --target "60 mm/s"
    --at "150 degC" --out profile.csv --figure plan.png[/bold]

    Exit code 1 says that no profile exists; then nothing is written.
    """
    inputs = reading.inputs(machine_file, logs, fit_file, profile_file)
    if out is not None and figure is not None and out.absolute() == figure.absolute():
        raise OutputError(f"--out and --figure both name {out}: name two files")
    if figure is not None:
        may_draw(figure, force, inputs)
    if out is not None:
        may_write(out, force, inputs)
    if at and profile_file is not None:
        raise ParameterError("give either --at or --temperature-profile")

    from hersey.files.writing import write_atomically
    from hersey.log import memory_limit
    from hersey.machine.machine import read_machine
    from hersey.machine.temperature_profile import read_temperature_profile
    from hersey.stability.plan import plan_profile

    machine = read_machine(machine_file)
    wanted = target_of(target, machine)
    kelvin = temperature_of(at)
    with memory_limit(reading.max_memory):
        profile = None if profile_file is None else read_temperature_profile(profile_file)
    surface = reading.surface(logs, fit_file, machine)
    drag, samples = _drag(surface, machine, kelvin, seed, varies=profile is not None)
    with bar("planning", unit="profiles") as progress:
        planned = plan_profile(
            machine.train,
            drag,
            target_speed=wanted,
            temperature=profile,
            limits=machine.limits,
            roll_radius=machine.roll_radius,
            uncertainty=_uncertainty(machine, drag),
            samples=samples,
            confidence=confidence,
            seed=seed,
            progress=progress,
        )
    if planned.found and figure is not None:
        from hersey.charts import chart_of
        from hersey.charts.render import picture

        with working("drawing"):
            content = picture(chart_of(planned, temperature=profile), figure.suffix)
        write_atomically(figure, content, overwrite=True)
    if planned.found and out is not None:
        write_atomically(out, planned.table(), overwrite=True)
    if as_json:
        print_json("plan", planned.to_dict())
    else:
        say(planned.summary())
        for what, written in (("profile", out), ("figure", figure)):
            if planned.found and written is not None:
                say(f"{what}: {written}")
    if not planned.found:
        raise typer.Exit(IMPOSSIBLE)


def _uncertainty(machine: Machine, drag: Drag) -> dict[str, Uncertainty]:
    """How far parameters are known; a range of the stick speed moves with it from where it was stated."""
    known = dict(machine.uncertainty)
    if "stick_speed" in known:
        known["stick_speed"] = known["stick_speed"].times(drag.stick_speed / machine.stick_speed)
    return known


def _drag(
    surface: DampingSurface, machine: Machine, kelvin: float | None, seed: int, *, varies: bool
) -> tuple[Drag, dict[str, FloatArray]]:
    """The fitted drag, at one temperature or varying with it, and draws of what the fit leaves open."""
    import warnings

    if surface.b is not None and kelvin is None and not varies:
        raise ParameterError(
            "the drag varies with temperature: give --at '150 degC' or --temperature-profile"
        )
    if surface.b is None and (kelvin is not None or varies):
        raise ParameterError("the log is isothermal: leave out --at and --temperature-profile")
    drag = surface.drag(**machine.belt, temperature=kelvin)
    at = drag.reference_temperature if varies else kelvin
    with warnings.catch_warnings():  # the fit's own command says how many draws have no falling branch
        warnings.simplefilter("ignore")
        samples = surface.drag_samples(_DRAWS, seed, **machine.belt, temperature=at)
    if surface.rest is not None:
        samples |= surface.rest.samples(_DRAWS, seed, roll_radius=machine.roll_radius, temperature=at)
    return drag, samples
