"""Laws of failures and suspensions: published numbers, bounds, failure modes, a fleet, the next test."""

from __future__ import annotations

import itertools
import json
import math

import numpy as np
import pytest
from scipy import stats

import hersey
from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.failures.distributions import DISTRIBUTIONS, LOGNORMAL, WEIBULL
from hersey.life.failures.fit import age_held, covariance, fitted
from hersey.life.failures.likelihood import log_between
from hersey.life.failures.positions import positions, steps
from hersey.life.failures.test_plan import specimens_for
from tests.conftest import ROOT

#: NIST/SEMATECH e-Handbook of Statistical Methods, 8.4.1.3 (data of 8.2.2.1), hours.
HANDBOOK = ROOT / "examples" / "failures.csv"
#: Bearing cages, Meeker and Escobar, Statistical Methods for Reliability Data (1998), table C.5, hours.
CAGES = [
    *((50, False, 288), (150, False, 148)),
    *((250, False, 124), (350, False, 111), (450, False, 106), (550, False, 99), (650, False, 110)),
    *((750, False, 114), (850, False, 119), (950, False, 127), (1050, False, 123), (1150, False, 93)),
    *((1250, False, 47), (1350, False, 41), (1450, False, 27), (1550, False, 11), (1650, False, 6)),
    *((1850, False, 1), (2050, False, 2)),
    *((age, True, 1) for age in (230, 334, 423, 990, 1009, 1510)),
]
#: Life of mylar-polyurethane insulation by voltage, the same, example 19.10.
MYLAR = {
    219.0: (15, 16, 36, 50, 55, 95, 122, 129, 625, 700),
    157.1: (49, 99, 154.5, 180, 291, 447, 510, 600, 1656, 1721),
    122.4: (188, 297, 405, 744, 1218, 1340, 1715, 3382),
    100.3: (606, 1012, 2520, 2610, 3988, 4100, 5025, 6842),
}


def of_rows(rows: list[tuple[float, bool, int]]) -> hersey.Failures:
    ages, failed, count = (np.array(each) for each in zip(*rows, strict=True))
    return hersey.Failures(ages.astype(float), np.where(failed, ages, np.inf), count, "h")


def numbers(law: hersey.FailureLaw) -> list[float]:
    return [each.value for each in law.parameters]


def test_the_handbook_of_nist() -> None:
    """Printed: 1.7208, 606.5280 (4e-4 beside), -75.135, AIC 154.27, of the lognormal law 154.39."""
    law = hersey.weibull(HANDBOOK)
    shape, scale = numbers(law)
    assert round(shape, 4) == 1.7208
    assert scale == pytest.approx(606.5280, abs=5e-4)
    assert law.log_likelihood is not None
    assert round(law.log_likelihood, 3) == -75.135
    aic = {each.law: round(each.aic, 2) for each in law.comparison}
    assert (aic["weibull"], aic["lognormal"]) == (154.27, 154.39)


def test_likelihood_ratio_bounds_of_a_book() -> None:
    """Meeker and Escobar, example 8.16: shape 2.035, B10 3903, its 95 % bounds [2093, 22144].

    The lower bound comes out at 2094.3, at which the ratio of likelihoods is that of chi-square to 1e-9.
    """
    cages = of_rows(CAGES)
    assert (cages.specimens, cages.failures) == (1703, 6)
    law = hersey.weibull(cages, level=0.95, calibrate=False)
    assert round(numbers(law)[0], 3) == 2.035
    b10 = law.b_life(0.10)
    assert round(b10.age) == 3903
    assert round(b10.high) == 22144
    assert b10.low == pytest.approx(2093, rel=7e-4)
    shapes = np.linspace(0.5, 5.0, 20001)
    scales = b10.low / (-math.log(0.9)) ** (1 / shapes)
    best = max(
        sum(
            count
            * (stats.weibull_min.logpdf if failed else stats.weibull_min.logsf)(age, shapes, scale=scales)
            for age, failed, count in CAGES
        )
    )
    assert law.log_likelihood is not None
    assert 2 * (law.log_likelihood - best) == pytest.approx(stats.chi2.ppf(0.95, 1), abs=1e-5)
    wider = hersey.weibull(cages, level=0.95).b_life(0.10)
    assert wider.high > 2 * b10.high


def test_ages_between_inspections_of_a_book() -> None:
    """Meeker and Escobar, example 7.1: exponential, 572.3, standard error 41.72, bounds [498, 662]."""
    low, high = (
        np.array([0, 100, 300, 500, 700, 1000, 2000.0]),
        np.array([100, 300, 500, 700, 1000, 2000, 4000.0]),
    )
    sample = hersey.Failures(low, high, np.array([41, 44, 24, 32, 29, 21, 9]), "h")
    law = hersey.weibull(sample, shape=1.0, level=0.95, calibrate=False)
    scale = law.parameters[1]
    assert round(scale.value, 1) == 572.3
    assert (round(scale.low), round(scale.high)) == (498, 662)
    error = scale.value * math.sqrt(covariance(law.fits[0])[0, 0])
    assert round(error, 2) == 41.72


