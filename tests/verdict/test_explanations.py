"""What a verdict names and what it lists, on torques whose law is known."""

from __future__ import annotations

import numpy as np
import pytest

import hersey
from hersey.verdict.regimes import named_in_words
from tests.damping.test_surface import grid, points_of

SPEEDS = np.geomspace(0.5, 15.0, 12)
MIDDLE = float(np.exp(np.mean(np.log(SPEEDS))))
REGIMES = {
    "constant film": 0.0,
    "soft EHL": -0.58,
    "rigid piezoviscous film": -2 / 3,
    "Dowson-Higginson EHL": -0.7,
    "dry Coulomb friction or a rigid film": -1.0,
    "falling branch": -1.2,
}


def seen(torque: np.ndarray, scatter: float = 0.004, seed: int = 1) -> hersey.Regime:
    """What is said of a torque at these speeds, read with a scatter."""
    noise = scatter * np.random.default_rng(seed).standard_normal(SPEEDS.size)
    points = points_of(SPEEDS, torque * np.exp(noise), error=scatter)
    return hersey.regime(points, hersey.fit(points))


def keys(regime: hersey.Regime) -> list[str]:
    return [e.key for e in regime.explanations]


@pytest.mark.parametrize("name", REGIMES)
def test_a_clean_power_law_of_each_regime_is_named(name: str) -> None:
    found = seen(2.0 * SPEEDS ** (1.0 + REGIMES[name]))
    assert found.named == name
    assert name in keys(found)
    assert f"as expected for {named_in_words(name)}" in found.headline()
    assert f"as expected for {named_in_words(name)}" in found.verdict


@pytest.mark.parametrize("ratio", [0.1, 0.5, 2.0])
def test_friction_and_viscous_drag_names_no_regime(ratio: float) -> None:
    """T0 + k w, which any one exponent misses."""
    for seed in range(3):
        found = seen(1.0 + ratio * SPEEDS / MIDDLE, seed=seed)
        assert found.named is None
        assert found.why_unnamed
        assert "Coulomb + viscous" in keys(found)
        assert "as expected for" not in found.verdict
        assert "no regime named" in found.headline()
    (both,) = (e for e in found.explanations if e.key == "Coulomb + viscous")
    assert both.constant_share == pytest.approx(1.0 / (1.0 + ratio), abs=0.05)


@pytest.mark.parametrize("scatter", [0.003, 0.02])
def test_a_soft_film_beside_a_constant_is_not_called_dowson_higginson(scatter: float) -> None:
    """An exponent of -0.6 with a quarter of the torque constant measures -0.70."""
    torque = 0.75 * (SPEEDS / MIDDLE) ** 0.4 + 0.25
    for seed in range(3):
        found = seen(torque, scatter, seed)
        assert found.named != "Dowson-Higginson EHL"
        assert "soft EHL + constant torque" in keys(found)
    points = points_of(SPEEDS, torque, error=0.003)
    assert hersey.fit(points).c.value == pytest.approx(-0.70, abs=0.01)


def test_what_bends_otherwise_is_another_curvature() -> None:
    """An exponent that falls with speed, as by thinning or heat, is no film beside a constant."""
    z = np.log(SPEEDS / MIDDLE)
    found = seen(np.exp(0.3 * z - 0.03 * z**2))
    # one regime has the mean exponent, and is not named for it
    assert [h.name for h in found.hypotheses if h.consistent] == ["Dowson-Higginson EHL"]
    assert found.named is None
    assert {"shear thinning", "shear heating"} <= set(keys(found))
    assert not any("constant torque" in key for key in keys(found))
    assert found.lack_of_fit is not None
    assert found.lack_of_fit.in_speed


def test_a_steep_fall_says_what_else_falls_so() -> None:
    steep, gentle = (seen(SPEEDS ** (1.0 + c)).verdict for c in (-1.8, -1.2))
    assert "braking" in steep
    assert "controller" in steep
    assert "braking" not in gentle


