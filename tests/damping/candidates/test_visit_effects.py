"""Effects of many visits are eliminated: nothing else changes, against the same with each an unknown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy import optimize

from hersey.damping.candidates import refits, searching, visit_effects
from hersey.damping.candidates.bordered import Bordered
from hersey.damping.candidates.branched import FREE, Law
from hersey.damping.candidates.clustered import clustered_with_prior
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.lack_of_fit import lack_of_fit
from hersey.damping.candidates.likelihood import HUBER, deviance, loss, minimise
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.refits import left_out, resampled
from hersey.damping.candidates.searching import residuals_of, search
from hersey.damping.candidates.shared_errors import (
    freedom_beside,
    freedom_of,
    groupings,
    shared_scatter,
)
from hersey.damping.candidates.thermal import KELVIN, Thermal
from hersey.damping.candidates.visit_effects import Integrated, Visits
from hersey.damping.gradual import _gains
from tests.damping.candidates.test_shared_errors import REFERENCE, SPEEDS, THERMAL, visited

BROKEN = Law(Thermal(KELVIN, REFERENCE), FREE)


def many(*, runs: bool = False, outliers: bool = True, tare: bool = True) -> Observations:
    """Thirty visits that scatter, in no order; some dwells and two whole visits lie far outside."""
    kelvin = [360.0 + 4.0 * (7 * i % 30) for i in range(30)]
    zero = 0.02 * np.geomspace(1.0, 0.1, 30 * SPEEDS.size)[:, None]
    data = visited(
        kelvin,
        between=0.03,
        runs=[i // 5 for i in range(30)] if runs else None,
        between_runs=0.02 if runs else 0.0,
        error=0.004,
        tare=zero if tare else None,
    )
    random = np.random.default_rng(8)
    if outliers:
        far = 0.2 * (random.random(len(data)) < 0.05) + 0.3 * np.isin(data.visit, [4, 17])
        data = replace(data, log_torque=data.log_torque + far)
    return data.take(random.permutation(len(data)))


def corner(data: Observations) -> Observations:
    """The same dwells with a transition among their speeds."""
    z = data.inputs.log_speed
    return replace(data, log_torque=data.log_torque + 0.8 * np.maximum(0.2 - z, 0.0))


@pytest.fixture(params=["plain", "runs", "no zero", "corner"])
def data(request: pytest.FixtureRequest) -> Observations:
    return {
        "plain": lambda: many(),
        "runs": lambda: many(runs=True),
        "no zero": lambda: many(tare=False, outliers=False),
        "corner": lambda: corner(many()),
    }[request.param]()


@pytest.fixture
def as_unknowns(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    return lambda: monkeypatch.setattr(visit_effects, "MANY", 10**9)


def law_of(data: Observations) -> Law:
    turns = np.corrcoef(np.maximum(0.2 - data.inputs.log_speed, 0.0), data.log_torque)[0, 1] > 0.0
    return BROKEN if turns else THERMAL


def test_the_likeliest_effect_is_where_the_cost_of_its_visit_is_least() -> None:
    random = np.random.default_rng(4)
    label = random.integers(0, 9, 60)
    label[:9] = np.arange(9)
    off, by = 3.0 * random.standard_normal((5, 60)), random.uniform(0.5, 3.0, 60)
    off[0, label == 2] += 40.0
    off[1] *= 8.0
    times, centre = random.integers(0, 3, (5, 60)).astype(float), 2.0 * random.standard_normal((5, 9))
    found = Visits(label).likeliest(off, by, centre, times)
    for row, each in np.ndindex(5, 9):
        mine = label == each

        def cost(effect: float, row: int = row, each: int = each, mine: np.ndarray = mine) -> float:
            dwells = times[row, mine] * loss(off[row, mine] - by[mine] * effect, HUBER)
            return float(np.sum(dwells) + loss(np.array(effect - centre[row, each]), HUBER))

        best = optimize.minimize_scalar(cost, bracket=(-5.0, 5.0), tol=1e-12)
        assert cost(float(found[row, each])) == pytest.approx(best.fun, rel=1e-12)
        assert found[row, each] == pytest.approx(best.x, abs=2e-6)


def test_dwells_far_on_either_side_do_not_pass_for_one_side() -> None:
    """The first step goes from beyond the limit on one side to beyond it on the other: no dwell is within."""
    effect = Visits(np.array([0, 0])).likeliest(
        np.array([[19.3, 40.7]]), np.full(2, 7.75), np.array([[1.73]]), 1.0
    )
    assert effect == pytest.approx((19.3 + 2.5 + 1.73 / 7.75) / (7.75 + 1.0 / 7.75), rel=1e-12)


def test_a_fit_is_the_same(data: Observations, as_unknowns: Callable[[], None]) -> None:
    law = law_of(data)
    fit = fit_law(law, data)
    as_unknowns()
    other = fit_law(law, data, [fit.values])
    assert fit.shared[0].deviation > 0.0
    assert fit.effects.size >= 30
    moved = np.abs(fit.values - other.values) / np.sqrt(np.diag(other.covariance))
    assert moved == pytest.approx(0.0, abs=2e-5)
    assert fit.effects == pytest.approx(other.effects, abs=3e-5)
    assert fit.deviance == pytest.approx(other.deviance, rel=1e-7)
    assert fit.cost == pytest.approx(other.cost, rel=1e-6)
    assert fit.scatter == pytest.approx(other.scatter, rel=1e-6)
    assert [s.deviation for s in fit.shared] == pytest.approx([s.deviation for s in other.shared], rel=1e-6)
    for name in law.names:
        assert fit.freedom_of(name) == pytest.approx(other.freedom_of(name), rel=1e-5)
    np.testing.assert_allclose(fit.covariance, other.covariance, rtol=1e-5, atol=1e-12)
    np.testing.assert_allclose(fit.clustered, other.clustered, rtol=1e-5, atol=1e-12)


def dense(normal: Bordered) -> tuple[np.ndarray, np.ndarray]:
    """The same slopes with a column for each visit last, dwells and priors."""
    member = normal.visits.label[:, None] == np.arange(normal.visits.count)
    dwells = np.hstack([normal.border, normal.by_visit[:, None] * member])
    priors = np.zeros((len(normal.prior) + normal.visits.count, dwells.shape[1]))
    priors[: len(normal.prior), : normal.border.shape[1]] = normal.prior
    priors[len(normal.prior) :, normal.border.shape[1] :] = np.diag(normal.own_prior)
    return dwells, priors


def at_minimum(data: Observations) -> tuple[LawFit, Bordered, np.ndarray]:
    """A fit, the normal equations there, and residuals in standard errors."""
    fit = fit_law(law_of(data), data)
    start = np.append(fit.values, fit.effects)
    found = search(fit.law, data, fit.disturbances, fit.sigma, start)
    assert found.bordered is not None
    u = residuals_of(fit.law, data, fit.disturbances, found.values) / fit.sigma
    return fit, found.bordered, u


def test_bordered_equations_have_the_inverse_of_the_whole_matrix(data: Observations) -> None:
    fit, normal, u = at_minimum(data)
    size, border = fit.values.size, normal.border.shape[1]
    dwells, priors = dense(normal)
    bread = np.linalg.inv(dwells.T @ dwells + priors.T @ priors)
    assert normal.inverse == pytest.approx(bread[:border, :border], rel=1e-8, abs=1e-14)
    assert normal.gains(size) == pytest.approx((bread @ dwells.T)[:size], rel=1e-7, abs=1e-12)
    taken = bread.shape[0] - size - np.trace(bread[size:, size:])
    assert normal.taken_up(size) == pytest.approx(taken, rel=1e-10)
    every = np.vstack([dwells, priors])
    clustered = clustered_with_prior(every, u, bread, data.cluster // 4)[:size, :size]
    assert normal.clustered(u, data.cluster // 4, size) == pytest.approx(clustered, rel=1e-7, abs=1e-14)


def test_freedoms_are_those_of_the_whole_matrix(data: Observations) -> None:
    fit, normal, u = at_minimum(data)
    size = fit.values.size
    sigma = fit.sigma * np.sqrt(np.maximum(np.abs(u) / HUBER, 1.0))
    dwells, priors = dense(normal)
    bread = np.linalg.inv(dwells.T @ dwells + priors.T @ priors)
    grouped = groupings(data)
    whole = freedom_of(grouped, fit.shared, dwells * sigma[:, None], sigma, bread, size)
    found = freedom_beside(grouped, fit.shared, normal, sigma, size)
    assert found.uncertainty == pytest.approx(whole.uncertainty, rel=1e-7)
    assert len(found.parts) == len(whole.parts) == 1 + len(fit.shared)
    for one, other in zip(found.parts, whole.parts, strict=True):
        assert one == pytest.approx(other, rel=1e-7, abs=1e-14)
    assert found.residual == whole.residual


def test_what_follows_a_fit_is_the_same(
    data: Observations, monkeypatch: pytest.MonkeyPatch, as_unknowns: Callable[[], None]
) -> None:
    monkeypatch.setattr(refits, "_PRECISION", 1e-13)
    fit, _, u = at_minimum(data)
    sigma = fit.sigma * np.sqrt(np.maximum(np.abs(u) / HUBER, 1.0))
    slopes, whole = fit.law.jacobian(fit.values, data.inputs), fit.residuals + fit.disturbances @ fit.effects
    by_heat = fit.law.slopes(fit.values, data.inputs)[1]

    def said() -> tuple[np.ndarray, np.ndarray, np.ndarray, list[float]]:
        shared = shared_scatter(groupings(data), fit.shared, data, slopes, by_heat, whole, sigma)
        lack = lack_of_fit(fit, data)
        numbers = [lack.curvature, lack.temperature, *lack.local_exponents, *lack.by_temperature]
        numbers += [number for each in shared for number in (each.deviation, each.p_value)]
        drawn = resampled(fit, data, 4, seed=5)
        return _gains(data, fit), left_out(fit, data), drawn, [float(each or 0.0) for each in numbers]

    gains, missed, drawn, numbers = said()
    as_unknowns()
    same_gains, same_missed, same_drawn, same_numbers = said()
    assert numbers == pytest.approx(same_numbers, rel=1e-7)
    assert gains == pytest.approx(same_gains, rel=1e-6, abs=1e-10)
    assert missed == pytest.approx(same_missed, abs=1e-8)
    assert drawn == pytest.approx(same_drawn, rel=1e-6)


def test_effects_integrated_out_are_those_of_the_whole_matrix() -> None:
    data = many(runs=True)
    random = np.random.default_rng(2)
    residuals, errors = 0.04 * random.standard_normal(len(data)), random.uniform(0.005, 0.02, len(data))
    visits, runs = groupings(data)
    assert visits.visits is not None
    whole = deviance(residuals, errors, shared=np.column_stack([0.03 * visits.member, 0.02 * runs.member]))
    found = deviance(residuals, errors, shared=Integrated(visits.visits, 0.03, 0.02 * runs.member))
    assert found == pytest.approx(whole, rel=1e-11)


def test_effects_of_visits_are_no_unknowns(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes: set[int] = set()

    def counted(residual: Any, jacobian: Any, start: np.ndarray, **effort: Any) -> Any:
        sizes.add(start.size)
        return minimise(residual, jacobian, start, **effort)

    monkeypatch.setattr(searching, "minimise", counted)
    fit = fit_law(THERMAL, many())
    assert fit.effects.size == 31
    assert sizes == {fit.values.size + 1}
