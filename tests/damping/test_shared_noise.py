"""Noise as slow as a dwell: intervals hold the truth whatever its correlation time.

The noise is made here, by a recursion of its own.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from hersey.damping.dwells import shared_noise as shared
from hersey.damping.dwells.noise import mean_and_error
from hersey.damping.dwells.shared_noise import Powers, cosine_power, shared_noise
from tests.damping.test_dwells import RPM, log_of


def slow_noise(random: np.random.Generator, seconds: float, rate: float, tau: float) -> np.ndarray:
    """Noise of unit deviation that forgets over ``tau`` s, sampled ``rate`` times a second."""
    white = random.standard_normal(round(seconds * rate))
    if tau == 0.0:
        return white
    memory = np.exp(-1.0 / (rate * tau))
    white[1:] *= (1.0 - memory**2) ** 0.5
    return np.asarray(lfilter([1.0], [1.0, -memory], white))


def staircase(
    seed: int, tau: float, steps: int = 30, rate: float = 100.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Speed, torque without noise and noise of 3 % of a staircase, dwells of 6 to 10 s."""
    random = np.random.default_rng(seed)
    held = np.geomspace(10.0, 200.0, steps)
    counts = [round(rate * random.uniform(6.0, 10.0)) for _ in held]
    speed = np.repeat(held * RPM, counts)
    torque = (speed / RPM / 30.0) ** 0.2
    return speed, torque, 0.03 * torque * slow_noise(random, speed.size / rate, rate, tau)


@pytest.mark.parametrize("tau", [0.0, 0.05, 0.2, 0.5, 1.0])
def test_intervals_of_dwells_hold_the_truth(tau: float) -> None:
    inside, kept = [], 0
    for seed in range(10):
        speed, torque, noise = staircase(seed, tau)
        points = log_of(speed, torque + noise, dt=0.01).steady()
        truth = (points.column("speed") / RPM / 30.0) ** 0.2
        inside += list(np.abs(points.column("torque") - truth) < 1.96 * points.column("torque_error"))
        kept += len(points)
    assert kept == 10 * 30
    assert 0.92 <= np.mean(inside) <= 0.98


def test_each_dwell_alone_would_not_see_slow_noise() -> None:
    random = np.random.default_rng(1)
    dwells = [slow_noise(random, 8.0, 100.0, 1.0) for _ in range(40)]
    true = (2.0 / 8.0 * (1.0 - (1.0 - np.exp(-8.0)) / 8.0)) ** 0.5
    together = shared_noise([Powers.of(d, 0.01) for d in dwells])
    assert together is not None
    errors = [together.mean_error(Powers.of(d, 0.01)) for d in dwells]
    assert np.median(errors) == pytest.approx(true, rel=0.25)
    assert np.median([mean_and_error(d)[1] for d in dwells]) < 0.75 * true


def test_the_error_of_a_drift_knows_slow_noise() -> None:
    random = np.random.default_rng(2)
    dwells = [slow_noise(random, 8.0, 100.0, 0.5) for _ in range(80)]
    together = shared_noise([Powers.of(d, 0.01) for d in dwells])
    assert together is not None
    time = np.arange(800) * 0.01
    rises = [8.0 * np.polyfit(time, d, 1)[0] for d in dwells]
    stated = np.median([together.rise_error(Powers.of(d, 0.01)) for d in dwells])
    assert stated == pytest.approx(np.std(rises), rel=0.3)


def test_a_dwell_of_its_own_noise_has_its_own_error() -> None:
    random = np.random.default_rng(3)
    level = np.where(np.arange(40) % 2, 5.0, 1.0)
    dwells = [a * slow_noise(random, 8.0, 100.0, 0.2) for a in level]
    together = shared_noise([Powers.of(d, 0.01) for d in dwells])
    assert together is not None
    errors = np.array([together.mean_error(Powers.of(d, 0.01)) for d in dwells])
    assert np.mean(errors[1::2]) / np.mean(errors[::2]) == pytest.approx(5.0, rel=0.15)


def waves_in_some(size: float, seed: int = 4) -> list[np.ndarray]:
    """White noise in 40 dwells, and slow waves of random phase in every second."""
    random = np.random.default_rng(seed)
    time = np.arange(800) / 400
    return [
        random.standard_normal(800)
        + size * (i % 2) * np.cos(np.pi * time * random.uniform(0.5, 2.0) + random.uniform(0.0, 6.0))
        for i in range(40)
    ]


def test_dwells_that_differ_in_more_than_level_share_no_noise() -> None:
    """As where what fluctuates belongs to the angle of a shaft and not to time."""
    assert shared_noise([Powers.of(d, 0.01) for d in waves_in_some(0.0)]) is not None
    assert shared_noise([Powers.of(d, 0.01) for d in waves_in_some(2.0)]) is None


def test_where_slow_parts_differ_a_little_each_counts_its_own() -> None:
    dwells = waves_in_some(0.3)
    together = shared_noise([Powers.of(d, 0.01) for d in dwells])
    assert together is not None
    assert together.prior < 30.0
    errors = np.array([together.mean_error(Powers.of(d, 0.01)) for d in dwells])
    assert np.ptp(errors) > 0.5 * np.mean(errors)


def test_ripple_is_no_noise() -> None:
    random = np.random.default_rng(5)
    time = np.arange(800) * 0.01
    dwells = [
        0.1 * random.standard_normal(800)
        + np.sin(2 * np.pi * random.uniform(2.0, 8.0) * time + random.uniform(0.0, 6.0))
        for _ in range(30)
    ]
    together = shared_noise([Powers.of(d, 0.01) for d in dwells])
    assert together is not None
    errors = [together.mean_error(Powers.of(d, 0.01)) for d in dwells]
    spread = float(np.std([np.mean(d) for d in dwells]))
    assert spread < np.mean(errors) < 2.0 * spread  # of a ripple of amplitude 1
    assert np.mean(errors) < 0.01
    assert together.prior == np.inf


@pytest.mark.parametrize("order", [0, 1, 2, 7])
@pytest.mark.parametrize("share", [0.002, 0.05, 0.4, 2.0])
def test_power_of_a_cosine_in_noise_that_forgets(order: int, share: float) -> None:
    """Against the double sum over a dwell of 4000 blocks."""
    n = 4000
    at = (np.arange(n) + 0.5) / n
    wave = np.cos(np.pi * order * at) * (1.0 if order == 0 else 2.0**0.5)
    correlation = np.exp(-np.arange(n) / n / share)
    spectrum = np.fft.irfft(np.abs(np.fft.rfft(wave, 2 * n)) ** 2)[:n]
    power = (spectrum[0] + 2.0 * np.sum(correlation[1:] * spectrum[1:])) / n**2 / share
    stated = cosine_power(np.array([float(order)]), np.array([share]))[0]
    assert stated == pytest.approx(power, rel=0.02)


def test_few_dwells_and_dwells_without_noise_share_none() -> None:
    random = np.random.default_rng(6)
    noisy = [Powers.of(random.standard_normal(100), 0.1) for _ in range(shared.FEWEST)]
    still = [Powers.of(np.ones(100), 0.1)] * 10
    assert shared_noise(noisy) is not None
    assert shared_noise(noisy[1:] + still) is None


def test_a_long_dwell_has_the_power_of_a_short_one_per_time() -> None:
    """Averaging to fewer samples leaves the power of noise without memory as it is."""
    series = np.random.default_rng(7).standard_normal(50_000)
    whole = Powers.of(series, 0.001)
    assert whole.duration == pytest.approx(50.0)
    assert np.average(whole.power, weights=whole.count) == pytest.approx(0.001, rel=0.15)
