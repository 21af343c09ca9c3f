"""Verdicts follow from the exponents and name what they reject."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import hersey
from hersey.damping.estimate import Estimate
from hersey.damping.gradual import Closure
from hersey.damping.surface import DampingSurface
from hersey.units import celsius
from hersey.verdict.regimes import REGIMES, Hypothesis
from tests.damping.test_surface import SPEEDS, grid, points_of
from tests.verdict.cases import alone, holm

RPM = np.pi / 30
COULOMB = "dry Coulomb friction or a rigid film"


def verdict(exponent: float, error: float = 0.005) -> hersey.Regime:
    random = np.random.default_rng(8)
    torque = SPEEDS ** (1 + exponent) * np.exp(error * random.standard_normal(SPEEDS.size))
    points = points_of(SPEEDS, torque, error=error)
    return hersey.regime(points, hersey.fit(points))


@pytest.mark.parametrize(
    ("exponent", "name"),
    [(0.0, "constant film"), (-0.58, "soft EHL"), (-0.7, "Dowson-Higginson EHL"), (-1.0, "dry Coulomb")],
)
def test_each_regime_is_recognised(exponent: float, name: str) -> None:
    found = verdict(exponent)
    assert name in found.verdict
    kept = [h.name for h in found.hypotheses if h.consistent]
    assert any(k.startswith(name) for k in kept)
    assert not {"constant film", COULOMB} & set(kept) or exponent in (0.0, -1.0)


def test_a_falling_branch_warns_of_stick_slip() -> None:
    said = verdict(-1.2).verdict
    assert "Torque falls as speed rises over the whole range" in said
    assert "stick-slip is then possible" in said


def test_what_fits_nothing_is_said_to_fit_nothing() -> None:
    found = verdict(-0.85)
    assert "fits no regime" in found.verdict
    assert found.named is None
    assert not any(h.consistent for h in found.hypotheses)


def test_wide_intervals_reject_nothing_near() -> None:
    points = points_of(SPEEDS, SPEEDS**0.35, error=0.1)
    found = hersey.regime(points, hersey.fit(points))
    assert {"soft EHL", "Dowson-Higginson EHL"} <= {h.name for h in found.hypotheses if h.consistent}


def test_p_values_and_intervals_agree() -> None:
    """What the interval and the sensors hold is never refuted; what lies beyond is by Holm's p-value."""
    random = np.random.default_rng(9)
    saved = 0
    for _ in range(20):
        torque = SPEEDS**0.3 * np.exp(0.02 * random.standard_normal(SPEEDS.size))
        points = points_of(SPEEDS, torque, error=0.02)
        surface = hersey.fit(points)
        c = surface.c
        assert c.systematic > 0
        adjusted, reach = holm(alone(c)), c.high - c.value + c.systematic
        for h in hersey.regime(points, surface).hypotheses:
            assert h.p_value == pytest.approx(adjusted[h.name], rel=1e-9)
            assert h.consistent == (adjusted[h.name] > 0.05)
            if np.isfinite(h.low):
                within = c.value - reach <= h.high and c.value + reach >= h.low
                assert h.consistent or not within
                saved += h.consistent and not within
    assert saved > 0


def test_exponents_per_temperature_and_branch(points: hersey.SteadyPoints) -> None:
    found = hersey.regime(points, hersey.fit(points))
    branches = {(e.branch, round((e.temperature or 0) - 273.15)) for e in found.exponents}
    assert ("mixed", 180) in branches
    assert ("ehl", 90) in branches
    for e in found.exponents:
        assert e.exponent.value == pytest.approx(-1.2 if e.branch == "mixed" else -0.7, abs=0.05)


def surface_of(c: float, error: float = 0.05, freedom: int = 5) -> DampingSurface:
    """A law of speed alone with the exponent, error and degrees of freedom asked for."""
    surface = hersey.fit(points_of(SPEEDS, SPEEDS**0.3, error=0.01))
    reach = float(stats.t.ppf(0.975, freedom)) * error
    return replace(
        surface,
        c=Estimate(c, error, c - reach, c + reach, freedom),
        statistics=replace(surface.statistics, points=freedom + 2, variables=2),
    )


