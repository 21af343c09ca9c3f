"""What a fitted law gives on: damping, torque, the transition, drag and draws of drag, each by hand."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import hersey
from hersey.damping.surface import DampingSurface
from hersey.errors import ExtrapolationWarning, InsufficientDataError, ParameterError
from tests.damping.test_surface import SPEEDS, TEMPERATURES, grid, points_of

#: The law of the points: torque 0.8 N m at 1.5 rad/s and 150 degC, where the branches meet.
TORQUE, SPEED, CELSIUS = 0.8, 1.5, 150.0
RADIUS, STICK = 0.015, 3e-4


def law(w: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Torque with exponents 0.3 and -0.2 and a transition that moves as T^3."""
    at = SPEED * (t / CELSIUS) ** 3.0
    return np.asarray(TORQUE * np.where(w > at, (w / at) ** 0.3, (w / at) ** -0.2))


def exact(scale: str = "degC") -> DampingSurface:
    w, t = grid(np.geomspace(0.1, 15, 14), TEMPERATURES)
    kelvin = t + 273.15
    torque = law(w, t if scale == "degC" else 150.0 * kelvin / 423.15)
    return hersey.fit(points_of(w, torque, t, error=1e-4), temperature_scale=scale)


def few(count: int = 12, noise: float = 0.01) -> DampingSurface:
    """A corner at one temperature, by few dwells."""
    w = np.geomspace(0.4, 15, count)
    disturbed = np.exp(noise * np.where(np.arange(count) % 2, 1.0, -1.0))
    torque = np.where(w > 2, (w / 2) ** 0.3, (w / 2) ** -0.2) * disturbed
    return hersey.fit(points_of(w, torque, error=1.2 * noise))


@pytest.fixture(scope="module")
def surface() -> DampingSurface:
    return exact()


def test_damping_and_torque_on_either_side_of_the_transition(surface: DampingSurface) -> None:
    w, t = np.array([[0.3], [3.0]]), np.array([100.0, 150.0])
    expected = law(w, t)
    assert surface.torque(speed=w, temperature=t + 273.15) == pytest.approx(expected, rel=1e-3)
    assert surface.damping(speed=w, temperature=t + 273.15) == pytest.approx(expected / w, rel=1e-3)
    assert surface.torque(speed=-w, temperature=t + 273.15) == pytest.approx(-expected, rel=1e-3)
    assert surface.damping(speed=-w, temperature=t + 273.15) == pytest.approx(expected / w, rel=1e-3)


def test_the_range_measured_is_left_with_a_warning(surface: DampingSurface) -> None:
    cold, hot = 363.15, 453.15
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for speed, kelvin in ((0.1, cold), (15.0, hot), (0.09995, 362.9), (15.01, 453.5), (-15.0, hot)):
            surface.torque(speed=speed, temperature=kelvin)
    low, high = r"0\.1 to 15 rad/s, so", r"363\.1 to 453\.1 K, so"
    for speed in (0.0997, 15.03, -15.03):
        with pytest.warns(
            ExtrapolationWarning, match=f"speed is outside the measured range, {low}"
        ) as caught:
            surface.damping(speed=speed, temperature=400.0)
        assert len(caught) == 1
    for kelvin in (cold - 0.5, hot + 0.6):
        with pytest.warns(
            ExtrapolationWarning, match=f"temperature is outside the measured range, {high}"
        ) as caught:
            surface.damping(speed=3.0, temperature=kelvin)
        assert len(caught) == 1
    with pytest.warns(ExtrapolationWarning, match="speed"):
        surface.damping(speed=np.array([1.0, 100.0]), temperature=400.0)


@pytest.mark.parametrize("scale", ["degC", "K"])
def test_the_transition_moves_with_temperature(scale: str) -> None:
    surface = exact(scale)
    for celsius in (100.0, 150.0, 180.0):
        share = celsius / 150.0 if scale == "degC" else (celsius + 273.15) / 423.15
        assert surface.transition_speed(celsius + 273.15) == pytest.approx(SPEED * share**3.0, rel=2e-3)
    assert surface.transition is not None
    assert surface.transition_speed() == surface.transition.speed.value


def test_no_power_of_a_temperature_below_zero(surface: DampingSurface) -> None:
    with pytest.raises(ParameterError, match="273 K, but a law in degC holds only above 0 degC"):
        surface.transition_speed(273.0)
    with pytest.raises(ParameterError, match="temperature is NaN"):
        surface.drag(roll_radius=RADIUS, stick_speed=STICK, temperature=float("nan"))
    for ask in (surface.damping, surface.torque, surface.predict):
        with pytest.raises(ParameterError, match=r"temperature is 180 .* 180 K .* Write '180 degC'"):
            ask(speed=1.0, temperature=[400.0, 180.0])


