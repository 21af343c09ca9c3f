"""Friction against age at one speed: known truths, logs of several speeds, stops, and the line to type."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from scipy.signal import lfilter

import hersey
from hersey.errors import InsufficientDataError, OneSpeedError, ParameterError
from hersey.life.growth.laws import SETTLING
from tests.cli.command import run
from tests.conftest import shared

#: Thousand rows of a second each.
TIME = np.arange(1000.0)
#: Columns of the pin-on-disc files.
TE67 = {"time": "Time", "torque": "Friction Force#1", "speed": "Speed", "temperature": "Specimen Temp"}


def noise(seed: int, size: int = TIME.size, lasts: float = 5.0) -> np.ndarray:
    """Noise of unit variance whose neighbours correlate."""
    kept = np.exp(-1.0 / lasts)
    white = np.random.default_rng(seed).standard_normal(size + 200) * np.sqrt(1.0 - kept * kept)
    return np.asarray(lfilter([1.0], [1.0, -kept], white))[200:]


def frame(friction: np.ndarray, speed: Any = 60.0, **more: np.ndarray) -> pl.DataFrame:
    columns = {
        "time (s)": np.arange(float(friction.size)),
        "speed (rpm)": np.broadcast_to(np.asarray(speed, dtype=float), friction.size),
        "torque (N*m)": friction,
    }
    return pl.DataFrame(columns | more)


def log(friction: np.ndarray, speed: Any = 60.0, **more: np.ndarray) -> hersey.TorqueLog:
    return hersey.read(frame(friction, speed, **more), isothermal="temperature (degC)" not in more)


def kinds(found: hersey.FrictionTrend) -> list[str]:
    return [each.kind for each in found.warnings]


@pytest.fixture(scope="module")
def run_in() -> hersey.FrictionTrend:
    """Falls from 0.6 to 0.4 N m with a time constant of 80 s: within 5 % of it after 184 s."""
    return hersey.trend(log(0.4 + 0.2 * np.exp(-TIME / 80.0) + 0.01 * noise(1)))


def test_a_run_in_is_found(run_in: hersey.FrictionTrend) -> None:
    assert run_in.kind == "falls and settles"
    assert run_in.steady is not None
    assert run_in.steady_age is not None
    assert run_in.time_constant is not None
    assert run_in.steady.low < 0.4 < run_in.steady.high < 0.41
    assert run_in.time_constant.low < 80.0 < run_in.time_constant.high
    assert run_in.steady_age.low < 80.0 * np.log(0.2 / 0.02) < run_in.steady_age.high < 400.0
    assert run_in.jumps == ()
    assert kinds(run_in) == ["no temperature"]
    assert run_in.headline().startswith("Torque falls to a steady 398 mN·m")


def test_the_result_answers(run_in: hersey.FrictionTrend) -> None:
    held = json.loads(json.dumps(run_in.to_dict(), allow_nan=False))
    assert held["kind"] == "falls and settles"
    assert held["laws"][0]["weight"] == max(each["weight"] for each in held["laws"])
    assert run_in.to_frame().columns[:2] == ["age (s)", "torque (N m)"]
    assert sum(each.weight for each in run_in.laws) == pytest.approx(1.0)
    assert run_in.chart().to_dict()["title"]["text"] == "Torque at one speed"
    assert all(line in run_in.summary() for line in run_in.lines())


def test_the_same_log_gives_the_same_bits(run_in: hersey.FrictionTrend) -> None:
    again = hersey.trend(log(0.4 + 0.2 * np.exp(-TIME / 80.0) + 0.01 * noise(1)))
    assert again.to_dict() == run_in.to_dict()


def test_a_torque_of_the_other_sign_and_in_other_units_says_the_same(run_in: hersey.FrictionTrend) -> None:
    friction = -(0.4 + 0.2 * np.exp(-TIME / 80.0) + 0.01 * noise(1))
    again = hersey.trend(log(friction, speed=-60.0), by="revolutions")
    turned = hersey.trend(log(friction, speed=60.0), by="distance", radius="50 mm")
    assert run_in.steady_age is not None
    assert again.steady is not None
    assert again.steady.value == pytest.approx(0.4, rel=0.02)
    assert again.steady_age is not None
    assert turned.steady_age is not None
    assert (again.age_unit, turned.age_unit) == ("rev", "m")
    assert again.steady_age.value == pytest.approx(run_in.steady_age.value, rel=1e-6)  # a turn a second
    assert turned.steady_age.value == pytest.approx(2.0 * np.pi * 0.05 * run_in.steady_age.value, rel=1e-6)


def test_what_does_not_change_is_told_to_be_constant() -> None:
    found = hersey.trend(log(0.4 + 0.01 * noise(2)))
    assert (found.kind, found.law, found.jumps) == ("constant", "constant", ())
    assert found.steady is not None
    assert found.steady.low < 0.4 < found.steady.high
    assert found.steady_age is not None
    assert found.steady_age.high == 0.0
    assert re.fullmatch(r"Torque shows no trend: .*; a steady drift is at most \S+ %/h", found.headline())


def test_growth_has_no_steady_value() -> None:
    found = hersey.trend(log(0.4 + 0.1 * TIME / TIME.size + 0.005 * noise(3)))
    assert found.kind == "rises"
    assert found.steady is None
    assert found.rate.low < 1e-4 < found.rate.high
    assert "not steady" in kinds(found)


def test_a_sudden_rise_is_a_jump_that_must_be_looked_at() -> None:
    found = hersey.trend(log(np.where(TIME < 600.0, 0.4, 0.56) + 0.008 * noise(4)))
    (jump,) = found.jumps
    assert jump.age == pytest.approx(600.0, abs=15.0)
    assert jump.change.low < 0.4 < jump.change.high
    assert not jump.after_stop
    warning = next(each for each in found.warnings if each.kind == "jump")
    assert warning.severity == "act"
    assert re.match(r"Friction rose suddenly by \+(39|40|41) % at ", warning.sentence)
    assert found.kind == "constant"
    assert found.steady is not None
    assert found.steady.low < 0.56 < found.steady.high


def test_a_stop_adds_no_age_and_a_jump_after_it_says_so() -> None:
    friction, speed = 0.4 + 0.004 * noise(5, 1300), np.full(1300, 60.0)
    friction[500:800], speed[500:800] = 0.0, 0.0
    friction[800:] -= 0.08
    found = hersey.trend(log(friction, speed))
    assert found.last_age == pytest.approx(999.0, abs=2.0)
    (jump,) = found.jumps
    assert jump.after_stop
    assert {"jump after a stop", "stops"} <= {*kinds(found)}


def test_a_difference_of_the_directions_is_named() -> None:
    friction, speed = 0.4 + 0.004 * noise(7, 1000), np.full(1000, 60.0)
    friction[500:] -= 0.08
    speed[500:] = -60.0
    friction[500:] *= -1.0
    found = hersey.trend(log(friction, speed))
    (jump,) = found.jumps
    assert jump.turned
    assert not jump.after_stop
    assert jump.change.value == pytest.approx(-0.2, abs=0.01)
    assert "jump with direction" in kinds(found)


def test_faces_apart_at_the_ends_are_left_out() -> None:
    friction = 0.4 + 0.004 * noise(6)
    friction[:20] = friction[-30:] = 0.001
    found = hersey.trend(log(friction))
    assert found.kind == "constant"
    assert next(each.values["rows"] for each in found.warnings if each.kind == "faces apart") == 50


def test_friction_that_follows_temperature_is_no_trend() -> None:
    kelvin = 3.0 * (1.0 - np.exp(-TIME / 300.0))
    friction = 0.4 * (1.0 - 0.02 * (kelvin - kelvin[-1])) + 0.002 * noise(7)
    read = 25.0 + kelvin + 0.02 * np.random.default_rng(7).standard_normal(TIME.size)
    found = hersey.trend(log(friction, **{"temperature (degC)": read}))
    assert found.kind == "constant"
    assert found.per_kelvin is not None
    assert found.per_kelvin.low < -0.008 < found.per_kelvin.high
    assert "temperature effect" in kinds(found)


def test_a_log_of_several_speeds_says_which_to_choose() -> None:
    speed = np.where(TIME < 400.0, 20.0, 60.0)
    several = log(0.4 + 0.004 * noise(8), speed)
    with pytest.raises(InsufficientDataError) as refused:
        hersey.trend(several)
    assert str(refused.value) == (
        "the log has several speeds, but a trend is followed at one: 20 rpm (40 % of the rows), 60 rpm "
        "(60 % of the rows). Choose one, e.g. at='60 rpm'"
    )
    found = hersey.trend(several, at="60 rpm")
    assert found.rows == 600
    assert found.speed == pytest.approx(2.0 * np.pi)


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"by": "distance"}, "a distance needs the radius of the track: add radius='22 mm', or count by="),
        ({"share": 1.5}, "share is 1.5: it must be between 0 and 1"),
        ({"at": "0 rpm"}, "the speed to follow is 0.0: it must not be 0"),
        ({"by": "distance", "radius": -1.0}, "the radius is -1.0: it must be greater than 0"),
    ],
)
def test_bad_arguments_are_named(changed: dict[str, Any], says: str) -> None:
    with pytest.raises(ParameterError, match=re.escape(says)):
        hersey.trend(log(0.4 + 0.01 * noise(9)), **changed)


@pytest.mark.parametrize(
    ("friction", "speed", "says"),
    [
        (0.4 + 0.01 * noise(10)[:20], 60.0, "only 20 rows are at one speed"),
        (np.full(100, 0.4), 60.0, r"torque always reads 0\.4 N m"),
        (0.4 + 0.01 * noise(10)[:100], 0.0, "the drive stands still throughout"),
        (0.4 + 0.01 * noise(10), np.geomspace(1.0, 1000.0, TIME.size), "the speed varies throughout"),
    ],
)
def test_what_is_no_record_is_refused(friction: np.ndarray, speed: Any, says: str) -> None:
    with pytest.raises(InsufficientDataError, match=says):
        hersey.trend(log(friction, speed))


def test_the_settling_law_and_its_age_are_inverses_and_its_slope_is_its_own() -> None:
    age = np.array([0.1, 0.5, 2.0])
    shape = np.log(np.array([0.3, 1.4]))[:, None]
    for size in np.array([-1.0, 0.5]):
        x = np.full(age.size, size)
        grown, slope = SETTLING.sloped(x, age, shape)
        np.testing.assert_allclose(grown, SETTLING.log_growth(x, age, shape), rtol=1e-12)
        np.testing.assert_allclose(SETTLING.age(x, grown, shape), age, rtol=1e-9)
        step = 1e-6
        moved = [SETTLING.log_growth(x + side, age, shape) for side in (-step, step)]
        np.testing.assert_allclose(slope, (moved[1] - moved[0]) / (2.0 * step), rtol=1e-6)
    assert np.isinf(SETTLING.age(np.zeros(1), np.full(1, np.log(2.0)), shape))


# The command line -----------------------------------------------------------------------------------------


def test_a_fit_of_one_speed_ends_in_the_line_to_type(tmp_path: Path) -> None:
    table = frame(0.4 + 0.2 * np.exp(-TIME / 80.0) + 0.01 * noise(1)).rename({"torque (N*m)": "M"})
    table.write_csv(tmp_path / "wear.csv")
    done = run("fit", "wear.csv", "--isothermal", "--torque-unit=N*m", "--min-dwell", "3 s", cwd=tmp_path)
    assert done.returncode == 2
    line = "hersey trend wear.csv --isothermal '--torque-unit=N*m'"
    assert done.stderr.rstrip().endswith(f"To follow friction over time, type: {line}")
    figure = run(*shlex.split(line)[1:], "--out", "trend.csv", "--json", cwd=tmp_path)
    assert figure.returncode == 0
    assert json.loads(figure.stdout)["kind"] == "falls and settles"
    assert (tmp_path / "trend.csv").is_file()


def test_a_notebook_gets_the_function() -> None:
    with pytest.raises(OneSpeedError) as refused:
        hersey.fit(log(0.4 + 0.01 * noise(11)).steady())
    assert refused.value.remedy == "To follow friction over time, use hersey.trend(log)"
    assert refused.value.files == ("frame",)


def test_all_logs_of_one_speed_are_in_the_line(tmp_path: Path) -> None:
    for seed in (1, 2):
        frame(0.4 + 0.001 * TIME + 0.01 * noise(seed)).write_csv(tmp_path / f"{seed}.csv")
    done = run("fit", "1.csv", "2.csv", "--isothermal", "--min-dwell", "100 s", cwd=tmp_path)
    assert "1.csv and 1 more: no dwell found" in done.stderr
    assert done.stderr.rstrip().endswith("type: hersey trend 1.csv 2.csv --isothermal")


def test_options_of_dwells_are_refused(tmp_path: Path) -> None:
    frame(0.4 + 0.01 * noise(12)).write_csv(tmp_path / "a.csv")
    done = run("trend", "a.csv", "--isothermal", "--tare", "standing", cwd=tmp_path)
    assert done.stderr == "hersey: a trend is made of rows, not of dwells: omit --tare\n"


# Files by others ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "kind", "steady"),
    [
        ("PPS+30PTFE_100N_200RPM_30MINS_1", "falls then rises", False),
        ("PPS+45PTFE_60N_200RPM_30MINS_2", "falls then rises and settles", True),
        ("PPS_60N_2", "falls and settles", True),
    ],
)
def test_wear_tests_by_others(name: str, kind: str, steady: bool) -> None:
    """As the records look: a first minute of run-in, then growth, still on at the end; no jump."""
    found = hersey.trend(
        hersey.read(
            shared(f"data/friction/te67_pin_on_disc/{name}.tsv"),
            channels=TE67,
            units={"torque": "0.022 N*m", "speed": "rpm", "temperature": "degC"},
        )
    )
    assert (found.kind, found.steady is not None, found.jumps) == (kind, steady, ())
    assert {"not steady", "steady value extrapolated"} & {*kinds(found)}
