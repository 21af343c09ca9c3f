"""The runs of a life test in one file: ``hersey campaign``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
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
from hersey.cli.terminal import say
from hersey.cli.workers import Crew
from hersey.errors import ParameterError
from hersey.files.endings import LOGS
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    from hersey.life.age import Age

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

    from hersey.cli.campaign_adding import Adding, of_table
    from hersey.life.age import Age
    from hersey.life.campaign import Campaign, RunToAdd

    failed: list[str] = []
    events: Sequence[tuple[str, Age, str]] = ()
    alike = ""
    if table is not None:
        wanted, events = of_table(table, runs, failed)
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
        adding = Adding(reading, machine, force, client, printing, alike)
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
        if printing.as_json:
            printing.json(opened.to_dict(), warnings=None)
        else:
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
        if printing.as_json:
            printing.json(opened.to_dict(), warnings=found.warnings, each=found.each)
        else:
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
