"""A fit file from elsewhere is refused where no fit can be such."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from hersey.document.assembly import fit_document
from hersey.document.saved_fit import read_fit
from hersey.errors import ParameterError


@pytest.fixture(scope="module")
def saved(log: Any, points: Any) -> dict[str, Any]:
    from hersey import _core
    from hersey.damping.fit import fit
    from hersey.document.parts import PRINTED

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
    with pytest.raises(ParameterError, match=r"fit.json: .*write it anew"):
        read_fit(tmp_path / "fit.json")
