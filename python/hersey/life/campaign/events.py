"""Maintenance as a campaign keeps it."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from hersey.errors import ParameterError
from hersey.life.age import Age
from hersey.life.campaign.adding import age_unit, as_kept, no_specimen
from hersey.life.maintenance import Event


def keeps_events(database: sqlite3.Connection) -> bool:
    """Return whether the file is of a version that keeps events."""
    return bool(database.execute("SELECT 1 FROM sqlite_master WHERE name = 'events'").fetchone())


def add_event(
    database: sqlite3.Connection, path: Path, unit: str, age: Age, kind: str, run: int | None
) -> Event:
    """Add an event inside a transaction; adding it again changes nothing but its run.

    Raises
    ------
    ParameterError
        If no run is of this specimen.
    UnitError
        If the ages of the campaign are in another unit.
    """
    unit = as_kept(unit)
    if database.execute("SELECT 1 FROM runs WHERE unit = ?", (unit,)).fetchone() is None:
        raise no_specimen(database, path, unit)
    age = age.as_unit(age_unit(database))
    database.execute("INSERT OR REPLACE INTO events VALUES (?, ?, ?, ?)", (unit, age.value, kind, run))
    return Event(unit, age, kind, run)


def remove_event(database: sqlite3.Connection, unit: str, age: Age, kind: str) -> None:
    """Remove an event inside a transaction.

    Raises
    ------
    ParameterError
        If there is none.
    """
    unit, age = as_kept(unit), age.as_unit(age_unit(database) or age.unit)
    where = "WHERE (unit, age, kind) = (?, ?, ?)"
    if not database.execute(f"DELETE FROM events {where}", (unit, age.value, kind)).rowcount:
        raise ParameterError(f"specimen '{unit}' has no event '{kind}' at {age}")


def events_of(database: sqlite3.Connection) -> list[Event]:
    """Return all events by specimen and age; none in a file of a version that kept none."""
    if not keeps_events(database):
        return []
    counted = age_unit(database)
    rows = database.execute("SELECT unit, age, kind, run_id FROM events ORDER BY unit, age, kind")
    return [Event(unit, Age(age, counted), kind, run) for unit, age, kind, run in rows]
