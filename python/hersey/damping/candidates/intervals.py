"""Intervals of what was fitted, by four methods, and none where the data determine nothing.

covariance
    Student's t times the standard error, of the model's own covariance.
clustered
    The same with a covariance that holds whatever the dwells of a cluster have in common.
profile
    Every value at which the rest can be refitted so that the cost rises by less than t^2. It follows the
    corner in the likelihood of a transition, where a standard error does not (Venzon and Moolgavkar, Appl.
    Stat. 37 (1988) 87).
bootstrap
    Clusters drawn with replacement; percentiles about the fit, widened for the parameters it took.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.branched import FREE, Law
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.fitting import AnyLaw, LawFit
from hersey.damping.candidates.identifiability import not_identified
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.refits import resampled
from hersey.damping.candidates.searching import Effort, search
from hersey.damping.candidates.shared_errors import Freedom, SharedScatter, shared_variance
from hersey.damping.candidates.shared_load import SharedLoadLaw
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, VFT
from hersey.damping.distributions import normal_quantile, ratio_above
from hersey.damping.estimate import CONFIDENCE, quantile
from hersey.result import OPEN, Record
from hersey.schema.domain import Domain
from hersey.units import convert

Ends = tuple[float, float]

#: Steps of a profile, in standard errors, and how far it is followed.
_STEP, _FARTHEST = 0.25, 8.0
METHODS = ("covariance", "clustered", "profile", "bootstrap")


@dataclass(frozen=True)
class Quantity:
    """What a parameter says, as a monotone function of it."""

    name: str
    unit: str
    parameter: int
    of: Callable[[float], float]


@dataclass(frozen=True)
class ParameterEstimate(Record):
    """A quantity with its intervals at 95 %, by method; neither error nor interval if not identified."""

    name: str
    unit: str
    value: Annotated[float, OPEN]
    error: float | None
    intervals: dict[str, Ends] = field(default_factory=dict)
    not_identified: str = ""

    @property
    def interval(self) -> Ends | None:
        """The interval to quote: by profile, else by covariance."""
        return self.intervals.get("profile") or self.intervals.get("covariance")

    def __str__(self) -> str:
        """Return value and interval, or why there is none."""
        if self.interval is None:
            return f"cannot be determined: {self.not_identified}"
        low, high = self.interval
        return f"{self.value:.5g} [{low:.5g}, {high:.5g}]"


@dataclass(frozen=True)
class Band:
    """Torque, N m, with 95 % limits: of the law, and of one further dwell in a visit of its own."""

    torque: FloatArray
    confidence: tuple[FloatArray, FloatArray]
    prediction: tuple[FloatArray, FloatArray]


#: A parameter of a law, what it is called, its unit, and its value of that of the parameter.
_Named = tuple[str, str, str, Callable[[float], float]]


def quantities(law_fit: LawFit, data: Observations) -> tuple[Quantity, ...]:
    """Return what the parameters of a fit are called, in which units, and their values."""
    law, w, domain = law_fit.law, data.reference_speed, data.domain
    stribeck = isinstance(law, StribeckLaw)
    kind = "Stribeck" if stribeck else "transition"
    viscous = f"ln(viscous {domain.quantity} at the Stribeck speed / Coulomb)"
    of_heat, of_transition = _of_temperature(law, data.reference_kelvin)
    named: list[_Named] = [
        *_of_level(law, w, domain),
        *of_heat,
        ("c", "c of the film" if isinstance(law, ConstantPlusLaw) else "c", "", float),
        *(
            (f"c{i}", f"c at {convert(float(kelvin), 'K', 'degC'):.0f} degC", "", float)
            for i, kelvin in enumerate(data.temperatures, 1)
        ),
        ("c_mixed", "c below the transition", "", float),
        ("stick", "ln(Stribeck peak / Coulomb)", "", float),
        *([("viscous", viscous, "", float)] if stribeck else []),
        ("at", f"{kind} speed", domain.speed_unit, lambda v: w * _exp(v)),
        *of_transition,
    ]
    index = {name: i for i, name in enumerate(law.names)}
    return tuple(Quantity(name, unit, index[p], of) for p, name, unit, of in named if p in index)


def _of_level(law: AnyLaw, w: float, domain: Domain) -> list[_Named]:
    """What stands for the level of a law, or of its parts, at a reference speed (SI)."""
    of, unit = domain.quantity, domain.unit
    if isinstance(law, StribeckLaw):
        return [("level", f"Coulomb {of}", unit, _exp)]
    if isinstance(law, ConstantPlusLaw):
        return [
            ("level", f"{of} of the film at reference", unit, _exp),
            ("rest", f"constant {of} over that of the film at reference", "", _exp),
            ("viscous", f"viscous {of} over that of the film at reference", "", _exp),
        ]
    if isinstance(law, SharedLoadLaw):
        stated, torque = law.contact.stated, law.torque
        return [
            ("viscosity", "viscosity over that stated", "", _exp),
            ("roughness", "roughness of both faces, rms", "m", lambda v: stated["roughness"] * _exp(v)),
            ("boundary", "boundary friction", "", lambda v: stated["boundary"] * _exp(v)),
            ("rest", "constant torque", "N m", lambda v: torque * v),
        ]
    if not domain.is_torque:
        return [("level", f"{of} at {domain.at(w)}", unit, _exp)]
    return [("level", "damping at reference", domain.damping_unit, lambda v: _exp(v) / w)]


def _of_temperature(law: AnyLaw, kelvin: float | None) -> tuple[list[_Named], list[_Named]]:
    """What stands for temperature in a law, and in its transition, at a reference temperature (K)."""
    if not law.thermal or kelvin is None:
        return [], []
    of_film = isinstance(law, ConstantPlusLaw)
    by_energy = law.thermal.kind in (ARRHENIUS, VFT)
    per_unit = law.thermal.energy(kelvin) / 1e3 if by_energy else 1.0
    named: list[_Named] = [("e", "b of the film" if of_film else "b", "", float)]
    moved: list[_Named] = [("d", "exponent of the transition speed in temperature", "", float)]
    if by_energy:
        of_what = {Law: "torque", ConstantPlusLaw: "torque of the film"}.get(type(law), "viscosity")
        named = [("e", f"activation energy of {of_what}", "kJ/mol", lambda v: per_unit * v)]
        moved = [("d", "activation energy of the transition speed", "kJ/mol", lambda v: -per_unit * v)]
    named.append(("q", "T0", "K", lambda v: kelvin - 1.0 / v))
    return named, moved if isinstance(law, Law) and law.branches == FREE else []


def estimates(
    fit: LawFit, data: Observations, *, draws: FloatArray | None = None, profile: bool = True
) -> tuple[ParameterEstimate, ...]:
    """Return every quantity of a fit with its intervals.

    Parameters
    ----------
    draws
        Values of resampled fits, from `resampled`; without them there is no bootstrap interval.
    profile
        Whether to follow the profile likelihood.
    """
    lost = not_identified(fit, data) | {n: why for n in fit.law.names if (why := fit.not_estimable(n))}
    out = []
    for q in quantities(fit, data):
        name, value = fit.law.names[q.parameter], float(fit.values[q.parameter])
        if name in lost:
            out.append(ParameterEstimate(q.name, q.unit, q.of(value), None, {}, lost[name]))
            continue
        raw = _intervals(fit, data, q.parameter, draws, profile)
        if "profile" in raw and not np.all(np.isfinite(raw["profile"])):
            out.append(ParameterEstimate(q.name, q.unit, q.of(value), None, {}, _open(raw["profile"])))
            continue
        error = fit.error(name)
        step = 1e-4 * max(error, 1e-12)
        slope = abs(q.of(value + step) - q.of(value - step)) / (2 * step)
        ends = {method: _mapped(q.of, limits) for method, limits in raw.items()}
        out.append(ParameterEstimate(q.name, q.unit, q.of(value), slope * error, ends))
    return tuple(out)


def profile_interval(fit: LawFit, data: Observations, parameter: int) -> Ends:
    """Return where the profile of the cost crosses t^2 on either side; infinite where it never does."""
    target = quantile(fit.freedom_of(fit.law.names[parameter])) ** 2
    error = fit.error(fit.law.names[parameter])
    if not error > 0:  # exact data
        return float(fit.values[parameter]), float(fit.values[parameter])
    below, above = (_crossing(fit, data, parameter, side * error, target) for side in (-1.0, 1.0))
    return below, above


def bootstrap_draws(fit: LawFit, data: Observations, count: int = 400, seed: int = 1) -> FloatArray:
    """Return values of fits to resampled clusters, shape (count, parameters)."""
    return resampled(fit, data, count, seed)


def band(fit: LawFit, inputs: Inputs) -> Band:
    """Return the torque of a fit at inputs, the median of what one would measure, with its limits."""
    dwell = of_one_dwell(fit.scatter, float(np.median(fit.errors)), fit.shared)
    return band_of(fit.law, fit.values, fit.freedoms, dwell, inputs)


def of_one_dwell(scatter: float, error: float, shared: tuple[SharedScatter, ...]) -> float:
    """Return the relative error of one further dwell, in a visit and a run of its own."""
    return float(np.sqrt(scatter**2 + error**2 + shared_variance(shared)))


def band_of(law: AnyLaw, values: FloatArray, freedom: Freedom, dwell: float, inputs: Inputs) -> Band:
    """Return the torque of a law at inputs with its limits; ``dwell`` is the relative error of one dwell."""
    slopes = law.jacobian(values, inputs)
    centre = law.predict(values, inputs)
    variance = np.einsum("ij,jk,ik->i", slopes, freedom.covariance, slopes)
    reach = np.array([quantile(freedom.of(row)) for row in slopes])
    of_law, of_dwell = reach * np.sqrt(variance), reach * np.sqrt(variance + dwell**2)
    return Band(
        np.exp(centre),
        (np.exp(centre - of_law), np.exp(centre + of_law)),
        (np.exp(centre - of_dwell), np.exp(centre + of_dwell)),
    )


def _intervals(
    fit: LawFit, data: Observations, parameter: int, draws: FloatArray | None, profile: bool
) -> dict[str, Ends]:
    freedom = fit.freedom_of(fit.law.names[parameter])
    value, reach = float(fit.values[parameter]), quantile(freedom)
    out = {}
    clusters = np.unique(data.cluster).size
    of_clusters = quantile(min(clusters - fit.values.size, freedom))
    by = ("covariance", fit.covariance, reach), ("clustered", fit.clustered, of_clusters)
    for method, covariance, width in by:
        error = float(np.sqrt(max(covariance[parameter, parameter], 0.0)))
        out[method] = value - width * error, value + width * error
    if profile:
        out["profile"] = profile_interval(fit, data, parameter)
    if draws is not None:
        low, high = np.quantile(draws[:, parameter], [0.5 - CONFIDENCE / 2, 0.5 + CONFIDENCE / 2])
        widened = np.sqrt(clusters / max(clusters - fit.values.size, 1))
        widened *= of_clusters / float(normal_quantile(0.5 + CONFIDENCE / 2))
        out["bootstrap"] = value - widened * (value - float(low)), value + widened * (float(high) - value)
    return out


def _crossing(fit: LawFit, data: Observations, parameter: int, error: float, target: float) -> float:
    """Follow the profile outward in steps; the last crossing within reach, interpolated."""
    value = float(fit.values[parameter])
    start = np.append(fit.values, fit.effects)
    kinked = fit.law.broken and fit.law.names[parameter] in ("at", "c_mixed")
    warm, inside, outside = start, 0.0, None
    before, rise_before = 0.0, 0.0
    for step in np.arange(_STEP, _FARTHEST * np.sqrt(target) / 2.0, _STEP):
        minimum = search(
            fit.law,
            data,
            fit.disturbances,
            fit.sigma,
            warm,
            held=(parameter, value + step * error),
            effort=Effort(1e-7),
        )
        rise = minimum.cost - fit.cost
        if rise < target:
            inside, outside = step, None
        elif outside is None:
            outside = before + _STEP * (np.sqrt(target) - rise_before) / max(
                np.sqrt(rise) - rise_before, 1e-12
            )
        if outside is not None and (not kinked or step > inside + 1.5):
            return value + error * float(outside)
        warm, before, rise_before = minimum.values, float(step), float(np.sqrt(max(rise, 0.0)))
    return float(np.sign(error) * np.inf)


def _exp(value: float) -> float:
    """Exponential that ends at the largest number."""
    return float(np.exp(np.minimum(value, 700.0)))


def _open(ends: Ends) -> str:
    side = "either side" if not np.any(np.isfinite(ends)) else ("above" if np.isinf(ends[1]) else "below")
    return f"the data do not bound it from {side}. Record more temperatures and slower and faster speeds"


def _mapped(of: Callable[[float], float], ends: Ends) -> Ends:
    mapped = sorted(of(end) for end in ends)
    return mapped[0], mapped[1]


def likelihood_ratio(smaller: LawFit, larger: LawFit) -> float:
    """Return the p-value of a law against one that contains it, by an F test on the larger's scatter."""
    more = larger.values.size - smaller.values.size
    gain = max(smaller.deviance - larger.deviance, 0.0)
    n = larger.residuals.size
    ratio = np.expm1(gain / n) * larger.freedom / max(more, 1)
    return float(ratio_above(ratio, more, larger.freedom))
