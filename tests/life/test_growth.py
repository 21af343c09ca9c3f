"""The growth of an indicator: known truth, limits in closed form, invariances, refusals."""

from __future__ import annotations

import json
import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate, stats

from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.growth import draws as growth_draws
from hersey.life.growth import fit as growth_module
from hersey.life.growth import limit_ages, peaks
from hersey.life.growth import posterior as growth_posterior
from hersey.life.growth.fit import Growth, fit_growth
from hersey.life.growth.law_weights import weights_by
from hersey.life.growth.laws import LAWS
from hersey.life.growth.limit_ages import ages_of_sum, heavy_tailed, quantiles
from hersey.life.growth.marginal import Specimens, likelihood
from hersey.life.growth.points import Points, falls

LAW = {law.name: law for law in LAWS}
ZERO = np.zeros(1)


def logs(
    name: str, *, units: int = 6, ages: int = 8, noise: float = 0.01, seed: int = 3, reach: float = 1.0
) -> tuple[list[str], np.ndarray, np.ndarray, np.ndarray]:
    """Specimens, ages to 600, values, and the true age of each at the value 2, formulas written out anew."""
    random = np.random.default_rng(seed)
    rate = reach * np.exp(random.normal(0.0, 0.2, units)) / 1000.0
    level = np.exp(random.normal(0.0, 0.05, units))
    t = np.tile(np.linspace(0.0, 600.0, ages), (units, 1))
    r, need = rate[:, None], 2.0 / level
    grown, true = {
        "constant": (1.0 + 0.0 * t, np.full(units, np.inf)),
        "linear": (1.0 + r * t, (need - 1.0) / rate),
        "exponential": (np.exp(r * t), np.log(need) / rate),
        "side flow": (np.sqrt(1.0 + r * t), (need**2 - 1.0) / rate),
        "saturating": (1.0 + 1000.0 * r * (1.0 - np.exp(-t / 150.0)), np.full(units, np.nan)),
    }[name]
    value = level[:, None] * grown * np.exp(random.normal(0.0, noise, t.shape))
    names = [f"F{i + 1}" for i in range(units) for _ in range(ages)]
    return names, t.ravel(), value.ravel(), true


@pytest.fixture(autouse=True)
def fewer_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    """A third of the draws: what they would tell better is the matter of the benchmark."""
    monkeypatch.setattr(growth_posterior, "_ROUNDS", (100, 100, 100, 200))
    monkeypatch.setattr(growth_posterior, "_MOST", 2.0)
    monkeypatch.setattr(growth_module, "_DRAWS", 1000)


@pytest.mark.parametrize(("name", "reach"), [("linear", 1.5), ("exponential", 1.0), ("side flow", 6.0)])
def test_a_known_truth_is_found(name: str, reach: float) -> None:
    unit, age, value, true = logs(name, reach=reach)
    growth = fit_growth(unit, age, value, 0.002)
    assert growth.effective > 100
    assert growth.weights[name] + growth.weights["curved"] > 0.7
    assert max(growth.weights, key=lambda law: growth.weights[law]) == name
    assert growth.law in {name, None}
    told = growth.reaches(2.0).units
    held = [each.age.low <= t <= each.age.high for each, t in zip(told, true, strict=True)]
    assert sum(held) >= 5
    for each, t in zip(told, true, strict=True):
        assert each.age.value == pytest.approx(t, rel=0.12)
        assert each.age.high - each.age.low < 0.65 * t
        assert each.never < 0.05


def test_what_saturates_is_called_saturating_and_may_never_reach() -> None:
    unit, age, value, _ = logs("saturating", reach=0.6)
    growth = fit_growth(unit, age, value, 0.002)
    assert growth.law == "saturating"
    assert growth.parameters["saturating"]["tau"].value == pytest.approx(150.0, rel=0.15)
    far = growth.reaches(4.0)
    assert all(each.never > 0.9 and math.isinf(each.age.value) for each in far.units)
    # no run shows what comes beyond 1.75 times the age followed
    assert str(far.units[0]) == "F1: later than 1050"
    assert growth.reaches(4.0).to_dict()["units"][0]["age"]["high"] is None


