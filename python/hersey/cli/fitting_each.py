"""A separate fit of each of many logs, as a table: ``hersey fit --each``."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hersey.arrays import one_thread
from hersey.cli.options import Reading
from hersey.cli.outputs import NOT_FOUND, Output
from hersey.cli.printing import Printing
from hersey.cli.progress import bar
from hersey.cli.terminal import say
from hersey.cli.workers import Crew
from hersey.errors import HerseyError

if TYPE_CHECKING:
    from hersey.damping.estimate import Estimate
    from hersey.machine.machine import Machine
    from hersey.schema.warning import Warning


#: Other logs of which it is looked up whether they state a unit that one lacks.
_OTHERS = 3
#: Logs that a warning names.
_NAMED = 3


def fit_each(
    logs: list[Path],
    reading: Reading,
    machine: Machine | None,
    table: Output,
    keep_going: bool,
    crew: Crew,
    printing: Printing,
) -> None:
    """Fit each log separately and write a table with a row for each, in their order."""
    from hersey.log.many import collected, each_of, failure_line

    files = logs if crew.scheduler is None else [log.absolute() for log in logs]
    task = partial(
        row, reading if crew.scheduler is None else reading.anywhere(), machine, others=files[:_OTHERS]
    )
    with crew.at_work() as client, bar("fitting", unit="logs") as progress:
        results = each_of(task, files, client=client, progress=progress)
        fits = collected(logs, results, keep_going)
    rows = [{"log": str(log), **fitted} for log, (fitted, _) in fits.items()]
    if rows and table.path is not None:
        table.write(_table(rows, table.path.suffix))
        printing.text(f"{len(rows)} of {len(logs)} logs are fitted.")
        printing.warnings(*_joint({log: replaced for log, (_, replaced) in fits.items()}))
        printing.files(table.path)
    if fits.failures:
        say(*(f"- {failure_line(*failed)}" for failed in fits.failures.items()), file=sys.stderr)
        raise typer.Exit(NOT_FOUND)


def row(
    reading: Reading, machine: Machine | None, log: Path, *, others: Sequence[Path] = ()
) -> tuple[dict[str, Any], list[Warning]] | HerseyError:
    """Return dwells, fit and verdict of a log, in SI, with its 95 % intervals, and which units were replaced.

    Or what is wrong with the log.
    """
    from hersey.damping.fit import fit
    from hersey.log.replaced import UNIT_REPLACED
    from hersey.verdict.regime import regime

    try:
        with one_thread():
            points = reading.points_of([log], machine, [each for each in others if each != log])
            surface = fit(points, temperature_scale=reading.temperature_scale)
            words = regime(points, surface).headline()
    except HerseyError as error:
        return error
    bend, kelvin = surface.transition, surface.temperature_range or (None, None)
    fitted = {
        "dwells": points.table.height,
        "speed from (rad/s)": surface.speed_range[0],
        "speed to (rad/s)": surface.speed_range[1],
        "temperature from (K)": kelvin[0],
        "temperature to (K)": kelvin[1],
        **_columns("a", f"N m s/rad at T = 1 {surface.temperature_scale}, w = 1 rad/s", surface.a),
        **_columns("b", "", surface.b),
        **_columns("c", "", surface.c),
        **_columns("c below the transition", "", None if bend is None else bend.mixed_exponent),
        **_columns("transition speed", "rad/s", None if bend is None else bend.speed),
        "regime": words,
    }
    return fitted, [each for file in points.log.files for each in file.warnings if each.kind == UNIT_REPLACED]


def _joint(found: Mapping[Path, Sequence[Warning]]) -> list[Warning]:
    """Warnings by log, those that are the same as one with the names of their logs."""
    logs: dict[tuple[object, ...], list[Path]] = {}
    first: dict[tuple[object, ...], Warning] = {}
    for log, warnings in found.items():
        for each in warnings:
            same = (each.kind, *each.values.items())
            first.setdefault(same, each)
            logs.setdefault(same, []).append(log)
    return [each.within(_names(logs[same])) for same, each in first.items()]


def _names(logs: Sequence[Path]) -> str:
    named, more = ", ".join(map(str, logs[:_NAMED])), len(logs) - _NAMED
    return f"{named} and {more} more" if more > 0 else named


def _columns(name: str, unit: str, known: Estimate | None) -> dict[str, float | None]:
    ends = (None, None, None) if known is None else (known.value, known.low, known.high)
    return {
        f"{name}{end}{f' ({unit})' * bool(unit)}": value
        for end, value in zip(("", " low", " high"), ends, strict=True)
    }


def _table(rows: list[dict[str, Any]], suffix: str) -> bytes:
    import polars as pl

    from hersey.files.tables import table

    kinds = {"log": pl.String, "regime": pl.String, "dwells": pl.Int64}
    schema = {name: kinds.get(name, pl.Float64) for name in rows[0]}
    return table(pl.DataFrame(rows, schema=schema), suffix)
