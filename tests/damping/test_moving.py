"""Logs that move all the time: numbers known beforehand, what the filter costs, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import polars as pl
import pytest
from scipy import optimize

import hersey
from hersey.damping.dwells.doubtful import doubtful_order
from hersey.damping.moving.correlated import autoregression
from hersey.damping.moving.curve import moving_curve
from hersey.damping.moving.result import MovingFit
from hersey.errors import InsufficientDataError, ParameterError
from hersey.log import corrections
from hersey.verdict.friction import leading_friction
from tests.damping.moving_logs import (
    COULOMB,
    INERTIA,
    OFFSET,
    RATE,
    VISCOUS,
    counted,
    made,
    read,
    sine,
    times,
    waves,
)

TRUTH = {"T_C": COULOMB, "k_v": VISCOUS, "J": INERTIA, "offset": OFFSET}


def kinds(fit: MovingFit) -> list[str]:
    return [each.kind for each in fit.warnings]


def off(fit: MovingFit, name: str, truth: float) -> float:
    """How many standard errors a number is off."""
    return abs(fit[name].value - truth) / fit[name].error


@pytest.fixture(scope="module")
def encoder() -> MovingFit:
    return sine().moving()


def test_coulomb_and_viscous_friction_by_an_encoder(encoder: MovingFit) -> None:
    """Its speed is that of the interval just past: half an interval late, which is found."""
    assert encoder.law == "Coulomb and viscous friction"
    for name, truth in TRUTH.items():
        assert off(encoder, name, truth) < 3.0, name
        assert encoder[name].value == pytest.approx(truth, rel=0.02), name
    assert off(encoder, "delay", 0.5 / RATE) < 3.0
    assert kinds(encoder) == ["offset or direction"]


def test_stribeck_friction() -> None:
    speed, rate = waves(times())
    slow = speed / 3.0
    rise = 0.2 * np.exp(-((slow / 0.6) ** 2))
    fit = made(counted(slow), rate / 3.0, np.sign(slow) * (COULOMB + rise) + VISCOUS * slow).moving()
    assert fit.law == "Stribeck, Coulomb and viscous friction"
    for name, truth in (TRUTH | {"T_S": COULOMB + 0.2, "w_S": 0.6}).items():
        assert off(fit, name, truth) < 3.0, name


def test_friction_of_each_direction() -> None:
    """Reverse 0.5 + 0.04 |w|, twice as steep as forward: no offset beside it."""
    speed, rate = waves(times())
    friction = np.where(speed > 0, COULOMB + VISCOUS * speed, -0.5 + 0.04 * speed)
    fit = made(speed, rate, friction - OFFSET).moving()
    assert fit.law == "Coulomb and viscous friction, each direction separately"
    assert "offset" not in fit
    for name, truth in {"T_C+": 0.3, "k_v+": 0.02, "T_C-": 0.5, "k_v-": 0.04}.items():
        assert off(fit, name, truth) < 3.0, name


def test_the_viscous_part_falls_with_temperature() -> None:
    fit = sine(hot=True).moving()
    assert off(fit, "s", 0.02) < 3.0
    assert fit.friction_at(8.0).value == pytest.approx(COULOMB + VISCOUS * 8.0, rel=0.01)


def test_an_inertia_that_was_subtracted_is_not_subtracted_again() -> None:
    done = corrections.inertia(sine(), moment_of_inertia=INERTIA)
    log = replace(done.log, corrections=done.corrections)
    fit = log.moving()
    assert "J" not in fit
    assert fit.inertia_given is None
    assert fit["T_C"].value == pytest.approx(COULOMB, rel=0.02)
    with pytest.raises(ParameterError, match="already subtracts the torque of the inertia"):
        log.moving(inertia=INERTIA)


def test_a_given_inertia(encoder: MovingFit) -> None:
    fit = hersey.fit_moving(sine(), inertia="100 kg*cm^2")
    assert "J" not in fit
    assert fit.inertia_given == pytest.approx(INERTIA)
    assert fit["T_C"].value == pytest.approx(encoder["T_C"].value, rel=5e-3)
    with pytest.raises(ParameterError, match=r"the moment of inertia is -1 kg m\^2: it must not be negative"):
        hersey.fit_moving(sine(), inertia=-1.0)


def test_the_low_pass_biases_no_linear_term() -> None:
    """A sine of 2 Hz, half of whose power a low-pass of 3 Hz takes: without noise all is exact to 1e-3."""
    time = times()
    omega = 4.0 * np.pi
    speed, rate = 6.0 * np.sin(omega * time), 6.0 * omega * np.cos(omega * time)
    slow = 8.0 * np.sin(0.7 * time)
    fit = made(speed + slow, rate + 5.6 * np.cos(0.7 * time), VISCOUS * (speed + slow), noise=1e-4).moving()
    assert fit["J"].value == pytest.approx(INERTIA, rel=1e-3)
    assert fit["k_v"].value == pytest.approx(VISCOUS, rel=3e-3)


def test_the_error_of_a_given_inertia_is_in_what_depends_on_it() -> None:
    """Each number errs by as much more as it moves with an inertia that is off by its standard error."""
    exact, off = (hersey.fit_moving(sine(), inertia=factor * INERTIA) for factor in (1.0, 1.02))
    unsure = hersey.fit_moving(sine(), inertia=f"{INERTIA} kg*m^2 ± {2 * 1.96} %")
    for one, moved, wider in zip(exact.parameters, off.parameters, unsure.parameters, strict=True):
        shift = moved.estimate.value - one.estimate.value
        expected = np.hypot(one.estimate.error, shift)
        assert wider.estimate.error == pytest.approx(expected, rel=0.05), one.name
    assert unsure["delay"].error > 2.0 * exact["delay"].error
    shared = [np.linalg.norm(each.points().window_errors, axis=1) for each in (exact, unsure)]
    assert (shared[1] > 0.99 * shared[0]).all()
    assert shared[1].max() > 3.0 * shared[0].max()


def test_noise_of_a_tachometer_does_not_lessen_the_inertia() -> None:
    """White noise of 0.3 rad/s: without a correction the inertia would be 0.5 % low."""
    speed, rate = waves(times())
    friction = COULOMB * np.sign(speed) + VISCOUS * speed
    found = []
    for seed in range(2):
        noise = np.random.default_rng([seed, 5]).normal(0.0, 0.3, speed.size)
        found.append(made(speed + noise, rate, friction, seed=seed).moving())
    pulls = [(each["J"].value - INERTIA) / each["J"].error for each in found]
    assert max(map(abs, pulls)) < 4.0


def test_correlated_noise_widens_the_intervals() -> None:
    """Noise with a memory of 0.5 s: a mean is known as of 100 times fewer rows."""
    speed, rate = waves(times())
    friction = COULOMB * np.sign(speed) + VISCOUS * speed
    kicks = np.random.default_rng(3).normal(0.0, 0.01, speed.size)
    slow = np.empty(speed.size)
    last = 0.0
    for i, kick in enumerate(kicks):
        last = slow[i] = 0.98 * last + kick * np.sqrt(1.0 - 0.98**2)
    white = made(speed, rate, friction).moving()
    coloured = made(speed, rate, friction + slow, noise=1e-6).moving()
    assert coloured["offset"].error > 3.0 * white["offset"].error
    assert off(coloured, "offset", OFFSET) < 3.0
    assert coloured.effective_rows < 0.5 * white.effective_rows


def test_an_autoregression_is_found() -> None:
    """x_t = 0.7 x_(t-1) + noise, a third of the rows missing: correlations 0.7^n."""
    rng = np.random.default_rng(1)
    series = np.empty(6000)
    last = 0.0
    for i, kick in enumerate(rng.normal(0.0, 1.0, series.size)):
        last = series[i] = 0.7 * last + kick
    places = np.flatnonzero(np.arange(series.size) % 30 < 20)
    noise = autoregression([(places, series[places, None])])
    assert noise.correlation(4) == pytest.approx(0.7 ** np.arange(5), abs=0.06)
    assert noise.variance == pytest.approx(1.0 / (1.0 - 0.49), rel=0.1)
    assert noise.together == pytest.approx(1.7 / 0.3, rel=0.35)


def test_windows_are_steady_points(encoder: MovingFit) -> None:
    points = encoder.points()
    speed = points.column("speed")
    truth = COULOMB * np.sign(speed) + VISCOUS * speed
    errors = np.sqrt(points.column("torque_error") ** 2 + np.sum(points.window_errors**2, axis=1))
    assert np.max(np.abs(points.column("torque") - truth) / errors) < 3.5
    assert points.window_errors.shape == (len(points), 3)
    used = int(points.table["rows"].sum()) + sum(each.rows for each in points.rejected)
    assert used == points.log.rows
    assert {each.why.kind for each in points.rejected} == {"too slow"}
    surface = hersey.fit(points)
    assert surface.c.value == pytest.approx(-0.86, abs=0.05)
    assert set(np.sign(encoder.points(rotation="reverse").column("speed"))) == {-1.0}


def test_the_friction_curve_of_a_moving_log_has_its_numbers(encoder: MovingFit) -> None:
    """Its windows judge it; numbers, ends and limits are those of every sample, and the offset is named."""
    points = encoder.points()
    surface = hersey.fit(points)
    curve = leading_friction(points, surface, hersey.regime(points, surface))
    assert curve is not None
    assert curve.of_every_sample
    assert [each.estimate for each in curve.parameters] == [encoder["T_C"], encoder["k_v"]]
    assert curve.aicc < surface.statistics.aicc - 10.0
    assert curve.directions is not None
    assert curve.directions.offset == pytest.approx(OFFSET, abs=0.002)
    assert "One law describes both directions beside an offset of 1" in curve.finding
    slow, fast = encoder.speed_range
    ends = [*(curve.forward_speeds or ()), *(curve.reverse_speeds or ())]
    assert (min(ends), max(ends)) == pytest.approx((slow, fast), rel=0.3)
    for line in curve.lines:
        at = float(line.speed[30])
        known = encoder.friction_at(at)
        assert (line.low is None, line.high is None) == (False, False)
        assert [line.low[30], line.torque[30], line.high[30]] == pytest.approx(  # type: ignore[index]
            [known.low, known.value, known.high], rel=1e-9
        )


def test_the_least_torque_of_a_moving_log() -> None:
    """Stribeck friction of 0.3 + 0.2 exp(-(w/0.6)^2) + 0.02 w is least at 1.45 rad/s."""
    speed, rate = waves(times())
    slow = speed / 3.0
    rise = 0.2 * np.exp(-((slow / 0.6) ** 2))
    fit = made(slow, rate / 3.0, np.sign(slow) * (COULOMB + rise) + VISCOUS * slow).moving()
    curve = moving_curve(fit.points())
    assert curve is not None
    (least,) = curve.least
    true = float(optimize.brentq(lambda w: VISCOUS - 0.4 * w / 0.36 * np.exp(-((w / 0.6) ** 2)), 0.8, 2.5))
    assert least.direction == "both"
    assert least.speed.low < true < least.speed.high
    assert least.speed.high < 1.3 * least.speed.low


def test_a_film_that_moves_all_the_time_is_no_friction_curve() -> None:
    speed, rate = waves(times())
    points = made(speed, rate, 0.3 * np.sign(speed) * np.abs(speed) ** 0.4).moving().points()
    surface = hersey.fit(points)
    assert leading_friction(points, surface, hersey.regime(points, surface)) is None


def test_windows_that_last_as_long_as_the_log_are_in_no_order() -> None:
    """They come by speed, not by time; of one ramp up they come by both."""
    speed, rate = waves(times())
    up = np.abs(speed) + 0.3
    both = made(up, np.sign(speed) * rate, COULOMB + VISCOUS * up).moving().points()
    assert doubtful_order(both) == []
    ramp = 1.0 + times() / 8.0
    log = made(ramp, np.full(ramp.size, 1.0 / 8.0), COULOMB + VISCOUS * ramp)
    once = log.moving(inertia=INERTIA).points()
    assert [each.values["quantity"] for each in doubtful_order(once)] == ["speed"]


def test_what_windows_share_moves_them_together(encoder: MovingFit) -> None:
    """One standard error of the offset is in all of them."""
    shared = encoder.points().window_errors
    assert np.sqrt(np.sum(shared**2, axis=1)).min() > 0.5 * encoder["offset"].error


def test_one_direction_shows_no_zero() -> None:
    time = times()
    speed, rate = 6.0 + 4.0 * np.sin(time), 4.0 * np.cos(time)
    fit = made(speed, rate, COULOMB + VISCOUS * speed).moving()
    assert "offset" not in fit
    assert kinds(fit) == ["torque zero unknown"]
    assert fit["T_C"].value == pytest.approx(COULOMB + OFFSET, rel=0.02)


def constant(time: Any) -> hersey.TorqueLog:
    return read(6.0 + 0.001 * np.sin(time), 0.3 + 0.0 * time)


def motoring(time: Any) -> hersey.TorqueLog:
    speed, rate = waves(time)
    return read(speed, -COULOMB * np.sign(speed) - VISCOUS * speed + INERTIA * rate)


def loaded(time: Any) -> hersey.TorqueLog:
    """Torque of a brake that goes up and down while the speed rises."""
    return read(2.0 + 0.3 * time, 0.5 + 0.45 * np.sin(1.7 * time))


@pytest.mark.parametrize(
    ("log", "said"),
    [
        (constant, "the speed hardly changes, so inertia and friction cannot be separated. Omit moving"),
        (motoring, "torque and speed have opposite signs. Flip one with signs="),
        (loaded, "torque does not follow speed: friction and a constant explain"),
    ],
)
def test_what_is_no_friction_is_refused(log: Any, said: str) -> None:
    with pytest.raises(InsufficientDataError) as error:
        log(times()).moving()
    assert said in str(error.value)


def test_a_coefficient_asks_for_radius_and_load() -> None:
    speed = 0.5 + 0.2 * np.sin(2.0 * times())
    columns = {"time (s)": times(), "mu": np.full(speed.size, 0.1), "sliding speed (m/s)": speed}
    log = hersey.read(pl.DataFrame(columns), isothermal=True)
    with pytest.raises(ParameterError) as error:
        log.moving()
    assert str(error.value) == (
        "a fit to every sample needs a torque, but the log is of a friction coefficient against sliding "
        "speed. Give radius='25 mm' and load='50 N', with your values. If nothing turns, give radius='1 m' "
        "and load='1 N', and read N·m as the coefficient and rad/s as m/s"
    )


def test_exact_data_end_in_no_fault() -> None:
    """No noise at all: the numbers are those that made it; a torque that never changes measures nothing."""
    speed, rate = waves(times())
    exact = made(speed, rate, COULOMB * np.sign(speed) + VISCOUS * speed, noise=0.0).moving()
    assert exact["J"].value == pytest.approx(INERTIA, rel=1e-3)
    with pytest.raises(InsufficientDataError, match=r"torque reads 300 mN m in every row"):
        read(speed, 0.3 * np.sign(speed)).moving()


def test_too_short_a_log_is_refused() -> None:
    speed, rate = waves(times(1.0))
    with pytest.raises(InsufficientDataError, match="a moving log needs 30"):
        made(speed, rate, COULOMB * np.sign(speed)).moving()
