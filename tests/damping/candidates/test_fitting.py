"""One law fitted, against linear algebra done here: a straight law, residuals all within Huber's limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate, optimize, stats

from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.fitting import LawFit, fit_law, search
from hersey.damping.candidates.identifiability import not_identified
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.refits import left_out, resampled
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, KELVIN, VFT, Thermal
from tests.damping.candidates.cases import even, hand_fit
from tests.damping.candidates.test_comparison import LAWS, REFERENCE, dwells

STRAIGHT = Law(Thermal(KELVIN, REFERENCE), ONE)
VALUES = [0.1, -2.4, -0.7]


def columns(data: Observations) -> np.ndarray:
    """What the three parameters of the straight law multiply."""
    assert data.inputs.kelvin is not None
    z = data.inputs.log_speed
    return np.column_stack([np.ones_like(z), np.log(data.inputs.kelvin / REFERENCE), z])


def solved(x: np.ndarray, y: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    rows = x / sigma[:, None]
    return np.asarray(np.linalg.inv(rows.T @ rows) @ rows.T @ (y / sigma))


def in_terms_of(linear: np.ndarray) -> np.ndarray:
    """The straight law's own values: its last is the power less one."""
    return linear - np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def data() -> Observations:
    return even(STRAIGHT, VALUES)


@pytest.fixture(scope="module")
def fit(data: Observations) -> LawFit:
    return fit_law(STRAIGHT, data)


@pytest.fixture(scope="module")
def tared(data: Observations) -> Observations:
    """The same with a tare that is no multiple of a column of the law."""
    tare = 0.03 / np.exp(data.log_torque)
    return replace(data, tare=tare[:, None], log_torque=data.log_torque + 0.8 * tare)


def expected_psi() -> float:
    total, _ = integrate.quad(
        lambda u: min(abs(u), 2.5) ** 2 * stats.norm.pdf(u), -12, 12, points=[-2.5, 2.5]
    )
    return float(total)


def test_a_straight_law_is_weighted_least_squares(data: Observations, fit: LawFit) -> None:
    b, power = fit.values[1], 1.0 + fit.values[2]
    errors = np.sqrt(
        data.torque_error**2
        + (power * data.speed_error) ** 2
        + (b * data.temperature_error / data.inputs.kelvin) ** 2
    )
    assert fit.errors == pytest.approx(errors, rel=1e-6)
    sigma = np.sqrt(errors**2 + fit.scatter**2)
    assert fit.sigma == pytest.approx(sigma, rel=1e-6)
    x = columns(data)
    linear = solved(x, data.log_torque, fit.sigma)
    assert fit.values == pytest.approx(in_terms_of(linear), rel=1e-8)
    assert fit.residuals == pytest.approx(data.log_torque - x @ linear, abs=1e-9)
    u = fit.residuals / fit.sigma
    assert np.max(np.abs(u)) < 2.5
    assert fit.cost == pytest.approx(np.sum(u**2), rel=1e-9)
    rows = x / fit.sigma[:, None]
    assert fit.covariance == pytest.approx(np.linalg.inv(rows.T @ rows), rel=1e-7)
    assert np.sum(u**2) == pytest.approx((len(data) - 3) * expected_psi(), rel=1e-3)
    assert fit.effects.size == 0


def test_the_deviance_is_that_of_its_residuals_and_the_tare(fit: LawFit, tared: Observations) -> None:
    norm = 2 * integrate.quad(lambda u: np.exp(-0.5 * u**2), 0, 2.5)[0] + 2 * np.exp(-0.5 * 2.5**2) / 2.5

    def least(found: LawFit) -> float:
        def cost(scatter: float) -> float:
            s = np.sqrt(found.errors**2 + scatter**2)
            u = np.abs(found.residuals / s)
            rho = np.where(u <= 2.5, u**2, 5.0 * u - 6.25)
            return float(np.sum(rho + 2 * np.log(norm * s)))

        return float(
            optimize.minimize_scalar(cost, bounds=(1e-4, 0.1), method="bounded", options={"xatol": 1e-9}).fun
        )

    assert fit.deviance == pytest.approx(least(fit), abs=1e-6)
    with_tare = fit_law(STRAIGHT, tared)
    (tare,) = with_tare.effects
    assert abs(tare) > 0.1
    assert with_tare.deviance == pytest.approx(least(with_tare) + tare**2, abs=1e-6)