def p_values(c: float, error: float = 0.05, freedom: int = 5) -> dict[str, float]:
    points = points_of(SPEEDS, SPEEDS ** (1 + c))
    return {h.name: h.p_value for h in hersey.regime(points, surface_of(c, error, freedom)).hypotheses}


def test_the_hypotheses_are_those_of_the_literature() -> None:
    assert [h[:3] for h in REGIMES] == [
        ("constant film", 0.0, 0.0),
        ("soft EHL", -0.60, -0.56),
        ("rigid piezoviscous film", -2 / 3, -2 / 3),
        ("Dowson-Higginson EHL", -0.70, -0.70),
        (COULOMB, -1.0, -1.0),
        ("falling branch", -np.inf, -1.0),
    ]


@pytest.mark.parametrize("freedom", [3, 5, 30])
def test_p_values_by_hand(freedom: int) -> None:
    def two_sided(distance: float) -> float:
        return 2.0 * float(stats.t.sf(distance / 0.05, freedom))

    found = p_values(-0.84, 0.05, freedom)
    by_itself = {
        "constant film": two_sided(0.84),
        "soft EHL": two_sided(0.24),  # from the nearer end
        "rigid piezoviscous film": two_sided(0.84 - 2 / 3),
        "Dowson-Higginson EHL": two_sided(0.14),
        COULOMB: two_sided(0.16),
        "falling branch": two_sided(0.16) / 2.0,  # only one side speaks against it
    }
    assert found == pytest.approx(holm(by_itself))
    assert found["constant film"] == pytest.approx(6.0 * two_sided(0.84))  # the least of six


def test_p_values_on_the_other_side() -> None:
    slow = p_values(-0.50)
    assert slow["soft EHL"] == pytest.approx(2.0 * float(stats.t.sf(0.06 / 0.05, 5)))  # the last is itself
    steep = p_values(-1.10)
    assert steep[COULOMB] == pytest.approx(4.0 * float(stats.t.sf(2.0, 5)))  # the last but one
    assert steep["falling branch"] == pytest.approx(0.5)
    assert p_values(-0.58)["soft EHL"] == 1.0
    assert p_values(-0.7, error=0.0)["Dowson-Higginson EHL"] == 1.0
    assert p_values(-0.7, error=0.0)["constant film"] == pytest.approx(0.0, abs=1e-12)


def test_a_hypothesis_survives_at_five_percent() -> None:
    kept, lost = (Hypothesis("", 0.0, 0.0, "", "", p) for p in (0.0501, 0.0499))
    assert kept.consistent
    assert not lost.consistent


def line_by_hand(z: np.ndarray, y: np.ndarray, sigma: np.ndarray) -> tuple[float, float]:
    """Slope of a weighted line and its standard error."""
    rows = np.column_stack([np.ones_like(z), z]) / sigma[:, None]
    (_, slope), *_ = np.linalg.lstsq(rows, y / sigma, rcond=None)
    return float(slope), float(np.linalg.inv(rows.T @ rows)[1, 1] ** 0.5)


