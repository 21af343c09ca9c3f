"""Speed, load and temperature that no column holds: file names, schedules, positions, directions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.cli.options import Reading
from hersey.damping.recipe import Recipe
from hersey.errors import ChannelError, HerseyError, ParameterError, UnreadableLogError
from hersey.log.derived.file_names import NamePattern, proposed_pattern
from hersey.log.derived.position import slope, unwrapped
from hersey.log.derived.set_points import SetPoints
from hersey.log.mapping import read_with_mapping
from hersey.schema.domain import Domain

RPM = np.pi / 30
TIME = np.arange(3000) * 0.02
SPEEDS = np.repeat([20.0, 60.0, 180.0], 1000)
TORQUE = 0.01 * SPEEDS**0.4 + 1e-4 * np.sin(1.7 * np.arange(3000) ** 1.1)


def written(path: Path, **columns: object) -> Path:
    path.parent.mkdir(exist_ok=True)
    names = {"time": "Time [s]", "torque": "Torque [N*m]", "speed": "Speed [rpm]", "angle": "Angle [deg]"}
    frame = pl.DataFrame({names.get(name, name): values for name, values in columns.items()}, strict=False)
    frame.write_csv(path, float_precision=6)
    return path


def named(
    folder: Path, names: tuple[str, ...] = ("20 rpm 5 N.csv", "60 rpm 5 N.csv", "180 rpm 5 N.csv")
) -> list[Path]:
    parts = [slice(1000 * i, 1000 * i + 1000) for i in range(3)]
    return [
        written(folder / name, time=TIME[:1000], torque=TORQUE[part])
        for name, part in zip(names, parts, strict=True)
    ]


@pytest.mark.parametrize(
    ("template", "decimal", "name", "values"),
    [
        ("{speed} rpm {load} N.txt", ".", "120rpm 7.5 N.txt", {"speed": "120 rpm", "load": "7.5 N"}),
        ("{speed}rps{load:N}*", "-", "0-1rps0-7.txt", {"speed": "0.1 rps", "load": "0.7 N"}),
        (
            "*_{temperature}degC_{speed:mm/s}_*",
            ",",
            "R1_80,5degC_25_b.csv",
            {"temperature": "80.5 degC", "speed": "25 mm/s"},
        ),
        ("{radius} mm/{speed}RPM*", ".", "12 mm/-40rpm.csv", {"radius": "12 mm", "speed": "-40 RPM"}),
    ],
)
def test_names_by_a_pattern(template: str, decimal: str, name: str, values: dict[str, str]) -> None:
    assert NamePattern(template, decimal).values(name) == values


@pytest.mark.parametrize(
    ("template", "said"),
    [
        ("run.csv", "has no placeholder"),
        ("{speed} rpm {speed} rpm", "has {speed} twice"),
        ("{velocity} rpm", "has {velocity} which is unknown"),
        ("{speed}.csv", "{speed} without a unit behind it. Write the unit, e.g. {speed:rpm}"),
    ],
)
def test_patterns_that_cannot_be_used(template: str, said: str) -> None:
    with pytest.raises(ParameterError) as refused:
        NamePattern(template)
    assert said in str(refused.value)


def test_a_name_that_does_not_match_is_named() -> None:
    with pytest.raises(ParameterError, match=r"^1 rps\.csv: the name does not match"):
        NamePattern("{speed} rpm.csv").values("1 rps.csv")


@pytest.mark.parametrize(
    ("template", "name", "decimal", "speed"),
    [
        ("* {speed} rpm.csv", "free 60 rpm.csv", ".", "60 rpm"),
        ("* {speed} rpm.csv", "free -60.5 rpm.csv", ".", "-60.5 rpm"),
        ("*{speed} rpm.csv", "a-1.5 rpm.csv", ".", "1.5 rpm"),
        ("*{speed} rpm*", "R3 120rpm, not 5 rpm.csv", ".", "120 rpm"),
        ("*{speed}rps{load}N.txt", "x 0-1rps0-3N.txt", "-", "0.1 rps"),
        ("run.{speed} rpm.csv", "run.60 rpm.csv", ".", "60 rpm"),
        ("V2{speed} rpm.csv", "V260 rpm.csv", ".", "60 rpm"),
        ("{speed} rpm.csv", "-60 rpm.csv", ".", "-60 rpm"),
    ],
)
def test_any_text_takes_no_digit_of_a_number(template: str, name: str, decimal: str, speed: str) -> None:
    assert NamePattern(template, decimal).values(name)["speed"] == speed


@pytest.mark.parametrize("name", ["a1,5 rpm.csv", "a .5 rpm.csv"])
def test_the_end_of_a_number_is_not_read_as_one(name: str) -> None:
    with pytest.raises(ParameterError, match="the name does not match"):
        NamePattern("*{speed} rpm.csv").values(name)


@pytest.mark.parametrize(
    ("template", "name"),
    [
        ("*1" * 140 + "{speed} rpm", "1" * 300),
        ("*" * 280 + "{speed} rpm", "1 " * 150),
        ("*{speed} rpm x", "1" + " " * 300),
    ],
)
def test_a_pattern_of_many_texts_is_told_soon_not_to_match(template: str, name: str) -> None:
    """A search that tries every share of the name would not end."""
    with pytest.raises(ParameterError, match="the name does not match"):
        NamePattern(template).values(name)


@pytest.mark.parametrize(
    ("name", "proposed"),
    [
        ("0-1rps0-3N.txt", ("{speed}rps{load}N.txt", "-")),
        ("R3 120 rpm 80 degC.csv", ("R3 {speed} rpm {temperature} degC.csv", ".")),
        ("log 2023-01-02.csv", None),
        ("5 N.csv", None),
    ],
)
def test_a_pattern_is_proposed_for_a_name_with_a_speed(name: str, proposed: tuple[str, str] | None) -> None:
    assert proposed_pattern(name) == proposed
    if proposed:
        assert "speed" in NamePattern(*proposed).values(name)


def test_torque_against_time_with_the_speed_in_the_name_reduces_to_dwells(tmp_path: Path) -> None:
    logs = named(tmp_path)
    log = hersey.read(logs, name_pattern="{speed} rpm {load} N.csv", isothermal=True)
    assert [run.speed[0] / RPM for run in log.runs] == pytest.approx([20, 60, 180], rel=1e-12)
    assert all(np.all(run.load == 5.0) for run in log.runs)
    kinds = [[warning.kind for warning in file.warnings] for file in log.files]
    assert all("value of a file name" in each for each in kinds)
    points = log.steady()
    np.testing.assert_allclose(points.column("speed") / RPM, [20, 60, 180], rtol=1e-12)
    np.testing.assert_allclose(points.column("torque"), 0.01 * np.array([20, 60, 180]) ** 0.4, rtol=1e-3)


@pytest.mark.parametrize(
    ("names", "proposed"),
    [
        (("b_20rpm_60C.csv", "b_60rpm_60C.csv"), ("b_{speed}rpm_60C.csv", ".")),
        (("b_20rpm_60C.csv", "b_20rpm_80C.csv"), ("b_{speed}rpm_{temperature:degC}C.csv", ".")),
        (("v_10 mm_s.csv", "v_20 mm_s.csv"), ("v_{speed:mm/s} mm_s.csv", ".")),
        (("b_20rpm.csv", "b.csv"), None),
    ],
)
def test_a_pattern_fits_the_names_of_all_files(
    names: tuple[str, ...], proposed: tuple[str, str] | None
) -> None:
    assert proposed_pattern(names[0], names) == proposed


@pytest.mark.parametrize(
    ("names", "warned"),
    [
        (("F5N.csv", "F10N.csv", "F20N.csv"), ("load", "5 N, 10 N, 20 N", "F{load}N.csv")),
        (("r8mm.csv", "r16mm.csv", "r32mm.csv"), ("radius", "8 mm, 16 mm, 32 mm", "r{radius}mm.csv")),
        (("5N 1rpm.csv", "6N 2rpm.csv", "7N 3rpm.csv"), ("load", "5 N, 6 N, 7 N", "{load}N *rpm.csv")),
        (("5N a.csv", "5N b.csv", "5N c.csv"), None),
        (("a1.csv", "a2.csv", "a3.csv"), None),
    ],
)
def test_loads_and_radii_in_names_are_proposed(
    names: tuple[str, ...], warned: tuple[str, ...] | None, tmp_path: Path
) -> None:
    parts = [slice(1000 * i, 1000 * i + 1000) for i in range(3)]
    logs = [
        written(tmp_path / name, time=TIME[:1000], torque=TORQUE[part], speed=SPEEDS[part])
        for name, part in zip(names, parts, strict=True)
    ]
    log = hersey.read(logs, isothermal=True)
    found = [w for file in log.files for w in file.warnings if w.kind == "numbers in file names"]
    assert [(w.values["role"], w.values["numbers"]) for w in found] == ([warned[:2]] if warned else [])
    if warned:
        assert f"name_pattern='{warned[2]}'" in found[0].text
        values = {warned[0]: [1.0, 2.0, 3.0]}
        known = hersey.read(logs, isothermal=True, **values)
        assert not any(w.kind == "numbers in file names" for file in known.files for w in file.warnings)


def test_what_stands_in_names_is_never_guessed_but_proposed(tmp_path: Path) -> None:
    log = named(tmp_path)[0]
    with pytest.raises(ChannelError, match="no speed column") as refused:
        hersey.read(log, isothermal=True)
    assert "name_pattern='{speed} rpm {load} N.csv'" in refused.value.remedy
    (tmp_path / "hersey.toml").write_text('[names]\npattern = "{speed} rpm {load} N.csv"\n')
    (run,) = read_with_mapping(log, isothermal=True).log.runs
    assert run.speed[7] == pytest.approx(20 * RPM)


STEPS = [
    {"from": f"{20 * i} s", "to": f"{20 * i + 20} s", "speed": f"{w} rpm"}
    for i, w in enumerate((20, 60, 180))
]


def test_schedules_in_python_in_a_table_and_in_a_mapping_agree(tmp_path: Path) -> None:
    log = written(tmp_path / "log.csv", time=TIME + 3.0, torque=TORQUE)
    table = tmp_path / "plan.csv"
    table.write_text(
        "from [min],to [s],speed [rpm]\n0,20,20\n0.3333333333333333,40,60\n0.6666666666666666,60,180\n"
    )
    mapping = tmp_path / "m.toml"
    mapping.write_text(
        "".join("[[schedule]]\n" + "".join(f'{k} = "{v}"\n' for k, v in s.items()) for s in STEPS)
    )
    runs = [
        hersey.read(log, schedule=STEPS, isothermal=True).runs[0],
        hersey.read(log, schedule=table, isothermal=True).runs[0],
        read_with_mapping(log, mapping=mapping, isothermal=True).log.runs[0],
    ]
    for run in runs:
        np.testing.assert_allclose(run.speed, SPEEDS * RPM, rtol=1e-12)
    points = hersey.read(log, schedule=STEPS, isothermal=True).steady()
    np.testing.assert_allclose(points.column("speed") / RPM, [20, 60, 180], rtol=1e-12)
    (said,) = points.log.files[0].warnings
    assert (said.kind, said.values) == ("set point", {"role": "speed"})


BY_TIME = {"from": "0 s", "to": "60 s", "speed": "1 m/s"}
SLIDING = (0.01, 0.03, 0.1)
SLID = "from [m],to [mm],speed [mm/s]\n0,200,10\n0.2,800,30\n0.8,2800,100\n"  #: 20 s each


@pytest.mark.parametrize("plan", [SLID, "from [s],to [s],speed [m/s]\n0,20,0.01\n20,40,0.03\n40,60,0.1\n"])
def test_a_schedule_of_sliding_speeds_by_time_or_distance(plan: str, tmp_path: Path) -> None:
    speeds = np.repeat(SLIDING, 1000)
    (tmp_path / "plan.csv").write_text(plan)
    log = written(tmp_path / "log.csv", time=TIME, torque=0.3 * speeds**-0.1).read_text()
    (tmp_path / "cof.csv").write_text(log.replace("Torque [N*m]", "COF"))
    read = hersey.read(tmp_path / "cof.csv", schedule=tmp_path / "plan.csv", isothermal=True)
    assert read.domain == Domain("friction coefficient", "sliding speed")
    np.testing.assert_allclose(read.runs[0].speed, speeds, rtol=1e-12)
    np.testing.assert_allclose(read.steady().column("torque"), 0.3 * np.array(SLIDING) ** -0.1, rtol=1e-4)


def test_a_distance_is_the_clock_beside_a_schedule_of_distances(tmp_path: Path) -> None:
    speeds = np.repeat(SLIDING, 1000)
    slid = np.concatenate([[0.0], np.cumsum(0.02 * speeds)[:-1]])
    table = {"Sliding distance [m]": slid + 5.0, "COF": 0.3 * speeds**-0.1}  # not from 0: an earlier test
    (tmp_path / "plan.csv").write_text(SLID)
    pl.DataFrame(table).write_csv(tmp_path / "cof.csv")
    read = hersey.read(tmp_path / "cof.csv", schedule=tmp_path / "plan.csv", isothermal=True)
    np.testing.assert_allclose(read.runs[0].time, TIME, atol=1e-6)
    assert "time from distance" in [each.kind for each in read.files[0].warnings]
    named = {"channels": {"time": "Sliding distance"}, "schedule": tmp_path / "plan.csv", "isothermal": True}
    np.testing.assert_array_equal(hersey.read(tmp_path / "cof.csv", **named).runs[0].time, read.runs[0].time)
    with pytest.raises(ChannelError, match="no time"):
        hersey.read(tmp_path / "cof.csv", schedule=[BY_TIME], isothermal=True)


def test_rows_outside_a_schedule_are_dropped_and_counted(tmp_path: Path) -> None:
    log = written(tmp_path / "log.csv", time=TIME, torque=TORQUE)
    (file,) = hersey.read(log, schedule=[STEPS[0], STEPS[2]], isothermal=True).files
    (outside,) = [each for each in file.warnings if each.kind == "rows outside the schedule"]
    assert outside.values == {"rows": 1000, "all": 3000}
    late = [{"from": "1 h", "to": "2 h", "speed": "9 rpm"}]
    with pytest.raises(UnreadableLogError, match=r"no step of the schedule covers .* lasts 59\.98 s"):
        hersey.read(log, schedule=late, isothermal=True)


@pytest.mark.parametrize(
    ("steps", "said"),
    [
        ([], "has no step"),
        ([{"from": 0, "to": 0, "speed": 1}], "step 1 of the schedule ends at 0 s"),
        ([STEPS[1], STEPS[0]], "step 2 of the schedule begins at 0 s, before the previous one ends (40 s)"),
        ([{"from": "0 s", "speed": "1 rpm"}], "lacks 'to'"),
        ([{"from": "0 s", "to": "1 s", "torque": "1 N*m"}], "unknown key 'torque'"),
        ([{"from": "0 s", "to": "1 s", "speed": "1 mm"}], "mm"),
        ([STEPS[0], {"from": "20 s", "to": "30 s", "speed": "1 m/s"}], "step 2 of the schedule has speed as"),
        (
            [{"from": "0 m", "to": "1 m", "speed": "1 rpm"}],
            'e.g. from = "0 m", to = "20 m", speed = "0.1 m/s"',
        ),
        ([{"from": "1 m", "to": "2 m", "speed": "1 m/s"}], "must begin where the one before ends (0 m)"),
    ],
)
def test_schedules_that_cannot_be(steps: list[dict[str, object]], said: str) -> None:
    with pytest.raises(HerseyError) as refused:
        SetPoints.of(steps)
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("column", "unit", "of_turns"),
    [
        ("Angle", "deg", lambda turns: 360.0 * turns % 360.0),
        ("Angle", "rad", lambda turns: 2 * np.pi * turns),
        ("Count", "rev/4096", lambda turns: np.floor(4096.0 * turns)),
        ("Travel", "mm", lambda turns: 2 * np.pi * 25.0 * turns),
    ],
)
def test_speed_is_the_slope_of_a_position(column: str, unit: str, of_turns: object, tmp_path: Path) -> None:
    turns = np.cumsum(SPEEDS / 60.0 * 0.02)
    path = written(tmp_path / "log.csv", time=TIME, torque=TORQUE, **{column: of_turns(turns)})  # type: ignore[operator]
    radius = 0.025 if unit == "mm" else None
    log = hersey.read(
        path, channels={"position": column}, units={"position": unit}, radius=radius, isothermal=True
    )
    points = log.steady()
    np.testing.assert_allclose(points.column("speed") / RPM, [20, 60, 180], rtol=1e-4)
    (said,) = [each for each in log.files[0].warnings if each.kind == "speed from position"]
    assert said.values["window"] == pytest.approx(0.2)
    if unit == "rev/4096":
        assert said.values["step"] == pytest.approx(2 * np.pi / 4096 / 0.2)
    assert said.values["turns"] == (int(turns[-1]) if unit == "deg" else 0)


def test_the_angle_turned_stays_and_a_ramp_keeps_its_slope() -> None:
    time = np.arange(1000) * 0.01
    speed, over = slope(time, 0.5 * 3.0 * time**2, 0.2)
    assert over == pytest.approx(0.2)
    np.testing.assert_allclose(speed[10:-10], 3.0 * time[10:-10], rtol=1e-9)
    turned, count = unwrapped(np.mod(-2.0 * time, 2 * np.pi))
    np.testing.assert_allclose(turned - turned[0], -2.0 * time, atol=1e-9)
    assert count == 4
    far = np.array([0.0, 40.0, 3.0])
    assert unwrapped(far) == (far, 0) or np.array_equal(unwrapped(far)[0], far)


@pytest.mark.parametrize(
    "words", [("CW", "CCW"), ("F", "R"), ("1", "-1"), ("1", "0"), ("fwd", "rev"), ("TRUE", "FALSE")]
)
def test_a_speed_without_sign_gets_that_of_its_direction(words: tuple[str, str], tmp_path: Path) -> None:
    back = np.arange(3000) % 1000 >= 500
    signs = np.where(back, -1.0, 1.0)
    direction = [words[int(each)] for each in back]
    path = written(tmp_path / "log.csv", time=TIME, torque=TORQUE * signs, speed=SPEEDS, Dir=direction)
    log = hersey.read(path, channels={"direction": "Dir"}, isothermal=True)
    np.testing.assert_allclose(log.runs[0].speed, SPEEDS * signs * RPM, rtol=1e-12)
    (said,) = [each for each in log.files[0].warnings if each.kind == "sign from direction"]
    assert said.values == {"channel": "Dir", "forward": 1500, "reverse": 1500}


def test_other_words_for_a_direction_are_refused(tmp_path: Path) -> None:
    path = written(tmp_path / "log.csv", time=TIME, torque=TORQUE, speed=SPEEDS, Dir=["left"] * 3000)
    with pytest.raises(
        UnreadableLogError, match=r"log\.csv: column 'Dir': 'left' is not a direction"
    ) as refused:
        hersey.read(path, channels={"direction": "Dir"}, isothermal=True)
    assert "CW and CCW" in refused.value.remedy


def test_two_sources_of_one_speed_are_refused(tmp_path: Path) -> None:
    path = written(tmp_path / "20 rpm.csv", time=TIME, torque=TORQUE, speed=SPEEDS, angle=TIME)
    ways = {
        "name_pattern": {"channels": {"speed": "Speed"}, "name_pattern": "{speed} rpm.csv"},
        "schedule": {"schedule": STEPS, "name_pattern": "{speed} rpm.csv"},
        "position": {"channels": {"speed": "Speed", "position": "Angle"}},
    }
    for said, given in ways.items():
        with pytest.raises(ParameterError, match="both give the speed") as refused:
            hersey.read(path, isothermal=True, **given)  # type: ignore[arg-type]
        assert said in str(refused.value)


def test_options_recipe_and_its_file_agree(tmp_path: Path) -> None:
    plan = tmp_path / "plan.csv"
    plan.write_text("from [s],to [s],temperature [degC]\n0,60,80\n")
    log = named(tmp_path)[0]
    typed = Reading(
        name_pattern="{speed} rpm {load} N.csv", schedule=str(plan), position_window="50 ms"
    ).recipe([log])
    made = Recipe(logs=(log,), name_pattern="{speed} rpm {load} N.csv", schedule=plan, position_window=0.05)
    assert typed == made
    made.save(tmp_path / "recipe.toml")
    assert Recipe.from_file(tmp_path / "recipe.toml") == made
    again, logs = Reading(recipe_file=str(tmp_path / "recipe.toml")).completed(set())
    assert again.recipe(logs) == made
    (run,) = made.log().runs
    assert run.temperature is not None
    np.testing.assert_allclose(run.temperature, 353.15)
