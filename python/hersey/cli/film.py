"""For a nip: ``hersey film``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Force,
    Reading,
    reads_logs,
    temperature_of,
)
from hersey.cli.outputs import may_draw, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.lubrication.film_result import Film
    from hersey.machine.machine import Machine
    from hersey.study.nip import SharedLoad
    from hersey.verdict.contact_verdict import Verdict
    from hersey.verdict.evidence import MeasuredFilm


#: What the tables that a film needs say at least, as examples.
_EXAMPLES = {
    "contact": (
        'rubber_thickness = "3.5 mm"; modulus = "1 MPa"; poisson_ratio = 0.48; length = "220 mm"; '
        'load = "300 N"'
    ),
    "lubricant": (
        'name = "oil"; model = "arrhenius"; '
        'viscosities = [["40 degC", "120 mPa*s"], ["100 degC", "12 mPa*s"]]; pressure_viscosity = "20 GPa^-1"'
    ),
}


@reads_logs
def film(
    machine_file: Annotated[
        Path, typer.Argument(metavar="MACHINE", help="TOML file with the tables contact and lubricant.")
    ],
    reading: Reading,
    log: Annotated[
        list[Path] | None, typer.Option("--log", help="A log to compare with; may be given again.")
    ] = None,
    at: Annotated[
        str, typer.Option(help="Temperature of the film, as '180 degC', where log or points give none.")
    ] = "",
    belt_speed: Annotated[
        str, typer.Option(help="Speed of the belt, as '120 mm/s', instead of the points of the file.")
    ] = "",
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Draw the regime chart: .html, .png, .svg or .pdf.")
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Say how thick the lubricant film is, which regime makes it, and what a log says of both.

    Example: [bold]hersey film examples/machine.toml --log examples/bench.csv --tare standing[/bold]

    Without a log the film is computed at the points of the file.
    """
    overwrite = figure is not None and may_draw(figure, force, inputs=reading.inputs(machine_file, log))

    from hersey.files.writing import write_atomically
    from hersey.machine.machine import read_machine
    from hersey.study.nip import film_document, shared_load
    from hersey.verdict.cautions import cautions
    from hersey.verdict.checks import misfits, remarks
    from hersey.verdict.contact_verdict import verdict
    from hersey.verdict.evidence import measured_film
    from hersey.verdict.regime import regime

    machine = read_machine(machine_file)
    if machine.contact is None or machine.lubricant is None:
        missing = "contact" if machine.contact is None else "lubricant"
        raise ParameterError(
            f"{machine_file.name}: the film needs a table [{missing}]: write [{missing}] and below it yours "
            f"of {_EXAMPLES[missing]}"
        )
    kelvin = temperature_of(at)
    if not log and reading != Reading():
        raise ParameterError("options that say how to read a log need --log")
    measured, says, surface, doubts = None, None, None, []
    if log:
        from hersey.damping.fit import fit

        points = reading.points(reading.log(log, machine), machine)
        with working("fitting the surface"):
            surface = fit(points, temperature_scale=reading.temperature_scale)
        measured = measured_film(
            points,
            surface,
            machine.contact,
            machine.lubricant,
            temperature=kelvin,
            grip=machine.limits.roll_friction,
        )
        seen = regime(
            points, surface, contact=machine.contact, lubricant=machine.lubricant, temperature=kelvin
        )
        says = verdict(measured, surface, machine.contact, machine.lubricant, seen)
        doubts = cautions(points, surface)
    predicted, names = _predicted(machine, measured, kelvin, belt_speed)
    notes = (*remarks(machine, predicted), *doubts)
    shared = shared_load(machine, predicted, measured, surface)
    off = misfits(machine, predicted, measured, says, None if shared is None else shared.transition)
    if figure is not None:
        from hersey.charts import chart_of
        from hersey.charts.render import picture

        with working("drawing"):
            turn = None if shared is None else shared.transition
            chart = chart_of(predicted, names=names, measured=measured, transition=turn, mixed=machine.mixed)
            content = picture(chart, figure.suffix)
        write_atomically(figure, content, overwrite=overwrite)
    if as_json:
        print_json("film", film_document(predicted, names, measured, says, notes, shared, off))
        return
    say(_text(predicted, names, measured, says, (*(each.text for each in off), *notes), shared))
    if figure is not None:
        say(f"figure: {figure}")


def _predicted(
    machine: Machine, measured: MeasuredFilm | None, kelvin: float | None, belt_speed: str
) -> tuple[Film, list[str]]:
    """The film at the points of interest, and their names."""
    from hersey.lubrication.film import film_thickness
    from hersey.lubrication.film_temperature import film_temperature
    from hersey.units import parse

    assert machine.contact is not None
    assert machine.lubricant is not None
    if belt_speed:
        if kelvin is None:
            raise ParameterError("--belt-speed needs a temperature: --at '180 degC'")
        states = [(belt_speed, parse("belt speed", belt_speed), kelvin)]
        if not states[0][1] > 0:
            raise ParameterError(f"--belt-speed is {belt_speed}: it must be greater than 0")
    elif machine.points:
        states = [(p.name, p.speed, kelvin or p.temperature) for p in machine.points]
    elif measured is not None:
        return measured.predicted, [f"dwell {i + 1}" for i in range(measured.speed.size)]
    else:
        raise ParameterError("say where: [[points]] in the file, --log, or --belt-speed with --at")
    speeds = [speed / machine.contact.roll_radius for _, speed, _ in states]
    inside = film_temperature(
        machine.contact, machine.lubricant, speed=speeds, temperature=[heat for _, _, heat in states]
    )
    film = film_thickness(machine.contact, machine.lubricant, speed=speeds, temperature=inside)
    return film, [name for name, _, _ in states]


def _text(
    predicted: Film,
    names: list[str],
    measured: MeasuredFilm | None,
    says: Verdict | None,
    notes: tuple[str, ...],
    shared: SharedLoad | None,
) -> str:
    lines = [predicted.summary(names)]
    if shared is not None:
        lines += ["", shared.summary(names)]
    if measured is not None:
        lines += ["", measured.summary()]
    if says is not None:
        lines += ["", says.text]
    lines += [f"- {note}" for note in notes]
    return "\n".join(lines)
