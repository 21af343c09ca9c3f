"""What every combination of parameters settles to: ``hersey sweep``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.amounts import of_a_machine
from hersey.cli.options import (
    AsJson,
    Force,
)
from hersey.cli.outputs import may_write, print_json
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.errors import OutputError


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
        Path | None, typer.Option("--out", metavar="FILE", help="Write every set as a row: .parquet or .csv.")
    ] = None,
    threads: Annotated[
        int, typer.Option("--threads", help="Threads to use; the result is the same for any number.", min=1)
    ] = 1,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find what every combination of parameters settles to, and count the outcomes.

    Example: [bold]hersey sweep examples/scenario.toml --out sweep.parquet --threads 2[/bold]
    """
    if out is not None:
        if out.suffix not in (".parquet", ".csv"):
            raise OutputError(f"--out {out}: name a file that ends in .parquet or .csv")
        may_write(out, force, inputs=[scenario, *([machine] if machine else [])])

    from hersey.files.writing import write_atomically
    from hersey.motion.scenario import read_scenario, rows, summary

    if machine is None:
        described = read_scenario(scenario)
    else:
        stated = of_a_machine(machine)
        described = read_scenario(scenario, stated=stated, stated_in=machine.name)
    with bar("simulating", unit="sets") as progress:
        result = described.run(threads=threads, progress=progress)
    if out is not None:
        with working("writing the rows"):
            write_atomically(out, rows(result, out.suffix), overwrite=True)
    counted = summary(result)
    if as_json:
        print_json("sweep", counted)
        return
    for kind, share in counted["kinds"].items():
        say(f"{kind.replace('_', ' '):16s}{share}")
    for name, (low, high) in counted["stick_slip"].items():
        say(f"  {name.replace('_', ' '):16s}{low:.6g} to {high:.6g}")
    for failure in counted["failures"]:
        say(f"- {failure}")
    if described.grip is not None:
        say(f"- the roll grips the belt with up to {described.grip:.4g} N")
    if described.rest_force or described.rest_damping:
        say(
            f"- the rest of the drive acts beside the drag: {described.rest_force:.4g} N and "
            f"{described.rest_damping:.4g} N s/m"
        )
    if out is not None:
        say(f"sweep: {out}")
