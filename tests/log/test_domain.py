"""Friction as what was measured: runs at several radii or loads are one coefficient, and words say so."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey import SteadyPoints
from hersey.errors import InsufficientDataError, ParameterError, UnitError
from hersey.schema.domain import Domain
from hersey.verdict.warnings import warnings_of
from tests.cli.command import run
from tests.conftest import shared

SPEEDS = np.repeat([0.01, 0.02, 0.05, 0.1, 0.2, 0.5], 100)
RADII, LOADS = (0.01, 0.02, 0.04), (5.0, 10.0, 20.0)
COEFFICIENT = Domain("friction coefficient", "sliding speed")


def log(radius: float, load: float, quantity: str, power: float = 0.0) -> pl.DataFrame:
    """A staircase of speeds on a tribometer whose coefficient is 0.12 at 0.1 m/s."""
    noise = np.random.default_rng(round(1e4 * radius * load)).normal(1.0, 0.01, SPEEDS.size)
    friction = 0.12 * (SPEEDS / 0.1) ** power * noise
    if quantity == "torque":
        columns = {"Torque [N*m]": friction * load * radius, "Speed [rad/s]": SPEEDS / radius}
    elif quantity == "force":
        columns = {"Friction force [N]": friction * load, "Sliding speed [m/s]": SPEEDS}
    else:
        columns = {"COF": friction, "Sliding speed [m/s]": SPEEDS}
    return pl.DataFrame({"Time [s]": 0.1 * np.arange(SPEEDS.size)} | columns)


def points_of(quantity: str, power: float = 0.0, **stated: object) -> SteadyPoints:
    """The dwells of three runs, which differ in what is stated for each; radii if nothing is."""
    radii = (0.02,) * 3 if "radius" not in stated and "load" in stated else RADII
    loads = LOADS if np.ndim(stated.get("load")) else (10.0,) * 3
    tables = [log(*each, quantity, power) for each in zip(radii, loads, strict=True)]
    return hersey.read(tables, isothermal=True, **stated).steady()


@pytest.mark.parametrize(
    ("quantity", "stated"),
    [
        ("coefficient", {}),
        ("coefficient", {"radius": RADII, "load": 10.0}),
        ("torque", {"radius": RADII, "load": 10.0}),
        ("force", {"load": LOADS}),
    ],
)
def test_a_constant_coefficient_at_three_radii_or_loads_is_constant(quantity: str, stated: dict) -> None:
    points = points_of(quantity, **stated)
    assert points.domain == COEFFICIENT
    surface = hersey.fit(points)
    assert surface.c.low - surface.c.systematic <= -1.0 <= surface.c.high + surface.c.systematic
    assert surface.predict(speed=0.1).torque == pytest.approx(0.12, rel=5e-3)
    verdict = hersey.regime(points, surface).verdict
    assert verdict.startswith("Friction coefficient is constant: 0.12")
    assert "at 0.01 to 0.5 m/s" in verdict
    assert not re.search(r"torque|rpm|stick-slip", verdict)
    said = " ".join(each.sentence for each in warnings_of(points, surface))
    assert not re.search(r"\btorque|rpm|N m", said)


@pytest.mark.parametrize(("power", "does"), [(0.1, "rises"), (-0.1, "falls")])
def test_a_coefficient_that_changes_with_speed_is_said_to(power: float, does: str) -> None:
    points = points_of("coefficient", power)
    surface = hersey.fit(points)
    assert f"Friction coefficient {does} with sliding speed, as v^" in hersey.regime(points, surface).verdict
    assert surface.headline().startswith("mu = a v^(1 + c)")
    assert surface.domain == COEFFICIENT
    with pytest.raises(ParameterError, match=r"needs a torque.*Give radius='25 mm' and load='50 N'"):
        surface.drag(roll_radius=0.02, stick_speed=1e-3)


def test_a_force_alone_stays_a_force() -> None:
    points = points_of("force")
    assert points.domain == Domain("friction force", "sliding speed")
    assert "friction force 1.19" in points.headline() or "friction force 1.2" in points.headline()
    assert "Friction force is constant: 1.2" in hersey.regime(points, hersey.fit(points)).verdict
    assert "friction force (N)" in points.to_frame().columns
    assert "sliding speed (m/s)" in points.to_frame().columns


def test_torques_at_different_loads_are_not_fitted_together() -> None:
    points = points_of("torque", load=LOADS)
    with pytest.raises(InsufficientDataError, match=r"loads of 5 to 20 N.*Give the radius, e\.g\. radius="):
        hersey.fit(points)
    assert points_of("torque", load=LOADS, radius=0.02).domain == COEFFICIENT


def test_a_radius_and_a_load_ask_for_a_torque() -> None:
    table = log(0.02, 10.0, "coefficient")
    asked = hersey.read(table, isothermal=True, radius="20 mm", load="10 N").steady()
    assert asked.domain.is_torque
    turned = hersey.read(table, isothermal=True).steady().as_torque(radius="20 mm", load="10 N")
    assert turned.domain.is_torque
    for name in ("torque", "speed", "torque_error"):
        np.testing.assert_allclose(turned.column(name), asked.column(name), rtol=1e-9)
    assert turned.log.domain.is_torque
    with pytest.raises(ParameterError, match=r"no normal load is known\. Give it, e\.g\. load='50 N'"):
        hersey.read(table, isothermal=True).steady().as_torque(radius="20 mm")


def test_rows_without_contact_are_left_out_of_a_coefficient() -> None:
    table = log(0.02, 10.0, "force")
    load = np.full(SPEEDS.size, 10.0)
    load[:40], load[-40:] = 0.1, -0.2
    read = hersey.read(
        table.with_columns(Fn=pl.Series(load)), isothermal=True, channels={"load": "Fn"}, units={"load": "N"}
    )
    assert read.rows == SPEEDS.size - 80
    (said,) = [each for each in read.files[0].warnings if each.kind == "rows without contact"]
    assert said.values["rows"] == 80


def test_what_is_printed_of_friction_speaks_of_friction(tmp_path: Path) -> None:
    for i, radius in enumerate(RADII):
        log(radius, 10.0, "coefficient", -0.1).write_csv(tmp_path / f"{i}.csv")
    for command in ("fit", "models", "inspect"):
        done = run(command, "0.csv", "1.csv", "2.csv", "--isothermal", cwd=tmp_path)
        assert done.returncode == 0, done
        kept = [
            line
            for line in done.stdout.splitlines()
            if not re.match(r" +(COF|Sliding speed|Friction) ", line)
        ]
        assert not re.search(r"\btorque|rpm|N·m|stick-slip", "\n".join(kept)), done.stdout


def test_what_is_about_a_torque_refuses_friction() -> None:
    points = points_of("coefficient")
    for ask in (hersey.fit_friction, hersey.no_load_torque):
        with pytest.raises(ParameterError, match="needs a torque, but the log is of a friction coefficient"):
            ask(points)
    with pytest.raises(ParameterError, match="needs a speed of rotation, but the log is of a sliding speed"):
        hersey.coast_down(points.log, inertia="1 kg*m^2")


def test_a_dwell_that_is_not_used_is_turned_with_the_others() -> None:
    table = log(0.02, 10.0, "force").head(510)  # the fastest dwell is too short
    sliding = hersey.read(table, isothermal=True).steady()
    turned = sliding.as_torque(radius=0.02)
    assert sliding.rejected
    for before, after in zip(sliding.rejected, turned.rejected, strict=True):
        assert after.speed == pytest.approx(before.speed / 0.02, nan_ok=True)
        assert after.why.domain.is_torque


def test_a_trend_takes_its_speed_in_the_unit_of_the_log() -> None:
    sliding = hersey.read(log(0.02, 10.0, "force"), isothermal=True)
    assert hersey.trend(sliding, at="0.1 m/s").speed == pytest.approx(0.1)
    with pytest.raises(UnitError, match="rpm"):
        hersey.trend(sliding, at="60 rpm")


def test_no_exponent_is_claimed_of_one_speed() -> None:
    path = shared("data/friction/te67_pin_on_disc/PPS_60N_2.tsv")
    channels = {"torque": "Friction Coefficient", "speed": "Sliding Velocity", "time": "Time"}
    units = {"torque": "1", "speed": "m/s"}
    points = hersey.read(path, channels=channels, units=units, isothermal=True).steady()
    with pytest.raises(InsufficientDataError, match=r"all dwells are at 0\.15 m/s"):
        hersey.fit(points)


def test_loads_of_an_oil_film_are_no_stribeck_curve() -> None:
    folder = shared("data/friction/newport_oil_stribeck/Motor_oil_glass")
    files = [folder / f"{speed}rps{load}N.txt" for speed in ("0-1", "1", "2-5") for load in (1, 3, 10)]
    channels = {"time": "#2", "torque": "#4", "speed": "#6", "load": "#3"}
    units = {"time": "s", "torque": "N*m", "speed": "rev/s", "load": "N"}
    read = hersey.read(files, channels=channels, units=units, isothermal=True, radius="10 mm")
    assert read.domain == COEFFICIENT
    assert any(each.kind == "rows without contact" for file in read.files for each in file.warnings)
    points = read.steady()
    surface = hersey.fit(points)
    assert surface.transition is None
    verdict = hersey.regime(points, surface).verdict
    assert "no film regime is judged" in verdict
    assert "is lowest" not in verdict


def risen(quantity: str, load: np.ndarray, name: str) -> pl.DataFrame:
    """A constant coefficient whose load rose from dwell to dwell, as recorded beside it."""
    table = log(0.02, 10.0, quantity)
    measured = {"torque": "Torque [N*m]", "force": "Friction force [N]"}[quantity]
    return table.with_columns(
        pl.Series(measured, table[measured].to_numpy() * np.abs(load) / 10.0), pl.Series(name, load)
    )


@pytest.mark.parametrize(
    ("name", "sign", "flags"),
    [
        ("Normal force [N]", 1, ["--load 'Normal force'"]),
        ("Fz [N]", -1, ["--load 'Fz'", "--load-unit '-1 N'"]),
    ],
)
def test_a_force_beside_a_load_that_changes_waits_for_it(
    name: str, sign: int, flags: list[str], tmp_path: Path
) -> None:
    risen("force", sign * np.repeat([5.0, 8, 10, 14, 17, 20], 100), name).write_csv(tmp_path / "a.csv")
    refused = run("fit", "a.csv", "--isothermal", cwd=tmp_path)
    assert refused.returncode == 2
    assert f"column '{name}' may be the normal load, and it changes from 5 to 20 N" in refused.stderr
    assert f"use {' '.join(flags)}. If the normal load is another" in refused.stderr
    fitted = run("fit", "a.csv", "--isothermal", *shlex.split(" ".join(flags)), cwd=tmp_path)
    assert fitted.words.startswith("Friction coefficient is constant: 0.12")
    other = run("fit", "a.csv", "--isothermal", "--load", "50 N", cwd=tmp_path)
    assert other.words.startswith("Friction coefficient rises")  # as it would at one load


def test_the_load_of_each_file_counts_and_one_that_is_the_same_does_not() -> None:
    tables = [risen("force", np.full(SPEEDS.size, load), "Fn [N]") for load in LOADS]
    with pytest.raises(InsufficientDataError, match=r"changes from 5 to 20 N.*channels=\{'load': 'Fn'\}"):
        hersey.fit(hersey.read(tables, isothermal=True).steady())
    same = hersey.read(tables[0], isothermal=True).steady()
    assert hersey.fit(same).domain.quantity == "friction force"


def test_a_torque_beside_a_load_or_track_that_changes_is_fitted_and_that_is_said() -> None:
    load = np.repeat([5.0, 8, 10, 14, 17, 20], 100)
    table = risen("torque", load, "Load [N]").with_columns(pl.Series("Track [mm]", load))
    points = hersey.read(table, isothermal=True).steady()
    said = [each for each in warnings_of(points, hersey.fit(points)) if each.kind == "column may play a role"]
    assert [(e.severity, e.values["role"], e.values["low"], e.values["high"]) for e in said] == [
        ("watch", "load", 5.0, 20.0),
        ("watch", "radius", 5.0, 20.0),
    ]
    quiet = hersey.read(risen("torque", np.full(SPEEDS.size, 10.0), "Load [N]"), isothermal=True)
    assert [w.severity for w in quiet.files[0].warnings if w.kind == "column may play a role"] == ["note"]


def test_a_coefficient_goes_before_the_force_that_it_was_made_of() -> None:
    table = log(0.02, 10.0, "coefficient").with_columns(pl.Series("Friction force [N]", SPEEDS))
    assert hersey.read(table, isothermal=True).domain == COEFFICIENT
    empty = table.with_columns(pl.lit(None, pl.Float64).alias("COF"))
    assert hersey.read(empty, isothermal=True).domain.quantity == "friction force"


def test_a_trend_beside_a_load_that_changes_says_so() -> None:
    table = risen("force", np.linspace(5.0, 20.0, SPEEDS.size), "Fn [N]")
    steady = table.with_columns(pl.lit(0.1).alias("Sliding speed [m/s]"))
    found = hersey.trend(hersey.read(steady, isothermal=True))
    (said,) = [each for each in found.warnings if each.kind == "column may play a role"]
    assert (said.severity, said.values["how"]) == ("watch", "channels={'load': 'Fn'}")
