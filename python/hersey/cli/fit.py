"""The damping surface of a log: ``hersey fit``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.moving import Fitted, fitted, fitted_lines
from hersey.cli.options import Force, KeepGoing, Logs, Reading, SensorsFile
from hersey.cli.outputs import may_write, print_json
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.workers import Crew
from hersey.errors import ParameterError
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.damping.curves import CurveMixture
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.estimate import Estimate
    from hersey.damping.friction_curve.result import FrictionCurve
    from hersey.damping.surface import DampingSurface
    from hersey.log.means import MeansTable
    from hersey.log.torque_log import TorqueLog
    from hersey.lubrication.lubricant import Lubricant
    from hersey.machine.machine import Machine

_NO_SURFACE = "--json prints a surface, for which the windows of this log are too few: omit --json"
_HERSEY = "Fit to the Hersey number, with this viscosity, '20 mPa*s', or the lubricant of a TOML file."
_EACH = "Fit each log separately and write one row per log (.csv or .parquet)."


@grouped
def fit(
    logs: Logs,
    *,
    each: Annotated[Path | None, option(_EACH, metavar="TABLE")] = None,
    machine_file: SensorsFile = None,
    keep_going: KeepGoing = False,
    hersey: Annotated[str, option(_HERSEY, metavar="VISCOSITY")] = "",
    crew: Crew,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Fit the damping surface B = a T^b w^c and print it with the lubrication regime.

    Example: [bold]hersey fit examples/bench.csv --tare standing[/bold]

    Of a joint or gear motor it prints Coulomb, viscous and Stribeck friction, if that describes the dwells.

    Several logs count as runs of one machine and give one fit, unless --each fits them separately. If a log
    then fails, nothing is written; with --keep-going the others are, and the exit code is 1.
    """
    if each is not None and printing.as_json:
        raise ParameterError("--each writes a table and --json prints one fit: give one of them")
    if each is None and (keep_going or force or crew.scheduler or crew.count):
        raise ParameterError("--keep-going, --scheduler, --workers and --force need --each TABLE")
    if hersey and (each is not None or machine_file is not None or reading.moving):
        raise ParameterError("--hersey fits friction to all dwells: omit --each, --machine and --moving")
    machine = None
    if machine_file is not None:
        from hersey.machine.machine import read_machine

        machine = read_machine(machine_file)
    if each is None:
        _fit_one(logs, reading, machine, printing, hersey)
        return
    from hersey.cli.fitting_each import fit_each

    table = may_write(each, force, reading.inputs(logs, machine_file), flag="--each", ends=TABLES)
    fit_each(logs, reading, machine, table, keep_going, crew, printing)


def _fit_one(
    logs: list[Path], reading: Reading, machine: Machine | None, printing: Printing, hersey: str
) -> None:
    """Fit all logs together."""
    from hersey.cli.hersey_number import viscosity_of

    viscosity = viscosity_of(hersey) if hersey else None
    log = reading.log(logs, machine)

    from hersey.verdict.friction import excludes_power_law, leading_friction
    from hersey.verdict.regime import regime
    from hersey.verdict.warnings import warnings_of

    with working("fitting the surface"):
        found = (
            fitted(logs, log, reading, machine)
            if viscosity is None
            else _against(logs, log, reading, viscosity)
        )
        points, surface, moving = found.points, found.surface, found.moving
        curves = None
        if points is not None and surface is not None and printing.in_full:
            curves = _curves(points, surface, machine)
    if points is None or surface is None:
        if printing.as_json:
            raise ParameterError(_NO_SURFACE)
        if moving is not None:
            printing.text(*fitted_lines(moving))
            printing.warnings(*moving.warnings)
        return
    if printing.as_json:
        from hersey.document.assembly import fit_document

        print_json(fit_document(log, points, surface, curves, moving))
        return
    seen = regime(points, surface)
    friction = leading_friction(points, surface, seen)
    if moving is not None:
        printing.text(*fitted_lines(moving, "" if friction is None else friction.finding))
    elif friction is not None:
        printing.text(*_friction(friction, points.dropped()))
    if friction is None or printing.in_full or not excludes_power_law(friction, surface):
        of = "of the windows of speed " if moving is not None else ""
        said = moving is not None or friction is not None
        printing.text(*["", f"Damping {of}as one power law:"] * said, seen.verdict)
        if seen.driving is None:
            printing.text("", *_law(surface, curves, "dwells" if moving is None else "windows"))
    printing.warnings(*warnings_of(points, surface, friction))


