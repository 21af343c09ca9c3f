"""Which parameters can be estimated from a record, and which only together."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hersey.arrays import FloatArray
from hersey.schema.warning import Warning

#: A parameter is estimable if its relative standard error (that of an exponent: absolute) is below this.
ESTIMABLE = 0.2
#: Kind of the warnings that name what is not.
NOT_ESTIMABLE = "not estimable"
#: A parameter takes part in a direction if its share of the unit vector is at least this.
_PART = 0.25


class Direction(NamedTuple):
    """A direction in the space of parameters: exponents of a product, and its relative standard error."""

    exponents: dict[str, float]
    error: float

    def __str__(self) -> str:
        """Return the product as text."""
        return " x ".join(f"{name}^{power:+.2f}" for name, power in self.exponents.items())


def directions(names: tuple[str, ...], covariance: FloatArray) -> list[Direction]:
    """Return the principal directions of a covariance of logarithms, the least known first.

    These are the singular vectors of the scaled Jacobian, and the errors the inverses of its singular values.
    """
    variances, vectors = np.linalg.eigh(covariance)
    principal = []
    for variance, vector in sorted(zip(variances, vectors.T, strict=True), key=lambda pair: -pair[0]):
        turned = vector * np.sign(vector[np.argmax(np.abs(vector))])
        parts = {n: float(v) for n, v in zip(names, turned, strict=True) if abs(v) >= _PART}
        principal.append(Direction(parts, float(np.sqrt(max(variance, 0.0)))))
    return principal


def not_estimable(names: tuple[str, ...], covariance: FloatArray) -> list[Warning]:
    """Return a warning for each direction that is not known: what the record leaves open."""
    found: dict[str, Warning] = {}
    for direction in directions(names, covariance):
        if direction.error < ESTIMABLE:
            break
        involved = tuple(direction.exponents)
        if len(involved) == 1:
            warning = _of_one(involved[0])
        elif len(involved) == 2:
            warning = _of_a_pair(involved, direction, names, covariance)
        else:
            warning = Warning(
                NOT_ESTIMABLE,
                "{parameters} can only be estimated together: they can change at once without changing "
                "the record",
                severity="watch",
                parameters=_listed(involved),
            )
        found.setdefault(str(warning), warning)
    return list(found.values())


def _of_one(name: str) -> Warning:
    return Warning(
        NOT_ESTIMABLE,
        "the record hardly depends on the {parameters}",
        severity="watch",
        parameters=name.replace("_", " "),
    )


def _of_a_pair(
    pair: tuple[str, ...], direction: Direction, names: tuple[str, ...], covariance: FloatArray
) -> Warning:
    """What is known of two parameters: the product that keeps its value along the direction, or nothing."""
    first, second = pair
    weights = direction.exponents[second], -direction.exponents[first]
    scale = max(weights, key=abs)
    powers = dict(zip(pair, (weight / scale for weight in weights), strict=True))
    picked = np.array([powers.get(name, 0.0) for name in names])
    error = float(np.sqrt(max(picked @ covariance @ picked, 0.0)))
    if error < ESTIMABLE:
        return Warning(
            NOT_ESTIMABLE,
            "{parameters} can only be estimated as the product {product} (to {error:.1%})",
            severity="watch",
            parameters=_listed(pair),
            product=" x ".join(_power(name, power) for name, power in powers.items()),
            error=error,
        )
    return Warning(
        NOT_ESTIMABLE,
        "{parameters} cannot be estimated, nor can their product",
        severity="watch",
        parameters=_listed(pair),
    )


def _listed(names: tuple[str, ...]) -> str:
    labels = [name.replace("_", " ") for name in names]
    return f"{', '.join(labels[:-1])} and {labels[-1]}"


def _power(name: str, power: float) -> str:
    if name.endswith("exponent"):  # enters as its exponential: the logarithm of a force changes with it
        return f"exp({power:.2g} {name.replace('_', ' ')})"
    return name.replace("_", " ") + ("" if abs(power - 1) < 5e-3 else f"^{power:.2g}")
