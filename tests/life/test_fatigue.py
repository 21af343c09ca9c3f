"""Cycles counted and damage summed: published cases, sums by hand, invariants."""

from __future__ import annotations

import csv
import json
import math
from collections import defaultdict

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hersey
from hersey.errors import HerseyError, InsufficientDataError, ParameterError, UnitError
from hersey.life.fatigue import (
    RainflowCycles,
    SNCurve,
    damage_rate,
    life_of,
    miner_damage,
    rainflow_cycles,
    stick_slip_damage_rate,
)
from tests.conftest import shared

CURVE = SNCurve(20.0, 2e6, 5.0)
#: Whole numbers, so that sums and halves are exact.
SIGNALS = st.lists(st.integers(-50, 50), min_size=2, max_size=60).map(lambda s: np.array(s, dtype=float))


def totals(cycles: RainflowCycles) -> dict[float, float]:
    """Counts of each range."""
    found: dict[float, float] = defaultdict(float)
    for size, count in zip(cycles.ranges.tolist(), cycles.counts.tolist(), strict=True):
        found[size] += count
    return dict(found)


def block(amplitude: float, count: int, mean: float = 0.0) -> RainflowCycles:
    return RainflowCycles(np.array([2 * amplitude]), np.array([mean]), np.array([float(count)]))


def test_published_counts() -> None:
    cases = json.loads(shared("data/tables/rainflow_reference_cases.json").read_text())
    astm = cases["ASTM_E1049_fig6"]
    cycles = rainflow_cycles(astm["series"])
    rows = zip(cycles.ranges.tolist(), cycles.means.tolist(), cycles.counts.tolist(), strict=True)
    assert sorted(rows) == sorted(tuple(row[:3]) for row in astm["cycles_range_mean_count_i0_i1"])
    for name in ("ASTM_E1049_fig6", "rainflow_case2"):
        expected = {float(size): count for size, count in cases[name]["range_counts"].items()}
        assert totals(rainflow_cycles(cases[name]["series"])) == expected


def test_published_counts_of_a_residue() -> None:
    """Fatpack takes closed cycles out, and lays the residue behind itself to close what is left."""
    case = json.loads(shared("data/tables/rainflow_reference_cases.json").read_text())["fatpack_reversals"]
    closed: dict[float, float] = defaultdict(float)
    for low, high in [*case["closed_cycles"], *case["residue_cycles"]]:
        closed[float(abs(high - low))] += 1.0
    assert totals(rainflow_cycles(case["reversals"], repeating=True)) == dict(closed)


def test_published_lives() -> None:
    """Eurocode curves of fatpack in stress range, at 2e6 cycles; only ratios count, so that units do not."""
    rows = list(csv.DictReader(shared("data/tables/fatpack_SN_endurance_values.csv").open()))
    assert {row["curve"] for row in rows} == {"Linear", "BiLinear", "TriLinear"}
    for row in rows:
        category, load = float(row["Sc_detail_category_MPa"]), float(row["stress_range_MPa"])
        knee = category * (2 / 5) ** (1 / 3)
        curve = {
            "Linear": SNCurve(category, 2e6, 5),
            "BiLinear": SNCurve(knee, 5e6, 3, second_slope=5),
            "TriLinear": SNCurve(knee, 5e6, 3, second_slope=5, endurance=knee * (5 / 100) ** (1 / 5)),
        }[row["curve"]]
        assert float(curve.life(load)) == pytest.approx(float(row["endurance_cycles"]), rel=1e-12)


def test_constant_amplitude_by_hand() -> None:
    """At twice 20 N m and slope 5 the life is 2e6 / 32 = 62,500: 25,000 cycles take 0.4 of it."""
    assert miner_damage(block(40.0, 25_000), CURVE) == pytest.approx(0.4, rel=1e-14)
    swing = np.tile([40.0, -40.0], 500)
    assert damage_rate(swing, 500.0, CURVE) == pytest.approx(1 / 62_500, rel=1e-14)
    assert life_of(damage_rate(swing, 500.0, CURVE)) == pytest.approx(62_500, rel=1e-14)


def test_two_blocks_by_hand() -> None:
    """25,000 cycles at 40 N m (0.4) and 486,000 at 10 N m, for which each rule has its own life."""
    both = RainflowCycles(np.array([80.0, 20.0]), np.zeros(2), np.array([25_000.0, 486_000.0]))
    for curve, life in (
        (CURVE, 64e6),  # 2e6 * 2^5
        (SNCurve(20.0, 2e6, 5.0, second_slope="haibach"), 1024e6),  # 2e6 * 2^9
        (SNCurve(20.0, 2e6, 5.0, endurance=20.0), math.inf),
    ):
        assert miner_damage(both, curve) == pytest.approx(0.4 + 486_000 / life, rel=1e-14)


