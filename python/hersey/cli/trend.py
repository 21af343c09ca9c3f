"""Friction over time at one speed: ``hersey trend``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import Force, Logs, Reading, drawn
from hersey.cli.outputs import may_write_table_and_figure
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.quantities import amount_of
from hersey.errors import ChannelError, ParameterError, UnitError

if TYPE_CHECKING:
    from hersey.log.torque_log import TorqueLog

_BY = "Count age in time, distance or revolutions."
_AT = "Follow this speed, of a log with several, e.g. '60 rpm'.  [default: the only one]"
_SHARE = "Friction is steady within this share of its steady value."
_OUT = "Write means of blocks with the law and its interval (.csv)."


@grouped
def trend(
    logs: Logs,
    *,
    by: Annotated[str, option(_BY)] = "time",
    at: Annotated[str, option(_AT)] = "",
    share: Annotated[float, option(_SHARE)] = 0.05,
    seed: Annotated[int, option("Random seed.", min=0)] = 1,
    out: Annotated[Path | None, option(_OUT, metavar="CSV")] = None,
    figure: Annotated[Path | None, drawn("friction with the law and its interval")] = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Follow friction over time at one speed: run-in, growth, steady value and sudden jumps.

    Example: [bold]hersey trend examples/bench.csv --at '60 rpm'[/bold]

    Several logs count as one test, one after another. Age counts while the drive turns.
    """
    inputs = reading.inputs(logs)
    table, drawing = may_write_table_and_figure(out, figure, force, inputs)
    reading.refuse_dwells("a trend")

    from hersey.life.trend.fit import trend as followed

    log = _samples(reading, logs)
    speed = amount_of("speed" if log.domain.speed == "speed" else "belt speed", at, "--at") if at else None
    radius = reading.recipe(logs).radius
    with working("following friction"):
        found = followed(
            log, by=by, at=speed, radius=radius if isinstance(radius, float) else None, share=share, seed=seed
        )
    if out is not None:
        from hersey.files.tables import table as content

        table.write(content(found.to_frame(), ".csv"))
    drawing.draw(found, "drawing the trend")
    if printing.json(found):
        return
    printing.conclusion(found.lines, found.summary(), *found.warnings)
    printing.files(out, figure)


def _samples(reading: Reading, logs: list[Path]) -> TorqueLog:
    from hersey.log.torque_log import TorqueLog

    try:
        log = reading.log(logs)
    except (ChannelError, UnitError) as error:  # temperature is used where one is found
        if error.setting is None or error.setting.name != "temperature" or reading.temperature:
            raise
        log = replace(reading, isothermal=True).log(logs)
    if not isinstance(log, TorqueLog):
        raise ParameterError(f"{logs[0]} is a table of means; a trend needs rows of time, torque and speed")
    return log
