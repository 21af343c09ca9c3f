"""The runs of a life test in one file: ``hersey campaign``."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hersey.cli.arranged import parted, without_options
from hersey.cli.groups import argument, grouped, option
from hersey.cli.mistyped import retyped
from hersey.cli.options import Force, KeepGoing, Reading, SensorsFile
from hersey.cli.outputs import NOT_FOUND, may_write
from hersey.cli.printing import Printing, Quiet
from hersey.cli.progress import bar, working
from hersey.cli.terminal import note, say
from hersey.cli.workers import Crew
from hersey.errors import HerseyError, OutputError, ParameterError
from hersey.files.endings import LOGS
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.cli.workers import AtWork
    from hersey.life.age import Age
    from hersey.life.campaign import Added, Campaign, Entry, RunToAdd
    from hersey.processes.child import Child

campaign = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    help=(
        "Keep the runs of a life test, many specimens at many ages, in one file.\n\n"
        "Example: [bold]hersey campaign add life.hersey examples/bench.csv --unit F12 --age '120000 pages' "
        "--tare standing[/bold]\n\n"
        "The file holds steady points, fit, hash and settings of each log; the logs stay where they are."
    ),
)
_File = Annotated[Path, argument("CAMPAIGN", "Campaign file, e.g. life.hersey.")]


_RUNS = "Log of one run, or logs of one specimen at one age, or a pattern, e.g. 'logs/*.csv'."
_UNIT = "Name of the specimen, e.g. F12."
_AGE = "Age of the specimen, e.g. '120000 pages', '310 h' or '2e6 cycles'."
_TABLE = "Table of runs with columns log, unit, age and perhaps event, instead of --unit and --age."
_EVENT = "What was done: re-greased, cleaned or replaced."
_AFTER = "Number of the run of this age that was measured after it; see 'hersey campaign show'."
_REMOVE = "Remove the event instead."
#: What to do with logs of several specimens or ages.
_LIST_THEM = "list log, unit and age of each in a table and give it with --table runs.csv"
_OUT = "Table to write, .parquet or .csv, one row per dwell."


@campaign.command("add")
@grouped
def add(
    file: _File,
    *,
    runs: Annotated[list[Path] | None, argument("RUN", _RUNS)] = None,
    unit: Annotated[str, option(_UNIT)] = "",
    age: Annotated[str, option(_AGE)] = "",
    table: Annotated[Path | None, option(_TABLE, metavar="CSV")] = None,
    machine: SensorsFile = None,
    keep_going: KeepGoing = False,
    crew: Crew,
    reading: Reading,
    printing: Quiet,
    force: Force = False,
) -> None:
    """Add runs to a campaign; the file is created if it does not exist.

    Example: [bold]hersey campaign add life.hersey examples/bench.csv --unit F12 --age '120000 pages'
    --tare standing[/bold]

    A log that is there already is skipped. A log that has changed, or that is there with another specimen or
    age, is an error; --force replaces it. If one of the logs fails, none is added, unless --keep-going or
    --table is given: then the others are added, and the exit code is 1.
    """
    if file.suffix.lower() in LOGS:  # its name ends in .hersey
        typed = sys.argv[3:]
        raise ParameterError(
            f"{file} is not a campaign: name one first, and it is created if it does not exist. "
            f"Type: {retyped('campaign', 'add', 'life.hersey', *typed)}"
        )
    runs = _without_tables(file, runs or [], table)
    if table is None and not runs:
        raise ParameterError("name the logs with --unit and --age, or a table of runs with --table")
    if table is not None and (unit or age):
        raise ParameterError("the table holds unit and age: omit --unit and --age, or omit --table")
    if table is None and not (unit and age):
        missing = " ".join(["--unit F12"] * (not unit) + ["--age '120000 pages'"] * (not age))
        alike = (
            f". All {len(runs)} logs get this specimen and age. If they differ, {_LIST_THEM} instead of "
            "--unit and --age"
        )
        raise ParameterError(
            f"a run needs the name and the age of its specimen: add {missing}{alike * (len(runs) > 1)}"
        )

    from hersey.life.age import Age
    from hersey.life.campaign import Campaign, RunToAdd

    failed: list[str] = []
    events: Sequence[tuple[str, Age, str]] = ()
    alike = ""
    if table is not None:
        wanted, events = _of_table(table, runs, failed)
    else:
        parsed = Age.parse(age)
        wanted = [RunToAdd(path, unit, parsed) for path in runs]
        if len(runs) > 1:
            alike = (
                f"The specimen of all {len(runs)} logs is {unit}, their age {parsed}. If they differ, "
                f"{_LIST_THEM} --force."
            )
    Campaign.refuse_unless_writable(file)
    with crew.at_work() as client:
        adding = _Adding(reading, machine, force, client, printing, alike)
        if table is None and not keep_going:
            adding.all(file, wanted)
            return
        with Campaign.create(file) as opened:
            adding.each(opened, wanted, events, failed)


def _without_tables(file: Path, logs: list[Path], table: Path | None) -> list[Path]:
    """The logs without the given table of runs, which a pattern may match; any other table is refused."""
    from hersey.life.campaign import lists_runs

    logs = [
        log
        for log in logs
        if table is None or not log.exists() or not table.exists() or not log.samefile(table)
    ]
    found = next((log for log in logs if lists_runs(log)), None)
    if found is None:
        return logs
    if table is not None:
        raise ParameterError(f"{found} is a table of runs, not a log. Omit it, or give it instead of {table}")
    group: Any = typer.main.get_command(campaign)
    command = group.commands["add"]
    others = without_options(parted(sys.argv[3:], command)[1], ["--unit", "--age"], command)
    line = retyped("campaign", "add", str(file), "--table", str(found), *others)
    raise ParameterError(
        f"{found} is a table of runs, not a log. To add the logs that it lists, type: {line}"
    )


def _of_table(
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
class _Adding:
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
            note(*(str(warning) for warning in opened.diagnose().concerning(new)))


def _noted(added: Added) -> str:
    """Print the warnings of a run that was added, and return its outcome."""
    for warning in added.warnings:
        note(f"{added.path}: {warning}")
    return added.outcome


@campaign.command("event")
@grouped
def event(
    file: _File,
    kind: Annotated[str, argument("EVENT", _EVENT)],
    *,
    unit: Annotated[str, option(_UNIT)],
    age: Annotated[str, option(_AGE)],
    run: Annotated[int | None, option(_AFTER)] = None,
    remove: Annotated[bool, option(_REMOVE)] = False,
    printing: Quiet,
) -> None:
    """Record maintenance of a specimen, from which on its friction grows anew.

    Example: [bold]hersey campaign event life.hersey re-greased --unit F12 --age '80000 pages'[/bold]
    """
    from hersey.life.campaign import Campaign

    with Campaign.open(file) as opened:
        if remove:
            opened.remove_event(unit, age, kind)
            printing.text(f"{unit}: removed {kind} at {age}")
        else:
            printing.text(opened.add_event(unit, age, kind, run=run).summary())


@campaign.command("list")
@grouped
def list_(file: _File, *, printing: Printing) -> None:
    """List the specimens with their runs, ages and dwells.

    Example: [bold]hersey campaign list life.hersey[/bold]
    """
    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened:
        if not printing.json(opened.to_dict(), warnings=None):
            printing.text(opened.summary())


@campaign.command("show")
@grouped
def show(file: _File, unit: Annotated[str, argument("UNIT", _UNIT)], *, printing: Printing) -> None:
    """Show the runs of a specimen by age.

    Example: [bold]hersey campaign show life.hersey F12[/bold]
    """
    from hersey.cli.figures import columns, three
    from hersey.life.age import Age
    from hersey.life.campaign import Campaign
    from hersey.units import rpm

    with Campaign.open(file, write=False) as opened:
        if printing.json(opened.to_dict(unit), warnings=None):
            return
        rows = opened.runs(unit).to_dicts()
        table = []
        for row in rows:
            exponent, turn = row["exponent"], row["transition_speed"]
            cells = [
                "-" if exponent is None else three(exponent),
                "-" if turn is None else three(rpm(turn), "rpm"),
            ]
            table.append((str(row["run"]), str(Age(row["age"], opened.age_unit)), str(row["dwells"]), *cells))
        printing.text(*columns(("run", "age", "dwells", "exponent c", "least torque at"), table, indent=0))
        printing.text(*(f"- run {row['run']} has no fit: {row['no_fit']}" for row in rows if row["no_fit"]))
        printing.details(*(f"run {row['run']}: {row['log']}" for row in rows))


@campaign.command("check")
@grouped
def check(file: _File, *, printing: Printing) -> None:
    """Check the campaign file, its logs, the order of the ages, and the fits.

    Example: [bold]hersey campaign check life.hersey[/bold]

    The exit code is 1 if something is wrong.
    """
    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened:
        with bar("checking", unit="runs") as progress:
            found = opened.check(progress)
        if not printing.json(opened.to_dict(), warnings=found.warnings):
            printing.text(found.summary())
    if not found.ok:
        raise typer.Exit(NOT_FOUND)


@campaign.command("export")
def export(file: _File, out: Annotated[Path, option(_OUT, metavar="FILE")], force: Force = False) -> None:
    """Write every dwell as a row of a table, with specimen, age and run.

    Example: [bold]hersey campaign export life.hersey --out dwells.parquet[/bold]
    """
    table = may_write(out, force, inputs=[file], ends=TABLES)

    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened, working("writing the dwells"):
        table.write(opened.export(out.suffix))
    say(str(out))
