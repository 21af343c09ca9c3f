"""What is a dwell: each limit from either side, and the reason given beyond it."""

from __future__ import annotations

import re

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.errors import InsufficientDataError, ParameterError
from hersey.units import rpm
from tests.damping.test_dwells import RPM, dwells, log_of
from tests.damping.test_dwells_errors import by_hand, noise


def straightened(seed: int, count: int = 500) -> np.ndarray:
    """Noise without a trend of its own, of unit deviation."""
    series = noise(seed, count)
    time = np.arange(count)
    series = series - np.polyval(np.polyfit(time, series, 1), time)
    return np.asarray(series / np.std(series))


def ramp(rise: float) -> np.ndarray:
    """A line whose rise between the edges of a dwell of 10 s, which are cut, is as given."""
    return np.linspace(-0.5, 0.5, 500) * rise * 499 / 479


def alternating(size: float, count: int = 500) -> np.ndarray:
    return size * np.where(np.arange(count) % 2, 1.0, -1.0)


def point(
    torque: np.ndarray | None = None, temperature: np.ndarray | None = None, speed: np.ndarray | None = None
) -> SteadyPoints:
    """One dwell of 10 s at 30 rpm after one at 60 rpm that is beyond reproach."""
    good = np.ones(500)
    joined = [
        np.append(good * level, good if part is None else part)
        for level, part in (
            (60 * RPM, 30 * RPM * good if speed is None else speed),
            (1.0, torque),
            (400.0, temperature),
        )
    ]
    return log_of(joined[0], joined[1], temperature=None if temperature is None else joined[2]).steady()


def refused(points: SteadyPoints, words: str) -> bool:
    """Whether the dwell tried is not used, for a reason that begins so."""
    assert points.column("speed")[0] == pytest.approx(60 * RPM)
    return len(points) == 1 and any(r.reason.startswith(words) for r in points.rejected)


def whole(points: SteadyPoints) -> bool:
    """Whether all of the dwell tried is used."""
    return len(points) == 2 and points.column("rows")[1] == 480


@pytest.mark.parametrize(("rise", "kept"), [(1.9, True), (-1.9, True), (2.1, False), (-2.1, False)])
def test_temperature_may_drift_by_two_kelvin(rise: float, kept: bool) -> None:
    assert whole(point(temperature=400.0 + ramp(rise) + 1.0 * straightened(1))) == kept


@pytest.mark.parametrize(("rise", "kept"), [(0.0097, True), (-0.0097, True), (0.0103, False)])
def test_speed_may_drift_by_one_percent(rise: float, kept: bool) -> None:
    found = point(speed=30 * RPM * (1 + ramp(rise)))
    assert whole(found) == kept
    assert refused(found, f"speed drifts by {100 * rise:+.1f} % over the dwell") != kept
    backwards = point(-np.ones(500), speed=-30 * RPM * (1 + ramp(rise)))
    assert whole(backwards) == kept
    assert refused(backwards, f"speed drifts by {100 * rise:+.1f} % over the dwell") != kept


@pytest.mark.parametrize(
    ("rise", "deviation", "kept"),
    [
        (0.029, 0.01, True),
        (0.031, 0.01, False),
        (-0.031, 0.01, False),
        (0.058, 0.03, True),
        (0.062, 0.03, False),
    ],
)
def test_torque_may_drift_by_a_share_or_by_its_own_noise(rise: float, deviation: float, kept: bool) -> None:
    """3 %, or two standard deviations about the line."""
    torque = 1.0 + ramp(rise) + deviation * straightened(2)
    assert whole(point(torque)) == kept
    assert whole(point(-torque, speed=np.full(500, -30 * RPM))) == kept


def test_what_drifts_to_the_end_is_refused_with_its_rise() -> None:
    # no later start helps where the rest of it drifts as steeply
    steps = np.cumsum(np.exp(np.linspace(0.0, 6.0, 500)))
    found = point(1.0 + steps / steps[-1])
    assert refused(found, "torque drifts by +")
    assert refused(point(temperature=400.0 + 50.0 * steps / steps[-1]), "temperature drifts by +")


