"""The study of a log and its machine: fit, regime, nip, torque budget, behaviour and decision."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.damping.compare import LogComparison, compare
from hersey.damping.curves import CurveMixture, fit_curves
from hersey.damping.dwells import SteadyPoints
from hersey.damping.fit import fit
from hersey.damping.surface import DampingSurface
from hersey.decision.behaviour import Behaviour, Step, Working
from hersey.errors import HerseyError, ParameterError
from hersey.log import TorqueLog
from hersey.machine.machine import Machine, read_machine
from hersey.result import Result
from hersey.study.display_units import display_units
from hersey.study.first_screen.decision import decision
from hersey.study.first_screen.reasons import in_words
from hersey.study.first_screen.result import DecisionPart
from hersey.study.nip import film_part
from hersey.study.nip_film import FilmPart
from hersey.study.simulation import SimulationPart, simulation
from hersey.study.torque_budget import TorqueBudgetPart, torque_budget
from hersey.verdict.cautions import cautions
from hersey.verdict.regime import Regime, regime

if TYPE_CHECKING:
    import polars as pl


@dataclass(frozen=True, repr=False)
class Study(Result):
    """What a log and its machine tell together.

    Attributes
    ----------
    points, surface, curves, regime
        Dwells, the fitted law, the drag curves of all laws by weight, and what the exponents alone say.
    machine, machine_file
        None without a machine, or where it was not read from a file.
    nip, torque_budget
        Film theory of the nip, and what film, contact and the rest of the drive take; None where the machine
        does not state them.
    behaviour, simulation
        What the machine does, and its typical belt below the transition; None without a machine or where
        nothing can be computed.
    comparison, against
        This log over an earlier one, and the dwells of that one; None unless asked for.
    decision
        What to do, why, and what stands against it.
    warnings
        What is doubtful of dwells and fit.
    units
        The unit in which each quantity is shown.
    """

    points: SteadyPoints
    surface: DampingSurface
    curves: CurveMixture
    regime: Regime
    machine: Machine | None
    machine_file: Path | None
    nip: FilmPart | None
    torque_budget: TorqueBudgetPart | None
    behaviour: Behaviour | None
    simulation: SimulationPart | None
    comparison: LogComparison | None
    against: SteadyPoints | None
    decision: DecisionPart
    warnings: tuple[str, ...]
    units: dict[str, str]

    @property
    def verdict(self) -> list[str]:
        """What log and nip say of the regime, in paragraphs; a contradiction first."""
        own = [self.nip.verdict] if self.nip is not None and self.nip.verdict else []
        return [*own, self.regime.verdict]

    def summary(self) -> str:
        """Return decision, comparison, verdict, warnings and fit, as text."""
        told = self.decision
        interval = f" ({told.interval})" if told.interval else ""
        lines = [f"{told.instruction}{interval}. {told.otherwise}"]
        lines += [f"{told.measurement.text}."] if told.measurement is not None else []
        lines += [f"{point.name}: {point.words}" for point in told.points]
        if self.comparison is not None:
            lines.append(f"Against {self.comparison.names[0]}: {self.comparison.verdict}")
        lines += [*self.verdict, *(f"- {warning}" for warning in self.warnings)]
        return "\n".join([*lines, self.surface.summary()])

    def to_dict(self) -> dict[str, Any]:
        """Return decision, verdict, warnings, fit, regime, nip and torque budget, in SI."""
        parts = {"decision": self.decision, "nip": self.nip, "torque_budget": self.torque_budget}
        return {
            "verdict": self.verdict,
            "warnings": list(self.warnings),
            "fit": self.surface.to_dict(),
            "regime": self.regime.to_dict(),
            "comparison": None if self.comparison is None else self.comparison.to_dict(),
            **{name: None if part is None else part.model_dump() for name, part in parts.items()},
        }

    def to_frame(self) -> pl.DataFrame:
        """Return the dwells."""
        return self.points.to_frame()

    def chart(self) -> Any:
        """Return the chart of torque against speed."""
        return self.surface.chart()


def study(
    points: SteadyPoints,
    machine: Machine | str | Path | None = None,
    *,
    against: SteadyPoints | None = None,
    traces: Sequence[TorqueLog] = (),
    temperature_scale: str = "degC",
    machine_file: Path | None = None,
    step: Step = lambda _what: None,
) -> Study:
    """Fit the dwells of a log, judge the regime, and work out what its machine does.

    Parameters
    ----------
    machine
        The machine, or its file.
    against
        Dwells of an earlier log, which this one is compared with as `hersey.compare` does (this is B).
    traces
        Recordings of the machine that show starts from rest or stick-slip: evidence of V*.
    temperature_scale
        As for `hersey.fit`.
    machine_file
        Where the machine was read, if it is not given by its file.
    step
        Called with the name of each step that takes long.

    Raises
    ------
    InsufficientDataError
        If the points cannot determine the surface, or share nothing with those of the other log.
    ParameterError
        If a file is in both logs, or the machine's file is wrong.

    Examples
    --------
    >>> from hersey import Recipe
    >>> study(Recipe(logs="examples/bench.csv", tare="standing").points()).decision.signal
    'watch'
    """
    if isinstance(machine, str | Path):
        machine_file, machine = Path(machine), read_machine(machine)
    comparison = None
    if against is not None:
        step("comparing the two logs")
        comparison = _compared(points, against)
    step("fitting the surface")
    surface = fit(points, temperature_scale=temperature_scale)
    curves = fit_curves(points, surface, None if machine is None else machine.mixed)
    working = None if machine is None else Working(points, surface, machine, traces, curves)
    with nullcontext() if working is None else working:
        step("judging the regime")
        nip = (machine.contact, machine.lubricant) if machine is not None else (None, None)
        seen = regime(points, surface, contact=nip[0], lubricant=nip[1])
        film, budget = film_part(points, surface, machine, seen), torque_budget(points, surface, machine)
        warnings = tuple(cautions(points, surface))
        found, simulated, why = None, None, ""
        try:
            if working is not None:
                found = working.result(step)
                simulated = simulation(found)
        except HerseyError as error:  # a stick speed above the transition, say: the log still counts
            why = in_words(error)
        units = display_units(points, None if found is None else found.map)
        decided = decision(
            points,
            surface,
            machine,
            seen=seen,
            film=film,
            torque_budget=budget,
            compared=comparison,
            found=found,
            why=why,
            machine_file="" if machine_file is None else machine_file.name,
            unit=units["torque"],
        )
    return Study(
        points=points,
        surface=surface,
        curves=curves,
        regime=seen,
        machine=machine,
        machine_file=machine_file,
        nip=film,
        torque_budget=budget,
        behaviour=found,
        simulation=simulated,
        comparison=comparison,
        against=against,
        decision=decided,
        warnings=warnings,
        units=units,
    )


def _compared(points: SteadyPoints, against: SteadyPoints) -> LogComparison:
    """What this log has against an earlier one."""
    here = {file.sha256 for file in points.log.files}
    for file in against.log.files:
        if file.sha256 in here:
            raise ParameterError(f"{file.name} is in both logs: name another to compare this one with")
    names = against.log.title, points.log.title
    if names[0] == names[1]:
        names = f"{names[0]} (earlier)", names[1]
    return compare(against, points, names=names)
