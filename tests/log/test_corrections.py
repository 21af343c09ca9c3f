"""Each correction gives back what was put in, says what it did, and leaves alone what it cannot know."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey import testbench
from hersey.errors import InsufficientDataError, ParameterError
from hersey.log import corrections
from hersey.log.corrections import Corrected
from hersey.log.torque_log import LogFile, Run

STEP = 0.02
TIME = np.arange(0.0, 60.0, STEP)


def log_of(
    torque: np.ndarray,
    speed: np.ndarray,
    temperature: np.ndarray | None = None,
    time: np.ndarray | None = None,
) -> hersey.TorqueLog:
    time = TIME if time is None else time
    run = Run("made.csv", time, torque, speed, temperature)
    return hersey.TorqueLog((run,), (LogFile("made.csv", "0" * 64, 1, time.size, 0, (), ()),))


def staircase(*levels: float, ramp: float = 1.0) -> np.ndarray:
    """Speeds held for equal times, with ramps between."""
    each = TIME[-1] / len(levels)
    knots = [t for i in range(len(levels)) for t in (i * each + (ramp if i else 0.0), (i + 1) * each)]
    return np.interp(TIME, knots, np.repeat(levels, 2))


def torque_of(done: Corrected) -> np.ndarray:
    return done.log.runs[0].torque


def test_inertia_comes_out_of_ramps() -> None:
    speed = staircase(1.0, 9.0, 3.0, ramp=2.0)
    drag = 0.4 * speed**0.3
    inertial = 0.02 * np.gradient(speed, STEP)
    random = np.random.default_rng(1)
    noisy = speed + 0.003 * random.standard_normal(TIME.size)
    done = corrections.inertia(log_of(drag + inertial, noisy), moment_of_inertia=0.02)
    left = torque_of(done) - drag
    assert np.abs(inertial).max() == pytest.approx(0.08, rel=0.01)
    ramps = np.abs(inertial) > 1e-6
    away = ~np.convolve(np.abs(np.diff(inertial, prepend=0)) > 1e-6, np.ones(27), "same").astype(bool)
    assert np.abs(left[ramps & away]).max() < 0.003
    assert np.sqrt(np.mean(left[ramps] ** 2)) < 0.3 * np.sqrt(np.mean(inertial[ramps] ** 2))
    (record,) = done.corrections
    assert record.name == "inertia"
    assert dict(record.parameters)["moment_of_inertia"] == "0.02 kg m^2"
    assert record.effects[0].largest == pytest.approx(0.08, rel=0.05)


def test_inertia_of_the_virtual_stand_is_found_again() -> None:
    quiet = testbench.Stand(
        torque_noise=0.0, repeatability=0.0, mesh_ripple=0.0, torque_offset=0.0, torque_step=0.0,
        speed_ripple=0.0, stick_slip=False, inertia=0.05, temperatures_degC=(150.0,), overshoot=0.0,
    )  # fmt: skip
    recorded = testbench.run(seed=1, stand=quiet)
    columns = [recorded.table[name].to_numpy() for name in testbench.COLUMNS]
    time, torque, speed, temperature = columns
    log = log_of(torque, speed * testbench.RPM, temperature + 273.15, time)
    truth = recorded.truth.torque(speed * testbench.RPM, np.maximum(temperature, 20.0))
    after = torque_of(corrections.inertia(log, moment_of_inertia=0.05, window=0.3))
    held = np.abs(temperature - 150.0) < 0.2
    before_error = np.sqrt(np.mean((torque - truth)[held] ** 2))
    after_error = np.sqrt(np.mean((after - truth)[held] ** 2))
    assert after_error < 0.35 * before_error


def test_gaps_and_uneven_clocks_do_not_break_the_derivative() -> None:
    random = np.random.default_rng(2)
    kept = random.random(TIME.size) > 0.3
    kept &= (TIME < 20) | (TIME > 31)
    kept |= np.isin(np.arange(TIME.size), [1200, 1202])  # two rows alone in the gap
    time = np.sort(TIME[kept] + 0.2 * STEP * random.standard_normal(kept.sum()))
    speed = 5.0 + 2.0 * np.sin(0.5 * time)
    done = corrections.inertia(log_of(np.zeros(time.size), speed, time=time), moment_of_inertia=1.0)
    expected = -np.cos(0.5 * time)
    alone = (time > 21) & (time < 30)
    assert alone.sum() == 2
    np.testing.assert_allclose(torque_of(done)[~alone], expected[~alone], atol=0.02)
    np.testing.assert_array_equal(torque_of(done)[alone], 0.0)
    (warning,) = done.corrections[0].warnings
    assert (warning.kind, warning.values) == ("rows alone between gaps", {"rows": 2})


def test_tare_is_a_shift() -> None:
    log = log_of(np.full(TIME.size, 0.5), np.full(TIME.size, 3.0))
    done = corrections.tare(log, torque=0.02)
    np.testing.assert_allclose(torque_of(done), 0.48)
    assert "at most 0.02 N m" in str(done.corrections[0])
    assert done.corrections[0].effects[0].share == pytest.approx(0.04)


def test_no_load_torque_has_the_direction_of_the_speed() -> None:
    speed = staircase(-4.0, 4.0)
    log = log_of(0.5 * np.sign(speed), speed)
    after = torque_of(corrections.no_load(log, torque=0.1))
    np.testing.assert_allclose(after, 0.4 * np.sign(speed), atol=1e-12)


def test_no_load_torque_from_a_second_log() -> None:
    def bearings(speed: np.ndarray) -> np.ndarray:
        return np.sign(speed) * (0.02 + 0.004 * np.abs(speed))

    random = np.random.default_rng(3)
    free_speed = staircase(2.0, 4.0, 6.0, 8.0, -3.0, -8.0)
    free = log_of(bearings(free_speed) * (1 + 0.02 * random.standard_normal(TIME.size)), free_speed)
    speed = staircase(1.0, 3.0, 5.0, 7.0, -5.0)
    drag = np.sign(speed) * 0.3 * np.abs(speed) ** 0.3
    done = corrections.no_load(log_of(drag + bearings(speed), speed), torque=free)
    inside = np.abs(speed) >= 2.0
    np.testing.assert_allclose(torque_of(done)[inside], drag[inside], atol=0.0006)
    (warning,) = done.corrections[0].warnings
    assert warning.kind == "speeds beyond the no-load log"
    assert warning.values["rows"] == np.count_nonzero((np.abs(speed) < 2) & (np.abs(speed) > 0.002))
    assert "dwells of made.csv at 2 to 8 rad/s" in str(done.corrections[0])


def test_torque_from_current_through_gears() -> None:
    """3 A at 35 mN m/A through a gear of 12.5 that passes 80 %: 1.05 N m at a roll that turns at 2 rad/s."""
    speed = np.where(TIME < 50, 25.0, -25.0)
    done = corrections.torque_from_current(log_of(np.full(TIME.size, 3.0), speed), motor_constant=0.035)
    done = corrections.at_roll(done, torque_ratio=12.5, speed_ratio=12.5, efficiency=0.8)
    driving = TIME < 50
    np.testing.assert_allclose(torque_of(done)[driving], 1.05)
    np.testing.assert_allclose(torque_of(done)[~driving], 0.105 * 12.5 / 0.8)
    np.testing.assert_allclose(np.abs(done.log.runs[0].speed), 2.0)
    current, gears = done.corrections
    assert (current.name, current.effects) == ("torque from current", ())
    (of_current,), (of_gears,) = current.warnings, gears.warnings
    assert of_current.kind == "torque from current"
    assert of_current.values["torque"] == pytest.approx(0.105)
    assert (of_gears.kind, of_gears.values) == ("roll drives the motor", {"rows": 500})


def test_sign() -> None:
    log = log_of(np.full(TIME.size, -0.5), np.full(TIME.size, 3.0))
    done = corrections.sign(log, torque=-1)
    assert torque_of(done)[0] == 0.5
    assert done.log.runs[0].speed[0] == 3.0


@pytest.mark.parametrize("constant", [1.0, 4.0, 12.0])
def test_thermal_lag_is_undone(constant: float) -> None:
    true = 420.0 + 15.0 * np.sin(0.3 * TIME) + 0.3 * TIME
    shown = np.empty_like(true)
    shown[0] = true[0]
    decay = np.exp(-STEP / constant)
    for i in range(1, true.size):
        shown[i] = decay * shown[i - 1] + (1 - decay) * 0.5 * (true[i] + true[i - 1])
    log = log_of(np.ones(TIME.size), np.ones(TIME.size), shown)
    done = corrections.thermal_lag(log, time_constant=constant)
    inside = np.abs(TIME - 30.0) < 30.0 - constant
    after = done.log.runs[0].temperature
    assert after is not None
    assert np.abs(shown - true)[inside].max() > 4.0
    assert np.abs(after - true)[inside].max() < 0.5


def test_temperature_offset_and_its_absence() -> None:
    done = corrections.temperature_offset(
        log_of(np.ones(TIME.size), np.ones(TIME.size), np.full(TIME.size, 400.0)), offset=-1.5
    )
    assert done.log.runs[0].temperature is not None
    assert done.log.runs[0].temperature[0] == 398.5
    bare = log_of(np.ones(TIME.size), np.ones(TIME.size))
    with pytest.raises(InsufficientDataError, match=r"made.csv has no temperature"):
        corrections.temperature_offset(bare, offset=1.0)


def test_records_pile_up_and_the_log_given_stays_as_it_was() -> None:
    log = log_of(np.full(TIME.size, 0.5), np.full(TIME.size, 3.0))
    before = log.runs[0].torque.copy()
    done = corrections.tare(corrections.sign(log, torque=-1), torque=0.1)
    assert [record.name for record in done.corrections] == ["sign", "tare"]
    np.testing.assert_array_equal(log.runs[0].torque, before)
    assert done.log.files == log.files


def test_an_effect_is_largest_rms_and_share_of_the_median() -> None:
    """A sine of an offset: its root mean square is 1/sqrt(2) of its height, its mean absolute 2/pi."""
    speed = 3.0 + 2.0 * np.sin(2 * np.pi * TIME / 20.0)
    done = corrections.inertia(log_of(np.full(TIME.size, -0.4), speed), moment_of_inertia=0.5)
    (effect,) = done.corrections[-1].effects
    height = 0.5 * 2.0 * 2 * np.pi / 20.0  # the ends of the derivative are a little off
    assert effect.role == "torque"
    assert effect.largest == pytest.approx(height, rel=5e-3)
    assert effect.typical == pytest.approx(height / np.sqrt(2), rel=1e-3)
    assert effect.share == pytest.approx(height / np.sqrt(2) / 0.4, rel=1e-3)
    assert str(effect) == "torque by at most 0.315 N m, 0.222 N m rms, 55 % of its median"
    np.testing.assert_allclose(
        torque_of(done), -0.4 - height * np.cos(2 * np.pi * TIME / 20.0), atol=1e-2 * height
    )


def test_a_share_needs_something_to_be_a_share_of() -> None:
    done = corrections.tare(log_of(np.zeros(TIME.size), np.full(TIME.size, 3.0)), torque=0.25)
    (effect,) = done.corrections[-1].effects
    assert (effect.largest, effect.typical, effect.share) == (0.25, 0.25, None)
    assert str(effect) == "torque by at most 0.25 N m, 0.25 N m rms"
    warmed = corrections.temperature_offset(
        log_of(np.ones(TIME.size), np.ones(TIME.size), np.full(TIME.size, 400.0)), offset=-3.0
    )
    (effect,) = warmed.corrections[-1].effects
    assert str(effect) == "temperature by at most 3 K, 3 K rms"
    assert str(warmed.corrections[-1]) == (
        "temperature offset (offset -3 K): changed temperature by at most 3 K, 3 K rms"
    )


def test_gears_by_hand_in_both_directions() -> None:
    speed = np.where(TIME < 30.0, 4.0, -4.0)
    log = log_of(np.full(TIME.size, 0.5), speed)
    done = corrections.at_roll(log, torque_ratio=3.0, speed_ratio=2.0, efficiency=0.8)
    driving = TIME < 30.0
    np.testing.assert_allclose(torque_of(done)[driving], 0.5 * 3.0 * 0.8, rtol=1e-12)
    np.testing.assert_allclose(torque_of(done)[~driving], 0.5 * 3.0 / 0.8, rtol=1e-12)
    np.testing.assert_allclose(done.log.runs[0].speed, speed / 2.0, rtol=1e-12)
    (warning,) = done.corrections[-1].warnings
    assert warning.values == {"rows": int(np.sum(~driving))}
    assert str(warning) == f"in {int(np.sum(~driving))} rows the load drives the motor"
    assert not corrections.at_roll(log, torque_ratio=3.0).corrections[-1].warnings


def test_the_no_load_curve_is_held_beyond_its_dwells() -> None:
    idle = log_of(0.1 + 0.02 * staircase(2.0, 4.0, 6.0), staircase(2.0, 4.0, 6.0))
    speed = np.where(TIME < 20.0, 1.0, np.where(TIME < 40.0, -3.0, 8.0))
    done = corrections.no_load(log_of(np.sign(speed) * 1.0, speed), torque=idle)
    expected = np.where(TIME < 20.0, 1.0 - 0.14, np.where(TIME < 40.0, -1.0 + 0.16, 1.0 - 0.22))
    np.testing.assert_allclose(torque_of(done), expected, rtol=1e-6)
    beyond = int(np.sum((TIME < 20.0) | (TIME >= 40.0)))
    (warning,) = done.corrections[-1].warnings
    assert warning.values == {"rows": beyond}
    assert (
        str(warning) == f"{beyond} rows lie outside the speed range of the no-load log; "
        "the nearest no-load torque was used"
    )


def test_a_current_becomes_a_torque_and_says_so() -> None:
    done = corrections.torque_from_current(
        log_of(np.where(TIME < 20.0, 2.0, -4.0), np.ones(TIME.size)), motor_constant=0.05
    )
    np.testing.assert_allclose(torque_of(done), np.where(TIME < 20.0, 0.1, -0.2), rtol=1e-12)
    assert str(done.corrections[-1]) == (
        "torque from current (motor_constant 0.05 N m/A); the torque channel was a motor current in A; "
        "after conversion the median "
        "torque is 0.2 N m"
    )


def test_a_lag_is_undone_by_tau_times_the_rate() -> None:
    temperature = 350.0 + 0.5 * TIME
    log = log_of(np.ones(TIME.size), np.ones(TIME.size), temperature)
    done = corrections.thermal_lag(log, time_constant=8.0)
    np.testing.assert_allclose(done.log.runs[0].temperature, temperature + 4.0, rtol=1e-9)
    assert done.corrections[-1].parameters == (("time_constant", "8 s"), ("window", "2 s"))
    short = corrections.thermal_lag(log, time_constant=1.0)
    assert short.corrections[-1].parameters == (("time_constant", "1 s"), ("window", "0.5 s"))


def test_samples_alone_between_gaps_are_left_and_counted() -> None:
    time = np.concatenate([np.arange(0, 10, STEP), [15.0, 15.0 + STEP], 20 + np.arange(0, 10, STEP)])
    log = log_of(np.ones(time.size), 2.0 + 0.3 * time, time=time)
    done = corrections.inertia(log, moment_of_inertia=0.5)
    alone = np.isin(time, [15.0, 15.0 + STEP])
    np.testing.assert_allclose(torque_of(done)[alone], 1.0, rtol=1e-12)
    np.testing.assert_allclose(torque_of(done)[~alone], 1.0 - 0.5 * 0.3, rtol=1e-9)
    (warning,) = done.corrections[-1].warnings
    assert warning.values == {"rows": 2}
    assert (
        str(warning)
        == "2 rows stand alone between gaps, so no derivative can be computed there; they were not corrected"
    )


BAD = {
    "tare is inf": lambda log: corrections.tare(log, torque=np.inf),
    "efficiency is 1.2": lambda log: corrections.at_roll(log, efficiency=1.2),
    "torque_ratio is 0": lambda log: corrections.at_roll(log, torque_ratio=0.0),
    "moment_of_inertia is -1 kg m": lambda log: corrections.inertia(log, moment_of_inertia=-1.0),
    "window is 0 s": lambda log: corrections.inertia(log, moment_of_inertia=1.0, window=0.0),
    "time_constant is nan s": lambda log: corrections.thermal_lag(log, time_constant=np.nan),
    "sign of torque is 2": lambda log: corrections.sign(log, torque=2),
    "no-load torque is -1 N m": lambda log: corrections.no_load(log, torque=-1.0),
    "motor_constant is 0 N m/A": lambda log: corrections.torque_from_current(log, motor_constant=0.0),
}


@pytest.mark.parametrize("says", BAD)
def test_what_physics_does_not_allow_is_refused(says: str) -> None:
    log = log_of(np.ones(TIME.size), np.ones(TIME.size), np.full(TIME.size, 400.0))
    with pytest.raises(ParameterError, match=says):
        BAD[says](log)


def test_a_corrected_log_is_fitted_to_the_truth() -> None:
    """A log spoilt in four ways and corrected gives the dwells of the log before."""
    speed = staircase(2.0, 5.0, 12.0)
    random = np.random.default_rng(5)
    drag = 0.4 * speed**0.3 * (1 + 0.01 * random.standard_normal(TIME.size))
    good = log_of(drag, speed)
    spoilt = log_of(-(drag / (10 * 0.9) + 0.03), 10 * speed)
    done = corrections.tare(corrections.sign(spoilt, torque=-1), torque=0.03)
    done = corrections.at_roll(done, torque_ratio=10, speed_ratio=10, efficiency=0.9)
    for name in ("speed", "torque", "torque_error"):
        np.testing.assert_allclose(done.log.steady().column(name), good.steady().column(name), rtol=1e-9)
    assert replace(done.log.runs[0], name="x").name == "x"


def test_no_load_torque_where_the_roll_drives_the_motor() -> None:
    """The no-load torque brakes the motion, whichever way torque acts."""
    speed = staircase(-4.0, 4.0)
    after = torque_of(corrections.no_load(log_of(-0.5 * np.sign(speed), speed), torque=0.1))
    np.testing.assert_allclose(after, -0.6 * np.sign(speed), atol=1e-12)
