"""Fitting the damping surface: the paper's candidate in the likelihood of all candidate laws."""

from __future__ import annotations

from functools import partial

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.branches import Transition, fit_branches, transition, why_no_transition
from hersey.damping.candidates.branched import ONE, Law
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.fitting import LawFit, clustered_covariance, fit_law
from hersey.damping.candidates.likelihood import minimise, scatter_beyond
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.thermal import scaled_temperature
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.estimate import Estimate, estimate
from hersey.damping.surface import SCALES, DampingSurface, FitStatistics
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import celsius

#: Rounds in which the scatter of the fit to torque settles.
_ROUNDS = 12


def fit(points: SteadyPoints, *, temperature_scale: str = "degC") -> DampingSurface:
    """Fit the damping surface to steady points.

    Parameters
    ----------
    points
        From `TorqueLog.steady`.
    temperature_scale
        ``degC`` (as the paper) or ``K``: a and b depend on it.

    Raises
    ------
    InsufficientDataError
        If the points hold fewer than three speeds, or a temperature that does not vary.
    """
    if temperature_scale not in SCALES:
        raise ParameterError(f"temperature scale '{temperature_scale}' is not known: degC or K")
    data = Observations.of(points)
    _require_temperatures(data, temperature_scale)
    _require_dwells(data)
    thermal = None if data.inputs.kelvin is None else SCALES[temperature_scale]
    law = Candidate(thermal, ONE).law(data)
    assert isinstance(law, Law)
    single = fit_law(law, data)
    branches = fit_branches(data, single)
    if branches is None:
        return _surface(points, data, single, None, "too few points for a second branch", temperature_scale)
    refused = why_no_transition(data, single, branches)
    if refused:
        return _surface(points, data, single, None, refused, temperature_scale)
    measured_transition = transition(data, single, branches)
    return _surface(points, data, branches.fit, measured_transition, "", temperature_scale)


def _require_temperatures(data: Observations, scale: str) -> None:
    kelvin = data.inputs.kelvin
    if kelvin is None:
        return
    if sum(1 for _ in groups_of_temperature(kelvin)) < 2:
        low, high = celsius(float(kelvin.min())), celsius(float(kelvin.max()))
        raise InsufficientDataError(
            f"all steady points are at one temperature ({low:.1f} to {high:.1f} degC): no exponent b can be "
            "claimed; record other temperatures, or say --isothermal to fit B = a w^c at this one"
        )
    if np.any(scaled_temperature(kelvin, scale) <= 0):
        raise InsufficientDataError("T^b has no meaning at or below 0 degC: fit with --temperature-scale K")


def _require_dwells(data: Observations) -> None:
    needed = 3 + (data.inputs.kelvin is not None)
    if len(data) <= needed:
        raise InsufficientDataError(
            f"{len(data)} steady points cannot determine {needed - 1} coefficients and their errors: "
            f"at least {needed + 1} are needed"
        )


def _surface(
    points: SteadyPoints,
    data: Observations,
    fit: LawFit,
    measured_transition: Transition | None,
    refused: str,
    scale: str,
) -> DampingSurface:
    law = fit.law
    assert isinstance(law, Law)
    kelvin = data.inputs.kelvin
    coefficients = _coefficients(law, data, fit.values, fit.covariance, fit.freedom, scale)
    labels = {"level": "ln B_ref", "e": "b", "at": "ln(w_t/w_ref)"}
    residuals = data.log_torque - law.predict(fit.values, data.inputs)
    return DampingSurface(
        a=coefficients["a"],
        b=coefficients.get("b"),
        c=coefficients["c"],
        transition=measured_transition,
        temperature_scale=scale,
        reference_speed=data.reference_speed,
        reference_temperature=data.reference_kelvin,
        variables=tuple(labels.get(name, name) for name in law.names),
        values=np.append(fit.values[0] - np.log(data.reference_speed), fit.values[1:]),
        covariance=fit.covariance,
        torque_space=_in_torque_space(law, data, fit, scale),
        statistics=_statistics(data, fit, residuals),
        speed_range=(float(data.speed.min()), float(data.speed.max())),
        temperature_range=None if kelvin is None else (float(kelvin.min()), float(kelvin.max())),
        residuals=residuals,
        rejected_transition=refused,
        data_sha256=tuple(file.sha256 for file in points.log.files),
    )


