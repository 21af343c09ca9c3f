"""Laws of viscosity in temperature against each other, for a table of a lubricant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hersey.damping.candidates.candidate import viscosity_candidates
from hersey.damping.candidates.comparison import choose, ranked
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.model_comparison import CandidateFit
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.thermal import ARRHENIUS
from hersey.damping.estimate import Estimate, estimate
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import takes_si


@dataclass(frozen=True)
class ViscosityLaws:
    """Laws of temperature by AICc, those refused and why, and the one chosen."""

    candidates: tuple[CandidateFit, ...]
    refused: tuple[tuple[str, str], ...]
    chosen: CandidateFit
    activation_energy: Estimate  #: J/mol, of the Arrhenius law, whether chosen or not


@takes_si(kelvin="temperature", viscosity="viscosity")
def viscosity_laws(kelvin: ArrayLike, viscosity: ArrayLike, *, relative_error: float = 0.0) -> ViscosityLaws:
    """Fit power laws, Arrhenius and VFT to a table of viscosities and choose one.

    Parameters
    ----------
    kelvin
        Temperatures, K, shape (points,).
    viscosity
        Viscosities in any one unit, shape (points,).
    relative_error
        Of each viscosity; what the laws miss beyond it counts as scatter.

    Raises
    ------
    InsufficientDataError
        If there are fewer than five temperatures.
    ParameterError
        If a viscosity or temperature is not positive.
    """
    hot, value = np.asarray(kelvin, dtype=np.float64), np.asarray(viscosity, dtype=np.float64)
    if hot.shape != value.shape or hot.ndim != 1:
        raise ParameterError("kelvin and viscosity must be one-dimensional and of equal length")
    if not (np.all(value > 0) and np.all(hot > 0) and np.all(np.isfinite(value + hot))):
        raise ParameterError("viscosity and temperature must be positive")
    levels, group = np.unique(hot, return_inverse=True)
    zero = np.zeros_like(hot)
    data = Observations(
        inputs=Inputs(zero, hot, group.astype(np.intp)),
        log_torque=np.log(value),
        torque_error=np.full(hot.size, relative_error),
        speed_error=zero,
        temperature_error=zero,
        tare=np.empty((hot.size, 0)),
        visit=np.arange(hot.size),
        run=np.zeros(hot.size, dtype=np.intp),
        cluster=group.astype(np.intp),
        clustered_by="level",
        reference_speed=1.0,
        reference_kelvin=float(1.0 / np.mean(1.0 / hot)),
        temperatures=levels,
    )
    refused = tuple(
        (candidate.name, why) for candidate in viscosity_candidates() if (why := candidate.refused(data))
    )
    carried = [candidate for candidate in viscosity_candidates() if not candidate.refused(data)]
    arrhenius = next((candidate for candidate in carried if candidate.thermal == ARRHENIUS), None)
    if arrhenius is None:
        raise InsufficientDataError(f"no law of viscosity can be fitted: {refused[0][1]}")
    by_aicc = ranked(
        [(candidate, fit_law(candidate.law(data), data)) for candidate in carried], data, cross_validate=True
    )
    fit = next(r.fit for r in by_aicc if r.candidate == arrhenius)
    assert fit.law.thermal is not None
    assert data.reference_kelvin is not None
    per_unit = fit.law.thermal.energy(data.reference_kelvin)
    energy, error = per_unit * float(fit.values[1]), per_unit * float(np.sqrt(fit.covariance[1, 1]))
    return ViscosityLaws(by_aicc, refused, choose(by_aicc), estimate(energy, error, fit.freedom_of("e")))
