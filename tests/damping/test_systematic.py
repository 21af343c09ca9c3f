"""What errors of the sensors do to a fit, against straight lines fitted to what they would have read."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.candidates.branched import ONE, Law
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.shared_errors import disturbances
from hersey.damping.candidates.thermal import KELVIN, Thermal
from hersey.damping.systematic import sensor_shifts
from hersey.log.mapping import LogMapping
from hersey.log.role_tables import SpeedMapping, TemperatureMapping, TorqueMapping
from hersey.log.sensors import Sensors
from hersey.machine import read_machine
from tests.conftest import ROOT
from tests.damping.candidates.test_comparison import REFERENCE, dwells
from tests.damping.test_surface import SPEEDS, grid, points_of

THERMAL, VALUES = Law(Thermal(KELVIN, REFERENCE), ONE), [0.1, -2.4, -0.7]
TWO = np.array([370.0, 430.0])


def line(columns: list[np.ndarray], y: np.ndarray, sigma: np.ndarray | float = 1.0) -> np.ndarray:
    weigh = 1.0 / (np.ones_like(y) * sigma)
    rows = np.column_stack(columns) * weigh[:, None]
    return np.asarray(np.linalg.lstsq(rows, y * weigh, rcond=None)[0])


def shifts(sensors: Sensors) -> np.ndarray:
    """Changes of level, b and c of exact dwells at two temperatures."""
    data = dwells(THERMAL, VALUES, temperatures=TWO, scatter=0.0)
    return sensor_shifts(fit_law(THERMAL, data), data, sensors)


def test_a_gain_of_torque_moves_the_level_alone() -> None:
    gain, zero, *_ = shifts(Sensors(torque_gain=0.01, torque_zero=0.0))
    assert gain == pytest.approx([0.01, 0.0, 0.0], abs=1e-7)
    assert zero == pytest.approx(np.zeros(3), abs=1e-7)


def test_a_gain_of_speed_moves_the_level_by_the_power() -> None:
    """Of torque with speed: 1 + c."""
    by_speed = shifts(Sensors(speed_gain=0.005))[2]
    assert by_speed == pytest.approx([-0.3 * 0.005, 0.0, 0.0], abs=1e-7)


def test_a_zero_of_torque_bends_the_line() -> None:
    data = dwells(THERMAL, VALUES, temperatures=TWO, scatter=0.0)
    torque, z, kelvin = np.exp(data.log_torque), data.inputs.log_speed, data.inputs.kelvin
    assert kelvin is not None
    columns = [np.ones_like(z), np.log(kelvin / REFERENCE), z]
    fit = fit_law(THERMAL, data)
    expected = line(columns, 0.004 / torque, fit.sigma)
    assert shifts(Sensors(torque_zero=0.004))[1] == pytest.approx(expected, abs=1e-7)
    assert expected[2] < -1e-4  # the slow dwells, of little torque, rise
    # unless it is stated, a thousandth of the largest torque
    default = line(columns, 0.001 * torque.max() / torque, fit.sigma)
    assert shifts(Sensors())[1] == pytest.approx(default, abs=1e-7)


def test_a_temperature_that_is_off_stretches_the_law_of_temperature() -> None:
    """Between two temperatures b ln(T1/T2) is as measured, whatever the temperatures are called."""
    everywhere, faster = shifts(Sensors(temperature_zero=2.0))[3:]
    cold, hot = TWO
    b = -2.4 * np.log(hot / cold) / np.log((hot + 2.0) / (cold + 2.0))
    assert everywhere[1] == pytest.approx(b + 2.4, rel=1e-5)
    assert everywhere[1] == pytest.approx(-2.4 * 2.0 / 400.0, rel=0.02)  # as the derivative by T says
    assert everywhere[2] == pytest.approx(0.0, abs=1e-7)
    data = dwells(THERMAL, VALUES, temperatures=TWO, scatter=0.0)
    z, kelvin = data.inputs.log_speed, data.inputs.kelvin
    assert kelvin is not None
    warmer = kelvin + 2.0 * (z - z.min()) / (z.max() - z.min())
    fit = fit_law(THERMAL, data)
    tilted = line([np.ones_like(z), np.log(warmer / REFERENCE), z], data.log_torque, fit.sigma)
    assert faster == pytest.approx(tilted - np.array([0.1, -2.4, 0.3]), abs=1e-6)
    assert faster[2] == pytest.approx(2.4 * 2.0 / 400.0 / (z.max() - z.min()), rel=0.05)


def test_a_log_without_temperatures_has_no_error_of_them() -> None:
    data = dwells(Law(None, ONE), [0.1, -0.7], temperatures=None, scatter=0.0)
    fit = fit_law(Law(None, ONE), data)
    assert sensor_shifts(fit, data, Sensors()).shape == (3, 2)
    assert shifts(Sensors(temperature_zero=0.0)).shape == (3, 3)
    assert shifts(Sensors()).shape == (5, 3)


@pytest.mark.parametrize("torque_gain", [0.0, 0.03])
def test_the_systematic_part_of_each_coefficient(torque_gain: float) -> None:
    """The root of the sum of squares of what each error does; of a in proportion to a."""
    torque = 2.0 * SPEEDS**0.4
    points = points_of(SPEEDS, torque, error=0.01)
    sensors = Sensors(torque_gain=torque_gain, speed_gain=0.002, torque_zero=0.01)
    points = replace(points, log=replace(points.log, sensors=sensors))
    surface = hersey.fit(points)
    level, slope = line([np.ones(8), np.log(SPEEDS)], 0.01 / torque)
    assert surface.c.systematic == pytest.approx(abs(slope), rel=1e-4)
    parts = np.array([torque_gain, level, 0.4 * 0.002])
    assert surface.a.systematic == pytest.approx(surface.a.value * np.sqrt(np.sum(parts**2)), rel=1e-4)
    # beside the statistical interval, not in it
    plain = hersey.fit(replace(points, log=replace(points.log, sensors=Sensors(0.0, 0.0, 0.0, 0.0))))
    assert (surface.c.low, surface.c.high) == pytest.approx((plain.c.low, plain.c.high))
    assert plain.c.systematic == pytest.approx(0.0, abs=1e-9)


def test_the_transition_has_the_error_of_the_speed() -> None:
    w = np.geomspace(0.4, 15, 12)
    points = points_of(w, np.where(w > 2, (w / 2) ** 0.3, (w / 2) ** -0.2), error=0.01)
    sensors = Sensors(torque_gain=0.05, torque_zero=0.0, speed_gain=0.01)
    surface = hersey.fit(replace(points, log=replace(points.log, sensors=sensors)))
    assert surface.transition is not None
    speed = surface.transition.speed
    assert speed.systematic == pytest.approx(0.01 * speed.value, rel=1e-3)


def test_b_in_degrees_celsius_is_uncertain_by_the_zero_of_temperature() -> None:
    w, t = grid(SPEEDS, np.array([90.0, 180.0]))
    points = points_of(w, 62.0 * t**-0.9 * w**0.3, t, error=0.01)
    only = Sensors(temperature_zero=1.5, torque_gain=0.0, torque_zero=0.0, speed_gain=0.0)
    surface = hersey.fit(replace(points, log=replace(points.log, sensors=only)))
    y = np.log(62.0 * t**-0.9 * w**0.3)
    z = np.log(w)
    moved = []
    for by in (np.ones_like(z), (z - z.min()) / np.ptp(z)):
        moved.append(line([np.ones_like(z), np.log(t + 1.5 * by), z], y)[1] + 0.9)
    assert surface.b is not None
    assert surface.b.systematic == pytest.approx(np.hypot(*moved), rel=1e-4)


def test_what_is_stated_of_the_sensors_and_what_is_a_default() -> None:
    assert str(Sensors()) == (
        "temperature 2 K (default), torque 1 % and 0.1 % of the largest torque (default), "
        "speed 0.1 % (default)"
    )
    stated = Sensors(0.5, 0.02, 0.002, stated=("temperature", "torque"))
    assert str(stated) == "temperature 0.5 K, torque 2 % and 2 mN m, speed 0.1 % (default)"


def test_the_mapping_states_the_sensors() -> None:
    plain = LogMapping(torque=TorqueMapping("M", "N*m"), speed=SpeedMapping("n", "rpm"))
    assert plain.sensors == Sensors()
    said = LogMapping(
        torque=TorqueMapping("M", "N*m", zero_error=0.002),
        speed=SpeedMapping("n", "rpm", gain_error=0.01),
        temperature=TemperatureMapping("T", "degC", zero_error=0.5, film_heating=3.0),
    )
    assert said.sensors == Sensors(0.5, 0.01, 0.002, 0.01, 3.0, stated=("temperature", "torque", "speed"))
    assert str(said.sensors).startswith("temperature 0.5 K, film heated by up to 3 K,")


#: Speeds (rad/s), readings (K) and exponents of a drive whose film friction heats.
W, READ = np.tile(np.geomspace(1.0, 20.0, 8), 4), np.repeat([360.0, 390.0, 420.0, 450.0], 8)
B, C, BOUND = -6.0, -0.7, 6.0


def heated(share: float, sensors: Sensors) -> hersey.DampingSurface:
    """The fit of a film that runs hotter than its reading by a share of the bound at the greatest power."""
    cool = (READ / REFERENCE) ** B * W ** (1.0 + C)
    film = READ + share * BOUND * cool * W / np.max(cool * W)
    noise = 0.002 * np.random.default_rng(3).standard_normal(W.size)
    points = points_of(
        W, (film / REFERENCE) ** B * W ** (1.0 + C) * np.exp(noise), READ - 273.15, error=0.002
    )
    return hersey.fit(replace(points, log=replace(points.log, sensors=sensors)), temperature_scale="K")


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_bound_on_film_heating_is_enough_to_find_it(share: float) -> None:
    """Friction heats in proportion to power, a shape of its own: c keeps its value and a narrow interval."""
    unknown, bounded = heated(share, Sensors()), heated(share, Sensors(film_heating=BOUND))
    assert unknown.b is not None
    assert bounded.b is not None
    for estimate, truth in ((bounded.c, C), (bounded.b, B)):
        assert abs(estimate.value - truth) < 3.0 * estimate.error
    assert abs(unknown.c.value - C) > 3.0 * unknown.c.error or share < 0.2
    whole = np.hypot(unknown.c.systematic, unknown.c.high - unknown.c.value)
    assert np.hypot(bounded.c.systematic, bounded.c.high - bounded.c.value) < 0.5 * whole
    assert "film heated by up to 6 K" in bounded.summary()


def test_the_bound_on_film_heating_is_a_prior_of_its_size() -> None:
    """Dwells of one power say nothing of the heating: its bound stands in the error of the level."""
    film = Sensors(film_heating=BOUND)
    speed, kelvin = np.tile([1.0, 2.0, 4.0], 4), np.repeat([360.0, 390.0, 420.0, 450.0], 3)
    points = points_of(speed, 1.0 / speed, kelvin - 273.15, error=0.002)  # 1 W everywhere
    data = Observations.of(replace(points, log=replace(points.log, sensors=film)))
    assert data.heating == pytest.approx(np.full(speed.size, BOUND / 12.0**0.5))
    assert data.inputs.kelvin == pytest.approx(kelvin + BOUND / 2.0)
    slope = np.full(speed.size, -0.02)
    assert disturbances(data, (), (), slope)[:, -1] == pytest.approx(slope * data.heating)


def test_the_machine_states_what_the_mapping_does_not(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(
        (ROOT / "tests" / "stand" / "machine.toml").read_text()
        + '[sensors.torque]\ngain_error = "3 %"\n'
        + '[sensors.temperature]\nzero_error = "5 K"\nfilm_heating = "4 K"\n'
    )
    assert read_machine(ROOT / "tests" / "stand" / "machine.toml").sensors == Sensors()
    of_machine = read_machine(path).sensors
    assert of_machine == Sensors(5.0, 0.03, film_heating=4.0, stated=("temperature", "torque"))
    said = LogMapping(torque=TorqueMapping("M", "N*m", zero_error=0.002)).sensors
    either = Sensors(5.0, 0.01, 0.002, film_heating=4.0, stated=("torque", "temperature"))
    assert said.or_else(of_machine) == either
    assert Sensors().or_else(of_machine) == of_machine
    assert said.or_else(Sensors()) == said
