"""Units that a file states and that an option or a mapping replaces: said, unless the unit is the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.log.means import read_means
from hersey.log.replaced import UNIT_REPLACED, replaced_in
from hersey.units import without_factor

HEADER = "Time [ms],Torque [N*m],Speed [rpm],Temp [degC]"
ROWS = [f"{10 * i},{0.2 + 0.001 * (i % 7)},30,{90 + i % 3}" for i in range(100)]


def replaced(path: Path, units: dict[str, str], header: str = HEADER) -> list[str]:
    path.write_text("\n".join([header, *ROWS]))
    log = hersey.read(path, units=units)
    found = replaced_in(log.files)
    assert all(each.severity == "watch" and each.where == path.name for each in found)
    return [str(each.values["role"]) for each in found]


@pytest.mark.parametrize(
    ("role", "unit"),
    [
        ("torque", "kgf*cm"),
        ("torque", "mN*m"),
        ("torque", "-1 mN*m"),
        ("speed", "rad/s"),
        ("temperature", "degF"),
        ("time", "s"),
    ],
)
def test_another_unit_is_said(role: str, unit: str, tmp_path: Path) -> None:
    assert replaced(tmp_path / "bench.csv", {role: unit}) == [role]


@pytest.mark.parametrize(
    ("role", "unit"),
    [
        ("torque", "N*m"),
        ("torque", "Nm"),
        ("torque", "0.001 N*m"),
        ("torque", "-1 N*m"),
        ("torque", "9.84 N*m / 100"),
        ("speed", "1/min"),
        ("speed", "-1 rpm"),
        ("temperature", "°C"),
        ("time", "ms"),
    ],
)
def test_the_same_unit_is_not(role: str, unit: str, tmp_path: Path) -> None:
    assert replaced(tmp_path / "bench.csv", {role: unit}) == []


@pytest.mark.parametrize("stated", ["", " [kg-cm]", " [V]", " [%]", " [rpm]"])
def test_a_unit_that_is_none_of_the_role_is_not_replaced(stated: str, tmp_path: Path) -> None:
    unit = {" [V]": "2 N*m/V", " [%]": "2 N*m / 100"}.get(stated, "kgf*cm")
    header = HEADER.replace(" [N*m]", stated)
    units = {"torque": unit, "speed": "rpm"}
    if stated == " [rpm]":
        path = tmp_path / "bench.csv"
        path.write_text("\n".join([header, *ROWS]))
        log = hersey.read(path, channels={"torque": "Torque", "speed": "Speed"}, units=units)
        assert replaced_in(log.files) == []
    else:
        assert replaced(tmp_path / "bench.csv", units, header) == []


def test_frames_tables_of_means_and_mappings_say_it_too(tmp_path: Path) -> None:
    numbers = np.array([[float(cell) for cell in row.split(",")] for row in ROWS]).T
    frame = pl.DataFrame(dict(zip(HEADER.split(","), numbers, strict=True)))
    log = hersey.read(frame, units={"torque": "kgf*cm", "time": "s"})
    assert {each.values["role"] for each in replaced_in(log.files)} == {"torque", "time"}
    means = tmp_path / "means.csv"
    means.write_text(
        "Torque [N*m],Speed [rpm]\n" + "\n".join(f"{0.1 + 0.01 * i},{10 * i}" for i in range(1, 9))
    )
    (one,) = replaced_in(read_means(means, units={"torque": "kgf*cm"}).files)
    assert one.kind == UNIT_REPLACED
    assert (one.values["stated"], one.values["unit"]) == ("N*m", "kgf*cm")
    path = tmp_path / "bench.csv"
    path.write_text("\n".join([HEADER, *ROWS]))
    (tmp_path / "hersey.toml").write_text('[torque]\nunit = "kgf*cm"\n')
    (one,) = replaced_in(hersey.read_with_mapping(path).log.files)
    assert one.values["role"] == "torque"


def test_a_factor_is_told_from_its_unit() -> None:
    cases = {"9.84 mN*m / 100": "mN*m", "-1 rpm": "rpm", "1/min": "1/min", "N*m": "N*m", "1/s": "1/s"}
    assert {unit: without_factor(unit) for unit in cases} == cases