def _coefficients(
    law: Law, data: Observations, values: FloatArray, covariance: FloatArray, freedom: int, scale: str
) -> dict[str, Estimate]:
    """a, b and c as Eq. 4 has them, from values about the reference point."""
    weights = np.zeros(values.size)
    weights[0], weights[law.index("c")] = 1.0, -np.log(data.reference_speed)
    if law.thermal:
        reference = scaled_temperature(np.asarray(data.reference_kelvin), scale)
        weights[law.index("e")] = -float(np.log(reference))
    # ln B = ln torque - ln w, so that of B at w = 1 rad/s is level - (1 + c) ln w_ref
    at_one = float(weights @ values) - float(np.log(data.reference_speed))
    log_a = estimate(at_one, float(np.sqrt(weights @ covariance @ weights)), freedom)
    a = float(np.exp(log_a.value))
    out = {"a": Estimate(a, a * log_a.error, float(np.exp(log_a.low)), float(np.exp(log_a.high)))}
    for name, parameter in (("b", "e"), ("c", "c")):
        if parameter in law.names:
            i = law.index(parameter)
            out[name] = estimate(float(values[i]), float(np.sqrt(covariance[i, i])), freedom)
    return out


def _statistics(data: Observations, fit: LawFit, residuals: FloatArray) -> FitStatistics:
    """How well the law describes the dwells; chi-square counts their errors alone, unless some are nil."""
    sigma = fit.errors if np.all(fit.errors > 0) else fit.sigma
    chi_square = float(np.sum((fit.residuals / sigma) ** 2))
    torque = np.exp(data.log_torque)
    fitted = torque * np.exp(-residuals)
    return FitStatistics(
        points=len(data),
        variables=int(fit.values.size),
        chi_square=chi_square,
        reduced_chi_square=chi_square / fit.freedom,
        scatter=fit.scatter,
        dwell_error=float(np.median(fit.errors)),
        aicc=fit.aicc,
        r_squared_damping=_r_squared(torque / data.speed, fitted / data.speed),
        r_squared_torque=_r_squared(torque, fitted),
    )


def _r_squared(measured: FloatArray, fitted: FloatArray) -> float:
    """Share of the variance explained; 0 where there is none to explain."""
    total = float(np.sum((measured - measured.mean()) ** 2))
    return 1.0 - float(np.sum((measured - fitted) ** 2)) / total if total > 0 else 0.0


def _in_torque_space(law: Law, data: Observations, fit: LawFit, scale: str) -> dict[str, Estimate]:
    """The same law fitted to torque, errors absolute; a transition stays where ln torque put it.

    Its covariance holds whatever the variance of each dwell.
    """
    torque = np.exp(data.log_torque)
    errors, tare = data.torque_error * torque, data.tare * torque
    free = law.index("at") if law.broken else fit.values.size
    held = fit.values[free:]

    def predicted(values: FloatArray) -> FloatArray:
        return np.exp(law.predict(np.append(values, held), data.inputs))

    def residual(sigma: FloatArray, values: FloatArray) -> FloatArray:
        return (torque - predicted(values)) / sigma

    def jacobian(sigma: FloatArray, values: FloatArray) -> FloatArray:
        slopes = law.jacobian(np.append(values, held), data.inputs)[:, :free]
        return -(predicted(values) / sigma)[:, None] * slopes

    values, scatter = fit.values[:free], float(np.std(torque - predicted(fit.values[:free])))
    for _ in range(_ROUNDS):
        sigma = np.sqrt(errors**2 + scatter**2 + (1e-9 * torque.max()) ** 2)
        best = minimise(partial(residual, sigma), partial(jacobian, sigma), values)
        values, before = best.values, scatter
        scatter = scatter_beyond(torque - predicted(values), errors, torque.size - free)
        if abs(scatter - before) <= 1e-6 * max(scatter, 1e-9 * float(torque.max())):
            break
    each = np.arange(torque.size)
    covariance = clustered_covariance(best.jacobian, residual(sigma, values), each)
    shift = np.linalg.pinv(best.jacobian) @ (tare / sigma)
    covariance = covariance + np.outer(shift, shift)
    return _coefficients(law, data, values, covariance, torque.size - free, scale)
