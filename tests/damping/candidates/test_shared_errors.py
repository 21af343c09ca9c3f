"""Errors that dwells share, against linear algebra and sums written out here: REML, F, degrees of freedom."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize, stats

from hersey.damping.candidates.branched import ONE, Law
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.likelihood import deviance, log_normalisation
from hersey.damping.candidates.observations import Inputs, Observations, _visits
from hersey.damping.candidates.shared_errors import Freedom, SharedScatter, groupings, shared_scatter
from hersey.damping.candidates.thermal import KELVIN, Thermal

REFERENCE = 400.0
SPEEDS = np.geomspace(0.5, 15.0, 6)
ISOTHERMAL = Law(None, ONE)
THERMAL = Law(Thermal(KELVIN, REFERENCE), ONE)
VALUES = {None: [0.1, -0.7], REFERENCE: [0.1, -2.4, -0.7]}


def visited(
    kelvin: list[float] | None,
    *,
    visits: int | None = None,
    between: float = 0.0,
    within: float = 0.01,
    seed: int = 1,
    error: float = 0.0,
    runs: list[int] | None = None,
    tare: np.ndarray | None = None,
    between_runs: float = 0.0,
) -> Observations:
    """Visits of every speed, one to each of these temperatures in their order, scatter as asked for."""
    count = len(kelvin) if kelvin is not None else visits or 0
    visit = np.repeat(np.arange(count), SPEEDS.size)
    speed = np.tile(SPEEDS, count)
    reference = float(np.exp(np.mean(np.log(speed))))
    hot = None if kelvin is None else np.repeat(np.array(kelvin), SPEEDS.size)
    random = np.random.default_rng(seed)
    noise = within * random.standard_normal(speed.size) + (between * random.standard_normal(count))[visit]
    run = np.zeros(count, dtype=np.intp) if runs is None else np.array(runs)
    noise += (between_runs * random.standard_normal(run.max() + 1))[run[visit]]
    z = np.log(speed / reference)
    level = 0.1 + 0.3 * z + (0.0 if hot is None else -2.4 * np.log(hot / REFERENCE))
    means = np.empty(0) if kelvin is None else np.unique(kelvin)
    group = np.zeros(speed.size, dtype=np.intp) if hot is None else np.searchsorted(means, hot)
    return Observations(
        inputs=Inputs(z, hot, group),
        log_torque=level + noise,
        torque_error=np.full(speed.size, error),
        speed_error=np.zeros(speed.size),
        temperature_error=np.zeros(speed.size),
        tare=np.empty((speed.size, 0)) if tare is None else tare,
        visit=visit,
        run=run[visit],
        cluster=np.arange(speed.size),
        clustered_by="level",
        reference_speed=reference,
        reference_kelvin=None if kelvin is None else REFERENCE,
        temperatures=means,
    )


def design(data: Observations) -> np.ndarray:
    """What the parameters of a straight law multiply."""
    z, kelvin = data.inputs.log_speed, data.inputs.kelvin
    columns = [np.ones_like(z), z] if kelvin is None else [np.ones_like(z), np.log(kelvin / REFERENCE), z]
    return np.column_stack(columns)


def straight(data: Observations) -> np.ndarray:
    """Residuals of ordinary least squares."""
    x = design(data)
    return np.asarray(data.log_torque - x @ np.linalg.lstsq(x, data.log_torque, rcond=None)[0])


def scatter_of(data: Observations, sigma: np.ndarray) -> SharedScatter:
    (found,) = shared_scatter(
        groupings(data),
        (SharedScatter("visit", 0.0, 1.0, estimable=True),),
        data,
        design(data),
        np.zeros(len(data)),
        straight(data),
        sigma,
    )
    return found


def one_hot(label: np.ndarray) -> np.ndarray:
    return np.asarray(label[:, None] == np.unique(label)[None, :], dtype=float)


def squares_by_hand(data: Observations) -> tuple[float, int, float, int]:
    """Sum of squares that visits take beyond the law, what they leave, and the degrees of freedom of each."""
    x, y = design(data), data.log_torque
    both = np.column_stack([x, one_hot(data.visit)])

    def left(columns: np.ndarray) -> tuple[float, int]:
        coefficients, _, rank, _ = np.linalg.lstsq(columns, y, rcond=1e-10)
        return float(np.sum((y - columns @ coefficients) ** 2)), int(rank)

    (alone, few), (with_visits, many) = left(x), left(both)
    return alone - with_visits, many - few, with_visits, y.size - many


def test_the_variance_of_a_balanced_layout_is_that_of_the_analysis_of_variance() -> None:
    """Visits of one law of speed: the mean square between less that within, over the dwells of a visit."""
    data = visited(None, visits=7, between=0.05)
    means = (data.log_torque - 0.3 * data.inputs.log_speed).reshape(7, SPEEDS.size).mean(axis=1)
    between = SPEEDS.size * float(np.var(means, ddof=1))
    sigma = 0.012
    found = scatter_of(data, np.full(len(data), sigma))
    assert found.estimable
    assert found.deviation**2 == pytest.approx((between - sigma**2) / SPEEDS.size, rel=1e-4)


def test_the_variance_with_a_law_of_temperature_is_least_in_the_restricted_likelihood() -> None:
    """The likelihood of what no fixed effect explains, by a dense covariance: -2 log as Harville has it."""
    kelvin = [363.0, 363.0, 393.0, 423.0, 423.0, 453.0]
    data = visited(kelvin, between=0.04, seed=3)
    data = data.take(np.delete(np.arange(len(data)), [1, 2, 9, 30]))  # unbalanced
    sigma = np.linspace(0.008, 0.02, len(data))
    x, member, y = design(data), one_hot(data.visit), data.log_torque

    def restricted(log_deviation: float) -> float:
        v = np.diag(sigma**2) + np.exp(2.0 * log_deviation) * member @ member.T
        inverse = np.linalg.inv(v)
        normal = x.T @ inverse @ x
        left = y - x @ np.linalg.solve(normal, x.T @ inverse @ y)
        return float(np.linalg.slogdet(v)[1] + np.linalg.slogdet(normal)[1] + left @ inverse @ left)

    least = optimize.minimize_scalar(restricted, bounds=(np.log(1e-3), np.log(0.5)), method="bounded")
    assert scatter_of(data, sigma).deviation == pytest.approx(np.exp(least.x), rel=1e-3)


def test_no_scatter_of_visits_is_none() -> None:
    """Where the mean square between is below that within, the likeliest variance is nil."""
    data = visited(None, visits=7)
    even = data.log_torque.reshape(7, SPEEDS.size)
    data = replace(data, log_torque=(even - even.mean(axis=1, keepdims=True)).ravel())
    found = scatter_of(data, np.full(len(data), 0.01))
    assert found.deviation == 0.0
    assert found.p_value > 0.99


@pytest.mark.parametrize("kelvin", [None, [363.0, 393.0, 423.0, 453.0, 383.0, 383.0]])
def test_f_is_that_of_two_least_squares(kelvin: list[float] | None) -> None:
    for between, seed in ((0.0, 4), (0.005, 5), (0.01, 6)):
        data = visited(kelvin, visits=6, between=between, seed=seed)
        gain, many, left, freedom = squares_by_hand(data)
        expected = stats.f.sf(gain / many / (left / freedom), many, freedom)
        found = scatter_of(data, np.full(len(data), 0.01))
        assert found.p_value == pytest.approx(expected, rel=1e-6)


def test_f_lets_the_zero_take_its_part() -> None:
    """An error of the zero is projected out with its prior: of a column that no prior holds, wholly."""
    data = visited(None, visits=6, between=0.02, seed=7)
    tare = 50.0 * np.random.default_rng(2).standard_normal((len(data), 1))
    data = replace(data, tare=tare)
    wide = np.column_stack([design(data), tare])
    y, both = data.log_torque, np.column_stack([wide, one_hot(data.visit)])

    def left(columns: np.ndarray) -> tuple[float, int]:
        coefficients, _, rank, _ = np.linalg.lstsq(columns, y, rcond=1e-10)
        return float(np.sum((y - columns @ coefficients) ** 2)), int(rank)

    (alone, few), (rest, many) = left(wide), left(both)
    freedom = len(data) - many + 1  # the prior is one observation more
    expected = stats.f.sf((alone - rest) / (many - few) / (rest / freedom), many - few, freedom)
    found = scatter_of(data, np.full(len(data), 0.01))
    assert found.p_value == pytest.approx(expected, rel=1e-3)


def test_p_values_of_clean_visits_are_uniform_and_of_scattered_ones_tiny() -> None:
    kelvin = [363.0, 393.0, 423.0, 453.0, 383.0]
    clean = [fit_law(THERMAL, visited(kelvin, seed=seed, error=0.01)).shared[0].p_value for seed in range(60)]
    assert stats.kstest(clean, "uniform").pvalue > 0.05
    told = [
        fit_law(THERMAL, visited(kelvin, between=0.03, seed=seed)).shared[0].p_value for seed in range(30)
    ]
    assert max(told) < 0.01


def test_groups_are_visits_of_several_dwells_and_runs_of_several_visits() -> None:
    data = visited([363.0, 393.0, 423.0, 363.0, 393.0, 423.0], runs=[0, 0, 1, 1, 2, 2])
    assert [g.name for g in groupings(data)] == ["visit", "run"]
    visit, run = groupings(data)
    assert visit.member.sum(axis=0).tolist() == [6.0] * 6
    assert run.member.sum(axis=0).tolist() == [12.0] * 3
    assert [g.name for g in groupings(visited([363.0, 393.0, 423.0]))] == ["visit"]
    each = replace(data, visit=np.arange(len(data)))  # a dwell for each: that is the scatter between dwells
    assert [g.name for g in groupings(each)] == ["run"]
    assert groupings(replace(each, run=np.zeros(len(data), dtype=np.intp))) == ()


def test_without_temperatures_what_dwells_share_is_that_of_their_run() -> None:
    data = visited(None, visits=3, runs=[0, 1, 2])
    assert [g.name for g in groupings(data)] == ["run"]
    assert [g.name for g in groupings(visited([363.0, 393.0, 423.0], runs=[0, 1, 2]))] == ["visit"]


def test_two_runs_without_a_law_of_temperature_tell_how_far_they_stand_apart() -> None:
    """Of the level; with one, two visits may lie close by chance and tell nothing."""
    held = 0
    for seed in range(20):
        fit = fit_law(ISOTHERMAL, visited(None, visits=2, between=0.03, seed=seed))
        assert fit.shared[0].estimable
        level = fit.estimate("level")
        held += level.low <= VALUES[None][0] <= level.high
    assert held >= 17


def test_visits_are_stays_whatever_they_differ_by() -> None:
    one_run = np.zeros(6, dtype=np.intp)
    close = np.array([373.0, 373.2, 377.0, 377.1, 381.0, 380.8])  # three stays 4 K apart
    assert _visits(one_run, close).tolist() == [0, 0, 1, 1, 2, 2]
    wandering = np.array([373.0, 376.0, 379.0, 375.0, 372.0, 400.0])  # one stay, and another
    assert _visits(one_run, wandering).tolist() == [0, 0, 0, 0, 0, 1]
    assert _visits(np.array([0, 0, 0, 1, 1, 1]), None).tolist() == [0, 0, 0, 1, 1, 1]


def test_what_runs_share_is_told_from_what_visits_share() -> None:
    kelvin = [363.0, 393.0, 423.0] * 8
    runs = np.repeat(np.arange(8), 3).tolist()
    by_run = fit_law(THERMAL, visited(kelvin, runs=runs, between_runs=0.05, seed=2)).shared
    by_visit = fit_law(THERMAL, visited(kelvin, runs=runs, between=0.05, seed=2)).shared
    assert [s.name for s in by_run] == ["visit", "run"]
    assert by_run[1].deviation == pytest.approx(0.05, rel=0.5)
    assert by_run[0].deviation < 0.01
    assert by_visit[0].deviation == pytest.approx(0.05, rel=0.5)
    assert by_visit[1].deviation < 0.02


def dense(fit: LawFit, data: Observations) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Values and covariance by generalised least squares at the variances of the fit, and that covariance."""
    v = np.diag(fit.errors**2 + fit.scatter**2) + data.tare @ data.tare.T
    v += fit.shared[0].deviation ** 2 * one_hot(data.visit) @ one_hot(data.visit).T
    x, inverse = design(data), np.linalg.inv(v)
    covariance = np.linalg.inv(x.T @ inverse @ x)
    return covariance @ x.T @ inverse @ data.log_torque, covariance, v


