"""Whether a campaign is as it should be: its file, the logs behind it, ages and fits."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.errors import FORCE, MissingFileError
from hersey.files.reading import hash_of
from hersey.life.age import Age
from hersey.life.campaign.adding import age_unit, lies_at
from hersey.result import Record

if TYPE_CHECKING:
    import polars as pl

#: Logs written within this time, s, may have been copied: their order says nothing.
_AT_ONCE = 60.0


@dataclass(frozen=True)
class Finding(Record):
    """Something that is not as it should be: what, in words, of which run and specimen (None: the file)."""

    kind: str  #: damaged, log missing, log changed, age backwards or no fit
    text: str
    run: int | None = None
    unit: str | None = None


@dataclass(frozen=True)
class Findings:
    """What a check of a campaign found among how many runs."""

    runs: int
    findings: tuple[Finding, ...]

    @property
    def ok(self) -> bool:
        """Whether nothing was found."""
        return not self.findings

    def summary(self) -> str:
        """Return a line for the whole, and one for each finding."""
        count = len(self.findings)
        whole = "all as it should be" if self.ok else f"{count} finding{'s' if count > 1 else ''}"
        return "\n".join([f"{self.runs} runs: {whole}", *(f"- {each.text}" for each in self.findings)])

    def to_dict(self) -> dict[str, Any]:
        """Return the findings as JSON can hold them."""
        return asdict(self)

    def to_frame(self) -> pl.DataFrame:
        """Return a row per finding."""
        import polars as pl

        kinds = {"kind": pl.String, "text": pl.String, "run": pl.Int64, "unit": pl.String}
        return pl.DataFrame([asdict(each) for each in self.findings], schema=kinds)


def check(
    database: sqlite3.Connection, home: Path, progress: Callable[[int, int], None] | None = None
) -> Findings:
    """Check the file, every log behind it, the order of the ages, and the fits.

    The time at which a log was recorded is that at which its file was last written to.
    """
    found = [
        Finding("damaged", f"the file is damaged: {row[0]}: take it from a backup")
        for row in database.execute("PRAGMA integrity_check(100)")
        if row[0] != "ok"
    ]
    unit_of_age = age_unit(database)
    rows = database.execute(
        "SELECT id, unit, age, path, sha256, written, no_fit FROM runs ORDER BY unit, age, id"
    ).fetchall()
    latest: dict[str, tuple[float, float, int]] = {}
    for number, (run, unit, age, kept, sha256, written, no_fit) in enumerate(rows):
        path = lies_at(kept, home)
        named = f"run {run}, {unit} at {Age(age, unit_of_age)}: {path.name}"
        if lost := _lost(path, sha256):
            found.append(Finding(lost[0], f"{named} {lost[1]}", run, unit))
        if no_fit:
            found.append(Finding("no fit", f"{named} has no fit: {no_fit}", run, unit))
        if written is not None:
            before, at, other = latest.get(unit, (written, age, run))
            if written < before - _AT_ONCE and at < age:
                other_age = Age(at, unit_of_age)
                text = f"{named} was written before that of run {other} at {other_age}: are the ages right?"
                found.append(Finding("age backwards", text, run, unit))
            latest[unit] = max((before, at, other), (written, age, run))
        if progress is not None:
            progress(number + 1, len(rows))
    return Findings(len(rows), tuple(found))


def _lost(path: Path, sha256: str) -> tuple[str, str] | None:
    """What became of a log, or None if it is as it was."""
    try:
        if not path.exists():  # said here, where a lot of them may be gone
            raise MissingFileError
        now = hash_of(path)
    except MissingFileError:
        return "log missing", f"is no longer at {path}: put it back; its dwells stay"
    if now != sha256:
        return (
            "log changed",
            f"has changed since it was added: add it again with {FORCE.to()}, or put it back",
        )
    return None