def test_drift_is_real_beyond_three_standard_errors() -> None:
    """Of a line's rise: root 12 of the error of a mean."""
    residual = np.pad(5.0 * straightened(3, 480), 10, mode="edge")
    error = 12**0.5 * by_hand(residual[10:-10])[1]
    for share, kept in ((2.9, True), (3.1, False)):
        assert share * error > 2.0
        assert whole(point(temperature=400.0 + ramp(share * error) + residual)) == kept


@pytest.mark.parametrize(("rise", "cut"), [(2.5, 0.3), (3.4, 0.5), (5.0, 0.65)])
def test_a_dwell_that_drifts_is_tried_again_from_later_on(rise: float, cut: float) -> None:
    found = point(temperature=400.0 + ramp(rise) + 0.2 * rise * straightened(4))
    start = 10 + round(cut * 480)
    row = found.table.row(1, named=True)
    assert row["start"] == pytest.approx(10.0 + start / 50)
    assert row["end"] == pytest.approx(10.0 + 489 / 50)
    assert (row["rows"], row["settling_rows"]) == (490 - start, 10 + start)


@pytest.mark.parametrize(("knee", "cut"), [(0.88, 0.8), (0.93, 0.9)])
def test_a_long_warm_up_leaves_the_end_of_a_dwell(knee: float, cut: float) -> None:
    """Half is cut as settling at most; then the least of the later starts that is steady."""
    share = np.linspace(0.0, 1.0, 1500)
    temperature = 400.0 - 300.0 * np.maximum(knee - share, 0.0)
    found = log_of(dwells(30, seconds=30), np.ones(1500), temperature=temperature).steady(min_dwell=1.0)
    (row,) = found.table.rows(named=True)
    assert row["start"] / 30.0 == pytest.approx(0.5 + 0.5 * cut, abs=0.012)
    assert row["settling_rows"] == 1500 - row["rows"]
    assert row["temperature"] == pytest.approx(400.0, abs=0.2)


@pytest.mark.parametrize(("deviation", "kept"), [(0.34, True), (0.36, False)])
def test_torque_may_swing_by_a_third(deviation: float, kept: bool) -> None:
    found = point(1.0 + alternating(deviation))
    assert whole(found) == kept
    assert refused(found, "torque fluctuates: standard deviation 36 %, so sliding is not steady") != kept


@pytest.mark.parametrize(("deviation", "kept"), [(0.49, True), (0.51, False)])
def test_speed_may_swing_by_half(deviation: float, kept: bool) -> None:
    found = point(speed=30 * RPM * (1.0 + alternating(deviation)))
    assert whole(found) == kept
    assert refused(found, "speed not constant: 14.7 to 45.3 rpm, standard deviation 51 %") != kept


def saw(period: int, deviation: float) -> np.ndarray:
    """Torque that rises slowly and drops at once, mean 1."""
    phase = np.arange(500) % period / (period - 1) - 0.5
    return np.asarray(1.0 + deviation * phase / np.std(phase))


def test_stick_slip_rises_slowly_and_drops_fast() -> None:
    assert refused(
        point(saw(20, 0.06)), "stick-slip: torque rises slowly and drops fast, standard deviation 6 %"
    )
    assert whole(point(saw(20, 0.045)))  # too little
    assert whole(point(2.0 - saw(20, 0.06)))  # the other way round
    assert whole(point(saw(9, 0.06)))  # a ninth of the time is not at once


def test_stick_slip_of_few_rows_shows_where_changes_go_on() -> None:
    """Seven changes rise and two drop: less skewed than sudden drops, but changes resemble the last."""
    cycle = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 3.5])
    torque = np.resize(cycle, 500)
    torque = 1.0 + 0.06 * (torque - torque.mean()) / np.std(torque)
    changes = np.diff(torque)
    assert -3.0 < float(np.mean(changes**3)) / float(np.mean(changes**2)) ** 1.5 < -1.0
    assert float(np.mean(changes[1:] * changes[:-1])) > 0.0
    assert refused(point(torque), "stick-slip: torque rises slowly and drops fast, standard deviation 6 %")
    assert whole(point(2.0 - torque))  # the other way round


