"""From a trace of stick-slip: ``hersey cycles``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, Force, MaxMemory, TimeUnit, drawn
from hersey.cli.outputs import may_draw, print_json, say_written
from hersey.cli.progress import working
from hersey.cli.quantities import belt_speed_of, share
from hersey.cli.terminal import say
from hersey.errors import ParameterError, UnitError, WrongKindError

if TYPE_CHECKING:
    from hersey.arrays import FloatArray
    from hersey.identification.cycle_record import CycleRecord
    from hersey.identification.identified_drive import IdentifiedDrive
    from hersey.identification.trace_file import TraceFile

_SHARE = "friction coefficient"
#: Kinds of the known parameters where they are not those of a belt: of a roll on a torsional spring, and of a
#: belt whose force is a share of its weight.
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


_UNCERTAINTY = "How far the drive speed may be off, as '2 %': half of its 95 % interval.  [default: 0.1 %]"
_CHANNEL = "Instead of --drive-speed: the column of it, of which the mean counts."
_LEAST_DROP = "Count slips of at least this fall, as '0.5 N' (default: beyond noise)."
_KNOWN = "A known parameter, as 'mass=0.3 kg' ('mass=2 kg*cm^2' with a torque); repeatable."
_CLOSURES = "Closures to compare; stribeck may be added and takes minutes."
_RUN = "Look only at this run, counted from 1, where the clock of the file starts anew."


@dataclass(frozen=True)
class _Trace:
    """The drive speed, and what of a file is the trace."""

    drive_speed: Annotated[str, option("Speed of the drive, as '20 mm/s', or '3 rpm' with a torque.")] = ""
    drive_speed_uncertainty: Annotated[str, option(_UNCERTAINTY)] = ""
    drive_speed_channel: Annotated[str, option(_CHANNEL)] = ""
    quantity: Annotated[str, option("force, torque or speed; found by name if left out.")] = ""
    time: Annotated[str, option("Name of the time column or variable.")] = ""
    time_unit: TimeUnit = ""
    value: Annotated[str, option("Name of the column or variable of the quantity.")] = ""
    unit: Annotated[str, option("Its unit, as 'N'; 1 for a share of a weight.")] = ""
    least_drop: Annotated[str, option(_LEAST_DROP)] = ""

    def runs(self, file: Path) -> list[tuple[TraceFile, TraceFile | None]]:
        """Return the runs of a file, each with the channel of its drive speed if that is named."""
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

        uncertainty = self.drive_speed_uncertainty
        record = cycles(
            given.time,
            given.value,
            drive_speed=speed,
            drive_speed_uncertainty=share("--drive-speed-uncertainty", uncertainty) if uncertainty else None,
            quantity="speed" if given.quantity == "speed" else "force",
            least_drop=_least_drop(self.least_drop, given),
        )
        return replace(record, warnings=(*record.warnings, *given.warnings))


@dataclass(frozen=True)
class _Identification:
    """Whether the drive behind the cycles is sought, and what is known of it."""

    identify: Annotated[bool, option("Also identify the drive behind the cycles.", "--identify")] = False
    known: Annotated[list[str] | None, option(_KNOWN, metavar="NAME=VALUE")] = None
    closures: Annotated[str, option(_CLOSURES)] = "retained,stiction"

    def drive(self, record: CycleRecord, known: dict[str, float]) -> IdentifiedDrive | None:
        """Return the drive, if it is sought."""
        from hersey.identification.identified_drive import identify

        if not self.identify:
            return None
        with working("identifying the drive"):
            return identify(record, known=known, closures=tuple(self.closures.replace(" ", "").split(",")))


@grouped
def cycles(
    file: Annotated[Path, argument("TRACE", "Trace in any format that a log may have.")],
    *,
    trace: _Trace,
    sought: _Identification,
    figure: Annotated[Path | None, drawn("trace, slips and fit")] = None,
    run_number: Annotated[int, option(_RUN, metavar="N")] = 0,
    max_memory: MaxMemory = "2 GB",
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find the slips of a stick-slip trace, and with --identify the drive that makes them.

    Example: [bold]hersey cycles examples/stick-slip.csv --drive-speed "20 mm/s" --identify[/bold]
    """
    drawing = may_draw(figure, force, inputs=[file])
    if trace.drive_speed and trace.drive_speed_channel:
        raise ParameterError("give either --drive-speed or --drive-speed-channel")
    if sought.known and not sought.identify:
        raise ParameterError("--known needs --identify")

    from hersey.log import memory_limit

    with memory_limit(max_memory):
        runs = trace.runs(file)
    chosen = _chosen(file, len(runs), run_number, alone=figure is not None or as_json)
    for number in chosen:
        given, channel = runs[number]
        speed = _drive_speed(trace.drive_speed, given) if channel is None else _of_channel(channel, given)
        known = _known(sought.known or [], given)
        record = trace.record(given, speed)
        drive, unit = sought.drive(record, known), given.unit.replace("*", " ")
        shown = "share of the weight" if given.unit == "1" else unit
        drawing.draw(record, drive=drive, unit=shown)
        if as_json:
            print_json(record, unit=given.unit, drive=drive)
            continue
        say("\n" * (number != chosen[0]) + record.summary(unit))
        if drive is not None:
            say("\n" + drive.summary(unit))
        say_written(figure=figure)


def _chosen(trace: Path, runs: int, stated: int, *, alone: bool) -> list[int]:
    """Which runs of a file are looked at, counted from 0; ``alone``: only one can be."""
    if stated > runs or stated < 0:
        raise ParameterError(f"--run-number is {stated}: {trace.name} holds {runs} run{'s' * (runs > 1)}")
    if stated:
        return [stated - 1]
    if alone and runs > 1:
        raise ParameterError(
            f"{trace.name} holds {runs} runs, for its clock starts anew: a figure or --json shows one, "
            f"choose it with --run-number 1 to {runs}"
        )
    return list(range(runs))


def _of_channel(channel: TraceFile, given: TraceFile) -> FloatArray:
    """The drive speed at the times of the trace."""
    import numpy as np

    turning = _turns(given)
    if turning != (channel.unit == "rad/s"):
        raise WrongKindError(
            f"--drive-speed-channel {channel.name} with a trace of {given.quantity} in {given.unit}: it must "
            f"be {'an angular speed' if turning else 'the speed of a belt'}"
        )
    seen = np.isfinite(channel.value)
    return np.asarray(np.interp(given.time, channel.time[seen], channel.value[seen]))


def _turns(given: TraceFile) -> bool:
    """Whether a trace is of a roll, not of a belt."""
    return given.quantity == "torque" or given.unit == "rad/s"


def _drive_speed(text: str, given: TraceFile) -> float | None:
    if not text:
        return None
    try:
        return belt_speed_of(text, "--drive-speed", "speed" if _turns(given) else "belt speed")
    except WrongKindError as error:
        raise WrongKindError(
            f"--drive-speed with a trace of {given.quantity} in {given.unit}: {error}"
        ) from None


def _least_drop(text: str, given: TraceFile) -> float | None:
    from hersey.identification.trace_file import RELATIVE
    from hersey.units import parse

    if not text:
        return None
    if given.quantity == "speed":
        raise ParameterError("--least-drop counts falls of a force: leave it out with a trace of speed")
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
    """A force as a share of the weight: the one number that needs no unit."""
    return share(where, text) if text.strip().endswith("%") else _number(where, text)


def _number(where: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ParameterError(f"{where} is '{text}': write a number") from None
