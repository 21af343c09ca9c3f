"""For a nip: ``hersey film``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import Force, Reading, drawn
from hersey.cli.outputs import may_draw, print_json
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.quantities import belt_speed_of, temperature_of
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.surface import DampingSurface
    from hersey.lubrication.film_result import Film
    from hersey.machine.machine import Machine
    from hersey.schema.warning import Warning
    from hersey.study.nip import SharedLoad
    from hersey.verdict.contact_verdict import Verdict
    from hersey.verdict.evidence import MeasuredFilm


#: The tables that a film needs, with the fewest keys, as examples.
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


#: Longest name of a point in the table, and rows that it has at most.
_LONGEST, _MOST = 18, 12
_LOG = "Log to compare with; repeat for more files."
_AT = "Film temperature, e.g. '180 degC', if neither log nor operating points give it."
_BELT_SPEED = "Sliding speed, e.g. '120 mm/s', instead of the operating points of the file."
_MACHINE = "Machine file with the tables \\[contact] and \\[lubricant]."


@grouped
def film(
    machine_file: Annotated[Path, argument("MACHINE", _MACHINE)],
    *,
    log: Annotated[list[Path] | None, option(_LOG, metavar="LOG")] = None,
    at: Annotated[str, option(_AT)] = "",
    belt_speed: Annotated[str, option(_BELT_SPEED)] = "",
    figure: Annotated[Path | None, drawn("the regime chart")] = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Compute film thickness and lubrication regime, and compare them with a log.

    Example: [bold]hersey film examples/machine.toml --log examples/bench.csv --tare standing[/bold]

    Without a log, the film is computed at the operating points of the machine file.
    """
    drawing = may_draw(figure, force, inputs=reading.inputs(machine_file, log))

    from hersey.machine.machine import read_machine
    from hersey.study.nip import film_document, shared_load
    from hersey.verdict.checks import nip_warnings

    machine = read_machine(machine_file)
    _refuse_incomplete(machine, machine_file.name)
    kelvin = temperature_of(at)
    if not log and reading != Reading():
        raise ParameterError("the options for reading a log need --log LOG")
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
    if printing.as_json:
        print_json(film_document(predicted, names, found.measured, found.says, warnings, shared))
        return
    printing.text(predicted.headline() + "." if found.says is None else found.says.text)
    if not printing.verbose:
        printing.text(*_points(predicted, names, shared))
    printing.details("", *_lines(predicted, names, found, shared))
    printing.warnings(*warnings)
    printing.files(figure)


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
    """Refuse a machine file without the tables that a film needs."""
    for table, example in _EXAMPLES.items():
        if getattr(machine, table) is None:
            raise ParameterError(
                f"{file}: the film needs a table [{table}]: add [{table}] with your values, e.g. {example}"
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
            raise ParameterError("--belt-speed needs a temperature: add --at '180 degC'")
        states = [(belt_speed, belt_speed_of(belt_speed, "--belt-speed"), kelvin)]
    elif machine.points:
        states = [(p.name, p.speed, kelvin or p.temperature) for p in machine.points]
    elif measured is not None:
        return measured.predicted, [f"dwell {i + 1}" for i in range(measured.speed.size)]
    else:
        raise ParameterError(
            "name a state: [[points]] in the machine file, --log LOG, or --belt-speed and --at"
        )
    speeds = [speed / machine.contact.roll_radius for _, speed, _ in states]
    inside = film_temperature(
        machine.contact, machine.lubricant, speed=speeds, temperature=[kelvin for _, _, kelvin in states]
    )
    film = film_thickness(machine.contact, machine.lubricant, speed=speeds, temperature=inside)
    return film, [name for name, _, _ in states]


def _lines(predicted: Film, names: list[str], found: _OfALog, shared: SharedLoad | None) -> list[str]:
    """The film by every law, the share of the asperities, and the film of the log."""
    lines = [predicted.summary(names)]
    lines += [] if shared is None else ["", shared.summary(names)]
    return lines + ([] if found.measured is None else ["", found.measured.summary()])


def _points(predicted: Film, names: list[str], shared: SharedLoad | None) -> list[str]:
    """The film at each point: temperature, thickness, lambda ratio, torque and regime."""
    import numpy as np

    from hersey.cli.figures import columns, three
    from hersey.units import celsius

    film, mixed = predicted, None if shared is None else shared.film
    ratio = [] if mixed is None else np.ravel(mixed.lambda_ratio).tolist()
    torque = np.ravel(film.torque if mixed is None else mixed.torque)
    rows = [
        (
            name[:_LONGEST],
            f"{celsius(kelvin):.0f} °C",
            three(1e6 * least, "µm"),
            *([three(ratio[i])] if ratio else []),
            three(1e3 * torque[i], "mN·m"),
            regime,
        )
        for i, (name, kelvin, least, regime) in enumerate(
            zip(
                names,
                np.ravel(film.temperature).tolist(),
                np.ravel(film.minimum * film.factor).tolist(),
                film.regime_names(),
                strict=False,
            )
        )
    ]
    head = ("point", "temp.", "least film", *(["lambda"] if ratio else []), "torque", "regime")
    return ["", *columns(head, rows[:_MOST]), *_more(len(rows))]


def _more(count: int) -> list[str]:
    return [f"  and {count - _MOST} more: --verbose"] if count > _MOST else []
