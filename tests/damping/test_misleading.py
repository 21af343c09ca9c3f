"""Error structures that bias exponents: the interval holds the truth, or a finding names the cause."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.damping.dwells.misleading import misleading
from hersey.damping.dwells.relaxation import Trend, relaxation
from hersey.damping.dwells.shared_noise import Powers, shared_noise
from hersey.inspection import inspect
from hersey.log.corrections import thermal_lag
from hersey.log.sensors import HYSTERESIS_OF_LARGEST, TEMPERATURE_LAG
from hersey.schema.warning import Warning
from hersey.verdict.warnings import warnings_of
from tests.cli.command import run
from tests.conftest import mostly_nightly
from tests.damping.bench_logs import RPM, B, Bench, C
from tests.damping.test_surface import SPEEDS, points_of

#: A bench quick enough for many logs.
BENCH = Bench(rpm=RPM[::2], celsius=(90.0, 130.0, 170.0, 90.0), dwell=20.0, rate=5.0)
SEEDS = range(12)


def holds(estimate: hersey.Estimate, truth: float) -> bool:
    """Whether the interval and what errors of the sensors may add hold the truth."""
    return estimate.low - estimate.systematic <= truth <= estimate.high + estimate.systematic


def days(
    seed: int, gain: float = 1.05, second: tuple[float, ...] = (140.0, 160.0, 180.0)
) -> hersey.SteadyPoints:
    """Two days with gains of their own."""
    first = replace(BENCH, celsius=(90.0, 110.0, 130.0), spread=0.0).frame(seed)
    later = replace(BENCH, celsius=second, gain=gain, spread=0.0).frame(100 + seed)
    return hersey.read([first, later]).steady(tare="standing")


def found(points: hersey.SteadyPoints, kind: str) -> Warning | None:
    return next((each for each in misleading(points) if each.kind == kind), None)


RISING = replace(BENCH, sweep="up")
LATE = replace(BENCH, lag=20.0, soak=30.0)
STRUCTURES: dict[str, tuple[str, Callable[[int], hersey.SteadyPoints]]] = {
    "hysteresis": ("one direction", replace(RISING, hysteresis=0.01).points),
    "hysteresis of a wide range": ("one direction", replace(RISING, hysteresis=0.01, span=1.5).points),
    "relaxing, rising": ("relaxation", replace(RISING, relaxing=0.2).points),
    "relaxing, up and down": ("relaxation", replace(BENCH, relaxing=0.2).points),
    "relaxing, long dwells": ("relaxation", replace(BENCH, relaxing=0.2, dwell=60.0).points),
    "days": ("unlinked runs", days),
    "lag": ("temperature lag", LATE.points),
    "lag, rising": ("temperature lag", replace(LATE, sweep="up").points),
    "8 bits": ("resolution", replace(BENCH, bits=8, noise=0.001).points),
    "6 bits": ("resolution", replace(BENCH, bits=6).points),
    "50 mN m": ("resolution", replace(BENCH, step=0.05).points),
}


#: One of each kind of finding.
KEPT = ("hysteresis", "relaxing, rising", "days", "lag, rising", "6 bits")


@pytest.mark.usefixtures("one_branch")
@pytest.mark.parametrize("name", mostly_nightly(STRUCTURES, *KEPT))
def test_the_interval_holds_the_truth_and_a_finding_names_the_cause(name: str) -> None:
    kind, points_of = STRUCTURES[name]
    inside = {"c": 0, "b": 0}
    for seed in SEEDS:
        points = points_of(seed)
        surface = hersey.fit(points)
        assert surface.b is not None
        inside["c"] += holds(surface.c, C)
        inside["b"] += holds(surface.b, B)
        structure = found(points, kind)
        assert structure is not None, f"seed {seed}"
        assert structure in warnings_of(points, surface)
    assert min(inside.values()) >= 11, inside


@pytest.mark.parametrize("bench", [BENCH, replace(BENCH, noise=0.02, dwell=10.0)], ids=["quiet", "noisy"])
def test_clean_logs_have_none(bench: Bench) -> None:
    assert sum(not misleading(bench.points(seed)) for seed in range(20)) >= 19


def test_runs_that_share_a_temperature_are_linked() -> None:
    assert found(days(1), "unlinked runs") is not None
    assert found(days(1, second=(130.0, 180.0)), "unlinked runs") is None


def test_speeds_in_both_directions_check_for_hysteresis() -> None:
    assert found(RISING.points(1), "one direction") is not None
    falling = found(replace(BENCH, sweep="down").points(1), "one direction")
    assert falling is not None
    assert falling.number("direction") == -1.0
    assert found(BENCH.points(1), "one direction") is None
    (of_friction,) = (
        each for each in misleading(RISING.points(1), exponents=False) if each.kind == "one direction"
    )
    assert "The intervals do not include it. Also record the speeds on the way down" in of_friction.text


def test_hysteresis_counts_as_a_zero_that_depends_on_direction() -> None:
    """Against a straight line through what a sensor with play would have read."""
    torque = 2.0 * SPEEDS**0.4
    points = points_of(SPEEDS, torque, error=0.01)
    ways = {"from below": ["from below"] * 8, "start": ["start"] * 8}
    rising, unknown = (
        hersey.fit(replace(points, table=points.table.with_columns(approach=pl.Series(way))))
        for way in ways.values()
    )
    by = np.polyfit(np.log(SPEEDS), HYSTERESIS_OF_LARGEST * torque.max() / torque, 1)[0]
    assert rising.c.systematic == pytest.approx(np.hypot(unknown.c.systematic, by), rel=1e-4)
    assert (rising.c.low, rising.c.high) == pytest.approx((unknown.c.low, unknown.c.high))


def test_the_time_constant_of_a_relaxation_is_found() -> None:
    """0.1 of a change of torque, which goes as speed to the power 0.405, is late."""
    for seed in range(4):
        shown = replace(BENCH, rpm=RPM, relaxing=0.1, dwell=60.0).points(seed).relaxation
        assert shown is not None
        assert shown.time == pytest.approx(60.0, rel=0.25)
        assert shown.size == pytest.approx(-0.1 * (1.0 + C), rel=0.25)


def test_a_drift_that_does_not_go_with_the_steps_is_no_relaxation() -> None:
    since, random = np.linspace(0.0, 20.0, 100), np.random.default_rng(1)
    steps = [0.5, -0.5] * 8
    level = 1.0 + 1e-4 * random.standard_normal((16, 100))
    fades = np.exp(-since / 10.0)
    late = [Trend.of(since, y * (1.0 - 0.02 * x * fades), x) for x, y in zip(steps, level, strict=True)]
    drifting = [Trend.of(since, y * (1.0 + 0.001 * since), x) for x, y in zip(steps, level, strict=True)]
    shown = relaxation(late)
    assert shown is not None
    assert shown.time == pytest.approx(10.0, rel=0.15)
    assert shown.left == pytest.approx(-0.02 * np.array(steps) * fades.mean(), rel=0.1)
    assert relaxation(drifting) is None
    assert relaxation([replace(trend, isothermal=False) for trend in late]) is None


def test_lag_counts_where_the_temperature_changes() -> None:
    points = LATE.points(1)
    structure = found(points, "temperature lag")
    assert structure is not None
    assert structure.number("off") == pytest.approx(
        TEMPERATURE_LAG * np.max(np.abs(points.temperature_rates))
    )
    assert structure.number("off") > 2.0
    steady = replace(points, temperature_rates=np.zeros(len(points)))
    with_lag, without = hersey.fit(points), hersey.fit(steady)
    assert with_lag.c.systematic > 1.05 * without.c.systematic
    assert with_lag.c.value == without.c.value


def test_a_lag_that_is_corrected_is_not_reported() -> None:
    corrected = thermal_lag(LATE.log(1), time_constant=20.0)
    log = replace(corrected.log, corrections=corrected.corrections)
    assert found(log.steady(tare="standing"), "temperature lag") is None


@pytest.mark.parametrize(
    ("bits", "noise"),
    mostly_nightly(
        [(bits, noise) for bits in (3, 5, 8) for noise in (0.0, 0.001, 0.004)],
        (3, 0.0),
        (5, 0.004),
        (8, 0.001),
    ),
)
def test_coarse_torque_never_ends_in_a_traceback(bits: int, noise: float) -> None:
    for seed in range(3):
        points = replace(BENCH, bits=bits, noise=noise).points(seed)
        assert [each.quantity for each in points.resolutions] == ["torque"]
        assert hersey.fit(points).statistics.points == len(points)
    assert hersey.compare_models(points, bootstrap=0, cross_validate=False).chosen.fit.values.size


def test_inspection_names_the_resolution(tmp_path: Path) -> None:
    path = tmp_path / "coarse.csv"
    replace(BENCH, bits=6).frame(1).write_csv(path)
    said = inspect(path, tare="standing").warnings
    assert sum("resolution of" in each.text for each in said) == 1


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("command", ["inspect", "fit", "models"])
def test_commands_take_coarse_torque(tmp_path: Path, command: str) -> None:
    replace(BENCH, bits=5, noise=0.0).frame(1).write_csv(tmp_path / "coarse.csv")
    more = ["--bootstrap", "0"] if command == "models" else []
    done = run(command, "coarse.csv", "--tare", "standing", *more, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "Torque is recorded with a resolution of" in done.words + done.stderr


def test_a_dwell_whose_only_power_is_ripple_has_a_noise() -> None:
    """Readings that flip between two steps of the sensor may hold one wave alone."""
    random = np.random.default_rng(2)
    dwells = [Powers.of(random.standard_normal(200), 0.1) for _ in range(8)]
    flips = replace(dwells[0], power=np.where(np.arange(dwells[0].power.size) == 9, 50.0, 0.0))
    noise = shared_noise([*dwells, flips])
    assert noise is None or np.isfinite(noise.mean_error(flips))
