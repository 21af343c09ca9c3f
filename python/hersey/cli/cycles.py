"""Slips of a stick-slip trace and the drive behind them: ``hersey cycles``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.mistyped import retyped
from hersey.cli.options import Force, MaxMemory, TimeUnit, drawn
from hersey.cli.outputs import may_draw
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.quantities import belt_speed_of, share
from hersey.errors import (
    InsufficientDataError,
    ParameterError,
    UnitError,
    WrongKindError,
    followed_by,
    sentence,
)

if TYPE_CHECKING:
    from hersey.arrays import FloatArray
    from hersey.identification.cycle_record import CycleRecord
    from hersey.identification.identified_drive import IdentifiedDrive
    from hersey.identification.trace_file import TraceFile

_SHARE = "friction coefficient"
#: Kinds of the known parameters of a roll on a torsional spring, and of a belt whose force is relative to its
#: weight, where they differ from those of a belt.
_OF_A_TORQUE: dict[str, str | None] = {
    "stiffness": "torsional stiffness",
    "mass": "moment of inertia",
    "transition_force": "torque",
    "transition_speed": "speed",
    "stick_speed": "speed",
}
_OF_A_SHARE: dict[str, str | None] = {
    "stiffness": "stiffness per weight",
    "mass": "mass per weight",
    "transition_force": _SHARE,
}


_SPEED = "Speed of the drive, e.g. '20 mm/s', or '3 rpm' for a trace of torque."
_UNCERTAINTY = "Half width of the 95 % interval of the drive speed, e.g. '2 %'.  [default: 0.1 %]"
_CHANNEL = "Column of the drive speed, whose mean is used, instead of --drive-speed."
_LEAST_DROP = "Count only slips of at least this drop, e.g. '0.5 N'.  [default: above noise]"
_KNOWN = "Known parameter, e.g. 'mass=0.3 kg' ('mass=2 kg*cm^2' for a torque); repeatable."
_CLOSURES = "Closures to compare; stribeck can be added but takes minutes."
_RUN = "Use only this run, counted from 1, of a file whose time restarts."
_TRACE = "Trace of force, torque or speed, in any log format."
_UNIT = "Unit of that column, e.g. 'N'; 1 if the force is relative to the weight."
#: Radius of a roll by which one speed is turned into the other as an example, m.
_RADIUS = 0.015
#: Units in which numbers are printed, and how many make one in SI, by the unit in SI.
_SHOWN = {"m/s": ("mm/s", 1e3), "N/m": ("N/mm", 1e-3)}
#: What drops in a slip, where it is not what the trace holds, and its unit by that of the trace.
_DROPS, _UNITS = {"speed": "stretch"}, {"m/s": "m", "rad/s": "rad"}
#: Kinds of what is derived from the parameters of a drive, which are those of some parameter.
_DERIVED = {
    "release_force": "transition_force",
    "drag_at_drive_speed": "transition_force",
    "drive_speed": "stick_speed",
}


@dataclass(frozen=True)
class _Trace:
    """The drive speed, and the column of the trace."""

    drive_speed: Annotated[str, option(_SPEED)] = ""
    drive_speed_uncertainty: Annotated[str, option(_UNCERTAINTY)] = ""
    drive_speed_channel: Annotated[str, option(_CHANNEL)] = ""
    quantity: Annotated[str, option("Quantity: force, torque or speed.  [default: by name]")] = ""
    time: Annotated[str, option("Time column or variable.")] = ""
    time_unit: TimeUnit = ""
    value: Annotated[str, option("Column or variable of the quantity.")] = ""
    unit: Annotated[str, option(_UNIT)] = ""
    least_drop: Annotated[str, option(_LEAST_DROP)] = ""

    def runs(self, file: Path) -> list[tuple[TraceFile, TraceFile | None]]:
        """Return the runs of a file, each with the column of its drive speed if that is named."""
        from hersey.identification.trace_file import read_trace_runs

        of = {name: getattr(self, name) for name in ("time", "time_unit")}
        runs = read_trace_runs(file, quantity=self.quantity, value=self.value, unit=self.unit, **of)
        if not self.drive_speed_channel:
            return [(run, None) for run in runs]
        speeds = read_trace_runs(file, quantity="speed", value=self.drive_speed_channel, **of)
        return list(zip(runs, speeds, strict=True))

    def record(self, given: TraceFile, speed: float | FloatArray | None) -> CycleRecord:
        """Return the cycles of a run."""
        from hersey.identification.cycle_record import cycles
        from hersey.identification.cycle_warnings import in_unit

        uncertainty = self.drive_speed_uncertainty
        record = cycles(
            given.time,
            given.value,
            drive_speed=speed,
            drive_speed_uncertainty=share("--drive-speed-uncertainty", uncertainty) if uncertainty else None,
            quantity="speed" if given.quantity == "speed" else "force",
            least_drop=_least_drop(self.least_drop, given),
        )
        force = given.quantity != "speed"
        unit = given.unit if force else _UNITS.get(given.unit, given.unit)
        found = (in_unit(each, unit, chosen=force) for each in record.warnings)
        return replace(record, warnings=(*found, *given.warnings))


@dataclass(frozen=True)
class _Identification:
    """Whether to identify the drive, and its known parameters."""

    identify: Annotated[bool, option("Identify the drive behind the cycles.", "--identify")] = False
    known: Annotated[list[str] | None, option(_KNOWN, metavar="NAME=VALUE")] = None
    closures: Annotated[str, option(_CLOSURES)] = "retained,stiction"

    def drive(
        self, record: CycleRecord, known: dict[str, float], unit: str, *, instead: str
    ) -> IdentifiedDrive | None:
        """Return the drive, if it is to be identified; ``instead``: what to do if there is no stick-slip."""
        from hersey.identification.identified_drive import identify

        if not self.identify:
            return None
        with working("identifying the drive"):
            try:
                compared = tuple(self.closures.replace(" ", "").split(","))
                return identify(record, known=known, closures=compared, unit=unit)
            except InsufficientDataError as error:
                error.remedy = followed_by(error.remedy, instead)
                raise


@grouped
def cycles(
    file: Annotated[Path, argument("TRACE", _TRACE)],
    *,
    trace: _Trace,
    sought: _Identification,
    figure: Annotated[Path | None, drawn("trace, slips and fit")] = None,
    run_number: Annotated[int, option(_RUN, metavar="N")] = 0,
    max_memory: MaxMemory = "2 GB",
    printing: Printing,
    force: Force = False,
) -> None:
    """Find the slips of a stick-slip trace, and with --identify the drive behind them.

    Example: [bold]hersey cycles examples/stick-slip.csv --drive-speed "20 mm/s" --identify[/bold]
    """
    drawing = may_draw(figure, force, inputs=[file])
    if trace.drive_speed and trace.drive_speed_channel:
        raise ParameterError("--drive-speed and --drive-speed-channel exclude each other: give one of them")
    if sought.known and not sought.identify:
        raise ParameterError("--known needs --identify")

    from hersey.log import memory_limit

    with memory_limit(max_memory):
        runs = trace.runs(file)
    chosen = _chosen(file, len(runs), run_number, alone=figure is not None or printing.as_json)
    for number in chosen:
        given, channel = runs[number]
        speed = _drive_speed(trace.drive_speed, given) if channel is None else _of_channel(channel, given)
        known = _known(sought.known or [], given)
        record = trace.record(given, speed)
        drag_only = record.kind == "steady_sliding" and given.quantity == "torque"
        for_drag = f"For the drag of steady sliding type: {retyped('report', str(file))}" * drag_only
        unit = _UNITS.get(given.unit, given.unit).replace("*", " ")
        drive = sought.drive(record, known, unit, instead=for_drag)
        shown = "share of the weight" if given.unit == "1" else unit
        drawing.draw(record, drive=drive, unit=shown)
        if printing.json(record, unit=given.unit, drive=drive):
            continue
        if len(chosen) > 1:
            printing.text(*([""] if number != chosen[0] else []), f"Run {number + 1} of {len(runs)}")
        called = _DROPS.get(given.quantity, given.quantity)
        whole = [record.summary(unit, called=called), *([] if drive is None else ["", drive.summary(unit)])]
        warned = (*record.warnings, *(() if drive is None else drive.warnings))
        printing.conclusion(partial(_lines, record, drive, unit, called), "\n".join(whole), *warned)
        if for_drag:
            printing.text(for_drag)
        printing.files(figure)


def _lines(record: CycleRecord, drive: IdentifiedDrive | None, unit: str, called: str) -> list[str]:
    """The motion and its figures, then the drive that makes it; ``called`` as in `CycleRecord.summary`."""
    import numpy as np

    from hersey.cli.figures import labelled, three
    from hersey.identification.detection import FEWEST_SLIPS

    of, lines = {"1": "of the weight"}.get(unit, unit), [sentence(record.headline(unit, called=called))]
    if record.kind != "steady_sliding" and record.slips >= FEWEST_SLIPS:
        what = {"stick_slip": "Stick-slip", "inertial": "Inertial oscillation"}[record.kind]
        lines = [f"{what} with {record.slips} slips."]
        lap, drop = float(np.median(record.period)), float(np.median(record.drop))
        low, high = float(np.median(record.force_min)), float(np.median(record.force_max))
        rows = [
            ("frequency", f"{three(1 / lap, 'Hz')} (period {three(lap, 's')})"),
            (called, f"{three(low)} to {three(high)} {of}, drop {three(drop)} {of}"),
            ("stuck", f"{100 * record.stuck_fraction:.0f} % of the time"),
        ]
        if record.stiffness:
            name, factor = _SHOWN.get(f"{unit}/m", (f"{unit}/{'rad' if unit == 'N m' else 'm'}", 1.0))
            rows.append(("stiffness", f"{three(factor * record.stiffness)} {name} (loading slope / speed)"))
        lines += labelled(rows)
    return lines + ([] if drive is None else _identified(drive, unit))


def _identified(drive: IdentifiedDrive, unit: str) -> list[str]:
    """The closure, and what the trace determines of the drive."""
    from hersey.cli.figures import labelled, three, within
    from hersey.motion.parameters import OF_THE_BELT

    decided = "" if drive.decided else " (the others fit as well)"
    misfit = f"the fit is within {three(100 * drive.misfit)} % of the drop"
    rows = []
    for name, known in {**drive.estimates, **drive.derived}.items():
        of, factor = _unit_of(name, unit)
        shown = within((known.value, known.low, known.high), of, factor=factor)
        rows.append((name.replace("_", " "), shown))
    for name, value in drive.known.items():
        of, factor = _unit_of(name, unit)
        rows.append((name.replace("_", " "), f"{three(factor * value, of)} (given)"))
    lines = ["", f"Drive: closure {drive.closure}{decided}; {misfit}.", *labelled(rows)]
    open_ones = [name for name in OF_THE_BELT if name not in drive.estimates and name not in drive.known]
    if open_ones:
        lines.append(f"Not determined by this trace: {', '.join(open_ones).replace('_', ' ')}.")
    speed = three(_unit_of("drive_speed", unit)[1] * drive.drive_speed, _unit_of("drive_speed", unit)[0])
    known_to = f"{three(100 * drive.drive_speed_uncertainty)} %"
    return [*lines, f"The intervals assume a drive speed of {speed} within {known_to}."]


def _unit_of(name: str, unit: str) -> tuple[str, float]:
    """The unit in which a number of a drive is printed, and its factor; ``unit`` is that of the trace."""
    from hersey.motion.parameters import KINDS
    from hersey.units import KINDS as UNITS

    if name == "free_period":
        return "s", 1.0
    kinds = {"N": KINDS, "N m": KINDS | _OF_A_TORQUE}.get(unit, {})
    kind = kinds.get(_DERIVED.get(name, name))
    si = UNITS[kind][0] if kind else ""
    return _SHOWN.get(si, (si.replace("*", "·"), 1.0))


def _chosen(trace: Path, runs: int, stated: int, *, alone: bool) -> list[int]:
    """The runs of a file that are used, counted from 0; ``alone``: only one can be."""
    if stated > runs or stated < 0:
        raise ParameterError(f"--run-number is {stated}: {trace.name} holds {runs} run{'s' * (runs > 1)}")
    if stated:
        return [stated - 1]
    if alone and runs > 1:
        raise ParameterError(
            f"{trace.name} holds {runs} runs, because its time restarts; --figure and --json show one: "
            f"choose it with --run-number 1 to {runs}"
        )
    return list(range(runs))


def _of_channel(channel: TraceFile, given: TraceFile) -> FloatArray:
    """The drive speed at the times of the trace."""
    import numpy as np

    turning = _turns(given)
    if turning != (channel.unit == "rad/s"):
        raise WrongKindError(
            f"--drive-speed-channel {channel.name}: with a trace of {given.quantity} in {given.unit} it must "
            f"be {'an angular speed' if turning else 'a sliding speed'}"
        )
    seen = np.isfinite(channel.value)
    return np.asarray(np.interp(given.time, channel.time[seen], channel.value[seen]))


def _turns(given: TraceFile) -> bool:
    """Whether a trace is of a roll, not of a belt."""
    return given.quantity == "torque" or given.unit == "rad/s"


def _drive_speed(text: str, given: TraceFile) -> float | None:
    if not text:
        return None
    wanted, other = ("speed", "belt speed") if _turns(given) else ("belt speed", "speed")
    try:
        return belt_speed_of(text, "--drive-speed", wanted)
    except WrongKindError as error:
        try:
            speed = belt_speed_of(text, "--drive-speed", other)
        except WrongKindError:
            raise error from None
        raise _other_speed(text, speed, given) from None


def _other_speed(text: str, speed: float, given: TraceFile) -> WrongKindError:
    """Say that the speed of a belt was given for that of a roll, or the other way round, and what to type."""
    from hersey.identification.trace_file import RELATIVE
    from hersey.units import rpm

    trace = given.quantity if given.unit == RELATIVE else f"{given.quantity} in {given.unit}"
    if _turns(given):
        is_of, needed, by = "a sliding speed", "a rotational speed", "divide it by"
        typed = f"{rpm(speed / _RADIUS):.3g} rpm"
    else:
        is_of, needed, by = "a rotational speed", "a sliding speed", "multiply it by"
        typed = f"{1e3 * speed * _RADIUS:.3g} mm/s"
    return WrongKindError(
        f"--drive-speed '{text}' is {is_of}, but a trace of {trace} needs {needed}",
        remedy=f"{by} the radius, e.g. at {1e3 * _RADIUS:g} mm type --drive-speed '{typed}'",
    )


def _least_drop(text: str, given: TraceFile) -> float | None:
    from hersey.identification.trace_file import RELATIVE
    from hersey.units import parse

    if not text:
        return None
    if given.quantity == "speed":
        raise ParameterError("--least-drop is a drop of force: omit it for a trace of speed")
    if given.unit == RELATIVE:
        return _of_the_weight("--least-drop", text)
    try:
        return parse(given.quantity, text)
    except UnitError as error:
        raise UnitError(f"--least-drop: {error}") from None


def _known(texts: list[str], given: TraceFile) -> dict[str, float]:
    from hersey.identification.trace_file import RELATIVE
    from hersey.motion.parameters import KINDS, OF_THE_BELT

    kinds = KINDS | (_OF_A_TORQUE if given.quantity == "torque" else {})
    kinds |= _OF_A_SHARE if given.unit == RELATIVE else {}
    values = {}
    for text in texts:
        name, sign, amount = (part.strip() for part in text.partition("="))
        if not sign or name not in OF_THE_BELT:
            raise ParameterError(f"--known '{text}': write NAME=VALUE with one of {', '.join(OF_THE_BELT)}")
        values[name] = _amount(f"--known {name}", amount, kinds[name])
    return values


def _amount(where: str, text: str, kind: str | None) -> float:
    from hersey.units import parse

    if kind is None:
        return _number(where, text)
    if kind == _SHARE:
        return _of_the_weight(where, text)
    try:
        return parse(kind, text)
    except UnitError as error:
        raise type(error)(f"{where}: {error}") from None


def _of_the_weight(where: str, text: str) -> float:
    """A force relative to the weight, the one number that needs no unit."""
    return share(where, text) if text.strip().endswith("%") else _number(where, text)


def _number(where: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ParameterError(f"{where} is '{text}': write a number") from None
