"""The paper's figures drawn anew: ``hersey figures``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Force,
)
from hersey.cli.outputs import may_write_folder, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say


def figures(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the figures.")] = Path(
        "figures"
    ),
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Draw the paper's Figs. 9-14 anew and two of our own; say of each claim whether it holds and how well.

    Example: [bold]hersey figures --out figures[/bold]
    """
    may_write_folder(out, force, flag="--out")

    from hersey import paper_figures as paper

    with working("simulating"):
        drawings = paper.all_figures()
    with working("drawing"):
        paper.write(drawings, out, overwrite=force)
    if as_json:
        print_json("figures", json.loads(paper.as_json(drawings)))
        return
    for figure in drawings:
        say(figure.heading)
        for claim in figure.claims:
            say(f"  {claim.verdict.value}: {claim.statement} ({claim.evidence})")
    say(f"figures: {out}")