def test_the_exponent_of_a_temperature_by_hand() -> None:
    """Each dwell is brought to one temperature by the b of the surface, its scatter added to every error."""
    random = np.random.default_rng(4)
    w, t = grid(np.geomspace(0.5, 15, 6), np.array([100.0, 160.0]))
    t = t + np.tile([-1.0, 1.0, 0.5, -0.5, 1.5, -0.9], 2)
    errors = np.tile([0.005, 0.01, 0.02, 0.03, 0.02, 0.04], 2)
    torque = 5.0 * (t / 120) ** -0.9 * w**0.3 * np.exp(0.02 * random.standard_normal(w.size))
    points = points_of(-w, -torque, t, errors)  # of a drive that turns backwards
    surface = hersey.fit(points)
    surface = replace(surface, statistics=replace(surface.statistics, scatter=0.015, points=12, variables=3))
    assert surface.b is not None
    found = hersey.regime(points, surface).exponents
    assert [(e.branch, e.points) for e in found] == [("all", 6), ("all", 6)]
    for exponent, group in zip(found, (t < 130, t > 130), strict=True):
        y = np.log(torque / w)[group] - surface.b.value * np.log(t[group])
        slope, error = line_by_hand(np.log(w[group]), y, np.hypot(errors[group], 0.015))
        e = exponent.exponent
        assert e.value == pytest.approx(slope, rel=1e-9)
        assert e.error == pytest.approx(error, rel=1e-9)
        assert (e.high - e.value) / error == pytest.approx(stats.t.ppf(0.975, 9), rel=1e-9)
        assert (e.value - e.low) / error == pytest.approx(stats.t.ppf(0.975, 9), rel=1e-9)
        assert exponent.temperature == pytest.approx(273.15 + float(np.mean(t[group])))
        assert (exponent.speed_low, exponent.speed_high) == pytest.approx((0.5, 15.0))


def bent(celsius: bool) -> tuple[hersey.SteadyPoints, DampingSurface]:
    """Points and surface of two branches that meet at 1.5 rad/s and 150 degC; 3.0 at 189 degC."""
    w, t = grid(np.geomspace(0.4, 15, 14), np.array([120.0, 150.0, 180.0]) if celsius else np.array([150.0]))
    at = 1.5 * (t / 150) ** 3.0
    torque = np.where(w > at, (w / at) ** 0.3, (w / at) ** -0.2)
    points = points_of(w, torque, t if celsius else None, error=2e-3)
    return points, hersey.fit(points)


def test_branches_part_at_the_transition_of_their_own_temperature() -> None:
    points, surface = bent(celsius=True)
    speeds = np.geomspace(0.4, 15, 14)
    found = hersey.regime(points, surface).exponents
    assert [e.branch for e in found] == ["mixed", "ehl"] * 3
    for kelvin, mixed, ehl in zip((393.15, 423.15, 453.15), found[::2], found[1::2], strict=True):
        slow = speeds[speeds < surface.transition_speed(kelvin)]
        assert mixed.temperature == ehl.temperature == pytest.approx(kelvin)
        assert (mixed.points, ehl.points) == (slow.size, 14 - slow.size)
        assert (mixed.speed_low, mixed.speed_high) == pytest.approx((0.4, slow[-1]))
        assert (ehl.speed_low, ehl.speed_high) == pytest.approx((speeds[slow.size], 15.0))
        assert mixed.exponent.value == pytest.approx(-1.2, abs=0.01)
        assert ehl.exponent.value == pytest.approx(-0.7, abs=0.01)


def test_three_speeds_make_an_exponent_and_two_do_not() -> None:
    points, surface = bent(celsius=False)
    assert surface.transition is not None
    speeds = points.column("speed")
    for slow, branches in ((3, ["mixed", "ehl"]), (2, ["ehl"])):
        at = float(np.sqrt(speeds[slow - 1] * speeds[slow]))
        moved = replace(surface.transition, speed=Estimate(at, 0.0, at, at))
        found = hersey.regime(points, replace(surface, transition=moved)).exponents
        assert [e.branch for e in found] == branches
        assert found[0].temperature is None


