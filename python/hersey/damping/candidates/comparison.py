"""Every candidate fitted to the same dwells, one chosen, and the reasons in words.

Of the candidates within `EVIDENCE` AICc of the likeliest the simplest is chosen, as for a second branch of
the surface: a larger law must be beyond doubt. With some thirty laws in competition, the best of those that
are too large beats the right one by 2 AICc in one log of ten. Among those so near, one whose parameters the
data all determine goes before one with a parameter that they do not; where none is near, the law stays, and
says which parameter is open.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hersey.cache.kept import kept
from hersey.damping.candidates.branched import Law
from hersey.damping.candidates.candidate import Candidate, all_candidates, contact_candidates
from hersey.damping.candidates.collapse import HerseyCollapse, temperature_collapse
from hersey.damping.candidates.energy import ActivationEnergies, activation_energies, usable_for_transition
from hersey.damping.candidates.errors_in_variables import orthogonal_fit
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.identifiability import not_identified
from hersey.damping.candidates.intervals import bootstrap_draws, estimates
from hersey.damping.candidates.lack_of_fit import lack_of_fit
from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.damping.candidates.model_comparison import CandidateFit, ModelComparison
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.refits import left_out
from hersey.damping.candidates.shared_errors import shared_variance
from hersey.damping.candidates.shared_load import SharedLoad
from hersey.damping.candidates.thermal import ARRHENIUS
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.reduced import require_points
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import takes_si

#: AICc by which candidates differ at most when the data do not tell them apart.
TIED = 2.0


@takes_si()
@kept(apart=("progress",))
def compare_models(
    points: SteadyPoints | Observations,
    *,
    candidates: tuple[Candidate, ...] | None = None,
    contact: SharedLoad | None = None,
    bootstrap: int = 300,
    seed: int = 1,
    cross_validate: bool = True,
    progress: Callable[[int, int], None] | None = None,
) -> ModelComparison:
    """Fit every model to the same dwells and choose one.

    Parameters
    ----------
    points
        From `TorqueLog.steady`.
    candidates
        Models to fit; default: all.
    contact
        Film and asperities of the machine (`hersey.MixedContact`), whose laws are candidates then.
    bootstrap
        Number of resampled fits of the chosen model; 0 omits that interval.
    seed
        Random seed of the resampling.
    cross_validate
        Whether to predict dwells from the others.
    progress
        Called with candidates done and candidates in all.

    Raises
    ------
    InsufficientDataError
        If no candidate can be fitted: fewer than three speeds, or too few dwells.

    Examples
    --------
    >>> import hersey
    >>> points = hersey.read("examples/bench.csv").steady(tare="standing")
    >>> rest = hersey.NoLoadTorque.stated(constant="180 mN*m", per_speed="1 mN*m*s/rad")
    >>> found = compare_models(points.without(rest), bootstrap=0, cross_validate=False)
    >>> found.chosen.candidate.branches
    'two branches, one Hersey number'
    """
    if bootstrap < 0 or seed < 0:
        name, value = ("bootstrap", bootstrap) if bootstrap < 0 else ("seed", seed)
        raise ParameterError(f"{name} is {value}: it must be at least 0")
    if not isinstance(points, Observations):
        require_points(points, "hersey.compare_models({points})")
    data = points if isinstance(points, Observations) else Observations.of(points)
    candidates = candidates or all_candidates()
    candidates += () if contact is None else contact_candidates(contact)
    candidates = tuple(replace(each, quantity=data.domain.quantity) for each in candidates)
    refused = [(candidate.name, why) for candidate in candidates if (why := candidate.refused(data))]
    carried = [candidate for candidate in candidates if not candidate.refused(data)]
    if not carried:
        raise InsufficientDataError(f"no model can be fitted. {refused[0][0]}: {refused[0][1]}")
    by_aicc = ranked(_fitted(carried, data, progress), data, cross_validate)
    chosen = choose(by_aicc)
    draws = bootstrap_draws(chosen.fit, data, bootstrap, seed) if bootstrap else np.empty(0)
    return ModelComparison(
        candidates=by_aicc,
        refused=tuple(refused),
        chosen=chosen,
        reasons=_reasons(by_aicc, chosen, data),
        parameters=estimates(chosen.fit, data, draws=draws if draws.size else None),
        energies=_energies(by_aicc, chosen, data),
        collapse=_collapse(data, chosen.fit),
        orthogonal=orthogonal_fit(chosen.fit, data),
        data=data,
        bootstrap=bootstrap if draws.size else 0,
        seed=seed,
    )


def _fitted(
    candidates: list[Candidate], data: Observations, progress: Callable[[int, int], None] | None
) -> list[tuple[Candidate, LawFit]]:
    fits = []
    for done, candidate in enumerate(candidates):
        if progress:
            progress(done, len(candidates))
        fits.append((candidate, fit_law(candidate.law(data), data)))
    return fits


def choose(candidates: tuple[CandidateFit, ...]) -> CandidateFit:
    """Return the simplest candidate that the likeliest does not beat beyond doubt, determined ones first."""
    least = min(r.fit.aicc for r in candidates)
    near = [r for r in candidates if r.fit.aicc <= least + EVIDENCE]
    return min(near, key=lambda r: (bool(r.not_identified), r.fit.parameters, r.fit.aicc))


def ranked(
    fits: list[tuple[Candidate, LawFit]], data: Observations, cross_validate: bool
) -> tuple[CandidateFit, ...]:
    """Return fits by AICc, with what is not determined and the errors of excluded dwells."""
    least_aicc, least_bic = min(f.aicc for _, f in fits), min(f.bic for _, f in fits)
    weights = np.array([np.exp(-0.5 * (f.aicc - least_aicc)) for _, f in fits])
    weights /= weights.sum()
    out = []
    for (candidate, fit), weight in zip(fits, weights.tolist(), strict=True):
        missed = left_out(fit, data) if cross_validate else None
        if missed is not None and not np.all(np.isfinite(missed)):
            missed = None
        out.append(
            CandidateFit(
                candidate,
                fit,
                not_identified(fit, data),
                fit.aicc - least_aicc,
                fit.bic - least_bic,
                weight,
                None if missed is None else float(np.sqrt(np.mean(missed**2))),
                missed,
                lack_of_fit(fit, data),
            )
        )
    return tuple(sorted(out, key=lambda r: r.delta_aicc))


def _reasons(ranked: tuple[CandidateFit, ...], chosen: CandidateFit, data: Observations) -> tuple[str, ...]:
    """Return why this candidate, and what may be said for the others."""
    numbers = chosen.fit.parameters
    said = [
        f"Chosen: {chosen.candidate.name}, with {numbers} parameters fitted to {len(data)} dwells.",
        *(f"Parameter {name} cannot be determined: {why}." for name, why in chosen.not_identified.items()),
        *(f"The model is rejected: {miss}." for miss in chosen.lack_of_fit.misses()),
    ]
    for other in ranked:
        if other.delta_aicc >= chosen.delta_aicc or other is chosen:
            continue
        better = chosen.delta_aicc - other.delta_aicc
        if other.not_identified:
            reason = next(iter(other.not_identified.values()))
            said.append(
                f"{other.candidate.name} fits better (AICc lower by {better:.1f}), but one of its parameters "
                f"cannot be determined: {reason}."
            )
        else:
            more = other.fit.parameters - chosen.fit.parameters
            price = f"{more} more parameter{'s' if more > 1 else ''}"
            doubt = "this difference is not significant" if better < TIED else f"{EVIDENCE:g} is needed"
            said.append(
                f"{other.candidate.name}, with {price}, fits better (AICc lower by {better:.1f}), "
                f"but {doubt}."
            )
    worse = [r for r in ranked if r.delta_aicc > chosen.delta_aicc and not r.not_identified]
    if worse:
        next_best = worse[0]
        gap = next_best.delta_aicc - chosen.delta_aicc
        tie = ", not significant" if gap < TIED else ""
        said.append(f"Next best is {next_best.candidate.name} (AICc higher by {gap:.1f}{tie}).")
    best = min(ranked, key=lambda r: r.fit.bic)
    said.append(
        "BIC selects the same model."
        if best is chosen
        else f"BIC selects {best.candidate.name} (BIC lower by {chosen.delta_bic:.1f})."
    )
    return (*said, *_by_cross_validation(ranked, chosen, data))


def _by_cross_validation(
    ranked: tuple[CandidateFit, ...], chosen: CandidateFit, data: Observations
) -> tuple[str, ...]:
    tried = [r for r in ranked if r.cross_validation is not None]
    if chosen.left_out is None or not tried:
        return ()
    best = min(tried, key=lambda r: float(r.cross_validation or 0.0))
    what = f"excluding one {data.clustered_by} at a time"
    error = f"the chosen model predicts the excluded dwells with an rms error of {_per_cent(chosen)}"
    if best is chosen or best.left_out is None:
        return (f"Cross-validation, {what}: {error}, the best of all models.",)
    gain = chosen.left_out**2 - best.left_out**2
    chance = float(np.std(gain, ddof=1) * np.sqrt(gain.size))
    apart = "beyond chance" if float(np.sum(gain)) > 2 * chance else "within chance"
    other = f"{best.candidate.name} with {_per_cent(best)}, a difference {apart}"
    return (f"Cross-validation, {what}: {error}; {other}.",)


def _per_cent(candidate: CandidateFit) -> str:
    return f"{100.0 * (candidate.cross_validation or 0.0):.2f} %"


def _energies(
    ranked: tuple[CandidateFit, ...], chosen: CandidateFit, data: Observations
) -> ActivationEnergies:
    arrhenius = [
        r
        for r in ranked
        if r.candidate.thermal == ARRHENIUS
        and isinstance(r.fit.law, Law)  # others have no energy of all the torque
        and not r.candidate.stribeck
        and not r.candidate.per_temperature
    ]
    sound = [r for r in arrhenius if not r.not_identified] or arrhenius
    free = next((r.fit for r in sound if usable_for_transition(r.fit) and not r.not_identified), None)
    best = sound[0] if sound else None
    if not chosen.fit.law.broken or (best is not None and not best.fit.law.broken):
        free = None  # a law of temperature that misses bends where no transition is
    return activation_energies(None if best is None else best.fit, free, chosen.fit, data)


def _collapse(data: Observations, fit: LawFit) -> HerseyCollapse | None:
    try:
        return temperature_collapse(data, shared_variance(fit.shared) ** 0.5)
    except InsufficientDataError:
        return None
