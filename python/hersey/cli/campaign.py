"""The runs of a life test in one file: ``hersey campaign``."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, Force, KeepGoing, Reading, SensorsFile
from hersey.cli.outputs import NOT_FOUND, may_write, print_json
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.cli.workers import Crew
from hersey.errors import HerseyError, OutputError, ParameterError
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.cli.workers import AtWork
    from hersey.life.campaign import Added, Campaign, Entry, RunToAdd

campaign = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    help=(
        "Keep the runs of a life test, many units at many ages, in one file: add, list, check.\n\n"
        "Example: [bold]hersey campaign add life.hersey examples/bench.csv --unit F12 --age '120000 pages' "
        "--tare standing[/bold]\n\n"
        "Steady points, fit, hash and settings of each log are kept; logs stay where they are."
    ),
)
_File = Annotated[Path, argument("CAMPAIGN", "File of the campaign, as life.hersey.")]


_RUNS = "Log of one run, or of several of one unit at one age, or a pattern as 'logs/*.csv'."
_AGE = "Age of the unit, as '120000 pages', '310 h' or '2e6 cycles'."
_TABLE = "Instead of unit and age: a table of runs with columns log, unit and age."


@campaign.command("add")
@grouped
def add(
    file: _File,
    *,
    runs: Annotated[list[Path] | None, argument("[RUN]...", _RUNS)] = None,
    unit: Annotated[str, option("Name of the unit, as F12.")] = "",
    age: Annotated[str, option(_AGE)] = "",
    table: Annotated[Path | None, option(_TABLE, metavar="CSV")] = None,
    machine: SensorsFile = None,
    keep_going: KeepGoing = False,
    crew: Crew,
    reading: Reading,
    force: Force = False,
) -> None:
    """Add runs, and make the campaign if there is none: all the logs given or none, of a table each.

    Example: [bold]hersey campaign add life.hersey examples/bench.csv --unit F12 --age '120000 pages'
    --tare standing[/bold]

    A log that is there already is skipped; one that has changed, or is under another unit or age, is an
    error, and replaced with --force. With a table all its runs are added, or of the logs given those that it
    names; what fails is excluded, as with --keep-going. Exit code 1 says that a run could not be added.
    """
    if table is None and not runs:
        raise ParameterError("give either RUN... with --unit and --age, or --table with runs in rows")
    if table is not None and (unit or age):
        raise ParameterError("--unit and --age stand in the table: leave them out, or name the logs")
    if table is None and not (unit and age):
        missing = "--age '120000 pages'" if unit else "--unit F12"
        raise ParameterError(f"say which unit was recorded, and at which age: add {missing}")

    from hersey.life.age import Age
    from hersey.life.campaign import Campaign, RunToAdd

    failed: list[str] = []
    if table is not None:
        wanted = _of_table(table, runs, failed)
    else:
        parsed = Age.parse(age)
        wanted = [RunToAdd(path, unit, parsed) for path in runs or []]
    Campaign.refuse_unless_writable(file)
    with crew.at_work() as client:
        adding = _Adding(reading, machine, force, client)
        if table is None and not keep_going:
            adding.all(file, wanted)
            return
        with Campaign.create(file) as opened:
            adding.each(opened, wanted, failed)


def _of_table(table: Path, logs: list[Path] | None, failed: list[str]) -> list[RunToAdd]:
    """The runs of a table, or of the logs given those that it names; the others are among the ``failed``."""
    from hersey.life.campaign import RunToAdd, read_runs, rows_of

    rows = read_runs(table)
    if not logs:
        return rows
    found = rows_of(logs, rows, table.name)
    failed += [f"{log}: {each}" for log, each in zip(logs, found, strict=True) if isinstance(each, Exception)]
    named = [each for each in found if isinstance(each, RunToAdd)]
    if len(named) < len(rows):
        say(f"{table.name}: of {len(rows)} runs the logs given are {len(named)}", file=sys.stderr)
    return named


@dataclass(frozen=True)
class _Adding:
    """How runs are read, by whom, and whether they replace what is there."""

    reading: Reading
    machine: Path | None
    force: bool
    client: AtWork

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
            for added in opened.add_entries(read, force=self.force):
                say(added.summary())

    def each(self, opened: Campaign, wanted: list[RunToAdd], failed: list[str]) -> None:
        """Add the runs that can be; those that cannot join the ``failed``, and end the command."""
        counts: Counter[str] = Counter()
        new: list[tuple[RunToAdd, str]] = []
        for run in wanted:
            try:
                settled = self._there(opened, run)
            except HerseyError as error:
                failed.append(f"{run.log}: {error}")
                continue
            if isinstance(settled, str):
                new.append((run, settled))
            else:
                counts[_noted(settled)] += 1
        with bar("adding", unit="runs") as progress:
            for number, (run, result) in enumerate(self._read(new), 1):
                try:
                    if isinstance(result, HerseyError):
                        raise result
                    entry = (result, run.unit, run.age)
                    counts[_noted(opened.add_entries([entry], force=self.force)[0])] += 1
                except OutputError:  # what the next run would meet too
                    raise
                except HerseyError as error:
                    failed.append(f"{run.log}: {error}")
                progress(number, len(new))
        said = [f"{counts[outcome]} {outcome}" for outcome in sorted(counts)]
        say(f"{opened.path.name}: {', '.join([*said, *([f'{len(failed)} failed'] if failed else [])])}")
        if failed:
            say(*(f"- {each}" for each in failed), file=sys.stderr)
            raise typer.Exit(NOT_FOUND)

    def _read(self, runs: list[tuple[RunToAdd, str]]) -> Iterator[tuple[RunToAdd, Entry | HerseyError]]:
        """Each run, with what is kept of it or why nothing is."""
        from hersey.cli.campaign_reading import entries

        logs = [(run.log, settings) for run, settings in runs]
        read = entries(self.reading, logs, self.machine, self.client)
        return zip((run for run, _ in runs), read, strict=True)

    def _settings(self, run: RunToAdd) -> str:
        from hersey.cli.campaign_reading import settings_of

        return settings_of(self.reading, run.log, self.machine)

    def _there(self, opened: Campaign, run: RunToAdd) -> Added | str:
        """The run if adding it would change nothing, else how its log is to be read."""
        from hersey.files.reading import hash_of

        settings, sha256 = self._settings(run), hash_of(run.log)
        return (None if self.force else opened.there(sha256, run.unit, run.age, settings)) or settings


def _noted(added: Added) -> str:
    """The outcome of a run that was added, whose warnings are printed."""
    for warning in added.warnings:
        say(f"{added.path}: {warning}", file=sys.stderr)
    return added.outcome


@campaign.command("list")
def list_(file: _File, as_json: AsJson = False) -> None:
    """List the units, with their runs, ages and dwells.

    Example: [bold]hersey campaign list life.hersey[/bold]
    """
    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened:
        if as_json:
            print_json(opened.to_dict(), warnings=None)
        else:
            say(opened.summary())


@campaign.command("show")
def show(
    file: _File, unit: Annotated[str, argument("UNIT", "Name of the unit.")], as_json: AsJson = False
) -> None:
    """Show every run of a unit by age: its log, dwells, exponent and transition.

    Example: [bold]hersey campaign show life.hersey F12[/bold]
    """
    from hersey.life.age import Age
    from hersey.life.campaign import Campaign
    from hersey.units import rpm

    with Campaign.open(file, write=False) as opened:
        if as_json:
            print_json(opened.to_dict(unit), warnings=None)
            return
        for row in opened.runs(unit).to_dicts():
            facts = [f"run {row['run']} at {Age(row['age'], opened.age_unit)}", f"{row['dwells']} dwells"]
            if row["exponent"] is not None:
                facts.append(f"exponent {row['exponent']:.3g}")
            if row["transition_speed"] is not None:
                facts.append(f"transition at {rpm(row['transition_speed']):.3g} rpm")
            if row["no_fit"]:
                facts.append(f"no fit: {row['no_fit']}")
            say(f"{', '.join(facts)}: {row['log']}")


@campaign.command("check")
def check(file: _File, as_json: AsJson = False) -> None:
    """Check that the file is sound, every log there and unchanged, ages go forward, and every run has a fit.

    Example: [bold]hersey campaign check life.hersey[/bold]

    Exit code 1 says that something was found.
    """
    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened:
        with bar("checking", unit="runs") as progress:
            found = opened.check(progress)
        if as_json:
            print_json(opened.to_dict(), warnings=found.warnings)
        else:
            say(found.summary())
    if not found.ok:
        raise typer.Exit(NOT_FOUND)


@campaign.command("export")
def export(
    file: _File,
    out: Annotated[Path, option("Table to write: .parquet or .csv, a row per dwell.", metavar="FILE")],
    force: Force = False,
) -> None:
    """Write every dwell as a row, with unit, age and run.

    Example: [bold]hersey campaign export life.hersey --out dwells.parquet[/bold]
    """
    table = may_write(out, force, inputs=[file], ends=TABLES)

    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened, working("writing the dwells"):
        table.write(opened.export(out.suffix))
    say(f"dwells: {out}")
