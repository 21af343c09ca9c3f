"""Arguments in SI however they are given: a number, text with its unit, a pint quantity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from functools import cache, partial
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import hersey
from hersey.errors import ArgumentError, ParameterError, PlausibilityWarning, UnitError, WrongKindError
from hersey.units import argument, registry, takes_si
from hersey.verdict.evidence import measured_film
from tests.conftest import ROOT

TRAIN = hersey.Drivetrain(1000.0, 1.0)
DRAG = hersey.Drag(50.0, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
WARM = hersey.Drag(
    50.0,
    1.0,
    ehl_exponent=-0.7,
    mixed_exponent=-1.2,
    stick_speed=0.01,
    reference_temperature=400.0,
    force_temperature_exponent=-1.0,
)
ROLL = hersey.Contact(
    roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48, length=0.22, load=250.0
)
LAYER: dict[str, Any] = {
    "effective_modulus": 2.63e6,
    "layer": hersey.ElasticLayer("3.5 mm", 0.49),  # type: ignore[arg-type]
    "nodes": 51,
}


def oil() -> hersey.Lubricant:
    from hersey.lubrication.lubricant import EXAMPLES

    return EXAMPLES["cylinder oil"]


@cache
def surface() -> hersey.DampingSurface:
    return hersey.fit(hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing"))


@cache
def models() -> hersey.ModelComparison:
    points = hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing")
    return hersey.compare_models(points, bootstrap=0, cross_validate=False)


def drag_of(**changed: Any) -> hersey.Drag:
    values = {"transition_force": 50.0, "transition_speed": 1.0, "stick_speed": 0.01, **changed}
    return hersey.Drag(ehl_exponent=-0.7, mixed_exponent=-1.2, **values)


def contact_of(**changed: Any) -> hersey.Contact:
    return replace(ROLL, **changed)


def at_speed(v: Any) -> float:
    return hersey.stick_slip(TRAIN, DRAG, drive_speed=v).frequency


def for_time(v: Any) -> Any:
    return hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=v, samples=3).belt_speed


#: What each argument decides, its unit, and the range of its numbers in that unit.
TAKEN: list[tuple[str, Callable[[Any], Any], str, float, float]] = [
    ("drive_speed", at_speed, "mm/s", 500.0, 1500.0),
    ("duration", for_time, "ms", 10.0, 300.0),
    (
        "temperature",
        lambda v: hersey.hysteresis(TRAIN, WARM, temperature=v, sensitivity=False).upper,
        "degC",
        80.0,
        180.0,
    ),
    (
        "slowest",
        lambda v: hersey.cycles_without_sticking(TRAIN, DRAG, slowest=v).drive_speed,
        "mm/s",
        20.0,
        900.0,
    ),
    (
        "stiffness",
        lambda v: hersey.hysteresis_sweep(TRAIN, DRAG, stiffness=v, lower=False).upper.values,
        "N/mm",
        0.5,
        2.0,
    ),
    (
        "mass",
        lambda v: hersey.sweep(TRAIN, DRAG, drive_speed=1.0, mass=v).frequency.values,
        "g",
        500.0,
        2000.0,
    ),
    ("stiffness", lambda v: hersey.Drivetrain(v, 1.0).stiffness, "N/mm", 0.1, 100.0),
    (
        "inertia",
        lambda v: hersey.Drivetrain.rotational(stiffness=2.0, inertia=v, roll_radius=0.02).mass,
        "g*cm^2",
        1.0,
        100.0,
    ),
    ("transition_force", lambda v: drag_of(transition_force=v).transition_force, "kN", 0.01, 1.0),
    ("stick_speed", lambda v: drag_of(stick_speed=v).stick_speed, "mm/s", 1.0, 100.0),
    (
        "reference_temperature",
        lambda v: drag_of(reference_temperature=v).reference_temperature,
        "degC",
        20.0,
        200.0,
    ),
    (
        "bristle_damping",
        lambda v: drag_of(closure="lugre", bristle_stiffness=1e5, bristle_damping=v).bristle_damping,
        "N*s/mm",
        0.01,
        1.0,
    ),
    (
        "transition_torque",
        lambda v: (
            hersey.Drag.rotational(
                transition_torque=v,
                transition_speed=2.0,
                roll_radius=0.015,
                ehl_exponent=-0.7,
                mixed_exponent=-1.2,
                stick_speed=1e-3,
            ).transition_force
        ),
        "mN*m",
        10.0,
        1000.0,
    ),
    ("values", lambda v: hersey.Schedule([0.0, 1.0], [v, v]).at(0.5), "rpm", 1.0, 400.0),
    ("load", lambda v: contact_of(load=v).load, "kN", 0.1, 1.0),
    ("modulus", lambda v: contact_of(modulus=v).effective_modulus, "MPa", 0.5, 5.0),
    ("load", lambda v: hersey.nip_width(ROLL, load=v), "kN", 0.1, 1.0),
    (
        "speed",
        lambda v: hersey.film_thickness(ROLL, oil(), speed=v, temperature=400.0).minimum,
        "rpm",
        1.0,
        400.0,
    ),
    ("temperature", lambda v: hersey.drag_torque(ROLL, oil(), speed=4.0, temperature=v), "degC", 40.0, 90.0),
    (
        "viscosity",
        lambda v: hersey.solve_line_contact(0.015, 1136.0, 0.1, v, **LAYER).minimum_thickness,
        "mPa*s",
        80.0,
        120.0,
    ),
    (
        "points",
        lambda v: hersey.Lubricant("arrhenius", ((313.15, v), (373.15, 1e-3))).points[0][1],
        "mPa*s",
        10.0,
        100.0,
    ),
    (
        "density",
        lambda v: hersey.Lubricant("arrhenius", oil().points[:2], density=v).density,
        "g/cm^3",
        0.7,
        2.0,
    ),
    ("speed", lambda v: surface().damping(speed=v, temperature=420.0), "rpm", 10.0, 100.0),
    ("temperature", lambda v: surface().torque(speed=4.0, temperature=v), "degC", 95.0, 175.0),
    ("speed", lambda v: surface().predict(speed=v, temperature=420.0).torque, "rpm", 10.0, 100.0),
    ("stick_speed", lambda v: surface().drag(roll_radius=0.015, stick_speed=v).stick_speed, "mm/s", 0.1, 1.0),
    ("speed", lambda v: models().predict(speed=v, temperature=420.0).torque, "rpm", 10.0, 100.0),
]


@pytest.mark.parametrize(("name", "call", "unit", "low", "high"), TAKEN)
def test_a_number_a_text_and_a_quantity_are_one(
    name: str, call: Callable[[Any], Any], unit: str, low: float, high: float
) -> None:
    @settings(max_examples=4, derandomize=True, deadline=None, database=None)
    @given(st.floats(low, high, allow_nan=False))
    def check(value: float) -> None:
        quantity = registry.Quantity(value, unit)
        written = call(f"{value!r} {unit}")
        plain = float(quantity.to_base_units().magnitude) if unit != "rpm" else value * np.pi / 30
        np.testing.assert_allclose(written, call(plain), rtol=1e-9, err_msg=name)
        np.testing.assert_array_equal(written, call(quantity))

    check()


@pytest.mark.parametrize(("name", "call"), [row[:2] for row in TAKEN])
def test_a_wrong_unit_names_its_argument(name: str, call: Callable[[Any], Any]) -> None:
    with pytest.raises(UnitError, match=name):
        call("3 mol")


def test_lists_of_texts_become_arrays() -> None:
    torque = hersey.drag_torque(ROLL, oil(), speed=["40 rpm", "80 rpm"], temperature=["100 degC", 380.0])
    expected = hersey.drag_torque(
        ROLL, oil(), speed=np.array([40.0, 80.0]) * np.pi / 30, temperature=[373.15, 380.0]
    )
    np.testing.assert_allclose(torque, expected, rtol=1e-12)
    table = hersey.DragTable(["10 mm/s", "1 m/s"], ["120 N", 50.0], stick_speed="10 mm/s")  # type: ignore[arg-type]
    assert (table.speeds, table.forces, table.stick_speed) == ((0.01, 1.0), (120.0, 50.0), 0.01)


def test_dwells_and_drives_take_units(stick_slip_record: hersey.CycleRecord) -> None:
    log = hersey.read(ROOT / "examples" / "bench.csv")
    assert log.steady(min_dwell="4000 ms").table.equals(log.steady(min_dwell=4.0).table)  # type: ignore[arg-type]
    assert stick_slip_record.drive_speed == 1.0
    drive = hersey.identify(stick_slip_record, known={"mass": "1000 g"}, closures=("retained",))  # type: ignore[dict-item]
    assert drive.known == {"mass": 1.0}
    with pytest.raises(UnitError, match="known mass"):
        hersey.identify(stick_slip_record, known={"mass": "1 s"})  # type: ignore[dict-item]


@pytest.fixture
def stick_slip_record() -> hersey.CycleRecord:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=10.0, samples=10001)
    return hersey.cycles(run.time, run.spring_force, drive_speed="1000 mm/s")  # type: ignore[arg-type]


def test_speeds_of_the_stability_room_take_units() -> None:
    assert hersey.safe_step(TRAIN, DRAG, from_speed="250 cm/s", to_speed=1.2) == hersey.safe_step(  # type: ignore[arg-type]
        TRAIN, DRAG, from_speed=2.5, to_speed=1.2
    )
    bears = hersey.disturbance(TRAIN, DRAG, drive_speed="1200 mm/s")  # type: ignore[arg-type]
    assert bears == hersey.disturbance(TRAIN, DRAG, drive_speed=1.2)
    with pytest.raises(UnitError, match="target_speed"):
        hersey.plan_profile(TRAIN, DRAG, target_speed="60 rpm")  # type: ignore[arg-type]


def test_what_a_sweep_varies_takes_units_by_name() -> None:
    stick_speed = registry.Quantity(10, "mm/s")
    texts: dict[str, Any] = {"stiffness": ["0.9 N/mm", "1.1 N/mm"], "stick_speed": stick_speed}
    plain = {"stiffness": [900.0, 1100.0], "stick_speed": 0.01}
    for sweep in (hersey.hysteresis_sweep, partial(hersey.sweep, drive_speed="1000 mm/s")):
        swept, same = (sweep(TRAIN, DRAG, **each) for each in (texts, plain))  # type: ignore[operator]
        xr.testing.assert_allclose(swept, same, rtol=1e-14)
        with pytest.raises(UnitError, match="stiffness: "):
            sweep(TRAIN, DRAG, stiffness="1 s")  # type: ignore[operator]


def test_draws_of_a_band_take_units() -> None:
    texts: dict[str, Any] = {
        "stiffness": ["0.9 N/mm", "1.1 N/mm", "1 N/mm"],
        "mixed_exponent": [-1.2, -1.1, -1.3],
    }
    plain = texts | {"stiffness": [900.0, 1100.0, 1000.0]}
    band, same = (hersey.hysteresis(TRAIN, DRAG, samples=each, sensitivity=False) for each in (texts, plain))
    assert band.interval == same.interval
    with pytest.raises(UnitError, match="samples of mass"):
        hersey.hysteresis(TRAIN, DRAG, samples={"mass": ["1 s"]})


def test_the_range_of_a_design_takes_units() -> None:
    plain = hersey.design(models(), count=1, speeds=(1.0, 10.0), temperatures=(373.15, 393.15))
    speeds, temperatures = ("1 rad/s", "10 rad/s"), ("100 degC", "120 degC")
    assert hersey.design(models(), count=1, speeds=speeds, temperatures=temperatures).points == plain.points  # type: ignore[arg-type]
    with pytest.raises(UnitError, match="speeds"):
        hersey.design(models(), speeds=("1 mm", "2 mm"))  # type: ignore[arg-type]


def test_the_temperature_of_a_measured_film_takes_units() -> None:
    points = hersey.read(ROOT / "examples" / "bench.csv", isothermal=True).steady(tare="standing")
    kelvin: list[Any] = [373.15, "100 degC"]
    one, other = (
        measured_film(points, hersey.fit(points), ROLL, oil(), temperature=each).thickness for each in kelvin
    )
    np.testing.assert_array_equal(one, other)


def test_the_map_takes_units() -> None:
    map_ = hersey.operating_map(
        surface(),
        hersey.Machine("11 N/mm", "11 kg", roll_radius="15 mm", stick_speed="0.3 mm/s"),  # type: ignore[arg-type]
        temperatures=["100 degC", "150 degC"],
        speeds=["10 mm/s", "100 mm/s"],
        draws=1,
    )
    assert map_.temperature is not None
    assert map_.temperature.tolist() == [373.15, 423.15]
    assert map_.state_at(temperature="120 degC", speed="45 mm/s") == map_.state_at(
        temperature=393.15, speed=0.045
    )  # type: ignore[arg-type]


def test_one_of_several_kinds() -> None:
    assert argument("drive", ("force", "torque"), "3 N") == 3.0
    assert argument("drive", ("force", "torque"), "3 mN*m") == pytest.approx(3e-3)
    assert argument("drive", ("force", "torque"), 7.0) == 7.0
    with pytest.raises(WrongKindError, match="drive: unit 's'"):
        argument("drive", ("force", "torque"), "3 s")
    with pytest.raises(UnitError, match="drive: '3'"):
        argument("drive", ("force", "torque"), "3")


def test_a_function_keeps_its_name_and_its_defaults() -> None:
    @takes_si(length="length")
    def double(length: float = 2.0, other: str = "3 mm") -> tuple[float, str]:
        """Say it."""
        return 2.0 * length, other

    assert (double.__name__, double.__doc__) == ("double", "Say it.")
    assert double() == (4.0, "3 mm")
    assert double("5 mm", "4 mm") == (pytest.approx(0.01), "4 mm")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="double has no argument 'width'"):
        double(width=1.0)  # type: ignore[call-arg]


@pytest.mark.parametrize("given", [timedelta(seconds=0.5), np.timedelta64(500, "ms")])
def test_a_duration_with_its_unit_is_a_time(given: Any) -> None:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=2.0, duration=given)
    assert run.time[-1] == 0.5
    with pytest.raises(ArgumentError, match=r"drive_speed is .*the duration .*one number|drive_speed is not"):
        hersey.simulate(TRAIN, DRAG, drive_speed=given, duration=1.0)


def test_months_have_no_length() -> None:
    with pytest.raises(ArgumentError, match="the duration 2 months"):
        hersey.simulate(TRAIN, DRAG, drive_speed=2.0, duration=np.timedelta64(2, "M"))


def test_a_roll_radius_in_mm_without_its_unit_is_doubted() -> None:
    said = "^roll_radius is 15 without a unit, which means 15 m. If it is in mm, write '15 mm'$"
    with pytest.warns(PlausibilityWarning, match=said) as found:
        surface().drag(roll_radius=15, stick_speed=3e-3, temperature="180 degC")
    assert found[0].filename == __file__
    for known in (0.015, "15 mm", "15 m"):
        surface().drag(roll_radius=known, stick_speed=3e-3, temperature="180 degC")  # type: ignore[arg-type]


def test_a_confidence_in_percent_is_met_with_the_share() -> None:
    with pytest.raises(ParameterError, match=r"^confidence is 95: it must be from .* Write 0\.95$"):
        hersey.plan_profile(TRAIN, DRAG, target_speed=2.0, confidence=95)
