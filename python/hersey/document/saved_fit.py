"""`fit.json`: a fit as ``hersey fit LOG --json`` prints it, read back into a `DampingSurface`."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

from hersey.damping.branches import Transition
from hersey.damping.candidates.branched import transition_exponent
from hersey.damping.candidates.shared_errors import Freedom, SharedScatter
from hersey.damping.estimate import Estimate
from hersey.damping.fitted_law import FitStatistics
from hersey.damping.gradual import Closure
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.damping.soundness import LARGEST
from hersey.damping.surface import DampingSurface
from hersey.document.consistency import faults_of_fit
from hersey.document.parts.fit import FitPart
from hersey.document.parts.log import InputFile, Point
from hersey.errors import HerseyError, ParameterError, way_in
from hersey.files.text import read_text
from hersey.schema.domain import Domain
from hersey.schema.part import Interval
from hersey.schema.warning import Warning

#: How far a number may be from the one it follows from, relative: JSON keeps all digits.
_ROUNDING = 1e-9
#: The law as ``hersey fit`` prints it in a text.
_PRINTED = re.compile(r"^ *B = a (?:T\^b )?w\^c[, ]", re.MULTILINE)


class _FitFile(BaseModel):
    """What a fit needs of the document; the rest of it (regime, timeline ...) is not read."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)

    hersey_version: str
    fit: FitPart
    points: list[Point] = []
    files: list[InputFile] = []


def read_fit(path: str | Path) -> DampingSurface:
    """Read a fit back from what ``hersey fit LOG --json`` or ``hersey report LOG --json`` printed.

    Raises
    ------
    MissingFileError
        If there is no such file, or it cannot be read.
    ParameterError
        If it is no such document, naming the file and the field.
    """
    path = Path(path)
    text = read_text(path)
    if _PRINTED.search(text):
        printed = "the printed text of a fit, not its JSON"
        said = "the text that hersey fit prints without --json" if way_in() == "terminal" else printed
        raise ParameterError(f"{path.name} is {said}", remedy=save_again(path))
    try:
        document = _FitFile.model_validate_json(text, strict=True)
    except ValidationError as error:
        first = error.errors()[0]
        if first["type"] == "json_invalid":
            raise _broken(path, "document", f"not valid JSON ({first['ctx']['error']})") from None
        place = ".".join(str(part) for part in first["loc"]) or "document"
        raise _broken(path, place, first["msg"]) from None
    except HerseyError:
        raise
    except (ValueError, RecursionError) as error:
        raise _broken(path, "document", f"not valid JSON ({error})") from None
    with np.errstate(all="ignore"):  # what overflows is refused
        _check(path, document)
        _check_dwells(path, document)
        surface = _surface(document)
        for field, asked in faults_of_fit(surface, document.fit, document.points):
            raise _broken(path, f"fit.{field}", f"it must be {asked}")
    return surface


def holds_fit(path: str | Path) -> bool:
    """Return whether a file is JSON that states a version of hersey and a fit, whether or not it is sound."""
    try:
        document = json.loads(read_text(Path(path)))
    except (HerseyError, OSError, ValueError, RecursionError):
        return False
    return (
        isinstance(document, dict) and "hersey_version" in document and isinstance(document.get("fit"), dict)
    )


def _broken(path: Path, field: str, reason: str) -> ParameterError:
    return ParameterError(f"{path.name}: {field}: {reason}", remedy=save_again(path))


def save_again(path: Path, *options: str) -> str:
    """Return how to save a fit in the place of a file; ``options`` are those of ``hersey fit``."""
    if way_in() != "terminal":
        return "save the fit again"
    # a file that may be the log itself is never named as the place to write to
    name = path.name if path.suffix == ".json" else "fit.json"
    return f"save the fit again with: {shlex.join(['hersey', 'fit', 'LOG', *options, '--json'])} > {name}"


def _check(path: Path, document: _FitFile) -> None:
    """Refuse what the schema allows and no fit can be."""
    fit = document.fit
    for field, part in _estimates(fit):
        if None in (part.value, part.error, part.systematic):
            raise _broken(path, f"fit.{field}", "value, error and systematic must be numbers")
    freed = fit.transition is not None and fit.transition.freed is not None
    size = 2 + ("b" in fit.coefficients) + 2 * (fit.transition is not None) + freed
    for field, holds, asked in _rules(fit, size):
        if not holds:
            raise _broken(path, f"fit.{field}", f"it must be {asked}")
    parts, uncertainty = fit.variance_parts, np.array(fit.variance_uncertainty)
    if any(np.shape(part) != (size, size) for part in parts) or uncertainty.shape != (
        (len(parts), len(parts)) if parts else (0,)
    ):
        raise _broken(
            path, "fit.variance_parts", f"it must have {size} rows of {size} numbers for each variance"
        )
    if not _is_covariance(np.array(fit.covariance)):
        raise _broken(path, "fit.covariance", "it must be symmetric, without negative variances")
    if fit.transition is not None and fit.transition.closure is not None:
        _check_closure(path, fit.transition.closure, size)
    if fit.rest is not None:
        _check_rest(path, fit.rest)
    for field, value, expected in _derived(fit):
        if not np.isclose(value, expected, rtol=_ROUNDING):
            raise _broken(path, f"fit.{field}", "it differs from fit.values, so one of them was changed")


