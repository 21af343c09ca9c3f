"""What every combination of parameters settles to: ``hersey sweep``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from hersey.cli.amounts import of_a_machine
from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, Force
from hersey.cli.outputs import may_write, print_json, say_written
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.cli.workers import Crew
from hersey.errors import ParameterError
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    import xarray as xr

    from hersey.motion.scenario import Scenario
    from hersey.motion.work import Work

#: More sets than this no disk holds.
_MOST = 1e12
_MACHINE = "Machine's file: stiffness, mass and stick speed where the scenario has none, grip, rest."
_OUT = "Write every set as a row: .parquet or .csv; or a folder of chunks: .zarr, .parquet."
_RESUME = "Go on with what the folder holds of the same sweep."


@dataclass(frozen=True)
class _Chunks:
    """How a sweep is kept in a folder."""

    chunk: Annotated[int | None, option("Keep the sweep in a folder, N sets at a time.", metavar="N")] = None
    resume: Annotated[bool, option(_RESUME, "--resume/--no-resume")] = True

    def are_kept(self, out: Path | None, crew: Crew) -> bool:
        """Return whether the sweep is kept in a folder of chunks."""
        if out is None or out.suffix == ".csv":
            if self.chunk is not None:
                raise ParameterError("--chunk is of a sweep that is kept: name a folder by --out sweep.zarr")
            return False
        if out.suffix == ".zarr":
            return True
        asked = self.chunk is not None or crew.asked
        return out.suffix == ".parquet" and (asked or (out / "manifest.parquet").is_file())


@grouped
def sweep(
    scenario: Annotated[Path, argument("SCENARIO", "TOML file that describes the sweep.")],
    *,
    machine: Annotated[Path | None, option(_MACHINE, metavar="TOML")] = None,
    out: Annotated[Path | None, option(_OUT, metavar="FILE")] = None,
    threads: Annotated[int, option("Threads to use; the result is the same for any number.", min=1)] = 1,
    crew: Crew,
    chunks: _Chunks,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find what every combination of parameters settles to, and count the outcomes.

    Example: [bold]hersey sweep examples/scenario.toml --out sweep.parquet --threads 2[/bold]
    """
    folder = out if chunks.are_kept(out, crew) else None
    if threads != 1 and crew.asked:
        raise ParameterError("--threads is of this process alone: with workers leave it out")
    inputs = [scenario, *([machine] if machine else [])]
    table = may_write(out if folder is None else None, force, inputs=inputs, ends=[*TABLES, ".zarr"])

    from hersey.motion.work import Work

    described = _read(scenario, machine, kept=folder is not None)
    with crew.at_work() as client, bar("simulating", unit="sets") as progress:
        work = Work(threads=threads, client=client, chunk=chunks.chunk, progress=progress)
        if folder is not None:
            counted, warnings = _keep(described, folder, chunks.resume, force, work)
        else:
            counted, warnings, result = _run(described, work)
    if table.path is not None:
        from hersey.motion.scenario import rows

        with working("writing the rows"):
            table.write(rows(result, table.path.suffix))
    if as_json:
        print_json(counted)
        return
    say(*_lines(counted), *(f"- {each}" for each in (*warnings, *_of_the_machine(described))))
    say_written(sweep=out)


def _read(scenario: Path, machine: Path | None, *, kept: bool) -> Scenario:
    from hersey.motion.parameters import MOST_SETS
    from hersey.motion.scenario import read_scenario

    stated = None if machine is None else of_a_machine(machine)
    stated_in = "" if machine is None else machine.name
    return read_scenario(scenario, stated=stated, stated_in=stated_in, most=_MOST if kept else MOST_SETS)


def _keep(
    described: Scenario, folder: Path, resume: bool, force: bool, work: Work
) -> tuple[dict[str, Any], list[str]]:
    """Run a sweep into a folder; what it counts, and what to say of it."""
    from hersey.scale.store import SweepFolder

    with _said_if_interrupted():
        found = described.keep(SweepFolder(folder, resume, force), work)
    before = [f"{found.before} of {found.chunks} chunks were there"] if found.before else []
    return found.summary(), [*map(str, found.warnings), *before]


def _run(described: Scenario, work: Work) -> tuple[dict[str, Any], list[str], xr.Dataset]:
    """Run a sweep in memory; what it counts, what to say of it, and all of it."""
    from hersey.motion.scenario import summary

    result = described.run(work)
    return summary(result), result.attrs.get("warnings", []), result


def _lines(counted: dict[str, Any]) -> list[str]:
    """What a sweep counts, and what failed."""
    lines = [f"{kind.replace('_', ' '):16s}{share}" for kind, share in counted["kinds"].items()]
    for name, (low, high) in counted["stick_slip"].items():
        lines.append(f"  {name.replace('_', ' '):16s}{low:.6g} to {high:.6g}")
    return lines + [f"- {failure}" for failure in counted["failures"]]


def _of_the_machine(described: Scenario) -> Iterator[str]:
    """What a machine's file brought to a sweep."""
    if described.grip is not None:
        yield f"the roll grips the belt with up to {described.grip:.4g} N"
    if described.rest_force or described.rest_damping:
        yield (
            f"the no-load torque acts beside the drag: {described.rest_force:.4g} N and "
            f"{described.rest_damping:.4g} N s/m"
        )


@contextmanager
def _said_if_interrupted() -> Iterator[None]:
    """Say on Ctrl-C what is kept."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        say(*(f"hersey: {note}" for note in getattr(interrupt, "__notes__", [])), file=sys.stderr)
        raise
