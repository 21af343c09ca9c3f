"""From log and machine to the posterior: priors, evidence, draws, convergence."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple, TypedDict, Unpack

import numpy as np

from hersey.arrays import FloatArray, refuse_unknown
from hersey.cache.kept import kept
from hersey.damping.curves import CurveMixture, fit_curves
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.reduced import require_film, require_points
from hersey.damping.fit import fit
from hersey.damping.surface import DampingSurface
from hersey.errors import ParameterError
from hersey.log import TorqueLog
from hersey.machine.machine import Machine
from hersey.posterior.drives import DriveModel, Drives
from hersey.posterior.evidence import BreakAway, Evidence, Start, StickSlip
from hersey.posterior.likelihood import log_likelihood, misfit
from hersey.posterior.priors import CLOSURES, DrivePriors
from hersey.posterior.result import Convergence, Posterior, edges_at, quantiles
from hersey.posterior.sampler import Moves, Population, sample
from hersey.posterior.traces import Found, evidence_of_log, evidence_of_trace
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Draws of a posterior, all populations together.
DRAWS = 1000
#: Draws of the prior that are weighed at first for each that is kept: cheaper than moves, and independent.
FIRST = 8
#: Populations that know nothing of each other.
CHAINS = 2
#: Misfit (a chi-square) from which evidence contradicts dwells and machine file together, and does not count:
#: of figures; of an outcome, which most draws then do not show.
CONTRADICTS, UNLIKE = 20.0, 5.0
#: Rounds in which evidence is excluded, the worst first.
_ROUNDS = 3
#: Relative standard error of a static friction that is stated without one.
_STATED_STATIC = 0.05

#: Called with the share of the work that is done.
Progress = Callable[[float], object]


class Sampling(TypedDict, total=False):
    """How a posterior is drawn, each by its name.

    Parameters
    ----------
    draws
        All populations together, at least 40; 1000 if not given.
    seed
        Of the random draws; 1 if not given.
    threads
        For the motion of the draws; the result does not depend on it.
    progress
        Called with the share of the work that is done.
    """

    draws: int
    seed: int
    threads: int
    progress: Progress | None


@takes_si(temperature="temperature")
@kept(apart=("threads", "progress"))
def posterior(
    points: SteadyPoints,
    machine: Machine,
    *,
    surface: DampingSurface | None = None,
    curves: CurveMixture | None = None,
    traces: Sequence[TorqueLog] = (),
    evidence: Sequence[Evidence] | None = None,
    temperature: float | None = None,
    **sampling: Unpack[Sampling],
) -> Posterior:
    """Return draws of drag curve, closure, stick speed, stiffness and mass, given all evidence.

    Parameters
    ----------
    points
        From `TorqueLog.steady`; no-load torque subtracted.
    machine
        What its file states, with ranges; `hersey.posterior.priors` has the defaults.
    surface, curves
        The fit of the points and their drag curves (`hersey.damping.curves.fit_curves`), if there are any
        already.
    traces
        Recordings of the machine, from `hersey.read`, that show starts from rest or stick-slip.
    evidence
        Starts, stick-slip and break-away; by default those found in the log of the points and in ``traces``.
    temperature
        K, of the headline; by default that of the operating points, or the hottest measured.
    **sampling
        Any of ``draws``, ``seed``, ``threads`` and ``progress``; see `Sampling`.

    Raises
    ------
    ParameterError
        If draws or seed are out of range, evidence lacks the temperature that the fit needs, or the machine
        states a no-load torque that was not subtracted.

    Examples
    --------
    >>> import hersey
    >>> machine = hersey.read_machine("examples/machine.toml")
    >>> points = hersey.read("examples/bench.csv").steady(tare="standing").without(machine.rest)
    >>> found = hersey.posterior(points, machine, draws=400)
    >>> max(found.closures(), key=found.closures().get)
    'retained'
    """
    require_points(points, "hersey.posterior({points}, machine)")
    require_film(points, machine.rest, "hersey.posterior({points}, machine)")
    if surface is not None:
        surface.refuse_whole_torque(machine.rest)
    refuse_unknown("posterior", sampling, tuple(Sampling.__annotations__))
    draws, seed, threads = sampling.get("draws", DRAWS), sampling.get("seed", 1), sampling.get("threads", 1)
    if draws < 20 * CHAINS or seed < 0:
        name, value, least = ("draws", draws, 20 * CHAINS) if draws < 20 * CHAINS else ("seed", seed, 0)
        raise ParameterError(f"{name} is {value}: it must be at least {least}")
    found = surface or fit(points)
    curves = curves or fit_curves(points, found, machine.mixed)
    seen = _given(evidence, found) if evidence is not None else _seen(points, curves, found, machine, traces)
    kelvin = temperature if temperature is not None else decision_temperature(found, machine)
    headline = kelvin if found.b is not None else None
    agreed = _agreeing(curves, found, machine, (*seen.evidence, *_stated(machine, found)), sampling)
    edges = edges_at(agreed.model, agreed.drives, headline, threads=threads)
    drawn = Posterior(
        model=agreed.model,
        drives=agreed.drives,
        temperature=headline,
        laws=agreed.model.curves.table,
        evidence=agreed.evidence,
        warnings=(*seen.warnings, *agreed.contradicting),
        convergence=_convergence(agreed.populations, edges.fold),
        seed=seed,
        chains=CHAINS,
    )
    drawn.keep(headline, edges)
    return drawn


class _Agreed(NamedTuple):
    """Draws and the evidence that agrees with them, and which does not."""

    model: DriveModel
    populations: list[Population]
    drives: Drives
    evidence: tuple[Evidence, ...]
    contradicting: tuple[Warning, ...]


def _agreeing(
    curves: CurveMixture,
    surface: DampingSurface,
    machine: Machine,
    evidence: tuple[Evidence, ...],
    sampling: Sampling,
) -> _Agreed:
    """Draw, leave out the evidence that contradicts the rest, and draw again."""
    counted: tuple[Evidence, ...] = evidence
    contradicting: tuple[Warning, ...] = ()
    for left in range(_ROUNDS, -1, -1):
        priors = DrivePriors.of(machine, break_away_known=any(map(_tells_break_away, counted)))
        model = DriveModel(curves, surface, machine, priors)
        populations = _populations(model, counted, sampling)
        drives = _joined([p.drives for p in populations])
        off = np.array([misfit(model, drives, e) / _most_misfit(e) for e in counted])
        # what is half as wrong as the worst may be so because of the worst
        wrong = (off > 1.0) & (off >= (0.5 * off.max() if left > 1 else 0.0)) if off.size else off > 1.0
        if not wrong.any():
            break
        contradicting += tuple(
            _contradicting(e) for e, is_wrong in zip(counted, wrong, strict=True) if is_wrong
        )
        counted = tuple(e for e, is_wrong in zip(counted, wrong, strict=True) if not is_wrong)
    return _Agreed(model, populations, drives, counted, contradicting)


def _populations(model: DriveModel, evidence: Sequence[Evidence], sampling: Sampling) -> list[Population]:
    """The chains, each of as many draws."""
    draws, seed, threads = sampling.get("draws", DRAWS), sampling.get("seed", 1), sampling.get("threads", 1)
    said = [_part(sampling.get("progress"), chain) for chain in range(CHAINS)]
    return [
        _population(model, evidence, draws // CHAINS, seed, chain, said[chain], threads)
        for chain in range(CHAINS)
    ]


def decision_temperature(surface: DampingSurface, machine: Machine) -> float | None:
    """Return the temperature (K) of the decision: the hottest of the operating points, or of the log."""
    if surface.b is None or surface.temperature_range is None:
        return None
    points = [point.temperature for point in machine.points if point.temperature > surface.temperature_zero]
    return max(points) if points else surface.temperature_range[1]


def _tells_break_away(evidence: Evidence) -> bool:
    """Whether it tells the force that starts a belt."""
    return isinstance(evidence, BreakAway) or (isinstance(evidence, Start) and evidence.peak is not None)


def _most_misfit(evidence: Evidence) -> float:
    """The misfit from which evidence contradicts the rest."""
    outcome_alone = (isinstance(evidence, Start) and evidence.peak is None) or (
        isinstance(evidence, StickSlip) and evidence.figures is None
    )
    return UNLIKE if outcome_alone else CONTRADICTS


def _given(evidence: Sequence[Evidence], surface: DampingSurface) -> Found:
    """Evidence of the caller, which must have the temperature that the fit needs."""
    for each in evidence:
        surface.check_temperature(each.temperature)
    return Found(tuple(evidence))


def _contradicting(evidence: Evidence) -> Warning:
    """Why a piece of evidence does not count."""
    names = {"StickSlip": "stick-slip", "Start": "the start"}
    return Warning(
        "evidence contradicts dwells and machine",
        "{evidence} contradicts dwells and machine file",
        severity="watch",
        where=evidence.source,
        remedy="check stiffness, mass and stick speed",
        evidence=names.get(type(evidence).__name__, "the break-away force"),
    )


def _seen(
    points: SteadyPoints,
    curves: CurveMixture,
    surface: DampingSurface,
    machine: Machine,
    traces: Sequence[TorqueLog],
) -> Found:
    """Evidence of the log of the points and of the traces."""
    seen = evidence_of_log(points, curves, machine)
    for trace in traces:
        seen = seen + evidence_of_trace(trace, machine, zero=points.tare)
    kept: dict[Evidence, Evidence] = {}
    warnings = seen.warnings
    for each in seen.evidence:
        if surface.b is not None and each.temperature is None:
            words = Warning(
                "evidence without temperature",
                "it has no temperature, but the fit needs one",
                severity="watch",
                where=each.source,
            )
            warnings += (words,)
        else:  # a recording that is given twice counts once
            kept.setdefault(replace(each, source=""), each)
    return Found(tuple(kept.values()), warnings)


def _stated(machine: Machine, surface: DampingSurface) -> tuple[BreakAway, ...]:
    """The static friction that a machine file states, as evidence at the temperature of the stick speed."""
    if machine.static_friction is None or machine.contact is None:
        return ()
    force = machine.static_friction * machine.contact.load
    kelvin = machine.stick_speed_temperature or surface.reference_temperature
    at = None if surface.b is None else kelvin
    return (BreakAway(at, force, _STATED_STATIC, "[boundary] static_friction"),)


def _part(progress: Progress | None, chain: int) -> Progress | None:
    if progress is None:
        return None
    return lambda share: progress((chain + share) / CHAINS)


def _population(
    model: DriveModel,
    evidence: Sequence[Evidence],
    count: int,
    seed: int,
    chain: int,
    progress: Progress | None,
    threads: int,
) -> Population:
    random = np.random.default_rng([seed, chain])
    chances = np.array(list(CLOSURES.values()))
    many = FIRST * count
    closure = np.minimum(
        np.searchsorted(np.cumsum(chances), (np.arange(many) + 0.5) / many), chances.size - 1
    )
    start = Drives(
        random.permutation(model.curves.shares(many)),
        random.permutation(closure).astype(np.intp),
        random.standard_normal((many, model.size)),
    )

    def target(drives: Drives, least: FloatArray) -> FloatArray:
        value = model.log_weight(drives)
        if evidence:
            value = value + log_likelihood(model, drives, evidence, least - value, threads=threads)
        # a draw whose motion cannot be followed does not count
        return np.where(np.isnan(value), -np.inf, value)

    return sample(start, target, chances, model.curves.weights, random, Moves(), progress, count=count)


def _joined(parts: Sequence[Drives]) -> Drives:
    return Drives(
        np.concatenate([p.law for p in parts]),
        np.concatenate([p.closure for p in parts]),
        np.concatenate([p.latent for p in parts]),
    )


def _convergence(populations: Sequence[Population], fold: FloatArray) -> Convergence:
    """Compare the quantiles of V* (m/s, of all draws) of the populations."""
    each = np.split(fold, np.cumsum([len(p.drives) for p in populations])[:-1])
    ends = np.array([quantiles(values, (0.05, 0.5, 0.95)) for values in each])
    low, high = ends.min(axis=0), ends.max(axis=0)
    return Convergence(
        ratio=float(np.max(high / np.maximum(low, 1e-300))),
        width=float(high[-1] / max(low[0], 1e-300)),
        accepted=min(p.accepted for p in populations),
        distinct=min(p.distinct for p in populations),
        stages=max(p.stages for p in populations),
        log_evidence=tuple(p.log_evidence for p in populations),
        counted=min(p.counted for p in populations),
    )
