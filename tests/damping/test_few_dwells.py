"""A falling branch that few dwells hold, and a transition that one Hersey number does not."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.branches import fit_branches
from hersey.damping.candidates import Observations
from hersey.damping.candidates.branched import ONE
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.thermal import CELSIUS as CELSIUS_SCALE
from hersey.damping.gradual import _by_power
from hersey.damping.scaled import move_of, scaled_speed, scaled_torque
from hersey.damping.surface import DampingSurface
from hersey.document.assembly import fit_document
from hersey.document.printed import PRINTED
from hersey.document.saved_fit import read_fit
from tests.damping.test_surface import points_of

RADIUS, STICK = 0.015, 1e-4
CELSIUS = np.array([90.0, 130.0, 170.0])


def fitted(
    speeds: np.ndarray, turn: np.ndarray, down: float, noise: np.ndarray, celsius: np.ndarray | None = None
) -> DampingSurface:
    """A corner at ``turn``, torque falling by ``down`` below it and rising by 0.4 above."""
    z = np.log(speeds / turn)
    torque = np.exp(np.where(z < 0.0, down, 0.4) * z + noise)
    return hersey.fit(points_of(speeds, torque, celsius, error=0.005))


def by_temperature(speeds: np.ndarray, exponent: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Speeds, transition speeds and temperatures of a grid; the transition is 2 rad/s at 130 degC."""
    w, t = (each.ravel() for each in np.meshgrid(speeds, CELSIUS))
    return w, 2.0 * (t / 130.0) ** exponent, t


def test_three_dwells_hold_a_falling_branch() -> None:
    """Three of eight fall, the fourth stands just above the corner: it was taken for one of them."""
    rng, w = np.random.default_rng(21), 0.6 * 1.53 ** np.arange(8)
    turn = 0.93 * w[3]
    told = [fitted(w, turn, -0.6, 0.02 * rng.standard_normal(8)).transition for _ in range(6)]
    found = [t for t in told if t is not None]
    assert len(found) >= 5
    assert not any(t.gradual for t in found)
    assert sum(t.speed.low < turn < t.speed.high for t in found) >= len(found) - 2
    mixed = [t.mixed_exponent for t in found]
    assert sum(e.low < -1.6 < e.high for e in mixed) >= len(found) - 2
    assert np.median([e.value for e in mixed]) == pytest.approx(-1.6, abs=0.05)
    assert np.median([e.high - e.low for e in mixed]) < 0.4


def test_three_dwells_of_three_temperatures_hold_it_too() -> None:
    rng = np.random.default_rng(22)
    w, turn, t = by_temperature(1.6 * 1.5 ** np.arange(7), 2.0)
    assert np.count_nonzero(w < turn) == 3
    for _ in range(3):
        surface = fitted(w, turn, -0.7, 0.01 * rng.standard_normal(w.size), t)
        found = surface.transition
        assert found is not None
        assert found.mixed_exponent.low < -1.7 < found.mixed_exponent.high
        hot = surface.transition_estimate(170.0 + 273.15)
        assert hot.value == pytest.approx(2.0 * (170 / 130) ** 2.0, rel=0.06)
        assert found.freed is None


def test_two_dwells_do_not() -> None:
    """A line through two would fit any: neither claimed nor denied."""
    w = 0.6 * 1.53 ** np.arange(9)
    noise = 0.004 * np.random.default_rng(23).standard_normal(9)
    surface = fitted(w, np.full(9, 0.95 * w[2]), -0.6, noise)
    assert surface.transition is None
    why = surface.rejected_transition
    assert "where two branches would meet; 3 dwells at 2 speeds are needed. Record slower" in why


def test_dwells_of_one_speed_are_one_speed() -> None:
    w = np.append(np.repeat(0.7, 4), 1.3 * 1.4 ** np.arange(8))
    noise = 0.004 * np.random.default_rng(24).standard_normal(w.size)
    surface = fitted(w, np.full(w.size, 1.2), -0.6, noise)
    assert "only 4 dwells at 1 speeds lie" in surface.rejected_transition


def test_the_exponent_of_few_dwells_knows_that_the_corner_may_move() -> None:
    """A dwell beside the corner may be of either branch: beyond what the slope of the likelihood has it."""
    w = 0.6 * 1.4 ** np.arange(9)
    noise = 0.03 * np.random.default_rng(7).standard_normal(9)
    surface = fitted(w, np.full(9, 1.02 * w[3]), -0.5, noise)
    found = surface.transition
    assert found is not None
    mixed = found.mixed_exponent
    by_slope = float(np.sqrt(surface.covariance[2, 2]))
    assert mixed.error > 1.03 * by_slope
    drawn = surface.drag_samples(8000, 1, roll_radius=RADIUS, stick_speed=STICK)["mixed_exponent"]
    low, high = np.quantile(drawn, [0.025, 0.975])
    assert high - low == pytest.approx(mixed.high - mixed.low, rel=0.12)


