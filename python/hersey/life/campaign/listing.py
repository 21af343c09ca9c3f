"""The runs of a campaign as a table, and its specimens as text."""

from __future__ import annotations

import shlex
import sqlite3
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.errors import ParameterError, way_in
from hersey.life.age import Age
from hersey.life.campaign.adding import as_kept, lies_at, no_specimen
from hersey.life.maintenance import Event

if TYPE_CHECKING:
    import polars as pl

_LISTED = "id, unit, age, path, sha256, dwells, exponent, transition_speed, no_fit, version, added"


def runs_of(database: sqlite3.Connection, path: Path, unit: str) -> pl.DataFrame:
    """Return one row per run, as `Campaign.runs`.

    Raises
    ------
    ParameterError
        If there is no such specimen.
    """
    import polars as pl

    where, given = ("WHERE unit = ?", (as_kept(unit),)) if unit else ("", ())
    rows = database.execute(f"SELECT {_LISTED} FROM runs {where} ORDER BY unit, age, id", given)
    home = path.absolute().parent
    listed = [(*row[:3], str(lies_at(row[3], home)), *row[4:]) for row in rows]
    if unit and not listed:
        raise no_specimen(database, path, unit)
    numbers: dict[str, Any] = dict.fromkeys(("age", "exponent", "transition_speed"), pl.Float64)
    names = ["run", "unit", "age", "log", *_LISTED.split(", ")[4:]]
    kinds = dict.fromkeys(names, pl.String) | numbers | {"run": pl.Int64, "dwells": pl.Int64}
    return pl.DataFrame(listed, schema=kinds, orient="row")


def no_run(path: Path, run: int) -> ParameterError:
    """Return the error of a run that is not there, with what lists those that are."""
    way = f"hersey campaign list {shlex.quote(str(path))}" if way_in() == "terminal" else "campaign.runs()"
    return ParameterError(f"{path.name} has no run {run}", remedy=f"list them with: {way}")


def overview(database: sqlite3.Connection, name: str, events: list[Event], age_unit: str) -> str:
    """Return how many runs and specimens there are, and a line per specimen with its maintenance."""
    specimens = database.execute(
        "SELECT unit, count(*), min(age), max(age), sum(dwells), sum(no_fit != '') FROM runs "
        "GROUP BY unit ORDER BY unit"
    ).fetchall()
    done: dict[str, list[str]] = {}
    for each in events:
        done.setdefault(each.unit, []).append(f"  {each.kind} at {each.age}")
    plural = "s" * (len(specimens) != 1)
    lines = [f"{name}: {sum(row[1] for row in specimens)} runs of {len(specimens)} specimen{plural}"]
    for unit, count, start, end, dwells, failed in specimens:
        first, last = Age(start, age_unit), Age(end, age_unit)
        ages = f"at {first}" if first == last else f"{first.value:.10g} to {last}"
        text = f"{unit}: {count} run{'s' * (count > 1)}, {ages}, {dwells} dwells"
        lines += [text + (f", {failed} without a fit" if failed else ""), *done.get(unit, [])]
    return "\n".join(lines)
