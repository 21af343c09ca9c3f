"""What kind of motion a trace shows, whatever slips are counted: motion integrated here, and a slider."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.signal import lfilter

from hersey.errors import InsufficientDataError
from hersey.identification import CycleRecord, cycles, drive_warnings, identify
from hersey.identification.motion_kind import LONGEST_OF_LAP, NO_FREE_PERIOD
from hersey.identification.trace_file import read_trace
from tests.conftest import shared
from tests.identification.two_states import Truth

#: The belt hardly sticks, or not quite: the period is 1.09 to 1.05 times the free one.
NEARLY_INERTIAL = (1.6, 2.0, 2.16)


@cache
def quiet(drive_speed: float, samples: int) -> tuple[np.ndarray, np.ndarray]:
    return replace(Truth(), drive_speed=drive_speed).trace(0, noise=0.0, samples=samples)


def record(
    drive_speed: float,
    *,
    samples: int = 254,
    noise: float = 0.0,
    memory: float = 0.0,
    least_drop: float | None = None,
) -> CycleRecord:
    """90 laps with noise, a share of the fall, of which each sample remembers so much of the last."""
    times, force = quiet(drive_speed, samples)
    white = np.random.default_rng(1).normal(size=force.size)
    slow = lfilter([np.sqrt(1 - memory**2)], [1, -memory], white)
    return cycles(times, force + noise * np.ptp(force) * slow, drive_speed=drive_speed, least_drop=least_drop)


@pytest.mark.parametrize("drive_speed", NEARLY_INERTIAL)
@pytest.mark.parametrize(
    ("samples", "noise", "memory"),
    [(20, 0.05, 0.0), (254, 0.0, 0.0), (254, 0.2, 0.0), (254, 0.1, 0.9), (2000, 0.02, 0.9), (2000, 0.2, 0.9)],
)
def test_nearly_inertial_motion_is_found(
    drive_speed: float, samples: int, noise: float, memory: float
) -> None:
    """At default settings, with white and with slower noise; the free period is near the truth."""
    found = record(drive_speed, samples=samples, noise=noise, memory=memory)
    assert found.kind in ("inertial", "stick_slip")
    assert found.slips == pytest.approx(90, abs=3)
    assert found.free_period == pytest.approx(Truth().free_period, rel=0.12)


def test_slower_noise_is_said() -> None:
    found = record(1.6, samples=2000, noise=0.1, memory=0.9).warnings
    (slower,) = (each for each in found if each.kind == "slower noise")
    assert "drops exceed the sample-to-sample noise but have no rhythm" in str(slower)
    assert slower.values["falls"] > 90


@pytest.mark.parametrize("memory", [0.0, 0.5, 0.9, 0.99, 1.0])
def test_noise_alone_is_no_cycle(memory: float) -> None:
    for seed in range(5):
        white = np.random.default_rng(seed).normal(size=20_000)
        slow = np.cumsum(white) if memory == 1.0 else lfilter([1.0], [1.0, -memory], white)
        found = cycles(np.arange(20_000) * 1e-3, slow)
        assert found.kind == "steady_sliding", seed
        assert np.isnan(found.free_period)
        if found.falls >= 3:
            assert found.headline() == f"irregular force: {found.falls} drops exceed the noise, but no cycles"


@pytest.mark.parametrize("least_drop", [1.0, 30.0, 100.0, 137.0, 1000.0])
def test_the_kind_does_not_hang_on_the_least_drop(least_drop: float) -> None:
    for drive_speed in (1.0, 2.16):
        plain = record(drive_speed, noise=0.01)
        counted = record(drive_speed, noise=0.01, least_drop=least_drop)
        assert plain.kind == "stick_slip"
        assert counted.motion == plain.motion
    time = np.arange(20_000) * 1e-3
    sine = 50 * np.sin(2 * np.pi * time / 0.2) * (1 + 0.3 * np.sin(time))
    assert cycles(time, sine, least_drop=least_drop).kind == "inertial"


def test_falls_that_are_not_counted_are_said() -> None:
    times, force = quiet(1.0, 254)
    none = cycles(times, force / 1000, least_drop=0.2, drive_speed=1.0)
    assert none.summary("1").splitlines()[0] == (
        f"stick slip: {none.falls} drops exceed the noise, none of at least 20 % of the load; "
        "the largest is 13.6 % of the load"
    )
    assert "none of at least 0.2 N" in none.summary("N")
    with pytest.raises(InsufficientDataError, match="omit least_drop"):
        identify(none)


def test_free_periods_are_plausible_or_not_given() -> None:
    """A fall of two samples is not timed; one that is slower than half a lap is no free fall."""
    time = np.arange(6000) * 0.01
    sudden = time % 1.0
    record = cycles(time, sudden)
    assert record.kind == "stick_slip"
    assert np.isnan(record.free_period)
    assert record.to_dict()["free_period"] is None
    assert "free period" not in record.summary().splitlines()[1]
    assert any(each.kind == NO_FREE_PERIOD and each.values["samples"] < 3.0 for each in record.warnings)
    slow = cycles(time, np.interp(time % 1.0, [0.0, 0.15, 0.3, 1.0], [0.0, 1.0, 1.0, 0.0]))
    (longer,) = (each for each in slow.warnings if each.kind == NO_FREE_PERIOD)
    assert longer.values["free"] > LONGEST_OF_LAP * longer.values["lap"]
    assert longer.values["lap"] == pytest.approx(1.0, rel=1e-3)
    assert "longer than the cycle" in str(longer)
    assert np.isnan(slow.free_period)


def test_gaps_in_every_lap_part_all_falls() -> None:
    time = np.arange(24_000) * 0.01
    force = np.interp(time % 2.0, [0.0, 1.4, 2.0], [0.0, 10.0, 0.0])
    kept = (time % 2.0 < 0.5) | (time % 2.0 > 0.9)
    record = cycles(time[kept], force[kept])
    assert record.falls > 100
    assert "no cycles" not in record.summary().splitlines()[0] or "drops exceed the noise" in record.summary()
    assert "gaps part the falls" in [each.kind for each in record.warnings]


@pytest.mark.parametrize(("speed", "kind"), [(1100, "stick_slip"), (4300, "inertial")])
def test_the_slider_is_the_same_at_every_least_drop(speed: int, kind: str) -> None:
    trace = read_trace(shared(f"data/stick-slip/k1002Nm_v{speed}.mat"), time_unit="s", unit="1")
    for least_drop in (None, 0.02, 0.05, 0.08, 0.12, 0.2, 0.5):
        found = cycles(trace.time, trace.value, drive_speed=speed * 1e-6, least_drop=least_drop)
        assert found.kind == kind, least_drop
        assert "no cycles" not in found.summary("1")
        assert 0.5 < found.free_period / 0.03478 < 1.3  # 2 pi sqrt(30.7 g / 1002 N/m)
    assert "drops exceed the noise, none of at least 50 % of the load" in found.summary("1")


def test_a_fitted_free_period_is_plausible_or_taken_back(monkeypatch: pytest.MonkeyPatch) -> None:
    told = identify(record(1.0, noise=0.01), known={"stick_speed": 0.01}, closures=("retained",))
    assert told.derived["free_period"].low < Truth().free_period < told.derived["free_period"].high
    monkeypatch.setattr(drive_warnings, "LONGEST_OF_LAP", 0.5)
    taken = identify(record(1.0, noise=0.01), known={"stick_speed": 0.01}, closures=("retained",))
    assert "free_period" not in taken.derived
    (why,) = (each for each in taken.warnings if each.kind == NO_FREE_PERIOD)
    assert why.values["free"] == told.derived["free_period"].value
    assert str(why).startswith("no free period is reported, because 0.19")