def test_a_lognormal_law_of_a_book() -> None:
    """Meeker and Escobar, p. 199: mu 6.56. Its sigma, 0.543 on ReliaSoft's page, is 0.534 by SciPy, too."""
    ages, failed = [252, 315, 369, 403, 474, *[500] * 15], [True] * 5 + [False] * 15
    law = hersey.weibull(ages, failed, law="lognormal")
    sigma, median = numbers(law)
    assert round(math.log(median), 2) == 6.56
    data = stats.CensoredData(uncensored=ages[:5], right=ages[5:])
    assert sigma == pytest.approx(stats.lognorm.fit(data, floc=0)[0], rel=1e-5)


def test_an_inverse_power_of_a_book() -> None:
    """Meeker and Escobar, example 19.10: -271.4; 95 % Wald bounds [0.83, 1.32], [-5.46, -3.11]."""
    load = np.repeat(list(MYLAR), [len(each) for each in MYLAR.values()])
    ages = np.array([age for each in MYLAR.values() for age in each], dtype=float)
    count = np.ones(ages.size, dtype=int)
    sample = hersey.Failures(ages, ages, count, "min", (), load, "kV", "power", 50.0)
    law = hersey.weibull(sample, law="lognormal")
    assert law.log_likelihood is not None
    assert round(law.log_likelihood, 1) == -271.4
    fit = law.fits[0]
    errors = np.sqrt(covariance(fit).diagonal())
    sigma = np.exp(-math.log(fit.k) + 1.96 * errors[1] * np.array([-1, 1]))
    assert sigma.round(2).tolist() == [0.83, 1.32]
    slope = -fit.c + 1.96 * errors[2] * np.array([-1, 1])
    assert slope == pytest.approx([-5.46, -3.11], abs=0.006)
    middle = float(np.average(-np.log(load)))
    assert fit.m - fit.c * middle == pytest.approx((21.6 + 33.4) / 2, abs=0.05)
    assert law.acceleration is not None
    assert law.acceleration.low < 4.289 < law.acceleration.high
    assert [each.kind for each in law.warnings] == ["stress of use not tested"]


def test_an_activation_energy_is_found_again() -> None:
    """Exact ages of a law of 0.7 eV at three temperatures, at the places where they are expected."""
    kelvin = np.repeat([330.0, 350.0, 370.0], 12)
    ranks = np.tile((np.arange(12) + 0.5) / 12, 3)
    ages = np.exp(0.7 / (8.617333262e-5 * kelvin) - 15) * (-np.log1p(-ranks)) ** 0.5
    sample = hersey.Failures(ages, ages, np.ones(36, dtype=int), "h", (), kelvin, "K", "arrhenius", 300.0)
    law = hersey.weibull(sample)
    assert law.acceleration is not None
    assert law.acceleration.effect == pytest.approx(0.7, abs=1e-8)
    assert law.acceleration.low < 0.7 < law.acceleration.high
    assert law.acceleration.same_shape == pytest.approx(1.0)
    places, shares = law.positions  # carried over to 300 K
    assert law.share_failed(places) == pytest.approx(shares, abs=0.05)
    ratio = math.exp(0.7 / 8.617333262e-5 * (1 / 300 - 1 / 350))
    at_350 = hersey.weibull(hersey.Failures(ages[12:24], ages[12:24], np.ones(12, dtype=int)))
    assert law.b_lives[1].age == pytest.approx(ratio * at_350.b_lives[1].age, rel=1e-7)


def test_failure_modes_at_several_stresses_are_one_law_with_a_warning() -> None:
    kelvin = np.repeat([330.0, 350.0], 6)
    ages = np.concatenate([np.arange(60.0, 120.0, 10.0), np.arange(30.0, 60.0, 5.0)])
    modes = ("wear", "seizure") * 6
    sample = hersey.Failures(ages, ages, np.ones(12, dtype=int), "h", modes, kelvin, "K", "arrhenius", 300.0)
    law = hersey.weibull(sample)
    assert law.modes == ()
    (told,) = [each for each in law.warnings if each.kind == "failure modes under stress"]
    assert set(told.values["modes"].split(", ")) == {"wear", "seizure"}


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


def test_an_inspection_of_no_width_is_an_exact_age() -> None:
    ages = np.array([54.0, 187, 216, 240, 500])
    failed = np.array([True, True, True, True, False])
    exact = hersey.weibull(ages, failed)
    high = np.where(failed, ages * (1 + 1e-5), np.inf)
    narrow = hersey.weibull(hersey.Failures(ages, high, np.ones(5, dtype=int)), calibrate=False)
    assert numbers(narrow) == pytest.approx(numbers(exact), rel=2e-5)


