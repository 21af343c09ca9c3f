"""The quickest warm-up within the limits of grip and motor: ``hersey warmup``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import FitFile, Force, Reading, SomeLogs, drawn
from hersey.cli.outputs import may_write_table_and_figure
from hersey.cli.printing import Printing, write_course
from hersey.cli.progress import working
from hersey.cli.quantities import amount_of, share, target_of
from hersey.cli.warming import (
    beyond_the_log,
    heat_of,
    refuse_above_setpoint,
    refuse_below_zero,
    start_of,
    warming_drag,
)
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.machine.machine import Machine
    from hersey.schema.noun import Noun
    from hersey.stability.warm_up_result import WarmUp


_MACHINE = "Machine file with drivetrain, limits and \\[heat]."
_OUT = "Write the warm-up as a table, which plan --temperature-profile reads."
_TARGET = "Full speed where it slides, e.g. '120 mm/s', or of the shaft, e.g. '80 rpm'."
_FROM = "Temperature of the cold start, e.g. '20 degC'.  [default: that of \\[heat]]"
#: Rows of the table.
_ROWS = 12


@dataclass(frozen=True)
class _Course:
    """Target, start and margin of the warm-up."""

    target: Annotated[str, option(_TARGET)] = ""
    start: Annotated[str, option(_FROM, "--from")] = ""
    margin: Annotated[str, option("Keep this share of the force limit in reserve.")] = "10 %"
    longest: Annotated[str, option("Longest warm-up to consider.")] = "30 min"

    def sought(self, machine: Machine) -> dict[str, float]:
        """Return target, margin and longest time in SI."""
        return {
            "target_speed": target_of(self.target, machine),
            "margin": share("--margin", self.margin),
            "longest": amount_of("time", self.longest, "--longest"),
        }


@grouped
def warmup(
    machine_file: Annotated[Path, argument("MACHINE", _MACHINE)],
    *,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    course: _Course,
    out: Annotated[Path | None, option(_OUT, metavar="CSV")] = None,
    figure: Annotated[Path | None, drawn("speed, drag and temperatures")] = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Find the quickest warm-up whose drag stays within the limits of grip and motor.

    Example: [bold]hersey warmup examples/machine.toml examples/bench.csv --tare standing --target "120 mm/s"
    --from "20 degC" --figure warm-up.png[/bold]

    The exit code is 1 if full speed is not reached; then nothing is written.
    """
    inputs = reading.inputs(machine_file, logs, fit_file)
    outputs = may_write_table_and_figure(out, figure, force, inputs)

    from hersey.machine.machine import read_machine
    from hersey.schema.warning import Warning
    from hersey.stability.warm_up import warm_up

    machine = read_machine(machine_file)
    sought, heat = course.sought(machine), heat_of(machine, machine_file, course.start)
    refuse_above_setpoint(machine, machine_file, course.start)
    weakest, limits = _limits(machine, machine_file.name)
    surface = reading.surface(logs, fit_file, machine, machine_file)
    refuse_below_zero(surface, heat, start_of(machine_file, course.start), fit_file)
    with working("warming up"):
        warm = warm_up(machine.train, warming_drag(surface, machine), heat, **sought, **limits)
    limit = Warning("force limit", "the limit is that of the {limit}", limit=weakest)
    beyond = beyond_the_log(surface, warm.film_temperature)
    warm = replace(warm, warnings=(*warm.warnings, limit, *beyond))
    write_course(warm, outputs, printing, lambda: _lines(warm, weakest, machine.part))


def _lines(warm: WarmUp, weakest: str, part: Noun) -> list[str]:
    """The warm-up in words, what the alternatives would do, and a table."""
    import math

    import numpy as np

    from hersey.cli.figures import columns, four, three
    from hersey.schema.noun import BELT
    from hersey.units import celsius

    lines = [_verdict(warm)]
    if math.isfinite(warm.start):
        limit = f"limit of the {weakest}, {three(warm.force_limit, 'N')}, less {three(100 * warm.margin)} %"
        lines.append(f"Drag stays below {three(warm.kept_below, 'N')} ({limit}).")
    lines += _alternatives(warm)
    last = min(warm.time.size - 1, int(np.searchsorted(warm.time, warm.full_speed)))
    film, roll = celsius(warm.film_temperature), celsius(warm.roll_temperature)
    body = "roll" if part == BELT else "counterbody"
    rows = [
        (four(warm.time[i]), four(1e3 * warm.drive_speed[i]), f"{film[i]:.1f}", f"{roll[i]:.1f}")
        for i in np.unique(np.linspace(0, last, _ROWS).round().astype(int)).tolist()
    ]
    return [
        *lines,
        "",
        *columns(("time (s)", "drive (mm/s)", "film (°C)", f"{body} (°C)"), rows, first=">"),
    ]


def _verdict(warm: WarmUp) -> str:
    """When to start and when full speed is reached."""
    import math

    from hersey.cli.figures import three
    from hersey.units import celsius

    target, longest = three(1e3 * warm.target_speed, "mm/s"), three(float(warm.time[-1]), "s")
    if not math.isfinite(warm.start):
        end = f"{celsius(float(warm.film_temperature[-1])):.0f} °C"
        return (
            f"The drive cannot start within {longest}: at {end} drag is still above the limit at any speed."
        )
    first = "Start at once" if warm.start == 0 else f"Stand for {three(warm.start, 's')}, then start"
    if not math.isfinite(warm.full_speed):
        last = three(1e3 * float(warm.drive_speed[-1]), "mm/s")
        return f"{first}. {target} is not reached within {longest}; the speed is then {last}."
    at = int(warm.time.searchsorted(warm.full_speed))
    film = f"{celsius(float(warm.film_temperature[at])):.0f} °C"
    sticks = "" if math.isfinite(warm.slides_from) else " It sticks at that speed."
    least = warm.target_speed / warm.acceleration + 2.0 * float(warm.time[1])
    slow = " and run slowly until warm" if warm.full_speed - warm.start > least else ""
    when = f"Full speed {target} is reached after {three(warm.full_speed, 's')}, at {film}."
    return f"{first}{slow}. {when}{sticks}"


def _alternatives(warm: WarmUp) -> list[str]:
    """What full speed at once, and standing until warm, would do."""
    import math

    from hersey.cli.figures import three

    share = (
        f"{three(warm.drag_at_once, 'N')}, {three(100 * warm.drag_at_once / warm.force_limit)} % of the limit"
    )
    if not math.isfinite(warm.within_at_once):
        ends = f"above the limit for {three(float(warm.time[-1]), 's')}"
    else:
        ends = (
            f"within the limit after {three(warm.within_at_once, 's')}"
            if warm.within_at_once > 0
            else "within it"
        )
    lines = [f"Full speed at once takes {share}: {ends}."]
    if not math.isfinite(warm.full_speed_standing):
        return [*lines, "Standing until warm does not reach full speed."]
    return [*lines, f"Standing until warm reaches full speed after {three(warm.full_speed_standing, 's')}."]


def _limits(machine: Machine, file: str) -> tuple[str, dict[str, float]]:
    """The name of the force limit, and the limits of force and acceleration."""
    limit = machine.limits.force(machine.roll_radius)
    if limit is None:
        raise ParameterError(
            f"{file} has no force limit: add motor_torque, or roll_friction and nip_load, to [limits]"
        )
    if machine.limits.acceleration is None:
        raise ParameterError(f"{file} has no acceleration limit: add acceleration to [limits]")
    return limit[0], {"force_limit": limit[1], "acceleration": machine.limits.acceleration}
