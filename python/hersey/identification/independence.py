"""Which parameters a fit tells apart, and in words which only together."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hersey.arrays import FloatArray

#: A parameter is told if its relative standard error (that of an exponent: absolute) is below this.
TOLD = 0.2
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


def in_words(names: tuple[str, ...], covariance: FloatArray) -> list[str]:
    """Say for each direction that is not known what the record cannot tell."""
    sentences = []
    for direction in directions(names, covariance):
        if direction.error < TOLD:
            break
        involved = list(direction.exponents)
        labels = [name.replace("_", " ") for name in involved]
        if len(involved) == 1:
            sentences.append(f"the record hardly depends on the {labels[0]}")
            continue
        together = f"{', '.join(labels[:-1])} and {labels[-1]}"
        if len(involved) == 2:
            one, two = involved
            weights = direction.exponents[two], -direction.exponents[one]
            scale = max(weights, key=abs)
            a, b = weights[0] / scale, weights[1] / scale
            picked = np.array([a * (n == one) + b * (n == two) for n in names])
            error = float(np.sqrt(max(picked @ covariance @ picked, 0.0)))
            product = f"{_power(one, a)} x {_power(two, b)}"
            if error < TOLD:
                sentences.append(f"{together} only as the product {product} (to {error:.1%})")
            else:
                sentences.append(f"{together}: neither is told, nor a product of them")
        else:
            sentences.append(
                f"{together} only together: they can change at once and leave the record as it is"
            )
    return list(dict.fromkeys(sentences))


def _power(name: str, power: float) -> str:
    if name.endswith("exponent"):  # enters as its exponential: the logarithm of a force changes with it
        return f"exp({power:.2g} {name.replace('_', ' ')})"
    return name.replace("_", " ") + ("" if abs(power - 1) < 5e-3 else f"^{power:.2g}")
