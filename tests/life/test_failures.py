"""Laws of failures and suspensions: bounds, failure modes, a fleet, the next test."""

from __future__ import annotations

import itertools
import json
import math
from functools import cache

import numpy as np
import pytest
from scipy import integrate, stats

import hersey
from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.failures import forecast
from hersey.life.failures.distributions import DISTRIBUTIONS, LOGNORMAL, WEIBULL
from hersey.life.failures.fit import age_held, fitted
from hersey.life.failures.likelihood import Observed, log_between
from hersey.life.failures.maximum import maximum
from hersey.life.failures.positions import positions, steps
from hersey.life.failures.replicates import drawn
from hersey.life.failures.test_plan import specimens_for
from tests.conftest import ROOT

#: NIST/SEMATECH e-Handbook of Statistical Methods, 8.2.2.1, hours.
HANDBOOK = ROOT / "examples" / "failures.csv"


@cache
def handbook() -> hersey.FailureLaw:
    return hersey.weibull(HANDBOOK)


def numbers(law: hersey.FailureLaw) -> list[float]:
    return [each.value for each in law.parameters]


def test_an_activation_energy_is_found_again() -> None:
    """Exact ages of a law of 0.7 eV at three temperatures, at the places where they are expected."""
    kelvin = np.repeat([330.0, 350.0, 370.0], 12)
    ranks = np.tile((np.arange(12) + 0.5) / 12, 3)
    ages = np.exp(0.7 / (8.617333262e-5 * kelvin) - 15) * (-np.log1p(-ranks)) ** 0.5
    sample = hersey.Failures(ages, ages, np.ones(36, dtype=int), "h", (), kelvin, "K", "arrhenius", 300.0)
    law = hersey.weibull(sample, calibrate=False)
    assert law.acceleration is not None
    assert law.acceleration.effect == pytest.approx(0.7, abs=1e-8)
    assert law.acceleration.low < 0.7 < law.acceleration.high
    assert law.acceleration.same_shape == pytest.approx(1.0)
    assert law.at_use.low == pytest.approx(law.at_use.high)
    places, shares = law.positions  # carried over to 300 K
    assert places.size == 36
    assert law.share_failed(places) == pytest.approx(shares, abs=0.05)
    ratio = math.exp(0.7 / 8.617333262e-5 * (1 / 300 - 1 / 350))
    at_350 = hersey.weibull(ages[12:24], np.ones(12, dtype=bool), calibrate=False)
    assert law.b_lives[1].age == pytest.approx(ratio * at_350.b_lives[1].age, rel=1e-7)


def test_failure_modes_at_several_stresses_are_one_law_with_a_warning() -> None:
    kelvin = np.repeat([330.0, 350.0], 6)
    ages = np.array([60.0, 70, 80, 90, 100, 110, 12, 30, 35, 40, 45, 70])
    modes = ("wear", "seizure") * 6
    sample = hersey.Failures(ages, ages, np.ones(12, dtype=int), "h", modes, kelvin, "K", "arrhenius", 300.0)
    law = hersey.weibull(sample, calibrate=False)
    assert law.modes == ()
    (told,) = [each for each in law.warnings if each.kind == "failure modes under stress"]
    assert set(told.values["modes"].split(", ")) == {"wear", "seizure"}
    alone = 0.0
    for own in (ages[:6], ages[6:]):
        shape, _, scale = stats.weibull_min.fit(own, floc=0)
        alone += stats.weibull_min.logpdf(own, shape, scale=scale).sum()
    assert law.acceleration is not None
    assert law.log_likelihood is not None
    ratio = 2 * (alone - law.log_likelihood)
    assert law.acceleration.same_shape == pytest.approx(stats.chi2.sf(ratio, 4 - 3), rel=1e-4)


@pytest.mark.parametrize("name", DISTRIBUTIONS)
def test_laws_agree_with_scipy(name: str) -> None:
    law, k = DISTRIBUTIONS[name], np.array(1.7)
    own = {
        "weibull": stats.weibull_min(1.7),
        "lognormal": stats.lognorm(1 / 1.7),
        "gamma": stats.gamma(1.7),
    }[name]
    ages = np.array([1e-4, 0.02, 0.7, 3.0, 12.0])
    x = np.log(ages)
    assert law.log_density(x, k) == pytest.approx(own.logpdf(ages) + x, rel=1e-9)
    assert law.log_survival(x, k) == pytest.approx(own.logsf(ages), rel=1e-9)
    assert law.log_failed(x, k) == pytest.approx(own.logcdf(ages), rel=1e-9)
    assert np.exp(law.quantile(np.array([0.01, 0.6]), k)) == pytest.approx(own.ppf([0.01, 0.6]), rel=1e-9)
    ends = np.array([-np.inf]), np.array([np.inf])
    assert log_between(law, *ends, k) == pytest.approx([0.0], abs=1e-12)
    assert log_between(law, x[:1], x[1:2], k) == pytest.approx(
        np.log(own.cdf(ages[1:2]) - own.cdf(ages[:1])), rel=1e-9
    )


