"""Every law of viscosity that the core has reaches a lubricant, a drive file, a unit and the docs."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey import _core
from hersey.errors import ParameterError
from hersey.exchange.drive_file import drive_values
from hersey.lubrication.lubricant import MODELS, Lubricant
from tests.conftest import ROOT
from tests.exchange.instances import course, instance
from tests.exchange.test_against_core import AGREEMENT, TRAIN, far, mixed_drag

LAWS = tuple(_core.VISCOSITY_LAWS)


def oil(law: str) -> Lubricant:
    """One oil by each law: points of a Vogel law with rounded coefficients."""
    kelvin = np.linspace(330.0, 450.0, _core.VISCOSITY_LAWS[law].points)
    points = tuple((float(t), 2e-4 * math.exp(900.0 / (t - 180.0))) for t in kelvin)
    return Lubricant(law, points, density=900.0)


def drag(law: str) -> hersey.MixedDrag:
    mixed = mixed_drag()
    return replace(mixed, contact=replace(mixed.contact, lubricant=oil(law)), stick_speed=1e-6)


def test_the_core_says_how_many_points_each_takes() -> None:
    assert {"arrhenius": 2, "vogel": 3, "walther": 2}.items() <= MODELS.items()
    assert tuple(MODELS) == LAWS


@pytest.mark.parametrize("law", LAWS)
def test_the_drive_file_names_the_law_and_its_coefficients(law: str) -> None:
    values = drive_values(TRAIN, drag(law))
    coefficients = oil(law).coefficients()
    assert values["temperature_law"] == oil(law).law.kind == law
    assert tuple(coefficients) == tuple(_core.VISCOSITY_LAWS[law].coefficients)
    assert values["viscosity_numbers"] == list(coefficients.values())


@pytest.mark.parametrize("law", LAWS)
def test_a_unit_moves_by_the_law_as_the_core_does(law: str, tmp_path: Path) -> None:
    """While the temperature is another than that at which the drag is stated, so that the law counts."""
    belt, temperature = drag(law), 400.0
    speed = 0.8 * belt.law_at(temperature).transition_speed
    given = {"drive_speed": speed, "temperature": temperature}
    times = np.linspace(0.0, 0.4, 81)
    run = hersey.simulate(TRAIN, belt, duration=0.4, samples=81, **given)
    unit = hersey.export_fmu(tmp_path / "unit.fmu", TRAIN, belt, **given).path
    with instance(unit) as opened:
        got = course(opened, times, "belt_speed", "spring_force")
    assert far(got[:, 0], run.belt_speed) < AGREEMENT
    assert far(got[:, 1], run.spring_force) < AGREEMENT


def test_a_law_that_is_not_known_is_refused_with_those_that_are() -> None:
    values = drag("vogel").wire() | {"temperature_law": "roelands"}
    with pytest.raises(ParameterError, match=r"temperature_law 'roelands' is not known: none, power, arr.*"):
        _core.Law(values)
    del values["temperature_law"]
    with pytest.raises(ParameterError, match="temperature_law is missing"):
        _core.Law(values)
    with pytest.raises(ParameterError, match="'slipperiness' is no value of a drag"):
        _core.Law({"slipperiness": 1.0})
    values = drag("vogel").wire() | {"viscosity_numbers": [1.0, 2.0]}
    with pytest.raises(ParameterError, match="viscosity_numbers has 2 numbers: 3 are needed"):
        _core.Law(values)


@pytest.mark.parametrize("law", LAWS)
def test_the_docs_name_the_law(law: str) -> None:
    """For those who write a machine file, and with its coefficients for those who write a drive file."""
    assert f"`{law}`" in (ROOT / "docs" / "theory" / "film.md").read_text()
    header = (ROOT / "crates" / "c" / "include" / "hersey.h").read_text()
    coefficients = ", ".join(_core.VISCOSITY_LAWS[law].coefficients)
    assert f"{law} ({coefficients})" in header