def test_a_tare_is_one_more_unknown_with_a_prior(tared: Observations) -> None:
    fit = fit_law(STRAIGHT, tared)
    rows = np.column_stack([columns(tared), tared.tare]) / fit.sigma[:, None]
    rows = np.vstack([rows, [0.0, 0.0, 0.0, 1.0]])
    y = np.append(tared.log_torque / fit.sigma, 0.0)
    bread = np.linalg.inv(rows.T @ rows)
    linear = bread @ rows.T @ y
    assert fit.values == pytest.approx(in_terms_of(linear[:3]), rel=1e-7)
    assert fit.effects == pytest.approx([linear[3]], rel=1e-6)
    assert fit.disturbances == pytest.approx(tared.tare, abs=0)
    assert fit.covariance == pytest.approx(bread[:3, :3], rel=1e-6)
    assert fit.residuals * 1.0 == pytest.approx(
        tared.log_torque - columns(tared) @ linear[:3] - linear[3] * tared.tare[:, 0], abs=1e-8
    )
    assert fit.cost == pytest.approx(np.sum((y - rows @ linear) ** 2), rel=1e-8)


def test_counts_and_criteria_by_hand() -> None:
    fit = hand_fit(STRAIGHT, VALUES, points=11, deviance=-31.7)
    assert fit.freedom == 8
    assert fit.parameters == 4
    assert fit.aicc == pytest.approx(-31.7 + 2 * 4 + 2 * 4 * 5 / (11 - 4 - 1), rel=1e-12)
    assert fit.bic == pytest.approx(-31.7 + 4 * np.log(11.0), rel=1e-12)
    assert fit.sigma == pytest.approx(np.hypot(fit.errors, 0.03), rel=1e-9)
    few = hand_fit(STRAIGHT, VALUES, points=5, deviance=-31.7)
    assert few.aicc == pytest.approx(-31.7 + 8 + 40, rel=1e-12)


def test_starts_that_are_given_are_those_searched() -> None:
    law, values = LAWS["arrhenius/two-hersey"]
    data = dwells(law, values, scatter=0.0)
    far = np.array(values) + np.array([0.0, 0.0, 0.0, 0.0, 0.05])
    worse = np.array([3.0, 0.0, 0.5, 2.0, 9.0])
    assert fit_law(law, data, [worse, far]).values == pytest.approx(values, abs=1e-5)


def test_search_holds_a_parameter_and_expects_a_tare(tared: Observations) -> None:
    sigma = np.linspace(0.05, 0.06, len(tared))
    x = columns(tared)
    rows = np.vstack([np.column_stack([x, tared.tare]) / sigma[:, None], [0.0, 0.0, 0.0, 1.0]])
    start = np.array([0.1, -2.4, -0.7, 0.0])
    expected = np.array([0.6])
    held = search(STRAIGHT, tared, tared.tare, sigma, start, held=(1, -2.3), expected=expected)
    y = np.append(tared.log_torque / sigma, 0.6) - rows[:, 1] * -2.3
    some = rows[:, [0, 2, 3]]
    linear = np.linalg.solve(some.T @ some, some.T @ y)
    assert held.values == pytest.approx([linear[0], -2.3, linear[1] - 1.0, linear[2]], rel=1e-7)
    assert np.max(np.abs(y - some @ linear)) < 2.5
    assert held.cost == pytest.approx(np.sum((y - some @ linear) ** 2), rel=1e-8)
    assert np.all(held.jacobian[:, 1] == 0.0)
    assert held.jacobian[:-1, 0] == pytest.approx(-1.0 / sigma, rel=1e-9)
    assert held.jacobian[-1] == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=0)
    assert start[1] == -2.4  # what was given stays as it is


