"""Fitting the damping surface: the paper's candidate in the likelihood of all candidate laws."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from hersey.arguments.door import Words
from hersey.arrays import FloatArray
from hersey.cache.kept import kept
from hersey.damping.branches import Transition, fit_branches, transition, why_no_transition
from hersey.damping.candidates.branched import ONE, Law
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.clustered import clustered_covariance
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.likelihood import minimise, scatter_beyond
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.thermal import scaled_temperature
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.dwells.constant import dead_temperature
from hersey.damping.dwells.least_duration import temperatures_lost
from hersey.damping.dwells.reduced import require_points
from hersey.damping.estimate import Estimate, estimate
from hersey.damping.fitted_law import SCALES, FitStatistics
from hersey.damping.scaled import law_of
from hersey.damping.shown import why_not_shown
from hersey.damping.surface import DampingSurface
from hersey.damping.systematic import sensor_shifts
from hersey.errors import ISOTHERMAL, InsufficientDataError, ParameterError, Setting
from hersey.units import celsius, takes_si

#: Temperature below which no lubricant flows, K: what reads less is in another unit.
NO_OIL_FLOWS = 193.15
#: Rounds in which the scatter of the fit to torque settles.
_ROUNDS = 12


@takes_si(temperature_scale=Words(("degC", "K")))
@kept()
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
    ParameterError
        If ``points`` is a log or its file: the message has the line that reduces it.
    """
    require_points(points, "hersey.fit({points})")
    if temperature_scale not in SCALES:
        raise ParameterError(f"temperature scale '{temperature_scale}' is not known. Use degC or K")
    data = Observations.of(points)
    _require_temperatures(data, temperature_scale, points)
    _require_dwells(data)
    thermal = None if data.inputs.kelvin is None else SCALES[temperature_scale]
    law = Candidate(thermal, ONE).law(data)
    assert isinstance(law, Law)
    single = fit_law(law, data)
    branches = fit_branches(data, single)
    if branches is None:
        return _surface(points, data, single, None, "too few dwells for a second branch", temperature_scale)
    refused = why_no_transition(data, single, branches) or why_not_shown(points, data, branches)
    if refused:
        return _surface(points, data, single, None, refused, temperature_scale)
    measured_transition = transition(data, single, branches)
    return _surface(points, data, branches.fit, measured_transition, "", temperature_scale)


def _require_temperatures(data: Observations, scale: str, points: SteadyPoints) -> None:
    kelvin = data.inputs.kelvin
    if kelvin is None:
        return
    if sum(1 for _ in groups_of_temperature(kelvin)) < 2:
        ends = {f"{celsius(float(each)):.1f}": None for each in (kelvin.min(), kelvin.max())}
        at = " to ".join(ends)
        if lost := temperatures_lost(points):
            raise InsufficientDataError(f"all dwells are at one temperature ({at} degC): {lost}")
        said = f"all dwells are at one temperature ({at} degC), so exponent b cannot be estimated"
        if dead := dead_temperature(points):
            said, record = f"{said}: {dead}", "Check it and record again"
        else:
            record = "Record other temperatures"
        raise InsufficientDataError(f"{said}. {record}, or fit without b by {ISOTHERMAL.to()}")
    if np.any(scaled_temperature(kelvin, scale) <= 0):
        raise InsufficientDataError(
            f"T^b is not defined at or below 0 degC, but the coldest dwell is at {_lowest(kelvin)}"
        )


def _lowest(kelvin: FloatArray) -> str:
    """The lowest temperature, and what to do about it: no oil flows so far below."""
    low = float(kelvin.min())
    if low < NO_OIL_FLOWS:
        how = Setting("temperature", "unit").to("degC")
        return f"{celsius(low):.0f} degC. If temperatures are in degC and not in K, use {how}"
    return f"{celsius(low):.3g} degC. Fit with {Setting('temperature_scale').to('K')}"


def _require_dwells(data: Observations) -> None:
    needed = 3 + (data.inputs.kelvin is not None)
    if len(data) <= needed:
        raise InsufficientDataError(
            f"{len(data)} dwells are too few for {needed - 1} coefficients and their errors; at least "
            f"{needed + 1} are needed"
        )


