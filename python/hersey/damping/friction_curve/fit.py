"""Fitting Coulomb, viscous and Stribeck friction to steady points: which law, and its parameters."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.cache.kept import kept
from hersey.damping.candidates.candidate import LEAST_FREEDOM
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.intervals import likelihood_ratio, profile_interval
from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.damping.candidates.observations import Observations
from hersey.damping.dwells import SteadyPoints, distinct_speeds, groups_of_temperature
from hersey.damping.dwells.reduced import require_points
from hersey.damping.estimate import Estimate
from hersey.damping.friction_curve import law as laws
from hersey.damping.friction_curve.dwell_law import DwellFriction
from hersey.damping.friction_curve.fitted import (
    BOTH,
    COULOMB_VISCOUS,
    FORWARD,
    REVERSE,
    STRIBECK,
    DirectionTest,
    FrictionParameter,
    LeastTorque,
    TriedFriction,
)
from hersey.damping.friction_curve.law import FrictionLaw
from hersey.damping.friction_curve.least import UNBOUNDED, Searched, least_torques
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.trend import trend_of
from hersey.errors import InsufficientDataError
from hersey.units import takes_si

#: Distinct speeds that a direction needs for Coulomb plus viscous friction, and for a Stribeck curve.
SPEEDS_OF_LINE, SPEEDS_OF_CURVE = 3, 5
#: Steepest fall of exp(-x^2).
_STEEPEST = float(np.sqrt(2.0 / np.e))
#: Directions by the ends of the names of parameters.
_WAYS = {laws.FORWARD: FORWARD, laws.REVERSE: REVERSE}


@dataclass(frozen=True)
class _Fitted:
    """One law as fitted."""

    law: FrictionLaw
    fit: LawFit

    @property
    def values(self) -> FloatArray:
        """Parameters of the law, SI."""
        assert isinstance(self.fit.law, DwellFriction)
        return self.fit.law.of(self.fit.values)

    @property
    def covariance(self) -> FloatArray:
        """Covariance of the parameters of the law, SI."""
        slopes = np.ones(self.values.size)
        speeds = self.law.places(laws.STRIBECK_SPEED)
        slopes[speeds] = self.values[speeds]
        return np.asarray(self.fit.covariance * np.outer(slopes, slopes))

    @property
    def falls_from_rest(self) -> bool:
        """Whether each Stribeck torque at rest exceeds that of Coulomb friction.

        A Coulomb friction below 0 only bends the curve where torque falls nowhere.
        """
        for way in self.law.ways if self.law.stribeck else ():
            own = self.law.of_way(self.values, way)
            rise = own[laws.STATIC] - own[laws.COULOMB]
            falls = _STEEPEST * rise > own[laws.VISCOUS] * own[laws.STRIBECK_SPEED]
            if not (rise > 0.0 and (own[laws.COULOMB] > 0.0 or falls)):
                return False
        return True


@takes_si()
@kept()
def fit_friction(points: SteadyPoints) -> FrictionCurve:
    """Fit Coulomb, viscous and Stribeck friction to the steady points of a joint or gear motor.

    Coulomb plus viscous friction and a Stribeck curve are fitted, for both directions together and for each
    apart, in the likelihood of `hersey.fit`. A law with more parameters needs a gain of 6 in AICc.

    Parameters
    ----------
    points
        From `TorqueLog.steady`; speed and torque carry the sign of the rotation.

    Returns
    -------
    FrictionCurve
        The law with T_C, T_S (N m), w_S (rad/s) and k_v (N m s/rad), and their 95 % intervals.

    Raises
    ------
    InsufficientDataError
        If the points hold fewer than three speeds, or too few dwells.
    ParameterError
        If ``points`` is a log or its file (the message has the line that reduces it), or of a friction force
        or coefficient.

    Examples
    --------
    >>> speed = [-60, -40, -20, -10, 10, 20, 40, 60]
    >>> torque = [-0.536, -0.521, -0.509, -0.501, 0.501, 0.507, 0.52, 0.533]
    >>> points = SteadyPoints.from_table({"speed [rpm]": speed, "torque [N*m]": torque})
    >>> fit_friction(points).headline()
    'Coulomb plus viscous friction: T_C = 494 mN·m [493, 496], k_v = 6.34 mN·m·s/rad [5.85, 6.83]'
    """
    require_points(points, "hersey.fit_friction({points})")
    points.domain.require_torque("the friction curve of a joint")
    data = Observations.of(points)
    fitted = _fitted(data)
    chosen = _chosen(fitted)
    ways = _ways(data)
    speed = data.speed
    ends = {
        name: (float(speed[way].min()), float(speed[way].max())) if np.any(way) else None
        for name, way in ways.items()
    }
    kelvin = data.inputs.kelvin
    return FrictionCurve(
        parameters=_parameters(chosen, data),
        least=_least(chosen, data),
        tried=_tried(fitted),
        directions=_directions(chosen, fitted, points),
        aicc=chosen.fit.aicc,
        scatter=chosen.fit.scatter,
        points=len(data),
        falls=any(trend_of(data.take(np.flatnonzero(way))).falls for way in ways.values() if np.any(way)),
        forward_speeds=ends[FORWARD],
        reverse_speeds=ends[REVERSE],
        temperature_range=None if kelvin is None else (float(kelvin.min()), float(kelvin.max())),
        reference_temperature=chosen.law.reference_kelvin,
        law=chosen.law,
        values=chosen.values,
        covariance=chosen.covariance,
        freedom=float(chosen.fit.freedom),
        data=data,
    )


def _ways(data: Observations) -> dict[str, BoolArray]:
    """Which dwells turn in each direction."""
    sign = data.inputs.sign
    forward = np.ones(len(data), dtype=bool) if sign is None else sign > 0
    return {FORWARD: forward, REVERSE: ~forward}


def _together(data: Observations) -> str:
    """What one law for all dwells holds for."""
    measured = [name for name, way in _ways(data).items() if np.any(way)]
    return measured[0] if len(measured) == 1 else BOTH


def _fitted(data: Observations) -> list[_Fitted]:
    """Every law that the dwells can carry, as fitted."""
    kelvin = data.inputs.kelvin
    warmed = kelvin is not None and sum(1 for _ in groups_of_temperature(kelvin)) > 1
    reference = data.reference_kelvin if warmed else None
    least = float(np.exp(data.log_torque.min()))
    out = []
    for stribeck in (False, True):
        for apart in (False, True):
            law = FrictionLaw(stribeck=stribeck, apart=apart, reference_kelvin=reference)
            if _carried(law, data):
                fit = fit_law(DwellFriction(law, data.reference_speed, least), data)
                out.append(_Fitted(law, fit))
    if not out:
        needed = 2 + (reference is not None) + LEAST_FREEDOM
        raise InsufficientDataError(
            f"{len(data)} dwells are too few for a friction curve; at least {needed} are needed"
        )
    return out


def _carried(law: FrictionLaw, data: Observations) -> bool:
    """Whether there are dwells enough for a law, in each direction if it has them apart."""
    if len(data) < len(law.names) + LEAST_FREEDOM:
        return False
    needed = SPEEDS_OF_CURVE if law.stribeck else SPEEDS_OF_LINE
    ways = list(_ways(data).values()) if law.apart else [np.ones(len(data), dtype=bool)]
    return all(np.any(way) and distinct_speeds(data.speed[way]) >= needed for way in ways)


def _chosen(fitted: list[_Fitted]) -> _Fitted:
    """The law of fewest parameters that none excludes; among as many, the likeliest."""
    sound = [each for each in fitted if each.falls_from_rest] or fitted[:1]
    best = min(each.fit.aicc for each in sound)
    kept_ = [each for each in sound if each.fit.aicc <= best + EVIDENCE]
    return min(kept_, key=lambda each: (each.fit.values.size, each.fit.aicc))


def _tried(fitted: list[_Fitted]) -> tuple[TriedFriction, ...]:
    aicc = np.array([each.fit.aicc for each in fitted])
    weight = np.exp(-0.5 * (aicc - aicc.min()))
    out = [
        TriedFriction(
            STRIBECK if each.law.stribeck else COULOMB_VISCOUS,
            each.law.apart,
            each.fit.parameters,
            each.fit.aicc,
            float(share),
            each.fit.scatter,
        )
        for each, share in zip(fitted, weight / weight.sum(), strict=True)
    ]
    return tuple(sorted(out, key=lambda tried: tried.aicc))


def _directions(chosen: _Fitted, fitted: list[_Fitted], points: SteadyPoints) -> DirectionTest | None:
    """Whether one law of the chosen kind holds for both directions; None where one cannot say."""
    same = {each.law.apart: each for each in fitted if each.law.stribeck == chosen.law.stribeck}
    if len(same) < 2:
        return None
    offset = None
    if chosen.law.apart and not points.tare_errors.shape[1]:
        forward, reverse = (chosen.law.of_way(chosen.values, way)[laws.COULOMB] for way in chosen.law.ways)
        offset = abs(forward - reverse) / 2.0
    return DirectionTest(likelihood_ratio(same[False].fit, same[True].fit), chosen.law.apart, offset)


def _parameters(chosen: _Fitted, data: Observations) -> tuple[FrictionParameter, ...]:
    out = []
    for i, each in enumerate(chosen.law.numbers):
        direction = _WAYS.get(each.way, _together(data))
        known = _estimate(chosen, data, i)
        out.append(FrictionParameter(each.kind, direction, known, laws.UNITS[each.kind], known.estimable))
    return tuple(out)


def _estimate(chosen: _Fitted, data: Observations, i: int) -> Estimate:
    """One parameter in SI: by curvature, and by the profile of the likelihood for a Stribeck curve."""
    fit, number = chosen.fit, chosen.law.numbers[i]
    known = fit.estimate(number.name)
    if fit.not_estimable(number.name):
        return known
    if chosen.law.stribeck and known.error > 0:
        low, high = profile_interval(fit, data, i)
        known = replace(known, low=low, high=high)
    if number.kind == laws.STRIBECK_SPEED:
        value = float(np.exp(known.value))
        with np.errstate(over="ignore"):
            low, high = (float(np.exp(end)) for end in (known.low, known.high))
        known = replace(known, value=value, error=value * known.error, low=low, high=high)
        if low < value / UNBOUNDED:
            known = replace(known, low=0.0, high=high)
    if number.kind in (laws.STRIBECK_SPEED, laws.STATIC) and not known.high < UNBOUNDED * known.value:
        known = replace(known, high=np.inf)
    if number.kind == laws.STATIC and _is_extrapolated(chosen, data, number.way):
        known = replace(known, high=np.inf)
    return known


def _is_extrapolated(chosen: _Fitted, data: Observations, way: str) -> bool:
    """Whether the slowest dwell is above the Stribeck speed: then it shows little of the rise to T_S."""
    speed = data.speed[_ways(data)[_WAYS[way]]] if way else data.speed
    return bool(speed.min() > chosen.law.of_way(chosen.values, way)[laws.STRIBECK_SPEED])


def _least(chosen: _Fitted, data: Observations) -> tuple[LeastTorque, ...]:
    """Where torque is least in each direction, where that lies between the measured speeds."""
    fit, law = chosen.fit, chosen.fit.law
    assert isinstance(law, DwellFriction)
    ways = _ways(data) if chosen.law.apart else {_together(data): np.ones(len(data), dtype=bool)}
    searched = Searched(
        fit.values,
        fit.covariance,
        law.of,
        lambda slopes: fit.freedoms.of(slopes) if np.any(slopes) else float(fit.freedom),
    )
    ends = {name: (float(data.speed[way].min()), float(data.speed[way].max())) for name, way in ways.items()}
    return least_torques(chosen.law, searched, ends)
