"""The speeds at which sticking depends on the start: ``hersey hysteresis``."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Annotated

from hersey.cli.belt import Belt
from hersey.cli.groups import grouped, option
from hersey.cli.mistyped import retyped
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.cli.amounts import Amounts
    from hersey.schema.noun import Noun
    from hersey.stability.disturbance import Disturbance, SafeStep
    from hersey.stability.hysteresis import HysteresisBand

_KICK = "Find the largest disturbance that sliding at this speed survives, e.g. '30 mm/s'."
_STEP = "Test a step of the drive speed, from this speed to --to-speed."
_END = "Speed after the step."


@grouped
def hysteresis(
    *,
    drive_speed: Annotated[str | None, option(_KICK)] = None,
    from_speed: Annotated[str | None, option(_STEP)] = None,
    to_speed: Annotated[str | None, option(_END)] = None,
    belt: Belt,
    printing: Printing,
) -> None:
    """Find the speed range in which sticking depends on how the drive was started.

    Give all numbers with units, e.g. '11 N/mm', or all bare in any consistent set of units. The defaults are
    the paper's baseline, in inches, ounces of force and seconds.

    Example: [bold]hersey hysteresis --from-speed 2.5 --to-speed 1.2[/bold]
    """
    if (from_speed is None) != (to_speed is None):
        given, other = (
            ("--to-speed", "--from-speed") if from_speed is None else ("--from-speed", "--to-speed")
        )
        end = f"the speed {'before' if from_speed is None else 'after'} the step"
        raise ParameterError(f"{given} is one end of a step of the drive speed: add {other} with {end}")

    from hersey.stability.disturbance import disturbance, safe_step
    from hersey.stability.hysteresis import hysteresis as band_of

    train, law, numbers = belt.parts(drive_speed=drive_speed, from_speed=from_speed, to_speed=to_speed)
    sliding, before, after = (numbers.values[name] for name in ("drive_speed", "from_speed", "to_speed"))
    kick, step = None, None
    with working("computing V*"):
        band = band_of(train, law)
        if sliding is not None:
            kick = disturbance(train, law, drive_speed=sliding)
        if before is not None and after is not None:
            try:
                step = safe_step(train, law, from_speed=before, to_speed=after)
            except ParameterError as error:
                raise _as_typed(error, {"from_speed": from_speed, "to_speed": to_speed}, numbers) from None
    if printing.json(band, disturbance=kick, step=step):
        return
    printing.conclusion(lambda: _band(band, numbers, train.part), band.summary({**vars(train), **vars(law)}))
    printing.text(*([] if kick is None else [_survived(kick, numbers)]))
    printing.text(*([] if step is None else [_stepped(step, numbers, train.part)]))
    printing.text(*numbers.words)


def _as_typed(error: ParameterError, typed: dict[str, str | None], numbers: Amounts) -> ParameterError:
    """The same error of a speed in the words and units of the command line."""
    if error.quantity not in typed or error.limit is None or error.value is None:
        return error
    value, shown = typed[error.quantity], numbers.shown(error.value, "belt speed")
    said = f"--{error.quantity.replace('_', '-')} '{value}'{f' ({shown})' * (shown != value)}"
    if error.limit == 0:
        return ParameterError(f"{said} must be {'finite' if error.value == math.inf else 'greater than 0'}")
    end = numbers.values["to_speed"]
    swaps = end is not None and end >= error.limit
    swap = f", or swap the two speeds: {retyped(*_swapped(sys.argv[1:]))}" if swaps else ""
    return ParameterError(
        f"{said} lies below the transition speed, {numbers.shown(error.limit, 'belt speed')}. Below it, "
        f"sliding is unstable. Start from a higher speed{swap}"
    )


def _swapped(words: list[str]) -> list[str]:
    """The words with the two ends of the step exchanged."""
    other = {"--from-speed": "--to-speed", "--to-speed": "--from-speed"}
    split = (word.partition("=") for word in words)
    return [f"{other.get(flag, flag)}{mark}{value}" for flag, mark, value in split]


def _band(band: HysteresisBand, numbers: Amounts, part: Noun) -> list[str]:
    """What happens at which drive speeds."""
    lower, least, upper = (numbers.shown(v, "belt speed") for v in (band.lower, band.transition, band.upper))
    between = numbers.shown_range(band.transition, band.upper, "belt speed")
    lines = []
    if band.stalls:
        lines.append("The grip does not suffice to start from rest, at any drive speed.")
    if band.upper == 0:
        return [
            *lines,
            f"No stick-slip. Once sliding, the {part} keeps sliding above {least}, within the grip.",
        ]
    if not band.bistable:
        return [*lines, f"Stick-slip ends at {upper}, whatever the start (speed of least drag: {least})."]
    if band.upper == math.inf:
        return [
            *lines,
            f"Sticks below {lower}. Above {least} it depends on the start, with no upper end.",
        ]
    return [
        *lines,
        f"Smooth from any start above {upper} (V*). Sticks from any start below {lower}.",
        f"From {between} the {part} sticks if started from rest and slides if slowed from above.",
    ]


def _survived(found: Disturbance, numbers: Amounts) -> str:
    at, kick = (numbers.shown(v, "belt speed") for v in (found.drive_speed, found.kick))
    above = numbers.shown(found.drive_speed + found.step, "belt speed")
    if found.kick == found.step == math.inf:
        return f"Sliding at {at} survives any disturbance."
    loss = "any sudden loss of speed" if found.kick == math.inf else f"a sudden loss of speed of {kick}"
    return f"Sliding at {at} survives {loss} and a sudden step of the drive down from {above}."


def _stepped(step: SafeStep, numbers: Amounts, part: Noun) -> str:
    before, after = (numbers.shown(v, "belt speed") for v in (step.from_speed, step.to_speed))
    does = f"makes the {part} stick" if step.sticks else f"keeps the {part} sliding"
    ramp = "Any ramp is safe."
    if step.ramp_time == math.inf:
        ramp = "No ramp is slow enough."
    elif step.ramp_time > 0:
        ramp = f"Use a ramp of at least {numbers.shown(step.ramp_time, 'time')}."
    return f"A sudden step from {before} to {after} {does}. {ramp}"
