"""Before a fit: ``hersey inspect``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Force,
    Logs,
    Reading,
    reads_logs,
)
from hersey.cli.outputs import may_draw, may_write, print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say


@reads_logs
def inspect(
    logs: Logs,
    reading: Reading,
    save_mapping: Annotated[
        bool,
        typer.Option(
            "--save-mapping", help="Write a proposal for the channels as hersey.toml beside the log."
        ),
    ] = False,
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Draw every channel: .html, .png, .svg or .pdf.")
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Show what a log holds before anything is fitted: clocks, channels, their faults, what it can tell.

    Example: [bold]hersey inspect examples/bench.csv --figure channels.svg[/bold]

    It works on logs that cannot be fitted too, and says why they cannot.
    """
    kept, replace_mapping, inputs = None, False, reading.inputs(logs)
    if save_mapping:
        from hersey.log.mapping import FILE_NAME

        kept = logs[0].with_name(FILE_NAME)
        replace_mapping = may_write(kept, force, inputs=inputs)
    replace_figure = figure is not None and may_draw(figure, force, inputs)

    from hersey.files.writing import write_atomically
    from hersey.inspection import inspect as inspected
    from hersey.log import memory_limit
    from hersey.log.proposal import propose_mapping

    recipe = reading.recipe(logs)
    with working("looking at the channels"), memory_limit(reading.max_memory):
        given = {name: value for name, value in vars(recipe).items() if name not in ("logs", "no_load")}
        inspection = inspected(logs, **(given | {"means": recipe.are_means}))
    if kept is not None:
        with memory_limit(reading.max_memory):
            proposal = propose_mapping(logs[0], channels=recipe.channels, units=recipe.units)
        write_atomically(kept, proposal, overwrite=replace_mapping)
    if figure is not None:
        from hersey.charts import chart_of
        from hersey.charts.render import picture

        with working("drawing the channels"), memory_limit(reading.max_memory):
            chart = chart_of(inspection, paths=logs)
            write_atomically(figure, picture(chart, figure.suffix), overwrite=replace_figure)
    if as_json:
        print_json("inspect", inspection.to_dict())
        return
    say(inspection.summary())
    if kept is not None:
        say(f"mapping: {kept}")
    if figure is not None:
        say(f"figure: {figure}")
