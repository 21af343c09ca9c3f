"""Intervals, bands and what is quoted, each number by hand from a fit made by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.intervals import (
    METHODS,
    ParameterEstimate,
    band,
    bootstrap_draws,
    estimates,
    likelihood_ratio,
    profile_interval,
    quantities,
)
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.refits import resampled
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, KELVIN, VFT, Thermal
from tests.damping.candidates.cases import even, hand_fit, inputs
from tests.damping.candidates.test_comparison import REFERENCE, dwells

STRAIGHT = Law(Thermal(KELVIN, REFERENCE), ONE)
VALUES = [0.1, -2.4, -0.7]
R = 8.31446261815324
#: Reference speed of the grid: the geometric mean of 0.4 and 16 rad/s.
W = np.sqrt(0.4 * 16.0)


@pytest.fixture(scope="module")
def data() -> Observations:
    """Few clusters, so that Student's t is far from normal."""
    full = even(STRAIGHT, VALUES)
    return replace(full, cluster=full.cluster % 6)


@pytest.fixture(scope="module")
def fit(data: Observations) -> LawFit:
    return fit_law(STRAIGHT, data)


def test_intervals_by_covariance_and_clusters_have_their_own_freedom(data: Observations, fit: LawFit) -> None:
    found = estimates(fit, data, profile=False)
    assert [p.name for p in found] == ["damping at reference", "b", "c"]
    for method, covariance, freedom in (
        ("covariance", fit.covariance, len(data) - 3),
        ("clustered", fit.clustered, 6 - 3),
    ):
        reach = stats.t.ppf(0.975, freedom) * np.sqrt(np.diag(covariance))
        for index in (1, 2):
            value = fit.values[index]
            ends = value - reach[index], value + reach[index]
            assert found[index].intervals[method] == pytest.approx(ends, rel=1e-10)
        ends = tuple(np.exp(fit.values[0] + side * reach[0]) / W for side in (-1, 1))
        assert found[0].intervals[method] == pytest.approx(ends, rel=1e-10)
    assert set(found[0].intervals) == {"covariance", "clustered"}
    errors = np.sqrt(np.diag(fit.covariance))
    assert found[0].value == pytest.approx(np.exp(fit.values[0]) / W, rel=1e-12)
    assert found[0].error == pytest.approx(errors[0] * np.exp(fit.values[0]) / W, rel=1e-6)
    assert [p.error for p in found[1:]] == pytest.approx(errors[1:], rel=1e-6)
    assert [p.value for p in found[1:]] == pytest.approx(fit.values[1:], rel=1e-12)


def test_few_clusters_leave_one_degree_of_freedom(data: Observations, fit: LawFit) -> None:
    three = replace(data, cluster=data.cluster % 3)
    found = estimates(fit, three, profile=False)[2]
    reach = 12.706204736 * np.sqrt(fit.clustered[2, 2])
    assert found.intervals["clustered"] == pytest.approx(
        (fit.values[2] - reach, fit.values[2] + reach), rel=1e-8
    )


def test_profile_of_a_straight_law_is_student_s_interval(data: Observations, fit: LawFit) -> None:
    by_profile = estimates(fit, data)
    for index in range(3):
        error = np.sqrt(fit.covariance[index, index])
        reach = stats.t.ppf(0.975, len(data) - 3) * error
        ends = fit.values[index] - reach, fit.values[index] + reach
        assert profile_interval(fit, data, index) == pytest.approx(ends, abs=2e-5 * error)
        if index:
            assert by_profile[index].intervals["profile"] == pytest.approx(ends, abs=2e-5 * error)
            assert by_profile[index].interval == by_profile[index].intervals["profile"]


