"""What ends the units of a life test, and when: ``hersey life``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, Figures, Force
from hersey.cli.outputs import PAGES, command, may_write, may_write_folder, show
from hersey.cli.progress import steps, working

_MACHINE = "Machine file: limits, operating points, film."


@grouped
def life(
    file: Annotated[Path, argument("CAMPAIGN", "File of the campaign, see 'hersey campaign'.")],
    *,
    machine_file: Annotated[Path, option(_MACHINE, "--machine", metavar="TOML")],
    out: Annotated[Path | None, option("The page to write, .html.  [default: life.html]")] = None,
    figures: Figures = None,
    unit: Annotated[str, option("Whose maps are drawn.  [default: the unit that ends next]")] = "",
    seed: Annotated[int, option("Random seed.", min=0)] = 0,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Predict which units of a life test fail first, how, and when, and what to measure next.

    Example: [bold]hersey life life.hersey --machine examples/machine.toml[/bold]

    With --json the whole answer goes to stdout, and a page is written only if --out is given.
    """
    page = out or (None if as_json else Path("life.html"))
    written = may_write(page, force, inputs=[file, machine_file], ends=PAGES)
    may_write_folder(figures, force)

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
            written.write(render_life(answer, runs, command()))
    if figures is not None:
        from hersey.charts.life import write_life_figures

        with working("writing the figures"):
            write_life_figures(answer, figures, overwrite=force)
    show(answer, as_json, f"seed {seed}", report=page)
