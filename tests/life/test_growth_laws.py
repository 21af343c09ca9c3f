"""Laws of growth against their formulas, which share no code with them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hersey.life.growth.laws import LAWS

LAW = {law.name: law for law in LAWS}
#: Rate (or size of a growth that ends), age and time constant.
R, T, TAU = 0.6, 0.9, 0.4
Z = (T / TAU) ** 2


@pytest.mark.parametrize(
    ("name", "shapes", "growth"),
    [
        ("side flow", (), math.sqrt(1.0 + R * T)),
        ("linear", (), 1.0 + R * T),
        ("exponential", (), math.exp(R * T)),
        ("saturating", (math.log(TAU),), 1.0 + R * (1.0 - math.exp(-T / TAU))),
        ("curved", (0.7,), (1.0 + 0.7 * R * T) ** (1.0 / 0.7)),
        ("power", (math.log(1.5),), 1.0 + (R * T) ** 1.5),
        ("sigmoid", (math.log(TAU), math.log(2.0)), math.exp(R * Z / (1.0 + Z))),
        (
            "run-in",
            (math.log(TAU), math.log(0.2 / 0.8), math.log(1.5)),
            1.0 - 0.2 * (1.0 - math.exp(-T / TAU)) + (R * T) ** 1.5,
        ),
    ],
)
def test_a_law_is_its_formula(name: str, shapes: tuple[float, ...], growth: float) -> None:
    """A wrong sign of a shape could be in a law and in its inverse alike."""
    found = LAW[name].log_growth(np.log([R]), np.array([T]), np.reshape(shapes, (-1, 1)))
    assert found == pytest.approx(math.log(growth), rel=1e-12)
