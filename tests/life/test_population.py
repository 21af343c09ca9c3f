"""The Weibull law of specimens of which some have not failed: published cases, coverage, few failures."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from hersey.errors import HerseyError, InsufficientDataError, ParameterError
from hersey.life.population import Population, weibull

#: NIST/SEMATECH e-Handbook of Statistical Methods, 8.4.1.3 (data of 8.2.2.1), hours.
FAILED = [54, 187, 216, 240, 244, 335, 361, 373, 375, 386]
HANDBOOK = ([*FAILED, *[500] * 10], [True] * 10 + [False] * 10)


def numbers(law: Population) -> tuple[float, float]:
    assert law.shape is not None
    assert law.scale is not None
    return law.shape, law.scale


def test_a_published_law() -> None:
    """Shape 1.7208 and log-likelihood -75.135 as printed; the scale printed is 4e-4 h beside."""
    shape, scale = numbers(weibull(*HANDBOOK, unit="h"))
    assert round(shape, 4) == 1.7208
    assert scale == pytest.approx(606.5280, abs=5e-4)
    law = stats.weibull_min(shape, scale=scale)
    assert round(float(law.logpdf(FAILED).sum() + 10 * law.logsf(500)), 3) == -75.135
    assert round(scale * math.gamma(1 + 1 / shape), 2) == 540.74


def test_a_peer_agrees() -> None:
    ages, failed = np.array([3.0, 5.0, 6.0, 6.5, 9.0, 12.0]), np.array([True, False, True, True, False, True])
    data = stats.CensoredData(uncensored=ages[failed], right=ages[~failed])
    shape, _, scale = stats.weibull_min.fit(data, floc=0)
    assert numbers(weibull(ages, failed)) == pytest.approx((shape, scale), rel=1e-4)


def test_published_median_ranks() -> None:
    """Kececioglu, Reliability & Life Testing Handbook 2 (1994), table 3.1, which approximates."""
    ages = [5100, 9500, 15000, 22000, 40000]
    at, ranks = weibull(ages, [True, False, True, False, True]).median_ranks
    assert at.tolist() == [5100, 15000, 40000]
    assert ranks == pytest.approx([0.1294, 0.361, 0.7084], abs=1.2e-3)
    assert ranks[0] == pytest.approx(1 - 0.5 ** (1 / 5), rel=1e-12)


def test_a_unit_taken_off_at_the_age_of_a_failure_had_outlived_it() -> None:
    ranks = weibull([10, 10, 20], [False, True, True]).median_ranks[1]
    assert ranks[0] == pytest.approx(1 - 0.5 ** (1 / 3), rel=1e-12)


def test_intervals_cover() -> None:
    """In 300 campaigns of 8 specimens that end at the fourth failure, intervals of B10 hold in 90 %."""
    units = np.sort(1000 * np.random.default_rng(7).weibull(2.0, (300, 8)), axis=1)
    ages = np.minimum(units, units[:, 3:4])
    told = [weibull(each, np.arange(8) < 4).b_life(0.10) for each in ages]
    truth = 1000 * math.sqrt(-math.log(0.9))
    above, below = np.mean([(each.low > truth, each.high < truth) for each in told], axis=0)
    assert 0.85 <= 1 - above - below <= 0.95
    assert min(above, below) > 0.02  # it misses on both sides


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.floats(0.5, 2.0), st.booleans()), min_size=2, max_size=12),
    st.sampled_from([1e-6, 3.0, 1e9]),
)
def test_units_of_age_do_not_matter(units: list[tuple[float, bool]], factor: float) -> None:
    ages, failed = np.array([u[0] for u in units]), [u[1] for u in units]
    law, other = weibull(ages, failed), weibull(factor * ages, failed)
    text = json.dumps(law.to_dict(), allow_nan=False)
    assert "nan" not in (text + law.summary()).lower()
    assert (law.shape is None) == (other.shape is None)
    if law.shape is not None:
        shape, scale = numbers(law)
        assert numbers(other) == pytest.approx((shape, factor * scale), rel=1e-6)
        for share in (0.1, 0.5):
            b = law.b_life(share)
            assert b.low < b.age < b.high
    else:
        assert [each.kind for each in law.warnings] == ["no law of failures"]


@pytest.mark.parametrize(
    ("failed", "words"),
    [
        ([False, False, False], "No specimen has failed up to 30 pages"),
        ([True, False, False], "Only one specimen has failed, at 10 pages"),
    ],
)
def test_too_few_failures_are_warned_of(failed: list[bool], words: str) -> None:
    law = weibull([10, 20, 30], failed, unit="pages")
    assert words in law.summary()
    assert law.warnings[0].values["failures"] == sum(failed)
    assert law.warnings[0].values["age"] == (10.0 if any(failed) else 30.0)
    assert law.to_dict()["b10"] is None
    with pytest.raises(InsufficientDataError, match=words):
        law.b_life(0.1)
    with pytest.raises(InsufficientDataError, match=words):
        law.lives([0.1])


def test_two_failures_show_little() -> None:
    law = weibull([10, 20, 30], [True, True, False], unit="pages")
    assert [(each.kind, each.values) for each in law.warnings] == [("few failures", {"failures": 2})]
    assert "Two failures show little" in law.summary()
    b10 = law.b_life(0.10)
    assert b10.low < b10.age / 100
    assert "which shows no spread" in weibull([10, 10], [True, True]).summary()


def test_what_the_shape_says() -> None:
    ages = np.linspace(90, 110, 12)
    assert "wear out" in weibull(ages, [True] * 12).verdict()
    assert "fail early" in weibull(10.0 ** np.arange(12), [True] * 12).verdict()
    assert "is unknown" in weibull(*HANDBOOK).verdict()


def test_the_same_seed_gives_the_same_bits() -> None:
    assert weibull(*HANDBOOK).to_dict() == weibull(*HANDBOOK).to_dict()
    assert weibull(*HANDBOOK, seed=1).shape_interval != weibull(*HANDBOOK).shape_interval
    wide, narrow = weibull(*HANDBOOK, level=0.95), weibull(*HANDBOOK, level=0.5)
    assert wide.b_life(0.1).low < narrow.b_life(0.1).low < narrow.b_life(0.1).high < wide.b_life(0.1).high


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: weibull([1.0, -2.0], [True, True]), "age 1 is -2"),
        (lambda: weibull([1.0, math.nan], [True, True]), "age 1 is nan"),
        (lambda: weibull([1.0, 2.0], [True]), "equal length"),
        (lambda: weibull([1.0, 2.0], [1, 3]), "true or false"),
        (lambda: weibull([], []), "ages is empty"),
        (lambda: weibull([1.0], [True], level=90), "level is 90"),
        (lambda: weibull(*HANDBOOK).b_life(10), "share is 10"),
    ],
)
def test_what_is_refused(call: object, words: str) -> None:
    with pytest.raises(HerseyError, match=words) as told:
        call()  # type: ignore[operator]
    assert isinstance(told.value, ParameterError)


def test_a_table_of_what_is_told() -> None:
    table = weibull(*HANDBOOK, unit="h").to_frame()
    assert table.filter(table["name"] == "B10")["unit"].item() == "h"
    assert table.filter(table["name"] == "failed")["value"].item() == 10
