"""Whether the numbers of a saved fit can be those of a fit: in range, and equal to what follows from others.

What follows from nothing in the file (e.g. the AICc, what sensors may add) is held to its range alone.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.thermal import scaled_temperature
from hersey.damping.estimate import quantile
from hersey.damping.soundness import (
    AGREES,
    LARGEST,
    Fault,
    agree,
    faults_of_covariance,
    faults_of_estimate,
    faults_of_range,
    faults_of_rest,
)
from hersey.damping.surface import DampingSurface
from hersey.document.parts.fit import FitPart
from hersey.document.parts.log import Point

#: No relative scatter or error of a dwell is greater.
_MOST_SCATTER = 10.0
#: Friction heats no film above what was read by more, K.
_MOST_HEATING = 200.0
#: The torque at a gradual bend differs from that of the trend lines by less, in its logarithm.
_MOST_LIFT = 2.0


def faults_of_fit(surface: DampingSurface, fit: FitPart, points: list[Point]) -> Iterator[Fault]:
    """Yield what no fit has: the key, and what it must be. Sizes of arrays are known to be right."""
    yield from _ranges(surface, fit)
    for name, part in zip(fit.variables, fit.values, strict=True):
        if abs(part) > LARGEST:
            yield "values", f"at most {LARGEST:g} ({name})"
    yield from _coefficients(surface)
    yield from _transition(surface)
    if surface.rest is not None:
        yield from ((f"rest.{key}", asked) for key, asked in faults_of_rest(surface.rest))
    if points:
        yield from _points(surface, points)


def _ranges(surface: DampingSurface, fit: FitPart) -> Iterator[Fault]:
    size, stated = len(fit.values), surface.statistics
    yield from faults_of_covariance("covariance", surface.covariance, size)
    for part in surface.freedoms.parts:
        yield from faults_of_covariance("variance_parts", part, size)
    estimated = 1 + sum(shared.deviation > 0 for shared in stated.shared)
    if surface.freedoms.parts and len(surface.freedoms.parts) != estimated:
        yield "variance_parts", "one for the dwells and one for each nonzero entry of shared"
    if surface.freedoms.parts:
        count = len(surface.freedoms.parts)
        yield from faults_of_covariance("variance_uncertainty", surface.freedoms.uncertainty, count)
    yield from faults_of_range("speed_range", surface.speed_range)
    yield from faults_of_range("temperature_range", surface.temperature_range)
    if not 0.0 <= stated.chi_square <= LARGEST:
        yield "chi_square", f"from 0 to {LARGEST:g}"
    if not agree(stated.reduced_chi_square, stated.chi_square / (stated.points - size)):
        yield "reduced_chi_square", "chi_square divided by (points - values)"
    for name in ("scatter", "dwell_error"):
        if not 0.0 <= getattr(stated, name) <= _MOST_SCATTER:
            yield name, f"from 0 to {_MOST_SCATTER:g}"
    for shared in stated.shared:
        if not (0.0 <= shared.deviation <= _MOST_SCATTER and 0.0 <= shared.p_value <= 1.0):
            yield "shared", f"deviations from 0 to {_MOST_SCATTER:g} and probabilities from 0 to 1"
    if abs(stated.aicc) > LARGEST:
        yield "aicc", f"at most {LARGEST:g}"
    for name in ("r_squared_damping", "r_squared_torque"):
        if not -LARGEST <= getattr(stated, name) <= 1.0:
            yield name, "at most 1"


def _coefficients(surface: DampingSurface) -> Iterator[Fault]:
    """Those of the law and of the fit in torque space, whose degrees of freedom are the same."""
    weights, value = _log_a(surface)
    names = {"a": weights}
    for name, index in (("b", 1), ("c", 1 + (surface.b is not None))):
        if name in surface.torque_space:
            names[name] = np.eye(surface.values.size)[index]
    own = {"a": surface.a, "b": surface.b, "c": surface.c}
    for name, of in names.items():
        scale = "log" if name == "a" else "linear"
        freedom, estimated = surface.freedoms.of(of), own[name]
        assert estimated is not None
        for key, part in (
            (f"coefficients.{name}", estimated),
            (f"torque_space.{name}", surface.torque_space[name]),
        ):
            if name == "a" and not part.value > 0.0:
                yield f"{key}.value", "greater than 0"
                continue
            yield from faults_of_estimate(key, part, scale)
            if not agree(part.freedom, freedom):
                yield f"{key}.freedom", "consistent with the covariance and its parts"
        with np.errstate(over="ignore"):
            expected = float(np.exp(value)) if name == "a" else float(of @ surface.values)
        if not agree(estimated.value, expected):
            yield f"coefficients.{name}", "consistent with values"
        variance = float(of @ surface.covariance @ of)
        error = max(variance, 0.0) ** 0.5 * (expected if name == "a" else 1.0)
        if not np.isclose(estimated.error, error, rtol=1e-6, atol=1e-9 * abs(expected)):
            yield f"coefficients.{name}.error", "consistent with covariance"
        if surface.torque_space[name].systematic != 0.0:
            yield f"torque_space.{name}.systematic", "0"


def _log_a(surface: DampingSurface) -> tuple[FloatArray, float]:
    """Weights of the values in ln a, and ln a: ln B at 1 rad/s and 1 degree less all others."""
    weights, thermal = np.zeros(surface.values.size), surface.b is not None
    weights[0], weights[1 + thermal] = 1.0, -float(np.log(surface.reference_speed))
    if thermal:
        scaled = scaled_temperature(np.asarray(surface.reference_temperature), surface.temperature_scale)
        weights[1] = -float(np.log(scaled))
    return weights, float(weights @ surface.values)


def _transition(surface: DampingSurface) -> Iterator[Fault]:
    if (found := surface.transition) is None:
        return
    size = surface.values.size
    mixed, at = (np.eye(size)[size - left] for left in ((2, 1) if found.freed is None else (3, 2)))
    yield from faults_of_estimate("transition.speed", found.speed, "neither")
    scale = "linear" if found.closure is not None else "neither"
    yield from faults_of_estimate("transition.mixed_exponent", found.mixed_exponent, scale)
    low, high = found.speed.low, found.speed.high
    if np.isfinite(low) != np.isfinite(high):
        yield "transition.speed", "with both ends of its interval, or none"
    if np.isfinite(low) and np.isfinite(high):
        reach = quantile(surface.freedoms.of(at))
        if not low > 0.0:
            yield "transition.speed.low", "greater than 0"
        elif not agree(found.speed.error, found.speed.value * float(np.log(high / low)) / (2.0 * reach)):
            yield "transition.speed.error", "consistent with its interval"
    part = found.mixed_exponent
    if np.isfinite(part.freedom) and not agree(part.freedom, surface.freedoms.of(mixed)):
        yield "transition.mixed_exponent.freedom", "consistent with the covariance and its parts"
    if part.estimable and not agree(part.error, (part.high - part.low) / (2.0 * quantile(part.freedom))):
        yield "consistent with its interval", "what its interval gives"
    error = max(float(mixed @ surface.covariance @ mixed), 0.0) ** 0.5
    if found.closure is not None and not agree(part.error, error):
        yield "consistent with covariance", "what follows from covariance"
    if not 0.0 < found.evidence <= LARGEST:
        yield "transition.evidence", "greater than 0"
    if found.freed is not None and not 0.0 < found.freed <= LARGEST:
        yield "transition.freed", "greater than 0"
    if found.closure is not None:
        yield from _closure(surface)


def _closure(surface: DampingSurface) -> Iterator[Fault]:
    assert surface.transition is not None
    closure, speed = surface.transition.closure, surface.transition.speed
    assert closure is not None
    yield from faults_of_covariance("transition.closure.covariance", closure.covariance, surface.values.size)
    if not agree(closure.values[1:-1], surface.values[1:-1]):
        yield "the same exponents as in values", "the exponents of values"
    if not abs(closure.values[0] - surface.values[0]) <= _MOST_LIFT:
        yield "transition.closure.values", "a torque close to that of values"
    if speed.estimable and not agree(
        float(np.sqrt(abs(closure.covariance[-1, -1]))), speed.error / speed.value
    ):
        yield "transition.closure.covariance", "the relative error of transition.speed as its last entry"


def _points(surface: DampingSurface, points: list[Point]) -> Iterator[Fault]:
    """The dwells, and what the fit says of them."""
    if len(points) != surface.statistics.points:
        yield "points", "as many as the document has"
        return
    speed, torque, residual = (
        np.array([getattr(p, n) for p in points]) for n in ("speed", "torque", "residual")
    )
    kelvin = np.array([np.nan if p.temperature is None else p.temperature for p in points])
    heats = surface.temperature_range is not None
    if np.any(speed == 0.0) or np.any(torque / speed <= 0.0) or (heats and not np.all(kelvin > 0.0)):
        yield "points", "dwells with speed, with torque of the same sign, above 0 K"
        return
    if not agree(np.array(surface.speed_range), np.array([np.abs(speed).min(), np.abs(speed).max()])):
        yield "speed_range", "lowest and highest speed of the document's points"
        return
    heating = _heating(surface, kelvin)
    if not 0.0 <= heating <= _MOST_HEATING:
        yield "temperature_range", "lowest and highest temperature of the document's points"
        return
    damping, fitted = (np.array([getattr(p, n) for p in points]) for n in ("damping", "damping_fitted"))
    if np.any(wrong := ~np.isclose(damping, torque / speed, rtol=AGREES)):
        yield "torque divided by speed", "torque over speed"
    lines = [] if heating else _lines(surface, np.abs(speed), kelvin)
    if lines and np.any(wrong := ~np.any([np.isclose(fitted, line, rtol=AGREES) for line in lines], axis=0)):
        yield "consistent with the fit", "what the fit gives"
    wrong = np.abs(residual - np.log(damping / np.where(fitted > 0, fitted, 1.0))) > 1e-6 * np.maximum(
        np.abs(residual), 1e-3
    )
    if np.any(wrong):
        yield f"points.{int(np.argmax(wrong))}.residual", "ln(damping/damping_fitted)"
        return
    stated, sizes = surface.statistics, np.abs(torque)
    for name, measured in (("r_squared_torque", sizes), ("r_squared_damping", sizes / np.abs(speed))):
        total = float(np.sum((measured - measured.mean()) ** 2))
        left = float(np.sum((measured * -np.expm1(-residual)) ** 2))
        expected_share = 1.0 - left / total if total > 0 else 0.0
        if not np.isclose(getattr(stated, name), expected_share, rtol=1e-6, atol=1e-9):
            yield name, "consistent with the document's points"


def _heating(surface: DampingSurface, kelvin: FloatArray) -> float:
    """By how much a fit has taken the film as warmer than what was read, at most, K; 0 if it has not."""
    if surface.temperature_range is None:
        return 0.0
    ends = np.array([kelvin.min(), kelvin.max()])
    away = np.array(surface.temperature_range) - ends
    if agree(np.array(surface.temperature_range), ends):
        return 0.0
    return float(away.max() if away.min() >= 0.0 else -LARGEST)


def _lines(surface: DampingSurface, speed: FloatArray, kelvin: FloatArray) -> list[FloatArray]:
    """Damping at the dwells, N m s/rad; of a gradual bend on either branch, to which each dwell is held."""
    heats = surface.b is not None
    found = surface.transition
    if found is None or found.closure is None:
        with warnings.catch_warnings():  # a range that agrees to rounding
            warnings.simplefilter("ignore")
            return [surface.damping(speed=speed, temperature=kelvin if heats else None)]
    warm = np.zeros(speed.size)
    if heats:
        scaled, reference = (
            scaled_temperature(np.asarray(each), surface.temperature_scale)
            for each in (kelvin, surface.reference_temperature)
        )
        warm = np.log(scaled / reference)
    z = np.log(speed / surface.reference_speed)
    level, c = surface.values[0] + (surface.b.value if surface.b else 0.0) * warm, surface.c.value
    meeting = np.log(found.meeting_speed / surface.reference_speed) + found.temperature_exponent * warm
    return [
        np.asarray(np.exp(level + c * z)),
        np.asarray(np.exp(level + c * meeting + found.mixed_exponent.value * (z - meeting))),
    ]