def test_bootstrap_is_widened_for_the_parameters_it_took(data: Observations, fit: LawFit) -> None:
    draws = fit.values + np.linspace(-1.0, 3.0, 4001)[:, None] * np.array([0.01, 0.02, 0.03])
    found = estimates(fit, data, draws=draws, profile=False)
    # six clusters and three parameters
    wider = np.sqrt(6 / 3) * stats.t.ppf(0.975, 3) / stats.norm.ppf(0.975)
    for index, unit in ((1, 0.02), (2, 0.03)):
        low, high = fit.values[index] - wider * 0.9 * unit, fit.values[index] + wider * 2.9 * unit
        assert found[index].intervals["bootstrap"] == pytest.approx((low, high), rel=1e-9)
    three = replace(data, cluster=data.cluster % 3)
    found = estimates(fit, three, draws=draws, profile=False)
    wider = np.sqrt(3.0) * stats.t.ppf(0.975, 1) / stats.norm.ppf(0.975)
    low, high = fit.values[2] - wider * 0.9 * 0.03, fit.values[2] + wider * 2.9 * 0.03
    assert found[2].intervals["bootstrap"] == pytest.approx((low, high), rel=1e-9)


def test_bootstrap_of_gaussian_draws_is_as_wide_as_theirs(data: Observations, fit: LawFit) -> None:
    normal = stats.norm.ppf((np.arange(20000) + 0.5) / 20000)
    draws = fit.values + 0.01 * normal[:, None]
    many = replace(data, cluster=np.arange(len(data), dtype=np.intp))
    low, high = estimates(fit, many, draws=draws, profile=False)[2].intervals["bootstrap"]
    n = len(data)
    expected = 2 * 0.01 * stats.t.ppf(0.975, n - 3) * np.sqrt(n / (n - 3))
    assert high - low == pytest.approx(expected, rel=1e-3)


def test_bootstrap_draws_are_those_of_resampling(data: Observations, fit: LawFit) -> None:
    assert np.array_equal(bootstrap_draws(fit, data, 4, 6), resampled(fit, data, 4, 6))
    assert bootstrap_draws(fit, data).shape == (400, 3)
    assert np.array_equal(bootstrap_draws(fit, data, 2), resampled(fit, data, 2, 1))


def open_to(data: Observations, fit: LawFit, aside: float, share: float, cost: float) -> str:
    """What is said of c if its value is moved by its errors, and steps are a share of its error."""
    moved = fit.values + aside * np.sqrt(fit.covariance[2, 2]) * np.array([0.0, 0.0, 1.0])
    shrunk = replace(fit, values=moved, covariance=fit.covariance * share**2, cost=cost)
    found = estimates(shrunk, data)[2]
    assert found.error is None
    assert found.interval is None
    assert found.intervals == {}
    assert found.value == moved[2]
    return str(found)


def test_an_open_profile_says_to_which_side(data: Observations, fit: LawFit) -> None:
    said = (
        "cannot be determined: the data do not bound it from {}. Record more temperatures and slower "
        "and faster speeds"
    )
    # eight steps of a hundredth of an error raise the cost by next to nothing
    assert open_to(data, fit, 0.0, 0.01, fit.cost) == said.format("either side")
    # from one error below, two errors up reach one above: a rise of 1; two down reach a rise of 9
    assert open_to(data, fit, -1.0, 0.25, fit.cost) == said.format("above")
    assert open_to(data, fit, 1.0, 0.25, fit.cost) == said.format("below")


def test_what_is_quoted_is_the_profile_else_the_covariance() -> None:
    both = ParameterEstimate("c", "", 0.5, 0.1, {"covariance": (0.3, 0.7), "profile": (0.2, 0.9)})
    assert both.interval == (0.2, 0.9)
    assert str(both) == "0.5 [0.2, 0.9]"
    alone = ParameterEstimate("c", "", 0.512345678, 0.1, {"covariance": (0.3, 0.7)})
    assert alone.interval == (0.3, 0.7)
    assert str(alone) == "0.51235 [0.3, 0.7]"
    none = ParameterEstimate("c", "", 0.5, None, {}, "too few")
    assert none.interval is None
    assert str(none) == "cannot be determined: too few"
    assert METHODS == ("covariance", "clustered", "profile", "bootstrap")


def named(
    law: Law | StribeckLaw, values: list[float], data: Observations
) -> dict[str, tuple[str, float, str]]:
    """Quantities by name: unit, value, and which parameter."""
    fit = hand_fit(law, values, points=len(data))
    return {
        q.name: (q.unit, q.of(values[q.parameter]), law.names[q.parameter]) for q in quantities(fit, data)
    }