@pytest.mark.parametrize("with_tare", [False, True])
def test_a_fit_with_shared_errors_is_generalised_least_squares(with_tare: bool) -> None:
    kelvin = [363.0, 393.0, 423.0, 453.0, 383.0]
    data = visited(kelvin, between=0.03, seed=8, error=0.006)
    if with_tare:
        data = replace(data, tare=0.01 / np.exp(data.log_torque)[:, None])
    fit = fit_law(THERMAL, data)
    assert fit.shared[0].deviation > 0.005
    assert np.max(np.abs(fit.residuals / fit.sigma)) < 2.5
    values, covariance, _ = dense(fit, data)
    assert fit.values == pytest.approx(values - np.array([0.0, 0.0, 1.0]), rel=1e-6)
    assert fit.covariance == pytest.approx(covariance, rel=1e-5, abs=1e-10)


def test_the_deviance_is_that_of_the_multivariate_normal() -> None:
    """Where no residual is beyond Huber's limit, at the scatter that makes it least."""
    data = visited([363.0, 393.0, 423.0, 453.0, 383.0], between=0.03, seed=8, error=0.006)
    fit = fit_law(THERMAL, data)
    residuals = data.log_torque - design(data) @ (fit.values + np.array([0.0, 0.0, 1.0]))
    member = fit.shared[0].deviation * one_hot(data.visit)
    # Huber's density has longer tails than the normal one: its constant is known
    longer = 2.0 * len(data) * (log_normalisation(2.5) - 0.5 * np.log(2.0 * np.pi))

    def twice(scatter: float) -> float:
        v = np.diag(fit.errors**2 + scatter**2) + member @ member.T
        return float(-2.0 * stats.multivariate_normal(np.zeros(len(data)), v).logpdf(residuals))

    scatters = np.geomspace(1e-4, 0.05, 400)
    least = min(twice(s) for s in scatters)
    assert fit.deviance == pytest.approx(least + longer, abs=1e-3)
    assert deviance(residuals, fit.errors, shared=member)[0] == pytest.approx(fit.deviance, abs=1e-9)