def test_what_does_not_grow_is_told_not_to() -> None:
    unit, age, value, _ = logs("constant", noise=0.02)
    growth = fit_growth(unit, age, value, 0.002, quantity="torque")
    assert growth.law == "constant"
    assert growth.headline() == "torque shows no growth"
    assert not growth.shown
    assert 0.0 < growth.rate_high < 0.1 / 600.0
    reached = growth.reaches(2.0)
    assert all(each.never > 0.9 for each in reached.units)
    # Yet it may grow unseen: the earliest ages are finite, beyond the last run, and stated.
    assert all(600.0 < each.age.low < math.inf for each in (*reached.units, reached.b10, reached.b50))
    assert str(reached.units[0]).startswith("F1: later than ")


def test_exact_lines_through_few_points_are_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without scatter the age is that of the formula, whatever the priors."""
    monkeypatch.setattr(limit_ages, "BEYOND", 0.0)
    monkeypatch.setattr(limit_ages, "OWN_BEYOND", 0.0)
    unit = [name for name in "ABCDEF" for _ in range(4)]
    age = np.tile([0.0, 10.0, 20.0, 30.0], 6)
    rate = np.repeat([0.02, 0.025, 0.03, 0.02, 0.028, 0.022], 4)
    growth = fit_growth(unit, age, 5.0 * (1.0 + rate * age), 0.0, laws=["linear"])
    for each, r in zip(growth.reaches(10.0).units, rate[::4], strict=True):
        assert each.age.value == pytest.approx(1.0 / r, rel=2e-3)
    curves = growth.at([0.0, 30.0])
    assert curves.median == pytest.approx(5.0 * (1.0 + rate[::4, None] * curves.age), rel=1e-3)
    assert (curves.low < curves.median).all()
    assert (curves.median < curves.high).all()


def test_a_unit_past_the_limit_is_told_by_the_same_draws() -> None:
    unit, age, value, _ = logs("linear", reach=1.5)
    growth = growth_of(unit, age, value)
    told = growth.reaches(1.5)
    assert all(each.passed > 0.99 for each in told.units if each.age.high < 600.0)
    assert "already passed" in told.summary()
    assert growth.reaches(0.5).units[0].age.value == 0.0


def growth_of(*columns: Any, **choices: Any) -> Growth:
    return fit_growth(*columns, 0.002, laws=["linear"], **choices)


@cache
def _plain(name: str) -> Growth:
    unit, age, value, _ = logs(name, units=3, ages=5)
    return fit_growth(unit, age, value, 0.002, laws=["linear", "saturating"])


@settings(max_examples=4, deadline=None)
@given(
    of_age=st.floats(1e-6, 1e6), of_value=st.floats(1e-6, 1e6), name=st.sampled_from(["linear", "saturating"])
)
def test_units_of_age_and_value_do_not_matter(of_age: float, of_value: float, name: str) -> None:
    unit, age, value, _ = logs(name, units=3, ages=5)
    plain = _plain(name)
    scaled = fit_growth(unit, age * of_age, value * of_value, 0.002, laws=["linear", "saturating"])
    assert scaled.weights == pytest.approx(plain.weights, rel=1e-3, abs=1e-4)
    for a, b in zip(plain.reaches(1.7).units, scaled.reaches(1.7 * of_value).units, strict=True):
        assert b.age.value == pytest.approx(a.age.value * of_age, rel=0.01)


def test_same_input_same_bits_whatever_the_order() -> None:
    unit, age, value, _ = logs("linear", units=3, ages=5)
    once, again = (growth_of(unit, age, value, seed=5).reaches(2.0) for _ in range(2))
    assert once == again
    order = np.concatenate([np.arange(5)[::-1], 5 + np.arange(10)[::-1]])
    turned = growth_of([unit[i] for i in order], age[order], value[order]).reaches(2.0)
    plain = growth_of(unit, age, value).reaches(2.0)
    found = {each.unit: each.age.value for each in turned.units}
    assert {each.unit: each.age.value for each in plain.units} == pytest.approx(found, rel=0.02)


@pytest.mark.parametrize("count", [1, 2])
def test_few_units_are_wide_and_say_so(count: int) -> None:
    unit, age, value, _ = logs("linear", units=count, ages=4, reach=1.5)
    few = fit_growth(unit, age, value, 0.002)
    assert (few.warnings[0].kind, few.warnings[0].values) == ("few specimens", {"specimens": count})
    assert str(few.warnings[0]).startswith("one specimen does" if count == 1 else "2 specimens show little")
    reached = few.reaches(2.0)
    assert (reached.b10, reached.b50) == (None, None)
    assert reached.headline().startswith(f"{reached.units[0].unit} reaches " if count == 1 else "")
    assert len(reached.to_frame()) == count
    assert few.law is None
    assert "several growth laws fit" in few.headline()


def test_values_that_fall_are_warned_of() -> None:
    unit, age, value, _ = logs("linear", reach=1.0)
    assert "values fall" in [each.kind for each in growth_of(unit, age, 1.0 / value).warnings]


def test_what_falls_at_first_and_then_grows_is_followed() -> None:
    """Run-in by 20 % with a time constant of 60, then growth: the limit lies above the fallen values."""
    unit, age, _, _ = logs("linear", units=4, ages=10)
    rate = np.repeat([0.0010, 0.0012, 0.0014, 0.0016], 10)
    noise = np.random.default_rng(5).normal(0.0, 0.01, age.size)
    value = (1.0 - 0.2 * (1.0 - np.exp(-age / 60.0)) + rate * age) * np.exp(noise)
    growth = fit_growth(unit, age, value, 0.002, laws=["linear", "exponential", "power", "run-in"])
    assert growth.law == "run-in"
    assert growth.parameters["run-in"]["d"].low < 0.2 < growth.parameters["run-in"]["d"].high
    assert "values fall" not in [each.kind for each in growth.warnings]
    for each, r in zip(growth.reaches(2.0).units, rate[::10], strict=True):
        assert each.age.low < 1.2 / r < each.age.high
        assert each.age.value == pytest.approx(1.2 / r, rel=0.15)


def test_what_still_runs_in_falls_but_what_has_run_in_does_not() -> None:
    age = np.tile(np.linspace(0.0, 1.0, 9), (3, 1))
    fallen = np.log(1.0 - 0.3 * (1.0 - np.exp(-age / 0.1)))
    rest = np.full(age.shape, 1e-4), np.ones(age.shape, dtype=bool)
    assert falls(Points(age, fallen, *rest))
    assert not falls(Points(age, fallen + 0.1 * age, *rest))


def test_evidence_counts_by_its_root_among_laws_that_grow() -> None:
    def of(law: str, evidence: float) -> growth_posterior.Posterior:
        return growth_posterior.Posterior(LAW[law], np.zeros((1, 5)), np.ones(1), evidence, ZERO)

    found = [of("constant", 1.0), of("linear", 4.0), of("power", 0.0)]
    constant, linear, power = weights_by(np.array([each.log_evidence for each in found]), found)
    assert linear / power == pytest.approx(math.exp(2.0))
    assert constant / (linear + power) == pytest.approx(math.exp(1.0) / (math.exp(4.0) + 1.0))


@pytest.mark.parametrize("law", LAWS, ids=[law.name for law in LAWS])
def test_a_law_and_its_age_are_inverses_and_its_slope_is_its_own(law: Any) -> None:
    if not law.grows:
        assert np.isinf(law.age(ZERO, np.array([0.1]), ZERO))
        return
    x, t = np.array([-0.4]), np.array([0.7])
    for shape in [np.full((len(law.shapes), 1), c) for c in (-0.8, 0.0, 0.5)]:
        y = law.log_growth(x, t, shape)
        assert law.age(x, y, shape) == pytest.approx(t, rel=1e-6)
        up, down = (law.log_growth(x + d, t, shape) for d in (1e-5, -1e-5))
        assert law.sloped(x, t, shape)[0] == pytest.approx(y, rel=1e-12)
        assert law.sloped(x, t, shape)[1] == pytest.approx((up - down) / 2e-5, rel=1e-4)


def test_the_curved_law_holds_the_others() -> None:
    x, t = np.array([-0.4]), np.linspace(0.1, 2.0, 5)
    for c, name in ((1.0, "linear"), (0.0, "exponential")):
        curved = LAW["curved"].log_growth(x, t, np.array([[c]]))
        assert curved == pytest.approx(LAW[name].log_growth(x, t, ZERO), rel=1e-4)
    drying = LAW["curved"].log_growth(np.zeros(1), np.array([0.5]), np.array([[-1.0]]))
    assert drying == pytest.approx(math.log(1.0 / (1.0 - 0.5)))


@pytest.mark.parametrize("logit", [-3.0, 0.4, 5.0])
def test_a_drying_film_follows_its_equation(logit: float) -> None:
    """Against steps in time, 0.7 of the drag growing as 1/h."""
    share, h, steps = 1.0 / (1.0 + math.exp(-logit)), 1.0, 20_000
    for _ in range(steps):
        middle = h - 0.5 * 0.6 / steps * ((1.0 - share) * h**3 + share * h)
        h -= 0.6 / steps * ((1.0 - share) * middle**3 + share * middle)
    shapes = np.array([[logit], [math.log(0.7 / 0.3)]])
    grown = LAW["drying film"].log_growth(ZERO, np.array([0.6]), shapes)
    assert grown == pytest.approx(math.log(0.3 + 0.7 / h), rel=3e-4)


def test_units_are_integrated_out_exactly() -> None:
    """Against a plain sum over level and size of one specimen."""
    age, value = np.array([[0.0, 0.4, 1.0]]), np.array([[0.02, 0.2, 0.55]])
    points = Points(age, value, np.full((1, 3), 0.02**2), np.ones((1, 3), dtype=bool))
    shared = np.array([[0.05, math.log(0.3), math.log(0.03), -0.6, math.log(0.5)]])
    found = likelihood(LAW["linear"], points, shared, np.array([-0.5]))[0]
    level, size = np.linspace(-1.5, 1.6, 1201), np.linspace(-4.0, 3.0, 1401)
    left = value[0] - np.log1p(np.exp(size)[:, None] * age[0])[None] - level[:, None, None]
    variance = 0.02**2 + 0.03**2
    density = np.exp(-0.5 * (left**2).sum(axis=2) / variance) / (2 * math.pi * variance) ** 1.5
    density *= np.exp(-0.5 * ((level - 0.05) / 0.3) ** 2)[:, None] / (0.3 * math.sqrt(2 * math.pi))
    density *= np.exp(-0.5 * ((size + 0.6) / 0.5) ** 2) / (0.5 * math.sqrt(2 * math.pi))
    total = density.sum() * (level[1] - level[0]) * (size[1] - size[0])
    assert found == pytest.approx(math.log(total), abs=1e-5)


def test_the_result_answers() -> None:
    unit, age, value, _ = logs("linear", units=3, ages=5)
    growth = growth_of(unit, age, value, quantity="torque", age_unit="h")
    told = growth.reaches(2.0)
    for result in (growth, told):
        plain = result.to_dict()
        assert json.loads(json.dumps(plain, allow_nan=False)) == plain
        assert "\n" not in repr(result)
    assert growth.to_frame().height == 5
    assert told.to_frame()["age (h)"].to_list()[:3] == [each.age.value for each in told.units]
    assert "torque reaches 2" in told.summary()
    assert growth.runs == (5, 5, 5)


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ((["A", "A"], [0, 1], [1, 0]), r"value of run 2 \(specimen 'A'\) is not positive: 0"),
        ((["A", "A"], [-1, 1], [1, 2]), r"age of run 1 \(specimen 'A'\) is negative: -1"),
        ((["A", "A"], [0, 1], [1, np.nan]), r"value of run 2 \(specimen 'A'\) is not a number"),
        ((["A", "A"], [0, 1], [1, 2], [0.1, -0.1]), r"error of run 2 \(specimen 'A'\) is negative"),
        ((["A", "A"], [0, 1, 2], [1, 2]), r"2 specimens are named, but age has shape \(3,\)"),
        ((["A", " "], [0, 1], [1, 2]), "run 2 has no specimen name"),
        ((["A", "A"], [0, 1], ["a", "b"]), "value is not a number"),
    ],
)
def test_bad_input_is_named(columns: Any, says: str) -> None:
    with pytest.raises(ParameterError, match=says):
        fit_growth(*columns)


def test_other_refusals() -> None:
    with pytest.raises(InsufficientDataError, match="no specimen was measured at two ages"):
        fit_growth(["A", "B", "B"], [1.0, 2.0, 2.0], [1.0, 2.0, 2.1])
    with pytest.raises(ParameterError, match="unknown growth law 'cubic'"):
        fit_growth(["A", "A"], [0, 1], [1, 2], laws=["cubic"])
    growth = growth_of(["A", "A", "A"], [0, 1, 2], [1, 1.5, 2])
    for limit in (0.0, math.nan, math.inf):
        with pytest.raises(ParameterError, match="must be greater than 0"):
            growth.reaches(limit)
    with pytest.raises(ParameterError, match="negative or not a number"):
        growth.at([-1.0])
    with pytest.raises(ParameterError, match="has no runs here"):
        growth.at([1.0], units=["nobody"])


def test_priors_are_those_of_the_docstring() -> None:
    text = fit_growth.__doc__ or ""
    mean, deviation = peaks.RATE_PRIOR
    assert f"N({mean:g}, {deviation:g}^2)" in text
    spreads = (peaks.LEVEL_SPREAD, peaks.RATE_SPREAD)
    medians, widths = (" and ".join(f"{each[i]:g}" for each in spreads) for i in (0, 1))
    assert f"medians {medians} and logarithms that spread by {widths}" in " ".join(text.split())
    assert f"half-normal of scale {peaks.RUN_SCATTER:g}" in text


def test_the_ends_of_an_age_hold_nine_draws_in_ten() -> None:
    low, median, high = quantiles(np.append(np.arange(1.0, 1000.0), np.inf))
    assert (low, median, high) == (50.0, 500.0, 950.0)
    assert np.isinf(quantiles(np.full(10, np.inf))).all()


def test_growth_of_new_units_is_doubted_beyond_the_greatest_last_age(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Units followed to 8 and to 40: by a power, for new ones beyond 40, for each beyond its own."""
    age = np.concatenate([np.linspace(0.0, 8.0, 9), np.linspace(0.0, 40.0, 9)])
    value = (1.0 + 0.02 * age) * np.exp(0.01 * np.random.default_rng(2).standard_normal(18))
    growth = fit_growth(["F1"] * 9 + ["F2"] * 9, age, value, 0.01)
    last, found = np.array([8.0, 40.0]), []
    for power in (1.0, 1.5):

        def beyond(_random: object, draws: int, *widths: int, by: float = power) -> Any:
            return tuple(np.full((draws, width), by) for width in widths)

        monkeypatch.setattr(growth_draws, "beyond", beyond)
        found.append(growth.drawn_ages(1.6))
    (units, new), (later_units, later_new) = found
    assert 0.1 < np.mean(new < 40.0) < 0.9
    np.testing.assert_allclose(later_new, np.where(new > 40.0, 40.0 * (new / 40.0) ** 1.5, new), rtol=1e-12)
    by_power = np.where(units > last, last * (units / last) ** 1.5, units)
    np.testing.assert_allclose(later_units, by_power, rtol=1e-12)