def test_without_a_tare_there_is_no_disturbance(data: Observations) -> None:
    sigma = np.full(len(data), 0.02)
    found = search(STRAIGHT, data, data.tare, sigma, np.array([0.1, -2.4, -0.7]))
    assert found.values == pytest.approx(in_terms_of(solved(columns(data), data.log_torque, sigma)), rel=1e-7)
    assert found.jacobian.shape == (len(data), 3)


def test_left_out_dwells_come_from_explicit_refits(data: Observations, fit: LawFit) -> None:
    x, missed = columns(data), left_out(fit, data)
    for label in np.unique(data.cluster):
        out = data.cluster == label
        linear = solved(x[~out], data.log_torque[~out], fit.sigma[~out])
        assert missed[out] == pytest.approx(data.log_torque[out] - x[out] @ linear, abs=2e-6)


@pytest.mark.parametrize("clusters", [9, 36])
def test_left_out_dwells_are_predicted_together(
    clusters: int, data: Observations, fit: LawFit, monkeypatch: pytest.MonkeyPatch
) -> None:
    called: list[int] = []
    predict = Law.predict

    def counted(self: Law, values: np.ndarray, inputs: Inputs) -> np.ndarray:
        called.append(values[0].size)
        return predict(self, values, inputs)

    monkeypatch.setattr(Law, "predict", counted)
    left_out(fit, replace(data, cluster=data.cluster % clusters))
    assert len(called) < 12
    assert called[0] == clusters
    called.clear()
    resampled(fit, data, 100, seed=1)
    assert len(called) < 20
    assert called[0] == 100


def test_left_out_dwells_keep_the_tare_of_the_others(tared: Observations) -> None:
    fit = fit_law(STRAIGHT, tared)
    missed = left_out(fit, tared)
    x = np.column_stack([columns(tared), tared.tare])
    prior = np.array([[0.0, 0.0, 0.0, 1.0]])
    for label in (0, 7, 30):
        out = tared.cluster == label
        rows = np.vstack([x[~out] / fit.sigma[~out, None], prior])
        y = np.append(tared.log_torque[~out] / fit.sigma[~out], 0.0)
        linear = np.linalg.solve(rows.T @ rows, rows.T @ y)
        assert missed[out] == pytest.approx(tared.log_torque[out] - x[out] @ linear, abs=2e-5)


def test_no_more_than_forty_parts_are_left_out(data: Observations, fit: LawFit) -> None:
    each = replace(data, cluster=np.arange(len(data), dtype=np.intp))
    missed = left_out(fit, each)
    out = np.arange(len(data)) % 40 == 5
    assert np.count_nonzero(out) == 2
    x = columns(data)
    linear = solved(x[~out], data.log_torque[~out], fit.sigma[~out])
    assert missed[out] == pytest.approx(data.log_torque[out] - x[out] @ linear, abs=2e-6)


def test_an_exponent_per_temperature_says_nothing_of_a_temperature_left_out() -> None:
    law, values = LAWS["arrhenius/one/each"]
    data = even(law, values)
    fit = fit_law(law, data)
    assert np.all(np.isfinite(left_out(fit, data)))
    by_heat = replace(data, cluster=data.inputs.group)
    assert np.all(np.isnan(left_out(fit, by_heat)))
    common = fit_law(STRAIGHT, by_heat)
    assert np.all(np.isfinite(left_out(common, by_heat)))


@pytest.mark.parametrize("count", [5, 36])
def test_clustered_errors_are_those_of_a_jackknife(data: Observations, count: int) -> None:
    grouped = replace(data, cluster=data.cluster % count)
    fit = fit_law(STRAIGHT, grouped)
    assert np.max(np.abs(fit.residuals / fit.sigma)) < 2.5
    x, total = columns(grouped), np.zeros((3, 3))
    for label in range(count):
        kept = grouped.cluster != label
        moved = in_terms_of(solved(x[kept], grouped.log_torque[kept], fit.sigma[kept])) - fit.values
        total += np.outer(moved, moved)
    assert fit.clustered == pytest.approx((count - 1) / count * total, rel=1e-5, abs=1e-10)


