"""The fitted surface: exact on exact data, agreeing with lmfit, honest about what it cannot know."""

from __future__ import annotations

import dataclasses

import lmfit
import numpy as np
import polars as pl
import pytest

import hersey
from hersey.damping.dwells import SteadyPoints
from hersey.errors import ExtrapolationWarning, InsufficientDataError, ParameterError
from hersey.log.torque_log import LogFile, Run, TorqueLog


def points_of(
    speed: np.ndarray,
    torque: np.ndarray,
    celsius: np.ndarray | None = None,
    error: np.ndarray | float = 0.0,
    *,
    speed_error: np.ndarray | float = 0.0,
    temperature_error: np.ndarray | float = 0.0,
    tare_error: float = 0.0,
) -> SteadyPoints:
    """Steady points as `TorqueLog.steady` would leave them.

    ``error`` of torque and ``speed_error`` are relative; ``temperature_error`` in K, ``tare_error`` in N m.
    """
    whole = np.ones(speed.size)
    kelvin = None if celsius is None else celsius + 273.15
    empty = np.zeros(2)
    run = Run("run", empty, empty, empty, None if celsius is None else empty)
    log = TorqueLog((run,), (LogFile("run", "0", 0, 2, 0, (), ()),))
    table = pl.DataFrame(
        {
            "run": np.zeros(speed.size, dtype=np.int64),
            "speed": speed,
            "speed_error": speed_error * np.abs(speed),
            "torque": torque,
            "torque_error": error * np.abs(torque),
            "temperature": kelvin,
            "temperature_error": None if celsius is None else temperature_error * whole,
        }
    )
    return SteadyPoints(table, (), 0.0, None, log, np.full((table.height, 1), tare_error))


