"""A gradual bend: its minimum with an honest interval, what motion is given of it, and who must show it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy import optimize, stats

import hersey
from hersey.damping import smoothing
from hersey.damping.smoothing import Curve, parabola
from hersey.damping.surface import DampingSurface
from hersey.document.assembly import fit_document
from hersey.document.printed import PRINTED
from hersey.document.saved_fit import read_fit
from hersey.errors import ParameterError
from tests.damping.test_surface import points_of

RADIUS, STICK = 0.015, 1e-5
SPEEDS = np.geomspace(0.3, 30.0, 14)


def stribeck(w: np.ndarray, power: float = 1.0) -> np.ndarray:
    """Coulomb torque that falls off, and a viscous one: steeper on one side of the minimum."""
    return np.asarray(0.3 * (1.0 + 0.8 * np.exp(-((w / 2.0) ** power)) + 0.06 * w))


def least_of(power: float = 1.0) -> tuple[float, float]:
    """Speed (rad/s) and torque (N m) where `stribeck` is least."""
    solved = optimize.minimize_scalar(
        lambda z: float(stribeck(np.exp(z), power)), bounds=(-1.0, 3.0), method="bounded"
    )
    return float(np.exp(solved.x)), float(solved.fun)


def recorded(rng: np.random.Generator, noise: float, power: float = 1.0) -> DampingSurface:
    """A fit to dwells up and down."""
    w = np.append(SPEEDS, SPEEDS[::-1])
    torque = stribeck(w, power) * np.exp(noise * rng.standard_normal(w.size))
    return hersey.fit(points_of(w, torque, error=0.3 * noise))


@pytest.fixture(scope="module")
def surface() -> DampingSurface:
    return recorded(np.random.default_rng(4), 0.005)


@pytest.fixture(scope="module")
def hot() -> DampingSurface:
    """At three temperatures; the minimum lies at one Hersey number and moves as T^3."""
    w, t = (each.ravel() for each in np.meshgrid(SPEEDS, [120.0, 150.0, 180.0]))
    z = np.log(w) - 3.0 * np.log(t / 150.0)
    rng = np.random.default_rng(5)
    torque = np.exp(0.4 * z + 0.3 * 0.6 * np.logaddexp(0.0, -z / 0.3)) * (
        1.0 + 0.004 * rng.standard_normal(z.size)
    )
    return hersey.fit(points_of(w, torque, t, error=0.002))


def curve(at: np.ndarray, values: np.ndarray, noise: float, known: np.ndarray | None = None) -> Curve:
    known = parabola(at) if known is None else known
    return Curve(at, values, noise**2 * np.eye(at.size), 1.0, known, at.size - 3.0)


def test_a_minimum_takes_one_covariance_of_each_grid(monkeypatch: pytest.MonkeyPatch) -> None:
    """And one inverse for each ratio of variance that counts, though it weighs the slopes on two grids."""
    seen, covariance = [], smoothing._slope_covariance

    def counted(at: np.ndarray, other: np.ndarray) -> np.ndarray:
        seen.append(at.size)
        return covariance(at, other)

    monkeypatch.setattr(smoothing, "_slope_covariance", counted)
    at, noise = np.linspace(-2.0, 3.0, 15), np.random.default_rng(1).standard_normal(15)
    found = curve(at, 0.3 * (at - 0.7) ** 2 + 0.05 * noise, 0.05)
    assert found.least() is not None
    assert seen == [smoothing._SLOPES, smoothing._SLOPES, 1]
    solved = found._solved
    first = [solved(ratio) for ratio in found._solutions]
    assert len(first) > 5
    assert all(solved(ratio) is kept for ratio, kept in zip(found._solutions, first, strict=True))


def test_the_least_of_a_parabola_is_as_uncertain_as_its_slope() -> None:
    """Where there is nothing but a parabola the ends are those of Fieller's theorem for its slope."""
    at, noise = np.linspace(-2.0, 3.0, 15), 0.01
    rows = parabola(at)
    wiggle = np.random.default_rng(1).standard_normal(15)
    wiggle -= rows @ np.linalg.lstsq(rows, wiggle, rcond=None)[0]
    wiggle *= 0.9 * noise * np.sqrt(12.0) / np.linalg.norm(wiggle)
    found = curve(at, 0.3 * (at - 0.7) ** 2 + 2.0 + wiggle, noise).least()
    assert found is not None
    assert found.log_speed == pytest.approx(0.7, abs=0.03)
    assert found.log_torque == pytest.approx(2.0, abs=noise)
    bread = noise**2 * np.linalg.inv(rows.T @ rows)
    reach = float(stats.t.ppf(0.975, 12))
    for end, side in zip(found.ends, (-1.0, 1.0), strict=True):
        by = np.array([0.0, 1.0, 2.0 * (end + 2.0)])
        # curves that bend more have a weight, which widens it
        assert 1.0 < side * 0.6 * (end - found.log_speed) / (reach * float(np.sqrt(by @ bread @ by))) < 2.5


