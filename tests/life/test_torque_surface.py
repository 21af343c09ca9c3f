"""The torque of a run between its dwells: against the truth of specimens that age, and of few dwells."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
import pytest

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.indicators.shared_kernel import shared_kernel
from hersey.life.indicators.torque_surface import Kernel, RunDwells, TorqueSurface
from hersey.testbench import population
from hersey.testbench.ageing import AgedTruth
from hersey.testbench.campaign import STAND
from hersey.testbench.drive import example_drive
from hersey.testbench.truth import RPM
from hersey.units import ZERO_CELSIUS

AGES = (0.0, 35e3, 70e3, 105e3, 140e3, 170e3)
#: The cold fast and the hot slow corner: rad/s, degC.
CORNERS = np.array([0.2, 0.045]) / 0.015, np.array([60.0, 180.0])


def dwells_of(truth: AgedTruth, seed: int, limit: float = 1.0) -> RunDwells:
    """What the stand of a campaign measures; a dwell that takes more than the motor has stalls."""
    speeds = np.array([*STAND.speeds_rpm, *STAND.speeds_rpm[-2::-1]]) * RPM
    speed, level = (np.ravel(each) for each in np.meshgrid(speeds, STAND.temperatures_degC))
    whole = truth.torque(speed, level)
    noise = STAND.repeatability * np.random.default_rng(seed).standard_normal(whole.size)
    shown = whole * (1.0 + noise)
    belt = shown - truth.rest.torque(speed, temperature=level + ZERO_CELSIUS)
    run = RunDwells(speed, level + ZERO_CELSIUS, belt, shown, STAND.repeatability * shown)
    return only(run, whole <= limit)


def only(run: RunDwells, keep: FloatArray | slice) -> RunDwells:
    return RunDwells(*(values[keep] for values in vars(run).values()))


@cache
def aged() -> tuple[list[AgedTruth], list[RunDwells], Kernel]:
    """All 48 runs of the specimens that ship, and their kernel."""
    units = population(*example_drive(), units=8, seed=3)
    truths = [unit.at(age) for unit, age in product(units, AGES)]
    runs = [dwells_of(truth, seed) for seed, truth in enumerate(truths)]
    return truths, runs, shared_kernel(runs)


def test_errors_at_both_corners_are_as_said() -> None:
    """Errors over their standard errors, of all specimens and ages, are about normal."""
    truths, runs, kernel = aged()
    normal = []
    for truth, run in zip(truths, runs, strict=True):
        found = TorqueSurface(run, kernel).at(CORNERS[0], CORNERS[1] + ZERO_CELSIUS)
        belt = truth.torque(*CORNERS) - truth.rest.torque(CORNERS[0], temperature=CORNERS[1] + ZERO_CELSIUS)
        normal.append(np.log(found.torque / belt) / found.error)
    errors = np.array(normal)
    assert np.all(np.abs(errors.mean(axis=0)) < 0.45)  # three standard errors of a mean of 48
    assert np.all((errors.std(axis=0) > 0.7) & (errors.std(axis=0) < 1.3))
    assert np.all(np.abs(errors) < 4.0)


def test_the_cold_corner_of_an_old_unit_where_it_stalls() -> None:
    """The power law of all dwells tells half of it; beyond the last dwell the error grows, and says so."""
    truths, runs, kernel = aged()
    old = 3 * len(AGES) + 5
    assert runs[old].speed.size < runs[0].speed.size
    at, where = TorqueSurface(runs[old], kernel), (CORNERS[0][:1], CORNERS[1][:1] + ZERO_CELSIUS)
    found = at.at(*where)
    rest = truths[old].rest.torque(where[0], temperature=where[1])
    assert found.torque + rest == pytest.approx(truths[old].torque(CORNERS[0][:1], CORNERS[1][:1]), rel=0.06)
    assert found.outside.tolist() == [True]
    assert found.factor == pytest.approx([1.34], abs=0.01)
    inside = TorqueSurface(runs[old - 1], kernel).at(*where)
    assert inside.outside.tolist() == [False]
    assert found.error[0] > 2.0 * inside.error[0]
    # without the dwells beside the corner it is told worse still, and said to be
    run = runs[old - 1]
    blind = TorqueSurface(only(run, run.temperature > 70.0 + ZERO_CELSIUS), kernel).at(*where)
    assert blind.outside[0]
    assert blind.kelvin[0] == pytest.approx(-30.0)
    assert blind.error[0] > 10.0 * inside.error[0]


def test_draws_of_a_curve_are_those_of_its_points() -> None:
    _, runs, kernel = aged()
    surface = TorqueSurface(runs[0], kernel)
    speed = np.geomspace(0.5, 20.0, 30)
    median, drawn = surface.curve(speed, 420.0), surface.drawn(speed, 420.0, draws=400, seed=1)
    found = surface.at(speed, np.full(30, 420.0))
    assert median == pytest.approx(found.torque)
    logs = np.log(drawn)
    assert logs.std(axis=0) == pytest.approx(found.error, rel=0.15)
    assert np.abs(np.corrcoef(logs[:, 14], logs[:, 15])[0, 1]) > 0.9  # neighbours go together
    assert np.array_equal(drawn, surface.drawn(speed, 420.0, draws=400, seed=1))


def power_law(speed: FloatArray, heat: FloatArray, seed: int, error: float = 0.01) -> RunDwells:
    torque = 0.2 * speed**0.4 * np.exp(-0.01 * (np.nan_to_num(heat, nan=400.0) - 400.0))
    shown = torque * (1.0 + error * np.random.default_rng(seed).standard_normal(speed.size))
    return RunDwells(speed, heat, shown, shown, error * torque)


@pytest.mark.parametrize("temperature", [400.0, np.nan])
def test_one_temperature_or_none(temperature: float) -> None:
    speed = np.geomspace(1.0, 20.0, 12)
    runs = [power_law(speed, np.full(12, temperature), seed) for seed in range(6)]
    kernel = shared_kernel(runs)
    errors = []
    for run in runs:
        surface = TorqueSurface(run, kernel)
        assert surface.covers(400.0)
        found = surface.at(np.array([3.3]), np.array([401.0]))
        errors.append(np.log(found.torque[0] / (0.2 * 3.3**0.4)) / found.error[0])
        if np.isnan(temperature):
            assert surface.covers(500.0)  # nobody measured it: it may have been any
        else:
            assert np.isnan(surface.at(np.array([3.3]), np.array([500.0])).torque[0])
            with pytest.raises(ParameterError, match="other temperatures"):
                surface.curve(speed, 500.0)
    assert np.all(np.abs(errors) < 4.0)
    assert np.sqrt(np.mean(np.square(errors))) < 2.0


@pytest.mark.parametrize("count", [4, 5, 6, 9])
def test_few_dwells_make_a_trend_of_fewer_terms(count: int) -> None:
    speed, heat = np.array([1.0, 4.0, 16.0]), np.array([350.0, 400.0, 450.0])
    grid = [each.ravel() for each in np.meshgrid(speed, heat)]
    order = [0, 8, 2, 6, 4, 1, 3, 5, 7][:count]
    run = power_law(grid[0][order], grid[1][order], 0)
    found = TorqueSurface(run, shared_kernel([run])).at(np.array([4.0]), np.array([390.0]))
    assert np.log(found.torque[0] / (0.2 * 4.0**0.4 * np.exp(0.1))) / found.error[0] == pytest.approx(
        0, abs=4
    )


def test_dwells_lost_in_noise_do_not_lead_astray() -> None:
    """Where the belt takes less than the noise some dwells are below nothing; their mean still counts."""
    kernel = aged()[2]
    speed, heat = np.repeat(np.geomspace(1.0, 20.0, 12), 6), np.full(72, 400.0)
    torque = 0.01 * speed**0.4
    shown = torque + 0.01 * np.random.default_rng(0).standard_normal(72)
    assert np.any(shown < 0.0)
    run = RunDwells(speed, heat, shown, shown + 0.2, np.full(72, 0.01))
    found = TorqueSurface(run, kernel).at(np.array([6.0]), np.array([400.0]))
    assert np.abs(np.log(found.torque[0] / (0.01 * 6.0**0.4))) < 3.0 * found.error[0]
    assert found.error[0] < 0.4


def test_too_few_dwells_are_refused() -> None:
    speed = np.array([1.0, 2.0, 3.0])
    run = power_law(speed, np.full(3, 400.0), 0)
    with pytest.raises(InsufficientDataError, match="3 dwells"):
        TorqueSurface(run, Kernel(0.1, 1.0, 50.0, 0.01, 0.01))
    with pytest.raises(InsufficientDataError, match="no run has 4 dwells"):
        shared_kernel([run])


def test_it_is_universal_kriging() -> None:
    """Mean and variance are those of the textbook's one linear system, [[K, F], [F', 0]]."""
    kernel = Kernel(0.4, 1.5, 60.0, 0.01, 0.003)
    grid = np.meshgrid(np.geomspace(1.0, 20.0, 6), [350.0, 380.0, 420.0, 450.0])
    run = power_law(grid[0].ravel(), grid[1].ravel(), 0)
    at = np.array([2.5, 13.0, 40.0]), np.array([365.0, 430.0, 480.0])
    found = TorqueSurface(run, kernel).at(*at)

    def terms(speed: FloatArray, heat: FloatArray) -> FloatArray:
        u, t = np.log(speed) - 1.5, (heat - 400.0) / 50.0
        return np.stack([np.ones_like(u), u, t, u * t, u * u, t * t], axis=1)

    def between(ours: tuple[FloatArray, ...], theirs: tuple[FloatArray, ...]) -> FloatArray:
        return kernel.covariance(np.log(ours[0])[:, None] - np.log(theirs[0]), ours[1][:, None] - theirs[1])

    here = run.speed, run.temperature
    noise = (run.error / run.torque) ** 2 + kernel.scatter**2
    trend = terms(*here)
    system = np.block([[between(here, here) + np.diag(noise), trend], [trend.T, np.zeros((6, 6))]])
    right = np.vstack([between(here, at), terms(*at).T])
    weights = np.linalg.solve(system, right)
    assert np.log(found.torque) == pytest.approx(weights[:24].T @ np.log(run.torque), abs=1e-3)
    variance = kernel.deviation**2 - np.sum(weights * right, axis=0)
    assert found.error == pytest.approx(np.sqrt(variance), rel=1e-2)
    assert found.error[2] > 0.3  # far beyond the dwells the trend adds as much as the deviation
