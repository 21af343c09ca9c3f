"""A recipe is how logs become dwells: one for command line, app, campaign and machine file."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hersey
from hersey.app.running import _points
from hersey.damping.recipe import Recipe
from hersey.errors import ParameterError, UnitError, WrongKindError
from hersey.log.sensors import Sensors
from hersey.machine.machine import read_machine

SPEEDS, KELVIN = (5.0, 10.0, 20.0, 40.0, 80.0), (353.15, 393.15, 433.15)
AMOUNT = st.floats(1e-6, 1e2)
TEXT = st.text(st.characters(codec="utf-8", categories=("L", "N", "P", "S", "Zs")), min_size=1, max_size=12)


def friction(folder: Path) -> Path:
    """A table of means of a friction force, whose radius the mapping beside it states."""
    rows = ["Friction force [N],Sliding speed [mm/s],Temp [K]"]
    rows += [f"{20.0 * v**0.3 * (t / 353.15) ** -3},{v},{t}" for t in KELVIN for v in SPEEDS]
    (folder / "means.csv").write_text("\n".join(rows))
    (folder / "hersey.toml").write_text('[radius]\nvalue = "25 mm"\n')
    return folder / "means.csv"


def asked(log: Path, **more: Any) -> dict[str, Any]:
    """What the app asks its worker."""
    request = {"logs": [str(log)], "mapping": str(log.parent / "hersey.toml"), "tare": "none"}
    return request | {"isothermal": False, "drop_missing": False} | more


def test_command_line_app_machine_file_and_python_read_alike(tmp_path: Path) -> None:
    """The app refused a table of means whose mapping states a radius, which the command line reads."""
    log = friction(tmp_path)
    points = Recipe(logs=(log,)).points()
    torque = [20.0 * 0.025 * v**0.3 * (t / 353.15) ** -3 for t in KELVIN for v in SPEEDS]
    np.testing.assert_allclose(points.column("torque"), torque, rtol=1e-12)
    of_app = _points(asked(log), None, lambda _step, _share: None)
    np.testing.assert_array_equal(of_app.column("torque"), points.column("torque"))
    command = [sys.executable, "-m", "hersey.cli", "fit", str(log), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300)
    printed = [point["torque"] for point in json.loads(done.stdout)["points"]]
    np.testing.assert_array_equal(printed, points.column("torque"))
    (tmp_path / "machine.toml").write_text(
        '[drivetrain]\nstiffness = "11 N/mm"\nmass = "11 kg"\nroll_radius = "25 mm"\nstick_speed = "1 mm/s"\n'
        '[rest]\nlog = "means.csv"\n'
    )
    rest = read_machine(tmp_path / "machine.toml").rest
    assert rest is not None
    assert rest.speed_range == pytest.approx((SPEEDS[0] / 25.0, SPEEDS[-1] / 25.0), rel=1e-12)


@given(
    names=st.dictionaries(st.sampled_from(["torque", "speed", "temperature"]), TEXT, max_size=3),
    every=st.none() | AMOUNT,
    load=st.none() | AMOUNT | st.lists(AMOUNT, min_size=2, max_size=4).map(tuple),
    min_dwell=AMOUNT,
    switches=st.tuples(st.booleans(), st.booleans(), st.booleans()),
    sign=st.sampled_from([-1, 1]),
)
def test_a_saved_recipe_is_the_same(
    tmp_path_factory: pytest.TempPathFactory,
    names: dict[str, str],
    every: float | None,
    load: Any,
    min_dwell: float,
    switches: tuple[bool, bool, bool],
    sign: int,
) -> None:
    folder = tmp_path_factory.getbasetemp()
    recipe = Recipe(
        logs=(folder / "logs" / "a.csv", folder / "b.csv"),
        channels={role: name for role, name in names.items() if name.strip()},
        signs={"torque": sign},
        every=every,
        load=load,
        min_dwell=min_dwell,
        isothermal=switches[0],
        drop_missing=switches[1],
        means=switches[2],
        no_load=folder / "free.csv",
    )
    recipe.save(folder / "recipe.toml", overwrite=True)
    assert Recipe.from_file(folder / "recipe.toml") == recipe


def test_amounts_of_a_recipe_take_units() -> None:
    recipe = Recipe(logs="a.csv", every="2 ms", load=("10 N", 20.0), min_dwell="0.1 min")  # type: ignore[arg-type]
    assert recipe.logs == (Path("a.csv"),)
    assert (recipe.every, recipe.load, recipe.min_dwell) == (0.002, (10.0, 20.0), pytest.approx(6.0))
    assert recipe.to_dict() == {
        "logs": ["a.csv"],
        "every": 0.002,
        "load": [10.0, 20.0],
        "min_dwell": pytest.approx(6.0),
    }
    with pytest.raises(WrongKindError, match="every: unit 'kg' is not a unit of time"):
        Recipe(every="2 kg")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "error", "says"),
    [
        ("tarre = 'standing'", ParameterError, r"recipe\.toml, line 1: .*'tarre'.* Did you mean .*tare"),
        ("every = 3", UnitError, "recipe.toml, line 1: every is 3, without a unit"),
        ("load = ['2 N', '3 m']", UnitError, "recipe.toml, line 1: load: unit 'm' is not a unit of force"),
        ("signs = {torque = 'x'}", ParameterError, r"recipe\.toml, line 1: signs\.torque is 'x'"),
        ("logs = [3]", ParameterError, "recipe.toml, line 1: logs is 3: write the name of a file"),
        (
            "logs = [['a.csv']]",
            ParameterError,
            r"recipe.toml, line 1: logs is \['a.csv'\]: write the name of a file",
        ),
        (
            "mapping = ['a.toml']",
            ParameterError,
            "recipe.toml, line 1: mapping is .*: write the name of a file",
        ),
        ("no_load = []", ParameterError, "recipe.toml, line 1: no_load is .*: write the name of a file"),
        ("mapping = ''", ParameterError, "recipe.toml, line 1: mapping is '': write the name of a file"),
    ],
)
def test_a_mistake_in_a_saved_recipe_is_named(
    tmp_path: Path, text: str, error: type[Exception], says: str
) -> None:
    (tmp_path / "recipe.toml").write_text(text + "\n")
    with pytest.raises(error, match=says):
        Recipe.from_file(tmp_path / "recipe.toml")


def test_dwells_keep_the_recipe_that_made_them(tmp_path: Path) -> None:
    log = friction(tmp_path)
    recipe = Recipe(logs=(log,))
    assert recipe.points().recipe is recipe
    rest = hersey.NoLoadTorque.stated(constant=0.001)
    assert recipe.dwells(recipe.log()).without(rest).recipe is recipe
    assert hersey.SteadyPoints.from_table(log, radius="25 mm").recipe is None  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("logs", "named"),
    [
        (("/a/x.csv", "/b/y.csv"), ("x.csv", "y.csv")),
        (("/a/1/log.csv", "/a/2/log.csv"), ("1/log.csv", "2/log.csv")),
        (("log.csv", "/a/log.csv"), ("log.csv", "a/log.csv")),
        (("/a/log.csv", "/a/log.csv"), ("log.csv", "log.csv")),
        ((), ()),
    ],
)
def test_a_recipe_by_name_holds_no_more_of_a_path_than_it_must(
    logs: tuple[str, ...], named: tuple[str, ...]
) -> None:
    recipe = Recipe(logs=logs, mapping=Path("/a/b/map.toml"), no_load=Path("/a/free.csv")).by_name()  # type: ignore[arg-type]
    assert recipe.logs == tuple(map(Path, named))
    assert (recipe.mapping, recipe.no_load) == (Path("map.toml"), Path("free.csv"))


def test_a_log_and_one_of_the_same_name_without_the_film_stay_two() -> None:
    recipe = Recipe(logs=("/a/log.csv",), no_load=Path("/b/log.csv"), mapping=Path("/c/map.toml")).by_name()  # type: ignore[arg-type]
    assert (recipe.logs, recipe.no_load) == ((Path("a/log.csv"),), Path("b/log.csv"))
    assert recipe.mapping == Path("map.toml")


def test_no_load_is_said_once(tmp_path: Path) -> None:
    log = friction(tmp_path)
    rest = hersey.NoLoadTorque.stated(constant=0.01, source="[rest] of machine.toml")
    drive: Any = SimpleNamespace(sensors=Sensors(), rest=rest)
    with pytest.raises(ParameterError, match=r"^.*no_load and \[rest\] of machine.toml both give"):
        Recipe(logs=(log,), no_load=log).points(drive)
    without = Recipe(logs=(log,)).points(drive)
    whole = Recipe(logs=(log,)).points()
    np.testing.assert_allclose(without.column("torque"), whole.column("torque") - 0.01, rtol=1e-12)


MEANS = "n [rpm],M [mN*m],way,x [deg]\n10,20,1,1\n20,25,1,2\n40,30,-1,3\n80,38,-1,4\n"


@pytest.mark.parametrize(
    ("mapping", "given", "omit"),
    [
        ('[direction]\nchannel = "way"\n', {}, r"\[direction\] channel in hersey.toml"),
        ('[names]\npattern = "{load} N.csv"\n', {}, r"\[names\] pattern in hersey.toml"),
        ('[position]\nchannel = "x"\n', {"means": True}, r"\[position\] channel in hersey.toml"),
        ("", {"name_pattern": "{load} N.csv"}, "name_pattern"),
        ("", {"position_window": 0.2}, "position_window"),
        ("", {"channels": {"direction": "way"}, "means": True}, r"channels=\{'direction': ...\}"),
    ],
)
def test_a_table_of_means_takes_nothing_in_the_place_of_a_column(
    mapping: str, given: dict[str, Any], omit: str, tmp_path: Path
) -> None:
    (tmp_path / "5 N.csv").write_text(MEANS)
    (tmp_path / "hersey.toml").write_text(mapping)
    recipe = Recipe(logs=(tmp_path / "5 N.csv",), isothermal=True)
    says = f"a table of means holds its speed, sign and load as columns. Write them there, and omit {omit}$"
    with pytest.raises(ParameterError, match=says):
        replace(recipe, **given).log()
    (tmp_path / "hersey.toml").write_text("")
    assert recipe.log().rows == 4


def test_corrections_of_a_table_of_means_are_named_as_they_were_given(tmp_path: Path) -> None:
    (tmp_path / "means.csv").write_text(MEANS)
    recipe = Recipe(logs=(tmp_path / "means.csv",), isothermal=True)
    with pytest.raises(ParameterError, match=r"^gear_ratio and speed_gear_ratio cannot .* omit gear_ratio"):
        replace(recipe, gear_ratio=10.0, speed_gear_ratio=10.0).log()
    (tmp_path / "hersey.toml").write_text("[torque]\ngear_ratio = 10\n")
    with pytest.raises(ParameterError, match=r"^hersey\.toml contains corrections"):
        recipe.log()


def test_the_unit_of_a_current_outranks_that_of_the_mapping(tmp_path: Path) -> None:
    time = np.arange(400) * 0.05
    rows = "".join(f"{t:.2f},2.0,{100 * (1 + t // 10):g}\n" for t in time)
    (tmp_path / "log.csv").write_text("t [s],I,n [rpm]\n" + rows)
    (tmp_path / "hersey.toml").write_text('[torque]\nunit = "N*m"\n')
    log = Recipe(
        logs=(tmp_path / "log.csv",),
        channels={"torque": "I"},
        units={"torque": "A"},
        torque_constant=0.11,
        isothermal=True,
    ).log()
    np.testing.assert_allclose(log.runs[0].torque, 0.22)


def test_a_zero_error_of_a_torque_is_none_of_a_friction_force(tmp_path: Path) -> None:
    log = friction(tmp_path)
    (tmp_path / "hersey.toml").write_text('[torque]\nzero_error = "0.1 N*m"\n')
    with pytest.raises(ParameterError, match=r"^\[torque\] zero_error needs a torque, .* a friction force"):
        Recipe(logs=(log,)).log()
    assert Recipe(logs=(log,), radius=0.025).log().sensors.torque_zero == 0.1