def _against(
    logs: list[Path], log: TorqueLog | MeansTable, reading: Reading, viscosity: Lubricant | float
) -> Fitted:
    """The fit of friction to the Hersey number."""
    from hersey.damping.fit import fit

    points = reading.points(logs, log).against_hersey_number(viscosity)
    return Fitted(points, fit(points), None)


def _law(surface: DampingSurface, curves: CurveMixture | None, points: str) -> list[str]:
    """The power law of ``points``: its estimates, or all of its statistics with the drag curves."""
    if curves is None:
        return _estimates(surface, points)
    from hersey.damping.curves.words import drag_curves

    return [surface.summary(), drag_curves(curves.table)]


def _friction(curve: FrictionCurve, dropped: str) -> list[str]:
    """The friction curve of a joint: what torque does, and the parameters with 95 % intervals.

    ``dropped`` says which dwells were excluded.
    """
    from hersey.cli.figures import labelled, three
    from hersey.damping.friction_curve.words import formula_of, law_of, rows_of

    rows = [*rows_of(curve), ("dwells", str(curve.points))]
    rows.append(("scatter", f"{three(100 * curve.scatter)} % of torque"))
    head = f"{formula_of(curve)} (value, 95 % interval)"
    return [f"{law_of(curve)}. {curve.finding} {dropped}".rstrip(), "", head, *labelled(rows)]


def _curves(points: SteadyPoints, surface: DampingSurface, machine: Machine | None) -> CurveMixture:
    from hersey.damping.curves import fit_curves

    return fit_curves(points, surface, None if machine is None else machine.mixed)


def _estimates(surface: DampingSurface, points: str) -> list[str]:
    """The law with its estimates, 95 % intervals and units, and what it is fitted to."""
    from hersey.cli.figures import labelled, three
    from hersey.units import celsius

    of, scale = surface.domain, {"degC": "°C"}.get(surface.temperature_scale, surface.temperature_scale)
    law = f"{surface.law}, T in {scale}" if surface.b else surface.law
    unit = (of.damping_unit if of.is_torque else of.unit).replace("N m s", "N·m·s")
    at_one = f"at {f'T = 1 {scale}, ' * bool(surface.b)}{of.speed_symbol} = 1 {of.speed_unit}"
    rows = [("a", " ".join(filter(None, (_within(surface.a), unit, at_one))))]
    rows += [(name, _within(known)) for name, known in (("b", surface.b), ("c", surface.c)) if known]
    if surface.transition is not None:
        kelvin = surface.reference_temperature
        at = "" if kelvin is None else f" at {celsius(kelvin):.0f} °C"
        rows.append(("c below w_t", _within(surface.transition.mixed_exponent)))
        rows.append(("w_t", f"{_within(surface.transition.speed)} {of.speed_unit}{at} (least {of.quantity})"))
    statistics = surface.statistics
    rows += [
        (points, str(statistics.points)),
        ("scatter", f"{three(100 * statistics.scatter)} % of {of.quantity}"),
    ]
    return [f"{law}, {of.speed_symbol} in {of.speed_unit} (value, 95 % interval)", *labelled(rows)]


def _within(known: Estimate) -> str:
    from hersey.cli.figures import within

    return within((known.value, known.low, known.high))