def test_a_late_interval_keeps_its_digits() -> None:
    """What fails between two ages that a share of exp(-60) outlives."""
    low, high = 60 ** (1 / 1.7), 61 ** (1 / 1.7)
    between = log_between(WEIBULL, np.log([low]), np.log([high]), np.array(1.7))
    assert between == pytest.approx([-60 + math.log(-math.expm1(-1))], rel=1e-9)


def test_an_inspection_of_no_width_is_an_exact_age() -> None:
    ages = np.array([54.0, 187, 216, 240, 500])
    failed = np.array([True, True, True, True, False])
    exact = hersey.weibull(ages, failed, calibrate=False)
    high = np.where(failed, ages * (1 + 1e-5), np.inf)
    narrow = hersey.weibull(hersey.Failures(ages, high, np.ones(5, dtype=int)), calibrate=False)
    assert numbers(narrow) == pytest.approx(numbers(exact), rel=2e-5)


def test_calibrated_bounds_are_exact_where_a_test_ends_at_a_failure() -> None:
    """In 2,000 samples of 10 that end at the sixth failure the roots of B10 lie within in 90 %."""
    truth, samples = np.array(math.log((-math.log(0.9)) ** 0.5)), 2000
    samples_of = np.log(np.sort(np.random.default_rng(7).weibull(2.0, (samples, 10)), axis=1))
    ages = np.exp(samples_of[0, [*range(6), 5]])
    count = np.array([1, 1, 1, 1, 1, 1, 4])
    fit = fitted(WEIBULL, hersey.Failures(ages, np.append(ages[:6], np.inf), count))
    low, high = fit._roots(np.array([0.1]), 0.9, age_held, 0.0)
    own = Observed(
        exact=samples_of[:, :6],
        right=samples_of[:, 5:6],
        exact_count=np.ones(6),
        right_count=np.array([4.0]),
        exact_stress=np.zeros(6),
        right_stress=np.zeros(1),
    )
    free = fit.problem(0.1, of=own)
    held = age_held(free, truth)
    at, best = maximum(free.function(), np.tile(fit.start(free), (samples, 1)))
    _, of_truth = maximum(held.function(), np.tile(fit.start(held), (samples, 1)))
    roots = np.sign(at[:, 0] - truth) * np.sqrt(2 * np.maximum(best - of_truth, 0))
    assert ((low <= roots) & (roots <= high)).mean() == pytest.approx(0.9, abs=0.02)
    assert (roots < low).mean() == pytest.approx(0.05, abs=0.015)


def test_drawn_specimens_are_looked_at_as_long_as_the_real_ones() -> None:
    """Five are withdrawn after the look at 5, ten others are looked at until 10."""
    low, high = np.array([0.0, 5, 10, 5]), np.array([5.0, 10, np.inf, np.inf])
    looked_at = hersey.Failures(low, high, np.array([3, 3, 4, 5]))
    truth = (math.log(8.0), 2.0, 0.0)
    of = drawn(WEIBULL, looked_at, np.zeros(4), truth, 4000, np.random.default_rng(1))
    assert np.exp(of.high[0]).tolist() == pytest.approx([5, np.inf, 5, 10, np.inf])
    assert set(of.between_count[:, :2].sum(axis=1)) == {5.0}
    assert set(of.between_count[:, 2:].sum(axis=1)) == {10.0}
    outlive = np.exp(-((np.array([0, 5, 10]) / 8) ** 2))
    expected = [5 * (1 - outlive[1]), 5 * outlive[1], *(-10 * np.diff(outlive)), 10 * outlive[2]]
    assert of.between_count.mean(axis=0) == pytest.approx(expected, abs=0.1)


