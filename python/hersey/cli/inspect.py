"""Before a fit: ``hersey inspect``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import AsJson, Force, Logs, Reading, SaveRecipe, drawn
from hersey.cli.outputs import may_draw, may_save_recipe, may_write, show
from hersey.cli.progress import working

_SAVE_MAPPING = "Write a proposal for the channels as hersey.toml beside the log."


@grouped
def inspect(
    logs: Logs,
    *,
    save_mapping: Annotated[bool, option(_SAVE_MAPPING, "--save-mapping")] = False,
    save_recipe: SaveRecipe = None,
    figure: Annotated[Path | None, drawn("every channel")] = None,
    reading: Reading,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Show what a log holds before anything is fitted: clocks, channels, their faults, what it can tell.

    Example: [bold]hersey inspect examples/bench.csv --figure channels.svg[/bold]

    It works on logs that cannot be fitted too, and says why they cannot.
    """
    kept, inputs = None, reading.inputs(logs)
    if save_mapping:
        from hersey.log.mapping import FILE_NAME

        kept = logs[0].with_name(FILE_NAME)
    written = may_write(kept, force, inputs=inputs)
    saved = may_save_recipe(save_recipe, force, inputs)
    drawing = may_draw(figure, force, inputs)

    from hersey.inspection import inspect as inspected
    from hersey.log import memory_limit
    from hersey.log.proposal import propose_mapping

    recipe = reading.recipe(logs)
    with working("looking at the channels"), memory_limit(reading.max_memory):
        given = {name: value for name, value in vars(recipe).items() if name not in ("logs", "no_load")}
        inspection = inspected(logs, **(given | {"means": recipe.are_means}))
    with memory_limit(reading.max_memory):
        if kept is not None:
            proposal = propose_mapping(logs[0], channels=recipe.channels, units=recipe.units)
            written.write(proposal)
        if save_recipe is not None:
            saved.write(recipe.toml(save_recipe.parent))
        drawing.draw(inspection, "drawing the channels", paths=logs)
    show(inspection, as_json, mapping=kept, recipe=save_recipe, figure=figure)
