"""Every combination of parameters, simulated and counted: ``hersey sweep``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from hersey.cli.amounts import of_a_machine
from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import Force
from hersey.cli.outputs import may_write
from hersey.cli.printing import Printing
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.cli.workers import Crew
from hersey.errors import ParameterError
from hersey.files.tables import TABLES

if TYPE_CHECKING:
    import xarray as xr

    from hersey.motion.scenario import Scenario
    from hersey.motion.work import Work

#: Most sets of a sweep, more than any disk holds.
_MOST = 1e12
_SCENARIO = "TOML file that describes the sweep."
_MACHINE = "Machine file, for grip, no-load torque, and what the scenario does not state."
_OUT = "Write one row per set (.parquet or .csv), or a folder of chunks (.zarr or .parquet)."
_RESUME = "Continue the same sweep in that folder, or start again."
_THREADS = "Threads to use; the result does not depend on it."
_CHUNK = "Keep the sweep in a folder, N sets at a time."
#: The outcomes, in words.
_KINDS = {
    "stick_slip": "stick-slip",
    "steady_sliding": "steady sliding",
    "grip_slip": "drive slips while it slides",
}
#: Ranges of the stick-slip that are printed: name, unit, and how many make one in SI.
_RANGES = {
    "frequency": ("frequency", "Hz", 1.0),
    "stuck_fraction": ("stuck", "% of the time", 100.0),
    "speed_max": ("highest sliding speed", "mm/s", 1e3),
    "stretch_max": ("greatest stretch", "mm", 1e3),
}


@dataclass(frozen=True)
class _Chunks:
    """How a sweep is stored in a folder."""

    chunk: Annotated[int | None, option(_CHUNK, metavar="N")] = None
    resume: Annotated[bool, option(_RESUME, "--resume/--no-resume")] = True

    def are_kept(self, out: Path | None, crew: Crew) -> bool:
        """Return whether the sweep is stored in a folder of chunks."""
        if out is None or out.suffix == ".csv":
            if self.chunk is not None:
                raise ParameterError("--chunk needs a folder: add --out sweep.zarr")
            return False
        if out.suffix == ".zarr":
            return True
        asked = self.chunk is not None or crew.asked
        return out.suffix == ".parquet" and (asked or (out / "manifest.parquet").is_file())


@grouped
def sweep(
    scenario: Annotated[Path, argument("SCENARIO", _SCENARIO)],
    *,
    machine: Annotated[Path | None, option(_MACHINE, metavar="TOML")] = None,
    out: Annotated[Path | None, option(_OUT, metavar="FILE")] = None,
    threads: Annotated[int, option(_THREADS, min=1)] = 1,
    crew: Crew,
    chunks: _Chunks,
    printing: Printing,
    force: Force = False,
) -> None:
    """Simulate every combination of parameters and count the outcomes.

    Example: [bold]hersey sweep examples/scenario.toml --out sweep.parquet --threads 2[/bold]
    """
    folder = out if chunks.are_kept(out, crew) else None
    if threads != 1 and crew.asked:
        raise ParameterError("--threads is for this process only: omit it with --workers or --scheduler")
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
    if printing.json(counted):
        return
    printing.text(*_lines(counted, in_si=described.units == "SI"))
    printing.text(*(f"- {each}" for each in (*warnings, *_of_the_machine(described))))
    printing.files(out)


def _read(scenario: Path, machine: Path | None, *, kept: bool) -> Scenario:
    from hersey.motion.parameters import MOST_SETS
    from hersey.motion.scenario import read_scenario

    stated = None if machine is None else of_a_machine(machine)
    stated_in = "" if machine is None else machine.name
    return read_scenario(scenario, stated=stated, stated_in=stated_in, most=_MOST if kept else MOST_SETS)


def _keep(
    described: Scenario, folder: Path, resume: bool, force: bool, work: Work
) -> tuple[dict[str, Any], list[str]]:
    """Run a sweep into a folder; its counts and its warnings."""
    from hersey.scale.store import SweepFolder

    with _said_if_interrupted():
        found = described.keep(SweepFolder(folder, resume, force), work)
    before = [f"{found.before} of {found.chunks} chunks were there already"] if found.before else []
    return found.summary(), [*map(str, found.warnings), *before]


def _run(described: Scenario, work: Work) -> tuple[dict[str, Any], list[str], xr.Dataset]:
    """Run a sweep in memory; its counts, its warnings, and all of its results."""
    from hersey.motion.scenario import summary

    result = described.run(work)
    return summary(result), result.attrs.get("warnings", []), result


def _lines(counted: dict[str, Any], *, in_si: bool) -> list[str]:
    """The outcomes of a sweep, the ranges of its stick-slip, and what failed."""
    from hersey.cli.figures import labelled, three

    sets = counted["sets"]
    outcomes = sorted(counted["kinds"].items(), key=lambda each: -each[1])
    rows = [
        (_KINDS.get(kind, kind.replace("_", " ")), f"{number} ({100 * number / sets:.0f} %)")
        for kind, number in outcomes
    ]
    ranges = []
    for name, (low, high) in counted["stick_slip"].items():
        label, unit, factor = _RANGES.get(name, (name.replace("_", " "), "", 1.0))
        if not in_si and name != "stuck_fraction":
            unit, factor = "", 1.0
        ranges.append((label, f"{three(factor * low)} to {three(factor * high, unit)}"))
    lines = [f"{sets} set{'s' * (sets != 1)} of parameters", *labelled(rows)]
    lines += ["Where it sticks and slips", *labelled(ranges)] if ranges else []
    return lines + [f"- {failure}" for failure in counted["failures"]]


def _of_the_machine(described: Scenario) -> Iterator[str]:
    """The grip and the no-load torque that a machine file adds to a sweep."""
    from hersey.cli.figures import three

    if described.grip is not None:
        yield f"The drive can pull with up to {three(described.grip, 'N')}."
    if described.rest_force or described.rest_damping:
        force, damping = three(described.rest_force, "N"), three(described.rest_damping, "N·s/m")
        yield f"The no-load torque is added to the drag: {force} + {damping} times speed."


@contextmanager
def _said_if_interrupted() -> Iterator[None]:
    """Print on Ctrl-C what is stored."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        say(*(f"hersey: {note}" for note in getattr(interrupt, "__notes__", [])), file=sys.stderr)
        raise