def grid(speeds: np.ndarray, temperatures: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    w, t = np.meshgrid(speeds, temperatures)
    return w.ravel(), t.ravel()


SPEEDS, TEMPERATURES = np.geomspace(0.5, 15, 8), np.array([90.0, 120.0, 150.0, 180.0])


def test_an_exact_law_is_found_exactly() -> None:
    w, t = grid(SPEEDS, TEMPERATURES)
    surface = hersey.fit(points_of(w, 62.0 * t**-0.9 * w**0.3, t))
    assert surface.a.value == pytest.approx(62.0, rel=1e-9)
    assert surface.b is not None
    assert surface.b.value == pytest.approx(-0.9, abs=1e-10)
    assert surface.c.value == pytest.approx(-0.7, abs=1e-10)
    assert surface.transition is None
    assert surface.statistics.r_squared_torque == pytest.approx(1.0)
    for name, value in (("a", 62.0), ("b", -0.9), ("c", -0.7)):
        assert surface.torque_space[name].value == pytest.approx(value, rel=1e-6)


def test_a_and_b_depend_on_the_scale_of_temperature() -> None:
    w, t = grid(SPEEDS, TEMPERATURES)
    kelvin = t + 273.15
    surface = hersey.fit(points_of(w, 3e7 * kelvin**-3.0 * w**0.3, t), temperature_scale="K")
    assert surface.b is not None
    assert surface.b.value == pytest.approx(-3.0, abs=1e-9)
    assert "T in K" in surface.summary()


def test_branches_that_meet_are_found() -> None:
    w, t = grid(np.geomspace(0.5, 15, 12), TEMPERATURES)
    at = 1.5 * (t / 150) ** 3.0
    torque = np.where(w > at, (w / at) ** 0.3, (w / at) ** -0.2)
    surface = hersey.fit(points_of(w, torque, t, error=1e-4))
    assert surface.transition is not None
    assert surface.transition_speed(150 + 273.15) == pytest.approx(1.5, rel=0.01)
    assert surface.transition.mixed_exponent.value == pytest.approx(-1.2, abs=0.01)
    assert surface.c.value == pytest.approx(-0.7, abs=0.005)
    measured = surface.torque(speed=w, temperature=t + 273.15)
    np.testing.assert_allclose(measured, torque, rtol=0.02)


def test_a_flat_torque_is_no_transition() -> None:
    random = np.random.default_rng(5)
    w = np.geomspace(1, 20, 15)
    surface = hersey.fit(points_of(w, 1.0 + 0.01 * random.standard_normal(15), error=0.01))
    assert surface.transition is None
    assert surface.rejected_transition
    assert np.isnan(surface.transition_speed())


def test_weighted_fit_agrees_with_lmfit() -> None:
    random = np.random.default_rng(6)
    w, t = grid(SPEEDS, TEMPERATURES)
    torque = 62.0 * t**-0.9 * w**0.3 * np.exp(0.02 * random.standard_normal(w.size))
    surface = hersey.fit(points_of(w, torque, t, error=0.03))  # errors so large that no scatter is added
    assert surface.statistics.scatter == 0.0

    def residual(p: lmfit.Parameters) -> np.ndarray:
        law = p["log_a"] + p["b"] * np.log(t) + p["c"] * np.log(w)
        return np.asarray((np.log(torque / w) - law) / 0.03)

    start = lmfit.create_params(log_a=1.0, b=-1.0, c=-1.0)
    other = lmfit.minimize(residual, start, scale_covar=False)
    assert surface.b is not None
    assert surface.b.value == pytest.approx(other.params["b"].value, rel=1e-6)
    assert surface.b.error == pytest.approx(other.params["b"].stderr, rel=1e-4)
    assert surface.c.value == pytest.approx(other.params["c"].value, rel=1e-6)
    assert surface.c.error == pytest.approx(other.params["c"].stderr, rel=1e-4)
    assert surface.statistics.chi_square == pytest.approx(other.chisqr, rel=1e-6)


def test_scatter_between_dwells_is_found() -> None:
    random = np.random.default_rng(7)
    w, t = grid(np.geomspace(0.5, 15, 30), TEMPERATURES)
    torque = 62.0 * t**-0.9 * w**0.3 * np.exp(0.02 * random.standard_normal(w.size))
    surface = hersey.fit(points_of(w, torque, t, error=0.001))
    assert surface.statistics.scatter == pytest.approx(0.02, rel=0.2)
    assert surface.statistics.reduced_chi_square == pytest.approx(400, rel=0.4)  # (0.02/0.001)^2


def test_units_of_speed_change_a_only() -> None:
    w, t = grid(SPEEDS, TEMPERATURES)
    torque = 62.0 * t**-0.9 * w**0.3
    one, two = hersey.fit(points_of(w, torque, t)), hersey.fit(points_of(10 * w, torque, t))
    assert one.c.value == pytest.approx(two.c.value)
    assert one.statistics.r_squared_torque == pytest.approx(two.statistics.r_squared_torque)


def test_extrapolation_warns_and_names_the_axis(points: hersey.SteadyPoints) -> None:
    surface = hersey.fit(points)
    with pytest.warns(ExtrapolationWarning, match="speed is outside"):
        surface.damping(speed=1000.0, temperature=400.0)
    with pytest.warns(ExtrapolationWarning, match="temperature is outside"):
        surface.damping(speed=5.0, temperature=600.0)
    with pytest.raises(ParameterError, match="temperature"):
        surface.damping(speed=5.0)


@pytest.mark.parametrize("name", ["damping", "torque", "total_torque", "predict"])
def test_speed_and_temperature_are_named(points: hersey.SteadyPoints, name: str) -> None:
    """Two plain numbers can be swapped unseen: 420 rad/s at 5 K gave nan."""
    method = getattr(hersey.fit(points), name)
    with pytest.raises(TypeError, match="by name"):
        method(5.0, 420.0)
    with pytest.raises(TypeError, match="by name"):
        method(5.0, temperature=420.0)


def test_a_fitted_law_carries_where_it_came_from(points: hersey.SteadyPoints) -> None:
    surface = hersey.fit(points)
    assert surface.data_sha256 == (points.log.files[0].sha256,)
    assert surface.version == hersey.__version__
    assert surface.covariance.shape == (len(surface.variables),) * 2
    with pytest.raises(dataclasses.FrozenInstanceError):
        surface.version = "2"  # type: ignore[misc]


def test_a_fitted_law_becomes_drag(points: hersey.SteadyPoints) -> None:
    surface = hersey.fit(points)
    drag = surface.drag(roll_radius=0.015, stick_speed=3e-4, temperature=420.0)
    speed = 5.0
    expected = float(surface.torque(speed=speed, temperature=420.0)) / 0.015
    assert float(drag.force(speed * 0.015)) == pytest.approx(expected, rel=1e-9)
    w, t = grid(SPEEDS, TEMPERATURES)
    single = hersey.fit(points_of(w, 62.0 * t**-0.9 * w**0.3, t))
    with pytest.raises(InsufficientDataError, match="no falling branch"):
        single.drag(roll_radius=0.015, stick_speed=3e-4, temperature=420.0)


def test_what_cannot_be_known_is_refused() -> None:
    w, t = grid(SPEEDS, np.array([150.0]))
    with pytest.raises(InsufficientDataError, match="one temperature"):
        hersey.fit(points_of(w, w**0.3, t))
    w, t = grid(np.array([1.0, 2.0]), TEMPERATURES)
    with pytest.raises(InsufficientDataError, match="three or more speeds"):
        hersey.fit(points_of(w, w**0.3, t))
    w, t = grid(SPEEDS, np.array([-20.0, 20.0]))
    with pytest.raises(InsufficientDataError, match="temperature_scale='K'"):
        hersey.fit(points_of(w, w**0.3, t))
    with pytest.raises(ParameterError, match="temperature scale"):
        hersey.fit(points_of(w, w**0.3, t + 100), temperature_scale="degF")


def test_the_summary_reads_like_lmfit(points: hersey.SteadyPoints) -> None:
    text = hersey.fit(points).summary()
    for part in ("[[Model]]", "[[Fit Statistics]]", "[[Variables]]", "[[Correlations]]", "R-squared, torque"):
        assert part in text
