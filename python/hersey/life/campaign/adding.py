"""Adding a run: which are new, there already, changed, or under another specimen or age."""

from __future__ import annotations

import datetime
import json
import os
import re
import sqlite3
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.errors import FORCE, ParameterError, meant, printable
from hersey.life.age import Age
from hersey.life.campaign.entry import COLUMNS, Entry
from hersey.result import Record
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

#: What became of a run.
ADDED, ALREADY, REPLACED = "added", "already there", "replaced"
_LONGEST_UNIT = 60
#: Specimens that a message lists.
_SPECIMENS = 12


@dataclass(frozen=True)
class Added(Record):
    """What became of a run, number ``run``: ``outcome`` is ``added``, ``already there`` or ``replaced``."""

    run: int
    unit: str
    age: Age
    path: str
    dwells: int
    outcome: str
    warnings: tuple[Warning, ...] = ()

    def summary(self) -> str:
        """Return it in a line, and a line for each warning."""
        name = Path(self.path).name
        head = f"{name}: {self.outcome} as run {self.run}, {self.unit} at {self.age}, {self.dwells} dwells"
        return "\n".join([head, *(f"- {each}" for each in self.warnings)])

    def to_frame(self) -> pl.DataFrame:
        """Return it as a table of one row."""
        import polars as pl

        age = {f"age ({self.age.unit})": self.age.value}
        named = {"run": self.run, "unit": self.unit, **age, "log": self.path}
        return pl.DataFrame({**named, "dwells": self.dwells, "outcome": self.outcome})


def stored(path: str, home: Path) -> str | bytes:
    """Return how a log's path stands in the file: from the campaign's folder if it lies there, else whole."""
    inside = os.path.relpath(path, home)
    kept = path if inside.startswith(os.pardir) else inside
    try:
        kept.encode()
    except UnicodeEncodeError:  # a name that is no text
        return os.fsencode(kept)
    return kept


def lies_at(kept: str | bytes, home: Path) -> Path:
    """Return the path of a log, whole."""
    return home / os.fsdecode(kept)


def age_unit(database: sqlite3.Connection) -> str:
    """Return the unit of a campaign's ages, empty before the first run."""
    row = database.execute("SELECT value FROM campaign WHERE name = 'age unit'").fetchone()
    return str(row[0]) if row else ""


def add_entry(
    database: sqlite3.Connection, home: Path, entry: Entry, unit: str, age: Age, force: bool
) -> Added:
    """Add a run inside a transaction.

    Raises
    ------
    ParameterError
        If it is changed, or under another specimen or age, and ``force`` is false.
    UnitError
        If the ages of the campaign are in another unit.
    """
    age = _in_the_unit_of_all(database, age)
    unit = _unit(database, unit, force)
    path, count = stored(entry.path, home), len(entry.dwells)
    warnings = []
    if entry.no_fit:
        warnings.append(
            Warning(
                "added without a fit", "added without a fit: {reason}", severity="watch", reason=entry.no_fit
            )
        )
    there = database.execute(
        "SELECT id, unit, age, settings FROM runs WHERE sha256 = ?", (entry.sha256,)
    ).fetchone()
    if there is not None:
        run, *place, settings = there
        if not force:
            if place != [unit, age.value] or settings != entry.settings:
                raise _there_otherwise(entry, run, place, unit, age)
            return Added(run, unit, age, entry.path, count, ALREADY)
        if place != [unit, age.value]:
            warnings.append(_moved(place[0], place[1], age.unit))
    measured_after = _events_before(database, sha256=entry.sha256, path=path)
    if there is not None:
        database.execute("DELETE FROM runs WHERE id = ?", (run,))
    replaced, overwritten = _same_path(database, path, entry, unit, age, force)
    outcome = ADDED if there is None and not replaced else REPLACED
    run = _inserted(database, path, entry, unit, age)
    for kind in measured_after:
        of_event = "WHERE (unit, age, kind) = (?, ?, ?) AND run_id IS NULL"
        database.execute(f"UPDATE events SET run_id = ? {of_event}", (run, unit, age.value, kind))
    return Added(run, unit, age, entry.path, count, outcome, (*warnings, *overwritten))


def _events_before(database: sqlite3.Connection, sha256: str, path: str | bytes) -> list[str]:
    """The kinds of the events after which the runs were measured that this one may replace."""
    rows = database.execute(
        "SELECT DISTINCT kind FROM events WHERE run_id IN (SELECT id FROM runs WHERE sha256 = ? OR path = ?)",
        (sha256, path),
    )
    return [row[0] for row in rows]


def _there_otherwise(entry: Entry, run: int, place: list[Any], unit: str, age: Age) -> ParameterError:
    """The error of a log whose content is there as another run, or was read in another way."""
    was = f"{place[0]} at {Age(place[1], age.unit)}"
    what = (
        f"is already run {run}, but was read with other settings. Use {FORCE.to()} to keep the new reading"
        if place == [unit, age.value]
        else f"has the same content as run {run} ({was}). Use {FORCE.to()} to move it to {unit} at {age}"
    )
    return ParameterError(f"{Path(entry.path).name} {what}")


