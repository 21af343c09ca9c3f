"""The step of a sensor, and what rounding to it leaves in a mean: against rounded noise."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.damping.dwells.resolution import repeats, rounding_error, step_of


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.2, 0.3])
def test_rounding_error_is_that_of_rounded_noise(noise: float) -> None:
    """Root mean square over every place between two steps; the noise is in steps."""
    step, random = 0.05, np.random.default_rng(3)
    places = np.linspace(0.0, 1.0, 200, endpoint=False)
    rounded = [np.round(place + noise * random.standard_normal(20_000)) for place in places]
    missed = np.array([values.mean() - place for values, place in zip(rounded, places, strict=True)])
    missed -= np.round(missed)
    predicted = [rounding_error(step * values, step) for values in rounded]
    actual = step * float(np.sqrt(np.mean(missed**2)))
    assert actual <= 1.15 * np.sqrt(np.mean(np.square(predicted)))
    if noise == 0.0:
        assert predicted[0] == pytest.approx(step / 12.0**0.5, rel=0.02)


def test_noise_of_a_step_leaves_no_rounding() -> None:
    values = 0.05 * np.round(3.3 + np.random.default_rng(3).standard_normal(1000))
    assert rounding_error(values, 0.05) < 1e-6
    assert rounding_error(values, 0.0) == 0.0


def test_set_points_are_no_steps() -> None:
    """A speed that is written as it was asked for, and a torque without noise."""
    speeds = [np.full(50, speed) for speed in (5.0, 10.0, 20.0, 40.0)]
    assert step_of(speeds) == 0.0
    torques = [np.full(50, torque) for torque in 2.0 * np.array([5.0, 7.0, 10.0, 20.0, 40.0, 80.0]) ** 0.4]
    assert step_of(torques) == 0.0
    noisy = [torque * (1.0 + 0.01 * np.random.default_rng(1).standard_normal(50)) for torque in torques]
    assert step_of(noisy) == 0.0


def test_the_step_of_readings_that_flip_or_repeat() -> None:
    random = np.random.default_rng(1)
    flipping = [0.02 * np.round(level + 0.4 * random.standard_normal(50)) for level in (3.5, 8.5, 20.5, 40.5)]
    assert step_of(flipping) == pytest.approx(0.02)
    same = [np.full(50, 0.02 * level) for level in (3, 4, 6, 9, 14) * 4]
    assert step_of(same) == pytest.approx(0.02)


def test_dwells_at_one_speed_and_temperature_repeat_their_rounding() -> None:
    speed = np.array([1.0, 1.01, 2.0, -1.0, 1.0])
    assert repeats(speed, None).tolist() == [3, 3, 1, 1, 3]
    kelvin = np.array([300.0, 300.2, 300.0, 300.0, 330.0])
    assert repeats(speed, kelvin).tolist() == [2, 2, 1, 1, 1]
