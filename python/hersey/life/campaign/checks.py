"""Whether a campaign is as it should be: its file, the logs behind it, ages and fits."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.errors import FORCE, MissingFileError
from hersey.files.reading import hash_of
from hersey.life.age import Age
from hersey.life.campaign.adding import age_unit, lies_at
from hersey.life.diagnostics.run_compared import RunCompared
from hersey.result import Record
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

#: Logs written within this time, s, may have been copied: their order says nothing.
_AT_ONCE = 60.0


@dataclass(frozen=True)
class CampaignCheck(Record):
    """What is not as it should be in a campaign of so many runs.

    ``each`` is every run compared with its specimen and the others. Values of each warning are ``run`` and
    ``unit`` where it concerns a run; else it concerns the file.
    """

    runs: int
    warnings: tuple[Warning, ...]
    each: tuple[RunCompared, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether nothing was found."""
        return not self.warnings

    def summary(self) -> str:
        """Return a line for the whole, and one for each warning."""
        count = len(self.warnings)
        whole = "no problems found" if self.ok else f"{count} warning{'s' if count > 1 else ''}"
        return "\n".join([f"{self.runs} runs: {whole}", *(f"- {each}" for each in self.warnings)])

    def to_frame(self) -> pl.DataFrame:
        """Return a row per warning."""
        import polars as pl

        kinds = {"kind": pl.String, "text": pl.String, "run": pl.Int64, "unit": pl.String}
        rows = [
            (each.kind, str(each), each.values.get("run"), each.values.get("unit")) for each in self.warnings
        ]
        return pl.DataFrame(rows, schema=kinds, orient="row")


def check(
    database: sqlite3.Connection, home: Path, progress: Callable[[int, int], None] | None = None
) -> CampaignCheck:
    """Check the file, every log behind it, the order of the ages, and the fits.

    The time at which a log was recorded is that at which its file was last written to.
    """
    found = [
        Warning(
            "damaged",
            "the file is damaged: {fault}",
            remedy="restore it from a backup",
            severity="act",
            fault=str(row[0]),
        )
        for row in database.execute("PRAGMA integrity_check(100)")
        if row[0] != "ok"
    ]
    unit_of_age = age_unit(database)
    rows = database.execute(
        "SELECT id, unit, age, path, sha256, written, no_fit FROM runs ORDER BY unit, age, id"
    ).fetchall()
    latest: dict[str, tuple[float, float, int]] = {}
    for number, (run, unit, age, kept, sha256, written, no_fit) in enumerate(rows):
        path, of_run = lies_at(kept, home), {"run": run, "unit": unit}
        named = f"run {run}, {unit} at {Age(age, unit_of_age)}: {path.name}"
        own = _of_log(path, sha256, of_run)
        if no_fit:
            own.append(Warning("no fit", "no fit: {reason}", severity="watch", reason=no_fit, **of_run))
        if written is not None:
            before, at, other = latest.get(unit, (written, age, run))
            if written < before - _AT_ONCE and at < age:
                own.append(_age_backwards(other, Age(at, unit_of_age), of_run))
            latest[unit] = max((before, at, other), (written, age, run))
        found += [each.within(named) for each in own]
        if progress is not None:
            progress(number + 1, len(rows))
    return CampaignCheck(len(rows), tuple(found))


def _age_backwards(other: int, age: Age, of_run: dict[str, Any]) -> Warning:
    """A log that was written before that of another run of the specimen, which was younger."""
    return Warning(
        "age backwards",
        "the log was written before that of run {other} at {other_age:.10g} {age_unit}. Are the ages right?",
        severity="act",
        other=other,
        other_age=age.value,
        age_unit=age.unit,
        **of_run,
    )


def _of_log(path: Path, sha256: str, of_run: dict[str, Any]) -> list[Warning]:
    """What became of a log, if it is not as it was."""
    try:
        if not path.exists():  # said here, where a lot of them may be gone
            raise MissingFileError
        now = hash_of(path)
    except MissingFileError:
        return [
            Warning(
                "log missing",
                "the log is no longer at {path}",
                remedy="put it back; its dwells stay in the campaign",
                severity="act",
                path=str(path),
                **of_run,
            )
        ]
    if now == sha256:
        return []
    return [
        Warning(
            "log changed",
            "the log has changed since it was added",
            remedy="add it again with {how}, or restore the old log",
            severity="act",
            how=FORCE,
            **of_run,
        )
    ]
