"""The robust likelihood: Huber's loss by hand, density by quadrature, scatter and deviance by definition."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy import integrate, optimize, stats

from hersey.damping.candidates.likelihood import (
    HUBER,
    central_differences,
    deviance,
    influence,
    log_normalisation,
    loss,
    minimise,
    scatter_beyond,
)
from hersey.errors import InsufficientDataError

#: Residuals of which two are beyond 2.5 of their own errors, and those errors.
RESIDUALS = np.array([0.021, -0.013, 0.034, -0.041, 0.007, 0.29, -0.017, 0.026, -0.22, 0.011])
ERRORS = np.array([0.012, 0.02, 0.015, 0.01, 0.03, 0.014, 0.022, 0.018, 0.011, 0.025])


def loss_by_hand(u: float, limit: float) -> float:
    return u * u if abs(u) <= limit else 2 * limit * abs(u) - limit**2


def test_huber_s_loss_and_influence_by_hand() -> None:
    assert HUBER == 2.5
    u = np.array([-4.0, -2.5, -1.0, 0.0, 0.5, 2.5, 3.0, 10.0])
    assert loss(u, 2.5) == pytest.approx([13.75, 6.25, 1.0, 0.0, 0.25, 6.25, 8.75, 43.75], abs=1e-14)
    assert influence(u, 2.5) == pytest.approx([-2.5, -2.5, -1.0, 0.0, 0.5, 2.5, 2.5, 2.5], abs=0)
    assert loss(u, np.inf) == pytest.approx(u**2, abs=1e-14)


@pytest.mark.parametrize("limit", [0.7, 1.5, 2.5, np.inf])
def test_the_density_is_normalised(limit: float) -> None:
    total = 2 * sum(
        integrate.quad(lambda u: np.exp(-0.5 * loss_by_hand(u, limit)), low, high, epsabs=1e-14)[0]
        for low, high in ((0.0, min(limit, 30.0)), (min(limit, 30.0), 90.0))
    )
    assert log_normalisation(limit) == pytest.approx(np.log(total), abs=1e-10)


def test_robust_centre_of_numbers_with_an_outlier_in_closed_form() -> None:
    x = np.array([1.0, 1.1, 0.9, 1.05, 40.0])
    # four within the limit and one beyond: sum of psi is zero where 4 (mean - v)/s + limit = 0
    expected = np.mean(x[:4]) + 2.5 * 0.1 / 4
    found = minimise(lambda v: (x - v[0]) / 0.1, None, np.array([1.0]))
    assert found.values == pytest.approx([expected], rel=1e-8)
    u = (x - expected) / 0.1
    assert found.cost == pytest.approx(sum(loss_by_hand(v, 2.5) for v in u), rel=1e-9)
    # each row counts as its influence over its residual
    expected_rows = -10.0 * np.sqrt([1, 1, 1, 1, 2.5 / u[4]])
    assert found.jacobian == pytest.approx(expected_rows[:, None], rel=1e-6)


@pytest.mark.parametrize("limit", [1.0, 2.5])
def test_the_minimum_is_that_of_a_search_without_derivatives(limit: float) -> None:
    t = np.linspace(0.0, 3.0, 9)
    y = 2.0 * np.exp(-0.7 * t) + 0.02 * np.array([1, -1, 1, 2, -1, -9, 1, 0, 1])

    def residual(v: np.ndarray) -> np.ndarray:
        return np.asarray((y - v[0] * np.exp(-v[1] * t)) / 0.02)

    def slopes(v: np.ndarray) -> np.ndarray:
        return np.column_stack([-np.exp(-v[1] * t), v[0] * t * np.exp(-v[1] * t)]) / 0.02

    start = np.array([1.5, 0.5])
    slow = optimize.minimize(
        lambda v: sum(loss_by_hand(u, limit) for u in residual(v)),
        start,
        method="Nelder-Mead",
        options={"xatol": 1e-10, "fatol": 1e-12, "maxiter": 4000},
    )
    for jacobian in (slopes, None):
        found = minimise(residual, jacobian, start, limit=limit)
        assert found.values == pytest.approx(slow.x, rel=1e-6)
        assert found.cost == pytest.approx(slow.fun, rel=1e-10)
        u = residual(found.values)
        root = np.sqrt(np.minimum(1.0, limit / np.abs(u)))
        assert found.jacobian == pytest.approx(root[:, None] * slopes(found.values), rel=1e-6, abs=1e-6)


def test_least_squares_without_a_limit() -> None:
    x = np.array([1.0, 1.1, 0.9, 1.05, 40.0])
    found = minimise(lambda v: (x - v[0]) / 0.1, None, np.array([1.0]), limit=np.inf)
    assert found.values == pytest.approx([8.81], rel=1e-9)
    assert found.cost == pytest.approx(100.0 * np.sum((x - 8.81) ** 2), rel=1e-9)
    assert found.jacobian == pytest.approx(np.full((5, 1), -10.0), rel=1e-8)


def test_as_many_residuals_as_parameters_are_enough_and_fewer_are_not() -> None:
    def line(v: np.ndarray) -> np.ndarray:
        return np.array([v[0] + v[1] - 3.0, v[0] - v[1] - 1.0])

    assert minimise(line, None, np.zeros(2)).values == pytest.approx([2.0, 1.0], abs=1e-7)
    with pytest.raises(InsufficientDataError, match=r"^1 points are too few for 2 parameters$"):
        minimise(lambda v: v[:1] - 1.0, None, np.zeros(2))


def test_nothing_is_computed_twice_in_a_row() -> None:
    x, asked = np.linspace(0.0, 2.0, 20), {"residual": list[bytes](), "jacobian": list[bytes]()}

    def residual(values: np.ndarray) -> np.ndarray:
        asked["residual"].append(values.tobytes())
        return values[0] * np.exp(-values[1] * x) - np.exp(-x)

    def jacobian(values: np.ndarray) -> np.ndarray:
        asked["jacobian"].append(values.tobytes())
        decay = np.exp(-values[1] * x)
        return np.column_stack([decay, -values[0] * x * decay])

    found = minimise(residual, jacobian, np.array([0.3, 2.0]))
    assert found.values == pytest.approx([1.0, 1.0], rel=1e-6)
    for calls in asked.values():
        assert len(calls) > 2
        assert all(one != other for one, other in itertools.pairwise(calls))


def test_a_search_ends_after_the_calls_it_is_allowed() -> None:
    count = []

    def valley(v: np.ndarray) -> np.ndarray:
        count.append(1)
        return np.array([10.0 * (v[1] - v[0] ** 2), 1.0 - v[0], 0.0])

    def slopes(v: np.ndarray) -> np.ndarray:
        return np.array([[-20.0 * v[0], 10.0], [-1.0, 0.0], [0.0, 0.0]])

    full = minimise(valley, slopes, np.array([-1.2, 1.0]), limit=np.inf)
    assert full.values == pytest.approx([1.0, 1.0], abs=1e-6)
    whole = len(count)
    count.clear()
    early = minimise(valley, slopes, np.array([-1.2, 1.0]), limit=np.inf, calls=2)
    assert len(count) < whole
    assert early.cost > 1e-3


def test_central_differences_are_derivatives() -> None:
    slopes = central_differences(lambda v: np.array([v[0] ** 2 * v[1], np.sin(v[1]), v[0]]))
    found = slopes(np.array([3.0, -0.4]))
    assert found == pytest.approx(np.array([[-2.4, 9.0], [0.0, np.cos(0.4)], [1.0, 0.0]]), rel=1e-8, abs=1e-9)
    assert slopes(np.array([0.0, 2.0]))[2, 0] == pytest.approx(1.0)
    asked: list[float] = []

    def recorded(v: np.ndarray) -> np.ndarray:
        asked.append(float(v[0]))
        return v

    central_differences(recorded)(np.array([2.0]))
    assert asked == pytest.approx([2.0 + 1.2e-5, 2.0 - 1.2e-5], abs=1e-13)
    asked.clear()
    central_differences(recorded)(np.array([0.0]))
    assert asked == pytest.approx([6e-14, -6e-14], rel=1e-9)


@pytest.mark.parametrize("limit", [1.2, 2.5])
@pytest.mark.parametrize("freedom", [6, 8, 10])
def test_scatter_makes_residuals_as_large_as_chance_has_them(limit: float, freedom: int) -> None:
    expected, _ = integrate.quad(
        lambda u: min(abs(u), limit) ** 2 * stats.norm.pdf(u), -12, 12, points=[-limit, limit]
    )
    scatter = scatter_beyond(RESIDUALS, ERRORS, freedom, limit)
    assert scatter > 0.01
    u = RESIDUALS / np.sqrt(ERRORS**2 + scatter**2)
    total = sum(min(abs(v), limit) ** 2 for v in u)
    assert total == pytest.approx(freedom * expected, rel=1e-8)


def test_scatter_without_a_limit_brings_chi_square_to_its_freedom() -> None:
    scatter = scatter_beyond(RESIDUALS, ERRORS, 8, np.inf)
    assert np.sum(RESIDUALS**2 / (ERRORS**2 + scatter**2)) == pytest.approx(8.0, rel=1e-9)
    alone = scatter_beyond(RESIDUALS, np.zeros(10), 8, np.inf)
    assert alone == pytest.approx(np.sqrt(np.sum(RESIDUALS**2) / 8), rel=1e-9)
    one_unknown = np.append(ERRORS[:9], 0.0)
    scatter = scatter_beyond(RESIDUALS, one_unknown, 8, np.inf)
    assert np.sum(RESIDUALS**2 / (one_unknown**2 + scatter**2)) == pytest.approx(8.0, rel=1e-9)


def test_the_limit_of_scatter_is_huber_s_unless_said() -> None:
    default = scatter_beyond(RESIDUALS, ERRORS, 8)
    assert default == pytest.approx(scatter_beyond(RESIDUALS, ERRORS, 8, 2.5), rel=1e-12)
    assert default != pytest.approx(scatter_beyond(RESIDUALS, ERRORS, 8, np.inf), rel=1e-3)


def test_there_is_no_scatter_where_the_errors_are_enough() -> None:
    assert scatter_beyond(RESIDUALS, 0.2 * np.ones(10), 8) == 0.0
    assert scatter_beyond(np.zeros(10), np.zeros(10), 8) == 0.0
    assert scatter_beyond(np.full(10, 1e-11), np.zeros(10), 8) == 0.0
    # with u = 1 everywhere, eight of ten are more than 8 degrees of freedom have, and 10 less than 11
    assert scatter_beyond(np.full(10, 0.1), np.full(10, 0.1), 11, np.inf) == 0.0
    above = scatter_beyond(np.full(10, 0.1), np.full(10, 0.1), 8, np.inf)
    assert above == pytest.approx(0.1 * np.sqrt(10 / 8 - 1), rel=1e-8)
    hardly = scatter_beyond(np.full(10, 0.1), np.full(10, 0.1), 9.5, np.inf)
    assert hardly == pytest.approx(0.1 * np.sqrt(10 / 9.5 - 1), rel=1e-6)


def test_neither_scatter_nor_deviance_asks_for_a_sign() -> None:
    for limit in (1.2, 2.5, np.inf):
        aside = RESIDUALS - 0.1
        assert np.sum(aside) < 0 < np.sum(-aside)
        one, other = (scatter_beyond(r, ERRORS, 8, limit) for r in (aside, -aside))
        assert one == pytest.approx(other, rel=1e-12)
        assert one > 0.05
        assert deviance(aside, ERRORS, limit) == pytest.approx(deviance(-aside, ERRORS, limit), rel=1e-12)


@pytest.mark.parametrize("limit", [1.2, 2.5, np.inf])
def test_deviance_is_twice_the_negative_log_likelihood_at_its_least(limit: float) -> None:
    total = 2 * sum(
        integrate.quad(lambda u: np.exp(-0.5 * loss_by_hand(u, limit)), low, high, epsabs=1e-14)[0]
        for low, high in ((0.0, min(limit, 30.0)), (min(limit, 30.0), 90.0))
    )

    def minus_twice_log(scatter: float) -> float:
        sigma = np.sqrt(ERRORS**2 + scatter**2)
        each = [
            loss_by_hand(u, limit) + 2 * np.log(total * s)
            for u, s in zip(RESIDUALS / sigma, sigma, strict=True)
        ]
        return float(np.sum(each))

    slow = optimize.minimize_scalar(minus_twice_log, bounds=(0.005, 0.3), options={"xatol": 1e-9})
    cost, scatter = deviance(RESIDUALS, ERRORS, limit)
    assert cost == pytest.approx(slow.fun, abs=1e-8)
    assert scatter == pytest.approx(slow.x, rel=1e-4)


def test_deviance_of_a_normal_sample_in_closed_form() -> None:
    rms = np.sqrt(np.mean(RESIDUALS**2))
    cost, scatter = deviance(RESIDUALS, np.zeros(10), np.inf)
    assert scatter == pytest.approx(rms, rel=1e-5)
    assert cost == pytest.approx(10 * (np.log(2 * np.pi * rms**2) + 1), rel=1e-9)
    errors = np.full(10, 0.3)
    cost, scatter = deviance(RESIDUALS, errors, np.inf)
    assert scatter == 0.0
    by_hand = -2 * np.sum(stats.norm.logpdf(RESIDUALS, scale=0.3))
    assert cost == pytest.approx(by_hand, rel=1e-9)
    # the limit is Huber's unless said
    assert deviance(RESIDUALS, ERRORS) == pytest.approx(deviance(RESIDUALS, ERRORS, 2.5), rel=1e-12)


def test_exact_data_have_the_deviance_of_the_least_error_there_is() -> None:
    cost, scatter = deviance(np.zeros(4), np.zeros(4), np.inf)
    assert scatter == pytest.approx(0.0, abs=1e-9)
    assert cost == pytest.approx(4 * np.log(2 * np.pi * 1e-18), rel=1e-9)