def _surface(
    points: SteadyPoints,
    data: Observations,
    fit: LawFit,
    measured_transition: Transition | None,
    refused: str,
    scale: str,
) -> DampingSurface:
    law = law_of(fit)
    kelvin = data.inputs.kelvin
    shifts = sensor_shifts(fit, data, points.log.sensors)
    coefficients = _coefficients(fit, data, fit.values, fit.covariance, scale, shifts)
    if measured_transition is not None:
        measured_transition = _with_sensors(measured_transition, fit, shifts)
    gradual = measured_transition is not None and measured_transition.gradual
    labels = {"level": "ln B_ref", "e": "b", "at": "ln(w_meet/w_ref)" if gradual else "ln(w_t/w_ref)"}
    labels["d"] = "exponent of w_t in T"
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
        freedoms=fit.freedoms,
        torque_space=_in_torque_space(law, data, fit, scale),
        statistics=_statistics(data, fit, residuals),
        speed_range=(float(data.speed.min()), float(data.speed.max())),
        temperature_range=None if kelvin is None else (float(kelvin.min()), float(kelvin.max())),
        residuals=residuals,
        rejected_transition=refused,
        data_sha256=tuple(file.sha256 for file in points.log.files),
        sensors=points.log.sensors.about(points.domain),
        rest=points.rest,
        domain=points.domain,
    )


def _coefficients(
    fit: LawFit,
    data: Observations,
    values: FloatArray,
    covariance: FloatArray,
    scale: str,
    shifts: FloatArray | None = None,
) -> dict[str, Estimate]:
    """a, b and c as Eq. 4 has them, from values about the reference point; ``shifts`` as `sensor_shifts`."""
    law = law_of(fit)
    weights = np.zeros(values.size)
    weights[0], weights[law.index("c")] = 1.0, -np.log(data.reference_speed)
    if law.thermal:
        reference = scaled_temperature(np.asarray(data.reference_kelvin), scale)
        weights[law.index("e")] = -float(np.log(reference))
    # ln B = ln torque - ln w, so that of B at w = 1 rad/s is level - (1 + c) ln w_ref
    at_one = float(weights @ values) - float(np.log(data.reference_speed))
    size = fit.values.size
    whole = np.append(weights, np.zeros(size - weights.size))
    moved = np.zeros((1, size)) if shifts is None else shifts
    log_a = estimate(at_one, float(np.sqrt(weights @ covariance @ weights)), fit.freedoms.of(whole))
    out = {"a": _exponential(log_a.with_systematic(_together(moved @ whole)))}
    for name, parameter in (("b", "e"), ("c", "c")):
        if parameter in law.names:
            i = law.index(parameter)
            error = float(np.sqrt(covariance[i, i]))
            out[name] = estimate(float(values[i]), error, fit.freedom_of(parameter)).with_systematic(
                _together(moved[:, i])
            )
    if law.thermal and fit.not_estimable("e"):
        out |= {name: replace(out[name], low=-np.inf, high=np.inf) for name in ("a", "b")}
    return out


def _together(shifts: FloatArray) -> float:
    """Half width of independent errors at their limits."""
    return float(np.sqrt(np.sum(shifts**2)))


def _with_sensors(transition: Transition, fit: LawFit, shifts: FloatArray) -> Transition:
    law, speed, mixed = law_of(fit), transition.speed, transition.mixed_exponent
    if fit.not_estimable("at"):
        speed = replace(speed, low=-np.inf, high=np.inf)
    moved = speed.value * _together(shifts[:, law.index("at")])
    return replace(
        transition,
        speed=speed.with_systematic(moved),
        mixed_exponent=mixed.with_systematic(_together(shifts[:, law.index("c_mixed")])),
    )


def _exponential(log: Estimate) -> Estimate:
    """What its logarithm is an estimate of."""
    value = float(np.exp(log.value))
    ends = float(np.exp(log.low)), float(np.exp(log.high))
    return Estimate(value, value * log.error, *ends, log.freedom, value * log.systematic)


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
        shared=fit.shared,
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
    errors, shared = data.torque_error * torque, fit.disturbances * torque[:, None]
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
    shifts = np.linalg.pinv(best.jacobian) @ (shared / sigma[:, None])
    covariance = covariance + shifts @ shifts.T
    return _coefficients(fit, data, values, covariance, scale)