def test_failure_modes_are_fitted_apart_and_joined() -> None:
    rows = [(54, "wear"), (187, "seizure"), (216, "wear"), (240, "wear"), (335, "seizure"), (386, "wear")]
    ages = np.array([age for age, _ in rows] + [500.0])
    high = np.append(ages[:-1], np.inf)
    count = np.append(np.ones(6, dtype=int), 8)
    names = (*(mode for _, mode in rows), "")
    law = hersey.weibull(hersey.Failures(ages, high, count, "h", names))
    assert [(each.mode, each.failures) for each in law.modes] == [("wear", 4), ("seizure", 2)]
    of_wear = np.repeat([name == "wear" for name in names], count)
    wear = hersey.weibull(np.repeat(ages, count), of_wear, calibrate=False)
    assert [p.value for p in law.modes[0].parameters] == pytest.approx(numbers(wear), rel=1e-9)
    outlive = [1 - fit.share(300.0) for fit in law.fits]
    assert law.share_failed(300.0) == pytest.approx(1 - np.prod(outlive), rel=1e-12)
    at = law.reliability(300.0)
    drawn_shares = np.exp(sum(each.log_survival(np.array(300.0)) for each in law.draws))
    assert at.share == pytest.approx(np.prod(outlive), rel=1e-12)
    assert (at.low, at.high) == pytest.approx(np.quantile(drawn_shares, [0.05, 0.95]), rel=1e-9)
    b10 = law.b_lives[0]
    assert law.share_failed(b10.age) == pytest.approx(0.10, rel=1e-9)
    assert b10.low < b10.age < b10.high


def test_a_mode_with_one_failure_joins_the_others() -> None:
    ages = np.array([54.0, 187, 216, 240])
    law = hersey.weibull(hersey.Failures(ages, ages, np.ones(4, dtype=int), "h", ("a", "a", "a", "b")))
    assert not law.modes
    assert [(each.kind, each.values["modes"]) for each in law.warnings] == [("failure modes together", "b")]


def test_turnbull_is_kaplan_and_meier_of_exact_ages() -> None:
    exact = hersey.Failures(np.array([10.0, 15, 20]), np.array([10.0, np.inf, 20]), np.array([1, 2, 1]))
    ages, shares = steps(exact)
    assert ages.tolist() == [10, 20]
    assert shares == pytest.approx([0.25, 1.0])
    assert positions(exact)[1] == pytest.approx([0.125, 0.625])
    # Meeker and Escobar, example 3.2: heat exchanger tubes of three plants, cracked by the year.
    low = np.array([0.0, 1, 2, 3, 0, 1, 2, 0, 1])
    high = np.array([1.0, 2, 3, np.inf, 1, 2, np.inf, 1, np.inf])
    tubes = hersey.Failures(low, high, np.array([1, 2, 2, 95, 2, 3, 95, 1, 99]), "years")
    ages, shares = positions(tubes)
    assert ages.tolist() == [1, 2, 3]
    first, second, third = 4 / 300, 5 / 197, 2 / 97
    by_product = 1 - np.cumprod([1 - first, 1 - second, 1 - third])
    assert shares == pytest.approx(by_product, rel=1e-6)
    mixed = hersey.Failures(np.array([10.0, 5, 20]), np.array([10.0, 12, 20]), np.ones(3, dtype=int))
    assert dict(zip(*(each.tolist() for each in steps(mixed)), strict=True))[10] == pytest.approx(2 / 3)
    assert steps(mixed)[1][-1] == pytest.approx(1.0)


def anderson(ages: FloatArray, shape: float, scale: float) -> float:
    """The statistic as textbooks print it."""
    share = stats.weibull_min.cdf(np.sort(ages), shape, scale=scale)
    n = ages.size
    rank = np.arange(1, n + 1)
    return float(-n - ((2 * rank - 1) / n * (np.log(share) + np.log(1 - share[::-1]))).sum())


def test_how_well_a_law_fits() -> None:
    ages = np.array([17.88, 28.92, 33.0, 41.52, 42.12, 45.6, 48.4, 51.84, 51.96, 54.12, 55.56, 67.8])
    law = hersey.weibull(ages, np.ones(12, dtype=bool))
    assert law.goodness is not None
    assert law.goodness.statistic == pytest.approx(anderson(ages, *numbers(law)), rel=1e-9)
    assert law.goodness.p_value > 0.3
    withdrawn = np.isin(np.arange(12), [0, 3, 4, 8, 11])
    law = hersey.weibull(ages, ~withdrawn)
    assert law.goodness is not None
    failed, left = (
        ages[~withdrawn],
        np.array([11.0, 10, 7, 6, 5, 3, 2]),
    )  # of 12, the first was withdrawn early
    shares = np.append(0.0, 1 - np.cumprod(1 - 1 / left))
    ends = np.append(0.0, stats.weibull_min.cdf(failed, numbers(law)[0], scale=numbers(law)[1]))
    parts = [
        integrate.quad(lambda f, share=share: (share - f) ** 2 / (f * (1 - f)), begin, end)[0]
        for share, begin, end in zip(shares[:-1], ends[:-1], ends[1:], strict=True)
    ]
    assert law.goodness.statistic == pytest.approx(11 * sum(parts), rel=1e-6)
    split = np.concatenate([np.linspace(1, 1.2, 8), np.linspace(100, 120, 8)])
    bad = hersey.weibull(split, np.ones(16, dtype=bool))
    assert bad.goodness is not None
    assert bad.goodness.p_value < 0.01
    assert "does not fit" in bad.summary()


