"""Wrong calls of what is public: each is refused by an error that names the argument and what to type."""

from __future__ import annotations

import dataclasses
import inspect
import re
import timeit
import warnings
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import hersey
from hersey.errors import ArgumentError, ExtrapolationWarning, HerseyError, ParameterError, WrongKindError
from hersey.units import parse, takes_si
from tests.conftest import ROOT

H: Any = hersey  # calls that no type checker allows
TRAIN = hersey.Drivetrain(1000.0, 1.0)
DRAG = hersey.Drag(50.0, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
MACHINE = hersey.Machine(11e3, 11.0, roll_radius=0.015, stick_speed=3e-4)
CONTACT = hersey.Contact(
    roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48, length=0.22, load=250.0
)
#: Kinds of the fields that are set below.
KINDS_OF = {"stiffness": "stiffness", "mass": "mass", "transition_speed": "belt speed", "nip_load": "force"}
#: What no argument of a function takes, beside those that take anything.
NOTHING = object()


@cache
def log_points() -> hersey.SteadyPoints:
    return hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing")


@cache
def surface() -> hersey.DampingSurface:
    return hersey.fit(log_points())


def checked() -> Iterator[tuple[str, Any]]:
    """Public functions, and records that users make, which check their arguments."""
    for name in hersey.__all__:
        thing = getattr(hersey, name)
        if (
            (inspect.isfunction(thing) and name != "memory_limit")
            or (inspect.isclass(thing) and "_check_fields" in getattr(thing.__init__, "__qualname__", ""))
            or hasattr(thing.__init__, "__wrapped__")
        ):
            yield name, thing


def test_no_function_takes_an_unknown_or_leaves_out_a_needed_argument() -> None:
    functions = dict(checked())
    assert len(functions) > 45
    for name, function in functions.items():
        signature = inspect.signature(function)
        needed = [
            p.name
            for p in signature.parameters.values()
            if p.default is p.empty and p.kind is not p.VAR_KEYWORD
        ]
        if not any(p.kind is p.VAR_KEYWORD for p in signature.parameters.values()):
            with pytest.raises(ArgumentError, match=f"{name} has no argument 'zzz'. "):
                function(**dict.fromkeys(needed), zzz=1)
        if needed:
            with pytest.raises(ArgumentError, match=f"{name} needs the argument {needed[0]}"):
                function()


def test_no_function_takes_a_value_of_a_wrong_type() -> None:
    for name, function in checked():
        for each in inspect.signature(function).parameters.values():
            call = function if inspect.isfunction(function) else function.__init__
            while "door" not in (held := inspect.getclosurevars(call).nonlocals):
                call = call.__wrapped__
            door = held["door"]
            argument = door.arguments.get(each.name)
            if argument is None or "anything" in argument.kinds:
                continue
            assert argument.wanted, (name, each.name)
            for wrong in (hersey.Work(), {1, 2}, NOTHING):
                accepted = argument.fits(wrong) and type(wrong).__name__ not in argument.classes
                assert not accepted or (wrong is NOTHING and argument.takes_numbers), (name, each.name)


TEMPERATURES: list[Callable[[Any], object]] = [
    lambda t: surface().damping(speed=4.0, temperature=t),
    lambda t: surface().drag(roll_radius=0.015, stick_speed=3e-4, temperature=t),
    lambda t: surface().transition_speed(t),
    lambda t: hersey.stick_slip(MACHINE, surface(), drive_speed=0.1, temperature=t),
    lambda t: hersey.operating_map(surface(), MACHINE, temperatures=[t, 400.0]),
    lambda t: hersey.OperatingPoint("hot", 0.1, t),
    lambda t: hersey.BoundaryFriction(0.1, temperature=t),
]


@pytest.mark.parametrize("call", TEMPERATURES)
def test_a_temperature_in_degrees_without_a_unit_is_refused(call: Callable[[Any], object]) -> None:
    with pytest.raises(ParameterError, match=r"is 180 without a unit, .* Write '180 degC', or '180 K'"):
        call(180)
    with pytest.raises(ParameterError, match=r"Write '-5 degC'$"):
        call(-5.0)


def test_swapped_arguments_are_named() -> None:
    for function, rest in (
        (H.stick_slip, {"drive_speed": 0.1}),
        (H.simulate, {"drive_speed": 0.1, "duration": 1.0}),
        (H.disturbance, {"drive_speed": 0.1}),
        (H.hysteresis, {}),
    ):
        with pytest.raises(TypeError, match="Swap train and drag: write hersey"):
            function(surface(), MACHINE, temperature=400.0, **rest)
    with pytest.raises(ParameterError, match="report needs a study"):
        H.report(MACHINE, "page.html")
    with pytest.raises(ParameterError, match="study needs steady points"):
        H.study(MACHINE, surface())
    with pytest.raises(TypeError, match=r"needs the argument b, SteadyPoints. Write hersey.compare\(a, b\)"):
        H.compare(3)


def test_a_near_name_is_proposed_and_all_are_listed() -> None:
    with pytest.raises(
        TypeError, match=r"Did you mean drive_speed\? Its arguments are train, drag, drive_speed"
    ):
        H.stick_slip(TRAIN, DRAG, speed=1.0)
    with pytest.raises(TypeError, match=r"Did you mean temperature\?"):
        H.film_thickness(None, None, speed=1.0, temp=400.0)


@pytest.mark.parametrize(
    ("speed", "says"),
    [
        ("25", "speed: '25' is not a number with a unit of speed. Write e.g. '25 rpm'"),
        ("25 foo", "speed: unknown unit 'foo'"),
        (
            pd.DataFrame({"n": [1.0]}),
            "speed is a table with the columns n.*Give one column, e.g. table\\['n'\\]",
        ),
        (np.ma.masked_array([1.0, 2.0], [True, False]), "speed has 1 masked value. Drop them"),
        (float("nan"), "speed is NaN"),
        (MACHINE, "speed is a Machine. It must be"),
        (["1 rpm", "2 mm"], "speed: unit 'mm'"),
    ],
)
def test_what_is_no_speed_is_named(speed: Any, says: str) -> None:
    with pytest.raises(HerseyError, match=says):
        surface().predict(speed=speed, temperature=420.0)
    if not isinstance(speed, list):
        with pytest.raises(
            HerseyError, match=says.replace("of speed", "of sliding speed").replace("25 rpm", "25 mm/s")
        ):
            hersey.stick_slip(TRAIN, DRAG, drive_speed=speed)


def test_columns_of_numbers_or_texts_are_taken() -> None:
    expected = surface().torque(speed=[4.0, 5.0], temperature=400.0)
    for speed in (pd.Series([4.0, 5.0]), pd.Series(["4 rad/s", "5 rad/s"]), np.array(["4 rad/s", "5 rad/s"])):
        np.testing.assert_allclose(surface().torque(speed=speed, temperature=400), expected, rtol=1e-12)
    with pytest.raises(ArgumentError, match="drive_speed has 2 values"):
        H.stick_slip(TRAIN, DRAG, drive_speed=[1.0, 2.0])


def test_a_speed_or_a_temperature_outside_the_log_is_said_once(tmp_path: Path) -> None:
    drag = surface().drag(roll_radius=0.015, stick_speed=3e-4)
    fixed: dict[str, Any] = {"temperature": 420.0}
    one, fmu = drag.at(420.0), tmp_path / "drive.fmu"
    slow, again = [0.1, 1e-5], {"overwrite": True}
    far: list[tuple[str, Callable[[], object]]] = [
        ("drive_speed is 2.5e", lambda: hersey.stick_slip(MACHINE, surface(), drive_speed=25, **fixed)),
        ("drive_speed is 2.5e", lambda: hersey.stick_slip(TRAIN, drag, drive_speed=25, **fixed)),
        ("drive_speed is 2.5e", lambda: hersey.simulate(TRAIN, drag, drive_speed=25, duration=0.01, **fixed)),
        ("drive_speed is 2.5e", lambda: hersey.disturbance(MACHINE, surface(), drive_speed=25, **fixed)),
        ("temperature is 250 degC", lambda: hersey.hysteresis(MACHINE, surface(), temperature="250 degC")),  # type: ignore[arg-type]
        ("drive_speed is 2.5e", lambda: hersey.sweep(TRAIN, one, drive_speed=[0.1, 25])),
        ("drive_speed is 0.01 mm/s", lambda: hersey.sweep(TRAIN, one, drive_speed=slow, mass=[1, 2])),
        ("temperature is 250 degC", lambda: H.hysteresis_sweep(TRAIN, drag, temperature=[420, 523.15])),
        ("temperature is 250 degC", lambda: drag.at("250 degC")),  # type: ignore[arg-type]
        ("drive_speed is 2.5e", lambda: hersey.Stepper(TRAIN, drag, drive_speed=25, **fixed)),
        ("temperature is 250 degC", lambda: H.Stepper(TRAIN, drag, drive_speed=0.1, temperature="250 degC")),
        ("drive_speed is 2.5e", lambda: hersey.export_fmu(fmu, TRAIN, drag, drive_speed=25, **fixed)),
        ("temperature is 250", lambda: H.export_fmu(fmu, TRAIN, drag, temperature="250 degC", **again)),
        ("temperature is outside", lambda: surface().transition_torque(523.0)),
        ("temperature is outside", lambda: surface().stick_speed_at(523.0, stick_speed=3e-4)),
    ]
    for says, call in far:
        with pytest.warns(ExtrapolationWarning, match=says) as warned:
            call()
        assert [str(Path(each.filename).name) for each in warned] == ["test_wrong_calls.py"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hersey.simulate(MACHINE, surface(), drive_speed=0.1, duration=0.01, **fixed)
        hersey.operating_map(surface(), MACHINE, temperatures=[330.0, 480.0], draws=1)
        hersey.sweep(TRAIN, one, drive_speed=[0.05, 0.1], stick_speed=[1e-4, 1e-3])
        hersey.sweep(TRAIN, one, drive_speed=[0.1, 25], transition_force=1.0)  # no longer that of the log
        hersey.hysteresis_sweep(TRAIN, drag, temperature=[400.0, 420.0])
        hersey.export_fmu(fmu, TRAIN, drag, overwrite=True, **fixed)  # a drive at rest


def test_a_stepper_says_each_time_that_it_leaves_the_range_of_the_log() -> None:
    drag = surface().drag(roll_radius=0.015, stick_speed=3e-4)
    stepper = hersey.Stepper(TRAIN, drag, drive_speed=0.1, temperature=420.0)
    said = []
    for inputs in (
        {"drive": 25.0},
        {"drive": 26.0},
        {"temperature": 523.15},
        {"drive": 0.1},
        {"drive": 25.0},
    ):
        with warnings.catch_warnings(record=True) as seen:
            warnings.simplefilter("always")
            stepper.set_inputs(**inputs)
        said.append([(str(each.message).split()[0], Path(each.filename).name) for each in seen])
    here = Path(__file__).name
    speed, heat = [("drive_speed", here)], [("temperature", here)]
    assert said == [speed, [], heat, [], speed]


def test_the_range_of_the_log_ends_where_its_dwells_end() -> None:
    """Twice the fastest dwell is outside, half the slowest too, and what is a thousandth beyond is not."""
    drag = surface().drag(roll_radius=0.015, stick_speed=3e-4)
    assert drag.measured is not None
    low, high = drag.measured.speed
    for speed, beyond in ((2 * high, 1), (1.01 * high, 1), (1.0005 * high, 0), (low, 0), (0.5 * low, 1)):
        with warnings.catch_warnings(record=True) as seen:
            warnings.simplefilter("always")
            drag.measured.warn(None, {"drive_speed": speed}, 1)
        assert len(seen) == beyond, speed


def test_two_numbers_that_could_be_swapped_are_given_by_name() -> None:
    with pytest.raises(TypeError, match=r"Give the others by name: force\(speed, temperature=...\)"):
        H.Drag.force(DRAG, 1.0, 400.0)


BENCH = ROOT / "examples" / "bench.csv"


@pytest.mark.parametrize(
    ("call", "written"),
    [
        (lambda: H.read(BENCH, torque_unit="mN*m"), {"units": {"torque": "mN*m"}}),
        (lambda: H.read(BENCH, torque_units="mN*m"), {"units": {"torque": "mN*m"}}),
        (lambda: H.read(BENCH, torque="Drive torque"), {"channels": {"torque": "Drive torque"}}),
        (lambda: H.read_many(BENCH, torque="Drive torque"), {"channels": {"torque": "Drive torque"}}),
        (lambda: H.read_with_mapping(BENCH, torque_sign=-1), {"signs": {"torque": -1}}),
        (lambda: H.inspect(BENCH, torque_unit="mN*m"), {"units": {"torque": "mN*m"}}),
        (
            lambda: H.read(BENCH, channels={"Drive torque": "torque", "time": "Time"}),
            {"channels": {"torque": "Drive torque", "time": "Time"}},
        ),
        (lambda: H.read(BENCH, units={"mN*m": "torque"}), {"units": {"torque": "mN*m"}}),
    ],
)
def test_a_column_or_unit_given_outside_its_dictionary_gets_the_dictionary_to_write(
    call: Callable[[], Any], written: dict[str, dict[str, Any]]
) -> None:
    with pytest.raises(ParameterError) as refused:
        call()
    advice = str(refused.value).rpartition("Write ")[2]
    assert eval(f"dict({advice})") == written
    if "signs" not in written:
        assert hersey.read(BENCH, **written).rows > 10_000


@pytest.mark.parametrize("read", [H.read, H.inspect, H.read_with_mapping])
def test_what_must_be_a_dictionary_comes_with_an_example(read: Any) -> None:
    for name, example in (("units", "{'torque': 'Nm'}"), ("channels", "{'torque': 'Torque 1'}")):
        with pytest.raises(ArgumentError) as refused:
            read(BENCH, **{name: "Nm"})
        assert str(refused.value).endswith(f"It must be a dictionary, e.g. {name}={example}")
    assert (
        H.inspect(BENCH, radius="15 mm", load=None, units=None).problem == ""
    )  # arguments that are no roles


def test_the_check_of_a_call_takes_microseconds() -> None:
    @takes_si(speed="speed", temperature="temperature")
    def nothing(law: object, *, speed: float, temperature: float | None = None) -> None:
        del law, speed, temperature

    runs = timeit.repeat(lambda: nothing(None, speed=1.0, temperature=400.0), number=200, repeat=20)
    assert min(runs) / 200 < 50e-6


@pytest.mark.parametrize(
    ("path", "shown", "found"),
    [
        ("C:\temp\new.csv", r"C:\temp\new.csv", r"\t and \n"),
        ("C:\temp\n*.csv", r"C:\temp\n*.csv", r"\t and \n"),
        ("logs\2024.csv", r"logs\2024.csv", r"\202"),
        ("logs\bench.csv", r"logs\bench.csv", r"\b"),
    ],
)
def test_a_path_whose_backslashes_python_took_as_escapes_is_shown_as_it_was_meant(
    path: str, shown: str, found: str
) -> None:
    with pytest.raises(hersey.errors.MissingFileError) as refused:
        hersey.read(path)
    assert shown in refused.value.reason
    assert refused.value.remedy.startswith(f"Python reads {found} in")
    assert eval(refused.value.remedy.split("Write ")[1]) == shown.replace("\\", "/")


@pytest.mark.parametrize("typed", ["folder\bench.csv", r"folder\bench.csv", "folderbench.csv"])
def test_a_path_with_backslashes_gets_the_name_of_the_file_that_is_there(
    typed: str, bench_csv: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "bench.csv").write_bytes(bench_csv.read_bytes())
    with pytest.raises(hersey.errors.MissingFileError) as refused:
        hersey.read(typed)
    advised = re.search(r"""["'](\S+)["']$""", refused.value.remedy)
    assert advised is not None
    assert hersey.read(advised[1]).rows > 1000
    assert ". ." not in str(refused.value)


@pytest.mark.parametrize(
    ("record", "name", "value"),
    [
        (MACHINE, "stiffness", "12 N/mm"),
        (TRAIN, "mass", "2 kg"),
        (DRAG, "transition_speed", "30 mm/s"),
        (hersey.Limits(), "nip_load", "300 N"),
    ],
)
def test_a_record_that_is_set_names_the_call_that_makes_another_one(
    record: Any, name: str, value: str
) -> None:
    with pytest.raises(dataclasses.FrozenInstanceError) as refused:
        setattr(record, name, value)
    call = str(refused.value).split(" = ")[-1]
    variable = call.split("(")[1].split(",")[0]
    made = eval(call, {"dataclasses": dataclasses, variable: record})  # as it is printed
    assert getattr(made, name) == pytest.approx(parse(KINDS_OF[name], value))
    with pytest.raises(dataclasses.FrozenInstanceError, match="has no field 'zzz'"):
        record.zzz = 1


def test_a_result_that_is_set_names_the_call_that_makes_another_one() -> None:
    cycles = hersey.rainflow_cycles(np.array([0.0, 1.0, 0.0, 2.0, 0.0]))
    with pytest.raises(dataclasses.FrozenInstanceError) as refused:
        cycles.means = cycles.ranges  # type: ignore[misc]
    call = str(refused.value).split(" = ")[-1]
    assert call == "dataclasses.replace(rainflow_cycles, means=...)"
    made = eval(
        call.replace("...", "ranges"), vars(cycles) | {"rainflow_cycles": cycles, "dataclasses": dataclasses}
    )
    assert made.means is cycles.ranges


def test_every_public_frozen_record_says_how_to_get_another_one() -> None:
    for name in hersey.__all__:
        record = getattr(hersey, name)
        if inspect.isclass(record) and dataclasses.is_dataclass(record):
            assert hasattr(record.__setattr__, "__wrapped__"), name


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: H.fit(temperature_scale=1, points=log_points()), ("degC", "K")),
        (lambda: H.nip_width(CONTACT, rule=1), ("layer", "hertz", "paper")),
        (lambda: dataclasses.replace(DRAG, closure=H), ("retained", "stiction", "stribeck", "lugre")),
        (lambda: surface().drag(roll_radius=0.015, stick_speed=1e-3, stick_speed_rule=1), ("fixed",)),
        (lambda: H.TorqueLog.steady(None, tare=True), ("none", "standing")),
        (lambda: H.TorqueLog.steady(None, rotation=1), ("both", "forward", "reverse")),
        (lambda: H.export_fmu("a.fmu", TRAIN, DRAG, drive_speed=1.0, fmi=3.0), ("3.0", "2.0")),
    ],
)
def test_an_argument_with_few_words_lists_them(call: Callable[[], Any], words: tuple[str, ...]) -> None:
    with pytest.raises(ArgumentError) as refused:
        call()
    for word in words:
        assert f"'{word}'" in refused.value.reason


def test_a_number_beside_a_wrong_value_is_not_taken_for_it() -> None:
    with pytest.raises(ArgumentError) as caught:
        hersey.simulate(TRAIN, DRAG, drive_speed=H.fit, duration=1.0)
    assert "which was given as" not in str(caught.value)
    with pytest.raises(ParameterError, match=r"Did you mean transition_speed, stick_speed or drive_speed\?"):
        H.sweep(TRAIN, DRAG, speed=[0.1])
    with pytest.raises(ArgumentError, match=r"rest is a Machine\. .* with rest = machine\.rest or"):
        log_points().without(H.Machine(11e3, 11.0, roll_radius=0.015, stick_speed=3e-4))
    with pytest.raises(LookupError, match=r"no column 'torque \[mN\*m\]'\. Did you mean 'torque'\?"):
        log_points().column("torque [mN*m]")
    with pytest.raises(WrongKindError, match=r"rpm' is that of a speed of rotation, .* the radius"):
        H.stick_slip(TRAIN, DRAG, drive_speed="20 rpm")
