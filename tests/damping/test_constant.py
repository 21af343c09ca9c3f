"""A torque or a speed that does not vary measures nothing and is refused; constant friction is fitted."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from numpy.typing import NDArray

import hersey
from hersey.damping.candidates.comparison import compare_models
from hersey.damping.dwells.constant import constant_torque
from hersey.errors import InsufficientDataError
from hersey.inspection import inspect
from tests.cli.command import run

Array = NDArray[np.float64]
SPEEDS, HOT, ROWS = (10.0, 20.0, 40.0, 80.0, 160.0), (80.0, 120.0, 170.0), 80
COUNT = len(SPEEDS) * len(HOT) * ROWS
RANDOM = np.random.default_rng(3)
WHITE = RANDOM.standard_normal(COUNT)
SPEED = np.tile(np.repeat(SPEEDS, ROWS), len(HOT)) * (1.0 + 0.002 * RANDOM.standard_normal(COUNT))
TEMPERATURE = np.repeat(HOT, len(SPEEDS) * ROWS) + 0.2 * RANDOM.standard_normal(COUNT)
CONSTANT = {
    "to the bit": np.full(COUNT, 500.0),
    "but for rounding": 500.0 * (1.0 + 1e-15 * WHITE),
    "but for one step": 500.0 + (WHITE > 1.5),
}


def frame(torque: Array, speed: Array = SPEED, temperature: Array = TEMPERATURE) -> pl.DataFrame:
    return pl.DataFrame(
        {
            "Time [s]": np.arange(COUNT) / 10.0,
            "Torque [mN*m]": torque,
            "Speed [rpm]": speed,
            "Temperature [degC]": temperature,
        }
    )


@pytest.fixture(autouse=True)
def _no_warning_escapes() -> object:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.mark.parametrize("name", CONSTANT)
def test_a_torque_that_does_not_vary_is_refused(name: str) -> None:
    points = hersey.read(frame(CONSTANT[name])).steady()
    says = r"torque \('Torque'\) reads 500(\.5)? mN m at all speeds"
    for fitted in (hersey.fit, compare_models):
        with pytest.raises(InsufficientDataError, match=says):
            fitted(points)


def test_so_is_one_of_a_table_of_means() -> None:
    table = {"speed [rpm]": [10, 20, 40, 80, 160], "torque [mN*m]": [5.0] * 5}
    with pytest.raises(InsufficientDataError, match="reads 5 mN m at all"):
        hersey.fit(hersey.SteadyPoints.from_table(table))


@pytest.mark.parametrize("verb", ["fit", "models", "report"])
def test_every_verb_refuses_it_in_one_line(verb: str, tmp_path: Path) -> None:
    frame(CONSTANT["to the bit"]).write_csv(tmp_path / "log.csv")
    done = run(verb, tmp_path / "log.csv", cwd=tmp_path)
    assert done.returncode != 0
    assert "does not measure friction" in " ".join(done.stderr.split())
    assert "Warning" not in done.stderr + done.stdout
    assert "Traceback" not in done.stderr


def test_inspect_says_that_it_tells_nothing(tmp_path: Path) -> None:
    frame(CONSTANT["but for one step"]).write_csv(tmp_path / "log.csv")
    support = inspect(tmp_path / "log.csv").support
    assert support is not None
    assert not any("exponent" in said for said in support.can)
    assert support.cannot[0].startswith("any exponent: torque always reads 500.5 mN m")


def test_coulomb_friction_is_fitted() -> None:
    """Torque that does not depend on speed, with 1 % of noise: damping goes as 1/speed."""
    points = hersey.read(frame(500.0 * (1.0 + 0.01 * WHITE))).steady()
    assert constant_torque(points) is None
    surface = hersey.fit(points)
    assert surface.c.value == pytest.approx(-1.0, abs=2e-3)
    assert surface.b is not None
    assert surface.b.value == pytest.approx(0.0, abs=1e-2)


def test_two_values_of_a_friction_that_changes_are_no_constant() -> None:
    table = np.where(SPEED > 30.0, 600.0, 500.0)
    assert constant_torque(hersey.read(frame(table)).steady()) is None


@pytest.mark.parametrize("speed", [np.full(COUNT, 60.0), 60.0 * (1.0 + 0.002 * WHITE)], ids=["set", "noisy"])
def test_a_speed_that_does_not_vary_is_refused(speed: Array) -> None:
    torque = 500.0 * (TEMPERATURE / 100.0) ** -1.0 * (1.0 + 0.01 * WHITE)
    with pytest.raises(InsufficientDataError, match="The speed is always 60 rpm"):
        hersey.read(frame(torque, speed=speed)).steady()
    with pytest.raises(InsufficientDataError, match="all dwells are at 60 rpm"):
        hersey.fit(hersey.read(frame(500.0 * (1.0 + 0.01 * WHITE), speed=speed)).steady())


def test_a_temperature_that_does_not_vary_is_allowed() -> None:
    torque = 500.0 * (SPEED / 30.0) ** 0.4 * (1.0 + 0.01 * WHITE)
    cold = frame(torque, temperature=np.full(COUNT, 100.0))
    with pytest.raises(InsufficientDataError, match=r"exponent b cannot be estimated.*isothermal=True"):
        hersey.fit(hersey.read(cold).steady())
    surface = hersey.fit(hersey.read(cold, isothermal=True).steady())
    assert surface.b is None
    assert surface.c.value == pytest.approx(-0.6, abs=5e-3)


def test_points_without_their_log_are_judged_by_their_means() -> None:
    """Those of a campaign were kept without rows."""
    points = hersey.read(frame(CONSTANT["to the bit"])).steady()
    kept = replace(points, log=replace(points.log, runs=()))
    assert constant_torque(kept) == pytest.approx(0.5)
    varying = hersey.read(frame(500.0 * (SPEED / 30.0) ** 0.4)).steady()
    assert constant_torque(replace(varying, log=replace(varying.log, runs=()))) is None
