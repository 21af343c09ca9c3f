"""Parts of the reading of a trace by hand: samples, turning points, falls, slopes, figures, notes, charts."""

from __future__ import annotations

from dataclasses import asdict, astuple, replace
from typing import Any

import numpy as np
import pytest
from scipy import stats
from scipy.signal import savgol_filter

import hersey
from hersey.charts.cycles import trace_chart
from hersey.errors import InsufficientDataError, ParameterError
from hersey.identification.cycle_record import CycleRecord, Scatter, cycles
from hersey.identification.detection import running_width
from hersey.identification.drive_fit import DriveFit
from hersey.identification.identified_drive import IdentifiedDrive, identify
from hersey.identification.independence import directions, not_estimable
from hersey.identification.sampling import even_samples
from hersey.identification.slip_shape import TEN_TO_NINETY, held_slope, slip_duration, stick_angle
from hersey.identification.turning_points import (
    Falls,
    averaged,
    crossing,
    curved,
    falls,
    least_turn,
    smoothed,
)
from hersey.identification.waveform import mean_waveform, model_lap
from hersey.schema.warning import Warning

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


def saw(
    *, teeth: int = 40, rise: int = 140, fall: int = 60, height: float = 10.0, step: float = 0.01
) -> tuple[np.ndarray, np.ndarray]:
    """Time and force of straight rises and falls of so many samples."""
    one = np.concatenate([np.arange(rise) / rise, 1 - np.arange(fall) / fall])
    value = 5.0 + height * np.concatenate([np.tile(one, teeth), one[: rise // 2]])
    return 3.0 + step * np.arange(value.size), value


def test_figures_of_a_saw() -> None:
    time, force = saw()
    record = cycles(time, force, drive_speed=0.5)
    assert record.kind == "stick_slip"
    assert record.slips == 40
    np.testing.assert_allclose(record.period, 2.0, rtol=1e-9)
    assert record.period.size == 39
    np.testing.assert_allclose(record.slip_time, 3.0 + 1.4 + 0.3 + 2.0 * np.arange(40), atol=0.011)
    np.testing.assert_allclose(record.drop, 9.3, rtol=0.01)  # a parabola rounds the corners
    np.testing.assert_allclose(record.fall_duration, 0.66, atol=0.065)  # from the running mean
    assert record.loading_slope == pytest.approx(10.0 / 1.4, rel=1e-3)
    assert record.stiffness == pytest.approx(record.loading_slope / 0.5, rel=1e-12)
    assert record.drift == pytest.approx(0.0, abs=1e-6)
    # 80 % of a straight fall lasts 0.48 s: half a cosine as steep lasts so much over its own share
    steep = 0.48 / (2 * np.arcsin(0.8) / np.pi)
    assert np.median(record.steep_duration) == pytest.approx(steep, rel=0.1)
    assert record.free_period == pytest.approx(2 * np.median(record.steep_duration), rel=1e-12)
    angle = stick_angle(
        float(np.median(record.drop)), float(np.median(record.fall_duration)), record.loading_slope
    )
    slips = float(np.median(record.fall_duration)) * (2 - 2 * angle / np.pi)
    assert record.stuck_fraction == pytest.approx(1 - slips / 2.0, rel=1e-9)
    assert record.samples.interval == pytest.approx(0.01)
    assert record.samples.start == 3.0
    assert record.slips_of_at_least(9.0) == 40
    assert record.slips_of_at_least(11.0) == 0
    assert cycles(time, force).stiffness is None
    assert record.warnings == ()


def of_kind(record: CycleRecord, kind: str) -> Warning:
    """The one warning of its kind."""
    (found,) = (each for each in record.warnings if each.kind == kind)
    return found


def test_drift_is_the_slope_of_the_middle() -> None:
    time, force = saw()
    record = cycles(time, force + 0.1 * (time - time[0]))
    assert record.drift == pytest.approx(0.1, rel=0.02)
    swing = record.drift * 0.01 * force.size
    assert of_kind(record, "level drifts").values == {"drift": pytest.approx(swing)}
    assert str(of_kind(record, "level drifts")) == f"the level drifts by {swing:.3g} over the trace"
    little = cycles(time, force + 0.03 * (time - time[0]))
    assert "level drifts" not in [each.kind for each in little.warnings]
    down = cycles(time, force - 0.1 * (time - time[0]))
    assert down.drift == pytest.approx(-0.1, rel=0.02)
    assert of_kind(down, "level drifts").values["drift"] == pytest.approx(-down.drift * 0.01 * force.size)


def test_missing_samples_are_counted_and_said() -> None:
    time, force = saw()
    gone = np.zeros(force.size, dtype=bool)
    gone[500:512] = gone[1790] = True
    record = cycles(time, np.where(gone, np.nan, force))
    assert record.samples.missing == 13
    sentence = "13 samples are missing; cycles that a gap hides in part are not used"
    assert of_kind(record, "samples missing").values == {"count": 13}
    assert f"- {sentence}" in record.summary().splitlines()
    assert f"{sentence}." in [each["text"] for each in record.to_dict()["warnings"]]
    assert cycles(time, force).warnings == ()


def test_a_gap_parts_its_neighbours() -> None:
    time, force = saw()
    kept = np.ones(time.size, dtype=bool)
    kept[2040:2270] = False
    record = cycles(time[kept], force[kept])
    assert record.slips in (38, 39)
    assert np.max(record.period) < 2.05
    assert record.period.size < record.slips - 1
    assert record.samples.missing == 230


def test_spikes_are_removed_and_said() -> None:
    time, force = saw()
    force[[250, 660, 661, 2250]] += [30.0, -25.0, -25.0, 30.0]
    record = cycles(time, force)
    assert record.samples.spikes == 4
    assert of_kind(record, "spikes removed").values == {"count": 4}
    assert str(of_kind(record, "spikes removed")) == "4 spikes of one or two samples were removed"
    assert record.slips == 40
    np.testing.assert_allclose(record.samples.value[[250, 2250]], force[[249, 2249]], atol=1.5)


def test_other_warnings_of_a_record() -> None:
    time, force = saw(rise=20, fall=120)
    turned = of_kind(cycles(time, force), "sign may be turned")
    assert turned.sentence == "The trace rises faster than it falls. Is its sign flipped?"
    time, force = saw(rise=30, fall=3)
    coarse = cycles(time, force)
    lasts = np.median(coarse.steep_duration) / 0.01
    few = of_kind(coarse, "falls of few samples")
    assert few.values == {"samples": pytest.approx(lasts)}
    assert str(few) == f"a drop lasts only {lasts:.1f} samples. Sample faster to resolve the slip"
    time, force = saw()
    noisy = force + np.random.default_rng(0).normal(0, 0.5, force.size)
    record = cycles(time, noisy, least_drop=0.1)
    within = of_kind(record, "least drop within noise")
    assert within.values == {"least_drop": 0.1, "taken": record.least_drop}
    assert (
        str(within)
        == f"the smallest drop asked for, 0.1, is within the noise, so {record.least_drop:.3g} was used"
    )
    assert record.samples.noise == pytest.approx(0.5, rel=0.1)
    less = cycles(time, noisy, least_drop=8.0).warnings
    assert "least drop within noise" not in [each.kind for each in less]


def test_small_slips_are_said_and_left_out() -> None:
    _, force = saw(teeth=20)
    _, small = saw(teeth=8, rise=30, fall=20, height=2.0)
    both = np.concatenate([force[:4000], small])
    record = cycles(3.0 + 0.01 * np.arange(both.size), both)
    count = int(np.sum(record.drop < 0.5 * np.median(record.drop)))
    assert count >= 6
    last = record.warnings[-1]
    assert last.kind == "many small slips"
    assert {name: last.values[name] for name in ("small", "slips", "least")} == {
        "small": count,
        "slips": record.slips,
        "least": record.least_drop,
    }
    assert str(last).startswith(
        f"{count} of {record.slips} slips are smaller than half the median, so their number depends on "
        "the smallest drop counted ("
    )
    assert str(last).endswith(f"half the median with least_drop={0.5 * np.median(record.drop):.3g}")
    assert (
        cycles(3.0 + 0.01 * np.arange(both.size), both, least_drop=5.0).slips == 19
    )  # the last is not followed by such a rise
    assert cycles(3.0 + 0.01 * np.arange(both.size), both, least_drop=5.0).least_drop == 5.0


def test_an_irregular_force_is_no_cycle() -> None:
    assert cycles(*saw()).summary("N").splitlines()[0] == "stick slip: 40 slips"
    rng = np.random.default_rng(1)
    knots = np.cumsum(rng.uniform(0.2, 3.0, 120))
    time = np.arange(0, knots[-1], 0.01)
    force = np.interp(time, knots, np.where(np.arange(120) % 2, 1.0, -1.0))
    record = cycles(time, force)
    if record.kind == "steady_sliding":
        assert "irregular force" in [each.kind for each in record.warnings]
        assert record.stuck_fraction == 0.0


def test_figures_in_words() -> None:
    record = cycles(*saw(), drive_speed=0.5)
    period, drop = Scatter.of(record.period), Scatter.of(record.drop)
    assert record.summary("N").splitlines() == [
        "stick slip: 40 slips",
        f"period        {period.median:.4g} s (scatter {period.deviation:.2g} s); free period "
        f"{record.free_period:.4g} s",
        f"drop          {drop.median:.4g} N (scatter {drop.deviation:.2g} N)",
        f"force         {np.median(record.force_min):.4g} to {np.median(record.force_max):.4g} N",
        f"loading slope {record.loading_slope:.5g} N/s",
        f"stuck         {record.stuck_fraction:.0%} of the time",
        f"stiffness     {record.stiffness:.5g} N/m (slope / speed)",
    ]
    assert record.summary("N m").splitlines()[-1].endswith("N m/rad (slope / speed)")
    document = record.to_dict()
    assert document["slips"] == 40
    assert document["slip_time"] == record.slip_time.tolist()
    assert document["drop"] == pytest.approx(asdict(drop))
    assert document["period"]["error"] == pytest.approx(period.deviation / np.sqrt(39))
    assert document["stiffness"] == record.stiffness


def test_scatter_by_hand() -> None:
    found = Scatter.of(np.array([1.0, 2.0, 6.0]))
    assert astuple(found) == pytest.approx((2.0, 3.0, np.sqrt(7.0), np.sqrt(7.0 / 3)))
    assert np.isnan(astuple(Scatter.of(np.array([])))).all()
    assert np.isnan(Scatter.of(np.array([4.0])).deviation)


def test_the_stretch_of_a_trace_of_speed() -> None:
    time = 0.01 * np.arange(2000)
    speed = 0.4 + 0.2 * np.cos(2 * np.pi * time)
    record = cycles(time, speed, quantity="speed", drive_speed=0.4)
    expected = -0.2 / (2 * np.pi) * np.sin(2 * np.pi * time)
    np.testing.assert_allclose(record.samples.value, expected, atol=2e-5)
    mean = cycles(time, speed, quantity="speed")
    np.testing.assert_allclose(mean.samples.value, expected, atol=2e-5 + 20 * abs(speed.mean() - 0.4))
    faster = cycles(time, speed, quantity="speed", drive_speed=0.5)
    np.testing.assert_allclose(faster.samples.value, expected + 0.1 * time, atol=2e-5)
    with pytest.raises(ParameterError, match=r"unknown quantity 'torque'. Use force, speed"):
        cycles(time, speed, quantity="torque")


def test_samples_on_even_times() -> None:
    rng = np.random.default_rng(2)
    time = 2.0 + 0.1 * np.arange(400.0)
    value = np.sin(time)
    whole = even_samples(time, value)
    assert (whole.start, whole.interval, whole.missing, whole.spikes) == (2.0, pytest.approx(0.1), 0, 0)
    np.testing.assert_allclose(whole.time, time, rtol=1e-12)
    assert not whole.bridged.any()
    kept = np.ones(400, dtype=bool)
    kept[[50, 51, 52, 200]] = False
    gap = even_samples(time[kept], value[kept])
    assert np.flatnonzero(gap.bridged).tolist() == [50, 51, 52, 200]
    assert gap.missing == 4
    np.testing.assert_allclose(gap.value[50:53], np.interp(time[50:53], time[kept], value[kept]), rtol=1e-9)
    noise = [even_samples(time, value + rng.normal(0, s, 400)).noise for s in (0.01, 0.1)]
    assert noise == pytest.approx([0.01, 0.1], rel=0.2)
    stairs = even_samples(time, np.round(np.sin(time / 5) * 20) / 20)
    assert stairs.noise == pytest.approx(0.05 / np.sqrt(12), rel=1e-6)
    with pytest.raises(
        InsufficientDataError, match=r"^force has 29 samples; at least 30 are needed to find a cycle$"
    ):
        even_samples(time[:29], value[:29])
    assert even_samples(time[:30], value[:30]).value.size == 30
    with pytest.raises(ParameterError, match=r"^time of sample 7 is not a number$"):
        even_samples(np.where(np.arange(400) == 7, np.nan, time), value)
    with pytest.raises(ParameterError, match=r"^time does not ascend at sample 9$"):
        even_samples(np.where(np.arange(400) == 9, 0.0, time), value)


def test_many_departures_are_no_spikes() -> None:
    time, force = saw()
    force[50::20] += 30.0
    assert even_samples(time, force).spikes == 0


def test_falls_of_at_least_so_much() -> None:
    value = np.array([0.0, 5, 4.5, 6, 1, 1.4, 0.5, 7, 2, 3, 9, 4])
    found = falls(value, 1.0)
    assert (found.top.tolist(), found.bottom.tolist()) == ([3, 7], [6, 8])
    deep = falls(value, 4.0)
    assert (deep.top.tolist(), deep.bottom.tolist()) == ([3, 7], [6, 8])
    deeper = falls(value, 5.2)
    assert (deeper.top.tolist(), deeper.bottom.tolist()) == ([3], [6])
    fine = falls(value, 0.3)
    assert (fine.top.tolist(), fine.bottom.tolist()) == ([1, 3, 5, 7], [2, 4, 6, 8])


def test_where_a_fall_passes_a_level() -> None:
    value = np.array([0.0, 10, 8, 6, 6.5, 2, 0, 5, 9, 3, 1])
    found = Falls(np.array([1, 8]), np.array([6, 10]))
    assert crossing(value, found, 0.5).tolist() == pytest.approx([4 + 1.5 / 4.5, 8 + 4 / 6])
    assert crossing(value, found, 0.1).tolist() == pytest.approx([1.5, 8 + 0.8 / 6])
    assert crossing(value, found, 0.9).tolist() == pytest.approx([5.5, 9 + 1.2 / 2])


def test_least_turn_and_running_values() -> None:
    assert least_turn(0.3, 1000, 1) == pytest.approx(2 * 0.3 * np.sqrt(2 * np.log(1000)))
    assert least_turn(0.3, 1000, 9) == pytest.approx(2 * 0.3 * np.sqrt(2 * np.log(1000) * np.pi / 18))
    value = np.array([0.0, 0, 9, 0, 0, 3, 3, 3])
    assert smoothed(value, 3).tolist() == [0, 0, 0, 0, 0, 3, 3, 3]
    assert averaged(value, 3).tolist() == pytest.approx([0, 3, 3, 3, 1, 2, 3, 3])
    assert smoothed(value, 1) is value
    square = np.arange(12.0) ** 2
    np.testing.assert_allclose(curved(square, 5)[2:-2], square[2:-2], rtol=1e-12)
    for window in (5, 7, 51):
        expected = savgol_filter(value, window, 2, mode="nearest")
        np.testing.assert_allclose(curved(value, window), expected, atol=1e-12)
    assert running_width(np.array([10.0, 20.0, 90.0])) == 9
    assert running_width(np.array([1.0])) == 1


def test_the_shape_of_a_slip() -> None:
    """Of an ellipse with sticks between: fall, slope and stuck time give the angle back."""
    omega, slope = 30.0, 1000.0
    for angle in (0.2, 0.7, 1.3):
        drop = 2 * slope / (omega * np.cos(angle))
        fall = np.pi / omega
        found = stick_angle(drop, fall, slope)
        if np.tan(angle) >= 0.45 * (np.pi / 2 - angle + np.tan(angle)):  # the slope is that of the stick
            assert found == pytest.approx(angle, rel=1e-6)
        assert slip_duration(fall, angle) == pytest.approx(2 * (np.pi - angle) / omega)
        assert held_slope(drop, fall, angle) == pytest.approx(slope)
    assert stick_angle(2.0, np.pi, 1.01) == 0.0
    mean = np.cos(np.pi / 2 - 0.45 * np.pi / 2) / (0.45 * np.pi / 2)  # over 45 % of half a sine
    assert stick_angle(2.0, np.pi, mean * 1.001) == 0.0
    assert stick_angle(2.0, np.pi, mean * 0.99) > 0.0
    assert pytest.approx(2 * np.arcsin(0.8) / np.pi) == TEN_TO_NINETY


# --- the drive behind a trace ------------------------------------------------------------------------------


def record_of(seed: int, *, noise: float = 1.0, seconds: float = 25.0, drift: float = 0.0) -> CycleRecord:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=seconds, samples=int(1000 * seconds) + 1)
    kept = run.time > 2.0
    white = np.random.default_rng(seed).normal(0, noise, int(kept.sum()))
    force = run.spring_force[kept] + white + drift * (run.time[kept] - 2.0)
    return cycles(run.time[kept], force, drive_speed=1.0)


def test_the_mean_lap_and_its_error() -> None:
    record = record_of(0, noise=5.0)
    wave = mean_waveform(record)
    np.testing.assert_allclose(wave.force, np.nanmean(wave.laps, axis=0), rtol=1e-12)
    seen = np.sum(np.isfinite(wave.laps), axis=0)
    error = np.nanstd(wave.laps, axis=0, ddof=1) / np.sqrt(seen)
    np.testing.assert_allclose(wave.error, np.maximum(error, 0.3 * np.median(error)), rtol=1e-12)
    assert np.median(wave.error) == pytest.approx(5.0 / np.sqrt(wave.number), rel=0.3)
    assert wave.number == wave.laps.shape[0] == wave.period.size
    truth = hersey.stick_slip(TRAIN, DRAG, drive_speed=1.0)
    assert np.nanmean(wave.period) == pytest.approx(1 / truth.frequency, rel=1e-3)
    lap = model_lap(TRAIN, DRAG, 1.0)
    assert lap is not None
    assert lap.period == pytest.approx(1 / truth.frequency, rel=1e-12)
    half = 500 * (truth.stretch_max + truth.stretch_min)
    assert float(lap.at(np.array([0.0]))[0]) == pytest.approx(half, rel=1e-9)
    before, after = lap.at(np.array([-1e-3, 1e-3]))
    assert before > half > after  # the middle of the fall
    np.testing.assert_allclose(
        lap.at(np.array([0.01, 0.01 + lap.period])), lap.at(np.array([0.01]))[0], rtol=1e-6
    )


def test_a_drift_is_taken_off_the_laps() -> None:
    steady, drifting = (mean_waveform(record_of(0, noise=0.0, drift=drift)) for drift in (0.0, 2.0))
    level = np.mean(drifting.force) - np.mean(steady.force)
    assert level == pytest.approx(2.0 * 11.5, rel=0.1)  # the mean lap is that of the middle
    assert np.median(np.nanstd(drifting.laps, axis=0)) < 1.0


@pytest.fixture(scope="module")
def drive() -> IdentifiedDrive:
    known = {"stick_speed": 0.01, "transition_speed": 1.0, "ehl_exponent": -0.7}
    return identify(record_of(3, seconds=25.0), known=known, closures=("retained",))


def test_intervals_are_t_times_the_error(drive: IdentifiedDrive) -> None:
    """Of so few laps as a short record has, t is far from 1.96."""
    known = {"stick_speed": 0.01, "transition_speed": 1.0, "ehl_exponent": -0.7, "mixed_exponent": -1.2}
    short = identify(record_of(3, seconds=4.3), known=known, closures=("retained",))
    for found in (short, drive):
        t = stats.t.ppf(0.975, found.waveform.number - 1)
        assert "stiffness" in found.estimates
        for name, each in {**found.estimates, **found.derived}.items():
            if name.endswith("exponent"):
                assert (each.high - each.low) / 2 == pytest.approx(t * each.error, rel=1e-9)
            else:
                width = np.log(each.high / each.low) / 2
                assert width == pytest.approx(t * each.error / each.value, rel=1e-9), name
    assert short.waveform.number < 10
    assert stats.t.ppf(0.975, short.waveform.number - 1) > 2.2


def test_what_is_derived_follows_from_the_best_fit(drive: IdentifiedDrive) -> None:
    own = drive.values
    assert drive.derived["free_period"].value == pytest.approx(
        2 * np.pi * np.sqrt(own["mass"] / own["stiffness"])
    )
    assert drive.derived["release_force"].value == pytest.approx(float(drive.drag.force(own["stick_speed"])))
    assert drive.derived["drag_at_drive_speed"].value == pytest.approx(
        float(drive.drag.force(own["drive_speed"]))
    )
    assert own["drive_speed"] == pytest.approx(1.0, abs=1e-3)
    assert drive.train == hersey.Drivetrain(own["stiffness"], own["mass"])
    assert drive.known == {"stick_speed": 0.01, "transition_speed": 1.0, "ehl_exponent": -0.7}
    assert own["stick_speed"] == 0.01
    rms = np.sqrt(np.mean((drive.fitted - drive.waveform.force) ** 2)) / np.ptp(drive.waveform.force)
    assert drive.misfit == pytest.approx(rms, rel=1e-9)
    chi = np.sum(((drive.fitted - drive.waveform.force) / drive.waveform.error) ** 2)
    assert chi <= drive.closures[0].chi_square <= chi + 10
    wanted = {"stiffness": 1000, "mass": 1, "transition_force": 50, "mixed_exponent": -1.2}
    for name, truth in wanted.items():
        assert drive.values[name] == pytest.approx(truth, rel=0.05)


def test_errors_of_a_known_record_are_those_of_its_noise(drive: IdentifiedDrive) -> None:
    """Four times the noise, four times the error; the estimates of many seeds scatter as the error says."""
    known = dict(drive.known) | {"mixed_exponent": -1.2, "transition_force": 50.0}
    found = [
        identify(record_of(seed, seconds=12.0), known=known, closures=("retained",)) for seed in range(6)
    ]
    values = np.array([f.estimates["stiffness"].value for f in found])
    errors = np.array([f.estimates["stiffness"].error for f in found])
    assert 0.35 < values.std(ddof=1) / np.median(errors) < 2.0


def test_a_drive_in_words(drive: IdentifiedDrive) -> None:
    lines = drive.summary("N").splitlines()
    assert lines[0] == f"closure: retained; chi-square: retained {drive.closures[0].chi_square:.4g}"
    assert "stick_speed        0.01 m/s (given)" in lines
    assert f"stiffness          {drive.estimates['stiffness']} N/m" in lines
    assert f"free_period        {drive.derived['free_period']} s" in lines
    assert f"the model matches the mean cycle within {drive.misfit:.2%} of the drop" in lines
    document = drive.to_dict()
    assert document["known"] == dict(drive.known)
    assert document["best_fit"] == dict(drive.values)
    assert document["estimates"]["mass"]["error"] == drive.estimates["mass"].error
    assert document["misfit"] == drive.misfit


def test_directions_are_those_of_the_covariance() -> None:
    turned = np.array([[0.6, 0.8], [-0.8, 0.6]])
    covariance = turned.T @ np.diag([4.0, 0.01]) @ turned
    first, second = directions(("mass", "stiffness"), covariance)
    assert (first.error, second.error) == pytest.approx((2.0, 0.1))
    assert first.exponents == pytest.approx({"mass": 0.6, "stiffness": 0.8})
    assert str(first) == "mass^+0.60 x stiffness^+0.80"
    names = ("mass", "ehl_exponent", "stick_speed")
    three = np.ones(3) / np.sqrt(3)
    assert list(map(str, not_estimable(names, 4.0 * np.outer(three, three) + 1e-6 * np.eye(3)))) == [
        "mass, ehl exponent and stick speed can only be estimated together: they can change at once "
        "without changing the record"
    ]
    both = np.diag([4.0, 4.1, 1e-6]) + 0.0
    both[0, 1] = both[1, 0] = 0.5
    assert "mass and ehl exponent cannot be estimated, nor can their product" in [
        str(each) for each in not_estimable(names, both)
    ]
    pair = np.array([2.0, 1.0, 0.0]) / np.sqrt(5)
    (product,) = not_estimable(names, 4.0 * np.outer(pair, pair) + 1e-4 * np.eye(3))
    assert str(product).startswith("mass and ehl exponent can only be estimated as the product ")
    assert "exp(" in product.values["product"]
    assert product.values["parameters"] == "mass and ehl exponent"
    assert product.values["error"] == pytest.approx(np.linalg.norm([1.0, -2.0]) / 2.0 * 0.01)


# --- the picture -------------------------------------------------------------------------------------------


def rows(layer: dict[str, Any]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = layer["data"]["values"]
    return found


def test_the_chart_of_a_trace_in_numbers(drive: IdentifiedDrive) -> None:
    record = record_of(3)
    trace, slips, cycle = trace_chart(record, drive, unit="N").to_dict(validate=False)["vconcat"]
    line, dots = (rows(layer) for layer in trace["layer"])
    size = record.samples.value.size
    lap = np.median(record.period) / record.samples.interval
    reach = int(max(8 * lap, 400)) // 2
    part = slice(size // 2 - reach, size // 2 + reach)
    np.testing.assert_allclose([r["time"] for r in line], record.samples.time[part])
    np.testing.assert_allclose([r["force"] for r in line], record.samples.value[part])
    inside = (record.slip_time >= line[0]["time"]) & (record.slip_time <= line[-1]["time"])
    np.testing.assert_allclose([r["time"] for r in dots], record.slip_time[inside])
    middle = 0.5 * (record.force_max + record.force_min)[inside]
    np.testing.assert_allclose([r["force"] for r in dots], middle)
    assert len(dots) in (7, 8, 9)
    np.testing.assert_allclose([r["drop"] for r in rows(slips)], record.drop)
    np.testing.assert_allclose([r["time"] for r in rows(slips)], record.slip_time)
    fitted, mean = (rows(layer) for layer in cycle["layer"])
    np.testing.assert_allclose([r["time"] for r in mean], 1e3 * drive.waveform.offset)
    np.testing.assert_allclose([r["force"] for r in mean], drive.waveform.force)
    np.testing.assert_allclose([r["force"] for r in fitted], drive.fitted)
    assert {r["line"] for r in fitted} == {"fitted motion"}
    heading = trace_chart(record, drive).to_dict(validate=False)["title"]["subtitle"]
    assert heading == [
        f"stick slip: {record.slips} slips, period {np.median(record.period):.4g} s; dots: middle "
        "of each slip",
        f"fitted motion: closure retained, within {100 * drive.misfit:.2g} % of the drop",
    ]
    undecided = trace_chart(record, replace(drive, decided=False)).to_dict(validate=False)["title"][
        "subtitle"
    ][1]
    assert "closure retained (not decided), within" in undecided
    quiet = cycles(record.samples.time, np.random.default_rng(0).normal(size=record.samples.value.size))
    assert len(trace_chart(quiet).to_dict(validate=False)["vconcat"]) == 1


def test_the_covariance_of_a_fit_is_that_of_the_mean_of_its_laps(monkeypatch: pytest.MonkeyPatch) -> None:
    """What each lap asks of the values, by least squares; their mean scatters as the covariance over n."""
    known = {"stick_speed": 0.01, "transition_speed": 1.0, "ehl_exponent": -0.7, "mixed_exponent": -1.2}
    record = record_of(3, noise=5.0, seconds=9.0)
    wave = mean_waveform(record)
    fit = DriveFit(wave, record, known, "retained")
    monkeypatch.setattr(DriveFit, "_level_error", lambda _: 0.0)
    laps = np.nan_to_num((wave.laps - wave.force) / wave.error)
    period = np.nan_to_num((wave.period - fit.period) / fit.period_error)
    changes = np.column_stack([laps, period]) @ np.linalg.pinv(fit.jacobian())[:, :-1].T
    n = changes.shape[0]
    assert n < 30  # where n - 1 for n shows
    expected = changes.T @ changes / (n * (n - 1))
    np.testing.assert_allclose(fit.covariance(0.0), expected[:-1, :-1], rtol=1e-6)
