"""What a life test is to decide: whether specimens reach an age, how many fail before it, when to replace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import numbers_of
from hersey.errors import ParameterError, Setting, UnitError
from hersey.life.age import Age
from hersey.life.replacement import cost_ratio

#: Least share, and greatest ratio of costs: beyond, all depends on less than a hundredth of the specimens.
_LEAST_SHARE, _GREATEST_RATIO = 0.01, 100.0
_WHY = "as a life test does not show when the first hundredth of new specimens fails"


class Asked(TypedDict, total=False):
    """What a life test is to decide, each by its name.

    Parameters
    ----------
    until
        Age that specimens should reach, e.g. "250000 pages": the next runs are those that show best which do.
    share
        Share of new specimens that may fail before that age, e.g. 0.05.
    cost_of_failure
        Cost of a failure in service over that of a planned replacement, e.g. 10: when to replace.
    """

    until: str | float | None
    share: float | None
    cost_of_failure: float | None


@dataclass(frozen=True)
class Questions:
    """What was asked; ages in the unit of the runs."""

    until: float | None = None
    share: float | None = None
    cost_of_failure: float | None = None


def questions_of(
    unit: str,
    until: str | float | None = None,
    share: float | None = None,
    cost_of_failure: float | None = None,
) -> Questions:
    """Return what was asked, in the unit of the runs.

    Raises
    ------
    ParameterError, UnitError
        If the age is none greater than 0 in such a unit, the share is not from 0.01 to 1 or comes without
        an age, or the cost is not above 1 or beyond 100.
    """
    age = _age_of(until, unit)
    if share is not None:
        share = _number("share", share)
        if not _LEAST_SHARE <= share < 1.0:
            reason = f", {_WHY}" if 0.0 < share < _LEAST_SHARE else ""
            raise ParameterError(
                f"{Setting('share').to()} is {100 * share:g} %: it must be at least {100 * _LEAST_SHARE:g} % "
                f"and below 100 %{reason}",
                quantity="share",
            )
        if age is None:
            example = Setting("until").to(f"200000 {unit}".strip())
            raise ParameterError(f"{Setting('share').to()} needs the age: add {example}", quantity="share")
    cost = None
    if cost_of_failure is not None:
        cost = cost_ratio(_number("cost_of_failure", cost_of_failure), _GREATEST_RATIO, _WHY)
    return Questions(age, share, cost)


def _number(name: str, given: ArrayLike) -> float:
    number = np.asarray(numbers_of(name, given))
    if number.ndim:
        raise ParameterError(f"{Setting(name).to()} must be one number", quantity=name)
    return float(number)


def _age_of(until: str | float | None, unit: str) -> float | None:
    if until is None:
        return None
    try:
        age = Age.parse(until, unit).as_unit(unit) if isinstance(until, str) else Age(float(until), unit)
        if age.value == 0.0:
            raise ParameterError("the age that specimens should reach must be greater than 0")
    except (ParameterError, UnitError) as error:
        raise error.within(Setting("until").to()) from None
    return age.value