def test_the_exponent_is_followed_beyond_the_kink_of_a_corner() -> None:
    """The likelihood of the exponent rises, then falls again as a dwell changes its branch: both count."""
    rng, w = np.random.default_rng(538), 0.6 * 1.35 ** np.arange(9)
    turn = rng.uniform(0.85, 1.2) * w[3]
    found = fitted(w, np.full(9, turn), -0.4, 0.05 * rng.standard_normal(9)).transition
    assert found is not None
    assert found.mixed_exponent.low == pytest.approx(-1.77, abs=0.01)  # -1.64 is where it first rises by t^2


@pytest.fixture(scope="module")
def freed_points() -> hersey.SteadyPoints:
    """The transition moves as T^1.2, where one Hersey number has T^3."""
    w, t = (each.ravel() for each in np.meshgrid(np.geomspace(0.4, 16.0, 9), CELSIUS))
    turn, level = 2.0 * (t / 130.0) ** 1.2, (t / 130.0) ** (-1.2 + 0.4 * 1.2)
    z = np.log(w / turn)
    noise = 0.004 * np.random.default_rng(25).standard_normal(w.size)
    torque = level * np.exp(np.where(z < 0.0, -0.5, 0.4) * z + noise)
    return points_of(w, torque, t, error=0.002)


@pytest.fixture(scope="module")
def freed(freed_points: hersey.SteadyPoints) -> DampingSurface:
    return hersey.fit(freed_points)


def test_a_transition_is_freed_where_one_hersey_number_is_excluded(freed: DampingSurface) -> None:
    found = freed.transition
    assert found is not None
    assert found.freed is not None
    assert found.freed > 6.0
    assert freed.b is not None
    assert freed.b.value == pytest.approx(-1.2, abs=0.03)
    assert found.temperature_exponent == freed.values[-1] == pytest.approx(1.2, abs=0.1)
    assert freed.variables[-1] == "exponent of w_t in T"
    assert "fitted separately: a fixed Hersey number is worse by" in freed.summary()
    assert np.all(np.abs(freed.residuals) < 0.02)


def test_a_freed_transition_is_as_uncertain_at_each_temperature_as_its_draws(freed: DampingSurface) -> None:
    for celsius in CELSIUS:
        kelvin = float(celsius) + 273.15
        e = freed.transition_estimate(kelvin)
        truth = 2.0 * (celsius / 130.0) ** 1.2
        assert e.value == pytest.approx(truth, rel=0.02)
        drag = freed.drag(roll_radius=RADIUS, stick_speed=STICK, temperature=kelvin)
        level = (celsius / 130.0) ** (-1.2 + 0.4 * 1.2)
        assert drag.transition_force * RADIUS == pytest.approx(level, rel=0.01)
        drawn = freed.drag_samples(4000, 1, roll_radius=RADIUS, stick_speed=STICK, temperature=kelvin)
        speed = np.log(drawn["transition_speed"] / RADIUS)
        assert np.std(speed) == pytest.approx(e.error / e.value, rel=0.1)
    warm = freed.drag(roll_radius=RADIUS, stick_speed=STICK)
    assert warm.at(kelvin).transition_speed == pytest.approx(drag.transition_speed, rel=1e-9)
    assert warm.at(kelvin).transition_force == pytest.approx(drag.transition_force, rel=1e-9)


def test_dwells_of_a_freed_transition_lie_on_one_curve(freed_points: hersey.SteadyPoints) -> None:
    """At the same distance from the transition torque is the same, what it varies by with temperature off."""
    data = Observations.of(freed_points)
    law = Candidate(CELSIUS_SCALE, ONE).law(data)
    branches = fit_branches(data, fit_law(law, data))
    assert branches is not None
    fit = branches.fit
    z, y = scaled_speed(data, fit), scaled_torque(data, fit)
    at, c, mixed = branches.least, *(fit.values[fit.law.index(name)] for name in ("c", "c_mixed"))
    curve = np.where(z < at, 1.0 + mixed, 1.0 + c) * (z - at)
    assert np.std(y - curve) < 0.01
    by = [
        (move_of(replace(fit, values=fit.values + step)) - move_of(fit)) / 1e-6 for step in 1e-6 * np.eye(6)
    ]
    assert _by_power(fit) == pytest.approx(np.array(by), abs=1e-6)


def test_a_saved_fit_keeps_its_freed_transition(
    freed: DampingSurface, log: hersey.TorqueLog, points: hersey.SteadyPoints, tmp_path: Path
) -> None:
    """In the document of another fit, without its dwells."""
    part = PRINTED["fit"].model_validate(fit_document(log, points, hersey.fit(points)))
    document = {"hersey_version": freed.version} | part.model_dump(mode="json") | {"points": []}
    document["fit"] |= freed.to_dict()
    path = tmp_path / "fit.json"
    path.write_text(json.dumps(document))
    again = read_fit(path)
    given = {"roll_radius": RADIUS, "stick_speed": STICK, "temperature": 440.0}
    assert again.drag(**given) == freed.drag(**given)
    assert again.transition_estimate(440.0) == freed.transition_estimate(440.0)
