"""Shares, ranges, temperatures and speeds of options, in SI."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from hersey.errors import ParameterError, UnitError, WrongKindError

if TYPE_CHECKING:
    from hersey.machine.machine import Machine


def amounts_in(text: str) -> str | list[str] | None:
    """Return a text that begins with a number, a list of such texts with commas, or None for other text."""
    parts = text.split(",")
    if not all(re.match(r"\s*[-+]?\.?[0-9]", part) for part in parts):
        return None
    return parts if len(parts) > 1 else text


def share(flag: str, text: str) -> float:
    """Return the share that an option such as ``'2 %'`` names."""
    match = re.fullmatch(r"\s*([0-9]+(?:\.[0-9]*)?)\s*%\s*", text[:60])
    if match is None:
        raise ParameterError(f"{flag} is '{text}': write a percentage, e.g. '2 %'")
    return float(match[1]) / 100


def range_of(kind: str, flag: str, text: str) -> tuple[float, float] | None:
    """Return two values with one unit, 'low to high unit'; None if the text is empty."""
    from hersey.units import parse

    if not text:
        return None
    match = re.fullmatch(r"\s*(\S+)\s+to\s+([-+.\deE]+)\s+(\S.*?)\s*", text)
    if match is None:
        raise ParameterError(f"{flag} '{text}' is not a range: write e.g. '2 to 200 rpm' or '60 to 200 degC'")
    low, high, unit = match.groups()
    with _of(flag):
        return parse(kind, f"{low} {unit}"), parse(kind, f"{high} {unit}")


def temperature_of(text: str, flag: str = "--at") -> float | None:
    """Return the temperature that ``--at``, or another flag, names, K; None if it is not given."""
    if not text:
        return None
    kelvin = amount_of("temperature", text, flag)
    return _positive(kelvin, f"{flag} is {text}: it must be above absolute zero")


def target_of(text: str, machine: Machine, flag: str = "--target") -> float:
    """Return the speed that ``--target``, or another flag, names, of belt or roll, m/s at the belt."""
    from hersey.units import parse

    if not text:
        raise ParameterError("the target speed is missing: add --target '60 mm/s'")
    with _of(flag):
        try:
            target = parse("belt speed", text)
        except WrongKindError:
            target = parse("speed", text) * machine.roll_radius
    return _positive(target, f"{flag} is {text}: it must be greater than 0")


def belt_speed_of(text: str, flag: str, kind: str = "belt speed") -> float:
    """Return a speed of the belt, or of another kind."""
    return _positive(amount_of(kind, text, flag), f"{flag} is {text}: it must be greater than 0")


def amount_of(kind: str, text: str, flag: str) -> float:
    """Return an amount of a kind that an option names, SI."""
    from hersey.units import parse

    with _of(flag):
        return parse(kind, text)


def inertia_in(text: str) -> dict[str, float]:
    """Return the moment of inertia of ``--inertia``, and half its 95 % interval if it has one, kg m^2."""
    from hersey.damping.inertia import inertia_of

    known = inertia_of(text, "--inertia")
    error = {"inertia_error": known.high - known.value} if known.error else {}
    return {"inertia": known.value} | error


def ratio_of(flag: str, text: str) -> float:
    """Return a plain number that an option names, or a ratio such as ``50:1``."""
    match = re.fullmatch(
        r"\s*([0-9]{1,9}(?:\.[0-9]{0,9})?)\s*(?::\s*([0-9]{1,9}(?:\.[0-9]{0,9})?))?\s*", text[:60]
    )
    if match is None or not float(match[1]) * float(match[2] or 1):
        raise ParameterError(f"{flag} is '{text}': write a number greater than 0, e.g. 50")
    return float(match[1]) / float(match[2] or 1)


@contextmanager
def _of(flag: str) -> Iterator[None]:
    """Begin what is wrong with a value with its option."""
    try:
        yield
    except UnitError as error:
        raise error.within(flag) from None


def _positive(value: float, otherwise: str) -> float:
    if not value > 0:
        raise ParameterError(otherwise)
    return value
