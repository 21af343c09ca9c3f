"""Dwells of all temperatures on one curve: at one Hersey number torque is a function of scaled speed."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.branched import FREE, Law, transition_exponent
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Observations


def law_of(fit: LawFit) -> Law:
    """Return the law of a fit of one branch or two."""
    assert isinstance(fit.law, Law)
    return fit.law


def powers_of(fit: LawFit) -> tuple[float, float]:
    """Return the exponents of temperature (0 if isothermal) and of speed above the transition."""
    law = law_of(fit)
    e = float(fit.values[law.index("e")]) if law.thermal else 0.0
    return e, float(fit.values[law.index("c")])


def move_of(fit: LawFit) -> float:
    """Return the exponent of the transition speed in temperature: that of one Hersey number, or its own."""
    law = law_of(fit)
    if law.branches == FREE and law.thermal:
        return float(fit.values[law.index("d")])
    return transition_exponent(*powers_of(fit))


def temperatures_of(data: Observations, law: Law) -> FloatArray:
    """Return ln temperature about the reference, in the scale of the law; zeros if isothermal."""
    if law.thermal is None or data.inputs.kelvin is None:
        return np.zeros(len(data))
    return law.thermal.shape(data.inputs.kelvin)[0]


def scaled_speed(data: Observations, fit: LawFit) -> FloatArray:
    """Return ln(w/w_ref) at the same Hersey number at the reference temperature, shape (points,)."""
    shift = move_of(fit) * temperatures_of(data, law_of(fit))
    return np.asarray(data.inputs.log_speed - shift)


def scaled_torque(data: Observations, fit: LawFit) -> FloatArray:
    """Return ln torque at the same Hersey number at the reference temperature, shape (points,).

    It is the ln torque measured unless 1 + c is so small that the move of the transition is bounded.
    """
    e, c = powers_of(fit)
    power = e + (1.0 + c) * move_of(fit)
    return np.asarray(data.log_torque - power * temperatures_of(data, law_of(fit)))
