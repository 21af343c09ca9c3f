"""Cycles of a trace: against the exact motion, with noise, drift and gaps, and against foreign data."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import InsufficientDataError, ParameterError
from hersey.identification import CycleRecord, cycles, identify
from hersey.identification.trace_file import read_trace
from tests.conftest import ROOT, shared

TRAIN = hersey.Drivetrain(1000, 1)
FREE_PERIOD = 2 * np.pi / np.sqrt(1000)


def drag(closure: str = "retained") -> hersey.Drag:
    return hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01, closure=closure)


def trace(speed: float, closure: str = "retained", duration: float = 20.0) -> tuple[np.ndarray, np.ndarray]:
    """Time and force of the exact motion after its transient, at 1 kHz."""
    samples = int(1000 * duration) + 1
    run = hersey.simulate(TRAIN, drag(closure), drive_speed=speed, duration=duration, samples=samples)
    kept = run.time > 2.0
    return run.time[kept], run.spring_force[kept]


@pytest.mark.parametrize("noise", [0.0, 3.0])
@pytest.mark.parametrize(
    ("speed", "closure"), [(0.4, "retained"), (1.0, "retained"), (1.9, "retained"), (1.0, "stiction")]
)
def test_figures_of_the_exact_motion(speed: float, closure: str, noise: float) -> None:
    """Period to 0.1 %, stiffness and free period to 3 %, stuck fraction to 0.04, turns to 1 % of the drop."""
    times, force = trace(speed, closure)
    truth = hersey.stick_slip(TRAIN, drag(closure), drive_speed=speed)
    noisy = force + np.random.default_rng(1).normal(0, noise, force.size)
    record = cycles(times, noisy, drive_speed=speed)
    assert record.kind == "stick_slip"
    assert abs(record.slips - (times[-1] - times[0]) * truth.frequency) <= 2
    assert np.median(record.period) == pytest.approx(1 / truth.frequency, rel=1e-3)
    assert record.stuck_fraction == pytest.approx(truth.stuck_fraction, abs=0.04)
    assert record.stiffness == pytest.approx(1000, rel=0.03)
    assert record.free_period == pytest.approx(FREE_PERIOD, rel=0.03)
    near = 10 * (truth.stretch_max - truth.stretch_min)
    assert np.median(record.force_max) == pytest.approx(1000 * truth.stretch_max, abs=near)
    assert np.median(record.force_min) == pytest.approx(1000 * truth.stretch_min, abs=near)


def test_steady_sliding_is_no_cycle() -> None:
    """White noise, noise on a drift, and noise on a random walk."""
    rng = np.random.default_rng(2)
    times = np.arange(20_000) * 1e-3
    for force in (
        50 + rng.normal(0, 1, times.size),
        50 + 0.3 * times + rng.normal(0, 1, times.size),
        50 + 0.2 * np.cumsum(rng.normal(0, 1, times.size)) + rng.normal(0, 1, times.size),
    ):
        assert cycles(times, force).kind == "steady_sliding"


def test_stick_slip_that_is_sampled_too_slowly_is_not_called_steady() -> None:
    """Every 50th sample of the shipped trace, a little more than one per cycle."""
    whole = read_trace(ROOT / "examples" / "stick-slip.csv")
    slow = cycles(whole.time[::50], whole.value[::50], drive_speed=0.02)
    kinds = [each.kind for each in slow.warnings]
    assert (slow.kind, slow.falls >= 3) == ("steady_sliding", True)
    assert "falls of few samples" in kinds
    assert "sign may be turned" not in kinds  # it is not: sampling makes the rises and falls
    with pytest.raises(InsufficientDataError) as refused:
        identify(slow)
    assert refused.value.reason.startswith(f"the trace is irregular: {slow.falls} drops exceed the noise")
    assert refused.value.remedy.startswith("a drop lasts only 3.9 samples. Sample faster")
    turned = cycles(whole.time[::8], -whole.value[::8])
    assert (turned.kind, "sign may be turned" in [each.kind for each in turned.warnings]) == (
        "inertial",
        True,
    )


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_a_sine_is_inertial(noise: float) -> None:
    times = np.arange(20_000) * 1e-3
    force = np.sin(2 * np.pi * times / 0.2) + np.random.default_rng(3).normal(0, noise, times.size)
    record = cycles(times, force)
    assert record.kind == "inertial"
    assert record.slips == pytest.approx(100, abs=2)
    assert record.free_period == pytest.approx(0.2, rel=0.03)
    assert record.loading_slope == pytest.approx(2 * np.pi / 0.2, rel=0.03)


def test_gaps_drift_and_spikes_change_no_figure() -> None:
    """A tenth of the samples missing in four gaps, single samples lost, a drift of a drop, spikes."""
    times, force = trace(1.0)
    rng = np.random.default_rng(4)
    force = force + rng.normal(0, 2.0, force.size) + 135 * (times / times[-1])
    force[rng.choice(force.size, 60, replace=False)] += 200
    force[rng.choice(force.size, 300, replace=False)] = np.nan
    kept = np.ones(times.size, dtype=bool)
    for first in (2000, 6000, 9500, 14_000):
        kept[first : first + 450] = False
    record = cycles(times[kept], force[kept], drive_speed=1.0)
    truth = hersey.stick_slip(TRAIN, drag(), drive_speed=1.0)
    assert record.samples.missing >= 4 * 449
    assert record.samples.spikes >= 50
    assert np.median(record.period) == pytest.approx(1 / truth.frequency, rel=2e-3)
    assert np.max(record.period) < 1.2 / truth.frequency
    assert record.stiffness == pytest.approx(1000, rel=0.04)
    assert record.drift * (times[-1] - times[0]) == pytest.approx(135 * 0.9, rel=0.1)


def test_uneven_times_are_laid_on_even_ones() -> None:
    times, force = trace(1.0)
    rng = np.random.default_rng(5)
    shaken = times + rng.uniform(-0.3e-3, 0.3e-3, times.size)
    record = cycles(shaken, np.interp(shaken, times, force), drive_speed=1.0)
    assert record.slips == cycles(times, force).slips
    assert record.stiffness == pytest.approx(1000, rel=0.03)


def test_a_trace_of_speed_has_the_same_cycles() -> None:
    run = hersey.simulate(TRAIN, drag(), drive_speed=1.0, duration=20, samples=20_001)
    kept = run.time > 2.0
    force = cycles(run.time[kept], run.spring_force[kept])
    speed = cycles(run.time[kept], run.belt_speed[kept], quantity="speed", drive_speed=1.0)
    assert speed.kind == "stick_slip"
    assert speed.slips == pytest.approx(force.slips, abs=1)
    assert np.median(speed.period) == pytest.approx(np.median(force.period), rel=1e-3)
    assert np.median(speed.drop) * 1000 == pytest.approx(np.median(force.drop), rel=0.02)
    assert speed.stiffness is None


def test_a_turned_sign_is_noticed() -> None:
    times, force = trace(1.0, "stiction")
    assert "sign may be turned" in [each.kind for each in cycles(times, -force).warnings]


def test_bad_traces_are_refused() -> None:
    times = np.arange(100) * 0.01
    with pytest.raises(ParameterError, match="does not ascend"):
        cycles(np.where(times == times[50], 0.1, times), times)
    with pytest.raises(ParameterError, match="equal lengths"):
        cycles(times, times[:-1])
    with pytest.raises(InsufficientDataError, match="10 samples"):
        cycles(times[:10], times[:10])
    with pytest.raises(InsufficientDataError, match="most of the trace is missing"):
        cycles(np.concatenate([times, times + 1e4]), np.tile(times, 2))
    with pytest.raises(ParameterError, match="least_drop is -1"):
        cycles(times, times, least_drop=-1)
    with pytest.raises(ParameterError, match="drive_speed is NaN"):
        cycles(times, times, drive_speed=float("nan"))


def slider(speed: int, least_drop: float | None = 0.05) -> CycleRecord:
    """The spring-pulled slider, drive speed in um/s (Colas et al., Phys. Rev. E 2019)."""
    path = shared(f"data/stick-slip/k1002Nm_v{speed}.mat")
    found = read_trace(path, time_unit="s", unit="1")
    return cycles(found.time, found.value, drive_speed=speed * 1e-6, least_drop=least_drop)


@pytest.mark.parametrize(
    ("speed", "kind", "slips", "period", "drop"),
    [
        (42, "stick_slip", 477, 0.72, 0.089),
        (1100, "stick_slip", 206, 0.0555, 0.075),
        (4300, "inertial", 130, 0.0285, 0.128),
    ],
)
def test_spring_pulled_slider(speed: int, kind: str, slips: int, period: float, drop: float) -> None:
    """Slips of at least 0.05 of the weight: number, period and fall within 5 % of the known."""
    record = slider(speed)
    assert record.kind == kind
    assert record.slips == pytest.approx(slips, rel=0.05)
    assert np.median(record.period) == pytest.approx(period, rel=0.05)
    assert np.median(record.drop) == pytest.approx(drop, rel=0.05)


@pytest.mark.parametrize("least_drop", [None, 0.05])
def test_loading_slope_of_the_slider(least_drop: float | None) -> None:
    """0.1393 1/s within 1 %, which is also k v/(m g) of the apparatus; whatever slips are counted."""
    assert slider(42, least_drop).loading_slope == pytest.approx(0.1393, rel=0.01)


def test_kinds_of_the_slider_do_not_hang_on_the_slips_counted() -> None:
    assert [slider(speed, None).kind for speed in (42, 1100, 4300)] == [
        "stick_slip",
        "stick_slip",
        "inertial",
    ]


def test_the_count_says_what_it_depends_on() -> None:
    record = slider(1100, None)
    assert record.slips > 300
    assert "many small slips" in [each.kind for each in record.warnings]


def test_a_million_samples_take_about_a_second(tmp_path: Path) -> None:  # noqa: ARG001
    """0.3 s on an idle core; the bound leaves room for a busy machine."""
    times = np.arange(1_000_000) * 5e-4
    force = (times % 0.7) + np.random.default_rng(6).normal(0, 0.01, times.size)
    started = time.process_time()
    record = cycles(times, force)
    assert time.process_time() - started < 2.0
    assert record.slips == pytest.approx(500 / 0.7, abs=2)
