"""Where the points part: the best falling and rising curves, all of them in one pass."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import optimize

from hersey.damping import branches


def values(seed: int) -> np.ndarray:
    """A valley with noise, and values that are equal."""
    random = np.random.default_rng(seed)
    valley = np.abs(np.linspace(-1.0, 1.0, 40)) + 0.2 * random.standard_normal(40)
    return np.round(valley, 1) if seed % 2 else valley


@pytest.mark.parametrize("seed", range(4))
def test_what_monotonic_curves_leave_is_that_of_a_peer(seed: int) -> None:
    torque = values(seed)
    weights = np.random.default_rng(10 + seed).uniform(0.5, 2.0, torque.size)
    falling, rising = branches._falling_and_rising(torque, weights)
    for i in range(torque.size):
        for found, part, rises in ((falling[i], slice(i + 1), False), (rising[i], slice(i, None), True)):
            curve = optimize.isotonic_regression(torque[part], weights=weights[part], increasing=rises)
            left = float(np.sum(weights[part] * (torque[part] - curve.x) ** 2))
            assert found == pytest.approx(left, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("seed", range(4))
def test_the_best_valley_is_the_best_of_all_tried(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    torque, calls, peer = values(seed), [0], optimize.isotonic_regression

    def counted(*given: Any, **named: Any) -> Any:
        calls[0] += 1
        return peer(*given, **named)

    monkeypatch.setattr(branches.optimize, "isotonic_regression", counted)
    residuals = branches._unimodal_residuals(torque)
    assert calls == [2]
    tried = [
        np.append(peer(torque[:i], increasing=False).x, peer(torque[i:]).x) for i in range(1, torque.size)
    ]
    least = min(float((torque - curve) @ (torque - curve)) for curve in tried)
    assert residuals @ residuals == pytest.approx(least, rel=1e-12)


def test_values_all_alike_have_a_level() -> None:
    assert not branches._unimodal_residuals(np.full(5, 2.0)).any()
    assert not branches._unimodal_residuals(np.full(1, 2.0)).any()
