"""Before a fit: ``hersey inspect``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.no_torque import other_use
from hersey.cli.options import Force, Logs, Reading, SaveRecipe, drawn
from hersey.cli.outputs import may_draw, may_save_recipe, may_write
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.traces import of_a_trace
from hersey.errors import Setting

if TYPE_CHECKING:
    from hersey.inspection import Inspection

_SAVE_MAPPING = "Write the proposed layout, channels and units as hersey.toml beside the log."
#: Settings of a recipe that only a fit takes.
_OF_A_FIT = ("logs", "no_load", "moving", "inertia", "inertia_error")
#: Longest name of a channel in the table, and most channels without a role that it shows.
_LONGEST, _OTHERS = 28, 8


@grouped
def inspect(
    logs: Logs,
    *,
    save_mapping: Annotated[bool, option(_SAVE_MAPPING, "--save-mapping")] = False,
    save_recipe: SaveRecipe = None,
    figure: Annotated[Path | None, drawn("every channel")] = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Show what a log holds, what is wrong with it and what it can show, before a fit.

    Example: [bold]hersey inspect examples/bench.csv --figure channels.svg[/bold]

    Logs that cannot be fitted can be inspected too; the reason is shown.
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
    if kept is not None:
        with working("looking at the channels"), memory_limit(reading.max_memory):
            names = [log.name for log in logs]
            said = recipe.stated()
            text = propose_mapping(
                logs[0], channels=recipe.channels, units=recipe.units, names=names, said=said
            )
            written.write(text)
    with working("looking at the channels"), memory_limit(reading.max_memory):
        given = {name: value for name, value in vars(recipe).items() if name not in _OF_A_FIT}
        inspection = inspected(logs, **(given | {"means": recipe.are_means}))
    with memory_limit(reading.max_memory):
        if save_recipe is not None:
            saved.write(recipe.toml(save_recipe.parent))
        drawing.draw(inspection, "drawing the channels", paths=logs)
    if printing.json(inspection):
        return
    if printing.verbose or inspection.support is None:  # what a log lacks can be anywhere in it
        printing.text(inspection.summary())
    else:
        printing.text(*_lines(inspection))
    if _lacks_channels(inspection):
        printing.text(*filter(None, [other_use(logs, reading)]))
    elif inspection.support is not None and inspection.support.dwells == 0:
        printing.text(*filter(None, [of_a_trace(logs)]))
    printing.files(kept, save_recipe, figure)


def _lacks_channels(inspection: Inspection) -> bool:
    """Whether no fit is possible because the files have not the channels of a log."""
    return inspection.support is None and any(
        why.absent for file in inspection.files for why in file.lacking.values()
    )


def _lines(inspection: Inspection) -> list[str]:
    """The files, what is wrong, whether a fit is possible, and the channels with a role."""
    from hersey.cli.figures import columns, three

    lines = [f"{file.name}: {file.format}, {file.rows} rows" for file in inspection.files]
    support = inspection.support
    if support is not None:
        lines.append(f"{support.dwells} dwells")
        lines += [f"  can show     {text}" for text in support.can]
        lines += [f"  cannot show  {text}" for text in support.cannot]
    lines += [f"Corrected: {each}" for each in inspection.corrections]
    lines += [
        f"{rows} {'row' if rows == 1 else 'rows'} of {name} {'is' if rows == 1 else 'are'} dropped: "
        "a number is missing or impossible"
        for name, rows in inspection.dropped.items()
    ]
    if inspection.advised:
        switches = (Setting(each, "switch").to() for each in inspection.advised)
        lines.append(f"To fit it, add {' '.join(switches)}")
    found = [each.sentence for each in (*inspection.warnings, *inspection.channel_warnings)]
    for file in inspection.files:
        found += [each.sentence for each in file.warnings]
        found += [f"{file.name}: {role}: {why}." for role, why in file.without.items()]
    lines += [f"- {each}" for each in dict.fromkeys(found)]
    rows = [
        (
            channel.name[:_LONGEST],
            channel.role or "-",
            three(channel.traits.low),
            three(channel.traits.high),
            channel.unit,
        )
        for file in inspection.files
        for channel in sorted(file.channels, key=lambda each: not each.role)[: _OTHERS + 4]
    ]
    return [*lines, "", *columns(("channel", "role", "from", "to", "unit"), rows)]