def test_reliability_has_the_bounds_of_ages() -> None:
    law = hersey.weibull(HANDBOOK, calibrate=False)
    b10 = law.b_life(0.10)
    at = law.reliability(b10.age)
    assert at.share == pytest.approx(0.9, rel=1e-9)
    # Where the lower bound of B10 stands, a tenth is the upper bound of the share failed.
    assert law.reliability(b10.low).low == pytest.approx(0.9, abs=1e-6)


def test_the_remaining_life_of_a_specimen() -> None:
    law = handbook()
    shape, scale = numbers(law)
    found = hersey.remaining_life(law, 200.0)
    median = scale * ((200 / scale) ** shape + math.log(2)) ** (1 / shape) - 200
    assert found.median == pytest.approx(median, rel=1e-9)
    assert found.earliest < found.low < found.median < found.high < found.latest
    outlive = np.exp((200 / scale) ** shape - ((200 + found.ahead) / scale) ** shape)
    assert found.outlive == pytest.approx(outlive, rel=1e-9)
    new = hersey.remaining_life(law, 0.0)
    b50 = law.b_lives[1]
    assert new.median == pytest.approx(b50.age, rel=1e-9)
    assert (new.low, new.high) == pytest.approx((b50.low, b50.high), rel=0.06)


def test_a_fleet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(forecast, "_POINTS", 4)
    law = handbook()
    ages, count = np.array([0.0, 100.0, 300.0]), np.array([200, 150, 50])
    found = hersey.fleet_forecast(law, ages, 50.0, count=count)
    shape, scale = numbers(law)
    chance = -np.expm1((ages / scale) ** shape - ((ages + 50) / scale) ** shape)
    assert found.expected[-1] == pytest.approx((count * chance).sum(), rel=1e-9)
    assert found.low[-1] < found.expected[-1] < found.high[-1]
    # Wider than chance alone would be.
    alone = stats.poisson.interval(0.9, found.expected[-1])
    assert found.high[-1] - found.low[-1] > alone[1] - alone[0]
    assert (np.diff(found.low) >= 0).all()
    assert (np.diff(found.high) >= 0).all()
    few = count // 25
    apart = hersey.fleet_forecast(law, np.repeat(ages, few), 50.0)
    assert apart.specimens == 16
    (possible,) = law.draws
    kept = np.exp(
        few
        @ (possible.log_survival(ages[:, None] + 50) - possible.log_survival(np.maximum(ages, 1e-9)[:, None]))
    )
    assert apart.none == pytest.approx(kept.mean(), abs=0.03)
    assert apart.expected[-1] == pytest.approx(found.expected[-1] / 25, rel=1e-9)


def test_a_demonstration_is_the_least_that_convinces() -> None:
    """22 specimens for 90 % confidence in B10 (success run: ln 0.1 / ln 0.9 = 21.9); all others by SciPy."""
    plan = hersey.life_test_plan(100_000, shape=2.0, unit="pages")
    assert plan.specimens(100_000, 0) == 22
    for each in plan.demonstrations:
        failed = 1 - 0.9 ** ((each.age / 100_000) ** 2)
        enough, fewer = (stats.binom.cdf(each.allowed, each.specimens - less, failed) for less in (0, 1))
        assert enough <= 0.1 < fewer
    assert specimens_for(1.0, 0, 1.0, 0.10, 0.95) == 29
    ages = -np.log1p(-(np.arange(1, 4) - 0.5) / 5)  # half of five fail; each bound at 90 %
    half = hersey.weibull([*ages, ages[-1], ages[-1]], [True] * 3 + [False] * 2, level=0.8).b_life(0.10)
    assert plan.precision[0].half_fail ** 2 == pytest.approx(half.high / half.low, rel=1e-6)
    ratios = [each.all_fail for each in plan.precision]
    assert all(after < before for before, after in itertools.pairwise(ratios))


