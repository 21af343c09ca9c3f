"""The rising branch by itself: the dwells above the transition, and whether one exponent holds there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.damping.candidates.branched import ONE, Law
from hersey.damping.candidates.candidate import LEAST_FREEDOM
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.lack_of_fit import SPEEDS_OF_CURVATURE, LackOfFit, lack_of_fit
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.thermal import Thermal
from hersey.damping.dwells import SteadyPoints, distinct_speeds
from hersey.damping.fitted_law import SCALES
from hersey.damping.surface import DampingSurface


@dataclass(frozen=True)
class Rising:
    """The dwells above the transition, all where there is none, and one power law fitted to them.

    ``fit`` and ``lack_of_fit`` are None, and ``why_not`` says why, where the dwells are too few to tell, or
    have several loads.
    """

    data: Observations
    thermal: Thermal | None
    fit: LawFit | None
    lack_of_fit: LackOfFit | None
    bent: bool
    why_not: str


def rising(points: SteadyPoints, surface: DampingSurface) -> Rising:
    """Return the rising branch of the dwells to which a surface was fitted.

    It is bent if its exponent changes beyond chance, and by more than errors of the sensors explain.
    """
    data = _above(Observations.of(points), surface)
    if loads := points.varying_load:
        low, high = loads
        why_not = (
            f"the load varies from {low:.3g} to {high:.3g} N, which the models do not include. "
            "Analyse one load at a time"
        )
        return Rising(data, None, None, None, False, why_not)
    thermal = None
    if surface.b is not None and data.reference_kelvin is not None:
        thermal = Thermal(SCALES[surface.temperature_scale], data.reference_kelvin)
    law = Law(thermal, ONE)
    dwells, speeds = len(law.names) + LEAST_FREEDOM, distinct_speeds(data.speed)
    if len(data) < dwells or speeds < SPEEDS_OF_CURVATURE:
        where = "" if surface.transition is None else " above the transition"
        why_not = (
            f"a test for one exponent needs {SPEEDS_OF_CURVATURE} speeds and {dwells} dwells{where}, "
            f"and there are only {speeds} and {len(data)}"
        )
        return Rising(data, thermal, None, None, False, why_not)
    fit = fit_law(law, data)
    lack = lack_of_fit(fit, data)
    return Rising(data, thermal, fit, lack, lack.bent_by(2.0 * surface.c.systematic), "")


def _above(data: Observations, surface: DampingSurface) -> Observations:
    if surface.transition is None:
        return data
    kelvin = data.inputs.kelvin if surface.b is not None else None
    temperatures = [None] * len(data) if kelvin is None else kelvin.tolist()
    at = np.array([surface.transition_speed(t) for t in temperatures])
    return data.take(np.flatnonzero(data.speed >= at))