def test_the_endurance_limit_itself_still_harms() -> None:
    curve = SNCurve(20.0, 2e6, 5.0, endurance=20.0)
    assert curve.life([20.0, 19.999]).tolist() == [2e6, math.inf]


def test_the_mean_by_goodman() -> None:
    """30 N m about 25 N m with 100 N m at the most harm as 40 N m about zero, in either direction."""
    curve = SNCurve(20.0, 2e6, 5.0, ultimate=100.0)
    assert curve.life(30.0, 25.0) == pytest.approx(62_500)
    assert curve.life(30.0, -25.0) == pytest.approx(62_500)
    assert CURVE.life(30.0, 25.0) == CURVE.life(30.0)
    with pytest.raises(ParameterError, match="breaks at once"):
        curve.life(60.0, 40.0)


def test_the_ratio_of_a_gear() -> None:
    assert miner_damage(block(10.0, 100), CURVE, ratio=4.0) == miner_damage(block(40.0, 100), CURVE)


@settings(max_examples=150, deadline=None)
@given(SIGNALS, st.sampled_from([0.25, 2.0, 1024.0]))
def test_scaling_and_reversal(signal: np.ndarray, factor: float) -> None:
    cycles = totals(rainflow_cycles(signal))
    assert totals(rainflow_cycles(factor * signal)) == {factor * size: n for size, n in cycles.items()}
    assert totals(rainflow_cycles(-signal)) == cycles
    scaled = miner_damage(rainflow_cycles(factor * signal), CURVE)
    assert scaled == pytest.approx(factor**5 * miner_damage(rainflow_cycles(signal), CURVE), rel=1e-12)


@settings(max_examples=150, deadline=None)
@given(SIGNALS, st.booleans())
def test_the_largest_range_is_kept(signal: np.ndarray, repeating: bool) -> None:
    cycles = rainflow_cycles(signal, repeating=repeating)
    assert cycles.ranges.max(initial=0.0) == np.ptp(signal)
    assert set(cycles.counts) <= {0.5, 1.0}


@settings(max_examples=150, deadline=None)
@given(SIGNALS, st.integers(2, 5))
def test_repeats(signal: np.ndarray, repeats: int) -> None:
    """Round from its highest peak a signal's cycles close, and n repeats have n times as many."""
    once = totals(rainflow_cycles(signal, repeating=True))
    many = np.tile(signal, repeats)
    assert totals(rainflow_cycles(many, repeating=True)) == {size: repeats * n for size, n in once.items()}
    assert all(count == int(count) for count in once.values())
    rate = damage_rate(signal, 1.0, CURVE)
    counted = miner_damage(rainflow_cycles(many), CURVE)
    assert (repeats - 1) * rate * (1 - 1e-9) <= counted <= repeats * rate * (1 + 1e-9)


@settings(max_examples=100, deadline=None)
@given(SIGNALS)
def test_all_ways_are_counted(signal: np.ndarray) -> None:
    """Every rise and fall belongs to one cycle: twice ranges by counts is the length of the way."""
    cycles = rainflow_cycles(signal)
    assert 2 * np.sum(cycles.ranges * cycles.counts) == np.sum(np.abs(np.diff(signal)))


def test_short_and_flat_signals() -> None:
    assert totals(rainflow_cycles([0.0, 10.0])) == {10.0: 0.5}
    assert totals(rainflow_cycles([0.0, 10.0, 10.0, 0.0])) == {10.0: 1.0}
    assert rainflow_cycles([3.0] * 9).counts.size == 0
    assert damage_rate([3.0] * 9, 1.0, CURVE) == 0.0
    assert life_of(0.0) == math.inf


def test_stick_slip_without_a_signal() -> None:
    """The damage of a settled cycle is that of its spring torque over time."""
    train = hersey.Drivetrain(1000.0, 1.0)
    drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    cycle = hersey.stick_slip(train, drag, drive_speed=1.0)
    curve = SNCurve(2.0, 1e6, 5.0, ultimate=10.0)
    run = hersey.simulate(
        train, drag, drive_speed=1.0, duration=20.5 / cycle.frequency, samples=40_001, start="rest"
    )
    late = run.time > 10.25 / cycle.frequency
    torque = run.spring_force[late] * 0.02
    told = stick_slip_damage_rate(cycle, train, curve, roll_radius=0.02, ratio=1.5)
    signal = damage_rate(torque, 10.25 / cycle.frequency, curve, ratio=1.5)
    assert told == pytest.approx(signal, rel=0.06)  # ten and a quarter laps hold ten or eleven peaks
    smooth = hersey.stick_slip(train, drag, drive_speed=5.0)
    assert smooth.frequency == 0
    assert stick_slip_damage_rate(smooth, train, curve, roll_radius=0.02) == 0.0


