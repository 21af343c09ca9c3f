"""For a nip: ``hersey film``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, Force, Reading, drawn
from hersey.cli.outputs import may_draw, print_json, say_written
from hersey.cli.progress import working
from hersey.cli.quantities import belt_speed_of, temperature_of
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.surface import DampingSurface
    from hersey.lubrication.film_result import Film
    from hersey.machine.machine import Machine
    from hersey.schema.warning import Warning
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


_AT = "Temperature of the film, as '180 degC', where log or points give none."
_BELT_SPEED = "Speed of the belt, as '120 mm/s', instead of the points of the file."


@grouped
def film(
    machine_file: Annotated[Path, argument("MACHINE", "TOML file with the tables contact and lubricant.")],
    *,
    log: Annotated[list[Path] | None, option("A log to compare with; may be given again.")] = None,
    at: Annotated[str, option(_AT)] = "",
    belt_speed: Annotated[str, option(_BELT_SPEED)] = "",
    figure: Annotated[Path | None, drawn("the regime chart")] = None,
    reading: Reading,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Say how thick the lubricant film is, which regime makes it, and what a log says of both.

    Example: [bold]hersey film examples/machine.toml --log examples/bench.csv --tare standing[/bold]

    Without a log the film is computed at the points of the file.
    """
    drawing = may_draw(figure, force, inputs=reading.inputs(machine_file, log))

    from hersey.machine.machine import read_machine
    from hersey.study.nip import film_document, shared_load
    from hersey.verdict.checks import nip_warnings

    machine = read_machine(machine_file)
    _refuse_incomplete(machine, machine_file.name)
    kelvin = temperature_of(at)
    if not log and reading != Reading():
        raise ParameterError("options that say how to read a log need --log")
    found = _compared(log, reading, machine, kelvin) if log else _OfALog()
    predicted, names = _predicted(machine, found.measured, kelvin, belt_speed)
    shared = shared_load(machine, predicted, found.measured, found.surface)
    turn = None if shared is None else shared.transition
    own = nip_warnings(machine, predicted, found.measured, found.says, turn)
    warnings = (*own, *found.doubts)
    chart: dict[str, Any] = {
        "names": names,
        "measured": found.measured,
        "transition": turn,
        "mixed": machine.mixed,
    }
    drawing.draw(predicted, **chart)
    if as_json:
        print_json(film_document(predicted, names, found.measured, found.says, warnings, shared))
        return
    say(*_lines(predicted, names, found, shared), *(f"- {each.sentence}" for each in warnings))
    say_written(figure=figure)


class _OfALog(NamedTuple):
    """What a log says of the film, and its fit; nothing without one."""

    surface: DampingSurface | None = None
    measured: MeasuredFilm | None = None
    says: Verdict | None = None
    doubts: Sequence[Warning] = ()


def _compared(logs: list[Path], reading: Reading, machine: Machine, kelvin: float | None) -> _OfALog:
    from hersey.damping.fit import fit
    from hersey.verdict.contact_verdict import verdict
    from hersey.verdict.evidence import measured_film
    from hersey.verdict.regime import regime
    from hersey.verdict.warnings import warnings_of

    nip, lubricant = machine.contact, machine.lubricant
    assert nip is not None
    assert lubricant is not None
    points = reading.points(logs, reading.log(logs, machine), machine)
    with working("fitting the surface"):
        surface = fit(points, temperature_scale=reading.temperature_scale)
    grip = machine.limits.roll_friction
    measured = measured_film(points, surface, nip, lubricant, temperature=kelvin, grip=grip)
    seen = regime(points, surface, contact=nip, lubricant=lubricant, temperature=kelvin)
    says = verdict(measured, surface, nip, lubricant, seen)
    return _OfALog(surface, measured, says, warnings_of(points, surface))


def _refuse_incomplete(machine: Machine, file: str) -> None:
    """Refuse a machine's file without the tables that a film needs."""
    for table, example in _EXAMPLES.items():
        if getattr(machine, table) is None:
            raise ParameterError(
                f"{file}: the film needs a table [{table}]: write [{table}] and below it yours of {example}"
            )


def _predicted(
    machine: Machine, measured: MeasuredFilm | None, kelvin: float | None, belt_speed: str
) -> tuple[Film, list[str]]:
    """The film at the points of interest, and their names."""
    from hersey.lubrication.film import film_thickness
    from hersey.lubrication.film_temperature import film_temperature

    assert machine.contact is not None
    assert machine.lubricant is not None
    if belt_speed:
        if kelvin is None:
            raise ParameterError("--belt-speed needs a temperature: --at '180 degC'")
        states = [(belt_speed, belt_speed_of(belt_speed, "--belt-speed"), kelvin)]
    elif machine.points:
        states = [(p.name, p.speed, kelvin or p.temperature) for p in machine.points]
    elif measured is not None:
        return measured.predicted, [f"dwell {i + 1}" for i in range(measured.speed.size)]
    else:
        raise ParameterError("say where: [[points]] in the file, --log, or --belt-speed with --at")
    speeds = [speed / machine.contact.roll_radius for _, speed, _ in states]
    inside = film_temperature(
        machine.contact, machine.lubricant, speed=speeds, temperature=[kelvin for _, _, kelvin in states]
    )
    film = film_thickness(machine.contact, machine.lubricant, speed=speeds, temperature=inside)
    return film, [name for name, _, _ in states]


def _lines(predicted: Film, names: list[str], found: _OfALog, shared: SharedLoad | None) -> list[str]:
    """The film, and what asperities and the log say of it, below each other."""
    lines = [predicted.summary(names)]
    lines += [] if shared is None else ["", shared.summary(names)]
    lines += [] if found.measured is None else ["", found.measured.summary()]
    return lines + ([] if found.says is None else ["", found.says.text])
