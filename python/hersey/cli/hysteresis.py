"""The speeds at which the past decides: ``hersey hysteresis``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from hersey.cli.belt import Belt
from hersey.cli.groups import grouped, option
from hersey.cli.options import AsJson
from hersey.cli.outputs import print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.stability.disturbance import Disturbance, SafeStep

_KICK = "Also say how large a kick or step the belt bears that slides at it, as '30 mm/s'."
_STEP = "With --to-speed: say whether a step between them makes it stick."


@grouped
def hysteresis(
    *,
    drive_speed: Annotated[str | None, option(_KICK)] = None,
    from_speed: Annotated[str | None, option(_STEP)] = None,
    to_speed: Annotated[str | None, option("Speed at the end of the step.")] = None,
    belt: Belt,
    as_json: AsJson = False,
) -> None:
    """Find the drive speeds between which the past decides whether the belt sticks.

    Numbers carry units, as '11 N/mm', or are bare in any consistent set of units; the defaults are the
    paper's baseline in inches, ounces of force and seconds. With units, results are in SI.

    Example: [bold]hersey hysteresis --from-speed 2.5 --to-speed 1.2[/bold]
    """
    if (from_speed is None) != (to_speed is None):
        raise ParameterError("a step needs both --from-speed and --to-speed")

    from hersey.stability.disturbance import disturbance, safe_step
    from hersey.stability.hysteresis import hysteresis as band_of

    train, law, numbers = belt.parts(drive_speed=drive_speed, from_speed=from_speed, to_speed=to_speed)
    sliding, before, after = (numbers.values[name] for name in ("drive_speed", "from_speed", "to_speed"))
    bears, step = None, None
    with working("looking for the band"):
        band = band_of(train, law)
        if sliding is not None:
            bears = disturbance(train, law, drive_speed=sliding)
        if before is not None and after is not None:
            step = safe_step(train, law, from_speed=before, to_speed=after)
    if as_json:
        print_json(band, disturbance=bears, step=step)
        return
    lines = [band.summary({**vars(train), **vars(law)})]
    lines += [] if bears is None else [_borne(bears)]
    lines += [] if step is None else [_stepped(step)]
    say(*lines, *numbers.words)


def _borne(found: Disturbance) -> str:
    return (
        f"Sliding at {found.drive_speed:g} it bears a sudden loss of belt speed of {found.kick:.6g}, "
        f"and a sudden fall of the drive from {found.drive_speed + found.step:.6g}."
    )


def _stepped(step: SafeStep) -> str:
    does, ramp = "sticks" if step.sticks else "goes on sliding", "any ramp is safe"
    if step.ramp_time == float("inf"):
        ramp = "no ramp is slow enough"
    elif step.ramp_time > 0:
        ramp = f"ramps of {step.ramp_time:.3g} s and longer are safe"
    return f"From {step.from_speed:g} to {step.to_speed:g} at once it {does}; {ramp}."