def test_an_error_of_a_visit_without_scatter_changes_no_deviance() -> None:
    residuals, errors = 0.01 * np.random.default_rng(3).standard_normal(20), np.full(20, 0.01)
    none = deviance(residuals, errors)
    assert deviance(residuals, errors, shared=np.zeros((20, 2))) == pytest.approx(none, rel=1e-9)


def test_the_freedom_of_a_balanced_layout_is_that_of_its_visits() -> None:
    """What varies between visits alone has their degrees of freedom, less those that the law takes up."""
    visits = 5
    fit = fit_law(ISOTHERMAL, visited(None, visits=visits, between=0.05, seed=2))
    assert fit.shared[0].deviation > 0.02
    assert fit.freedom_of("level") == pytest.approx(visits - 1, rel=1e-3)
    assert fit.freedom_of("c") == pytest.approx(visits * (SPEEDS.size - 1) - 1, rel=0.05)
    kelvin = [363.0, 393.0, 423.0, 453.0, 383.0]
    thermal = fit_law(THERMAL, visited(kelvin, between=0.05, seed=2))
    assert thermal.freedom_of("e") == pytest.approx(len(kelvin) - 2, rel=1e-3)
    assert thermal.freedom_of("level") == pytest.approx(len(kelvin) - 2, rel=1e-3)
    assert thermal.freedom_of("c") > 20


