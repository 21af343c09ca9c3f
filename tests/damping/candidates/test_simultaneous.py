"""Problems solved at once end where each ends alone, by MINPACK."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.likelihood import minimise
from hersey.damping.candidates.simultaneous import minimise_each

X = np.linspace(0.0, 2.0, 25)


def curve(values: FloatArray) -> FloatArray:
    """A decay onto a level, of values of shape (..., 3)."""
    level, size, rate = (values[..., i, None] for i in range(3))
    return np.asarray(level + size * np.exp(-rate * X))


def slopes(values: FloatArray) -> FloatArray:
    _, size, rate = (values[..., i, None] for i in range(3))
    decay = np.exp(-rate * X)
    return np.stack([np.ones_like(decay), decay, -size * X * decay], axis=-1)


def measured(random: np.random.Generator, problems: int) -> FloatArray:
    truth = np.array([0.3, 2.0, 1.5]) * random.uniform(0.5, 2.0, (problems, 3))
    noise = 0.02 * random.standard_normal((problems, X.size))
    noise[:, 3] += 0.3  # a bad point in each
    return (curve(truth) + noise) / 0.02


@pytest.mark.parametrize("precision", [1e-4, 1e-10])
@pytest.mark.parametrize("far", [0.1, 3.0])
def test_each_ends_where_it_ends_alone(far: float, precision: float) -> None:
    random = np.random.default_rng(3)
    y = measured(random, 30)
    start = np.array([0.3, 2.0, 1.5]) * np.exp(far * random.standard_normal((30, 3)))
    times = random.integers(0, 3, y.shape).astype(float)

    def residual(values: FloatArray, which: IntArray) -> FloatArray:
        return y[which] - curve(values) / 0.02

    def jacobian(values: FloatArray, _: IntArray) -> FloatArray:
        return -slopes(values) / 0.02

    found = minimise_each(residual, jacobian, start, times, precision=precision, calls=40)
    for each in range(30):
        rows = np.repeat(np.arange(X.size), times[each].astype(int))
        alone = minimise(
            lambda values, rows=rows, each=each: (y[each] - curve(values) / 0.02)[rows],
            lambda values, rows=rows: (-slopes(values) / 0.02)[rows],
            start[each],
            precision=precision,
        )
        assert found.cost[each] == pytest.approx(alone.cost, rel=1e-9)
        np.testing.assert_allclose(found.values[each], alone.values, rtol=1e-6)


def test_a_parameter_that_moves_nothing_stays() -> None:
    y = measured(np.random.default_rng(5), 4)

    def residual(values: FloatArray, which: IntArray) -> FloatArray:
        return y[which] - curve(values[:, :3]) / 0.02

    def jacobian(values: FloatArray, _: IntArray) -> FloatArray:
        return np.concatenate([-slopes(values[:, :3]) / 0.02, np.zeros((len(values), X.size, 1))], axis=2)

    start = np.tile([0.3, 2.0, 1.5, 7.0], (4, 1))
    found = minimise_each(residual, jacobian, start, np.ones_like(y), precision=1e-9, calls=40)
    assert np.all(found.values[:, 3] == 7.0)
    assert np.all(found.cost < 300.0)


def test_problems_that_are_solved_stay_where_they_are() -> None:
    values = np.array([[0.3, 2.0, 1.5], [0.5, 1.0, 2.5]])
    y = curve(values) / 0.02
    called: list[int] = []

    def residual(now: FloatArray, which: IntArray) -> FloatArray:
        called.append(which.size)
        return y[which] - curve(now) / 0.02

    found = minimise_each(
        residual, lambda now, _: -slopes(now) / 0.02, values, np.ones_like(y), precision=1e-9, calls=40
    )
    assert np.array_equal(found.values, values)
    assert np.all(found.cost == 0.0)
    assert len(called) == 3
