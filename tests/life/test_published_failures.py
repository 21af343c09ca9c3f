"""Laws of failures by the numbers of books and of other programs' manuals, to the digits printed there.

Where a printed number is not that of greatest likelihood, SciPy decides, and the docstring says so.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import optimize, stats

import hersey
from hersey.arrays import FloatArray
from hersey.life.failures.fit import Fit, covariance, middle
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


#: Cracked and other parts found at inspections, months: Nelson, Applied Life Data Analysis (1982), p. 415.
PARTS = (6.12, 19.92, 29.64, 35.40, 39.72, 45.24, 52.32, 63.48), (5, 16, 12, 18, 18, 2, 6, 17, 73)
#: Turbine wheels inspected once: age (100 h), cracked, not cracked; the same, p. 409.
WHEELS = (
    *((4, 0, 39), (10, 4, 49), (14, 2, 31), (18, 7, 66), (22, 5, 25), (26, 9, 30), (30, 9, 33)),
    *((34, 6, 7), (38, 22, 12), (42, 21, 19), (46, 21, 15)),
)
#: Class-B motor insulation, hours: temperature (degC), failures, and age and number of the others; Nelson,
#: Accelerated Testing (1990), p. 135.
CLASS_B = (
    (150, (), 8064, 10),
    (170, (1764, 2772, 3444, 3542, 3780, 4860, 5196), 5448, 3),
    (190, (408, 408, 1344, 1344, 1440), 1680, 5),
    (220, (408, 408, 504, 504, 504), 528, 5),
)
#: Time to breakdown of an insulating fluid by kV, min; the same, p. 129.
FLUID = {
    26: (5.79, 1579.52, 2323.70),
    28: (68.85, 108.29, 110.29, 426.07, 1067.60),
    30: (7.74, 17.05, 20.46, 21.02, 22.66, 43.40, 47.30, 139.07, 144.12, 175.88, 194.90),
    32: (
        *(0.27, 0.40, 0.69, 0.79, 2.75, 3.91, 9.88, 13.95, 15.93, 27.80, 53.24, 82.85, 89.29),
        *(100.58, 215.10),
    ),
    34: (
        *(0.19, 0.78, 0.96, 1.31, 2.78, 3.16, 4.15, 4.67, 4.85, 6.50, 7.35, 8.01, 8.27, 12.06),
        *(31.75, 32.52, 33.91, 36.71, 72.89),
    ),
    36: (0.35, 0.59, 0.96, 0.99, 1.69, 1.97, 2.07, 2.58, 2.71, 2.90, 3.67, 3.99, 5.35, 13.77, 25.50),
    38: (0.09, 0.39, 0.47, 0.73, 0.74, 1.13, 1.40, 2.38),
}
#: Vehicle shock absorbers, km, failed or not: O'Connor, Practical Reliability Engineering (1985).
SHOCKS = (6700, 9120, 12200, 13150, 14300, 17520, 20100, 20900, 22700, 26510, 27490)
UNSHOCKED = (
    *(6950, 7820, 8790, 9660, 9820, 11310, 11690, 11850, 11880, 12140, 12870, 13330, 13470, 14040),
    *(17540, 17890, 18450, 18960, 18980, 19410, 20100, 20150, 20320, 23490, 27410, 27890, 28100),
)
#: Revolutions of ball bearings, millions: Lieblein and Zelen, J. Res. NBS 57 (1956).
BEARINGS = (
    *(17.88, 28.92, 33.00, 41.52, 42.12, 45.60, 48.48, 51.84, 51.96, 54.12, 55.56, 67.80, 68.64, 68.64),
    *(68.88, 84.12, 93.12, 98.64, 105.12, 105.84, 127.92, 128.04, 173.40),
)


def of_rows(rows: list[tuple[float, bool, int]]) -> hersey.Failures:
    ages, failed, count = (np.array(each) for each in zip(*rows, strict=True))
    return hersey.Failures(ages.astype(float), np.where(failed, ages, np.inf), count, "h")


def numbers(law: hersey.FailureLaw) -> list[float]:
    return [each.value for each in law.parameters]


def location(fit: Fit) -> tuple[float, float, FloatArray]:
    """Location and scale of ln age, and the standard errors of location and ln scale."""
    of_share = float(fit.law.quantile(np.array(middle(fit.sample)), np.array(fit.k)))
    slopes = np.array([[1.0, of_share], [0.0, 1.0]])
    errors = np.sqrt((slopes @ covariance(fit)[:2, :2] @ slopes.T).diagonal())
    return fit.m, 1 / fit.k, errors


def insulation(lowest: float, kelvin: float, use: float) -> hersey.Failures:
    rows = [
        (age, age != last, number, degc + kelvin)
        for degc, ages, last, others in CLASS_B
        if degc >= lowest
        for age, number in (*((age, 1) for age in ages), (last, others))
    ]
    ages, failed, count, stress = (np.array(each) for each in zip(*rows, strict=True))
    high = np.where(failed, ages, np.inf)
    return hersey.Failures(ages.astype(float), high, count, "h", (), stress, "K", "arrhenius", use + kelvin)


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
    law = hersey.weibull(ages, failed, law="lognormal", calibrate=False)
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
    low, high = law.acceleration.low, law.acceleration.high
    assert low < 4.289 < high
    drawn = np.quantile(law.draws[0].c, [0.05, 0.95])
    assert drawn == pytest.approx([low, high], abs=0.1 * (high - low))
    assert [each.kind for each in law.warnings] == ["stress of use not tested"]


def test_parts_between_inspections_of_nelson() -> None:
    """Nelson (1982), figure 9.4.1 (STATPAC): 71.68742, 1.485506, of seven digits "useful to about three".

    Log-likelihood is greatest at 71.69041, 1.485367 by SciPy, too.
    """
    ends, count = PARTS
    low, high = np.array([0.0, *ends]), np.array([*ends, np.inf])
    law = hersey.weibull(hersey.Failures(low, high, np.array(count), "months"), calibrate=False)
    assert numbers(law) == pytest.approx([1.485506, 71.68742], rel=1e-4)
    printed = {0.01: 3.240171, 0.10: 15.75932, 0.50: 56.01331, 0.90: 125.6829, 0.99: 200.4108}
    for share, age in printed.items():
        assert law.age_estimated(share) == pytest.approx(age, rel=3e-4)
    assert 100 * law.share_failed(12.0) == pytest.approx(6.787357, rel=2e-4)

    def worth(at: FloatArray) -> float:
        shares = stats.weibull_min.cdf([0.0, *ends, np.inf], math.exp(at[0]), scale=math.exp(at[1]))
        return -float(np.array(count) @ np.log(np.diff(shares)))

    best = optimize.minimize(worth, [0.4, 4.2], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    assert numbers(law) == pytest.approx(np.exp(best.x), rel=1e-6)
    assert law.log_likelihood == pytest.approx(-best.fun, abs=1e-9)


def test_parts_in_days_of_sas_and_r() -> None:
    """R survival, tests/r_sas.Rout.save, after SAS: 7.6880 (0.0744), 0.674, -309.6, quantiles."""
    days, count = np.array([186.0, 606, 902, 1077, 1209, 1377, 1592, 1932]), np.array(PARTS[1])
    sample = hersey.Failures(np.append(0.0, days), np.append(days, np.inf), count, "days")
    law = hersey.weibull(sample, calibrate=False)
    mu, sigma, errors = location(law.fits[0])
    assert (round(mu, 4), round(sigma, 3)) == (7.6880, 0.674)
    assert errors.round(4).tolist() == [0.0744, 0.0987]
    assert law.log_likelihood is not None
    assert round(law.log_likelihood, 1) == -309.6
    printed = {0.01: 98.47183, 0.10: 479.31737, 0.50: 1704.71015, 0.80: 3006.43572}
    for share, age in printed.items():
        assert law.age_estimated(share) == pytest.approx(age, abs=6e-6)


def test_wheels_found_cracked_or_not_of_sas_and_r() -> None:
    """The same: lognormal 3.6999 (0.0708), 0.72, log scale (0.1232), -190.7."""
    rows = [(0, age, cracked) for age, cracked, _ in WHEELS if cracked]
    rows += [(age, math.inf, others) for age, _, others in WHEELS]
    low, high, count = (np.array(each) for each in zip(*rows, strict=True))
    sample = hersey.Failures(low.astype(float), high.astype(float), count)
    law = hersey.weibull(sample, law="lognormal", calibrate=False)
    mu, sigma, errors = location(law.fits[0])
    assert (round(mu, 4), round(sigma, 2)) == (3.6999, 0.72)
    assert errors.round(4).tolist() == [0.0708, 0.1232]
    assert law.log_likelihood is not None
    assert round(law.log_likelihood, 1) == -190.7


def test_an_activation_of_sas_and_r() -> None:
    """The same, motorettes without those of 150 degC: -10.471, 8.322 (1.284), 0.604 (0.183), -145.9."""
    sample = insulation(lowest=170, kelvin=273.2, use=130)
    law = hersey.weibull(sample, law="lognormal", calibrate=False)
    fit = law.fits[0]
    _, sigma, errors = location(fit)
    boltzmann = 8.617333262e-5
    assert sample.stress is not None
    place = float(np.average(1 / (boltzmann * sample.stress), weights=sample.count))
    slope = np.array([fit.c, math.sqrt(covariance(fit)[2, 2])]) / (1000 * boltzmann)
    assert slope.round(3).tolist() == [8.322, 1.284]
    assert round(fit.m - fit.c * place, 3) == -10.471
    assert (round(sigma, 3), errors[1].round(3)) == (0.604, 0.183)
    assert law.log_likelihood is not None
    assert round(law.log_likelihood, 1) == -145.9
    ages = [law.age_estimated(share) for share in (0.1, 0.5, 0.9)]
    assert ages == pytest.approx([12033.185, 26095.677, 56592.20], abs=6e-3)


def test_an_activation_of_nelson() -> None:
    """Nelson (1990), p. 135: 0.59673, B 9920.195; ReliaSoft 0.59678, 9924.804. Here 0.59679, 9924.859.

    At those of SciPy the gradient is 0; the books' differ by the digits that they kept on the way.
    """
    sample = insulation(lowest=150, kelvin=273.15, use=130)
    law = hersey.weibull(sample, law="lognormal", calibrate=False)
    assert law.acceleration is not None
    slope = law.acceleration.effect / 8.617333262e-5
    assert (numbers(law)[0], slope) == pytest.approx((0.59678, 9924.804), rel=2e-5)
    assert (numbers(law)[0], slope) == pytest.approx((0.59673, 9920.195), rel=5e-4)
    assert sample.stress is not None
    ages, inverse, failed = np.log(sample.low), 1 / sample.stress, np.isfinite(sample.high)

    def worth(at: FloatArray, of_use: float | None = None) -> float:
        u, b, s = at if of_use is None else (of_use, *at)
        z = (ages - u - 1e4 * b * (inverse - 1 / (130 + 273.15))) / math.exp(s)
        each = np.where(failed, stats.norm.logpdf(z) - s, stats.norm.logsf(z))
        return -float(sample.count @ each)

    near = {"xatol": 1e-9, "fatol": 1e-12}
    best = optimize.minimize(worth, [10.7, 0.99, -0.5], method="Nelder-Mead", options=near)
    assert (numbers(law)[0], slope) == pytest.approx((math.exp(best.x[2]), 1e4 * best.x[1]), rel=1e-6)
    b50 = law.b_lives[1]
    for age in (b50.low, b50.high):
        held = optimize.minimize(worth, best.x[1:], (math.log(age),), method="Nelder-Mead", options=near)
        assert 2 * (held.fun - best.fun) == pytest.approx(stats.chi2.ppf(0.90, 1), abs=1e-5)


@pytest.mark.parametrize(
    ("voltage", "mu", "sigma", "scale", "shape"),
    [
        (26, (6.86249, 1.10404), 1.83423, 955.74665, 0.54519),
        (30, (4.35133, 0.30151), 0.94446, 77.58159, 1.05881),
        (34, (2.50326, 0.31476), 1.29732, 12.22222, 0.77082),
        (38, (0.00092629, 0.27318), 0.73367610, 1.00092672, 1.36299929),
    ],
)
def test_a_fluid_by_voltage_of_sas_and_r(
    voltage: int, mu: tuple[float, float], sigma: float, scale: float, shape: float
) -> None:
    """R survival, tests/r_sas.Rout.save, after SAS."""
    ages = np.array(FLUID[voltage])
    law = hersey.weibull(ages, np.ones(ages.size, dtype=bool), calibrate=False)
    found = location(law.fits[0])
    near = 1e-8 if voltage == 38 else 6e-6
    assert numbers(law) == pytest.approx([shape, scale], abs=near)
    assert found[:2] == pytest.approx((mu[0], sigma), abs=near)
    assert found[2][0].round(5) == mu[1]


def test_an_inverse_power_of_nelson() -> None:
    """Nelson (1990), p. 453: 0.777 [0.653, 0.923], n 17.72958, K 6.8742e-29; ReliaSoft: K 6.8741e-29.

    By SciPy n is 17.729587 and K 6.87404e-29.
    """
    load = np.repeat([float(each) for each in FLUID], [len(each) for each in FLUID.values()])
    ages = np.concatenate([np.array(each) for each in FLUID.values()])
    count = np.ones(ages.size, dtype=int)
    sample = hersey.Failures(ages, ages, count, "min", (), load, "kV", "power", 20.0)
    law = hersey.weibull(sample, level=0.95)
    fit = law.fits[0]
    assert round(fit.k, 3) == 0.777
    error = math.sqrt(covariance(fit)[1, 1])
    assert (fit.k * np.exp(1.96 * error * np.array([-1, 1]))).tolist() == pytest.approx(
        [0.653, 0.923], abs=6e-4
    )
    assert fit.c == pytest.approx(17.72958, abs=1e-5)
    constant = math.exp(-fit.m - fit.c * float(np.log(load).mean()))
    assert constant == pytest.approx(6.8741e-29, rel=2e-5)


def test_shock_absorbers_of_another_program() -> None:
    """R weibulltools, tests/testthat/_snaps/ml_estimation.md: 10.2298631, 0.3164092, Wald bounds, -123.9954.

    Its sixth digits are those of where it stops: the scale is 0.3164086.
    """
    ages = np.array([*SHOCKS, *UNSHOCKED], dtype=float)
    failed = np.arange(ages.size) < len(SHOCKS)
    law = hersey.weibull(ages, failed, calibrate=False)
    mu, sigma, errors = location(law.fits[0])
    assert (mu, sigma) == pytest.approx((10.2298631, 0.3164092), abs=1e-6)
    normal = stats.norm.ppf(0.95) * np.array([-1, 1])
    assert mu + normal * errors[0] == pytest.approx([10.0491099, 10.4106162], abs=2e-6)
    assert sigma * np.exp(normal * errors[1]) == pytest.approx([0.2163041, 0.4628426], abs=3e-6)
    assert law.log_likelihood == pytest.approx(-123.9954, abs=5e-5)
    lognormal = hersey.weibull(ages, failed, law="lognormal", calibrate=False)
    assert location(lognormal.fits[0])[:2] == pytest.approx((10.1447710, 0.5300683), abs=1e-6)
    assert lognormal.log_likelihood == pytest.approx(-124.6085, abs=6e-5)


def test_ball_bearings() -> None:
    """Dekking et al., A Modern Introduction to Probability and Statistics (2005): 2.102.

    The book lists 68.64 once, of which 2.063 would follow.
    """
    law = hersey.weibull(np.array(BEARINGS), np.ones(23, dtype=bool), calibrate=False)
    assert round(numbers(law)[0], 3) == 2.102
    assert numbers(law)[1] == pytest.approx(81.878, abs=5e-4)  # by SciPy


def test_a_gamma_law_of_reliasoft() -> None:
    """ReliaSoft, Life Data Analysis Reference, gamma distribution: k 50.4908, logarithm of scale 0.0772."""
    ages = [61, 50, 67, 49, 53, 62, 53, 61, 43, 65, 53, 56, 62, 56, 58, 55, 58, 48, 66, 44, 48, 58, 43, 40]
    shape, scale = numbers(hersey.weibull(ages, [True] * 24, law="gamma", calibrate=False))
    assert round(shape, 4) == 50.4908
    assert round(math.log(scale), 4) == 0.0772


def test_likelihood_ratio_bounds_of_reliasoft() -> None:
    """The same, lognormal distribution, 75 %: age of which 80 % are left 55.718 [43.634, 66.085]."""
    law = hersey.weibull(
        [45.0, 60.0, 75.0, 90.0, 115.0], [True] * 5, law="lognormal", level=0.75, calibrate=False
    )
    b20 = law.b_life(0.20)
    assert [round(each, 3) for each in (b20.age, b20.low, b20.high)] == [55.718, 43.634, 66.085]
    sigma = law.parameters[0]  # the table of ages by sigma runs from 0.24 to 0.48
    assert 0.23 < sigma.low <= 0.24
    assert 0.48 <= sigma.high < 0.49
