"""A drive profile that ends smooth: ``hersey plan``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import AsJson, FitFile, Force, Reading, SomeLogs, Traces, drawn
from hersey.cli.outputs import give, may_write_table_and_figure
from hersey.cli.progress import bar, working
from hersey.cli.quantities import target_of, temperature_of
from hersey.cli.warming import beyond_the_log, heat_of
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.surface import DampingSurface
    from hersey.machine.machine import Machine
    from hersey.motion.heat import HeatBalance
    from hersey.motion.schedule import Schedule
    from hersey.posterior.result import Posterior
    from hersey.stability.plan import Plan

    Temperature = float | Schedule | HeatBalance | None


_MACHINE = "TOML file of the drivetrain, its limits and uncertainty."
_TARGET = "Target speed of the belt, as '60 mm/s', or of the roll, as '40 rpm'."
_PROFILE = "Instead: temperature against time, in any format that a log may have."
_HEAT = "Instead: the temperature that \\[heat] of the file and the plan make."
_FROM = "With --heat: of the cold start.  [default: that of \\[heat]]"


@dataclass(frozen=True)
class _Film:
    """The temperature of the film: one, a course, or what heats it from a start."""

    at: Annotated[str, option("Temperature, as '150 degC'.")] = ""
    temperature_profile: Annotated[Path | None, option(_PROFILE, metavar="FILE")] = None
    heat: Annotated[bool, option(_HEAT, "--heat")] = False
    start: Annotated[str, option(_FROM, "--from")] = ""

    def refuse_two(self) -> None:
        """Refuse more than one of them."""
        if sum((bool(self.at), self.temperature_profile is not None, self.heat)) > 1:
            raise ParameterError("give one of --at, --temperature-profile and --heat")
        if self.start and not self.heat:
            raise ParameterError("--from goes with --heat")

    def temperature(self, machine: Machine, file: Path, max_memory: str) -> Temperature:
        """Return what is given of it, K; None where nothing is."""
        from hersey.log import memory_limit
        from hersey.machine.temperature_profile import read_temperature_profile

        if self.temperature_profile is not None:
            with memory_limit(max_memory):
                return read_temperature_profile(self.temperature_profile)
        return heat_of(machine, file, self.start) if self.heat else temperature_of(self.at)


@dataclass(frozen=True)
class _Proof:
    """How surely a profile must work, and on which draws that is shown."""

    confidence: Annotated[float, option("Share of the belts that must run smoothly, 0.5 to 0.999.")] = 0.95
    seed: Annotated[int, option("Of all random draws.", min=0)] = 1


@grouped
def plan(
    machine_file: Annotated[Path, argument("MACHINE", _MACHINE)],
    *,
    logs: SomeLogs = None,
    fit_file: FitFile = None,
    trace: Traces = None,
    target: Annotated[str, option(_TARGET)] = "",
    film: _Film,
    proof: _Proof,
    out: Annotated[Path | None, option("Write the profile for a motor controller.", metavar="CSV")] = None,
    figure: Annotated[Path | None, drawn("profile and motion")] = None,
    reading: Reading,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find the quickest profile of drive speed from rest that ends smooth, and say how surely it does.

    Example: [bold]hersey plan examples/machine.toml examples/bench.csv --tare standing --target "60 mm/s"
    --at "150 degC" --out profile.csv --figure plan.png[/bold]

    Exit code 1 says that no profile exists; then nothing is written.
    """
    inputs = reading.inputs(machine_file, logs, fit_file, film.temperature_profile, trace)
    outputs = may_write_table_and_figure(out, figure, force, inputs)
    film.refuse_two()

    from hersey.machine.machine import read_machine
    from hersey.motion.schedule import Schedule

    machine = read_machine(machine_file)
    wanted = target_of(target, machine)
    temperature = film.temperature(machine, machine_file, reading.max_memory)
    surface, drawn_of_log = reading.surface_and_posterior(logs, fit_file, machine, trace, seed=proof.seed)
    if drawn_of_log is None:
        planned = _of_a_fit(surface, machine, wanted, temperature, proof)
    else:
        planned = _of_draws(drawn_of_log, surface, wanted, temperature, proof)
    course = temperature if isinstance(temperature, Schedule) else planned.course if film.heat else None
    if course is not None:
        beyond = beyond_the_log(surface, course.values)
        planned = replace(planned, warnings=(*planned.warnings, *beyond))
    give(planned, outputs, as_json, called="profile", temperature=course)


def _of_a_fit(
    surface: DampingSurface, machine: Machine, target: float, temperature: Temperature, proof: _Proof
) -> Plan:
    """The plan of one law with two branches, which a fit is."""
    from hersey.schema.warning import Warning
    from hersey.stability.plan import plan_of_log

    with bar("planning", unit="profiles") as progress:
        found = plan_of_log(
            surface, machine, target_speed=target, temperature=temperature, progress=progress, **vars(proof)
        )
    alone = Warning(
        "fit without its log",
        "--fit holds one law with two branches",
        remedy="give the log to count other drag curves, both closures and starts",
    )
    return replace(found, warnings=(*found.warnings, alone))


def _of_draws(
    draws: Posterior, surface: DampingSurface, target: float, temperature: Temperature, proof: _Proof
) -> Plan:
    """The plan of all drives that the log allows."""
    from hersey.decision.start_up import plan_start_up
    from hersey.decision.warming import plan_warm_start
    from hersey.stability.plan import check_temperature

    if temperature is None or isinstance(temperature, float):
        check_temperature(surface, temperature)
        with working("planning"):
            return plan_start_up(draws, temperature, target, confidence=proof.confidence)
    with bar("planning", unit="profiles") as progress:
        return plan_warm_start(draws, target, temperature=temperature, progress=progress, **vars(proof))