def test_the_verdict_of_one_branch_in_words() -> None:
    def said(c: float, error: float) -> str:
        return hersey.regime(points_of(SPEEDS, SPEEDS ** (1 + c)), surface_of(c, error)).verdict

    reach = float(stats.t.ppf(0.975, 5))
    assert said(-0.7, 0.02 / reach) == (
        "Damping varies as speed^-0.700 [-0.720, -0.680], as expected for Dowson-Higginson EHL. The "
        "data show no transition to a falling branch."
    )
    assert "-0.630 [-0.640, -0.620], which lies between soft EHL and rigid" in (said(-0.63, 0.01 / reach))
    assert "-0.65 [-0.75, -0.55]. Not excluded: soft EHL; rigid piezoviscous film; Dowson-" in said(
        -0.65, 0.1 / reach
    )
    assert "speed^0.2000 [0.1995, 0.2005], which fits no regime. " in said(0.2, 0.0005 / reach)
    assert "lies between constant film and soft EHL" in said(-0.3, 0.01)
    assert "lies between Dowson-Higginson EHL and dry Coulomb friction or a rigid film" in said(-0.85, 0.01)
    assert said(-1.2, 0.06 / reach) == (
        "Damping varies as speed^-1.20 [-1.26, -1.14], as expected for a falling branch. Torque "
        "falls as speed rises over the whole range. Mixed or boundary lubrication can cause this, "
        "and stick-slip is then possible."
    )
    assert "does not exclude a constant torque" in said(-1.02, 0.03)


def test_the_verdict_of_two_branches_in_words() -> None:
    points, surface = bent(celsius=False)
    assert surface.transition is not None
    exact = replace(
        surface.transition,
        speed=Estimate(20 * RPM, RPM, 18 * RPM, 22 * RPM),
        mixed_exponent=Estimate(-1.2, 0.01, -1.22, -1.18),
        closure=None,
    )
    surface = replace(surface, transition=exact, c=Estimate(-0.7, 0.01, -0.72, -0.68))
    assert hersey.regime(points, surface).verdict == (
        "Torque is lowest at 20.0 rpm [18.0, 22.0]. Above this speed torque rises, as with a film "
        "that carries the load. Damping varies as speed^-0.700 [-0.720, -0.680], as expected for "
        "Dowson-Higginson EHL. Below it torque rises as the drive slows: lubrication is mixed, and "
        "stick-slip is possible. The exponent of damping there is -1.20 [-1.22, -1.18]."
    )
    gradual = replace(surface, transition=replace(exact, closure=Closure(surface.values, surface.covariance)))
    assert hersey.regime(points, gradual).verdict.startswith(
        "Torque is lowest at 20.0 rpm [18.0, 22.0]. Above"
    )
    erring = replace(surface, transition=replace(exact, speed=exact.speed.with_systematic(0.5 * RPM)))
    assert hersey.regime(points, erring).verdict.startswith(
        "Torque is lowest at 20.0 rpm [18.0, 22.0] (sensors ± 0.5). Above"
    )


@pytest.mark.parametrize(
    ("exponent", "words"),
    [(3.0, "150 degC, and at higher speed when hotter. Above"), (-3.0, "150 degC. Above")],
)
def test_the_verdict_says_where_the_transition_moves(exponent: float, words: str) -> None:
    points, surface = bent(celsius=True)
    assert surface.transition is not None
    moved = replace(surface.transition, temperature_exponent=exponent)
    verdict = hersey.regime(
        points, replace(surface, transition=moved, reference_temperature=150.2 + 273.15)
    ).verdict
    assert " at 150 degC" in verdict
    assert words in verdict


def test_the_ice_point() -> None:
    assert celsius(273.15) == pytest.approx(0.0, abs=1e-9)


def test_the_verdict_names_the_scale_of_the_fit() -> None:
    w, t = grid(np.geomspace(0.4, 15, 14), np.array([120.0, 150.0, 180.0]))
    at = 1.5 * ((t + 273.15) / 423.15) ** 9.0
    points = points_of(w, np.where(w > at, (w / at) ** 0.3, (w / at) ** -0.2), t, error=2e-3)
    in_kelvin = hersey.fit(points, temperature_scale="K")
    assert f" at {in_kelvin.reference_temperature:.0f} K" in hersey.regime(points, in_kelvin).verdict