def _rules(fit: FitPart, size: int) -> Iterator[tuple[str, bool, str]]:
    """What each field of a fit of so many variables must be, and whether it is."""
    thermal = "b" in fit.coefficients
    names, kelvin = set(fit.coefficients), fit.reference_temperature
    yield "coefficients", {"a", "c"} <= names <= {"a", "b", "c"}, "a, c and, for a fit with temperature, b"
    yield "torque_space", set(fit.torque_space) == names, "the names of the coefficients"
    yield "reference_speed", fit.reference_speed > 0, "greater than 0"
    yield "reference_temperature", (kelvin is not None) == thermal, "there if b is"
    yield "reference_temperature", kelvin is None or kelvin > 0, "greater than 0"
    yield "temperature_range", (fit.temperature_range is not None) == thermal, "there if b is"
    for name, ends in (("speed_range", fit.speed_range), ("temperature_range", fit.temperature_range)):
        yield name, ends is None or 0 < ends[0] <= ends[1], "ascending, greater than 0"
    yield "values", len(fit.values) == size, f"{size} numbers"
    yield "variables", len(fit.variables) == size, f"{size} names"
    square = [len(row) for row in fit.covariance] == [size] * size
    yield "covariance", square, f"{size} rows of {size} numbers"
    yield "points", fit.points > size, f"more than the {size} variables"
    if fit.transition is not None:
        speed = fit.transition.speed
        open_ended = speed.low is None or speed.high is None
        within = open_ended or 0 < speed.low <= speed.value <= speed.high
        yield "transition.speed", within, "within its interval"
    said = (fit.transition is None) == bool(fit.no_transition)
    yield "no_transition", said, "the reason, if there is none"


def _estimates(fit: FitPart) -> Iterator[tuple[str, Estimate]]:
    """Numbers with an interval whose schema lets them be missing, by the field of the fit."""
    if fit.transition is not None:
        for name in ("speed", "mixed_exponent"):
            yield f"transition.{name}", getattr(fit.transition, name)
    if fit.rest is not None:
        for name in ("constant", "per_speed", "temperature_slope"):
            yield f"rest.{name}", getattr(fit.rest, name)


def _check_dwells(path: Path, document: _FitFile) -> None:
    """Refuse dwells and files with numbers that none has; nothing else in the document follows from them."""
    for place, point in enumerate(document.points):
        errors = (point.speed_error, point.torque_error, point.temperature_error or 0.0, point.load or 0.0)
        counts = (point.run, point.rows, point.settling_rows, point.effective_rows)
        heats = (point.temperature, point.group_temperature)
        rules = [
            ("errors", all(0.0 <= each <= LARGEST for each in errors), "not negative"),
            ("rows", all(0 <= each <= LARGEST for each in counts), "not negative"),
            ("end", -LARGEST <= point.start <= point.end <= LARGEST, "at or after start"),
            ("tare", abs(point.tare) <= LARGEST, f"at most {LARGEST:g}"),
            ("temperature", all(each is None or 0.0 < each <= LARGEST for each in heats), "above 0 K"),
        ]
        for field, holds, asked in rules:
            if not holds:
                raise _broken(path, f"points.{place}.{field}", f"it must be {asked}")
    for place, file in enumerate(document.files):
        numbers = (file.bytes, file.rows, file.missing_rows, file.duration, file.sampling_interval, file.gaps)
        if not all(0 <= each <= LARGEST for each in numbers):
            raise _broken(path, f"files.{place}", f"its numbers must be from 0 to {LARGEST:g}")


def _check_closure(path: Path, closure: Closure, size: int) -> None:
    rows = {len(row) for row in closure.covariance}
    if len(closure.values) != size or len(closure.covariance) != size or rows != {size}:
        raise _broken(
            path, "fit.transition.closure", f"it must have {size} values and {size} rows of {size} numbers"
        )
    if not _is_covariance(np.array(closure.covariance)):
        raise _broken(path, "fit.transition.closure", "it must be symmetric, without negative variances")


def _check_rest(path: Path, rest: NoLoadTorque) -> None:
    shape = [len(row) for row in rest.covariance]
    if shape != [3, 3, 3] or not _is_covariance(np.array(rest.covariance)):
        raise _broken(path, "fit.rest.covariance", "it must be a covariance of three numbers")
    for name in ("speed_range", "temperature_range"):
        ends = getattr(rest, name)
        if ends is not None and not 0 < ends[0] <= ends[1]:
            raise _broken(path, f"fit.rest.{name}", "it must be ascending, greater than 0")


