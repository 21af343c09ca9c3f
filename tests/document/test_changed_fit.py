"""One number of a saved fit changed: it is refused, but where nothing in the file tells what it must be."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey import _core
from hersey.document.assembly import fit_document
from hersey.document.printed import PRINTED
from hersey.document.saved_fit import read_fit
from hersey.errors import ParameterError
from tests.conftest import mostly_nightly

TOKENS = ("NaN", "Infinity", "-Infinity")
#: What may be changed, by key, and why.
FREE = {
    r"fit\.covariance\.(0\.1|1\.0)": "0 to rounding, of a law of two variables",
    r"fit\.aicc": "from the likelihood, which is not kept",
    r"fit\.scatter": "estimated with the fit; from 0 to 10",
    r"fit\.dwell_error": "median of errors that are not kept; from 0 to 10",
    r"fit\.shared\.\d+\.(deviation|p_value)": "estimated with the fit; 0 to 10, and a probability",
    r"fit\.coefficients\.[abc]\.systematic": "from the sensors' errors, which are kept in words",
    r"fit\.transition\.(speed|mixed_exponent)\.systematic": "the same",
    r"fit\.transition\.evidence": "against a fit that is not kept; greater than 0",
    r"fit\.covariance\.(0\.0|4\.4)": "without parts, those of b, c and c_mixed alone stand elsewhere",
    r"fit\.variance_parts\.\d\.\d\.\d": "moves degrees of freedom, which are bounded by the dwells'",
    r"fit\.variance_uncertainty\.\d\.\d": "the same",
    r"fit\.transition\.closure\.values\.0": "torque at the bend, by a curve not kept; a factor of 7",
    r"fit\.transition\.closure\.covariance\.([0-3])\.\1": "by the same curve",
    r"fit\.rest\.(constant|per_speed|temperature_slope)\.systematic": "from the sensors' errors",
    r"fit\.rest\.reference_temperature": "stated; above 0 K",
    r"points\.\d+\.(speed|torque|temperature)_error": "measured; nothing in the file follows from it",
    r"points\.\d+\.(effective_|settling_)?rows": "the same",
    r"points\.\d+\.(run|start|end|load|tare|group_temperature)": "the same",
    r"points\.\d+\.temperature": "of a law without temperature",
    r"files\.\d+\.(bytes|rows|missing_rows|duration|sampling_interval|gaps)": "of the log",
}
#: Shown by pages; a fit that is read back does not use it.
UNUSED = r"fit\.(laws|trend|curves|cells|transition_curve)\..*"
#: What may be null: numbers that need not be known, and one end of a profile.
NULLS = r"points\.\d+\.(load|temperature_error|group_temperature)|fit\.transition\.mixed_exponent\.(low|high)"
WORDS = [(re.compile(pattern), reason) for pattern, reason in FREE.items()]


def saved(points: hersey.SteadyPoints, scale: str) -> dict[str, Any]:
    surface = hersey.fit(points, temperature_scale=scale)
    part = PRINTED["fit"].model_validate(fit_document(points.log, points, surface))
    return {"hersey_version": _core.VERSION} | part.model_dump(mode="json")


@cache
def documents() -> dict[str, dict[str, Any]]:
    """Fits of several kinds, with three dwells each in the part that is changed."""
    points = hersey.read("examples/bench.csv").steady(tare="standing")
    rest = hersey.NoLoadTorque.stated(
        constant=0.005, per_speed=1e-4, temperature_slope=-1e-3, reference_temperature=400.0, uncertainty=0.1
    )
    table = {"speed [rpm]": [10, 20, 40, 80], "torque [mN*m]": [5.0, 5.6, 6.3, 7.2]}
    one = hersey.SteadyPoints.from_table(table, isothermal=True)
    return {
        "corner or bend": saved(points, "degC"),
        "shared scatter": saved(points, "K"),
        "less the rest": saved(points.without(rest), "degC"),
        "one power of speed": saved(one, "degC"),
    }


def numbers(value: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where each number stands; of lists of dwells, curves and cells the first two entries."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from numbers(item, (*place, key))
    elif isinstance(value, list):
        long = place[:1] in (("points",), ("regime",)) or place[:2] in {
            ("fit", "curves"),
            ("fit", "cells"),
            ("fit", "laws"),
            ("fit", "transition_curve"),
        }
        for index, item in enumerate(value[:2] if long else value):
            yield from numbers(item, (*place, index))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield place


def changes(number: float) -> list[Any]:
    scaled = 1000 * number if isinstance(number, int) else number * 1e3
    tried = [-number, scaled, 1e308, 0, *TOKENS, None, "1.5", [number]]
    return [each for each in tried if not (isinstance(each, int | float) and each == number)]


def tried(document: dict[str, Any], path: Path) -> Iterator[tuple[str, Any, str]]:
    """Key, change and error (empty if it was read) of every single change."""
    for place in numbers(document):
        if place[0] in ("regime", "warnings"):
            continue  # other than what a fit is made of: it is not looked at
        *above, last = place
        holder = document
        for key in above:
            holder = holder[key]
        before = holder[last]
        for change in changes(before):
            holder[last] = f"@{change}@" if change in TOKENS else change
            text = re.sub(r'"@(.*?)@"', r"\1", json.dumps(document))
            path.write_text(text)
            try:
                read_fit(path)
                error = ""
            except ParameterError as raised:
                error = str(raised)
            yield ".".join(map(str, place)), change, error
        holder[last] = before


def may_be(key: str, change: Any) -> bool:
    if re.fullmatch(UNUSED, key) and not isinstance(change, str | list):
        return True
    if change is None:
        return re.fullmatch(NULLS, key) is not None
    return not isinstance(change, str | list) and change != 1e308 and any(p.fullmatch(key) for p, _ in WORDS)


#: A fit less the no-load torque has every part that a fit may have, one power of speed the fewest.
KINDS = ["corner or bend", "shared scatter", "less the rest", "one power of speed"]


@pytest.mark.parametrize("name", mostly_nightly(KINDS, "less the rest", "one power of speed"))
def test_a_changed_number_is_refused(name: str, tmp_path: Path) -> None:
    document = copy.deepcopy(documents()[name])
    path = tmp_path / "fit.json"
    path.write_text(json.dumps(document))
    assert np.isfinite(read_fit(path).c.value)
    for key, change, error in tried(document, path):
        assert error.startswith("fit.json: ") if error else may_be(key, change), (key, change)