def test_drag_at_one_temperature(surface: DampingSurface) -> None:
    drag = surface.drag(roll_radius=RADIUS, stick_speed=STICK, temperature=100.0 + 273.15)
    assert drag.transition_speed == pytest.approx(SPEED * (100 / 150) ** 3 * RADIUS, rel=2e-3)
    assert drag.transition_force == pytest.approx(TORQUE / RADIUS, rel=2e-3)
    assert drag.ehl_exponent == surface.c.value
    assert surface.transition is not None
    assert drag.mixed_exponent == surface.transition.mixed_exponent.value
    ratio = surface.transition_speed(373.15) / surface.transition_speed()
    assert drag.stick_speed == pytest.approx(STICK * ratio, rel=1e-12)
    assert not drag.varies_with_temperature


def test_drag_of_a_transition_below_the_slowest_dwell_warns_of_temperature_alone(
    surface: DampingSurface,
) -> None:
    with pytest.warns(ExtrapolationWarning, match="temperature is outside") as warned:
        drag = surface.drag(roll_radius=RADIUS, stick_speed=STICK, temperature=60.0 + 273.15)
    assert len(warned) == 1
    assert drag.transition_speed / RADIUS < 0.1


@pytest.mark.parametrize("scale", ["degC", "K"])
def test_drag_that_varies_with_temperature_is_the_drag_at_each(scale: str) -> None:
    surface = exact(scale)
    warm = surface.drag(roll_radius=RADIUS, stick_speed=STICK)
    assert warm.varies_with_temperature
    assert surface.reference_temperature is not None
    zero = 273.15 if scale == "degC" else 0.0
    assert warm.reference_temperature == surface.reference_temperature
    for kelvin in (380.0, 440.0):
        found = warm.at(kelvin)
        by_itself = surface.drag(roll_radius=RADIUS, stick_speed=STICK, temperature=kelvin)
        assert found.transition_force == pytest.approx(by_itself.transition_force, rel=1e-9)
        assert found.transition_speed == pytest.approx(by_itself.transition_speed, rel=1e-9)
        share = (kelvin - zero) / (surface.reference_temperature - zero)
        assert surface.transition is not None
        stick = STICK * share**surface.transition.temperature_exponent
        assert found.stick_speed == pytest.approx(stick, rel=1e-9)
        assert by_itself.stick_speed == pytest.approx(stick, rel=1e-9)


def test_drag_of_an_isothermal_law() -> None:
    surface = few()
    drag = surface.drag(roll_radius=RADIUS, stick_speed=STICK)
    assert surface.transition is not None
    at = surface.transition.speed.value
    assert drag.transition_speed == pytest.approx(at * RADIUS)
    assert drag.transition_force == pytest.approx(float(surface.torque(speed=at)) / RADIUS)
    assert not drag.varies_with_temperature


def draws(surface: DampingSurface, count: int = 4000, seed: int = 1, celsius: float | None = None) -> dict:
    kelvin = None if celsius is None else celsius + 273.15
    return surface.drag_samples(count, seed, roll_radius=RADIUS, stick_speed=STICK, temperature=kelvin)


def ends(sample: np.ndarray) -> tuple[float, float]:
    low, high = np.quantile(sample, [0.025, 0.975])
    return float(low), float(high)


def test_draws_spread_as_the_intervals_of_few_dwells() -> None:
    """Student's t: with 12 dwells for 4 numbers the normal distribution is narrower by 15 %."""
    surface = few()
    found = draws(surface, 20_000)
    assert surface.transition is not None
    for sample, e in (
        (found["ehl_exponent"], surface.c),
        (found["mixed_exponent"], surface.transition.mixed_exponent),
    ):
        low, high = ends(sample)
        assert high - low == pytest.approx(e.high - e.low, rel=0.05)
        assert low - e.value == pytest.approx(e.low - e.value, rel=0.1)
    low, high = ends(found["transition_speed"] / RADIUS)
    speed = surface.transition.speed
    assert np.log(high / low) == pytest.approx(np.log(speed.high / speed.low), rel=0.05)


