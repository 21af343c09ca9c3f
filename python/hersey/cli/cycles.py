"""From a trace of stick-slip: ``hersey cycles``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Force,
    MaxMemory,
    share,
)
from hersey.cli.outputs import may_draw, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError, UnitError, WrongKindError

if TYPE_CHECKING:
    from hersey.arrays import FloatArray
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


def cycles(
    trace: Annotated[Path, typer.Argument(metavar="TRACE", help="Trace in any format that a log may have.")],
    drive_speed: Annotated[
        str, typer.Option(help="Speed of the drive, as '20 mm/s', or '3 rpm' with a torque.")
    ] = "",
    drive_speed_uncertainty: Annotated[
        str,
        typer.Option(
            help="How far the drive speed may be off, as '2 %': half of its 95 % interval.  [default: 0.1 %]"
        ),
    ] = "",
    drive_speed_channel: Annotated[
        str, typer.Option(help="Instead of --drive-speed: the column of it, of which the mean counts.")
    ] = "",
    quantity: Annotated[str, typer.Option(help="force, torque or speed; found by name if left out.")] = "",
    time: Annotated[str, typer.Option(help="Name of the time column or variable.")] = "",
    time_unit: Annotated[str, typer.Option(help="Unit of time, as 's' or 'ms'.")] = "",
    value: Annotated[str, typer.Option(help="Name of the column or variable of the quantity.")] = "",
    unit: Annotated[str, typer.Option(help="Its unit, as 'N'; 1 for a share of a weight.")] = "",
    least_drop: Annotated[
        str, typer.Option(help="Count slips of at least this fall, as '0.5 N' (default: beyond noise).")
    ] = "",
    identify: Annotated[
        bool, typer.Option("--identify", help="Also identify the drive behind the cycles.")
    ] = False,
    known: Annotated[
        list[str] | None,
        typer.Option(
            "--known",
            metavar="NAME=VALUE",
            help="A known parameter, as 'mass=0.3 kg' ('mass=2 kg*cm^2' with a torque); repeatable.",
        ),
    ] = None,
    closures: Annotated[
        str, typer.Option(help="Closures to compare; stribeck may be added and takes minutes.")
    ] = "retained,stiction",
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Draw trace, slips and fit: .html, .png, .svg or .pdf.")
    ] = None,
    run_number: Annotated[
        int,
        typer.Option(
            metavar="N",
            help="Look only at this run, counted from 1, where the clock of the file starts anew.",
        ),
    ] = 0,
    max_memory: MaxMemory = "2 GB",
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find the slips of a stick-slip trace, and with --identify the drive that makes them.

    Example: [bold]hersey cycles examples/stick-slip.csv --drive-speed "20 mm/s" --identify[/bold]
    """
    overwrite = figure is not None and may_draw(figure, force, inputs=[trace])
    if drive_speed and drive_speed_channel:
        raise ParameterError("give either --drive-speed or --drive-speed-channel")
    if known and not identify:
        raise ParameterError("--known needs --identify")

    from hersey.files.writing import write_atomically
    from hersey.identification.cycle_record import cycles as find_cycles
    from hersey.identification.identified_drive import identify as identify_drive
    from hersey.identification.trace_file import read_trace_runs
    from hersey.log import memory_limit

    with memory_limit(max_memory):
        runs = read_trace_runs(
            trace, quantity=quantity, time=time, value=value, time_unit=time_unit, unit=unit
        )
        channels: tuple[TraceFile, ...] = ()
        if drive_speed_channel:
            channels = read_trace_runs(
                trace, quantity="speed", value=drive_speed_channel, time=time, time_unit=time_unit
            )
    chosen = _chosen(trace, len(runs), run_number, alone=figure is not None or as_json)
    for number in chosen:
        given = runs[number]
        unit_shown = given.unit.replace("*", " ")
        speed = _drive_speed(drive_speed, given) if not channels else _of_channel(channels[number], given)
        values = _known(known or [], given)
        record = find_cycles(
            given.time,
            given.value,
            drive_speed=speed,
            drive_speed_uncertainty=share("--drive-speed-uncertainty", drive_speed_uncertainty)
            if drive_speed_uncertainty
            else None,
            quantity="speed" if given.quantity == "speed" else "force",
            least_drop=_least_drop(least_drop, given),
        )
        record = replace(record, notes=(*record.notes, *given.notes))
        drive = None
        if identify:
            with working("identifying the drive"):
                drive = identify_drive(
                    record, known=values, closures=tuple(closures.replace(" ", "").split(","))
                )
        if figure is not None:
            from hersey.charts import chart_of
            from hersey.charts.render import picture

            unit_text = "share of the weight" if given.unit == "1" else unit_shown
            with working("drawing"):
                drawing = picture(chart_of(record, drive=drive, unit=unit_text), figure.suffix)
            write_atomically(figure, drawing, overwrite=overwrite)
        if as_json:
            driven = None if drive is None else drive.to_dict()
            print_json("cycles", record.to_dict() | {"unit": given.unit, "drive": driven})
            continue
        say("\n" * (number != chosen[0]) + record.summary(unit_shown))
        if drive is not None:
            say("\n" + drive.summary(unit_shown))
        if figure is not None:
            say(f"figure: {figure}")


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

    turning = given.quantity == "torque" or given.unit == "rad/s"
    if turning != (channel.unit == "rad/s"):
        raise WrongKindError(
            f"--drive-speed-channel {channel.name} with a trace of {given.quantity} in {given.unit}: it must "
            f"be {'an angular speed' if turning else 'the speed of a belt'}"
        )
    seen = np.isfinite(channel.value)
    return np.asarray(np.interp(given.time, channel.time[seen], channel.value[seen]))


def _drive_speed(text: str, given: TraceFile) -> float | None:
    from hersey.units import parse

    if not text:
        return None
    turning = given.quantity == "torque" or given.unit == "rad/s"
    try:
        speed = parse("speed" if turning else "belt speed", text)
    except WrongKindError as error:
        raise WrongKindError(
            f"--drive-speed with a trace of {given.quantity} in {given.unit}: {error}"
        ) from None
    if not speed > 0:
        raise ParameterError(f"--drive-speed is {text}: it must be greater than 0")
    return speed


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
    from hersey.units import parse

    kinds = KINDS | (_OF_A_TORQUE if given.quantity == "torque" else {})
    kinds |= _OF_A_SHARE if given.unit == RELATIVE else {}
    values = {}
    for text in texts:
        name, sign, amount = (part.strip() for part in text.partition("="))
        if not sign or name not in OF_THE_BELT:
            raise ParameterError(f"--known '{text}': write NAME=VALUE with one of {', '.join(OF_THE_BELT)}")
        where, kind = f"--known {name}", kinds[name]
        if kind is None:
            values[name] = _number(where, amount)
            continue
        if kind == _SHARE:
            values[name] = _of_the_weight(where, amount)
            continue
        try:
            values[name] = parse(kind, amount)
        except UnitError as error:
            raise type(error)(f"{where}: {error}") from None
    return values


def _of_the_weight(where: str, text: str) -> float:
    """A force as a share of the weight: the one number that needs no unit."""
    return share(where, text) if text.strip().endswith("%") else _number(where, text)


def _number(where: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ParameterError(f"{where} is '{text}': write a number") from None