def test_clustered_errors_hold_the_tare(tared: Observations) -> None:
    fit = fit_law(STRAIGHT, tared)
    x = np.column_stack([columns(tared), tared.tare])

    def refit(kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rows = np.vstack([x[kept] / fit.sigma[kept, None], [0.0, 0.0, 0.0, 1.0]])
        y = np.append(tared.log_torque[kept] / fit.sigma[kept], 0.0)
        bread = np.linalg.inv(rows.T @ rows)
        return bread @ rows.T @ y, bread

    full, bread = refit(np.ones(len(tared), dtype=bool))
    labels = np.unique(tared.cluster)
    moved = np.array([refit(tared.cluster != label)[0] - full for label in labels])
    share = (labels.size - 1) / labels.size
    # what the dwells say and what the prior of the tare adds; the factor is one of 36 clusters
    expected = share * moved.T @ moved + np.outer(bread[3], bread[3])
    ratio = np.sqrt(np.diag(fit.clustered) / np.diag(expected[:3, :3]))
    assert ratio == pytest.approx(np.ones(3), abs=0.015)
    within = share * moved.T @ moved
    assert np.max(np.sqrt(np.diag(expected)[:3] / np.diag(within)[:3])) > 1.1


def test_resampled_fits_are_explicit_refits_to_the_clusters_drawn(data: Observations, fit: LawFit) -> None:
    draws = resampled(fit, data, 3, seed=9)
    random = np.random.default_rng(9)
    labels = np.unique(data.cluster)
    x = columns(data)
    for row in draws:
        picked = random.integers(0, labels.size, labels.size)
        kept = np.concatenate([np.flatnonzero(data.cluster == labels[i]) for i in picked])
        linear = solved(x[kept], data.log_torque[kept], fit.sigma[kept])
        u = (data.log_torque[kept] - x[kept] @ linear) / fit.sigma[kept]
        assert np.max(np.abs(u)) < 2.5
        assert row == pytest.approx(in_terms_of(linear), abs=1e-6)
    assert draws.shape == (3, 3)


def test_resampled_fits_draw_the_tare_from_its_prior(tared: Observations) -> None:
    fit = fit_law(STRAIGHT, tared)
    (row,) = resampled(fit, tared, 1, seed=4)
    random = np.random.default_rng(4)
    labels = np.unique(tared.cluster)
    picked = random.integers(0, labels.size, labels.size)
    disturbance = random.standard_normal()
    kept = np.concatenate([np.flatnonzero(tared.cluster == labels[i]) for i in picked])
    rows = np.column_stack([columns(tared), tared.tare])[kept] / fit.sigma[kept, None]
    rows = np.vstack([rows, [0.0, 0.0, 0.0, 1.0]])
    y = np.append(tared.log_torque[kept] / fit.sigma[kept], disturbance)
    linear = np.linalg.solve(rows.T @ rows, rows.T @ y)
    assert row == pytest.approx(in_terms_of(linear[:3]), abs=2e-5)


def test_resamples_hold_what_the_law_needs() -> None:
    """With one cluster per temperature, draws without all of them (or two) are drawn again."""
    law, values = LAWS["arrhenius/one/each"]
    data = even(law, values)
    fit = fit_law(law, data)
    by_heat = replace(data, cluster=data.inputs.group)
    (row,) = resampled(fit, by_heat, 1, seed=2)
    # every temperature once, in whatever order: the fit itself
    assert row == pytest.approx(fit.values, abs=1e-5)
    common = fit_law(STRAIGHT, by_heat)
    random, x = np.random.default_rng(12), columns(by_heat)
    draws = resampled(common, by_heat, 12, seed=12)
    compared = 0
    for found in draws:
        picked = random.integers(0, 4, 4)
        while np.unique(picked).size < 2:
            picked = random.integers(0, 4, 4)
        kept = np.concatenate([np.flatnonzero(by_heat.cluster == i) for i in picked])
        linear = solved(x[kept], by_heat.log_torque[kept], common.sigma[kept])
        u = (by_heat.log_torque[kept] - x[kept] @ linear) / common.sigma[kept]
        if np.max(np.abs(u)) < 2.5:
            compared += 1
            assert found == pytest.approx(in_terms_of(linear), abs=2e-5)
    assert compared >= 6


def test_resampled_corners_are_the_least_of_three_searches() -> None:
    law, values = LAWS["arrhenius/two-hersey"]
    data = even(law, values)
    fit = fit_law(law, data)
    (row,) = resampled(fit, data, 1, seed=5)
    picked = np.random.default_rng(5).integers(0, 36, 36)
    kept = np.concatenate([np.flatnonzero(data.cluster == i) for i in picked])
    drawn, sigma = data.take(kept), fit.sigma[kept]
    error = np.sqrt(fit.covariance[4, 4])
    costs = []
    for aside in (-1.0, 0.0, 1.0):
        start = fit.values + aside * error * np.eye(5)[4]
        costs.append(search(law, drawn, drawn.tare, sigma, start).cost)
    u = (drawn.log_torque - law.predict(row, drawn.inputs)) / sigma
    cost = np.sum(np.where(np.abs(u) <= 2.5, u**2, 5 * np.abs(u) - 6.25))
    assert cost == pytest.approx(min(costs), rel=1e-5)


def test_what_one_temperature_and_speed_cannot_tell_apart() -> None:
    data = even(STRAIGHT, VALUES)
    assert data.inputs.kelvin is not None
    # speed and temperature rise together
    tied = replace(data, inputs=replace(data.inputs, log_speed=3.0 * np.log(data.inputs.kelvin / REFERENCE)))
    fit = replace(hand_fit(STRAIGHT, VALUES, points=len(data)), errors=np.full(len(data), 0.01))
    why = "other parameters can compensate any change of it. Vary speed and temperature independently"
    assert not_identified(fit, tied) == {"e": why, "c": why}
    assert not_identified(fit, data) == {}


def test_parts_of_stribeck_s_curve_must_show() -> None:
    law = StribeckLaw(None)
    data = dwells(law, [-1.2, -0.2, -2.0, 0.2], temperatures=None, twice=1)
    count = len(data)
    values = np.array([-1.2, -0.2, -2.0, 0.2])
    small = 0.01 * np.eye(4)

    def fitted(error: float, covariance: np.ndarray) -> LawFit:
        fit = hand_fit(law, list(values), covariance=covariance, points=count, scatter=0.0)
        return replace(fit, errors=np.full(count, error))

    h = np.exp(data.inputs.log_speed - 0.2)
    total = 1 + np.exp(-0.2 - h**2) + np.exp(-2.0) * h
    norms = {
        "stick": np.sqrt(np.sum((np.exp(-0.2 - h**2) / total) ** 2)),
        "viscous": np.sqrt(np.sum((np.exp(-2.0) * h / total) ** 2)),
    }
    why = "the part that it scales is too small in this log. Record dwells at {} speeds"
    expected = {"stick": why.format("slower"), "viscous": why.format("faster")}
    for name, norm in norms.items():
        assert name not in not_identified(fitted(0.49 * norm, small), data)
        assert not_identified(fitted(0.51 * norm, small), data)[name] == expected[name]
    weak = small.copy()
    weak[1, 1], weak[2, 2] = 1.01, 0.99
    assert not_identified(fitted(0.01, weak), data) == {"stick": expected["stick"]}
    weak[1, 1], weak[2, 2] = 0.99, 1.01
    assert not_identified(fitted(0.01, weak), data) == {"viscous": expected["viscous"]}


def test_the_pole_of_vft_must_be_two_errors_from_none() -> None:
    law = Law(Thermal(VFT, REFERENCE), ONE)
    data = dwells(law, [0.1, 2.8, 0.004, -0.7])
    why = "the data do not bound T0 from below. Record temperatures further apart"
    for error, lost in ((0.00201, {"q": why}), (0.00199, {})):
        covariance = 1e-4 * np.eye(4)
        covariance[2, 2] = error**2
        fit = hand_fit(law, [0.1, 2.8, 0.004, -0.7], covariance=covariance, points=len(data))
        assert not_identified(fit, data) == lost


def test_a_transition_needs_torque_to_tell_viscosity() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), HELD)
    data = dwells(law, [0.1, 0.02, -0.94, -1.6, -0.2])
    why = (
        "torque above the transition hardly depends on viscosity (1 + c is at its bound), so the "
        "transition at other temperatures is unknown. Record faster speeds"
    )
    for c, lost in ((-0.9499, {}), (-0.9501, {"at": why})):
        fit = hand_fit(law, [0.1, 0.02, c, -1.6, -0.2], points=len(data))
        assert not_identified(fit, data) == lost
    free = Law(Thermal(ARRHENIUS, REFERENCE), FREE)
    fit = hand_fit(free, [0.1, 0.02, -0.96, -1.6, -0.2, 0.0], points=len(data))
    assert not_identified(fit, data) == {}


