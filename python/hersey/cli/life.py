"""What ends the units of a life test, and when: ``hersey life``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import AsJson, Force
from hersey.cli.outputs import PAGES, command, may_write, may_write_folder, print_json
from hersey.cli.progress import steps, working
from hersey.cli.terminal import say


def life(
    file: Annotated[
        Path, typer.Argument(metavar="CAMPAIGN", help="File of the campaign, see 'hersey campaign'.")
    ],
    machine_file: Annotated[
        Path,
        typer.Option("--machine", metavar="TOML", help="Machine's file: limits, operating points, film."),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", help="The page to write, .html.  [default: life.html]")
    ] = None,
    figures: Annotated[
        Path | None,
        typer.Option("--figures", metavar="DIR", help="Also write each chart as SVG, PNG and PDF."),
    ] = None,
    unit: Annotated[
        str, typer.Option("--unit", help="Whose maps are drawn.  [default: the unit that ends next]")
    ] = "",
    seed: Annotated[int, typer.Option("--seed", min=0, help="Of all draws.")] = 0,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Say what ends the units of a life test, and when: growth, film, drift, what to measure next.

    Example: [bold]hersey life life.hersey --machine examples/machine.toml[/bold]

    With --json the whole answer goes to stdout, and a page is written only if --out is given.
    """
    page = out or (None if as_json else Path("life.html"))
    overwrite = page is not None and may_write(page, force, inputs=[file, machine_file], ends=PAGES)
    if figures is not None:
        may_write_folder(figures, force)

    from hersey.files.writing import write_atomically
    from hersey.life.campaign import Campaign
    from hersey.life.following import follow
    from hersey.machine.machine import read_machine

    machine = read_machine(machine_file)
    with Campaign.open(file, write=False) as campaign:
        with steps() as step:
            answer = follow(campaign, machine, seed=seed, unit=unit, uses=page is not None, step=step)
        runs = campaign.runs()
    if page is not None:
        from hersey.report.life_page import render_life

        with working("drawing the page"):
            write_atomically(page, render_life(answer, runs, command()), overwrite=overwrite)
    if figures is not None:
        from hersey.charts.life import write_life_figures

        with working("writing the figures"):
            write_life_figures(answer, figures, overwrite=force)
    if as_json:
        print_json("life", answer.to_dict())
        return
    say(answer.summary())
    say(f"seed {seed}")
    if page is not None:
        say(f"report: {page}")
