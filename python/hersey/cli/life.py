"""Which specimens of a life test fail first, how and when: ``hersey life``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import Figures, Force
from hersey.cli.outputs import PAGES, command, may_write, may_write_folder
from hersey.cli.printing import Printing
from hersey.cli.progress import steps, working
from hersey.cli.quantities import share as share_of

if TYPE_CHECKING:
    from hersey.life.time_to_failure.estimate import TimeToFailure

_CAMPAIGN = "Campaign file, made by 'hersey campaign add'."
_MACHINE = "Machine file with limits, operating points, contact and lubricant."
_UNIT = "Specimen whose maps are drawn.  [default: the next to fail]"
_UNTIL = "Find the run that best shows which specimens last until this age, e.g. '250000 pages'."
_SHARE = "Decide whether at most this share of new specimens fails before --until, e.g. '5 %'."
_COST = "Cost of a failure over that of a planned replacement (a pure number): find when to replace."
#: Specimens in the table, and pieces of advice.
_SHOWN, _ADVISED = 10, 2


@grouped
def life(
    file: Annotated[Path, argument("CAMPAIGN", _CAMPAIGN)],
    *,
    machine_file: Annotated[Path, option(_MACHINE, "--machine", metavar="TOML")],
    out: Annotated[Path | None, option("Write the page here, .html.  [default: life.html]")] = None,
    figures: Figures = None,
    unit: Annotated[str, option(_UNIT)] = "",
    until: Annotated[str, option(_UNTIL)] = "",
    share: Annotated[str, option(_SHARE)] = "",
    cost_of_failure: Annotated[float | None, option(_COST)] = None,
    seed: Annotated[int, option("Random seed.", min=0)] = 0,
    printing: Printing,
    force: Force = False,
) -> None:
    """Predict which specimens of a life test fail first, how, and when.

    Example: [bold]hersey life life.hersey --machine examples/machine.toml[/bold]

    With --json the whole answer is printed instead, and a page is written only if --out is given.
    """
    page = out or (None if printing.as_json else Path("life.html"))
    written = may_write(page, force, inputs=[file, machine_file], ends=PAGES)
    may_write_folder(figures, force)

    from hersey.life.campaign import Campaign
    from hersey.life.following import follow
    from hersey.life.indicator import NOT_JUDGED
    from hersey.machine.machine import read_machine

    allowed = share_of("--share", share) if share else None
    machine = read_machine(machine_file, drivetrain=False)
    with Campaign.open(file, write=False) as campaign:
        with steps() as step:
            answer = follow(
                campaign,
                machine,
                seed=seed,
                unit=unit,
                until=until or None,
                share=allowed,
                cost_of_failure=cost_of_failure,
                uses=page is not None,
                step=step,
            )
        runs = campaign.runs()
    if page is not None:
        from hersey.report.life_page import render_life

        with working("drawing the page"):
            written.write(render_life(answer, runs, command()))
    if figures is not None:
        from hersey.charts.life import write_life_figures

        with working("writing the figures"):
            write_life_figures(answer, figures, overwrite=force)
    if printing.json(answer):
        return
    found = answer.time_to_failure
    if printing.verbose:
        printing.text(answer.summary(), f"seed {seed}")
    else:
        printing.text(*_lines(found))
        warnings = (*found.warnings, *answer.warnings)
        printing.warnings(*(each for each in warnings if each.kind != NOT_JUDGED))
        printing.text(*(f"- Not judged: {each.sentence}" for each in warnings if each.kind == NOT_JUDGED))
        printing.text(
            *(f"Next: {each}." for each in found.advice[: _ADVISED + len(found.deciding_runs)]),
            *filter(None, [found.planning()]),
        )
    printing.files(page, figures)


def _lines(found: TimeToFailure) -> list[str]:
    """When specimens fail and by what, then each specimen."""
    from hersey.cli.figures import labelled

    lines = list(filter(None, [found.headline(), found.of_new(), *found.answers(), found.of_followed()]))
    lines.append(f"Age at failure ({found.age_unit or 'age'}), 90 % interval:")
    ends = [(each.unit, str(each).removeprefix(f"{each.unit}: ")) for each in found.units[:_SHOWN]]
    lines += labelled(ends)
    more = len(found.units) - _SHOWN
    return lines + ([f"  and {more} more specimens"] if more > 0 else [])
