"""What every combination of parameters settles to: ``hersey sweep``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.amounts import of_a_machine
from hersey.cli.options import (
    AsJson,
    Force,
)
from hersey.cli.outputs import may_write, print_json
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.cli.workers import Scheduler, Workers, workers
from hersey.errors import ParameterError
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    import xarray as xr

#: More sets than this no disk holds.
_MOST = 1e12


def sweep(
    scenario: Annotated[Path, typer.Argument(metavar="SCENARIO", help="TOML file that describes the sweep.")],
    machine: Annotated[
        Path | None,
        typer.Option(
            "--machine",
            metavar="TOML",
            help="Machine's file: stiffness, mass and stick speed where the scenario has none, grip, rest.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="Write every set as a row: .parquet or .csv; or a folder of chunks: .zarr, .parquet.",
        ),
    ] = None,
    threads: Annotated[
        int, typer.Option("--threads", help="Threads to use; the result is the same for any number.", min=1)
    ] = 1,
    scheduler: Scheduler = None,
    processes: Workers = None,
    chunk: Annotated[
        int | None,
        typer.Option("--chunk", metavar="N", help="Keep the sweep in a folder, N sets at a time."),
    ] = None,
    resume: Annotated[
        bool,
        typer.Option("--resume/--no-resume", help="Go on with what the folder holds of the same sweep."),
    ] = True,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find what every combination of parameters settles to, and count the outcomes.

    Example: [bold]hersey sweep examples/scenario.toml --out sweep.parquet --threads 2[/bold]
    """
    in_chunks = _in_chunks(out, chunk, scheduler, processes)
    if threads != 1 and not (scheduler is None and processes is None):
        raise ParameterError("--threads is of this process alone: with workers leave it out")
    overwrite = False
    if out is not None and not in_chunks:
        ends = [*TABLES, ".zarr"]
        overwrite = may_write(out, force, inputs=[scenario, *([machine] if machine else [])], ends=ends)

    from hersey.motion.parameters import MOST_SETS
    from hersey.motion.scenario import read_scenario, summary
    from hersey.motion.work import Work
    from hersey.scale.store import SweepFolder

    stated = of_a_machine(machine) if machine is not None else None
    described = read_scenario(
        scenario,
        stated=stated,
        stated_in=machine.name if machine is not None else "",
        most=_MOST if in_chunks else MOST_SETS,
    )
    told: list[str] = []
    with workers(scheduler, processes) as client, bar("simulating", unit="sets") as progress:
        work = Work(threads=threads, client=client, chunk=chunk, progress=progress)
        if out is not None and in_chunks:
            with _said_if_interrupted():
                found = described.keep(SweepFolder(out, resume, force), work)
            counted = found.summary()
            told += found.notes
            if found.before:
                told.append(f"{found.before} of {found.chunks} chunks were there")
        else:
            result = described.run(work)
            counted = summary(result)
            told += result.attrs.get("notes", [])
    if out is not None and not in_chunks:
        _write(out, result, overwrite)
    if as_json:
        print_json("sweep", counted)
        return
    for kind, share in counted["kinds"].items():
        say(f"{kind.replace('_', ' '):16s}{share}")
    for name, (low, high) in counted["stick_slip"].items():
        say(f"  {name.replace('_', ' '):16s}{low:.6g} to {high:.6g}")
    for failure in counted["failures"]:
        say(f"- {failure}")
    for line in told:
        say(f"- {line}")
    if described.grip is not None:
        say(f"- the roll grips the belt with up to {described.grip:.4g} N")
    if described.rest_force or described.rest_damping:
        say(
            f"- the rest of the drive acts beside the drag: {described.rest_force:.4g} N and "
            f"{described.rest_damping:.4g} N s/m"
        )
    if out is not None:
        say(f"sweep: {out}")


def _in_chunks(out: Path | None, chunk: int | None, scheduler: str | None, processes: int | None) -> bool:
    """Whether the sweep is kept in a folder of chunks."""
    if out is None or out.suffix == ".csv":
        if chunk is not None:
            raise ParameterError("--chunk is of a sweep that is kept: name a folder by --out sweep.zarr")
        return False
    if out.suffix == ".zarr":
        return True
    asked = any(each is not None for each in (chunk, scheduler, processes))
    return out.suffix == ".parquet" and (asked or (out / "manifest.parquet").is_file())


@contextmanager
def _said_if_interrupted() -> Iterator[None]:
    """Say on Ctrl-C what is kept."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        say(*(f"hersey: {note}" for note in getattr(interrupt, "__notes__", [])), file=sys.stderr)
        raise


def _write(out: Path, result: xr.Dataset, overwrite: bool) -> None:
    """Write every set as a row."""
    from hersey.files.writing import write_atomically
    from hersey.motion.scenario import rows

    with working("writing the rows"):
        write_atomically(out, rows(result, out.suffix), overwrite=overwrite)