@pytest.mark.parametrize(
    ("at", "lost"),
    [
        (1.5, {"at", "c_mixed"}),  # two of nine speeds below, once each
        (2.5, set()),  # three below
        (6.5, {"at", "c"}),  # two above
        (5.5, set()),
    ],
)
def test_a_corner_needs_three_dwells_on_either_side(at: float, lost: set[str]) -> None:
    law = Law(None, FREE)
    data = dwells(law, [0.1, -0.7, -1.2, -0.9], temperatures=None, twice=1)
    z = data.inputs.log_speed
    here = float(np.interp(at, np.arange(9.0), z))
    fit = hand_fit(law, [0.1, -0.7, -1.2, here], points=9, covariance=1e-6 * np.eye(4))
    where, what = ("below", "slower") if at < 4 else ("above", "faster")
    why = f"only 2 dwells lie {where} the transition. Record dwells at {what} speeds"
    assert not_identified(fit, data) == dict.fromkeys(lost, why)


def test_a_corner_needs_two_speeds_on_either_side() -> None:
    law = Law(None, FREE)
    data = dwells(law, [0.1, -0.7, -1.2, -0.9], temperatures=None, twice=3)
    z = np.unique(data.inputs.log_speed)
    for here, lost in (
        (0.5 * (z[0] + z[1]), {"at", "c_mixed"}),
        (0.5 * (z[1] + z[2]), set()),
        (z[1], {"at", "c_mixed"}),  # at a speed is above it
        (0.5 * (z[-1] + z[-2]), {"at", "c", "level"}),
    ):
        fit = hand_fit(law, [0.1, -0.7, -1.2, float(here)], points=27, covariance=1e-6 * np.eye(4))
        found = not_identified(fit, data)
        assert set(found) == lost
        if lost:
            where, what = ("below", "slower") if "c_mixed" in lost else ("above", "faster")
            assert found["at"] == (
                f"only 3 dwells lie {where} the transition. Record dwells at {what} speeds"
            )


def test_an_error_of_a_quarter_of_the_speeds_is_no_transition() -> None:
    law = Law(None, FREE)
    data = dwells(law, [0.1, -0.7, -1.2, -0.9], temperatures=None)
    quarter = 0.25 * np.log(40.0)  # from 0.4 to 16 rad/s
    why = "the branches differ too little to show where they meet. Record slower and faster speeds"
    for error, lost in ((0.999 * quarter, {}), (1.001 * quarter, {"at": why})):
        covariance = 1e-4 * np.eye(4)
        covariance[3, 3] = error**2
        fit = hand_fit(law, [0.1, -0.7, -1.2, -0.2], points=len(data), covariance=covariance)
        assert not_identified(fit, data) == lost
