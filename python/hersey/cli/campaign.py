"""The runs of a life test in one file: ``hersey campaign``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import AsJson, Force, KeepGoing, Reading, reads_logs
from hersey.cli.outputs import NOT_FOUND, may_write, print_json
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.cli.workers import Scheduler, Workers, workers
from hersey.errors import HerseyError, OutputError, ParameterError
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from distributed import Client

    from hersey.life.campaign import Added, Campaign, RunToAdd
    from hersey.scale.local import LocalWorkers

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
_File = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="File of the campaign, as life.hersey.")]


@campaign.command("add")
@reads_logs
def add(
    file: _File,
    reading: Reading,
    runs: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[RUN]...",
            help="Log of one run, or of several of one unit at one age, or a pattern as 'logs/*.csv'.",
        ),
    ] = None,
    unit: Annotated[str, typer.Option("--unit", help="Name of the unit, as F12.")] = "",
    age: Annotated[
        str, typer.Option("--age", help="Age of the unit, as '120000 pages', '310 h' or '2e6 cycles'.")
    ] = "",
    table: Annotated[
        Path | None,
        typer.Option(
            "--table",
            metavar="CSV",
            help="Instead of unit and age: a table of runs with columns log, unit and age.",
        ),
    ] = None,
    machine: Annotated[
        Path | None,
        typer.Option("--machine", metavar="TOML", help="Machine's file: rest of the drive, sensors."),
    ] = None,
    keep_going: KeepGoing = False,
    scheduler: Scheduler = None,
    count: Workers = None,
    force: Force = False,
) -> None:
    """Add runs, and make the campaign if there is none: all the logs given or none, of a table each.

    Example: [bold]hersey campaign add life.hersey examples/bench.csv --unit F12 --age '120000 pages'
    --tare standing[/bold]

    A log that is there already is left alone; one that has changed, or is under another unit or age, is told,
    and replaced with --force. With a table all its runs are added, or of the logs given those that it names;
    what fails is left out, as with --keep-going. Exit code 1 says that a run could not be added.
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
    with workers(scheduler, count) as client:
        if table is None and not keep_going:
            _add_all(file, wanted, reading, machine, force, client)
            return
        with Campaign.create(file) as opened:
            _add_each(opened, wanted, reading, machine, force, client, failed)


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


def _add_all(
    file: Path,
    wanted: list[RunToAdd],
    reading: Reading,
    machine: Path | None,
    force: bool,
    client: Client | LocalWorkers | None,
) -> None:
    from hersey.cli.campaign_reading import entries, settings_of
    from hersey.life.campaign import Campaign

    logs = [(run.log, settings_of(reading, run.log, machine)) for run in wanted]
    read = []
    with bar("reading", unit="runs") as progress:
        for run, result in zip(wanted, entries(reading, logs, machine, client), strict=True):
            if isinstance(result, HerseyError):
                raise result
            read.append((result, run.unit, run.age))
            progress(len(read), len(wanted))
    with Campaign.create(file) as opened:
        for added in opened.add_entries(read, force=force):
            say(added.summary())


def _add_each(
    opened: Campaign,
    wanted: list[RunToAdd],
    reading: Reading,
    machine: Path | None,
    force: bool,
    client: Client | LocalWorkers | None,
    failed: list[str],
) -> None:
    from hersey.cli.campaign_reading import entries

    counts: dict[str, int] = {}
    new: list[tuple[RunToAdd, str]] = []

    def done(added: Added) -> None:
        counts[added.outcome] = counts.get(added.outcome, 0) + 1
        for note in added.notes:
            say(f"{added.path}: {note}", file=sys.stderr)

    for run in wanted:
        try:
            settled = _there(opened, run, reading, machine, force)
        except HerseyError as error:
            failed.append(f"{run.log}: {error}")
            continue
        if isinstance(settled, str):
            new.append((run, settled))
        else:
            done(settled)
    with bar("adding", unit="runs") as progress:
        read = entries(reading, [(run.log, settings) for run, settings in new], machine, client)
        for number, ((run, _), result) in enumerate(zip(new, read, strict=True), 1):
            try:
                if isinstance(result, HerseyError):
                    raise result
                done(opened.add_entries([(result, run.unit, run.age)], force=force)[0])
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


def _there(
    opened: Campaign, run: RunToAdd, reading: Reading, machine: Path | None, force: bool
) -> Added | str:
    """The run if adding it would change nothing, else how its log is to be read."""
    from hersey.cli.campaign_reading import settings_of
    from hersey.files.reading import hash_of

    settings = settings_of(reading, run.log, machine)
    sha256 = hash_of(run.log)
    return (None if force else opened.there(sha256, run.unit, run.age, settings)) or settings


@campaign.command("list")
def list_(file: _File, as_json: AsJson = False) -> None:
    """List the units, with their runs, ages and dwells.

    Example: [bold]hersey campaign list life.hersey[/bold]
    """
    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened:
        if as_json:
            print_json("campaign", opened.to_dict())
        else:
            say(opened.summary())


@campaign.command("show")
def show(
    file: _File,
    unit: Annotated[str, typer.Argument(metavar="UNIT", help="Name of the unit.")],
    as_json: AsJson = False,
) -> None:
    """Show every run of a unit by age: its log, dwells, exponent and transition.

    Example: [bold]hersey campaign show life.hersey F12[/bold]
    """
    from hersey.life.age import Age
    from hersey.life.campaign import Campaign
    from hersey.units import rpm

    with Campaign.open(file, write=False) as opened:
        if as_json:
            print_json("campaign", opened.to_dict(unit))
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
            print_json("campaign", opened.to_dict() | {"findings": found.to_dict()["findings"]})
        else:
            say(found.summary())
    if not found.ok:
        raise typer.Exit(NOT_FOUND)


@campaign.command("export")
def export(
    file: _File,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="Table to write: .parquet or .csv, a row per dwell.")
    ],
    force: Force = False,
) -> None:
    """Write every dwell as a row, with unit, age and run.

    Example: [bold]hersey campaign export life.hersey --out dwells.parquet[/bold]
    """
    overwrite = may_write(out, force, inputs=[file], ends=TABLES)

    from hersey.files.writing import write_atomically
    from hersey.life.campaign import Campaign

    with Campaign.open(file, write=False) as opened, working("writing the dwells"):
        write_atomically(out, opened.export(out.suffix), overwrite=overwrite)
    say(f"dwells: {out}")