def test_the_least_scatters_as_its_gains_say() -> None:
    rng, at, noise = np.random.default_rng(6), np.linspace(-2.0, 3.0, 15), 0.01
    values = np.log(stribeck(np.exp(at)))
    found = [curve(at, values + noise * rng.standard_normal(15), noise).least() for _ in range(200)]
    told = [each for each in found if each is not None]
    assert len(told) == 200
    for name, gains in (("log_speed", "speed_gain"), ("log_torque", "torque_gain")):
        by_gain = [noise * float(np.linalg.norm(getattr(each, gains))) for each in told]
        spread = float(np.std([getattr(each, name) for each in told]))
        assert np.median(by_gain) == pytest.approx(spread, rel=0.3)


def test_a_curve_without_a_minimum_has_none() -> None:
    at = np.linspace(0.0, 3.0, 12)
    assert curve(at, 0.4 * at, 0.01).least() is None


def test_a_trend_is_told_from_noise() -> None:
    at = np.linspace(0.0, 3.0, 20)
    noise = 0.01 * np.random.default_rng(2).standard_normal(20)
    line = np.column_stack([np.ones(20), at])
    assert curve(at, noise, 0.01, line).trend() < 3.0
    assert curve(at, noise + 0.03 * np.cos(2.0 * at), 0.01, line).trend() > 20.0


def test_the_transition_is_where_torque_is_least(surface: DampingSurface) -> None:
    speed, torque = least_of()
    t = surface.transition
    assert t is not None
    assert t.gradual
    assert t.speed.low < speed < t.speed.high
    assert t.speed.high / t.speed.low < 1.2
    assert surface.transition_speed() == t.speed.value == pytest.approx(speed, rel=0.06)
    assert t.meeting_speed > t.speed.high  # where the trend lines meet is another speed
    assert t.meeting_speed == pytest.approx(surface.reference_speed * np.exp(surface.values[-1]), rel=1e-9)
    assert surface.transition_torque() == pytest.approx(torque, rel=0.006)
    assert surface.torque(speed=t.meeting_speed) < 0.985 * torque
    assert "the trend lines on either side meet at" in surface.summary()
    assert surface.variables[-1] == "ln(w_meet/w_ref)"


def test_drag_starts_from_the_least_torque(surface: DampingSurface) -> None:
    _, torque = least_of()
    t = surface.transition
    assert t is not None
    drag = surface.drag(roll_radius=RADIUS, stick_speed=STICK)
    assert drag.transition_speed == pytest.approx(t.speed.value * RADIUS, rel=1e-12)
    assert drag.transition_force == pytest.approx(torque / RADIUS, rel=0.006)
    assert (drag.ehl_exponent, drag.mixed_exponent) == (surface.c.value, t.mixed_exponent.value)
    at = drag.transition_speed
    around = drag.force(at * np.array([1.0 - 1e-9, 1.0, 1.0 + 1e-9, 0.5, 2.0]))
    assert around[:3] == pytest.approx(drag.transition_force, rel=1e-8)
    assert np.all(around[3:] > drag.transition_force)


