"""The numbers of a fit against linear algebra by hand: errors, intervals, criteria, summary.

Where the errors of the dwells explain the residuals, the likeliest law is the weighted straight line.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize, stats

import hersey
from hersey.damping.estimate import Estimate
from tests.damping.test_surface import SPEEDS, TEMPERATURES, grid, points_of


def line(columns: list[np.ndarray], y: np.ndarray, sigma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values of a weighted linear fit and their covariance, the errors taken at their word."""
    rows = np.column_stack(columns) / sigma[:, None]
    values, *_ = np.linalg.lstsq(rows, y / sigma, rcond=None)
    return values, np.linalg.inv(rows.T @ rows)


def wave(count: int, size: float) -> np.ndarray:
    """Residuals that no straight line explains."""
    return size * np.where(np.arange(count) % 2, 1.0, -1.0)


def thermal_case(scale: str = "degC") -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A power of temperature in the scale, in which no visit is off."""
    w, t = grid(SPEEDS, TEMPERATURES)
    hot = 62.0 * t**-0.9 if scale == "degC" else 3e7 * (t + 273.15) ** -3.0
    errors = np.resize([0.02, 0.03, 0.05], w.size)
    torque = hot * w**0.3 * np.exp(0.01 * np.random.default_rng(3).standard_normal(w.size))
    return w, t, torque, errors


def test_a_law_of_speed_by_hand() -> None:
    errors = np.linspace(0.02, 0.06, 8)
    torque = 2.0 * SPEEDS**0.4 * np.exp(wave(8, 0.01))
    surface = hersey.fit(points_of(SPEEDS, torque, error=errors))
    y, ones = np.log(torque / SPEEDS), np.ones(8)
    (level, c), covariance = line([ones, np.log(SPEEDS)], y, errors)
    assert surface.b is None
    assert surface.statistics.scatter == 0.0
    assert surface.a.value == pytest.approx(np.exp(level), rel=1e-6)
    assert surface.c.value == pytest.approx(c, rel=1e-6)
    assert surface.c.error == pytest.approx(covariance[1, 1] ** 0.5, rel=1e-4)
    assert surface.a.error == pytest.approx(np.exp(level) * covariance[0, 0] ** 0.5, rel=1e-4)
    assert surface.residuals == pytest.approx(y - level - c * np.log(SPEEDS), abs=1e-7)
    assert surface.reference_speed == pytest.approx(float(stats.gmean(SPEEDS)))
    assert surface.reference_temperature is None
    assert surface.speed_range == pytest.approx((0.5, 15.0))
    assert surface.temperature_range is None
    assert surface.variables == ("ln B_ref", "c")
    _, about = line([ones, np.log(SPEEDS / surface.reference_speed)], y, errors)
    assert surface.covariance == pytest.approx(about, rel=1e-4, abs=1e-9)


@pytest.mark.parametrize("scale", ["degC", "K"])
def test_a_law_of_temperature_by_hand(scale: str) -> None:
    w, t, torque, errors = thermal_case(scale)
    surface = hersey.fit(points_of(w, torque, t, errors), temperature_scale=scale)
    scaled = t + 273.15 if scale == "K" else t
    y = np.log(torque / w)
    (level, b, c), covariance = line([np.ones_like(w), np.log(scaled), np.log(w)], y, errors)
    assert surface.b is not None
    assert np.log(surface.a.value) == pytest.approx(level, rel=1e-6)
    assert surface.a.error / surface.a.value == pytest.approx(covariance[0, 0] ** 0.5, rel=1e-3)
    for estimate, value, index in ((surface.b, b, 1), (surface.c, c, 2)):
        assert estimate.value == pytest.approx(value, rel=1e-6)
        assert estimate.error == pytest.approx(covariance[index, index] ** 0.5, rel=1e-3)
    assert surface.temperature_scale == scale
    assert surface.reference_temperature == pytest.approx(float(stats.hmean(t + 273.15)))
    assert surface.temperature_range == pytest.approx((90 + 273.15, 180 + 273.15))
    assert surface.variables == ("ln B_ref", "b", "c")


@pytest.mark.parametrize("count", [5, 8, 14])
def test_intervals_are_students(count: int) -> None:
    w = np.geomspace(0.5, 15, count)
    surface = hersey.fit(points_of(w, 3.0 * w**0.3 * np.exp(wave(count, 0.01)), error=0.03))
    reach = float(stats.t.ppf(0.975, count - 2))
    assert (surface.c.high - surface.c.value) / surface.c.error == pytest.approx(reach, rel=1e-9)
    assert (surface.c.value - surface.c.low) / surface.c.error == pytest.approx(reach, rel=1e-9)
    relative = surface.a.error / surface.a.value
    assert np.log(surface.a.high / surface.a.value) / relative == pytest.approx(reach, rel=1e-9)
    assert np.log(surface.a.value / surface.a.low) / relative == pytest.approx(reach, rel=1e-9)


def test_three_coefficients_take_three_degrees_of_freedom() -> None:
    w, t = grid(np.array([1.0, 3.0, 9.0]), np.array([100.0, 130.0, 160.0]))
    surface = hersey.fit(points_of(w, 5.0 * t**-0.9 * w**0.3, t, error=0.02))
    assert surface.b is not None
    for e in (surface.b, surface.c):
        assert (e.high - e.value) / e.error == pytest.approx(float(stats.t.ppf(0.975, 6)), rel=1e-9)


def test_two_visits_tell_the_exponent_of_speed_and_not_that_of_temperature() -> None:
    """That takes up the one difference between them, so that nothing is left to say how visits scatter."""
    w, t = grid(np.array([1.0, 3.0, 9.0]), np.array([100.0, 160.0]))
    torque = 5.0 * t**-0.9 * w**0.3
    surface = hersey.fit(points_of(w, torque, t, error=0.02))
    a, b, c = surface.a, surface.b, surface.c
    assert b is not None
    assert b.value == pytest.approx(-0.9, abs=1e-9)
    assert (b.estimable, a.estimable, c.estimable) == (False, False, True)
    assert (b.low, b.high) == (-np.inf, np.inf)
    assert (c.high - c.value) / c.error == pytest.approx(float(stats.t.ppf(0.975, 3)), rel=1e-9)
    assert [s.estimable for s in surface.statistics.shared] == [False]
    # the first temperature visited again, after the second: now they say it
    again = np.tile([100.0, 160.0, 100.0], (3, 1)).T.ravel()
    speed = np.tile([1.0, 3.0, 9.0], 3)
    visited = hersey.fit(points_of(speed, 5.0 * again**-0.9 * speed**0.3, again, error=0.02))
    assert visited.b is not None
    assert visited.b.estimable
    assert [s.estimable for s in visited.statistics.shared] == [True]


def test_scatter_by_hand() -> None:
    """Beyond errors of 1 %, what brings chi-square to the degrees of freedom."""
    torque = 2.0 * SPEEDS**0.4 * np.exp(wave(8, 0.04))
    surface = hersey.fit(points_of(SPEEDS, torque, error=0.01))
    ones, z = np.ones(8), np.log(SPEEDS)
    y = np.log(torque / SPEEDS)
    values, unit = line([ones, z], y, ones)
    squares = float(np.sum((y - values[0] - values[1] * z) ** 2))
    assert surface.statistics.scatter == pytest.approx((squares / 6 - 0.01**2) ** 0.5, rel=0.02)
    assert surface.c.error == pytest.approx((squares / 6 * unit[1, 1]) ** 0.5, rel=0.02)
    assert surface.statistics.chi_square == pytest.approx(squares / 0.01**2, rel=1e-3)
    assert surface.statistics.reduced_chi_square == pytest.approx(squares / 0.01**2 / 6, rel=1e-3)


def test_errors_of_speed_and_temperature_count() -> None:
    """2 % of torque, 1.5 % of speed, 2 K: of a film of constant thickness, so that speed counts once."""
    w, t = grid(SPEEDS, TEMPERATURES)
    torque = 5.0 * (t / 120.0) ** -0.9 * w * np.exp(wave(w.size, 0.004))
    combined = np.sqrt(0.02**2 + 0.015**2 + (0.9 * 2.0 / t) ** 2)
    surface = hersey.fit(points_of(w, torque, t, 0.02, speed_error=0.015, temperature_error=2.0))
    x, z = np.log(t), np.log(w)
    _, covariance = line([np.ones_like(w), x, z], np.log(torque / w), combined)
    assert surface.b is not None
    assert surface.c.error == pytest.approx(covariance[2, 2] ** 0.5, rel=2e-3)
    assert surface.b.error == pytest.approx(covariance[1, 1] ** 0.5, rel=2e-3)
    squares = float(np.sum((surface.residuals / combined) ** 2))
    assert surface.statistics.chi_square == pytest.approx(squares, rel=2e-3)


def test_an_error_of_temperature_counts_in_the_scale_of_the_law() -> None:
    """A kelvin is a larger share of 90 degC than of 363 K, and b as much smaller."""
    w, t = grid(SPEEDS, TEMPERATURES)
    kelvin = t + 273.15
    torque = 5.0 * (kelvin / 400.0) ** -4.0 * w
    surface = hersey.fit(points_of(w, torque, t, 0.005, temperature_error=2.0), temperature_scale="K")
    sigma = np.hypot(0.005, 4.0 * 2.0 / kelvin)
    _, covariance = line([np.ones_like(w), np.log(kelvin), np.log(w)], np.log(torque / w), sigma)
    assert surface.c.error == pytest.approx(covariance[2, 2] ** 0.5, rel=2e-3)


def test_an_error_of_the_tare_moves_all_dwells_together() -> None:
    """Its share is 1/torque, here nearly a straight line in ln w: a tilt of the whole fit."""
    z = np.log(SPEEDS / stats.gmean(SPEEDS))
    torque = 1.0 / (1.0 + 0.1 * z)
    plain = hersey.fit(points_of(SPEEDS, torque, error=0.03))
    tared = hersey.fit(points_of(SPEEDS, torque, error=0.03, tare_error=0.2))
    assert plain.c.error == pytest.approx(0.03 / np.sum(z**2) ** 0.5, rel=1e-3)
    assert tared.c.error == pytest.approx(np.hypot(plain.c.error, 0.2 * 0.1), rel=1e-3)
    assert tared.covariance[0, 0] ** 0.5 == pytest.approx(np.hypot(0.03 / 8**0.5, 0.2), rel=1e-3)
    space = tared.torque_space["c"].error
    assert space > 1.4 * plain.torque_space["c"].error


@pytest.mark.parametrize("thermal", [False, True])
def test_aicc_by_hand(thermal: bool) -> None:
    """Errors that explain all residuals leave no scatter, of dwells or visits; each is a number fitted."""
    if thermal:
        w, t, torque, errors = thermal_case()
        surface = hersey.fit(points_of(w, torque, t, errors))
    else:
        w, errors = SPEEDS, np.linspace(0.02, 0.04, 8)
        surface = hersey.fit(points_of(w, w**0.3 * np.exp(wave(8, 0.01)), error=errors))
    n, k = w.size, 5 if thermal else 3
    deviance = float(np.sum(np.log(2 * np.pi * errors**2) + (surface.residuals / errors) ** 2))
    assert surface.statistics.aicc == pytest.approx(
        deviance + 2 * k + 2 * k * (k + 1) / (n - k - 1), abs=0.15
    )
    assert (surface.statistics.points, surface.statistics.variables) == (n, 3 if thermal else 2)


def test_shares_of_variance_explained_by_hand() -> None:
    torque = 2.0 * SPEEDS**0.4 * np.exp(wave(8, 0.1))
    surface = hersey.fit(points_of(SPEEDS, torque, error=0.2))
    fitted = surface.a.value * SPEEDS ** (1 + surface.c.value)
    for found, measured, law in (
        (surface.statistics.r_squared_torque, torque, fitted),
        (surface.statistics.r_squared_damping, torque / SPEEDS, fitted / SPEEDS),
    ):
        left = np.sum((measured - law) ** 2) / np.sum((measured - np.mean(measured)) ** 2)
        assert found == pytest.approx(1.0 - left, rel=1e-6)
    assert surface.statistics.r_squared_torque != pytest.approx(
        surface.statistics.r_squared_damping, abs=0.01
    )


def test_in_torque_the_errors_are_absolute() -> None:
    torque = 2.0 * SPEEDS**0.4 * np.exp(0.03 * np.random.default_rng(5).standard_normal(8))
    errors = np.full(8, 0.5)  # N m, beyond what the residuals need
    surface = hersey.fit(points_of(SPEEDS, torque, error=errors / torque))

    def law(w: np.ndarray, log_a: float, c: float) -> np.ndarray:
        return np.asarray(np.exp(log_a) * w ** (1 + c))

    (log_a, c), _ = optimize.curve_fit(law, SPEEDS, torque, p0=[0.7, -0.6], sigma=errors)
    assert surface.torque_space["a"].value == pytest.approx(np.exp(log_a), rel=1e-4)
    assert surface.torque_space["c"].value == pytest.approx(c, rel=1e-4)
    assert surface.torque_space["c"].value != pytest.approx(surface.c.value, rel=1e-3)


def test_an_exponent_of_the_transition_keeps_one_hersey_number() -> None:
    w, t = grid(np.geomspace(0.5, 15, 12), TEMPERATURES)
    at = 1.5 * (t / 150) ** 3.0
    torque = np.where(w > at, (w / at) ** 0.3, (w / at) ** -0.2)
    surface = hersey.fit(points_of(w, torque, t, error=1e-3))
    assert surface.b is not None
    assert surface.transition is not None
    exponent = -surface.b.value / (1.0 + surface.c.value)
    assert surface.transition.temperature_exponent == pytest.approx(exponent, rel=1e-6)
    assert exponent == pytest.approx(3.0, abs=0.1)
    assert surface.variables == ("ln B_ref", "b", "c", "c_mixed", "ln(w_t/w_ref)")
    assert surface.rejected_transition == ""
    assert surface.transition.evidence > 6.0
    at_reference = 1.5 * ((float(surface.reference_temperature or 0.0) - 273.15) / 150) ** 3.0
    assert surface.transition.speed.value == pytest.approx(at_reference, rel=0.01)
    assert surface.transition.mixed_exponent.value == surface.values[3]
    assert surface.transition.mixed_exponent.error == pytest.approx(surface.covariance[3, 3] ** 0.5, rel=1e-3)


def test_a_corner_is_as_uncertain_as_the_profile_of_its_likelihood() -> None:
    """Refitted with the corner held at either end, chi-square rises by the square of t."""
    w = np.geomspace(0.4, 15, 12)
    torque = np.where(w > 2, (w / 2) ** 0.3, (w / 2) ** -0.2) * np.exp(wave(12, 0.01))
    surface = hersey.fit(points_of(w, torque, error=0.012))
    assert surface.transition is not None
    assert not surface.transition.gradual
    speed = surface.transition.speed
    reach = float(stats.t.ppf(0.975, 12 - 4))
    assert speed.value == pytest.approx(surface.reference_speed * np.exp(surface.values[-1]), rel=1e-9)
    sigma = np.hypot(0.012, surface.statistics.scatter) * np.ones(12)

    def chi_square(at: float) -> float:
        columns = [np.ones(12), np.log(w), np.minimum(np.log(w / at), 0.0)]
        values, _ = line(columns, np.log(torque), sigma)
        return float(np.sum(((np.log(torque) - np.column_stack(columns) @ values) / sigma) ** 2))

    for end in (speed.low, speed.high):
        assert chi_square(end) - chi_square(speed.value) == pytest.approx(reach**2, rel=0.02)
    assert speed.error / speed.value == pytest.approx(np.log(speed.high / speed.low) / (2 * reach), rel=1e-9)


def test_why_no_transition_is_said() -> None:
    few = hersey.fit(points_of(SPEEDS[:5], SPEEDS[:5] ** 0.3, error=0.01))
    assert few.rejected_transition == "too few dwells for a second branch"
    straight = hersey.fit(points_of(SPEEDS, SPEEDS**0.3 * np.exp(wave(8, 0.01)), error=0.03))
    assert "a second branch is not supported by the data (AICc gain -" in straight.rejected_transition
    w = np.geomspace(0.4, 15, 12)
    rising = hersey.fit(points_of(w, np.where(w > 2, (w / 2) ** 0.7, (w / 2) ** 0.1), error=0.005))
    assert "does not prove that torque falls with speed" in rising.rejected_transition
    falling = hersey.fit(points_of(w, np.where(w > 2, (w / 2) ** -0.1, (w / 2) ** -0.7), error=0.005))
    assert "does not prove that torque rises with speed" in falling.rejected_transition
    for surface in (few, straight, rising, falling):
        assert surface.transition is None
        assert len(surface.values) == 2


def test_an_estimate_is_printed_with_its_interval() -> None:
    known = Estimate(-0.70123, 0.01, -0.72, -0.68)
    assert str(known) == "-0.701 [-0.720, -0.680]"
    assert repr(known) == "Estimate(-0.701 [-0.720, -0.680] at 95 %)"
    sensors = known.with_systematic(0.0123)
    assert repr(sensors) == "Estimate(-0.701 [-0.720, -0.680] at 95 %, sensor errors add up to 0.012)"
    assert repr(Estimate(0.5, np.inf, -np.inf, np.inf)) == "Estimate(0.5, interval not known)"


def test_the_summary_prints_the_numbers() -> None:
    w, t, torque, errors = thermal_case()
    surface = hersey.fit(points_of(w, torque, t, errors))
    assert surface.b is not None
    st, lines = surface.statistics, surface.summary().splitlines()

    def after(words: str) -> float:
        (found,) = (line for line in lines if line.strip().startswith(words))
        return float(found.split("=")[1].split()[0].rstrip("%"))

    assert after("# data points") == st.points == 32
    assert after("# variables") == st.variables == 3
    assert after("# scatter added") == pytest.approx(100 * st.scatter, abs=1e-3)
    assert after("chi-square") == pytest.approx(st.chi_square, rel=1e-5)
    assert after("reduced chi-square") == pytest.approx(st.chi_square / 29, rel=1e-5)
    assert after("Akaike (AICc)") == pytest.approx(st.aicc, rel=1e-5)
    assert after("R-squared, torque") == pytest.approx(st.r_squared_torque, abs=1e-6)
    assert after("R-squared, damping") == pytest.approx(st.r_squared_damping, abs=1e-6)
    for name, e in (("a", surface.a), ("b", surface.b), ("c", surface.c)):
        (row,) = (
            r
            for r in lines[: lines.index("[[Fitted in torque space, errors absolute]]")]
            if r[:6].split() == [name]
        )
        numbers = (
            row.replace("[", " ").replace("]", " ").replace(",", " ").replace("%)", " ").replace("(", " ")
        )
        value, _, error, share, low, high = numbers.split()[1:7]
        assert (float(value), float(low), float(high)) == pytest.approx((e.value, e.low, e.high), rel=1e-5)
        assert float(error) == pytest.approx(e.error, rel=0.01)
        assert float(share) == pytest.approx(100 * abs(e.error / e.value), abs=0.01)


def test_correlations_are_listed_strongest_first() -> None:
    random = np.random.default_rng(1)
    w = np.geomspace(0.5, 15, 16)
    t = 100.0 * (w / 2.0) ** 0.2 * np.exp(0.1 * random.standard_normal(16))  # hotter when faster
    surface = hersey.fit(points_of(w, 5.0 * t**-0.9 * w**0.3, t, np.linspace(0.02, 0.08, 16)))
    c = surface.covariance
    names = surface.variables
    expected = []
    for i, j in ((0, 1), (0, 2), (1, 2)):
        r = c[i, j] / (c[i, i] * c[j, j]) ** 0.5
        if abs(r) >= 0.1:
            expected.append((-abs(r), f"    C({names[i]}, {names[j]}) = {r:+.4f}"))
    assert len(expected) >= 2
    lines = surface.summary().splitlines()
    heading = lines.index("[[Correlations]] (unreported are below 0.1)")
    assert lines[heading + 1 :] == [row for _, row in sorted(expected)]


def test_the_summary_of_two_branches() -> None:
    w = np.geomspace(0.4, 15, 12)
    bent = np.where(w > 2, (w / 2) ** 0.3, (w / 2) ** -0.2)
    surface = hersey.fit(points_of(w, bent, error=0.01))
    assert surface.transition is not None
    lines = surface.summary().splitlines()
    assert lines[1] == "    B = a w^c    (B in N m s/rad, w in rad/s)"
    assert "    below w_t the exponent is c_mixed" in lines
    (mixed,) = (row for row in lines if row.startswith("    c_mixed "))
    assert float(mixed.split()[1]) == pytest.approx(surface.transition.mixed_exponent.value, rel=1e-6)
    (at,) = (row for row in lines if row.startswith("    w_t "))
    assert float(at.split()[1]) == pytest.approx(surface.transition.speed.value, rel=1e-6)
    assert at.endswith("]  sensors +/- 0.002  rad/s")  # 0.1 % of 2 rad/s
    assert "varies as" not in surface.summary()


def test_the_summary_of_two_branches_says_where_they_move() -> None:
    w, t = grid(np.geomspace(0.5, 15, 12), TEMPERATURES)
    at = 1.5 * (t / 150) ** 3.0
    torque = np.where(w > at, (w / at) ** 0.3, (w / at) ** -0.2)
    surface = hersey.fit(points_of(w, torque, t, error=1e-3))
    assert surface.transition is not None
    text = surface.summary()
    assert "B = a T^b w^c    (B in N m s/rad, T in degC, w in rad/s)" in text
    (row,) = (row for row in text.splitlines() if row.startswith("    w_t  ") and "sensors" in row)
    assert row.endswith(f"  rad/s at {float(surface.reference_temperature or 0.0) - 273.15:.4g} degC")
    assert f"w_t varies as T^{surface.transition.temperature_exponent:.3g} (fixed Hersey number)" in text


@pytest.mark.parametrize("scale", ["degC", "K"])
def test_in_torque_the_coefficients_are_of_the_scale_too(scale: str) -> None:
    """An exact law: both fits find the same a, b and c."""
    w, t = grid(SPEEDS, TEMPERATURES)
    scaled = t + 273.15 if scale == "K" else t
    surface = hersey.fit(points_of(w, 62.0 * scaled**-0.9 * w**0.3, t, 0.01), temperature_scale=scale)
    for name, value in (("a", 62.0), ("b", -0.9), ("c", -0.7)):
        assert surface.torque_space[name].value == pytest.approx(value, rel=1e-4)
