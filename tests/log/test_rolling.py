"""Traction machines: the mean speed is that of entrainment, the slide-roll ratio makes the sliding speed."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey import SteadyPoints
from hersey.errors import InsufficientDataError
from hersey.schema.domain import Domain
from hersey.verdict.warnings import warnings_of
from tests.cli.command import run

SPEEDS = np.geomspace(5.0, 3000.0, 24)  #: mm/s
ENTRAINMENT = Domain("friction coefficient", "entrainment speed")


def stribeck(**columns: object) -> pl.DataFrame:
    """A table as traction machines export it; friction is lowest where its branches meet, at 0.3 m/s."""
    noise = np.random.default_rng(3).normal(1.0, 0.005, SPEEDS.size)
    friction = 0.05 * np.where(SPEEDS < 300.0, (SPEEDS / 300.0) ** -0.3, (SPEEDS / 300.0) ** 0.3) * noise
    usual = {"Mean speed (mm/s)": SPEEDS, "SRR (%)": 50.0, "Traction coeff": friction}
    return pl.DataFrame(usual | {"Traction force (N)": 30.0 * friction} | columns)


def test_the_mean_speed_beside_a_slide_roll_ratio_is_that_of_entrainment(tmp_path: Path) -> None:
    stribeck().write_csv(tmp_path / "mtm.csv")
    points = SteadyPoints.from_table(tmp_path / "mtm.csv")
    assert points.domain == ENTRAINMENT
    np.testing.assert_allclose(points.column("speed"), SPEEDS / 1e3, rtol=1e-12)  # not 50 % of it
    fitted = run("fit", "mtm.csv", "--isothermal", cwd=tmp_path)
    assert "Friction coefficient is lowest at an entrainment speed of 0.299 m/s [" in fitted.words
    assert "mu = a U^(1 + c), U in m/s" in fitted.words
    looked = run("inspect", "mtm.csv", "--isothermal", cwd=tmp_path)
    assert (
        "'Mean speed' is the entrainment speed, the mean of both surfaces. The slide-roll ratio 'SRR' is 50 %"
        in (looked.words)
    )
    assert "Entrainment speed is" not in looked.words  # nothing was computed


@pytest.mark.parametrize(
    ("table", "speed"),
    [
        (stribeck().drop("SRR (%)"), "sliding speed"),  # a mean of what?
        (
            stribeck().drop("SRR (%)").rename({"Mean speed (mm/s)": "Rolling speed (mm/s)"}),
            "entrainment speed",
        ),
        (stribeck().rename({"Mean speed (mm/s)": "Sliding speed (mm/s)"}), "sliding speed"),
    ],
)
def test_what_a_speed_is_shows_by_its_name_or_a_ratio(table: pl.DataFrame, speed: str) -> None:
    assert SteadyPoints.from_table(table).domain.speed == speed
    trace = pl.DataFrame({"Time [s]": np.arange(24) * 0.1}).hstack(table)
    assert hersey.read(trace, isothermal=True).domain.speed == speed


def test_a_ratio_that_varies_is_said_and_a_traction_curve_waits_for_its_sliding_speed(tmp_path: Path) -> None:
    ratio = np.linspace(5.0, 50.0, SPEEDS.size)
    points = SteadyPoints.from_table(stribeck(**{"SRR (%)": ratio}))
    (said,) = [w for w in warnings_of(points, hersey.fit(points)) if w.kind == "entrainment speed"]
    assert (said.severity, said.values["low"], said.values["high"]) == ("watch", 5.0, 50.0)
    table = stribeck(**{"SRR (%)": ratio, "Mean speed (mm/s)": 2000.0, "Traction coeff": 0.02 * ratio**0.2})
    with pytest.raises(InsufficientDataError, match=r"an entrainment speed of 2 m/s, while 'SRR' varies"):
        hersey.fit(SteadyPoints.from_table(table))
    table.write_csv(tmp_path / "a.csv")
    advised = run("fit", "a.csv", "--isothermal", "--means", cwd=tmp_path).stderr
    assert "add a column of it, 'SRR' times 'Mean speed', and name it with --speed 'Sliding speed'" in advised
    table.with_columns(pl.Series("Sliding speed (mm/s)", 20.0 * ratio)).write_csv(tmp_path / "a.csv")
    typed = shlex.split("--speed 'Sliding speed'")
    done = run("fit", "a.csv", "--isothermal", "--means", *typed, cwd=tmp_path)
    assert done.words.startswith("Friction coefficient rises with sliding speed, as v^0.200")


def test_the_temperature_of_the_lubricant_goes_before_that_of_a_heater() -> None:
    table = stribeck(**{"Heater temp (degC)": 120.0, "Pot temp (degC)": np.linspace(40, 100, SPEEDS.size)})
    points = SteadyPoints.from_table(table)
    np.testing.assert_allclose(points.column("temperature"), np.linspace(313.15, 373.15, SPEEDS.size))