def test_drag_of_a_gradual_bend_at_each_temperature(hot: DampingSurface) -> None:
    t, reference = hot.transition, hot.reference_temperature
    assert t is not None
    assert reference is not None
    assert t.gradual
    share = (reference - 273.15) / 150.0
    expected = share**3.0 * np.exp(0.3 * np.log(0.2 / 0.4))
    assert t.speed.low < expected < t.speed.high
    assert t.speed.value == pytest.approx(expected, rel=0.06)
    warm = hot.drag(roll_radius=RADIUS, stick_speed=STICK)
    for kelvin in (400.0, reference, 445.0):
        drag = hot.drag(roll_radius=RADIUS, stick_speed=STICK, temperature=kelvin)
        assert warm.at(kelvin).transition_speed == pytest.approx(drag.transition_speed, rel=1e-9)
        assert warm.at(kelvin).transition_force == pytest.approx(drag.transition_force, rel=1e-9)
        moved = ((kelvin - 273.15) / (reference - 273.15)) ** t.temperature_exponent
        assert drag.transition_speed == pytest.approx(t.speed.value * moved * RADIUS, rel=1e-9)
        assert drag.transition_force * RADIUS == pytest.approx(hot.transition_torque(), rel=1e-9)


@pytest.mark.parametrize("name", ["surface", "hot"])
def test_draws_of_drag_spread_as_the_interval(name: str, request: pytest.FixtureRequest) -> None:
    fit = request.getfixturevalue(name)
    drag = fit.drag(roll_radius=RADIUS, stick_speed=STICK).at(fit.reference_temperature)
    draws = fit.drag_samples(
        20_000, 1, roll_radius=RADIUS, stick_speed=STICK, temperature=fit.reference_temperature
    )
    speed = fit.transition.speed
    low, high = np.quantile(np.log(draws["transition_speed"]), [0.025, 0.975])
    assert high - low == pytest.approx(np.log(speed.high / speed.low), rel=0.06)
    for parameter, sample in draws.items():
        assert np.median(sample) == pytest.approx(getattr(drag, parameter), rel=0.02)
    low, high = np.quantile(draws["transition_force"], [0.025, 0.975])
    assert 0.002 < np.log(high / low) < 0.03  # torque where it is least is well known, wherever that is


def test_draws_know_that_the_least_goes_with_the_exponents() -> None:
    """Over many logs the least speed and the exponents vary together as one log's draws do."""
    rng = np.random.default_rng(11)
    fits = [recorded(rng, 0.01) for _ in range(40)]
    rows = np.array([[np.log(f.transition_speed()), f.c.value] for f in fits if f.transition])
    draws = fits[0].drag_samples(4000, 1, roll_radius=RADIUS, stick_speed=STICK)
    drawn = np.corrcoef(np.log(draws["transition_speed"]), draws["ehl_exponent"])[0, 1]
    assert drawn == pytest.approx(np.corrcoef(rows.T)[0, 1], abs=0.4)
    assert np.std(np.log(draws["transition_speed"])) < 2.0 * np.std(rows[:, 0])


@pytest.mark.parametrize("power", [0.7, 1.0, 2.0])
def test_the_interval_of_a_gradual_bend_holds_its_minimum(power: float) -> None:
    """29 of 30 are expected; below 25 is one time in a hundred thousand."""
    rng, (speed, _) = np.random.default_rng(7), least_of(power)
    fits = [recorded(rng, 0.006, power) for _ in range(30)]
    told = [f.transition.speed for f in fits if f.transition]
    assert len(told) >= 28
    assert sum(e.low < speed < e.high for e in told) >= len(told) - 4
    spread = 4.0 * float(np.std([np.log(e.value) for e in told]))
    assert np.median([np.log(e.high / e.low) for e in told]) < 2.0 * spread


def test_a_corner_stays_a_corner() -> None:
    rng, w = np.random.default_rng(3), np.append(SPEEDS, SPEEDS[::-1])
    shape = np.where(w > 3.0, (w / 3.0) ** 0.4, (w / 3.0) ** -0.25)
    fits = [
        hersey.fit(points_of(w, shape * np.exp(0.01 * rng.standard_normal(w.size)), error=0.003))
        for _ in range(20)
    ]
    told = [f.transition for f in fits if f.transition]
    assert len(told) == 20
    assert sum(t.gradual for t in told) <= 3
    assert sum(t.speed.low < 3.0 < t.speed.high for t in told) >= 17
    corners = [t for t in told if not t.gradual]
    assert all(t.meeting_speed == pytest.approx(t.speed.value, rel=1e-12) for t in corners)


