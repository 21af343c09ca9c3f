"""The speeds at which the past decides: ``hersey hysteresis``."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Belt,
    takes,
)
from hersey.cli.progress import working
from hersey.errors import ParameterError


@takes(Belt, "belt")
def hysteresis(
    belt: Belt,
    drive_speed: Annotated[
        float | None, typer.Option(help="Also say how large a kick or step the belt bears that slides at it.")
    ] = None,
    from_speed: Annotated[
        float | None, typer.Option(help="With --to-speed: say whether a step between them makes it stick.")
    ] = None,
    to_speed: Annotated[float | None, typer.Option(help="Speed at the end of the step.")] = None,
    as_json: AsJson = False,
) -> None:
    """Find the drive speeds between which the past decides whether the belt sticks.

    Values are in any consistent set of units; the defaults are the paper's baseline in inches, ounces of
    force and seconds.

    Example: [bold]hersey hysteresis --from-speed 2.5 --to-speed 1.2[/bold]
    """
    if (from_speed is None) != (to_speed is None):
        raise ParameterError("a step needs both --from-speed and --to-speed")

    from hersey.stability import disturbance as approach
    from hersey.stability.hysteresis import hysteresis as band_of

    train, law = belt.parts()
    with working("looking for the band"):
        band = band_of(train, law)
        bears = None if drive_speed is None else approach.disturbance(train, law, drive_speed=drive_speed)
        step = None
        if from_speed is not None and to_speed is not None:
            step = approach.safe_step(train, law, from_speed=from_speed, to_speed=to_speed)
    if as_json:
        from hersey.result import json_value

        document = {
            **json_value(asdict(band)),
            "bistable": band.bistable,
            "verdict": band.verdict(),
            "disturbance": None if bears is None else json_value(asdict(bears)),
            "step": None if step is None else json_value(asdict(step)),
        }
        print(json.dumps(document, indent=1, allow_nan=False))
        return
    lines = [
        f"lower edge        {band.lower:.9g}  (to {band.lower_accuracy:.0e})",
        f"transition speed  {band.transition:.9g}",
        f"upper fold V*     {band.upper:.9g}  (to {band.upper_accuracy:.0e}, by {band.method})",
    ]
    if band.deeper:
        lines.append("at the upper fold a deeper stick-slip ends, released higher than at the stick speed")
    if band.sensitivity:
        own = {**vars(train), **vars(law)}
        lines.append(
            f"{'parameter':18s} {'value':>12s} {'dV*/dparameter':>15s}"
            f" {'V* for +1 %':>13s} {'lower, +1 %':>13s}"
        )
        lines += [
            f"{name:18s} {own[name]:12.6g} {band.derivative(name, own[name]):15.6g} {share:+10.3f} % "
            f"{band.lower_sensitivity[name]:+10.3f} %"
            for name, share in band.sensitivity.items()
        ]
    lines.append(band.verdict())
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
            else f"ramps of {step.ramp_time:.6g} and longer are safe"
            if step.ramp_time > 0
            else "any ramp is safe"
        )
        lines.append(f"From {step.from_speed:g} to {step.to_speed:g} at once it {does}; {ramp}.")
    print("\n".join(lines))