def test_quantities_of_a_broken_law_by_hand() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), FREE)
    values = [0.1, 2.8, -0.7, -1.2, -0.9, -5.0]
    found = named(law, values, dwells(law, values))
    assert found == {
        "damping at reference": ("N m s/rad", pytest.approx(np.exp(0.1) / W), "level"),
        "activation energy of torque": ("kJ/mol", pytest.approx(2.8 * R * 0.4), "e"),
        "c": ("", -0.7, "c"),
        "c below the transition": ("", -1.2, "c_mixed"),
        "transition speed": ("rad/s", pytest.approx(W * np.exp(-0.9)), "at"),
        "activation energy of the transition speed": ("kJ/mol", pytest.approx(5.0 * R * 0.4), "d"),
    }


def test_quantities_of_a_pole_and_of_powers_by_hand() -> None:
    law = Law(Thermal(VFT, REFERENCE), FREE)
    values = [0.1, 2.8, 1 / 190.0, -0.7, -1.2, -0.9, -5.0]
    found = named(law, values, dwells(law, values))
    # at the reference VFT has the slope of Arrhenius
    assert found["activation energy of torque"] == ("kJ/mol", pytest.approx(2.8 * R * 0.4), "e")
    assert found["T0"] == ("K", pytest.approx(210.0), "q")
    assert found["activation energy of the transition speed"][1] == pytest.approx(5.0 * R * 0.4)
    for kind in (CELSIUS, KELVIN):
        law = Law(Thermal(kind, REFERENCE), FREE)
        values = [0.1, -2.4, -0.7, -1.2, -0.9, 3.0]
        found = named(law, values, dwells(law, values))
        assert found["b"] == ("", -2.4, "e")
        assert found["exponent of the transition speed in temperature"] == ("", 3.0, "d")
        assert len(found) == 6


def test_quantities_of_exponents_per_temperature_by_hand() -> None:
    law = Law(Thermal(KELVIN, REFERENCE), HELD, groups=4)
    values = [0.1, -2.4, -0.6, -0.65, -0.7, -0.75, -1.2, -0.9]
    data = dwells(law, values)
    found = named(law, values, data)
    by_heat = {name: value for name, (_, value, _) in found.items() if name.startswith("c at")}
    assert by_heat == {
        "c at 90 degC": -0.6,
        "c at 120 degC": -0.65,
        "c at 150 degC": -0.7,
        "c at 180 degC": -0.75,
    }
    assert "exponent of the transition speed in temperature" not in found
    alone = Law(None, FREE)
    found = named(alone, [0.1, -0.7, -1.2, -0.9], dwells(alone, [0.1, -0.7, -1.2, -0.9], temperatures=None))
    assert list(found) == ["damping at reference", "c", "c below the transition", "transition speed"]


def test_quantities_of_stribeck_s_curve_by_hand() -> None:
    law = StribeckLaw(Thermal(ARRHENIUS, REFERENCE))
    values = [-1.2, 9.0, -0.2, -2.0, 0.2]
    found = named(law, values, dwells(law, values))
    assert found == {
        "Coulomb torque": ("N m", pytest.approx(np.exp(-1.2)), "level"),
        "activation energy of viscosity": ("kJ/mol", pytest.approx(9.0 * R * 0.4), "e"),
        "ln(Stribeck peak / Coulomb)": ("", -0.2, "stick"),
        "ln(viscous torque at the Stribeck speed / Coulomb)": ("", -2.0, "viscous"),
        "Stribeck speed": ("rad/s", pytest.approx(W * np.exp(0.2)), "at"),
    }
    data = dwells(law, values)
    level = quantities(hand_fit(law, values), data)[0]
    assert level.of(900.0) == pytest.approx(np.exp(700.0))  # the largest number there is, nearly


