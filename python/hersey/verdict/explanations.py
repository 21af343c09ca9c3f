"""Everything that explains how torque varies with speed, and the one regime that may be named.

A film of one regime, alone or beside a constant torque (the no-load torque, or Coulomb friction), a
Stribeck curve, and what bends a film's exponent. An explanation is listed if the data do not exclude it: its
law holds (`lack_of_fit`) and no other is likelier by `EVIDENCE` AICc. A regime is named only if it is the
sole film listed and one exponent holds over all the speeds.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated, NamedTuple

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.candidate import LEAST_FREEDOM
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.lack_of_fit import LackOfFit, lack_of_fit
from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, VFT, Thermal
from hersey.damping.distributions import student_above
from hersey.damping.dwells import SteadyPoints
from hersey.damping.estimate import CONFIDENCE
from hersey.damping.rising import Rising, rising
from hersey.damping.surface import DampingSurface
from hersey.result import OPEN, Means, Record
from hersey.verdict.regimes import COULOMB, FALLING, Hypothesis

#: Share of the torque from which a constant part, or the film beside it, counts.
LEAST_SHARE = 0.02
#: Half width of the interval of c within which level torque is distinguished from falling torque.
LEVEL = 0.05
#: By how much the exponent of the film's formula may be off.
FORMULA = 0.01
# Keys of the explanations; ``CONSTANT`` stands behind the name of a film.
CONSTANT = " + constant torque"
COULOMB_VISCOUS = "Coulomb + viscous"
STRIBECK = "Stribeck curve"
THINNING = "shear thinning"
HEATING = "shear heating"
OTHER = "other curvature"
#: A logarithm beyond this is that of nothing, or of no bound.
_ANYTHING = 1e3
UNTRIED, POWER = "film" + CONSTANT, "one power of speed"
_WORDS = {
    POWER: "one power of speed",
    STRIBECK: "a Stribeck curve near its torque minimum",
    THINNING: "a shear-thinning lubricant",
    HEATING: "a film heated by its own shear",
    OTHER: "a curvature that none of the models describes",
    UNTRIED: "any film plus a constant {quantity} (too few dwells to test it)",
}


@dataclass(frozen=True)
class Explanation(Record):
    """What the data do not exclude.

    ``constant_share`` is that of a constant torque at the middle speed, None where there is none;
    ``p_value`` that of a law that holds, or of the exponent, None where no law was fitted.
    """

    key: str
    name: str
    constant_share: Annotated[
        float | None, Means("share of torque at the middle speed; null if there is none")
    ] = None
    p_value: float | None = None


@dataclass(frozen=True)
class Tried(Record):
    """A law that was fitted to the dwells of the rising branch.

    ``parameters`` are in the coordinates of the fit, ``constant_share`` as in `Explanation`; ``curvature`` is
    the p-value of the law as it bends with speed, None where too few speeds can say.
    """

    name: str
    parameters: Annotated[dict[str, float], OPEN]
    constant_share: Annotated[
        float | None, Means("share of torque at the middle speed; null if there is none")
    ]
    aicc: float
    curvature: Annotated[float | None, Means("p-value of the curvature against speed that the law leaves")]
    verdict: str = ""


@dataclass(frozen=True)
class Explained:
    """Explanations, the regime named (None if none may be), and whether one exponent holds.

    ``tried`` are the laws behind them, the likeliest first.
    """

    named: str | None
    explanations: tuple[Explanation, ...]
    lack_of_fit: LackOfFit | None  #: None where too few dwells can say
    why_unnamed: str
    tried: tuple[Tried, ...] = ()


#: What a law is called, its fit, whether it is listed, and the p-value of its bend.
_Fitted = tuple[Explanation, LawFit, bool, float | None]


class FilmLaw(NamedTuple):
    """The torque (N m) that theory gives a film at speeds (rad/s) and temperatures (K), and its regime."""

    regime: str
    torque: Callable[[FloatArray, FloatArray | None], FloatArray]


def explained(
    points: SteadyPoints,
    surface: DampingSurface,
    hypotheses: tuple[Hypothesis, ...],
    law: FilmLaw | None = None,
) -> Explained:
    """Return what explains the dwells above the transition, or all where there is none.

    Parameters
    ----------
    points, surface
        Of a log, and the surface fitted to it.
    hypotheses
        From `regimes.judged`, for the surface's exponent.
    law
        Of the film of this contact, if it is known: its exponent varies from dwell to dwell.
    """
    films = [h for h in hypotheses if h.consistent]
    branch = rising(points, surface)
    if branch.fit is None or branch.lack_of_fit is None:
        return Explained(None, _alone(films), None, branch.why_not)
    lack, bent = branch.lack_of_fit, branch.bent
    single = () if bent else _alone(films)
    own = None if law is None else _own_film(branch, surface, law, len(hypotheses))
    if own is not None and own[0].key not in {e.key for e in single}:
        single = (*single, own[0])
    beside, fitted = _beside_constant(
        branch, hypotheses, {e.key for e in single}, None if own is None else own[1]
    )
    too_few = len(branch.data) < len(branch.fit.law.names) + 1 + LEAST_FREEDOM
    listed = [*single, *beside]
    if not bent and surface.c.low > -1.0 and surface.c.high < -LEVEL:
        # a power-law fluid between walls: neither speed nor temperature can tell it from a film
        n = 1.0 + surface.c.value
        words = f"{_WORDS[THINNING]} (shear rate^{n:.2f}) in a film of fixed thickness"
        listed.append(Explanation(THINNING, words))
    if too_few and not beside:
        listed.append(Explanation(UNTRIED, _WORDS[UNTRIED].format(quantity=points.domain.quantity)))
    if (bent and own is None and lack.drift <= 0) or not listed:
        listed += _bending(lack, bent, surface)
    named = None if bent else _sole(films, surface)
    why = "; ".join(lack.misses()) if bent else ""
    if named and beside:
        named, why = None, f"{beside[0].name} fits as well"
    if named and too_few:
        named, why = (
            None,
            f"there are too few dwells to test the film plus a constant {points.domain.quantity}",
        )
    power = Explanation(POWER, _WORDS[POWER])
    fitted += [(power, branch.fit, not bent, lack.curvature)]
    fitted += [] if own is None else [(*own, own[0].key in {e.key for e in listed}, own[0].p_value)]
    return Explained(named, tuple(listed), lack, why, _laws_tried(fitted))


def _laws_tried(fitted: list[_Fitted]) -> tuple[Tried, ...]:
    """The laws fitted, the likeliest first, each with what became of it."""
    least = min(fit.aicc for _, fit, _, _ in fitted)
    out = []
    for said, fit, kept, p in sorted(fitted, key=lambda each: each[1].aicc):
        away = fit.aicc - least
        if kept:
            verdict = "not excluded"
        elif p is not None and p < 1.0 - CONFIDENCE:
            verdict = f"rejected, as its curvature against speed differs (p = {p:.1g})"
        elif away > EVIDENCE:
            verdict = "less likely"
        else:
            verdict = "no better than the film alone"
        known = [value if abs(value) < _ANYTHING else math.nan for value in fit.values.tolist()]
        values = dict(zip(fit.law.names, known, strict=True))
        out.append(Tried(said.name, values, said.constant_share, fit.aicc, p, verdict))
    return tuple(out)


def _alone(films: list[Hypothesis]) -> tuple[Explanation, ...]:
    return tuple(Explanation(h.name, h.name, None, h.p_value) for h in films)


def _sole(films: list[Hypothesis], surface: DampingSurface) -> str | None:
    """The one regime that the exponent leaves; level torque outranks the falling branch that begins there."""
    names = [h.name for h in films]
    if names == [COULOMB, FALLING]:
        narrow = surface.c.high - surface.c.low < 2 * LEVEL
        return COULOMB if narrow else None
    return names[0] if len(names) == 1 else None


def _beside_constant(
    branch: Rising, hypotheses: tuple[Hypothesis, ...], alone: set[str], own: LawFit | None
) -> tuple[list[Explanation], list[_Fitted]]:
    """Films beside a constant torque, and a Stribeck curve, that no other law excludes; and all fitted."""
    assert branch.fit is not None
    data, bent = branch.data, branch.bent
    thermal = _thermal_of_film(data, branch.thermal)
    least = [fit.aicc for fit in (None if bent else branch.fit, own) if fit is not None]
    tried: list[tuple[Explanation, LawFit]] = []
    refused: list[_Fitted] = []
    for row in hypotheses:
        if row.name in (COULOMB, FALLING) or (row.name in alone and not bent):
            continue
        found = [
            fit
            for exponent in _tried(row)
            for varying in ((False, True) if thermal else (False,))
            if (fit := _fitted(ConstantPlusLaw(thermal, exponent, varying), data)) is not None
        ]
        judged = [(fit, lack_of_fit(fit, data)) for fit in found]
        held = [(fit, lack) for fit, lack in judged if not lack.in_speed]
        if held:
            fit, lack = min(held, key=lambda f: f[0].aicc)
            tried.append((_with_constant(row.name, fit, lack, data), fit))
        elif judged:
            fit, lack = min(judged, key=lambda f: f[0].aicc)
            refused.append((_with_constant(row.name, fit, lack, data), fit, False, lack.curvature))
    curve = _stribeck(data, thermal)
    if curve is not None and curve.aicc < min([*least, np.inf]):
        lack = lack_of_fit(curve, data)
        if not lack.in_speed:
            tried.append((Explanation(STRIBECK, _WORDS[STRIBECK], None, lack.curvature), curve))
    worst = min([*least, *(fit.aicc for _, fit in tried)], default=0.0) + EVIDENCE
    near = sorted(((e, fit) for e, fit in tried if fit.aicc <= worst), key=lambda tie: tie[1].aicc)
    kept = [
        e for e, _ in near if e.constant_share is None or LEAST_SHARE <= e.constant_share <= 1.0 - LEAST_SHARE
    ]
    return kept, refused + [(e, fit, e in kept, e.p_value) for e, fit in tried]


def _own_film(
    branch: Rising, surface: DampingSurface, law: FilmLaw, tests: int
) -> tuple[Explanation, LawFit] | None:
    """The film of this contact alone, with the exponent of each dwell, unless the data exclude it.

    What the film's law has beyond the best power law is subtracted from the dwells: if the film made them one
    exponent holds for the rest, and it is that of the best power law.
    """
    assert branch.fit is not None
    data, power = branch.data, branch.fit.law
    # of damping: torque over speed
    expected = np.log(law.torque(data.speed, data.inputs.kelvin)) - data.inputs.log_speed
    design = power.jacobian(branch.fit.values, data.inputs)
    best, *_ = np.linalg.lstsq(design, expected, rcond=None)
    straight = replace(data, log_torque=data.log_torque - (expected - design @ best))
    fit = fit_law(power, straight)
    lack = lack_of_fit(fit, straight)
    c = fit.estimate("c")
    away = max(abs(c.value - best[power.names.index("c")]) - surface.c.systematic - FORMULA, 0.0)
    p = min(1.0, tests * 2.0 * float(student_above(away / max(c.error, 1e-12), max(c.freedom, 1))))
    if p <= 1.0 - CONFIDENCE or lack.bent_by(2.0 * surface.c.systematic):
        return None
    return Explanation(law.regime, f"{law.regime} as predicted for this contact", None, p), fit


def _tried(row: Hypothesis) -> list[float]:
    """Exponents that stand for a band: its ends, and its middle where it is wide."""
    middle = {0.5 * (row.low + row.high)} if row.high - row.low > LEVEL else set()
    return sorted({row.low, row.high} | middle)


def _stribeck(data: Observations, thermal: Thermal | None) -> LawFit | None:
    """The likeliest Stribeck curve, its viscosity by any law of temperature of one parameter."""
    laws = [StribeckLaw(None)]
    if thermal is not None:
        kinds = sorted({thermal.kind, ARRHENIUS} - {VFT})
        laws = [StribeckLaw(Thermal(kind, thermal.reference)) for kind in kinds]
    fits = [fit for law in laws if (fit := _fitted(law, data)) is not None]
    return min(fits, key=lambda fit: fit.aicc, default=None)


def _thermal_of_film(data: Observations, thermal: Thermal | None) -> Thermal | None:
    """The likeliest law of temperature of a film beside a constant torque, which has none."""
    if thermal is None:
        return None
    kinds = (thermal.kind, ARRHENIUS, *((VFT,) if data.temperatures.size > 2 else ()))
    tried = [(kind, _fitted(ConstantPlusLaw(Thermal(kind, thermal.reference)), data)) for kind in kinds]
    fitted = [(fit.aicc, kind) for kind, fit in tried if fit is not None]
    return Thermal(min(fitted)[1], thermal.reference) if fitted else thermal


def _fitted(law: ConstantPlusLaw | StribeckLaw, data: Observations) -> LawFit | None:
    if len(data) < len(law.names) + LEAST_FREEDOM:
        return None
    return fit_law(law, data)


def _with_constant(regime: str, fit: LawFit, lack: LackOfFit, data: Observations) -> Explanation:
    assert isinstance(fit.law, ConstantPlusLaw)
    film: FloatArray = fit.law.film_share(fit.values, data.inputs)
    share = float(1.0 - np.median(film))
    torque, beside = "torque", "no-load torque or "
    if not data.domain.is_torque:
        torque, beside = data.domain.quantity, ""
    if regime == "constant film":
        words = (
            f"a constant {torque}, e.g. Coulomb friction, {100 * share:.0f} % of the total, plus a viscous "
            f"{torque}"
        )
        return Explanation(COULOMB_VISCOUS, words, share, lack.curvature)
    words = f"{regime} plus a constant {torque} ({beside}Coulomb friction), {100 * share:.0f} % of the total"
    return Explanation(regime + CONSTANT, words, share, lack.curvature)


def _bending(lack: LackOfFit, bent: bool, surface: DampingSurface) -> list[Explanation]:
    """What bends an exponent so: down with speed by thinning or heat, as nothing tried the other way."""
    falls = lack.drift <= 0 if bent else surface.c.value > -1.0
    keys = (THINNING, HEATING, OTHER) if falls else (OTHER,)
    return [Explanation(key, _WORDS[key]) for key in keys]