def test_draws_go_together_as_the_covariance_says() -> None:
    surface = few()
    found = draws(surface, 20_000)
    level, c, mixed, at = np.eye(4)
    log_speed, log_force = np.log(found["transition_speed"]), np.log(found["transition_force"])
    value = surface.values
    force = level + (1 + value[1]) * at + value[3] * c  # ln torque at the transition, to first order
    picks = {"c": c, "mixed": mixed, "at": at, "force": force}
    rows = np.column_stack([found["ehl_exponent"], found["mixed_exponent"], log_speed, log_force])
    pick = np.array(list(picks.values()))
    assert surface.transition is not None
    speed, exponent = surface.transition.speed, surface.transition.mixed_exponent
    wider = np.array([1.0, 1.0, exponent.error, speed.error / speed.value])  # than the slope has it
    wider[2:] /= np.sqrt(np.diag(surface.covariance)[2:])
    covariance = surface.covariance * np.outer(wider, wider)
    expected = pick @ covariance @ pick.T
    scale = np.sqrt(np.diag(expected))
    assert np.corrcoef(rows.T) == pytest.approx(expected / np.outer(scale, scale), abs=0.06)
    centre = value[0] + (1 + value[1]) * value[3] + np.log(surface.reference_speed / RADIUS)
    assert np.median(log_force) == pytest.approx(centre, abs=0.1 * scale[3])
    assert np.median(log_speed) == pytest.approx(
        np.log(surface.transition_speed() * RADIUS), abs=0.1 * scale[2]
    )


@pytest.mark.parametrize("celsius", [100.0, 150.0, 180.0])
def test_draws_are_centred_on_the_drag_of_their_temperature(surface: DampingSurface, celsius: float) -> None:
    drag = surface.drag(roll_radius=RADIUS, stick_speed=STICK, temperature=celsius + 273.15)
    for name, sample in draws(surface, 500, celsius=celsius).items():
        assert sample.shape == (500,)
        assert np.median(sample) == pytest.approx(getattr(drag, name), rel=2e-3)


def test_a_seed_names_its_draws() -> None:
    surface = few()
    one, same, other = draws(surface, 50, 7), draws(surface, 50, 7), draws(surface, 50, 8)
    for name in one:
        assert np.array_equal(one[name], same[name])
        assert not np.any(one[name] == other[name])


def test_draws_without_two_branches_are_drawn_again_and_counted() -> None:
    surface = few()
    uncertain = replace(surface, covariance=100.0 * surface.covariance)
    with pytest.warns(UserWarning, match="had no falling branch and were replaced") as caught:
        found = draws(uncertain, 4000)
    refused, _, drawn = str(caught[0].message).split()[:3]
    assert drawn == "8000"
    assert surface.transition is not None
    mixed = surface.transition.mixed_exponent
    by_slope = float(np.sqrt(surface.covariance[2, 2]))  # ten times that is more than a moved corner adds
    share = stats.t.sf((-1.0 - mixed.value) / (10.0 * by_slope), 8)
    share += stats.t.cdf((-1.0 - surface.c.value) / (10.0 * surface.c.error), 8)
    assert int(refused) / 8000 == pytest.approx(float(share), rel=0.15)
    assert np.all(found["ehl_exponent"] > -1.0)
    assert np.all(found["mixed_exponent"] < -1.0)
    assert all(sample.shape == (4000,) for sample in found.values())


def test_draws_stick_below_their_transition() -> None:
    surface = few()
    at = surface.transition_speed() * RADIUS
    error = surface.covariance[-1, -1] ** 0.5
    with pytest.warns(UserWarning, match="were replaced"):
        found = surface.drag_samples(1000, 1, roll_radius=RADIUS, stick_speed=at * np.exp(-error))
    assert np.all(found["transition_speed"] > at * np.exp(-error))
    assert found["transition_speed"].min() < at
    hopeless = replace(surface, covariance=1e4 * surface.covariance)
    with pytest.raises(
        InsufficientDataError, match="of 1000 draws of the fit have no falling branch, so the data"
    ):
        draws(hopeless, 1000)


def test_draws_that_cannot_be_asked_for_are_refused(surface: DampingSurface) -> None:
    with pytest.raises(ParameterError, match="count is 0: it must be at least 1"):
        draws(surface, 0, celsius=150.0)
    with pytest.raises(ParameterError, match="seed is -1: it must be at least 0"):
        draws(surface, 1, -1, celsius=150.0)
    assert draws(surface, 1, 0, celsius=150.0)["ehl_exponent"].shape == (1,)
    with pytest.raises(ParameterError, match=r"this law depends on temperature. Give the temperature in K"):
        draws(surface)
    with pytest.raises(ParameterError, match="this law does not depend on temperature"):
        draws(few(), celsius=150.0)
    with pytest.raises(ParameterError):
        surface.drag_samples(1, 1, roll_radius=RADIUS, stick_speed=-1.0, temperature=423.0)
    straight = hersey.fit(points_of(SPEEDS, SPEEDS**0.3, error=0.01))
    with pytest.raises(InsufficientDataError, match="the data show no falling branch"):
        draws(straight)
