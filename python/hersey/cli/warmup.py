"""A warm-up that keeps grip and motor: ``hersey warmup``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, FitFile, Force, Reading, SomeLogs, drawn
from hersey.cli.outputs import give, may_write_table_and_figure
from hersey.cli.progress import working
from hersey.cli.quantities import share, target_of
from hersey.cli.warming import beyond_the_log, heat_of, warming_drag
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.machine.machine import Machine


_MACHINE = "TOML file of the drivetrain, its limits and \\[heat]."
_OUT = "Write the course; plan --temperature-profile reads it."


@dataclass(frozen=True)
class _Course:
    """The warm-up that is sought."""

    target: Annotated[str, option("Full speed of the belt, as '120 mm/s', or of the roll, as '80 rpm'.")] = ""
    start: Annotated[str, option("Temperature of the cold start.  [default: that of \\[heat]]", "--from")] = (
        ""
    )
    margin: Annotated[str, option("Share of the limit of force that is kept to spare.")] = "10 %"
    longest: Annotated[str, option("Time looked at, with its unit.")] = "30 min"

    def sought(self, machine: Machine) -> dict[str, float]:
        """Return target, margin and longest time in SI."""
        from hersey.units import parse

        return {
            "target_speed": target_of(self.target, machine),
            "margin": share("--margin", self.margin),
            "longest": parse("time", self.longest),
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
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find the quickest warm-up whose drag stays below grip and motor: slow until warm.

    Example: [bold]hersey warmup examples/machine.toml examples/bench.csv --tare standing --target "120 mm/s"
    --from "20 degC" --figure warm-up.png[/bold]

    Exit code 1 says that full speed is not reached; then nothing is written.
    """
    inputs = reading.inputs(machine_file, logs, fit_file)
    outputs = may_write_table_and_figure(out, figure, force, inputs)

    from hersey.machine.machine import read_machine
    from hersey.schema.warning import Warning
    from hersey.stability.warm_up import warm_up

    machine = read_machine(machine_file)
    sought, heat = course.sought(machine), heat_of(machine, machine_file, course.start)
    weakest, limits = _limits(machine, machine_file.name)
    surface = reading.surface(logs, fit_file, machine)
    with working("warming up"):
        warm = warm_up(machine.train, warming_drag(surface, machine), heat, **sought, **limits)
    limit = Warning("force limit", "the limit is that of the {limit}", limit=weakest)
    beyond = beyond_the_log(surface, warm.film_temperature)
    warm = replace(warm, warnings=(*warm.warnings, limit, *beyond))
    give(warm, outputs, as_json, called="course")


def _limits(machine: Machine, file: str) -> tuple[str, dict[str, float]]:
    """What limits the force, and the limits of force and acceleration."""
    limit = machine.limits.force(machine.roll_radius)
    if limit is None:
        raise ParameterError(
            f"{file} states no limit of force: add motor_torque, or roll_friction and nip_load, to [limits]"
        )
    if machine.limits.acceleration is None:
        raise ParameterError(f"{file} states no acceleration: add it to [limits]")
    return limit[0], {"force_limit": limit[1], "acceleration": machine.limits.acceleration}