def _moved(unit: str, age: float, age_unit: str) -> Warning:
    return Warning(
        "moved",
        "it was {unit} at {age:.10g} {age_unit} before",
        unit=unit,
        age=age,
        age_unit=age_unit,
    )


def _same_path(
    database: sqlite3.Connection, path: str | bytes, entry: Entry, unit: str, age: Age, force: bool
) -> tuple[bool, list[Warning]]:
    """Remove the run of the same log file that this one replaces; whether there was one, and what stays."""
    replaced, stay = False, []
    for run, of, at in database.execute("SELECT id, unit, age FROM runs WHERE path = ?", (path,)).fetchall():
        same = (of, at) == (unit, age.value)
        if not force:
            way = "replace it" if same else "add it and keep that run, whose log is gone"
            was = f"run {run} ({of} at {Age(at, age.unit)})"
            raise ParameterError(
                f"{Path(entry.path).name} has changed since it was added as {was}. Use {FORCE.to()} to {way}"
            )
        if same:
            replaced = True
            database.execute("DELETE FROM runs WHERE id = ?", (run,))
        else:
            stay.append(_overwritten(run, of, at, age.unit))
    return replaced, stay


def _overwritten(run: int, unit: str, age: float, age_unit: str) -> Warning:
    return Warning(
        "log overwritten",
        "the log of run {run} ({unit} at {age:.10g} {age_unit}) was overwritten; its dwells stay in "
        "the campaign",
        severity="watch",
        run=run,
        unit=unit,
        age=age,
        age_unit=age_unit,
    )


def is_there(database: sqlite3.Connection, sha256: str, unit: str, age: Age, settings: str) -> Added | None:
    """Return the run of a log with this hash if adding it so would change nothing."""
    row = database.execute(
        "SELECT id, age, path, dwells FROM runs WHERE (sha256, unit, settings) = (?, ?, ?)",
        (sha256, unit, settings),
    ).fetchone()
    if row is None or age.as_unit(age_unit(database)).value != row[1]:
        return None
    return Added(row[0], unit, age, os.fsdecode(row[2]), row[3], ALREADY)


def _in_the_unit_of_all(database: sqlite3.Connection, age: Age) -> Age:
    unit = age_unit(database)
    if unit:
        return age.as_unit(unit)
    database.execute("INSERT INTO campaign VALUES ('age unit', ?)", (age.unit,))
    return age


def _unit(database: sqlite3.Connection, unit: str, force: bool) -> str:
    """The specimen's name, which must be one that can be read and typed again."""
    unit = as_kept(unit)
    if not unit or len(unit) > _LONGEST_UNIT or printable(unit) != unit:
        raise ParameterError(
            f"specimen name '{unit[:_LONGEST_UNIT]}' is not valid. Give 1 to {_LONGEST_UNIT} "
            "characters, e.g. F12"
        )
    known = [row[0] for row in database.execute("SELECT DISTINCT unit FROM runs")]
    alike = [other for other in known if _folded(other) == _folded(unit)]
    if unit in known or not alike or force:
        return unit
    raise ParameterError(
        f"specimen '{unit}' differs only slightly from the existing '{alike[0]}'. Use that name, or "
        f"{FORCE.to()} if it is another specimen"
    )


def as_kept(unit: str) -> str:
    """Return a specimen's name as the campaign keeps it: without spaces around it, one between words."""
    return " ".join(unit.split())


def no_specimen(database: sqlite3.Connection, path: Path, unit: str) -> ParameterError:
    """Return the error of a specimen that is not there, with those that are."""
    known = [row[0] for row in database.execute("SELECT DISTINCT unit FROM runs ORDER BY unit")]
    near = meant(unit, known)
    more = f" and {len(known) - _SPECIMENS} more" if len(known) > _SPECIMENS else ""
    listed = f"specimens: {', '.join(known[:_SPECIMENS])}{more}"
    way = f"did you mean '{near}'?" if near else listed if known else "add a run first"
    return ParameterError(f"{path.name} has no specimen '{unit}'", remedy=way)


def _folded(unit: str) -> str:
    return re.sub(r"[\W_]", "", unit).casefold()


def _inserted(database: sqlite3.Connection, path: str | bytes, entry: Entry, unit: str, age: Age) -> int:
    fit = json.loads(entry.fit) if entry.fit else None
    transition = fit and fit["transition"]
    values = {
        "unit": unit,
        "age": age.value,
        "path": path,
        "sha256": entry.sha256,
        "written": entry.written,
        "added": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "version": entry.version,
        "settings": entry.settings,
        "reduction": entry.reduction,
        "fit": entry.fit,
        "no_fit": entry.no_fit,
        "dwells": len(entry.dwells),
        "exponent": fit and fit["coefficients"]["c"]["value"],
        "transition_speed": transition and transition["speed"]["value"],
    }
    run = database.execute(
        f"INSERT INTO runs ({', '.join(values)}) VALUES ({', '.join('?' * len(values))})",
        tuple(values.values()),
    ).lastrowid
    assert run is not None
    database.executemany(
        f"INSERT INTO dwells VALUES ({', '.join('?' * (2 + len(COLUMNS)))})",
        [(run, number, *row) for number, row in enumerate(entry.dwells)],
    )
    return run
