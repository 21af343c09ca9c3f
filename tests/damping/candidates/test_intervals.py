"""Intervals of the candidates: methods against each other and against known cases; what is not identified."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from hersey.damping.candidates import compare_models
from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.identifiability import not_identified
from hersey.damping.candidates.intervals import (
    METHODS,
    band,
    bootstrap_draws,
    estimates,
    likelihood_ratio,
    profile_interval,
)
from hersey.damping.candidates.likelihood import (
    HUBER,
    deviance,
    log_normalisation,
    loss,
    minimise,
    scatter_beyond,
)
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, VFT, Thermal
from tests.damping.candidates.test_comparison import LAWS, REFERENCE, SPEEDS, dwells
from tests.damping.candidates.test_shared_errors import THERMAL, visited


def test_the_density_integrates_to_one_and_is_normal_without_a_limit() -> None:
    u = np.linspace(-60.0, 60.0, 400_001)
    total = np.trapezoid(np.exp(-0.5 * loss(u, HUBER)), u)
    assert np.log(total) == pytest.approx(log_normalisation(HUBER), abs=1e-9)
    r = np.random.default_rng(0).standard_normal(50)
    cost, scatter = deviance(r, np.zeros(50), limit=np.inf)
    assert scatter == pytest.approx(np.sqrt(np.mean(r**2)), rel=1e-4)
    assert cost == pytest.approx(-2 * np.sum(stats.norm.logpdf(r, scale=scatter)), rel=1e-6)


def test_scatter_is_found_beyond_the_errors() -> None:
    random = np.random.default_rng(2)
    errors = random.uniform(0.5, 1.5, 4000)
    residuals = np.hypot(errors, 2.0) * random.standard_normal(4000)
    assert scatter_beyond(residuals, errors, 4000) == pytest.approx(2.0, rel=0.05)
    assert scatter_beyond(0.5 * errors * np.sign(residuals), errors, 4000) == 0.0


def test_huber_is_the_median_of_an_outlier_and_least_squares_without() -> None:
    x = np.array([1.0, 1.1, 0.9, 1.05, 40.0])
    centre = minimise(lambda v: (x - v[0]) / 0.1, None, np.array([1.0])).values[0]
    assert centre < 1.2
    mean = minimise(lambda v: (x - v[0]) / 0.1, None, np.array([1.0]), limit=np.inf).values[0]
    assert mean == pytest.approx(x.mean())


def test_profile_of_a_straight_law_is_student_s_interval() -> None:
    law, values = LAWS["power-degC/one"]
    data = dwells(law, values)
    fit = fit_law(law, data)
    for index in range(3):
        profile = profile_interval(fit, data, index)
        error = np.sqrt(fit.covariance[index, index])
        reach = stats.t.ppf(0.975, fit.freedom) * error
        expected = fit.values[index] - reach, fit.values[index] + reach
        assert profile == pytest.approx(expected, abs=0.06 * error)


def test_profile_of_a_transition_bounds_the_cost() -> None:
    law, values = LAWS["arrhenius/two-hersey"]
    data = dwells(law, values, scatter=0.03)
    fit = fit_law(law, data)
    at = law.index("at")
    low, high = profile_interval(fit, data, at)
    assert low < values[at] < high
    from hersey.damping.candidates.fitting import search

    target = stats.t.ppf(0.975, fit.freedom) ** 2
    start = np.append(fit.values, fit.effects)
    for end in (low, high):
        rise = search(law, data, fit.disturbances, fit.sigma, start, held=(at, end)).cost - fit.cost
        assert rise == pytest.approx(target, rel=0.15)


def test_bootstrap_follows_its_seed_and_its_clusters() -> None:
    law, values = LAWS["power-degC/one"]
    data = dwells(law, values)
    fit = fit_law(law, data)
    one, same, other = (bootstrap_draws(fit, data, 60, seed) for seed in (3, 3, 4))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)
    many = bootstrap_draws(fit, data, 400, 1)
    assert np.std(many, axis=0) == pytest.approx(np.sqrt(np.diag(fit.clustered)), rel=0.3)


def test_dwells_that_share_a_disturbance_count_once() -> None:
    law, values = LAWS["power-degC/one"]
    data = dwells(law, values, scatter=0.0, twice=4)
    random = np.random.default_rng(8)
    shared = 0.02 * random.standard_normal(data.cluster.max() + 1)[data.cluster]
    from dataclasses import replace

    data = replace(data, log_torque=data.log_torque + shared)
    fit = fit_law(law, data)
    ratio = np.sqrt(np.diag(fit.clustered) / np.diag(fit.covariance))
    assert ratio == pytest.approx(2.0, rel=0.35)  # four dwells tell what one does


def test_all_four_methods_are_given() -> None:
    law, values = LAWS["vft/two-hersey"]
    data = dwells(law, values)
    fit = fit_law(law, data)
    for parameter in estimates(fit, data, draws=bootstrap_draws(fit, data, 50, 1)):
        assert set(parameter.intervals) == set(METHODS)
        assert parameter.error is not None
        assert parameter.interval is not None
        low, high = parameter.interval
        assert low < parameter.value < high


def test_no_error_for_a_corner_outside_the_speeds() -> None:
    law = Law(Thermal(CELSIUS, REFERENCE), FREE)
    data = dwells(LAWS["power-degC/one"][0], LAWS["power-degC/one"][1])
    below = float(np.log(SPEEDS[0] / data.reference_speed)) - 0.3
    fit = fit_law(law, data, [np.array([0.1, -0.9, -0.7, -1.2, below, 0.0])])
    lost = not_identified(fit, data)
    found = {p.name: p for p in estimates(fit, data)}
    assert set(lost) >= {"at", "c_mixed"}
    assert found["transition speed"].error is None
    assert found["transition speed"].interval is None
    assert "slower speeds" in str(found["transition speed"])
    assert found["c"].error is not None


def test_no_error_for_a_pole_without_a_bound() -> None:
    law = Law(Thermal(VFT, REFERENCE), ONE)
    data = dwells(law, [0.1, 2.8, 1e-4, -0.7], temperatures=np.array([395.0, 402.0, 409.0]))
    found = {p.name: p for p in estimates(fit_law(law, data), data)}
    assert found["T0"].error is None
    assert "temperatures further apart" in found["T0"].not_identified


def test_no_error_for_a_part_of_stribeck_s_curve_that_does_not_show() -> None:
    law = StribeckLaw(Thermal(ARRHENIUS, REFERENCE))
    data = dwells(law, [-1.2, 9.0, -0.2, -9.0, 1.0])
    lost = not_identified(fit_law(law, data), data)
    assert "faster speeds" in lost["viscous"]


def test_an_undetermined_candidate_is_not_chosen() -> None:
    law, values = LAWS["power-degC/one"]
    found = compare_models(dwells(law, values, seed=2), bootstrap=0, cross_validate=False)
    assert any(candidate.not_identified for candidate in found.candidates)
    assert not found.chosen.not_identified


def test_bands_hold_the_law_and_the_next_dwell() -> None:
    law, values = LAWS["arrhenius/two-hersey"]
    inside = of_law = count = 0
    for seed in range(30):
        data = dwells(law, values, seed=seed, scatter=0.02)
        fit = fit_law(law, data)
        again = dwells(law, values, seed=1000 + seed, scatter=0.02)
        found = band(fit, data.inputs)
        truth, next_one = law.predict(np.array(values), data.inputs), again.log_torque
        of_law += np.count_nonzero(
            (np.log(found.confidence[0]) <= truth) & (truth <= np.log(found.confidence[1]))
        )
        inside += np.count_nonzero(
            (np.log(found.prediction[0]) <= next_one) & (next_one <= np.log(found.prediction[1]))
        )
        count += truth.size
    assert 0.93 < inside / count < 0.98
    assert 0.88 < of_law / count <= 1.0


def test_likelihood_ratio_of_laws_within_laws_is_uniform() -> None:
    small, values = LAWS["arrhenius/two-hersey"]
    large = Law(Thermal(ARRHENIUS, REFERENCE), FREE)
    p = []
    for seed in range(40):
        data = dwells(small, values, seed=seed, scatter=0.02)
        p.append(likelihood_ratio(fit_law(small, data), fit_law(large, data)))
    assert stats.kstest(p, "uniform").pvalue > 1e-3
    data = dwells(Law(Thermal(ARRHENIUS, REFERENCE), FREE), [0.1, 2.8, -0.7, -1.2, -0.9, -3.0])
    assert likelihood_ratio(fit_law(small, data), fit_law(large, data)) < 1e-6
    assert Law(Thermal(ARRHENIUS, REFERENCE), HELD).broken


def test_limits_of_one_further_dwell_hold_it_in_another_visit() -> None:
    kelvin = [363.0, 383.0, 403.0, 423.0, 443.0, 373.0, 393.0, 413.0]
    random = np.random.default_rng(7)
    inside = 0
    for seed in range(40):
        data = visited(kelvin, between=0.03, within=0.003, seed=seed)
        found = band(fit_law(THERMAL, data), data.at(np.array([3.0]), np.array([REFERENCE])))
        z = np.log(3.0 / data.reference_speed)
        dwell = 0.1 + 0.3 * z + 0.03 * random.standard_normal() + 0.003 * random.standard_normal()
        inside += bool(np.log(found.prediction[0][0]) < dwell < np.log(found.prediction[1][0]))
    assert inside >= 35