def test_stick_slip_is_seen_in_reverse() -> None:
    found = point(-saw(20, 0.06), speed=np.full(500, -30 * RPM))
    assert refused(found, "stick-slip")


def test_the_test_of_a_dwell_is_on_its_net_torque() -> None:
    standing, load = np.full(500, 10.0), 10.0 + np.append(np.ones(500), 1.0 + alternating(0.36))
    log = log_of(dwells(0, 60, 30), np.append(standing, load))
    assert len(log.steady()) == 2
    found = log.steady(tare="standing")
    assert refused(found, "torque fluctuates: standard deviation 36 %")


def test_a_drift_is_one_of_net_torque() -> None:
    standing, load = np.full(500, 10.0), np.append(np.ones(500), 1.0 + ramp(0.2) + 0.05 * straightened(5))
    log = log_of(dwells(0, 60, 30), np.append(standing, 10.0 + load))
    assert log.steady().column("rows").tolist() == [480, 480]
    assert log.steady(tare="standing").column("rows")[0] == 480
    assert not whole(log.steady(tare="standing"))


@pytest.mark.parametrize(("seconds", "kept"), [(2.5, True), (2.3, False)])
def test_a_dwell_lasts_two_seconds_without_its_edges(seconds: float, kept: bool) -> None:
    speed = np.append(dwells(60), dwells(30, seconds=seconds))
    points = log_of(speed, np.ones(speed.size)).steady()
    assert (len(points) == 2) == kept
    reason = "dwell too short: 1.9 s and 95 rows are settled, but 2 s and 20 rows are needed"
    assert [r.reason for r in points.rejected] == ([] if kept else [reason])


def test_the_shortest_dwell_can_be_said() -> None:
    speed = dwells(60, 30, seconds=5.0)
    assert len(log_of(speed, np.ones(500)).steady(min_dwell=4.5)) == 2
    with pytest.raises(InsufficientDataError, match=r"at least 4\.7 s"):
        log_of(speed, np.ones(500)).steady(min_dwell=4.7)


@pytest.mark.parametrize(("rows", "kept"), [(20, True), (19, False)])
def test_a_dwell_has_twenty_rows(rows: int, kept: bool) -> None:
    speed = np.append(np.full(40, 60 * RPM), np.full(rows, 30 * RPM))
    points = log_of(speed, np.ones(speed.size), dt=0.5).steady()
    assert (len(points) == 2) == kept
    reasons = [r.reason for r in points.rejected]
    assert reasons == ([] if kept else ["speed changing, or held for fewer than 20 rows"])


@pytest.mark.parametrize(("seconds", "reason"), [(0.8, "speed changing"), (1.2, "dwell too short: 0.8 s")])
def test_a_speed_is_held_for_a_second(seconds: float, reason: str) -> None:
    speed = np.concatenate([dwells(60), dwells(30, seconds=seconds), dwells(90)])
    points = log_of(speed, np.ones(speed.size)).steady()
    (found,) = points.rejected
    assert found.reason.startswith(reason)
    assert found.rows == round(seconds * 50)


@pytest.mark.parametrize(("step", "points"), [(1.047, 1), (1.053, 2), (0.953, 1), (0.947, 2)])
def test_a_step_of_five_percent_parts_two_dwells(step: float, points: int) -> None:
    speed = np.append(dwells(30, seconds=8), dwells(30 * step, seconds=10))
    found = log_of(speed, np.ones(speed.size)).steady()
    assert len(found) == points
    assert found.column("speed")[-1] == pytest.approx(30 * step * RPM)
    if points == 1:  # the stretch before the step strays by more than 1 %
        assert found.column("start")[0] == pytest.approx(8.0, abs=0.25)