def test_calibrated_bounds_are_exact_where_a_test_ends_at_a_failure() -> None:
    """In 200 samples of 10 that end at the sixth failure the roots of B10 lie within in 90 %."""
    random = np.random.default_rng(7)
    truth = math.log((-math.log(0.9)) ** 0.5)
    drawn = np.sort(random.weibull(2.0, (200, 10)), axis=1)
    low = np.append(drawn[0, :6], drawn[0, 5])
    high = np.append(drawn[0, :6], np.inf)
    plan = hersey.Failures(low, high, np.append(np.ones(6, dtype=int), 4))
    ends = fitted(WEIBULL, plan)._roots(np.array([0.1]), 0.9, age_held, 0.0)
    inside = 0
    for row in drawn:
        own = hersey.Failures(np.append(row[:6], row[5]), np.append(row[:6], np.inf), plan.count)
        fit = fitted(WEIBULL, own)
        root = fit._root(
            fit.problem(np.array([0.1])), np.log(fit.age([0.1])), np.array([truth]), age_held, []
        )
        inside += bool(ends[0][0] <= root[0] <= ends[1][0])
    assert 0.86 <= inside / 200 <= 0.94


def test_failure_modes_are_fitted_apart_and_joined() -> None:
    rows = [(54, "wear"), (187, "seizure"), (216, "wear"), (240, "wear"), (335, "seizure"), (386, "wear")]
    ages = np.array([age for age, _ in rows] + [500.0])
    high = np.append(ages[:-1], np.inf)
    count = np.append(np.ones(6, dtype=int), 8)
    names = (*(mode for _, mode in rows), "")
    law = hersey.weibull(hersey.Failures(ages, high, count, "h", names))
    assert [(each.mode, each.failures) for each in law.modes] == [("wear", 4), ("seizure", 2)]
    wear = hersey.weibull(np.repeat(ages, count), np.repeat([name == "wear" for name in names], count))
    assert [p.value for p in law.modes[0].parameters] == pytest.approx(numbers(wear), rel=1e-9)
    outlive = [1 - fit.share(300.0) for fit in law.fits]
    assert law.share_failed(300.0) == pytest.approx(1 - np.prod(outlive), rel=1e-12)
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
    law = hersey.weibull(HANDBOOK)
    shape, scale = numbers(law)
    found = hersey.remaining_life(law, 200.0)
    median = scale * ((200 / scale) ** shape + math.log(2)) ** (1 / shape) - 200
    assert found.median == pytest.approx(median, rel=1e-9)
    assert found.earliest < found.low < found.median < found.high < found.latest
    new = hersey.remaining_life(law, 0.0)
    b50 = law.b_lives[1]
    assert new.median == pytest.approx(b50.age, rel=1e-9)
    assert (new.low, new.high) == pytest.approx((b50.low, b50.high), rel=0.06)


def test_a_fleet() -> None:
    law = hersey.weibull(HANDBOOK)
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
    apart = hersey.fleet_forecast(law, np.repeat(ages, count), 50.0)
    assert abs(apart.high[-1] - found.high[-1]) <= 2


def test_a_demonstration_is_the_least_that_convinces() -> None:
    """22 specimens for 90 % confidence in B10 (success run: ln 0.1 / ln 0.9 = 21.9); all others by SciPy."""
    plan = hersey.life_test_plan(100_000, shape=2.0, unit="pages")
    assert plan.specimens(100_000, 0) == 22
    for each in plan.demonstrations:
        failed = 1 - 0.9 ** ((each.age / 100_000) ** 2)
        enough, fewer = (stats.binom.cdf(each.allowed, each.specimens - less, failed) for less in (0, 1))
        assert enough <= 0.1 < fewer
    assert specimens_for(1.0, 0, 1.0, 0.10, 0.95) == 29
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


def test_one_failure_is_enough_where_the_shape_is_known() -> None:
    """The scale is (sum of ages^shape over failures)^(1/shape)."""
    law = hersey.weibull([10.0, 20.0, 30.0], [False, True, False], shape=2.0, unit="h")
    assert numbers(law)[1] == pytest.approx(math.sqrt(100 + 400 + 900), rel=1e-9)
    assert "2 (given)" in law.summary()


def test_the_same_seed_gives_the_same_bits() -> None:
    one, other = (hersey.weibull(HANDBOOK, seed=seed) for seed in (3, 3))
    assert one.to_dict() == other.to_dict()
    wide, narrow = (hersey.weibull(HANDBOOK, level=level).b_lives[0] for level in (0.95, 0.5))
    assert wide.low < narrow.low < narrow.high < wide.high


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
        (lambda: hersey.weibull(HANDBOOK).b_life(10), "share is 10"),
        (lambda: hersey.weibull(HANDBOOK).reliability(0), "age is 0"),
        (lambda: hersey.fleet_forecast(hersey.weibull(HANDBOOK), [1.0, -1.0], 5.0), "age 1 is -1"),
        (lambda: hersey.fleet_forecast(hersey.weibull(HANDBOOK), [1.0], 0.0), "ahead is 0"),
        (lambda: hersey.remaining_life(hersey.weibull(HANDBOOK), -1.0), "age is -1"),
        (lambda: hersey.life_test_plan(0.0, shape=2.0), "target is 0"),
        (lambda: hersey.life_test_plan(1.0, shape=2.0, share=1.5), "share is 1.5"),
    ],
)
def test_what_is_refused(call: object, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        call()  # type: ignore[operator]
