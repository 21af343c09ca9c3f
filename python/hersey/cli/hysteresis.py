"""The speeds at which the past decides: ``hersey hysteresis``."""

from __future__ import annotations

from typing import Annotated

import typer

from hersey.cli.belt import Belt
from hersey.cli.options import (
    AsJson,
    takes,
)
from hersey.cli.outputs import print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError


@takes(Belt, "belt")
def hysteresis(
    belt: Belt,
    drive_speed: Annotated[
        str | None,
        typer.Option(
            help="Also say how large a kick or step the belt bears that slides at it, as '30 mm/s'."
        ),
    ] = None,
    from_speed: Annotated[
        str | None, typer.Option(help="With --to-speed: say whether a step between them makes it stick.")
    ] = None,
    to_speed: Annotated[str | None, typer.Option(help="Speed at the end of the step.")] = None,
    as_json: AsJson = False,
) -> None:
    """Find the drive speeds between which the past decides whether the belt sticks.

    Numbers carry units, as '11 N/mm', or are bare in any consistent set of units; the defaults are the
    paper's baseline in inches, ounces of force and seconds. With units, results are in SI.

    Example: [bold]hersey hysteresis --from-speed 2.5 --to-speed 1.2[/bold]
    """
    if (from_speed is None) != (to_speed is None):
        raise ParameterError("a step needs both --from-speed and --to-speed")

    from hersey.stability import disturbance as approach
    from hersey.stability.hysteresis import hysteresis as band_of

    train, law, numbers = belt.parts(drive_speed=drive_speed, from_speed=from_speed, to_speed=to_speed)
    sliding, before, after = (numbers.values[name] for name in ("drive_speed", "from_speed", "to_speed"))
    with working("looking for the band"):
        band = band_of(train, law)
        bears = None if sliding is None else approach.disturbance(train, law, drive_speed=sliding)
        step = None
        if before is not None and after is not None:
            step = approach.safe_step(train, law, from_speed=before, to_speed=after)
    if as_json:
        from hersey.result import json_value

        further = {"disturbance": json_value(bears), "step": json_value(step)}
        print_json("hysteresis", band.to_dict() | further)
        return
    lines = [band.summary({**vars(train), **vars(law)})]
    if bears is not None:
        lines.append(
            f"Sliding at {bears.drive_speed:g} it bears a sudden loss of belt speed of {bears.kick:.6g}, "
            f"and a sudden fall of the drive from {bears.drive_speed + bears.step:.6g}."
        )
    if step is not None:
        does = "sticks" if step.sticks else "goes on sliding"
        ramp = (
            "no ramp is slow enough"
            if step.ramp_time == float("inf")
            else f"ramps of {step.ramp_time:.3g} s and longer are safe"
            if step.ramp_time > 0
            else "any ramp is safe"
        )
        lines.append(f"From {step.from_speed:g} to {step.to_speed:g} at once it {does}; {ramp}.")
    say("\n".join([*lines, *numbers.words]))