@pytest.mark.parametrize(("step", "points"), [(1.07, 1), (1.09, 2)])
def test_a_noisy_speed_may_stray_further(step: float, points: int) -> None:
    """By four deviations of a block: changes of 4 % from block to block are deviations of 4/1.627 %."""
    held = np.append(dwells(30, seconds=10), dwells(30 * step, seconds=12))
    blocks = 1.0 + 0.02 * np.where(np.arange(held.size) // 10 % 2, 1.0, -1.0)
    found = log_of(held * blocks, np.ones(held.size)).steady()
    stretches = len(found) + len(found.rejected)
    assert stretches == points


@pytest.mark.parametrize(("seconds", "points"), [(0.8, 1), (1.0, 2)])
def test_an_excursion_under_a_second_parts_no_dwell(seconds: float, points: int) -> None:
    speed = np.concatenate([dwells(30), dwells(45, seconds=seconds), dwells(30)])
    found = log_of(speed, np.ones(speed.size)).steady()
    assert len(found) == points
    if points == 1:
        assert found.column("speed")[0] == pytest.approx(float(np.mean(speed[10:-10])))
        assert found.column("rows")[0] == speed.size - 20


def test_dwells_on_either_side_of_an_excursion_hold_one_speed() -> None:
    speed = np.concatenate([dwells(30), dwells(45, seconds=0.8), dwells(32)])
    assert len(log_of(speed, np.ones(speed.size)).steady()) == 2


def test_a_ramp_is_one_stretch() -> None:
    speed = np.concatenate([dwells(30), np.linspace(30, 90, 200) * RPM, dwells(90)])
    found = log_of(speed, np.ones(speed.size)).steady()
    assert len(found) == 2
    (between,) = found.rejected
    assert between.reason == "speed changing"
    assert between.rows == pytest.approx(200, abs=45)


def test_the_end_of_a_slow_ramp_is_cut_from_a_dwell() -> None:
    """Speed within 5 % is held, but what strays by more than 1 % is an edge."""
    speed = np.concatenate([dwells(30), np.linspace(30, 31.2, 100) * RPM, dwells(31.2, seconds=12)])
    (row,) = log_of(speed, np.ones(speed.size)).steady().table.rows(named=True)
    assert row["start"] == pytest.approx(10.0 + 2.0 * (1.2 - 0.312) / 1.2, abs=0.2)


@pytest.mark.parametrize(("slow", "standing"), [(0.0019, True), (0.0021, False)])
def test_a_drive_stands_below_a_fiftieth_of_a_revolution(slow: float, standing: bool) -> None:
    speed = np.append(np.full(500, slow), dwells(60))
    found = log_of(speed, np.ones(1000)).steady()
    assert [r.reason for r in found.rejected] == (["drive at standstill"] if standing else [])
    assert len(found) == 2 - standing


@pytest.mark.parametrize(("slowest", "standing"), [(0.042, True), (0.038, False)])
def test_a_drive_stands_if_it_is_far_slower_than_it_moves(slowest: float, standing: bool) -> None:
    """A twentieth of the slowest speed that is surely one."""
    speed = np.concatenate([np.full(500, 0.00195), np.full(500, slowest), dwells(60)])
    found = log_of(speed, np.ones(1500)).steady()
    assert len(found) == 3 - standing


def test_a_noisy_zero_stands() -> None:
    """Within three standard errors of the mean of 50 blocks, whose deviation is 2/1.627 of the wobble."""
    wobble = 0.1 * np.where(np.arange(500) // 10 % 2, 1.0, -1.0)
    chance = 3.0 * 0.2 / 1.627 / 50**0.5
    for share, standing in ((0.97, True), (1.03, False)):
        found = log_of(np.append(wobble + share * chance, dwells(60) + wobble), np.ones(1000)).steady()
        assert ("drive at standstill" in [r.reason for r in found.rejected]) == standing


def test_what_strays_by_the_noise_is_no_edge() -> None:
    """By four times what neighbouring blocks differ by, or by 1 %."""
    found = point(
        speed=30 * RPM * np.append(1.0 + np.repeat([0.015, -0.015], 2)[np.arange(300) % 4], np.ones(200))
    )
    assert whole(found)
    ripple = 0.003 * np.repeat([1.0, -1.0], 2)[np.arange(500) % 4]
    for stray, kept in ((0.020, True), (0.030, False)):
        found = point(speed=30 * RPM * (1.0 + ripple + stray * (np.arange(500) < 25)))
        assert whole(found) == kept
        assert found.column("start")[1] == pytest.approx(10.2 if kept else 10.5, abs=0.05)


def test_a_piece_too_short_for_a_dwell_is_not_joined_to_one() -> None:
    speed = np.concatenate([dwells(60), dwells(30, seconds=0.8), dwells(31.55)])
    found = log_of(speed, np.ones(speed.size)).steady()
    assert [(r.reason, r.rows) for r in found.rejected] == [("speed changing", 40)]
    assert found.column("rows").tolist() == [480, 480]


def test_of_a_slow_log_each_row_is_a_block() -> None:
    speed = np.append(np.full(25, 60 * RPM), np.full(26, 30 * RPM))
    found = log_of(speed, np.ones(51), dt=1.0).steady()
    assert found.column("rows").tolist() == [25, 26]


def test_only_the_rotation_asked_for_is_used() -> None:
    speed = dwells(30, -60, 90)
    log = log_of(speed, np.sign(speed))
    assert log.steady(rotation="forward").column("speed") == pytest.approx([30 * RPM, 90 * RPM])
    (other,) = log.steady(rotation="forward").rejected
    assert other.reason == "rotation is not forward"
    reverse = log.steady(rotation="reverse")
    assert reverse.column("speed") == pytest.approx([-60 * RPM])
    assert reverse.table["approach"].to_list() == ["from below"]
    assert {r.reason for r in reverse.rejected} == {"rotation is not reverse"}


def test_torque_against_the_rotation_is_refused() -> None:
    found = point(-np.ones(500))
    assert refused(found, "torque and speed have opposite signs. Flip one with signs={'torque': -1}")


def test_a_sensor_that_shows_nothing_is_named() -> None:
    assert refused(point(np.zeros(500)), "torque is zero. Check that the sensor is connected")


def test_reasons_are_counted_where_nothing_is_steady() -> None:
    speed = dwells(0, 30, 60, 45)
    torque = np.concatenate([np.ones(500), *(1.0 + alternating(0.5) for _ in range(2)), np.zeros(500)])
    with pytest.raises(InsufficientDataError) as caught:
        log_of(speed, torque).steady()
    said = str(caught.value)
    assert said.startswith(
        "run: no dwell found (1 x drive at standstill, 2 x torque fluctuates, 1 x torque is zero"
    )
    assert said.endswith("A dwell must hold one speed for at least 2 s")


def test_a_list_of_reasons_holds_no_instruction() -> None:
    with pytest.raises(InsufficientDataError) as caught:
        log_of(dwells(30, 60, 45), np.concatenate([-np.ones(500), np.zeros(1000)])).steady()
    listed, instructions = str(caught.value).split("). ", 1)
    assert listed.endswith("(1 x torque and speed have opposite signs, 2 x torque is zero")
    assert instructions.startswith("Flip torque or speed with ")


def test_what_cannot_be_asked_of_dwells_is_refused() -> None:
    log = log_of(dwells(30, 60), np.ones(1000))
    for bad in (0.0, -1.0, float("inf"), float("nan")):
        with pytest.raises(ParameterError, match="min_dwell is"):
            log.steady(min_dwell=bad)
    with pytest.raises(ParameterError, match="tare 'zero' is not known"):
        log.steady(tare="zero")
    with pytest.raises(ParameterError, match="rotation 'left' is not known"):
        log.steady(rotation="left")
    with pytest.raises(InsufficientDataError, match="never stands still"):
        log.steady(tare="standing")
    with pytest.raises(InsufficientDataError, match="run has 19 rows, but one dwell needs at least 20"):
        log_of(np.ones(19), np.ones(19)).steady()


@pytest.mark.parametrize(("interval", "few"), [(1.0, True), (0.5, False)])
def test_a_slow_logger_is_the_reason_where_dwells_have_few_rows(interval: float, few: bool) -> None:
    """Four speeds of 15 s: 15 rows at 1 Hz are too few, 30 at 2 Hz enough."""
    rows = round(15 / interval)
    speed = np.repeat([20.0, 40.0, 80.0, 160.0], rows) * RPM
    scatter = 1.0 + 0.01 * noise(1, speed.size)
    frame = pl.DataFrame(
        {
            "t [s]": np.arange(speed.size) * interval,
            "torque [N*m]": speed**0.3 * scatter,
            "speed [rad/s]": speed,
        }
    )
    log = hersey.read(frame, isothermal=True)
    if not few:
        assert len(log.steady()) == 4
        return
    with pytest.raises(
        InsufficientDataError, match=r"4 of 4 held speeds have fewer than 20 rows .* every 0\.38 s"
    ):
        log.steady()


def test_a_group_of_temperatures_spans_six_kelvin() -> None:
    def members(*kelvin: float) -> list[list[int]]:
        return [g.tolist() for g in groups_of_temperature(np.array(kelvin))]

    assert members(300.0, 303.0, 306.0) == [[0, 1, 2]]
    assert members(300.0, 304.0, 308.0) == [[0, 1], [2]]  # the whole, not neighbours
    assert members(300.0, 306.1) == [[0], [1]]
    narrow = groups_of_temperature(np.array([300.0, 303.0]), width=2.0)
    assert [g.tolist() for g in narrow] == [[0], [1]]


def test_a_revolution_a_minute() -> None:
    assert rpm(2 * np.pi) == pytest.approx(60.0)


@pytest.mark.parametrize("min_dwell", [2.0, 0.5])
def test_steps_that_are_too_short_at_this_rate_are_counted(min_dwell: float) -> None:
    speed = np.repeat([10.0, 20.0, 40.0, 80.0] * 4, 80) * RPM
    with pytest.raises(InsufficientDataError) as refused:
        log_of(speed, np.ones(speed.size), dt=0.01).steady(min_dwell=min_dwell)
    said = re.search(
        r"in (\d+) steps .* lasts ([\d.]+) s.* more than ([\d.]+) s.* least ([\d.]+) s", str(refused.value)
    )
    assert said
    assert said.groups() == ("16", "0.8", "1", "3" if min_dwell == 2.0 else "2")
    speed = np.repeat([10.0, 20.0, 40.0, 80.0] * 4, round(100 * float(said[4]))) * RPM
    assert len(log_of(speed, np.ones(speed.size), dt=0.01).steady(min_dwell=min_dwell)) == 16


@pytest.mark.parametrize("tare", ["none", "standing"])
def test_a_clock_in_minutes_is_asked_about(tare: str) -> None:
    """A minute at each speed is read as a second: too short for a dwell, and for the zero."""
    speed = dwells(0, 10, 20, 40, 80, seconds=60.0)
    torque = 0.1 * (speed > 0) + 0.001 * np.random.default_rng(1).standard_normal(speed.size)
    assert len(log_of(speed, torque).steady(tare=tare)) == 4
    with pytest.raises(InsufficientDataError, match=r"minutes.*units=\{'time': 'min'\}: 4 dwells"):
        log_of(speed, torque, dt=0.02 / 60.0).steady(tare=tare)
    with pytest.raises(InsufficientDataError) as refused:
        log_of(speed, torque, dt=0.02 / 60e3).steady(tare=tare)
    assert "4 dwells" not in str(refused.value)


def test_a_clock_in_minutes_is_not_proposed_for_a_swing() -> None:
    """Slowed down sixtyfold, the crests of a reciprocating motion last long enough for dwells."""
    speed = 30 * RPM * np.sin(2 * np.pi * 2 * 0.002 * np.arange(30_000))
    assert len(log_of(speed, 0.1 * np.sign(speed), dt=0.12).steady()) > 50
    with pytest.raises(InsufficientDataError, match="no dwell found") as refused:
        log_of(speed, 0.1 * np.sign(speed), dt=0.002).steady()
    assert "minutes" not in str(refused.value)