@pytest.mark.parametrize(
    ("ages", "failed", "words"),
    [
        ([10, 20, 30], [False, False, False], "No specimen has failed up to 30 h"),
        ([10, 20, 30], [True, False, False], "Only one specimen has failed, by 10 h"),
        ([10, 10], [True, True], "All failures lie at one age"),
    ],
)
def test_too_few_failures_give_no_law(ages: list[float], failed: list[bool], words: str) -> None:
    law = hersey.weibull(ages, failed, unit="h")
    assert [each.kind for each in law.warnings] == ["no law of failures"]
    assert words in law.summary()
    assert "no failure law is known" in law.headline()
    json.dumps(law.to_dict(), allow_nan=False)
    for asked in (
        lambda: law.b_life(0.1),
        lambda: law.reliability(5.0),
        lambda: hersey.remaining_life(law, 1.0),
        lambda: hersey.fleet_forecast(law, [1.0], 1.0),
    ):
        with pytest.raises(InsufficientDataError, match=words):
            asked()


def test_found_failed_at_any_age_alike_gives_no_law() -> None:
    """Both found failed by 10 and 20 may have failed at once, and the one of 30 never."""
    low, high = np.array([0.0, 0, 30]), np.array([10.0, 20, np.inf])
    law = hersey.weibull(hersey.Failures(low, high, np.ones(3, dtype=int), "h"))
    assert not law.is_known
    assert "The share failed hardly grows with age" in law.summary()


def test_the_greatest_numbers_do_no_harm(recwarn: pytest.WarningsRecorder) -> None:
    law = hersey.weibull([1e300, 1e-300, 5.0], [True] * 3, calibrate=False)
    assert not recwarn.list
    json.dumps(law.to_dict(), allow_nan=False)


def test_up_to_three_failures_are_few() -> None:
    for count, kinds in ((3, ["few failures"]), (4, [])):
        law = hersey.weibull([50.0, 90.0, 120.0, 160.0][:count], [True] * count, calibrate=False)
        assert [each.kind for each in law.warnings] == kinds


def test_one_failure_is_enough_where_the_shape_is_known() -> None:
    """The scale is (sum of ages^shape over failures)^(1/shape)."""
    law = hersey.weibull([10.0, 20.0, 30.0], [False, True, False], shape=2.0, unit="h")
    assert numbers(law)[1] == pytest.approx(math.sqrt(100 + 400 + 900), rel=1e-9)
    assert "2 (given)" in law.summary()


def test_the_same_seed_gives_the_same_bits() -> None:
    one, other = (hersey.weibull(HANDBOOK, seed=seed) for seed in (3, 3))
    assert one.to_dict() == other.to_dict()
    wide, narrow = (one.fits[0].bounds(np.array([0.1]), level, age_held) for level in (0.95, 0.5))
    assert wide[0] < narrow[0] < narrow[1] < wide[1]


def test_the_scale_of_a_gamma_law_has_the_bounds_of_its_draws() -> None:
    law = hersey.weibull([54.0, 187, 216, 240, 335], [True] * 5, law="gamma", level=0.8)
    ends = np.quantile(np.exp(law.draws[0].m), [0.1, 0.9])
    assert (law.parameters[1].low, law.parameters[1].high) == pytest.approx(ends, rel=1e-12)


def test_another_law_that_fits_better_is_named() -> None:
    ages = np.exp(LOGNORMAL.quantile((np.arange(80) + 0.5) / 80, np.array(0.8)))
    law = hersey.weibull(100 * ages, np.ones(80, dtype=bool))
    found = [each for each in law.warnings if each.kind == "another law fits better"]
    assert [each.values["best"] for each in found] == ["lognormal"]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: hersey.weibull([1.0, -2.0], [True, True]), "age 1 is -2"),
        (lambda: hersey.weibull([1.0, 2.0], [True]), "equal length"),
        (lambda: hersey.weibull([1.0, 2.0], [1, 3]), "true or false"),
        (lambda: hersey.weibull([1.0, 2.0]), "failed is missing"),
        (lambda: hersey.weibull([1.0], [True], level=90), "level is 90"),
        (lambda: hersey.weibull([1.0], [True], shape=-1.0), "shape is -1"),
        (lambda: hersey.weibull([1.0], [True], law="normal"), "law 'normal' is none of weibull"),
        (lambda: handbook().b_life(10), "share is 10"),
        (lambda: handbook().reliability(0), "age is 0"),
        (lambda: hersey.fleet_forecast(handbook(), [1.0, -1.0], 5.0), "age 1 is -1"),
        (lambda: hersey.fleet_forecast(handbook(), [1.0], 0.0), "ahead is 0"),
        (lambda: hersey.remaining_life(handbook(), -1.0), "age is -1"),
        (lambda: hersey.life_test_plan(0.0, shape=2.0), "target is 0"),
        (lambda: hersey.life_test_plan(1.0, shape=2.0, share=1.5), "share is 1.5"),
    ],
)
def test_what_is_refused(call: object, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        call()  # type: ignore[operator]
