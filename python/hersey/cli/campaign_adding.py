"""Adding runs to a campaign: all or none, or each that can be added."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from hersey.cli.options import Reading
from hersey.cli.outputs import NOT_FOUND
from hersey.cli.printing import Quiet
from hersey.cli.progress import bar
from hersey.cli.terminal import note, say
from hersey.errors import HerseyError, OutputError, ParameterError

if TYPE_CHECKING:
    from hersey.cli.workers import AtWork
    from hersey.life.age import Age
    from hersey.life.campaign import Added, Campaign, Entry, RunToAdd
    from hersey.processes.child import Child


def of_table(
    table: Path, logs: list[Path], failed: list[str]
) -> tuple[list[RunToAdd], list[tuple[str, Age, str]]]:
    """The runs and events of a table, or the runs of given logs that it lists; others join the ``failed``."""
    from hersey.life.campaign import RunToAdd, read_runs, rows_of

    read = read_runs(table)
    rows = read.runs
    if not logs:
        return rows, read.events
    found = rows_of(logs, rows, table.name)
    failed += [f"{log}: {each}" for log, each in zip(logs, found, strict=True) if isinstance(each, Exception)]
    named = [each for each in found if isinstance(each, RunToAdd)]
    if len(named) < len(rows):
        note(f"{len(named)} of the {len(rows)} runs in {table.name} are among the given logs.")
    given = {run.unit for run in named}
    return named, [event for event in read.events if event[0] in given]


@dataclass(frozen=True)
class Adding:
    """How runs are read, by which workers, and whether they replace runs that are there.

    ``alike`` is what to print if several logs are added as one specimen at one age.
    """

    reading: Reading
    machine: Path | None
    force: bool
    client: AtWork
    printing: Quiet
    alike: str

    def all(self, file: Path, wanted: list[RunToAdd]) -> None:
        """Add all runs or none."""
        from hersey.life.campaign import Campaign

        read = []
        with bar("reading", unit="runs") as progress:
            for run, result in self._read([(run, self._settings(run)) for run in wanted]):
                if isinstance(result, HerseyError):
                    raise result
                read.append((result, run.unit, run.age))
                progress(len(read), len(wanted))
        with Campaign.create(file) as opened:
            every = opened.add_entries(read, force=self.force)
            self.printing.text(*(added.summary() for added in every))
            _diagnosed(opened, {added.run for added in every})
        note(*filter(None, [self.alike]))

    def each(
        self,
        opened: Campaign,
        wanted: list[RunToAdd],
        events: Sequence[tuple[str, Age, str]],
        failed: list[str],
    ) -> None:
        """Add the runs and events that can be added; others join the ``failed``, and the exit code is 1."""
        from hersey.cli.campaign_reading import FEW, readers

        # of a campaign without runs all will be read: what reads them loads while settings are found here
        many = self.client is None and len(wanted) >= FEW and not len(opened)
        with readers(self.machine) if many else nullcontext(()) as children:
            counts, runs = self._runs(opened, wanted, failed, children)
        for unit, age, kind in events:
            try:
                opened.add_event(unit, age, kind)
            except OutputError:
                raise
            except HerseyError as error:
                failed.append(f"{kind} at {age}: {error}")
        said = [f"{counts[outcome]} {outcome}" for outcome in sorted(counts)]
        counted = [*said, *([f"{len(failed)} failed"] if failed else [])]
        self.printing.text(f"{opened.path.name}: {', '.join(counted)}")
        if failed:
            say(*(f"- {each}" for each in failed), file=sys.stderr)
        note(*filter(None, [self.alike]))
        _diagnosed(opened, runs)
        if failed:
            raise typer.Exit(NOT_FOUND)

    def _runs(
        self, opened: Campaign, wanted: list[RunToAdd], failed: list[str], children: Sequence[Child]
    ) -> tuple[Counter[str], set[int]]:
        """Add runs, and what was done before each; how many had each outcome, and the new numbers."""
        from hersey.log.many import failure_line

        counts: Counter[str] = Counter()
        numbers: set[int] = set()
        new: list[tuple[RunToAdd, str]] = []
        for run in wanted:
            try:
                settled = self._there(opened, run)
            except HerseyError as error:
                failed.append(failure_line(run.log, error))
                continue
            if isinstance(settled, str):
                new.append((run, settled))
            else:
                counts[_noted(settled)] += 1
                _with_event(opened, run, settled)
        with bar("adding", unit="runs") as progress:
            for number, (run, result) in enumerate(self._read(new, children), 1):
                try:
                    if isinstance(result, HerseyError):
                        raise result
                    entry = (result, run.unit, run.age)
                    added = opened.add_entries([entry], force=self.force)[0]
                    counts[_noted(added)] += 1
                    numbers.add(added.run)
                    _with_event(opened, run, added)
                except OutputError:  # what the next run would meet too
                    raise
                except HerseyError as error:
                    failed.append(failure_line(run.log, error))
                progress(number, len(new))
        return counts, numbers

    def _read(
        self, runs: list[tuple[RunToAdd, str]], children: Sequence[Child] = ()
    ) -> Iterator[tuple[RunToAdd, Entry | HerseyError]]:
        """Each run, with its entry or its error."""
        from hersey.cli.campaign_reading import entries

        logs = [(run.log, settings) for run, settings in runs]
        read = entries(self.reading, logs, self.machine, self.client, children)
        return zip((run for run, _ in runs), read, strict=True)

    def _settings(self, run: RunToAdd) -> str:
        from hersey.cli.campaign_reading import settings_of

        return settings_of(self.reading, run.log, self.machine)

    def _there(self, opened: Campaign, run: RunToAdd) -> Added | str:
        """The run if adding it would change nothing, else the settings for reading its log."""
        from hersey.files.reading import hash_of

        settings, sha256 = self._settings(run), hash_of(run.log)
        return (None if self.force else opened.there(sha256, run.unit, run.age, settings)) or settings


def _with_event(opened: Campaign, run: RunToAdd, added: Added) -> None:
    """Record what was done before a run that was added."""
    if run.event:
        opened.add_event(added.unit, added.age, run.event, run=added.run)


def _diagnosed(opened: Campaign, new: set[int]) -> None:
    """Print which of the new runs do not fit the others."""
    if new:
        with suppress(ParameterError):  # of damage to other runs, which 'check' reports
            note(*(str(warning) for warning in opened.diagnose(new).concerning(new)))


def _noted(added: Added) -> str:
    """Print the warnings of a run that was added, and return its outcome."""
    for warning in added.warnings:
        note(f"{added.path}: {warning}")
    return added.outcome
