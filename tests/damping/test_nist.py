"""NIST StRD nonlinear sets of the power and exponential families, through the machinery of the candidates.

Certified values: NIST Statistical Reference Datasets. lmfit fits the same data in the same test.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from hersey.damping.candidates.likelihood import minimise
from tests.conftest import shared

Array = NDArray[np.float64]
Model = Callable[[Array, Array], Array]

MODELS: dict[str, Model] = {
    "Misra1a": lambda b, x: b[0] * (1 - np.exp(-b[1] * x)),
    "Misra1b": lambda b, x: b[0] * (1 - (1 + b[1] * x / 2) ** -2.0),
    "Misra1c": lambda b, x: b[0] * (1 - (1 + 2 * b[1] * x) ** -0.5),
    "Misra1d": lambda b, x: b[0] * b[1] * x / (1 + b[1] * x),
    "Chwirut1": lambda b, x: np.exp(-b[0] * x) / (b[1] + b[2] * x),
    "Chwirut2": lambda b, x: np.exp(-b[0] * x) / (b[1] + b[2] * x),
    "DanWood": lambda b, x: b[0] * x ** b[1],
    "BoxBOD": lambda b, x: b[0] * (1 - np.exp(-b[1] * x)),
    "MGH10": lambda b, x: b[0] * np.exp(b[1] / (x + b[2])),
    "MGH17": lambda b, x: b[0] + b[1] * np.exp(-x * b[3]) + b[2] * np.exp(-x * b[4]),
    "Lanczos1": lambda b, x: sum(b[2 * i] * np.exp(-b[2 * i + 1] * x) for i in range(3)),
    "Lanczos2": lambda b, x: sum(b[2 * i] * np.exp(-b[2 * i + 1] * x) for i in range(3)),
    "Lanczos3": lambda b, x: sum(b[2 * i] * np.exp(-b[2 * i + 1] * x) for i in range(3)),
    "Bennett5": lambda b, x: b[0] * (b[1] + x) ** (-1 / b[2]),
    "Rat42": lambda b, x: b[0] / (1 + np.exp(b[1] - b[2] * x)),
    "Rat43": lambda b, x: b[0] / (1 + np.exp(b[1] - b[2] * x)) ** (1 / b[3]),
    "Nelson": lambda b, x: b[0] - b[1] * x[0] * np.exp(-b[2] * x[1]),
}
#: Lanczos1 is exact to 14 digits: its residual sum of squares is rounding, as NIST says itself.
EXACT = {"Lanczos1"}


@dataclass(frozen=True)
class Certified:
    """A set with its two starts and its certified values and standard errors."""

    x: Array
    y: Array
    starts: tuple[Array, Array]
    values: Array
    errors: Array
    squares: float


def read(name: str) -> Certified:
    text = shared(f"data/nist-strd/{name}.dat").read_text()
    rows = re.findall(r"^\s*b\d+ =\s*(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", text, flags=re.M)
    table = np.array(rows, dtype=float)
    lines = text.splitlines()
    first, last = (int(v) for v in re.search(r"Data\s+\(lines\s+(\d+) to\s+(\d+)\)", text).groups())  # type: ignore[union-attr]
    data = np.array([line.split() for line in lines[first - 1 : last]], dtype=float)
    y, x = data[:, 0], data[:, 1:].T
    squares = float(re.search(r"Residual Sum of Squares:\s+(\S+)", text)[1])  # type: ignore[index]
    if name == "Nelson":
        y = np.log(y)
    starts = table[:, 0], table[:, 1]
    return Certified(x if x.shape[0] > 1 else x[0], y, starts, table[:, 2], table[:, 3], squares)


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", MODELS)
def test_certified_values_to_six_digits(name: str, start: int) -> None:
    known, model = read(name), MODELS[name]

    def residual(values: Array) -> Array:
        with np.errstate(all="ignore"):
            return np.nan_to_num(known.y - model(values, known.x), nan=1e10, posinf=1e10, neginf=-1e10)

    found = minimise(residual, None, known.starts[start], limit=np.inf, precision=1e-14, calls=3000)
    assert found.values == pytest.approx(known.values, rel=1e-6)
    if name not in EXACT:
        assert found.cost == pytest.approx(known.squares, rel=1e-6)
        variance = found.cost / (known.y.size - known.values.size)
        covariance = variance * np.linalg.inv(found.jacobian.T @ found.jacobian)
        assert np.sqrt(np.diag(covariance)) == pytest.approx(known.errors, rel=1e-4)


def test_lmfit_agrees() -> None:
    lmfit = pytest.importorskip("lmfit")
    for name in ("Misra1a", "DanWood", "Chwirut2", "Rat42", "MGH17", "Lanczos3"):
        known, model = read(name), MODELS[name]
        start = known.starts[1]
        parameters = lmfit.Parameters()
        for index, value in enumerate(start):
            parameters.add(f"b{index}", value=value)

        def residual(values: Array, known: Certified = known, model: Model = model) -> Array:
            return np.asarray(known.y - model(values, known.x))

        def of_lmfit(p: object, known: Certified = known, model: Model = model) -> Array:
            return np.asarray(known.y - model(np.array(list(p.valuesdict().values())), known.x))  # type: ignore[attr-defined]

        mine = minimise(residual, None, start, limit=np.inf)
        other = lmfit.minimize(of_lmfit, parameters)
        values = np.array([other.params[f"b{i}"].value for i in range(start.size)])
        assert mine.values == pytest.approx(values, rel=1e-4)
