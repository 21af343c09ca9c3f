"""A fit file from elsewhere is refused where no fit can be such."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import hersey
from hersey import _core
from hersey.document.assembly import fit_document
from hersey.document.printed import PRINTED
from hersey.document.saved_fit import read_fit
from hersey.errors import ParameterError
from hersey.log.sensors import Sensors


@pytest.fixture(scope="module")
def saved(log: Any, points: Any) -> dict[str, Any]:
    from hersey.damping.fit import fit

    part = PRINTED["fit"].model_validate(fit_document(log, points, fit(points)))
    return {"hersey_version": _core.VERSION} | part.model_dump(mode="json")


def read(document: dict[str, Any], folder: Path) -> object:
    (folder / "fit.json").write_text(json.dumps(document))
    return read_fit(folder / "fit.json")


def test_what_was_saved_is_read(saved: dict[str, Any], tmp_path: Path) -> None:
    assert read(saved, tmp_path)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("reference_temperature", 0),
        ("reference_temperature", 0.0),
        ("reference_temperature", -0.0),
        ("reference_temperature", -300.0),
        ("reference_speed", 0.0),
        ("reference_speed", 10**400),
    ],
)
def test_a_number_that_no_fit_can_have(
    field: str, value: float, saved: dict[str, Any], tmp_path: Path
) -> None:
    with pytest.raises(ParameterError, match=f"fit.json: fit.{field}: "):
        read(saved | {"fit": saved["fit"] | {field: value}}, tmp_path)


@pytest.mark.parametrize(
    "text",
    ["", "[" * 100_000, "1" * 5000, '{"a": ' + "1" * 5000 + "}", '"\\ud800"', "\ufeff{}", "NaN", "null"],
)
def test_no_document(text: str, tmp_path: Path) -> None:
    (tmp_path / "fit.json").write_text(text, encoding="utf-8")
    with pytest.raises(ParameterError, match=r"fit.json: .*Save the fit again"):
        read_fit(tmp_path / "fit.json")


def test_fits_of_all_kinds_are_read_again(tmp_path: Path) -> None:
    """Also with a dwell held to the branch on the other side, and with a film that friction heats."""
    points = hersey.read("examples/bench.csv").steady(tare="standing")
    rest = hersey.no_load_torque(hersey.read("examples/no-load.csv").steady(tare="standing"))
    heated = replace(points, log=replace(points.log, sensors=Sensors(film_heating=3.0)))
    for each in (points, points.without(rest), heated, heated.without(rest)):
        surface = hersey.fit(each)
        part = PRINTED["fit"].model_validate(fit_document(each.log, each, surface))
        again = read({"hersey_version": _core.VERSION} | part.model_dump(mode="json"), tmp_path)
        assert isinstance(again, hersey.DampingSurface)
        assert again.to_dict() == surface.to_dict()