def test_a_saved_fit_keeps_its_bend(
    surface: DampingSurface, log: hersey.TorqueLog, points: hersey.SteadyPoints, tmp_path: Path
) -> None:
    """In the document of another fit, without its dwells."""
    part = PRINTED["fit"].model_validate(fit_document(log, points, hersey.fit(points)))
    document = {"hersey_version": surface.version} | part.model_dump(mode="json") | {"points": []}
    document["fit"] |= surface.to_dict()
    path = tmp_path / "fit.json"
    path.write_text(json.dumps(document))
    again = read_fit(path)
    given = {"roll_radius": RADIUS, "stick_speed": STICK}
    assert again.drag(**given) == surface.drag(**given)
    one, two = (s.drag_samples(50, 3, **given) for s in (surface, again))
    assert np.array_equal(one["transition_force"], two["transition_force"])
    closure = document["fit"]["transition"]["closure"]
    closure["covariance"][0][0] *= -1.0
    path.write_text(json.dumps(document))
    with pytest.raises(ParameterError, match=r"fit.transition.closure: it must be symmetric"):
        read_fit(path)
    closure["values"].pop()
    path.write_text(json.dumps(document))
    with pytest.raises(ParameterError, match=r"fit.transition.closure: it must have 4 values"):
        read_fit(path)


def corner(away: np.ndarray) -> np.ndarray:
    return np.where(away > 0, 0.4 * away, -0.25 * away)


def test_a_fall_in_one_rotation_alone_is_not_announced() -> None:
    rng, z = np.random.default_rng(8), np.log(SPEEDS / 3.0)
    falls = corner(z)
    level = np.where(z > 0, 0.4 * z, 0.0)
    noise = 0.004 * rng.standard_normal((2, z.size))
    w = np.append(SPEEDS, -SPEEDS)
    both = hersey.fit(points_of(w, np.sign(w) * np.exp(np.append(falls, falls) + noise.ravel()), error=0.002))
    assert both.transition is not None
    one = hersey.fit(points_of(w, np.sign(w) * np.exp(np.append(falls, level) + noise.ravel()), error=0.002))
    assert one.transition is None
    assert (
        "torque does not fall in the dwells of reverse rotation. Fit each rotation separately"
        in one.rejected_transition
    )


def test_a_fall_on_the_way_up_alone_is_not_announced() -> None:
    rng, z = np.random.default_rng(9), np.log(SPEEDS / 3.0)
    falls, level = corner(z), np.where(z > 0, 0.4 * z, 0.0)
    values = np.append(falls, level) + 0.004 * rng.standard_normal(2 * z.size)
    points = points_of(np.append(SPEEDS, SPEEDS), np.exp(values), error=0.002)
    ways = pl.Series("approach", ["from below"] * z.size + ["from above"] * z.size)
    surface = hersey.fit(replace(points, table=points.table.with_columns(ways)))
    assert surface.transition is None
    assert "does not fall in the dwells approached from above" in surface.rejected_transition
    points = points_of(np.append(SPEEDS, SPEEDS), np.exp(np.append(falls, falls)), error=0.002)
    assert hersey.fit(replace(points, table=points.table.with_columns(ways))).transition is not None


def test_few_dwells_of_a_rotation_are_not_asked() -> None:
    rng, z = np.random.default_rng(10), np.log(SPEEDS / 3.0)
    w = np.append(SPEEDS, -SPEEDS[:2])
    values = np.append(corner(z), corner(z)[:2]) + 0.003 * rng.standard_normal(w.size)
    assert hersey.fit(points_of(w, np.sign(w) * np.exp(values), error=0.002)).transition is not None


def test_one_speed_is_no_falling_branch() -> None:
    """Dwells at the slowest speed alone have more torque than the least beyond their errors."""
    w = np.repeat(np.geomspace(1.0, 20.0, 12), 2)
    rng, level = np.random.default_rng(12), np.unique(w)
    rises = np.where(w > level[5], 0.4 * np.log(w / level[5]), 0.0)
    values = rises + 0.06 * (w == level[0]) + 0.002 * rng.standard_normal(w.size)
    surface = hersey.fit(points_of(w, np.exp(values), error=0.001))
    assert surface.transition is None
    assert "exceeds its minimum at only 1 of 5 speeds, and 2 are needed" in surface.rejected_transition
