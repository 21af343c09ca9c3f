"""A drive profile that ends smooth: ``hersey plan``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import FitFile, Force, Reading, SomeLogs, Traces, drawn
from hersey.cli.outputs import may_write_table_and_figure
from hersey.cli.printing import Printing, write_course
from hersey.cli.progress import bar, working
from hersey.cli.quantities import target_of, temperature_of
from hersey.cli.warming import beyond_the_log, heat_of, refuse_below_zero, start_of
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.surface import DampingSurface
    from hersey.machine.machine import Machine
    from hersey.motion.heat import HeatBalance
    from hersey.motion.schedule import Schedule
    from hersey.posterior.result import Posterior
    from hersey.schema.noun import Noun
    from hersey.stability.plan import Plan

    Temperature = float | Schedule | HeatBalance | None


_MACHINE = "Machine file with drivetrain, limits and uncertainties."
_TARGET = "Target speed where it slides, e.g. '60 mm/s', or of the shaft, e.g. '40 rpm'."
_PROFILE = "Use a temperature that varies: a file of time and temperature."
_HEAT = "Compute the temperature from \\[heat] of the machine file."
_FROM = "Temperature of the cold start, with --heat.  [default: that of \\[heat]]"
_CONFIDENCE = "Probability with which the profile must work, 0.5 to 0.999."
_OUT = "Write the profile for a motor controller."
#: Unit in which a limit is printed, and how many make one in SI.
_UNITS = {
    "speed": ("mm/s", 1e3),
    "acceleration": ("mm/s²", 1e3),
    "grip": ("N", 1.0),
    "motor torque": ("N·m", 1.0),
}


@dataclass(frozen=True)
class _Film:
    """The temperature of the film: constant, varying, or computed from its heating."""

    at: Annotated[str, option("Film temperature, e.g. '150 degC'.")] = ""
    temperature_profile: Annotated[Path | None, option(_PROFILE, metavar="FILE")] = None
    heat: Annotated[bool, option(_HEAT, "--heat")] = False
    start: Annotated[str, option(_FROM, "--from")] = ""

    def refuse_two(self) -> None:
        """Refuse more than one of them."""
        if sum((bool(self.at), self.temperature_profile is not None, self.heat)) > 1:
            raise ParameterError(
                "--at, --temperature-profile and --heat exclude each other: give one of them"
            )
        if self.start and not self.heat:
            raise ParameterError("--from needs --heat")

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
    """With what probability a profile must work, and the seed of the draws that test it."""

    confidence: Annotated[float, option(_CONFIDENCE)] = 0.95
    seed: Annotated[int, option("Random seed.", min=0)] = 1


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
    out: Annotated[Path | None, option(_OUT, metavar="CSV")] = None,
    figure: Annotated[Path | None, drawn("profile and motion")] = None,
    reading: Reading,
    printing: Printing,
    force: Force = False,
) -> None:
    """Find the quickest start-up profile that ends in steady sliding.

    Example: [bold]hersey plan examples/machine.toml examples/bench.csv --tare standing --target "60 mm/s"
    --at "150 degC" --out profile.csv --figure plan.png[/bold]

    The exit code is 1 if no profile exists; then nothing is written.
    """
    inputs = reading.inputs(machine_file, logs, fit_file, film.temperature_profile, trace)
    outputs = may_write_table_and_figure(out, figure, force, inputs)
    film.refuse_two()

    from hersey.machine.machine import read_machine
    from hersey.motion.schedule import Schedule

    machine = read_machine(machine_file)
    wanted = target_of(target, machine)
    temperature = film.temperature(machine, machine_file, reading.max_memory)
    surface, drawn_of_log = reading.surface_and_posterior(
        logs, fit_file, machine, trace, machine_file=machine_file, seed=proof.seed
    )
    if temperature is not None and not isinstance(temperature, Schedule):
        given = start_of(machine_file, film.start) if film.heat else "--at"
        refuse_below_zero(surface, temperature, given, fit_file)
    if drawn_of_log is None:
        planned = _of_a_fit(surface, machine, wanted, temperature, proof)
    else:
        planned = _of_draws(drawn_of_log, surface, wanted, temperature, proof)
    course = temperature if isinstance(temperature, Schedule) else planned.course if film.heat else None
    if course is not None:
        beyond = beyond_the_log(surface, course.values)
    else:
        beyond = beyond_the_log(surface, temperature) if isinstance(temperature, float) else []
    planned = replace(planned, warnings=(*planned.warnings, *beyond))
    write_course(planned, outputs, printing, lambda: _lines(planned, machine.part), temperature=course)


def _lines(planned: Plan, part: Noun) -> list[str]:
    """The profile in words and as a table, and how much of each limit it uses."""
    from hersey.cli.figures import columns, four, labelled, three

    if not planned.found:
        return [
            "No profile ends in steady sliding.",
            *(f"- {each.text}" for each in planned.obstacles),
        ]
    lines = [_verdict(planned, part)]
    rows = [(four(time), four(1e3 * speed)) for time, speed in planned.rows()]
    lines += [planned.proof(), "", *columns(("time (s)", "drive speed (mm/s)"), rows, first=">"), ""]
    uses = []
    for use in planned.uses:
        name = use.name.replace("_", " ")
        unit, factor = _UNITS.get(name, ("", 1.0))
        share = f"{100 * use.used / use.limit:.0f} %"
        uses.append((name, f"{three(factor * use.used)} of {three(factor * use.limit, unit)} ({share})"))
    if uses:
        lines += ["Largest share of each limit", *labelled(uses)]
    else:
        lines.append("The machine file states no limit of speed, acceleration or torque ([limits]).")
    return lines if planned.course is None else [*lines, _temperatures(planned.course, planned)]


def _verdict(planned: Plan, part: Noun) -> str:
    """The profile in a sentence, and when the part slides steadily."""
    from hersey.cli.figures import three

    def taking(time: float) -> str:
        return f"in {three(time, 's')}" if time > 0 else "at once"

    target, peak = (three(1e3 * speed, "mm/s") for speed in (planned.target_speed, planned.peak_speed))
    if planned.kind == "direct":
        way = f"Speed up to {target} {taking(planned.rise)}."
    else:
        held = f"hold {three(planned.hold, 's')}, " if planned.hold > 0 else ""
        way = (
            f"Speed up to {peak} {taking(planned.rise)}, {held}slow down to {target} {taking(planned.fall)}."
        )
    wait = f"Wait {three(planned.wait, 's')}. " if planned.wait > 0 else ""
    return f"{wait}{way} The {part} slides steadily from {three(planned.duration, 's')} on."


def _temperatures(course: Schedule, planned: Plan) -> str:
    """The film temperature at first, at the start and at the end."""
    from hersey.units import celsius

    at = [f"{celsius(course.at(time)):.0f} °C" for time in (0.0, planned.wait, planned.duration)]
    return f"Film temperature: {at[0]} at first, {at[1]} at the start, {at[2]} once it slides steadily."


def _of_a_fit(
    surface: DampingSurface, machine: Machine, target: float, temperature: Temperature, proof: _Proof
) -> Plan:
    """The plan of a saved fit, which holds a single model."""
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
    """The plan that works for the draws of the posterior."""
    from hersey.decision.start_up import plan_start_up
    from hersey.decision.warming import plan_warm_start
    from hersey.stability.plan import check_temperature

    if temperature is None or isinstance(temperature, float):
        check_temperature(surface, temperature)
        with working("planning"):
            return plan_start_up(draws, temperature, target, confidence=proof.confidence)
    with bar("planning", unit="profiles") as progress:
        return plan_warm_start(draws, target, temperature=temperature, progress=progress, **vars(proof))