def test_freedom_without_shared_errors_is_that_of_the_residuals() -> None:
    clean = fit_law(THERMAL, visited([363.0, 393.0, 423.0, 453.0], seed=9, error=0.05))
    assert clean.shared[0].deviation == 0.0
    assert [clean.freedom_of(name) for name in THERMAL.names] == [24 - 3] * 3


def test_satterthwaite_by_hand() -> None:
    """Twice the squared variance over the variance of that variance, between one and the residuals'."""
    parts = (np.diag([1.0, 2.0]), np.diag([3.0, 0.0]))
    uncertainty = np.array([[0.04, -0.01], [-0.01, 0.09]])
    freedom = Freedom(50, np.diag([2.0, 1.5]), parts, uncertainty)
    weights = np.array([1.0, 1.0])
    by = np.array([3.0, 3.0])
    assert freedom.of(weights) == pytest.approx(2.0 * 3.5**2 / (by @ uncertainty @ by), rel=1e-12)
    assert freedom.of(np.array([1e-9, 1.0])) == pytest.approx(2 * 1.5**2 / (4 * 0.04), rel=1e-6)
    assert Freedom(7, np.diag([2.0, 1.5]), parts, uncertainty).of(weights) == 7.0
    assert Freedom(50, np.diag([0.1, 0.1]), parts, 1e3 * uncertainty).of(weights) == 1.0


def test_temperatures_visited_once_each_tell_no_more_than_the_law_takes_up() -> None:
    two = fit_law(THERMAL, visited([363.0, 453.0], seed=3))
    assert [s.estimable for s in two.shared] == [False]
    assert "visited once" in two.not_estimable("e")
    assert two.not_estimable("c") == two.not_estimable("level") == ""
    b, c = two.estimate("e"), two.estimate("c")
    assert (b.low, b.high, b.estimable) == (-np.inf, np.inf, False)
    reach = float(stats.t.ppf(0.975, 12 - 3)) * c.error
    assert (c.low, c.high) == pytest.approx((c.value - reach, c.value + reach))
    assert c.estimable
    again = fit_law(THERMAL, visited([363.0, 453.0, 363.0], seed=3))
    assert again.not_estimable("e") == ""
    assert again.estimate("e").estimable
