"""Units are read at the door, in the spellings of the field, and refused where they could mislead."""

import numpy as np
import pytest

from hersey.errors import UnitError
from hersey.units import conversion, convert, parse

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
        ("speed", "mm/s", "not a unit of speed"),
        ("torque", "%", "--torque-unit"),
        ("torque", "rpm", "not a unit of torque"),
        ("torque", "furlongz", "unknown unit"),
        ("torque", "(", "unknown unit"),
        ("torque", "", "no unit"),
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
