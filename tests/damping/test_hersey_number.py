"""Friction against the Hersey number: one Stribeck curve for all temperatures and loads, or none."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey import SteadyPoints
from hersey.errors import HerseyError, ParameterError
from hersey.lubrication.lubricant import Lubricant
from hersey.schema.domain import Domain
from tests.cli.command import run

SPEEDS = np.geomspace(0.005, 1.0, 12)
CELSIUS, LOADS = (30.0, 60.0, 90.0), (10.0, 30.0)


def viscosity(celsius: float) -> float:
    """An oil by Arrhenius' law, written down here: 0.05 Pa s at 40 degC, 40 kJ/mol."""
    return float(0.05 * np.exp(40e3 / 8.314462618 * (1 / (celsius + 273.15) - 1 / 313.15)))


OIL = Lubricant("arrhenius", ((313.15, viscosity(40.0)), (373.15, viscosity(100.0))))


def of_hersey(number: np.ndarray, speed: np.ndarray) -> np.ndarray:  # noqa: ARG001
    """Two powers of the Hersey number that meet at 1e-4 1/m, where friction is 0.05."""
    return 0.05 * np.where(number < 1e-4, (number / 1e-4) ** -0.2, (number / 1e-4) ** 0.4)


def of_speed(number: np.ndarray, speed: np.ndarray) -> np.ndarray:  # noqa: ARG001
    """A law of speed alone, as of wear or of a layer that no oil carries."""
    return 0.1 * (speed / 0.1) ** -0.2


def table(law: Callable[..., np.ndarray]) -> pl.DataFrame:
    """Means at three temperatures and two loads, with 0.5 % noise."""
    parts, noise = [], np.random.default_rng(7)
    for celsius in CELSIUS:
        for load in LOADS:
            friction = law(viscosity(celsius) * SPEEDS / load, SPEEDS) * noise.normal(1.0, 0.005, SPEEDS.size)
            columns = {"v [m/s]": SPEEDS, "COF": friction, "Oil temp [degC]": celsius, "Fn [N]": load}
            parts.append(pl.DataFrame(columns))
    return pl.concat(parts)


def test_an_error_of_temperature_is_one_of_the_hersey_number() -> None:
    """D ln eta = -E/(R T^2) dT by Arrhenius' law: 0.5 K at 60 degC are 2.17 %."""
    points = SteadyPoints.from_table(table(of_hersey), channels={"load": "Fn"})
    errors = {"speed_error": 0.03 * points.column("speed"), "temperature_error": 0.5 * np.ones(len(points))}
    known = replace(points, table=points.table.with_columns(**{k: pl.Series(v) for k, v in errors.items()}))
    found = known.against_hersey_number(OIL)
    kelvin = points.column("temperature")
    share = np.hypot(0.03, 40e3 / 8.314462618 / kelvin**2 * 0.5)
    np.testing.assert_allclose(found.column("speed_error") / found.column("speed"), share, rtol=1e-6)


def test_runs_at_three_temperatures_and_two_loads_fall_on_one_curve() -> None:
    points = SteadyPoints.from_table(table(of_hersey), channels={"load": "Fn"}).against_hersey_number(OIL)
    assert points.domain == Domain("friction coefficient", "Hersey number")
    exact = [viscosity(c) * SPEEDS / load for c in CELSIUS for load in LOADS]
    np.testing.assert_allclose(points.column("speed"), np.concatenate(exact), rtol=1e-9)
    assert "Hersey number (1/m)" in points.to_frame().columns
    surface = hersey.fit(points)
    t = surface.transition
    assert t is not None
    assert (t.speed.low, t.speed.value, t.speed.high) == pytest.approx((1e-4, 1e-4, 1e-4), rel=0.03)
    assert 1.0 + surface.c.value == pytest.approx(0.4, abs=0.01)
    assert 1.0 + t.mixed_exponent.value == pytest.approx(-0.2, abs=0.01)
    verdict = hersey.regime(points, surface).verdict
    assert verdict.startswith("Friction coefficient is lowest at a Hersey number of ")
    assert "6 curves at different temperatures or loads collapse on the Hersey number within 2.1 %" in verdict
    assert "Loads differ (10 to 30 N), so no film regime is judged." in verdict
    assert surface.headline().startswith("mu = a H^(1 + c)")


def test_curves_that_do_not_collapse_are_no_stribeck_curve_and_that_comes_first() -> None:
    points = SteadyPoints.from_table(table(of_speed), channels={"load": "Fn"})
    mixed = hersey.regime(points, hersey.fit(points)).verdict
    assert "collapse" not in mixed  # at several viscosities speed over load is not the Hersey number
    points = points.against_hersey_number(OIL)
    verdict = hersey.regime(points, hersey.fit(points)).verdict
    assert verdict.startswith("Curves at 6 temperatures and loads do not collapse on the Hersey number")
    assert "no single Stribeck curve" in verdict


def test_the_command_takes_a_file_or_a_viscosity(tmp_path: Path) -> None:
    table(of_hersey).write_csv(tmp_path / "a.csv")
    points = "viscosities = [" + ", ".join(f'["{c} degC", "{viscosity(c)} Pa*s"]' for c in (40, 100)) + "]"
    (tmp_path / "oil.toml").write_text(f'[lubricant]\nmodel = "arrhenius"\n{points}\n')
    done = run("fit", "a.csv", "--load", "Fn", "--hersey", "oil.toml", cwd=tmp_path)
    assert done.returncode == 0, done
    assert "mu = a H^(1 + c), H in 1/m" in done.words
    one = table(of_hersey).filter(pl.col("Oil temp [degC]") == CELSIUS[1]).drop("Oil temp [degC]")
    one.write_csv(tmp_path / "b.csv")
    typed = ["fit", "b.csv", "--isothermal", "--load", "Fn", "--hersey"]
    refused = run(*typed, "oil.toml", cwd=tmp_path)
    assert "the log has no temperatures" in refused.stderr
    advice = refused.stderr.partition("e.g. --hersey ")[2]
    assert run(*typed, *shlex.split(advice), cwd=tmp_path).returncode == 0
    number = run(*typed, f"{viscosity(CELSIUS[1])} Pa*s", cwd=tmp_path)
    assert "lowest at a Hersey number of 0.0001" in number.words
    (tmp_path / "no.toml").write_text("")
    for text, said in (
        ("20", "unit of viscosity"),
        ("x.toml", "File not found"),
        ("no.toml", "no [lubricant]"),
    ):
        assert said in run(*typed, text, cwd=tmp_path).stderr


@pytest.mark.parametrize(
    ("columns", "stated", "said"),
    [
        ({"COF": 0.1, "v [m/s]": SPEEDS}, {}, "needs the normal load. Give it, e.g. load='10 N'"),
        (
            {"Friction force [N]": 3.0, "v [m/s]": SPEEDS},
            {},
            "the log is of a friction force against",
        ),
        ({"Torque [N*m]": 3.0, "Speed [rpm]": SPEEDS}, {}, "the log is of a torque against speed"),
        ({"COF": 0.1, "v [m/s]": SPEEDS}, {"load": 10.0}, "the log has no temperatures"),
    ],
)
def test_what_it_needs(columns: dict[str, object], stated: dict[str, float], said: str) -> None:
    points = SteadyPoints.from_table(pl.DataFrame(columns), **stated)
    with pytest.raises(ParameterError) as refused:
        points.against_hersey_number(OIL)
    assert said in str(refused.value)
    with pytest.raises(HerseyError):
        points.against_hersey_number("20 N")
