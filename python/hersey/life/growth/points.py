"""The runs of an indicator as rows of specimens: checked, in logarithms and in the greatest age."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import BoolArray, FloatArray, IntArray, numbers_of
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.indicator import most_ages
from hersey.life.padded_rows import PaddedRows
from hersey.schema.warning import Warning

#: No value is taken as known better than this, relative.
_RESOLUTION = 1e-4
#: Standard errors by which a common slope must fall.
_FALLS = 3.0
#: Up to so many specimens show little of how specimens differ.
_FEW = 3


class ByRun(NamedTuple):
    """`Points` with a row for the first run of each specimen, one for the second, and so on."""

    age: FloatArray
    value: FloatArray
    variance: FloatArray
    given: BoolArray


@dataclass(frozen=True)
class Points:
    """Logarithms of the indicator, one row per specimen, filled up; ages in the greatest age."""

    age: FloatArray
    value: FloatArray
    variance: FloatArray  #: of the stated errors
    given: BoolArray
    place: IntArray = field(
        default_factory=lambda: np.zeros((2, 0), dtype=np.intp)
    )  #: row and column of each run

    @cached_property
    def by_run(self) -> ByRun:
        """The same by run."""
        age, value, variance = (np.ascontiguousarray(e.T) for e in (self.age, self.value, self.variance))
        return ByRun(age, value, variance, np.ascontiguousarray(self.given.T))

    def spread(self, units: int) -> Points:
        """So many specimens at most, evenly spread over all."""
        if len(self.age) <= units:
            return self
        some = np.linspace(0.0, len(self.age) - 1.0, units).round().astype(np.intp)
        return Points(self.age[some], self.value[some], self.variance[some], self.given[some])

    def part(self, units: int) -> Points:
        """The first specimens alone."""
        return Points(
            self.age[:units], self.value[:units], self.variance[:units], self.given[:units], self.place
        )


def checked_runs(
    unit: Sequence[object], age: ArrayLike, value: ArrayLike, error: ArrayLike
) -> tuple[list[str], list[FloatArray]]:
    """Return names of specimens, ages, values and errors of runs; errors as `fit_growth`."""
    names = [str(each).strip() for each in ([unit] if isinstance(unit, str) else unit)]
    columns = [np.atleast_1d(numbers_of(*each)) for each in (("age", age), ("value", value))]
    columns.append(numbers_of("error", error))
    if columns[2].ndim == 0:
        columns[2] = np.full(len(names), float(columns[2]))
    for name, column in zip(("age", "value", "error"), columns, strict=True):
        if column.shape != (len(names),):
            raise ParameterError(f"{len(names)} specimens are named, but {name} has shape {column.shape}")
    rules = (("age", "negative"), ("value", "not positive"), ("error", "negative"))
    for (name, fault), column in zip(rules, columns, strict=True):
        for i in np.flatnonzero(~np.isfinite(column)):
            raise ParameterError(
                f"{name} of run {i + 1} (specimen {names[i]!r}) is not a number", index=int(i)
            )
        bad = column <= 0.0 if name == "value" else column < 0.0
        for i in np.flatnonzero(bad):
            raise ParameterError(
                f"{name} of run {i + 1} (specimen {names[i]!r}) is {fault}: {column[i]:g}",
                quantity=name,
                value=float(column[i]),
                limit=0.0,
                index=int(i),
            )
    if "" in names:
        raise ParameterError(f"run {names.index('') + 1} has no specimen name", index=names.index(""))
    if most_ages(np.unique(names, return_inverse=True)[1], columns[0]) < 2:
        raise InsufficientDataError(
            "no specimen was measured at two ages, so its growth is unknown. Add runs at another age"
        )
    return names, columns


def points_of(
    names: list[str], units: tuple[str, ...], age: FloatArray, value: FloatArray, error: FloatArray
) -> tuple[Points, tuple[float, float]]:
    """Runs as rows of specimens, by age, in scaled ages and logarithms less their mean; and both scales."""
    greatest, logs = float(age.max()), np.log(value)
    middle = float(logs.mean())
    label = np.array([units.index(name) for name in names])
    order = np.lexsort((age, label))
    rows = PaddedRows.of(label[order])
    place = np.zeros((2, value.size), dtype=np.intp)
    place[:, order] = rows.row, rows.column
    columns = (age[order] / greatest, logs[order] - middle, error[order] ** 2 + _RESOLUTION**2)
    ages, values, variances = (rows.filled(column) for column in columns)
    return Points(ages, values, variances, rows.given, place), (greatest, middle)


def falls(points: Points) -> bool:
    """Whether straight lines through the specimens, with one slope, fall by three standard errors.

    Those through the later half of the ages of each must fall too: what has run in may grow again.
    """
    later = points.given & (
        points.age >= 0.5 * points.age.max(axis=1, where=points.given, initial=0.0)[:, None]
    )
    slope, error = _slope(points, points.given)
    return slope < -_FALLS * error and _slope(points, later)[0] <= 0.0


def _slope(points: Points, given: BoolArray) -> tuple[float, float]:
    """Common slope of straight lines through the values given of each specimen, and its standard error."""
    number = given.sum(axis=1, keepdims=True)
    age, value = (
        (each - (each * given).sum(axis=1, keepdims=True) / np.maximum(number, 1)) * given
        for each in (points.age, points.value)
    )
    square = float((age**2).sum())
    if square <= 0.0:
        return 0.0, math.inf
    slope = float((age * value).sum() / square)
    left = ((value - slope * age) ** 2 * given).sum() / max(number.sum() - len(number) - 1, 1)
    least = (points.variance * given).sum() / number.sum()
    return slope, math.sqrt(max(float(left), float(least)) / square)


def warnings_of(points: Points) -> tuple[Warning, ...]:
    """Return what weakens a law of growth that is fitted to points."""
    specimens = len(points.age)
    warnings = []
    if specimens <= _FEW:
        warnings.append(
            Warning(
                "few specimens",
                "one specimen does not show how specimens differ, so ages beyond its runs depend on the prior"
                if specimens == 1
                else (
                    "{specimens} specimens show little of how specimens differ, so ages beyond their runs "
                    "depend partly on the prior"
                ),
                severity="watch",
                specimens=specimens,
            )
        )
    once = sum(np.unique(age[given]).size < 2 for age, given in zip(points.age, points.given, strict=True))
    if once:
        warnings.append(
            Warning(
                "growth of one age",
                "{count} {count:specimen was|specimens were} seen at one age only; their growth is "
                "assumed to be that of the others",
                severity="watch",
                count=once,
            )
        )
    if falls(points):
        warnings.append(
            Warning(
                "values fall",
                "values fall with age up to the last runs, but every growth law rises in the end",
                remedy="give the reciprocal of the falling quantity",
                severity="act",
            )
        )
    return tuple(warnings)
