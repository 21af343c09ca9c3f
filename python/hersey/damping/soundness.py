"""Whether numbers that were read from a file can be what they are called: intervals, covariances, the rest.

Every number that follows from others must agree with them. A fault is a field and what it must be.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.no_load_torque import NUMBERS, NoLoadTorque

#: How far a number may be from the one that it follows from, relative.
AGREES = 1e-6
#: No number of a fit is greater, in SI.
LARGEST = 1e12
#: A field, and what it must be.
Fault = tuple[str, str]


def agree(value: float | FloatArray, expected: float | FloatArray) -> bool:
    """Whether numbers are the same to the digits that are kept."""
    return bool(np.allclose(value, expected, rtol=AGREES, atol=1e-300))


def faults_of_covariance(name: str, matrix: FloatArray, size: int) -> Iterator[Fault]:
    """Yield what keeps a matrix of shape (size, size) from being a covariance."""
    if matrix.shape != (size, size):
        yield name, f"{size} rows of {size} numbers"
        return
    scale = np.sqrt(np.abs(np.diag(matrix)))
    sized = np.where(scale > 0, scale, 1.0)
    alike = matrix / np.outer(sized, sized)  # numbers of several units differ by orders of magnitude
    if not np.all(np.abs(matrix) <= LARGEST):
        yield name, f"numbers up to {LARGEST:g}"
    elif not np.allclose(alike, alike.T, rtol=0.0, atol=AGREES):
        yield name, "symmetric"
    elif np.any(np.diag(matrix) < 0) or float(np.linalg.eigvalsh(alike).min(initial=0.0)) < -AGREES:
        yield name, "without negative variances"


def faults_of_estimate(name: str, part: Estimate, scale: str = "linear") -> Iterator[Fault]:
    """Yield what is wrong with a number and its interval.

    ``scale`` says what the interval is symmetric in: the number (``linear``), its ``log``, or ``neither``
    (that of a profile, of which only the order of low, value and high is checked).
    """
    if not abs(part.value) <= LARGEST:
        yield f"{name}.value", f"at most {LARGEST:g}"
    if not 0.0 <= part.error <= LARGEST:
        yield f"{name}.error", f"from 0 to {LARGEST:g}"
    if not part.freedom > 0.0:
        yield f"{name}.freedom", "greater than 0"
    if not 0.0 <= part.systematic <= LARGEST:
        yield f"{name}.systematic", f"from 0 to {LARGEST:g}"
    if not part.low <= part.value <= part.high:
        yield name, "within its interval"
        return
    reach = quantile(part.freedom) * part.error
    ends = part.value - reach, part.value + reach
    if scale == "log":
        with np.errstate(over="ignore"):
            low, high = (part.value * float(np.exp(by / part.value)) for by in (-reach, reach))
        ends = low, high
    if scale != "neither":
        if np.isfinite(part.low) != np.isfinite(part.high):
            yield name, "with both ends of its interval, or none"
        for end, found, expected in zip(("low", "high"), (part.low, part.high), ends, strict=True):
            if np.isfinite(found) and not np.isclose(found, expected, rtol=AGREES, atol=AGREES * reach):
                yield f"{name}.{end}", "consistent with value, error and freedom"
    elif max(abs(end) for end in (part.low, part.high) if np.isfinite(end)) > LARGEST:
        yield name, f"at most {LARGEST:g}"


def faults_of_range(name: str, ends: tuple[float, float] | None) -> Iterator[Fault]:
    """Yield what is wrong with the ends of a range of speeds or temperatures."""
    if ends is not None and not 0.0 < ends[0] <= ends[1] <= LARGEST:
        yield name, "ascending and greater than 0"


def faults_of_rest(rest: NoLoadTorque) -> Iterator[Fault]:
    """Yield what is wrong with the no-load torque."""
    parts = [getattr(rest, name) for name in NUMBERS]
    for name, part in zip(NUMBERS, parts, strict=True):
        yield from faults_of_estimate(name, part)
    found = list(faults_of_covariance("covariance", rest.covariance, len(NUMBERS)))
    yield from found
    if not found and not agree(np.sqrt(np.diag(rest.covariance)), np.array([part.error for part in parts])):
        yield "covariance", "consistent with the three errors (their squares on its diagonal)"
    if not rest.freedom > 0.0:
        yield "freedom", "greater than 0"
    reference = rest.reference_temperature
    if reference is not None and not 0.0 < reference <= LARGEST:
        yield "reference_temperature", "above 0 K"
    if reference is None and rest.temperature_slope.value != 0.0:
        yield "reference_temperature", "given, because there is a temperature_slope"
    yield from faults_of_range("speed_range", rest.speed_range)
    yield from faults_of_range("temperature_range", rest.temperature_range)
