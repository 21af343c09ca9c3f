"""The age of a unit: a number with its unit, a time or any countable noun."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from hersey.errors import ParameterError, UnitError
from hersey.units import conversion

_AGE = re.compile(r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(.*?)\s*", re.DOTALL)
_WORD = re.compile(r"[^\W\d_][\w-]{0,39}")
#: A number whose point may stand between thousands, as in German.
_THOUSANDS = re.compile(r"[1-9][0-9]{0,2}\.[0-9]{3}")
#: Digits with separators between them.
_SEPARATED, _SEPARATORS = re.compile(r"[+]?[0-9]+([.,' ][0-9]+)+"), re.compile(r"[.,' ]")
#: What ages usually count and is no time, which takes pint a second to find out.
COUNTS = frozenset(["cycle", "lap", "page", "print", "revolution", "sheet", "start", "stop", "stroke"])
_WAY_OUT = "Write a number and what it counts, e.g. '120000 pages', '310 h' or '2e6 cycles'"
_NO_NUMBER = f"is not a number with a unit. {_WAY_OUT}"


@dataclass(frozen=True)
class Age:
    """How long a unit has run: ``value`` (0 for a new one) in ``unit``.

    Examples
    --------
    >>> Age.parse("120000 pages")
    Age(value=120000.0, unit='pages')
    >>> Age.parse("90 min").as_unit("h").value
    1.5
    """

    value: float
    unit: str

    def __post_init__(self) -> None:
        """Refuse what no age can be."""
        if not (math.isfinite(self.value) and self.value >= 0.0):
            raise ParameterError(f"an age is {self.value:g} {self.unit}: it must be 0 (new) or greater")
        refuse_no_unit(self.unit)

    @classmethod
    def parse(cls, text: str, unit: str = "") -> Age:
        """Return the age that a text states; ``unit`` is that of a bare number.

        Raises
        ------
        ParameterError
            If it is no number, or below 0.
        UnitError
            If it has no unit, or one that is no word.
        """
        match = _AGE.fullmatch(text[:200])
        if match is None:
            raise ParameterError(f"age '{text[:40]}' {_NO_NUMBER}")
        if re.match(r"[.,' ]?[0-9]", match[2]):
            ways = " or ".join(f"'{each}'" for each in _without_separators(text[:40]))
            wrong = f"has separators between its digits. Write {ways}"
            raise ParameterError(f"age '{text[:40]}' {wrong if ways else _NO_NUMBER}")
        if not (match[2] or unit):
            raise UnitError(f"age '{text[:40]}' has no unit. {_WAY_OUT}")
        counted = match[2] or unit
        refuse_thousands(match[1], counted)
        return cls(float(match[1]), counted)

    def as_unit(self, unit: str) -> Age:
        """Return the same age in another unit: times are converted, other words must be the same.

        Raises
        ------
        UnitError
            If the units count different things.
        """
        if self.unit == unit:
            return self
        mine, other = _seconds(self.unit), _seconds(unit)
        if mine is not None and other is not None:
            return Age(self.value if mine == other else self.value * mine / other, unit)
        if mine is other and _counted(self.unit) == _counted(unit):
            return Age(self.value, unit)
        raise UnitError(f"an age is in {self.unit}, but the others are in {unit}. Give it in {unit}")

    def __str__(self) -> str:
        """Return number and unit."""
        return f"{self.value:.10g} {self.unit}"


def refuse_no_unit(unit: str) -> None:
    """Refuse what cannot be the unit of an age.

    Raises
    ------
    UnitError
        If it is not one word.
    """
    if _WORD.fullmatch(unit) is None:
        raise UnitError(f"unit '{unit[:40]}' of an age must be one word. {_WAY_OUT}")


def refuse_thousands(number: str, counted: str) -> None:
    """Refuse a count whose point may stand between thousands, as in German.

    Raises
    ------
    ParameterError
        If the number has such a point and counts no time or distance, of which decimals are usual.
    """
    if _THOUSANDS.fullmatch(number) and not _is_measured(counted):
        decimal = f"{float(number):g}"
        decimal += "0" if decimal == number else ""
        raise ParameterError(
            f"age '{number} {counted}' can be read in two ways. Write "
            f"'{number.replace('.', '')} {counted}' or '{decimal} {counted}'"
        )


def _without_separators(text: str) -> list[str]:
    """What digits with separators may mean: a whole number, and one with the last of them as its point.

    Nothing where they stand otherwise.
    """
    digits = _SEPARATED.match(text.strip())
    if digits is None:
        return []
    number = digits[0]
    unit = text.strip()[len(number) :]
    head, last, tail = re.split(r"([.,' ])(?=[0-9]*$)", number)
    head = _SEPARATORS.sub("", head)
    ways = [f"{head}{tail}{unit}"]
    if last in (".", ",") and number.count(last) == 1:
        decimal = f"{float(f'{head}.{tail}'):.12g}"
        ways.append(f"{decimal}{'0' * bool(_THOUSANDS.fullmatch(decimal))}{unit}")
    return ways


def one_of(unit: str) -> str:
    """Return the unit of one: ``page`` of ``pages``."""
    return unit.removesuffix("s") if _seconds(unit) is None else unit


def _seconds(unit: str) -> float | None:
    """Seconds of one unit, or None if it is no time."""
    if unit.removesuffix("s") in COUNTS:
        return None
    try:
        return conversion("time", unit).scale
    except UnitError:
        return None


def _is_measured(unit: str) -> bool:
    """Whether an age is a time or a distance, of which decimals are usual, and not a count."""
    try:
        conversion("length", unit)
    except UnitError:
        return _seconds(unit) is not None
    return True


def _counted(unit: str) -> str:
    """The noun, be it one or many."""
    return unit.casefold().removesuffix("s")