def test_sums_are_found_where_growth_is_steep() -> None:
    """Newton's method alone may swing between ages far apart; against the integral by fine steps."""
    law, x, c, sums = LAW["curved"], 1.41, 0.028, np.linspace(9.0, 12.0, 300)
    one = np.ones((1, sums.size))
    drawn = Specimens(law, -sums * one, x * one, np.full((1, 1, 1), c), 0.1 * np.ones((1, 1)))
    for age, goal in zip(ages_of_sum(drawn, np.zeros((1, 1))).ravel().tolist(), sums, strict=True):
        ages = np.linspace(0.0, age, 4001)
        value = np.exp(law.log_growth(np.array(x), ages, np.array([[c]])))
        assert math.log(integrate.trapezoid(value, ages)) == pytest.approx(goal, abs=0.1)  # 0.3 % of the age


def test_specimens_of_one_age_are_counted() -> None:
    unit, age, value, _ = logs("linear")
    cut = slice(None, -7)  # the last specimen at one age alone
    warnings = growth_of(unit[cut], age[cut], value[cut]).warnings
    (once,) = (each for each in warnings if each.kind == "growth of one age")
    assert (once.severity, once.values) == ("watch", {"count": 1})


def test_heavy_tails_spread_evenly_in_each_column() -> None:
    """The quantiles of Student's t with four degrees of freedom at (i + 1/2)/n, in an order of their own."""
    drawn = heavy_tailed(np.random.default_rng(3), (2000, 3))
    even = np.clip(stats.t.ppf((np.arange(2000) + 0.5) / 2000, 4.0), -5.0, 5.0)
    np.testing.assert_allclose(np.sort(drawn, axis=0), np.tile(even[:, None], 3), rtol=1e-9, atol=1e-12)
    assert not np.array_equal(drawn[:, 0], drawn[:, 1])


def test_of_one_specimen_the_spread_of_others_is_no_evidence() -> None:
    """What rises and falls again by 3 %: spreads beyond all sense once made any law certain."""
    random = np.random.default_rng(0)
    age = np.linspace(100.0, 1800.0, 20)
    value = 1.0 + 0.03 * np.sin(1.3 * math.pi * age / 1800.0) + 0.004 * random.standard_normal(20)
    growth = fit_growth(["pin"] * 20, age, value, 0.005)
    assert growth.law == "constant"
    assert growth.effective > 100.0