def test_torque_that_is_not_monotone_does_not_fall_over_the_whole_range() -> None:
    """It falls in the mean, and rises at the fast end."""
    z = np.log(SPEEDS / MIDDLE)
    for rise in (0.1, 0.15):
        found = seen(np.exp(-0.2 * z + rise * z**2))
        assert "whole range" not in found.verdict
    assert "whole range" in seen(SPEEDS**-0.2).verdict


def test_torque_falls_over_the_whole_range_only_if_it_falls_at_both_ends() -> None:
    """Where chance lets it rise at one end, it is not said of the whole."""
    said = set()
    for seed in range(10):
        found = seen(SPEEDS**-0.3, 0.06, seed)
        if "Torque falls" in found.verdict and found.lack_of_fit is not None:
            falls = max(found.lack_of_fit.local_exponents) < -1.0
            assert ("over the whole range" in found.verdict) == falls
            said.add(falls)
    assert said == {True, False}


def test_a_fall_is_claimed_only_where_the_dwells_show_it() -> None:
    """With 6 % of scatter an exponent below -1 may come from a few dwells; with 1 % torque falls."""
    words = [seen(SPEEDS**-0.15, scatter, 2).verdict for scatter in (0.06, 0.01)]
    assert "the dwells alone do not show it" in words[0]
    assert "Torque falls as speed rises" in words[1]


def test_a_hump_is_not_said_to_fall_below_a_speed() -> None:
    """Torque that rises and then falls is least at an end: no falling branch lies below that."""
    z = np.log(SPEEDS / MIDDLE)
    found = seen(np.exp(-0.06 * z**2), 0.003, 1)
    assert "Torque rises first" in found.verdict
    assert "too few dwells lie there" not in found.verdict


def test_an_exponent_between_two_regimes_says_why_none_is_named() -> None:
    """One law holds, and it is that of no regime: the reason is never empty."""
    found = seen(2.0 * SPEEDS**0.2)
    assert found.named is None
    assert found.why_unnamed.startswith(("no known regime", "the dwells do not exclude "))


def test_too_few_speeds_name_nothing() -> None:
    w, t = grid(np.array([1.0, 4.0, 12.0]), np.array([90.0, 120.0, 150.0]))
    points = points_of(w, 62.0 * t**-0.9 * w**0.3, t, error=0.002)
    found = hersey.regime(points, hersey.fit(points))
    assert found.named is None
    assert found.lack_of_fit is None
    assert "Dowson-Higginson EHL" in keys(found)
    assert found.why_unnamed


def test_what_too_few_dwells_cannot_try_is_listed() -> None:
    """Five dwells hold one exponent, and say nothing of a constant torque beside the film."""
    few = np.geomspace(0.5, 15.0, 5)
    points = points_of(few, 2.0 * few**0.3 * (1.0 + 0.002 * np.array([1, -1, 0, 1, -1])), error=0.002)
    found = hersey.regime(points, hersey.fit(points))
    assert found.named is None
    assert keys(found)[0] == "Dowson-Higginson EHL"
    assert "film + constant torque" in keys(found)
    assert "any film plus a constant torque (too few dwells to test it)" in found.verdict
    assert "film + constant torque" not in keys(seen(2.0 * SPEEDS**0.3))


def test_a_regime_is_named_from_the_dwells_of_several_temperatures() -> None:
    w, t = grid(SPEEDS, np.array([90.0, 120.0, 150.0]))
    noise = 0.003 * np.random.default_rng(2).standard_normal(w.size)
    points = points_of(w, 62.0 * t**-0.9 * w**0.42 * np.exp(noise), t, error=0.003)
    assert hersey.regime(points, hersey.fit(points)).named == "soft EHL"
    friction = points_of(w, (1.0 + 62.0 * t**-0.9 * w) * np.exp(noise), t, error=0.003)
    found = hersey.regime(friction, hersey.fit(friction))
    assert found.named is None
    assert "Coulomb + viscous" in keys(found)


def test_a_record_keeps_what_was_named_and_listed() -> None:
    found = seen(1.0 + 0.5 * SPEEDS / MIDDLE)
    plain = found.to_dict()
    assert plain["named"] is None
    assert [e["key"] for e in plain["explanations"]] == keys(found)
    assert plain["lack_of_fit"]["curvature"] == found.lack_of_fit.curvature  # type: ignore[union-attr]
