"""Drift: each ageing read rightly from two independent sources, derivatives, refusals."""

from __future__ import annotations

from functools import cache

import numpy as np
import polars as pl
import pytest
from benchmarks.drift import other, said, stand, table

from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.drift.aged_torque import OWN, Scales, expected, parts
from hersey.life.drift.quantities import _kinds
from hersey.life.drift.result import Drift, fit_drift
from hersey.testbench import Ageing, population
from hersey.testbench.drive import example_drive


@cache
def drift_of(source: str, kind: str, units: int = 4) -> Drift:
    return fit_drift(table((stand if source == "stand" else other)(kind, 2, units)))


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("nothing", "nothing"),
        ("lubricant", "lubricant"),
        ("film", "film"),
        ("roughness", "contact"),
        ("boundary friction", "contact"),
        ("no-load torque", "no-load torque"),
    ],
)
def test_what_ages_alone_is_read(kind: str, name: str) -> None:
    assert said(drift_of("stand", kind).reading) == name


@pytest.mark.parametrize("kind", ["nothing", "lubricant", "no-load torque"])
def test_what_ages_in_a_drive_of_other_laws_is_read(kind: str) -> None:
    assert said(drift_of("other", kind).reading) == kind


def test_the_rest_that_grows_is_told_in_newton_metres() -> None:
    drift = drift_of("stand", "no-load torque")
    units = population(*example_drive(), ageing=Ageing(rest_growth=1e-6), units=4, seed=2)
    told = drift["no-load torque"]
    true = [1e3 * 0.18 * 170e3 * unit.ageing.rest_growth for unit in units]
    found = np.array([[1e3 * each.low, 1e3 * each.high] for each in told.units])
    assert np.sum((found[:, 0] < true) & (true < found[:, 1])) >= 3
    assert told.moved
    assert not drift["speed of least torque"].moved


def test_thicker_oil_moves_the_speed_of_least_torque_down_and_a_starved_film_the_exponent_up() -> None:
    assert drift_of("stand", "lubricant")["speed of least torque"].change.high < 0.0
    assert drift_of("stand", "film")["exponent, cold and fast"].change.low > 0.0
    assert drift_of("stand", "roughness")["speed of least torque"].change.low > 0.0


def test_derivatives_are_those_of_the_law() -> None:
    random = np.random.default_rng(1)
    speed, kelvin = np.exp(random.uniform(-0.7, 2.7, (3, 20))), random.uniform(333.0, 453.0, (3, 20))
    scales = Scales.of(speed, kelvin, np.full(3, 0.2))
    place = scales.places(kelvin)
    own = np.array([1.0, 0.1, 0.05, -0.3, -0.3, 0.1]) + 0.1 * random.standard_normal((3, len(OWN)))
    shared = expected(scales)[0] + 0.05
    exact = parts(scales, speed, place, own, shared)
    for j in range(len(OWN)):
        step = 1e-6 * np.eye(len(OWN))[j]
        above, below = (parts(scales, speed, place, own + s * step, shared).torque for s in (1, -1))
        assert (above - below) / 2e-6 == pytest.approx(exact.own[..., j], abs=1e-8)
    for j in range(shared.size):
        step = 1e-6 * np.eye(shared.size)[j]
        above, below = (parts(scales, speed, place, own, shared + s * step).torque for s in (1, -1))
        assert (above - below) / 2e-6 == pytest.approx(exact.shared[..., j], abs=1e-8)


def test_many_units_are_read_as_few_are() -> None:
    runs = table(other("film and rest", 1, units=64, logs=4)).filter(pl.int_range(pl.len()) % 2 == 0)
    drift = fit_drift(runs)
    assert drift.fitted.settled
    assert said(drift.reading) == "film+no-load torque"


def test_without_stated_errors_their_scatter_tells_them() -> None:
    runs = table(stand("roughness", 2, 3)).with_columns(pl.lit(None, pl.Float64).alias("torque error (N m)"))
    drift = fit_drift(runs)
    assert said(drift.reading) == "contact"
    assert drift.scatter == pytest.approx(0.01, rel=0.1)


def test_without_temperatures_it_says_what_cannot_be_told() -> None:
    runs = table(stand("roughness", 2, 3))
    hot = runs.filter(pl.col("temperature (K)") > 450.0)
    drift = fit_drift(hot.with_columns(pl.lit(None, pl.Float64).alias("temperature (K)")))
    assert (drift.warnings[0].kind, drift.warnings[0].severity) == ("no temperatures", "act")
    assert "- Temperature varies too little" in drift.summary()
    assert "temperature law" not in [each.name for each in drift.quantities]
    assert drift["speed of least torque"].change.low > 0.0


def test_what_cannot_be_fitted_says_why() -> None:
    runs = table(stand("nothing", 2, 1))
    with pytest.raises(InsufficientDataError, match="two ages"):
        fit_drift(runs.filter(pl.col("age (h)") == 0.0))
    with pytest.raises(ParameterError, match="no column 'temperature"):
        fit_drift(runs.drop("temperature (K)"))
    missing = pl.when(pl.int_range(pl.len()) == 3).then(None).otherwise(pl.col("temperature (K)"))
    with pytest.raises(ParameterError, match="run 1 has dwells without a temperature"):
        fit_drift(runs.with_columns(missing.alias("temperature (K)")))
    with pytest.raises(ParameterError, match=r"speed of dwell 1 .* is 0"):
        fit_drift(runs.with_columns(pl.lit(0.0).alias("speed (rad/s)")))
    with pytest.raises(ParameterError, match=r"torque \(N m\) of dwell 1 \(run 1\) is not a number"):
        fit_drift(runs.with_columns(pl.lit(np.inf).alias("torque (N m)")))
    with pytest.raises(InsufficientDataError, match="no dwell"):
        fit_drift(runs.clear())


def test_too_few_dwells_tell_no_drift() -> None:
    few = table(other("lubricant", 1, units=2, logs=3)).group_by("run_id", maintain_order=True).head(2)
    with pytest.raises(InsufficientDataError, match="fewer than 4 dwells"):
        fit_drift(few)


def test_the_energy_of_torque_is_that_of_a_film_alone() -> None:
    """Film to the power 0.4 of a viscosity that falls by exp(2) from 400 to 450 K, in J/mol."""
    scales = Scales.of(np.array([1.0, 10.0]), np.array([400.0, 450.0]), np.array([0.2, 0.2]))
    shared = np.array([0.0, 0.6, 2.0, 0.0, 0.0, 0.0, 0.0])  # level, exponent, slope of viscosity
    own = np.array([0.0, 0.0, 0.0, -30.0, -30.0, 0.0])  # neither starved nor in contact
    [energy] = [kind for kind in _kinds(scales, shared) if kind.name == "temperature law"]
    by_hand = 8.314462618 * 0.4 * 2.0 / (1.0 / 400.0 - 1.0 / 450.0)
    assert energy.value(own[None])[0] == pytest.approx(by_hand, rel=1e-6)
