"""Shapes of drag curves: their limits, and the values that hand calculation gives."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.damping.curves.shapes import BLEND, PLUS, SATURATING, SHAPES, SHARP, STRIBECK


def test_the_blend_has_its_least_force_at_its_transition() -> None:
    """physics.md, section 7: F(v_t) = F_t is the minimum for every p; F(v_s) of the baseline."""
    x = np.linspace(-5.0, 5.0, 2001)[None, :]
    for p, at_stick in ((1.0, 80.380366), (2.0, 97.608688), (4.0, 110.538879), (8.0, 117.825397)):
        numbers = np.log([[0.3, 0.2, p]])
        curve = BLEND.curve(x, numbers)
        assert curve.min() == pytest.approx(0.0, abs=1e-12)
        assert x[0, int(np.argmin(curve))] == pytest.approx(0.0, abs=1e-9)
        stick = BLEND.curve(np.log([[0.01]]), numbers)
        assert 50.0 * np.exp(stick[0, 0]) == pytest.approx(at_stick, rel=1e-8)


def test_a_very_sharp_blend_is_the_corner() -> None:
    x = np.array([[-4.6, -1.0, -0.5, 0.7, 3.0]])
    corner = np.maximum(0.3 * x, -0.2 * x)
    assert SHARP.curve(x, np.log([[0.3, 0.2]])) == pytest.approx(
        corner, abs=0.016
    )  # ln of the weights of both branches, over p = 60


def test_far_off_each_law_has_its_slope() -> None:
    """Ln F over ln v: the film's exponent above; below, a constant where friction saturates."""
    far = np.array([[20.0, 21.0]])
    film = float(np.log(0.4))
    for shape, numbers in (
        (STRIBECK, [film, 0.0, -1.0, 0.0]),
        (SATURATING, [film, 0.0, -1.0, -2.0]),
        (PLUS, [film, 0.0]),
    ):
        above = np.diff(shape.curve(far, np.array([numbers])))[0, 0]
        below = np.diff(shape.curve(-far[:, ::-1], np.array([numbers])))[0, 0]
        assert above == pytest.approx(0.4, abs=2e-3)
        assert below == pytest.approx(0.0, abs=2e-3)


def test_the_stribeck_peak_stands_on_coulomb_friction() -> None:
    """F = 1 + exp(peak - x^decay) + exp(film) x^up at x = 1: 1 + 2/e + 0.1."""
    found = STRIBECK.curve(np.zeros((1, 1)), np.array([[0.0, np.log(2.0), np.log(0.1), 0.0]]))
    assert np.exp(found[0, 0]) == pytest.approx(1.0 + 2.0 / np.e + 0.1, rel=1e-12)


def test_draws_go_together_row_by_row() -> None:
    x = np.linspace(-2.0, 2.0, 7)
    for shape in SHAPES:
        rng = np.random.default_rng(3)
        numbers = rng.normal(0.0, 0.3, (4, len(shape.priors)))
        together = shape.curve(np.tile(x, (4, 1)), numbers)
        alone = np.vstack([shape.curve(x[None, :], row[None]) for row in numbers])
        assert together == pytest.approx(alone, rel=1e-14)
        assert np.all(np.isfinite(together))
