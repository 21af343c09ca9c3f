"""The study of a log and its machine: fit, regime, nip, torque budget, behaviour and decision."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.arguments.door import Words
from hersey.damping.compare import LogComparison, compare
from hersey.damping.curves import CurveMixture, fit_curves
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.reduced import require_film, require_points
from hersey.damping.fit import fit
from hersey.damping.friction_curve.words import verdict_of
from hersey.decision.behaviour import Step, Working
from hersey.errors import HerseyError, ParameterError
from hersey.log import TorqueLog
from hersey.machine.machine import Machine, read_machine
from hersey.result import Result, json_record
from hersey.schema.warning import Warning
from hersey.study.findings import Findings
from hersey.study.first_screen.decision import decision
from hersey.study.first_screen.reasons import in_words
from hersey.study.first_screen.result import DecisionPart
from hersey.study.nip import film_part
from hersey.study.simulation import simulation
from hersey.study.torque_budget import torque_budget
from hersey.units import takes_si
from hersey.verdict.friction import excludes_power_law, leading_friction
from hersey.verdict.regime import regime
from hersey.verdict.warnings import warnings_of

if TYPE_CHECKING:
    import polars as pl


@dataclass(frozen=True, repr=False, kw_only=True)
class Study(Findings, Result):
    """What a log and its machine tell together: what was found (`Findings`), and what to do.

    ``curves`` are the drag curves of all laws by weight.
    """

    curves: CurveMixture

    @cached_property
    def decision(self) -> DecisionPart:
        """What to do, why, and what stands against it."""
        return decision(self)

    @cached_property
    def warnings(self) -> tuple[Warning, ...]:
        """What is doubtful of the machine, of dwells and fit."""
        file = "machine" if self.machine_file is None else self.machine_file.name
        of_machine = () if self.machine is None else self.machine.warnings
        of_log = warnings_of(self.points, self.surface, self.friction)
        return (*(each.within(file) for each in of_machine), *of_log)

    @property
    def verdict(self) -> list[str]:
        """What log and nip say of the regime, in paragraphs; a contradiction first.

        Where a friction curve excludes the power law, that is the verdict.
        """
        own = [self.nip.verdict] if self.nip is not None and self.nip.verdict else []
        if self.friction is None:
            return [*own, self.regime.verdict]
        excluded = excludes_power_law(self.friction, self.surface)
        return [*own, verdict_of(self.friction), *([] if excluded else [self.regime.verdict])]

    def summary(self) -> str:
        """Return decision, comparison, verdict, warnings and fit, as text."""
        decision = self.decision
        said = (decision.instruction, decision.interval, decision.otherwise)
        lines = [*filter(None, (" ".join(filter(None, said)), decision.next))]
        lines += [f"{point.name}: {point.words}" for point in decision.points]
        if self.comparison is not None:
            lines.append(f"Compared with {self.comparison.names[0]}: {self.comparison.verdict}")
        lines += [*self.verdict, *(f"- {warning.sentence}" for warning in self.warnings)]
        return "\n".join([*lines, self.surface.summary()])

    def to_dict(self) -> dict[str, Any]:
        """Return decision, verdict, warnings, fit, regime, nip and torque budget, in SI."""
        plain = "verdict warnings regime friction comparison decision nip torque_budget"
        return json_record({"fit": self.surface} | {name: getattr(self, name) for name in plain.split()})

    def to_frame(self) -> pl.DataFrame:
        """Return the dwells."""
        return self.points.to_frame()

    def chart(self) -> Any:
        """Return the chart of torque against speed."""
        return self.surface.chart()


@takes_si(temperature_scale=Words(("degC", "K")))
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
    """Fit the dwells of a log, judge the regime, and predict the behaviour of the machine.

    Parameters
    ----------
    machine
        The machine, or its file.
    against
        Dwells of an earlier log (A) to compare with this one (B), as by `hersey.compare`.
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
        If a file is in both logs, the machine file is wrong, a log is given in the place of its points, or
        the machine states a no-load torque that was not subtracted.

    Examples
    --------
    >>> from hersey import Recipe
    >>> study(Recipe(logs="examples/bench.csv", tare="standing").points()).decision.signal
    'watch'
    """
    call = "hersey.study({points})" if machine is None else "hersey.study({points}, machine)"
    require_points(points, call)
    if against is not None:
        require_points(against, "hersey.study(points, against={points})")
    if isinstance(machine, str | Path):
        machine_file, machine = Path(machine), read_machine(machine)
        call = f"machine = hersey.read_machine({str(machine_file)!r}) and {call}"
    if machine is not None:
        require_film(points, machine.rest, call)
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
        found = {} if working is None else _behaviour(working, step)
        studied = Study(
            points=points,
            surface=surface,
            curves=curves,
            regime=seen,
            friction=None if film is not None else leading_friction(points, surface, seen),
            machine=machine,
            machine_file=machine_file,
            nip=film,
            torque_budget=budget,
            comparison=comparison,
            against=against,
            **found,
        )
        _ = studied.decision  # while the threads of the machine are there
    return studied


def _behaviour(working: Working, step: Step) -> dict[str, Any]:
    """What the machine does and its simulation, or why that cannot be computed; by fields of `Findings`."""
    found: dict[str, Any] = {}
    try:
        found["behaviour"] = working.result(step)
        found["simulation"] = simulation(found["behaviour"])
    except HerseyError as error:  # a stick speed above the transition, say: the log still counts
        found["why"] = in_words(error)
    return found


def _compared(points: SteadyPoints, against: SteadyPoints) -> LogComparison:
    """What this log has against an earlier one."""
    here = {file.sha256 for file in points.log.files}
    for file in against.log.files:
        if file.sha256 in here:
            raise ParameterError(f"{file.name} is in both logs. Name another log to compare with")
    names = against.log.title, points.log.title
    if names[0] == names[1]:
        names = f"{names[0]} (earlier)", names[1]
    return compare(against, points, names=names)
