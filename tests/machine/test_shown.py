"""A machine on one line: what moves the belt, with units."""

from __future__ import annotations

from typing import Any

import pytest

import hersey
from tests.conftest import ROOT

POINT = hersey.OperatingPoint("slow", 0.045, 453.15)


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, "drive, radius 15 mm, stiffness 11 kN/m, mass 11 kg, no operating points"),
        (
            {"stiffness": 512.3, "mass": "450 g", "points": (POINT,)},
            "drive, radius 15 mm, stiffness 512.3 N/m, mass 0.45 kg, 1 operating point",
        ),
        (
            {"stiffness": 1e3, "points": (POINT, POINT)},
            "drive, radius 15 mm, stiffness 1 kN/m, mass 11 kg, 2 operating points",
        ),
    ],
)
def test_a_machine_is_shown_on_one_line(given: dict[str, Any], line: str) -> None:
    stated = {"stiffness": 11e3, "mass": 11.0, "roll_radius": 0.015, "stick_speed": 3e-3} | given
    assert repr(hersey.Machine(**stated)) == f"Machine({line})"


def test_a_machine_from_its_file_is_shown_like_one_made_by_hand() -> None:
    machine = hersey.read_machine(ROOT / "examples" / "machine.toml")
    assert repr(machine) == "Machine(belt, radius 15 mm, stiffness 11 kN/m, mass 11 kg, 2 operating points)"


def test_a_table_of_the_file_says_where_its_keys_are() -> None:
    machine = hersey.read_machine(ROOT / "examples/machine.toml")
    with pytest.raises(AttributeError, match=r"fields of the machine, e\.g\. machine\.stiffness"):
        machine.drivetrain  # type: ignore[attr-defined]  # noqa: B018
    with pytest.raises(AttributeError, match="no attribute 'stifness'"):
        machine.stifness  # type: ignore[attr-defined]  # noqa: B018
