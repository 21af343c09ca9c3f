"""The age of a planned replacement, against integrals by quadrature and ages in closed form."""

from __future__ import annotations

import json
import math
from functools import cache

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import gamma

import hersey
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.replacement import best_replacement, costs, places

AGES = [54, 187, 216, 240, 244, 335, 361, 373, 375, 386, 500]


@cache
def wearing() -> hersey.FailureLaw:
    """A Weibull law of shape 2.5."""
    return hersey.weibull(AGES, [True] * 10 + [False], unit="h")


@pytest.mark.parametrize("ratio", [3.0, 10.0, 100.0])
def test_a_weibull_law_gives_the_age_of_quadrature(ratio: float) -> None:
    law = wearing()
    shape, scale = (each.value for each in law.parameters)

    def outlives(age: float) -> float:
        return math.exp(-((age / scale) ** shape))

    def cost(age: float) -> float:
        lived: float = quad(outlives, 0.0, age, epsabs=0.0, epsrel=1e-10)[0]
        return (outlives(age) + ratio * (1.0 - outlives(age))) / lived

    best = minimize_scalar(cost, bounds=(1.0, 500.0), method="bounded", options={"xatol": 1e-6})
    to_failure = ratio / (scale * float(gamma(1.0 + 1.0 / shape)))
    found = hersey.replacement_age(law, ratio)
    assert found.age.value == pytest.approx(best.x, rel=1e-3)
    assert found.saving.value == pytest.approx(1.0 - best.fun / to_failure, abs=2e-3)
    assert found.age.low < best.x < found.age.high
    at = np.array([50.0, 150.0, 300.0])
    assert np.interp(at, found.ages, found.cost) == pytest.approx(
        [cost(t) / to_failure for t in at], rel=2e-3
    )


def test_the_answer_is_in_words_and_whole() -> None:
    found = hersey.replacement_age(wearing(), 10.0)
    assert (found.pays, found.until, found.level) == ("yes", None, 0.9)
    assert found.summary() == (
        "Replace at 120 h (90 %: 93.9 to 191 h). That costs 57 % less per h than running to failure (90 %: "
        "10 % to 67 %), if a failure costs 10 times a planned replacement."
    )
    plain = found.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert found.to_frame().columns == ["age (h)", "cost (1)", "cost low (1)", "cost high (1)"]
    unsure = hersey.replacement_age(wearing(), 3.0)
    assert unsure.pays == "not yet decided"
    assert unsure.headline().startswith(
        "whether a planned replacement pays is not yet decided. At 225 h it costs 13 % more to 31 % less"
    )


def test_what_does_not_wear_out_is_run_to_failure() -> None:
    law = hersey.weibull(AGES, [True] * 10 + [False], shape=1.0)
    found = hersey.replacement_age(law, 10.0)
    assert (found.pays, found.age.value, found.saving.value) == ("no", math.inf, 0.0)
    assert (
        found.summary() == "No planned replacement pays, if a failure costs 10 times a planned replacement."
    )
    assert found.to_dict()["age"]["value"] is None


def uniform(life: float, ages: np.ndarray, ratio: float) -> np.ndarray:
    """The cost where ages at failure are uniform up to a life, over that of running to failure."""
    at = np.minimum(ages / life, 1.0)
    cost = costs(1.0 - at, life * (at - 0.5 * at**2), ratio)
    return np.asarray(cost / cost[-1])


def test_draws_of_uniform_lives_give_the_age_in_closed_form() -> None:
    """It is (sqrt(2 c - 1) - 1) / (c - 1) of the life, a third at c = 13."""
    ages, lives = places(5000.0), np.linspace(900.0, 1100.0, 201)
    drawn = np.stack([uniform(life, ages, 13.0) for life in lives])
    found = best_replacement(
        ages, drawn, uniform(1000.0, ages, 13.0), cost_of_failure=13.0, unit="pages", until=5000.0
    )
    assert found.age.value == pytest.approx(1000.0 / 3.0, rel=1e-3)
    assert (found.age.low, found.age.high) == pytest.approx((910.0 / 3.0, 1090.0 / 3.0), rel=2e-3)
    # C(1/3) = (1 + 12 / 3) / (1/3 - 1/18) = 18 of 26.
    assert found.saving.value == pytest.approx(1.0 - 18.0 / 26.0, abs=1e-3)
    late = best_replacement(
        ages, drawn, uniform(1000.0, ages, 13.0), cost_of_failure=13.0, unit="pages", until=300.0
    )
    assert late.pays == "not yet decided"
    assert "the age of least cost, 333 pages, is later than the runs show (300 pages), if" in late.summary()
    assert found.pays == "yes"
    assert "per page than running to failure" in found.summary()


def test_half_of_the_draws_that_wear_out_decide_nothing() -> None:
    ages = places(5000.0)
    wears, lasts = (
        uniform(1000.0, ages, 13.0),
        costs(np.exp(-ages / 800), 800 * (1 - np.exp(-ages / 800)), 13.0),
    )
    drawn = np.stack([wears, lasts / lasts[-1]] * 10)
    settings = {"cost_of_failure": 13.0, "unit": "pages", "until": 5000.0}
    found = best_replacement(ages, drawn, drawn.mean(axis=0), **settings)
    assert (found.pays, found.age.high) == ("not yet decided", math.inf)
    none = best_replacement(ages, drawn[1::2], drawn[1], **settings)
    assert none.summary().startswith("No planned replacement before 5000 pages pays, if")


@pytest.mark.parametrize(("left", "pays"), [(0.02, "no"), (0.9, "not yet decided")])
def test_where_most_outlive_the_last_age_running_to_failure_has_no_cost_yet(left: float, pays: str) -> None:
    ages = places(300.0)
    falling = np.linspace(3.0, 1.0, ages.size)
    found = best_replacement(
        ages, np.tile(falling, (50, 1)), falling, cost_of_failure=10.0, unit="h", until=None, left=left
    )
    assert (found.pays, found.age.value) == (pays, math.inf)


def test_a_cost_that_cannot_be_asked_for_is_refused() -> None:
    for cost in (1.0, -2.0, 1e6):
        with pytest.raises(
            ParameterError, match=r"must be above 1 and at most 10000\. It is the cost of a fail"
        ):
            hersey.replacement_age(wearing(), cost)
    with pytest.raises(InsufficientDataError):
        hersey.replacement_age(hersey.weibull([5.0, 6.0], [False, False]), 10.0)
