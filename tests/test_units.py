"""Units are read at the door, in the spellings of the field, and refused where they could mislead."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hersey.errors import UnitError, WrongKindError
from hersey.units import (
    KINDS,
    Conversion,
    argument,
    celsius,
    conversion,
    convert,
    kinds,
    parse,
    pint_units,
    rpm,
    spelling,
    table,
)

OUNCE_INCH = 0.45359237 / 16 * 9.80665 * 0.0254


@pytest.mark.parametrize("unit", ["ozf*in", "ozf.in", "oz.in", "oz-in", "in-oz", "oz in", "in.ozf"])
def test_ounce_inch_is_a_force_however_it_is_spelt(unit: str) -> None:
    assert conversion("torque", unit).scale == pytest.approx(OUNCE_INCH, rel=1e-9)


@pytest.mark.parametrize(
    ("kind", "unit", "scale"),
    [
        ("torque", "N.m", 1.0),
        ("torque", "Nm", 1.0),
        ("torque", "mNm", 1e-3),
        ("torque", "N·m", 1.0),
        ("torque", "lbf.in", 0.1129848290276167),
        ("torque", "9.84 mN*m / 100", 9.84e-5),
        ("torque", "-1 N*m", -1.0),
        ("torque", "-1 Nm", -1.0),
        ("torque", "9.84 mNm / 100", 9.84e-5),
        ("torque", "-1 oz.in", -OUNCE_INCH),
        ("torsional stiffness", "Nm/rad", 1.0),
        ("torsional stiffness", "mNm/deg", 0.18 / np.pi),
        ("rotational damping", "mNm·s/rad", 1e-3),
        ("speed", "RPM", np.pi / 30),
        ("speed", "1 / min", np.pi / 30),
        ("speed", "/min", np.pi / 30),
        ("speed", "min^(-1)", np.pi / 30),
        ("speed", "rad s-1", 1.0),
        ("speed", "r/s", 2 * np.pi),
        ("time", "Sec", 1.0),
        ("speed", "rpm", np.pi / 30),
        ("speed", "1/min", np.pi / 30),
        ("speed", "rev/s", 2 * np.pi),
        ("speed", "deg/s", np.pi / 180),
        ("time", "ms", 1e-3),
        ("time", "min", 60.0),
    ],
)
def test_scale_to_si(kind: str, unit: str, scale: float) -> None:
    assert conversion(kind, unit).scale == pytest.approx(scale, rel=1e-12)


@pytest.mark.parametrize(
    ("unit", "boiling"),
    [
        ("degC", 100),
        ("°C", 100),
        ("C", 100),
        ("degF", 212),
        ("K", 373.15),
        ("0.1 K", 3731.5),
        ("deg. C", 100),
        ("Celsius", 100),
    ],
)
def test_temperatures_have_an_offset(unit: str, boiling: float) -> None:
    line = conversion("temperature", unit)
    assert line.scale * boiling + line.offset == pytest.approx(373.15, abs=1e-9)


@pytest.mark.parametrize(
    ("kind", "unit", "says"),
    [
        ("speed", "Hz", "revolutions or radians"),
        ("speed", "1/s", "revolutions or radians"),
        ("speed", "mm/s", "is that of a sliding speed, not of a speed"),
        ("torque", "%", "9.84 mN"),
        ("torque", "rpm", "not a unit of torque"),
        ("torque", "furlongz", "unknown unit"),
        ("torque", "(", "unknown unit"),
        ("torque", "", "the unit is missing"),
        ("torque", "2**99999999", "unknown unit"),
        ("torque", "9**+9999999", "unknown unit"),
        ("torque", "((9**9)**9)**9", "unknown unit"),
        ("torque", "9,84 N*m", "unknown unit"),
        ("torque", "nan N*m", "unknown unit"),
        ("torque", "N*m;", "unknown unit"),
        ("torque", "J", "not a unit of torque"),
        ("torque", "kWh", "not a unit of torque"),
        ("torque", "0 N*m", "factor"),
        ("speed", "2 Hz", "revolutions or radians"),
        ("speed", "hertz", "revolutions or radians"),
        ("speed", "1 / s", "revolutions or radians"),
        ("speed", "Bq", "revolutions or radians"),
        ("speed", "0 rpm", "factor"),
        ("temperature", "delta_degC", "difference"),
        ("temperature", "V", "not a unit of temperature"),
    ],
)
def test_misleading_units_are_refused(kind: str, unit: str, says: str) -> None:
    with pytest.raises(UnitError, match=says.replace("(", "\\(").replace("*", "\\*")):
        conversion(kind, unit)


def test_quantities_need_number_and_unit() -> None:
    assert parse("speed", "60 rpm") == pytest.approx(2 * np.pi)
    assert parse("temperature", "180 degC") == pytest.approx(453.15)
    for text in ("60", "rpm", "", "1.2.3 rpm", "2,5 rpm", "2 -1 rpm", "1e999 rpm"):
        with pytest.raises(UnitError):
            parse("speed", text)
    assert convert(2 * np.pi, "rad/s", "rpm") == pytest.approx(60)


@pytest.fixture(scope="module")
def theirs() -> pint.UnitRegistry[float]:
    """The definitions of pint, as they come."""
    registry: pint.UnitRegistry[float] = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    registry.define("rev = revolution")
    return registry


@pytest.fixture
def no_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    """From here on a unit that the table lacks is an error."""

    def forbidden() -> None:
        raise AssertionError("the registry is asked")

    monkeypatch.setattr(pint_units, "_full_registry", forbidden)
    for cached in (conversion, table.from_table):
        cached.cache_clear()


def base(dimension: tuple[int, ...]) -> str:
    return "*".join(f"{unit}**{n}" for unit, n in zip(("m", "kg", "s", "K", "rad"), dimension, strict=True))


@pytest.mark.parametrize("name", [*table.TABLE, *table.OFFSETS])
def test_a_unit_of_the_table_is_that_of_pint(name: str, theirs: Any) -> None:
    scale, offset, dimension = table.from_table(name) or pytest.fail(name)
    zero, one = (float(theirs.Quantity(x, name).to(base(dimension)).magnitude) for x in (0.0, 1.0))
    assert offset == pytest.approx(zero, rel=1e-14, abs=1e-300)
    assert scale == pytest.approx(one - zero, rel=1e-12)


@st.composite
def products(draw: st.DrawFn) -> str:
    """Units of the table, multiplied, divided and to small powers."""
    text = draw(st.sampled_from(["", "1/"]))
    for i in range(draw(st.integers(1, 4))):
        sign = draw(st.sampled_from("*/")) if i else ""
        power = draw(st.sampled_from(["", "", "^2", "**3", "^-1", "**-2"]))
        text += sign + draw(st.sampled_from(sorted(table.TABLE))) + power
    return text


@settings(max_examples=300, deadline=None, derandomize=True)
@given(products())
def test_a_product_is_that_of_pint(theirs: Any, text: str) -> None:
    line = table.from_table(text)
    if line is None:  # beyond what any unit could be
        assert abs(math.log10(theirs.Quantity(1.0, text).to_base_units().magnitude)) > 90
        return
    assert line[0] == pytest.approx(theirs.Quantity(1.0, text).to(base(line[2])).magnitude, rel=1e-12)


FIELD = {
    "time": "s ms us min h sec",
    "torque": "N*m mN*m Nm mNm N.m kN*m cN*m uN*m N*mm ozf*in oz.in lbf*in lbf*ft lbf.in in-lbs ft-lb "
    "kgf*m gf*cm",
    "speed": "rad/s rpm RPM rev/s rev/min deg/s mrad/s 1/min U/min",
    "temperature": "degC degF K °C °F",
    "stiffness": "N/m N/mm kN/m lbf/in N/um",
    "mass": "kg g lb oz slug mg",
    "length": "m mm cm um µm nm in ft inch mil thou",
    "belt speed": "m/s mm/s in/s ft/min m/min",
    "force": "N kN mN lbf ozf kgf gf",
    "acceleration": "m/s^2 mm/s^2 in/s^2",
    "translational damping": "N*s/m N*s/mm lbf*s/in",
    "pressure": "Pa kPa MPa GPa bar mbar psi",
    "viscosity": "Pa*s mPa*s cP P reyn",
    "kinematic viscosity": "m^2/s mm^2/s cSt St",
    "density": "kg/m^3 g/cm^3",
    "pressure-viscosity coefficient": "Pa^-1 GPa^-1 1/GPa",
    "thermal conductivity": "W/m/K mW/m/K",
    "power": "W kW mW",
    "energy": "J kJ mJ",
    "heat capacity": "J/K kJ/K",
    "thermal conductance": "W/K mW/K",
}


@pytest.mark.usefixtures("no_registry")
@pytest.mark.parametrize(("kind", "unit"), [(kind, unit) for kind in FIELD for unit in FIELD[kind].split()])
def test_units_of_drives_need_no_registry(kind: str, unit: str, theirs: Any) -> None:
    line = conversion(kind, unit)
    assert conversion(kind, KINDS[kind][0]) == Conversion(KINDS[kind][0], 1.0, 0.0)
    if kind != "temperature":
        assert convert(line.scale, KINDS[kind][0], KINDS[kind][0]) == line.scale
        assert line.offset == 0.0
        plain = spelling.split_factor(unit, unit, "")[1]
        assert line.scale == pytest.approx(float(theirs.Quantity(1.0, plain).to(KINDS[kind][0]).m), rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "unit", "one"),
    [
        ("torque", "dyn*cm", 1e-7),
        ("torque", "hp/rpm", 6600 * 0.0254 * 0.45359237 * 9.80665 / (math.pi / 30)),
        ("belt speed", "km/hour", 1 / 3.6),
        ("pressure", "atm", 101_325.0),
        ("force", "kip", 4448.2216152605),
        ("thermal conductivity", "mW/mm/K", 1.0),
        ("time", "day", 86_400.0),
        ("energy", "Wh", 3600.0),
    ],
)
def test_any_other_unit_is_read_by_pint(kind: str, unit: str, one: float) -> None:
    assert table.from_table(unit) is None
    assert conversion(kind, unit).scale == pytest.approx(one, rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "unit", "one", "other"),
    [
        ("speed", "x1000 rpm", "1000 rpm", "rpm / 1000"),
        ("speed", "rpm x1000", "1000 rpm", "rpm / 1000"),
        ("torque", "N·m \u00d710^-3", "1e-3 N·m", "N·m / 1e-3"),
    ],
)
def test_a_factor_of_two_meanings_is_refused(kind: str, unit: str, one: str, other: str) -> None:
    with pytest.raises(UnitError) as refused:
        conversion(kind, unit)
    assert f"Write '{one}' if" in str(refused.value)
    assert f"'{other}' if" in str(refused.value)
    number, plain = one.split()
    assert conversion(kind, one).scale / conversion(kind, plain).scale == pytest.approx(
        float(number), rel=1e-12
    )
    assert conversion(kind, plain).scale / conversion(kind, other).scale == pytest.approx(
        float(number), rel=1e-12
    )


@pytest.mark.parametrize(("kind", "unit"), [("torque", "W*s"), ("torque", "mW*s"), ("speed", "1/s")])
def test_what_misleads_is_not_read_by_the_table(kind: str, unit: str) -> None:
    with pytest.raises(UnitError):
        conversion(kind, unit)


def test_units_for_people() -> None:
    assert convert(273.15, "K", "degC") == 0.0
    assert convert(20.0, "degC", "degF") == pytest.approx(68.0, abs=1e-12)
    assert convert(1000.0, "J/mol", "kcal/mol") == pytest.approx(1 / 4.184)
    assert rpm(math.pi) == 30.0
    assert celsius(373.15) == 100.0


@pytest.mark.parametrize(
    ("kind", "unit", "meant"),
    [
        ("stiffness", "N/mmm", "N/mm"),
        ("stiffness", "Nmm", "N/mm"),
        ("torque", "nm", "Nm"),
        ("torque", "N*m;", "N*m"),
        ("speed", "rmp", "rpm"),
        ("speed", "rpmm", "rpm"),
        ("temperature", "dgeC", "degC"),
        ("temperature", "degCC", "degC"),
        ("mass", "Kg", "kg"),
        ("force", "KN", "kN"),
        ("belt speed", "mm/sek", "mm/s"),
    ],
)
def test_a_slip_of_the_pen_is_answered_with_what_was_meant(kind: str, unit: str, meant: str) -> None:
    with pytest.raises(UnitError) as told:
        conversion(kind, unit)
    assert str(told.value).endswith(f". Did you mean {meant}?"), told.value
    assert conversion(kind, meant).scale > 0


def test_other_spellings_of_the_pen_are_read() -> None:
    for kind, unit, same in (
        ("torque", "Nmm", "N*mm"),
        ("speed", "RPM", "rpm"),
        ("temperature", "degc", "degC"),
    ):
        line, other = conversion(kind, unit), conversion(kind, same)
        assert (line.scale, line.offset) == (other.scale, other.offset)


@pytest.mark.parametrize(
    ("kind", "unit"), [("torque", "rpm"), ("torque", "N"), ("speed", "mm"), ("mass", "s")]
)
def test_a_unit_of_another_kind_is_no_slip(kind: str, unit: str) -> None:
    with pytest.raises(WrongKindError, match=f"Write one such as {KINDS[kind][1]}".replace("*", "[*]")):
        conversion(kind, unit)


@pytest.mark.parametrize(
    ("text", "period", "seconds"),
    [
        ("20 Hz", "50 ms", 0.05),
        ("1 kHz", "1 ms", 1e-3),
        ("0.5 hertz", "2 s", 2.0),
        ("30 Hz", "33.3333333 ms", 1 / 30),
        ("20 kHz", "50 us", 5e-5),
    ],
)
def test_a_frequency_in_place_of_a_time_becomes_its_period(text: str, period: str, seconds: float) -> None:
    with pytest.raises(WrongKindError) as refused:
        argument("every", "time", text)
    assert str(refused.value) == f"every: '{text}' is a frequency, not a time. Write its period, '{period}'"
    assert parse("time", period) == pytest.approx(seconds, rel=1e-8)
    with pytest.raises(UnitError, match="Write one such as s"):
        parse("time", "0 Hz")


def test_every_unit_that_is_proposed_can_be_read() -> None:
    assert set(kinds._USUAL) == set(KINDS)
    for kind, usual in kinds._USUAL.items():
        for unit in usual.split():
            assert conversion(kind, unit).scale > 0


@pytest.mark.parametrize(
    ("kind", "text", "said"),
    [
        ("heat capacity", "1.5 kJ/(kg K)", "specific heat.*multiply by the mass"),
        ("thermal conductance", "10 W/m^2/K", "heat transfer coefficient.*multiply by the area"),
        ("power", "5 kW/m^2", "heat flux.*multiply by the area"),
        ("power", "5 N*m", "not a unit of power"),
    ],
)
def test_a_specific_quantity_is_named_with_what_it_must_be_multiplied_by(
    kind: str, text: str, said: str
) -> None:
    with pytest.raises(WrongKindError, match=f"(?i){said}"):
        parse(kind, text)


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("0.045", "'0.045 N*m'"),  # nothing groups thousands behind a zero
        ("0,045", "'0.045 N*m'"),
        ("-0.500", "'-0.500 N*m'"),
        ("1.500", "'1.500 N*m' or '1500 N*m'"),
        ("1,500", "'1.500 N*m' or '1500 N*m'"),
        ("1234.500", "'1234.500 N*m'"),
        ("1.234.567", "'1234567 N*m'"),
        ("1,234.5", "'1234.5 N*m'"),
    ],
)
def test_a_number_without_unit_keeps_its_decimals_in_the_example(text: str, written: str) -> None:
    with pytest.raises(UnitError) as refused:
        parse("torque", text)
    assert str(refused.value).endswith(f"Write e.g. {written}")