def test_units_at_the_door() -> None:
    assert SNCurve("20000 mN*m", 2e6, 5.0) == CURVE
    assert damage_rate([1.0, -1.0], "1 min", CURVE) == damage_rate([1.0, -1.0], 60.0, CURVE)
    with pytest.raises(UnitError, match="amplitude"):
        SNCurve("20 N", 2e6, 5.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: SNCurve(0.0, 2e6, 5.0), "amplitude is 0"),
        (lambda: SNCurve(20.0, math.nan, 5.0), "cycles is NaN"),
        (lambda: SNCurve(20.0, 2e6, None), "slope is None"),  # type: ignore[arg-type]
        (lambda: SNCurve(20.0, 2e6, 5.0, second_slope=3.0), "at least the slope"),
        (lambda: SNCurve(20.0, 2e6, 5.0, second_slope="miner"), "it must be a number or 'haibach'"),
        (lambda: SNCurve(20.0, 2e6, 5.0, endurance=30.0), "above the point"),
        (lambda: SNCurve(20.0, 2e6, 5.0, ultimate=10.0), "at once"),
        (lambda: CURVE.life(-1.0), "not negative"),
        (lambda: rainflow_cycles([1.0, math.nan, 2.0]), "sample 1"),
        (lambda: rainflow_cycles([]), "empty"),
        (lambda: rainflow_cycles([[1.0, 2.0]]), "2 dimensions"),
        (lambda: rainflow_cycles(["a"]), "not a number"),
        (lambda: damage_rate([1.0, 2.0], 0.0, CURVE), "duration is 0"),
        (lambda: miner_damage(block(1.0, 1), CURVE, ratio=-1.0), "ratio is -1"),
        (lambda: life_of(-1.0), "rate is -1"),
        (lambda: damage_rate([1.0], 1.0, CURVE), "fewer than two"),
    ],
)
def test_what_is_refused(call: object, words: str) -> None:
    with pytest.raises(HerseyError, match=words) as told:
        call()  # type: ignore[operator]
    assert isinstance(told.value, ParameterError | InsufficientDataError)


def test_what_is_spent_is_taken_off() -> None:
    assert life_of(0.01, spent=0.4) == pytest.approx(60.0)
    assert life_of(0.01, spent=0.4, limit=0.3) == 0.0


@pytest.mark.slow
def test_a_peer_agrees() -> None:
    """Another package counts and sums by code of its own: `pyLife`, with one slope and with two."""
    pytest.importorskip("pylife")
    import pandas as pd
    import pylife.strength.fatigue  # noqa: F401 - it adds accessors
    from pylife.stress.rainflow import FourPointDetector, LoopValueRecorder

    signal = np.random.default_rng(4).normal(0.0, 12.0, 3000).cumsum() * 0.2
    signal -= signal.mean()
    peak = int(np.argmax(signal))
    round_ = np.append(np.roll(signal, -peak), signal[peak])
    recorder = LoopValueRecorder()
    detector = FourPointDetector(recorder=recorder).process(round_)
    loops = np.abs(np.subtract(recorder.values_from, recorder.values_to))
    rest = np.abs(np.diff(detector.residuals))
    mine = rainflow_cycles(signal, repeating=True)
    # Peak to valley to peak is left over: the greatest cycle, in two halves.
    ranges, counts = np.append(loops, rest), np.append(np.ones(loops.size), np.full(rest.size, 0.5))
    order = np.argsort(ranges)
    full = np.repeat(mine.ranges, (2 * mine.counts).astype(int))
    assert np.sort(full) == pytest.approx(np.repeat(ranges[order], (2 * counts[order]).astype(int)))
    for second in (None, "haibach"):
        curve = SNCurve(20.0, 2e6, 5.0, second_slope=second)
        peer = pd.Series({"k_1": 5.0, "ND": 2e6, "SD": 20.0, "k_2": 9.0 if second else 5.0})
        lives = peer.woehler.cycles(mine.amplitudes)
        assert miner_damage(mine, curve) == pytest.approx(float(np.sum(mine.counts / lives)), rel=1e-12)