def _rest(part: NoLoadTorque | None) -> NoLoadTorque | None:
    if part is None:
        return None
    numbers = {
        name: _estimate(getattr(part, name)) for name in ("constant", "per_speed", "temperature_slope")
    }
    return NoLoadTorque(
        **numbers,
        reference_temperature=part.reference_temperature,
        covariance=np.array(part.covariance),
        freedom=np.inf if part.freedom is None else part.freedom,
        source=part.source,
        sha256=tuple(part.sha256),
        speed_range=part.speed_range,
        temperature_range=part.temperature_range,
        warnings=tuple(Warning.read(warning) for warning in part.warnings),
    )


def _derived(fit: FitPart) -> list[tuple[str, float, float]]:
    """Numbers that stand in the file twice: the field, its value, and what follows from ``values``."""
    thermal = "b" in fit.coefficients
    b, c = (fit.values[1] if thermal else 0.0), fit.values[1 + thermal]
    derived = [("coefficients.c", fit.coefficients["c"].value, c)]
    if thermal:
        derived.append(("coefficients.b", fit.coefficients["b"].value, b))
    if fit.transition is not None:
        mixed, meeting, *moves = fit.values[1 + thermal + 1 :]
        closure = fit.transition.closure
        at = meeting if closure is None else closure.values[-1]
        derived += [
            ("transition.speed", fit.transition.speed.value, fit.reference_speed * float(np.exp(at))),
            (
                "transition.meeting_speed",
                fit.transition.meeting_speed,
                fit.reference_speed * float(np.exp(meeting)),
            ),
            ("transition.mixed_exponent", fit.transition.mixed_exponent.value, mixed),
            (
                "transition.temperature_exponent",
                fit.transition.temperature_exponent,
                moves[0] if moves else transition_exponent(b, c),
            ),
        ]
    return derived


def _is_covariance(matrix: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> bool:
    top = float(np.max(np.abs(matrix)))
    symmetric = bool(np.allclose(matrix, matrix.T, rtol=0.0, atol=_ROUNDING * top))
    return symmetric and float(np.linalg.eigvalsh(matrix).min()) >= -_ROUNDING * top


def _estimate(part: Interval | Estimate) -> Estimate:
    low, high, freedom = (
        none if end is None else end
        for end, none in ((part.low, -np.inf), (part.high, np.inf), (part.freedom, np.inf))
    )
    return Estimate(part.value, part.error, low, high, freedom, part.systematic)


def _transition(part: Transition) -> Transition:
    return Transition(
        speed=_estimate(part.speed),
        meeting_speed=part.meeting_speed,
        mixed_exponent=_estimate(part.mixed_exponent),
        temperature_exponent=part.temperature_exponent,
        evidence=part.evidence,
        closure=None
        if part.closure is None
        else Closure(np.array(part.closure.values), np.array(part.closure.covariance)),
        freed=part.freed,
    )


def _surface(document: _FitFile) -> DampingSurface:
    fit = document.fit
    coefficients = {name: _estimate(part) for name, part in fit.coefficients.items()}
    return DampingSurface(
        a=coefficients["a"],
        b=coefficients.get("b"),
        c=coefficients["c"],
        transition=None if fit.transition is None else _transition(fit.transition),
        temperature_scale=fit.temperature_scale,
        reference_speed=fit.reference_speed,
        reference_temperature=fit.reference_temperature,
        variables=tuple(fit.variables),
        values=np.array(fit.values),
        covariance=np.array(fit.covariance),
        freedoms=Freedom(
            fit.points - len(fit.values),
            np.array(fit.covariance),
            tuple(np.array(part) for part in fit.variance_parts),
            np.array(fit.variance_uncertainty),
        ),
        torque_space={name: _estimate(part) for name, part in fit.torque_space.items()},
        statistics=_statistics(fit),
        speed_range=fit.speed_range,
        temperature_range=fit.temperature_range,
        residuals=np.array([point.residual for point in document.points]),
        rejected_transition=fit.no_transition,
        data_sha256=tuple(file.sha256 for file in document.files),
        sensors=fit.sensors,
        rest=_rest(fit.rest),
        domain=Domain.read(fit.domain),
        version=document.hersey_version,
    )


def _statistics(fit: FitPart) -> FitStatistics:
    same: dict[str, Any] = {field.name: getattr(fit, field.name, None) for field in fields(FitStatistics)}
    shared = tuple(SharedScatter(**vars(part)) for part in fit.shared)
    return FitStatistics(**same | {"variables": len(fit.values), "shared": shared})
