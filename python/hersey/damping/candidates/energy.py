"""Activation energies: of torque, of the viscosity behind it, and of the transition speed.

Torque that varies as exp(E/(R T)) at one speed has the apparent activation energy E. As torque varies as
viscosity to the power 1 + c, the viscosity's own is E/(1 + c). A transition at one Hersey number moves as
one over the viscosity, and so carries the viscosity's energy too: whether the two agree is a test.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.branched import FREE, LEAST_POWER, Law
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Observations
from hersey.damping.distributions import student_above
from hersey.damping.estimate import Estimate, estimate, quantile, rounded

#: Joules in a thermochemical calorie.
CALORIE = 4.184
#: p-value below which two energies disagree.
_DISAGREE = 0.05


@dataclass(frozen=True)
class ActivationEnergies:
    """Energies in J/mol from the Arrhenius candidate, and what they say of each other.

    ``local`` holds the chosen law's apparent energy of torque at the coldest, the reference and the hottest
    temperature, K: equal if the law is Arrhenius. ``of_film`` says that a constant part of the torque is
    excluded from them: ``torque`` is then that of the film.
    """

    torque: Estimate | None
    power: Estimate | None  #: 1 + c, by which torque varies with viscosity
    viscosity: Estimate | None
    transition: Estimate | None
    p_value: float | None  #: of the transition's energy being the viscosity's
    verdict: str
    local: tuple[tuple[float, float], ...] = ()
    of_film: bool = False

    def lines(self) -> list[str]:
        """Return the energies as text, in kJ/mol and cal/mol."""
        lines = []
        named = (
            ("torque of the film, apparent" if self.of_film else "torque, apparent", self.torque),
            ("viscosity, from torque and its exponent", self.viscosity),
            ("viscosity, from the transition speed", self.transition),
        )
        for name, energy in named:
            if energy is None:
                continue
            kj, cal = scaled(energy, 1e-3), scaled(energy, 1.0 / CALORIE)
            if not energy.estimable:
                lines.append(f"{name}: {kj.value:.4g} kJ/mol = {cal.value:.0f} cal/mol, interval not known")
            else:
                lines.append(f"{name}: {_with(kj, 'kJ/mol')} = {_with(cal, 'cal/mol')}")
        return [*lines, self.verdict]


def _with(energy: Estimate, unit: str) -> str:
    return rounded(energy.value, energy.low, energy.high, unit)


def scaled(energy: Estimate, factor: float) -> Estimate:
    """Return an energy in another unit."""
    value, error, low, high, systematic = (
        factor * v for v in (energy.value, energy.error, energy.low, energy.high, energy.systematic)
    )
    return Estimate(value, error, low, high, energy.freedom, systematic)


def activation_energies(
    best: LawFit | None, free: LawFit | None, chosen: LawFit, data: Observations
) -> ActivationEnergies:
    """Return the energies.

    Parameters
    ----------
    best
        The likeliest Arrhenius candidate with common exponents.
    free
        The Arrhenius candidate whose transition moves freely; None if there is none, or nothing shows it.
    chosen
        The candidate chosen, for its local energies.
    """
    if best is None or data.reference_kelvin is None or best.law.thermal is None:
        return ActivationEnergies(
            None, None, None, None, None, "No activation energy: the log has fewer than two temperatures."
        )
    per_unit = best.law.thermal.energy(data.reference_kelvin)
    torque = _untold(best, _linear(best, {"e": per_unit}))
    of_film = isinstance(best.law, ConstantPlusLaw)
    power = _linear(best, {"c": 1.0}, offset=1.0 + _held(best))
    viscosity = None
    if power.low > LEAST_POWER:
        viscosity = _untold(best, _ratio(best, per_unit))
    transition = p_value = None
    if free is not None:
        transition = _untold(free, _linear(free, {"d": -per_unit}))
        p_value = None if free.not_estimable("e") else _disagreement(free)
    verdict = _verdict(viscosity, transition, p_value, power)
    local = _local(chosen, data)
    return ActivationEnergies(torque, power, viscosity, transition, p_value, verdict, local, of_film)


def _held(fit: LawFit) -> float:
    """The exponent of speed of a law that does not fit it; 0 if it is fitted."""
    return (fit.law.exponent or 0.0) if isinstance(fit.law, ConstantPlusLaw) else 0.0


def _untold(fit: LawFit, energy: Estimate) -> Estimate:
    """An energy without an interval where the law of temperature has none."""
    return replace(energy, low=-np.inf, high=np.inf) if fit.not_estimable("e") else energy


def _linear(fit: LawFit, share: dict[str, float], offset: float = 0.0) -> Estimate:
    weights = np.array([share.get(name, 0.0) for name in fit.law.names])
    value = offset + float(weights @ fit.values)
    return estimate(value, float(np.sqrt(weights @ fit.covariance @ weights)), fit.freedoms.of(weights))


def _ratio(fit: LawFit, per_unit: float) -> Estimate:
    """E/(1 + c), its interval symmetric in the logarithm where it is positive."""
    e = fit.values[fit.law.index("e")]
    c = fit.values[fit.law.index("c")] if "c" in fit.law.names else _held(fit)
    value = per_unit * float(e / (1.0 + c))
    slopes = _gradient(fit, e=per_unit / (1.0 + c), c=-per_unit * e / (1.0 + c) ** 2)
    error = float(np.sqrt(slopes @ fit.covariance @ slopes))
    if value > 2 * error:
        spread = float(np.exp(quantile(fit.freedoms.of(slopes)) * error / value))
        return Estimate(value, error, value / spread, value * spread)
    return estimate(value, error, fit.freedoms.of(slopes))


def _disagreement(fit: LawFit) -> float:
    """p-value of d = -e/(1 + c), by the delta method."""
    e, c, d = (fit.values[fit.law.index(name)] for name in ("e", "c", "d"))
    slopes = _gradient(fit, e=1.0 / (1.0 + c), c=-e / (1.0 + c) ** 2, d=1.0)
    error = float(np.sqrt(slopes @ fit.covariance @ slopes))
    return float(2.0 * student_above(abs(d + e / (1.0 + c)) / max(error, 1e-300), fit.freedoms.of(slopes)))


def _gradient(fit: LawFit, **share: float) -> FloatArray:
    return np.array([share.get(name, 0.0) for name in fit.law.names])


def _local(fit: LawFit, data: Observations) -> tuple[tuple[float, float], ...]:
    law = fit.law
    if not isinstance(law, Law) or law.thermal is None or data.reference_kelvin is None:
        return ()
    q = float(fit.values[law.index("q")]) if "q" in law.names else 0.0
    e = float(fit.values[law.index("e")])
    hots = (float(data.temperatures[0]), data.reference_kelvin, float(data.temperatures[-1]))
    return tuple((hot, e * law.thermal.energy(hot, q)) for hot in hots)


def _verdict(
    viscosity: Estimate | None, transition: Estimate | None, p_value: float | None, power: Estimate
) -> str:
    if viscosity is None:
        return (
            f"The exponent of torque in viscosity, {power}, does not exclude 0, so torque gives no "
            "activation energy. Record faster speeds, where torque rises with speed."
        )
    if transition is not None and p_value is None:
        return (
            "Each temperature was visited once, so the energies from transition speed and torque "
            "cannot be compared. Visit one again, or record another."
        )
    if transition is None or p_value is None:
        return (
            "The log does not show how the transition moves with temperature, so this energy cannot "
            "be checked. Record speeds around the transition at more temperatures."
        )
    both = f"{transition.value / 1e3:.3g} and {viscosity.value / 1e3:.3g} kJ/mol, p = {p_value:.2g}"
    if p_value < _DISAGREE:
        return (
            f"Viscosity's energies from the transition speed and from torque disagree ({both}): the "
            "transition is not at one Hersey number, or the exponent is not that of viscosity."
        )
    return (
        f"Viscosity's energies from the transition speed and from torque agree ({both}), as expected "
        "for a fixed Hersey number."
    )


def usable_for_transition(fit: LawFit) -> bool:
    """Whether a candidate carries a transition of its own and common exponents."""
    return isinstance(fit.law, Law) and fit.law.branches == FREE and fit.law.groups == 1