def test_an_interval_of_a_falling_quantity_is_in_order() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), FREE)
    values = [0.1, 2.8, -0.7, -1.2, -0.9, -5.0]
    data = dwells(law, values)
    fit = hand_fit(law, values, points=len(data))
    found = estimates(fit, data, profile=False)[-1]
    reach = stats.t.ppf(0.975, len(data) - 6) * np.sqrt(fit.covariance[5, 5])
    unit = R * 0.4
    assert found.intervals["covariance"] == pytest.approx(((5 - reach) * unit, (5 + reach) * unit))
    assert found.error == pytest.approx(np.sqrt(fit.covariance[5, 5]) * unit, rel=1e-6)


@pytest.mark.parametrize("points", [9, 25])
def test_bands_by_hand(points: int) -> None:
    law = Law(Thermal(KELVIN, REFERENCE), ONE)
    fit = hand_fit(law, VALUES, points=points)
    where = inputs([-1.0, 0.3, 1.2], [370.0, 400.0, 440.0])
    found = band(fit, where)
    reach = stats.t.ppf(0.975, points - 3)
    middle = np.median(fit.errors)
    assert middle > 0.01
    for i, (z, kelvin) in enumerate(zip([-1.0, 0.3, 1.2], [370.0, 400.0, 440.0], strict=True)):
        g = np.array([1.0, np.log(kelvin / 400.0), z])
        centre = 0.1 - 2.4 * g[1] + 0.3 * z
        variance = g @ fit.covariance @ g
        assert found.torque[i] == pytest.approx(np.exp(centre), rel=1e-12)
        for ends, width in (
            (found.confidence, np.sqrt(variance)),
            (found.prediction, np.sqrt(variance + 0.03**2 + middle**2)),
        ):
            assert ends[0][i] == pytest.approx(np.exp(centre - reach * width), rel=1e-10)
            assert ends[1][i] == pytest.approx(np.exp(centre + reach * width), rel=1e-10)


def test_likelihood_ratio_is_an_f_test_by_hand() -> None:
    small = hand_fit(STRAIGHT, VALUES, points=14, deviance=-60.0)
    law = Law(Thermal(KELVIN, REFERENCE), FREE)
    large = hand_fit(law, [0.1, -2.4, -0.7, -1.2, -0.9, 3.0], points=14, deviance=-68.0)
    # for a normal law the deviance is n ln(sum of squares)
    ratio = (np.exp(8.0 / 14) - 1) * 8 / 3
    assert likelihood_ratio(small, large) == pytest.approx(stats.f.sf(ratio, 3, 8), rel=1e-10)
    worse = replace(large, deviance=-59.0)
    assert likelihood_ratio(small, worse) == 1.0


@pytest.mark.parametrize("seed", [1, 5])
def test_profile_of_a_corner_ends_at_its_last_crossing(seed: int) -> None:
    """Against a scan of the cost in small steps from either side, each step a fit from several starts."""
    law, values = Law(None, FREE), [0.1, -0.7, -1.2, -0.5]
    data = dwells(law, values, temperatures=None, scatter=0.0)
    noise = 0.08 * np.random.default_rng(seed).choice([-1.0, 1.0], len(data))
    data = replace(data, log_torque=data.log_torque + noise)
    fit = fit_law(law, data)
    found = profile_interval(fit, data, 3)
    error = float(np.sqrt(fit.covariance[3, 3]))
    target = stats.t.ppf(0.975, len(data) - 4) ** 2
    z, y = data.inputs.log_speed, data.log_torque

    def rise(at: float) -> float:
        """Linear least squares at a fixed corner: no residual of these is beyond Huber's limit."""
        x = np.column_stack([np.ones_like(z), np.maximum(z - at, 0.0), np.minimum(z - at, 0.0)])
        u = (y - x @ np.linalg.lstsq(x / fit.sigma[:, None], y / fit.sigma, rcond=None)[0]) / fit.sigma
        assert np.max(np.abs(u)) < 2.5
        return float(np.sum(u**2)) - fit.cost

    for end, side in zip(found, (-1.0, 1.0), strict=True):
        steps = np.arange(0.0, abs(end - fit.values[3]) / error + 1.4, 0.01)
        inside = [s for s in steps if rise(fit.values[3] + side * s * error) < target]
        assert abs(end - fit.values[3]) / error == pytest.approx(max(inside), abs=0.04)
