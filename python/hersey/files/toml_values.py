"""Values of a TOML table: strings with units, and plain numbers."""

from __future__ import annotations

from collections.abc import Mapping

from hersey.errors import ParameterError, UnitError
from hersey.units import KINDS, parse


def values(
    file: str, name: str, table: object, kinds: Mapping[str, tuple[str | None, float, float]]
) -> dict[str, float]:
    """Return the values of a table that are stated, checked.

    ``kinds`` gives the kind of unit (none for a plain number), the least and the greatest value believed.

    Raises
    ------
    ParameterError, UnitError
        Each names the file and the key.
    """
    if not isinstance(table, dict):
        raise ParameterError(f"{file}: {name} is not a table: write [{name}]")
    unknown = sorted(set(table) - set(kinds))
    if unknown:
        raise ParameterError(f"{file}: [{name}] has no key '{unknown[0]}': {', '.join(kinds)} are known")
    return {key: value_of(file, f"{name}.{key}", text, *kinds[key]) for key, text in table.items()}


def value_of(file: str, key: str, text: object, kind: str | None, low: float, high: float) -> float:
    """Return one value in SI, checked, as `values` does; ``key`` names it in errors."""
    if kind is None:
        if isinstance(text, bool) or not isinstance(text, int | float):
            raise ParameterError(f"{file}: {key} is {text!r}: write a number")
        value, si = float(text), ""
    else:
        if not isinstance(text, str):
            raise UnitError(f"{file}: {key} is {text}: write a string with its unit")
        try:
            value, si = parse(kind, text), " " + KINDS[kind][0]
        except UnitError as error:
            raise UnitError(f"{file}: {key}: {error}") from None
    if not value > 0:
        raise ParameterError(f"{file}: {key} is {text}: it must be greater than 0")
    if not low <= value <= high:
        raise ParameterError(f"{file}: {key} is {text}: {low:g} to {high:g}{si} is believed")
    return value
