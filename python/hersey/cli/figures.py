"""Numbers as a terminal shows them: three figures, an interval rounded like its value, columns that align."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

#: Significant figures of a result, and of the half width of an interval.
_FIGURES, _OF_WIDTH = 3, 2
#: Numbers outside this range are written with an exponent.
_SMALL, _LARGE = 1e-4, 1e7


def three(value: float, unit: str = "") -> str:
    """Return a number to three significant figures, with its unit.

    Examples
    --------
    >>> three(59.5878, "mm/s"), three(7802), three(0.1043), three(0)
    ('59.6 mm/s', '7800', '0.104', '0')
    """
    return f"{_figures(value, _FIGURES)} {unit if math.isfinite(value) else ''}".rstrip()


def four(value: float) -> str:
    """Return a number of a profile, to four significant figures."""
    return _figures(value, _FIGURES + 1)


def _figures(value: float, figures: int) -> str:
    if not math.isfinite(value):
        return "not known" if math.isnan(value) else "infinite" if value > 0 else "-infinite"
    if value == 0 or not _SMALL <= abs(value) < _LARGE:
        return f"{value:.{figures}g}"
    rounded = float(f"{value:.{figures}g}")
    place = max(figures - 1 - math.floor(math.log10(abs(rounded))), 0)
    text = f"{rounded:.{place}f}"
    return text.rstrip("0").rstrip(".") if place else text


def within(values: Iterable[float], unit: str = "", *, factor: float = 1.0) -> str:
    """Return a value with its interval in brackets, all to the same place.

    Parameters
    ----------
    values
        Value, lower end and upper end.
    unit
        The unit in which they are shown.
    factor
        How many of that unit make one of the values.

    Examples
    --------
    >>> within((-0.5962, -0.6202, -0.5722)), within((0.1042, 0.0964, 0.1176), "mm/s", factor=1e3)
    ('-0.596 [-0.620, -0.572]', '104 [96, 118] mm/s')
    """
    value, low, high = (factor * each for each in values)
    if not all(map(math.isfinite, (value, low, high))):
        return f"{three(value)} (no interval) {unit}".rstrip()
    largest, half = max(map(abs, (value, low, high))), (high - low) / 2
    if not _SMALL <= largest < _LARGE:
        return f"{value:.3g} [{low:.3g}, {high:.3g}] {unit}".rstrip()
    place = _FIGURES - 1 - math.floor(math.log10(largest))
    if half > 0:
        place = min(place, _OF_WIDTH - 1 - math.floor(math.log10(half)))
    shown = [f"{round(each, place) + 0.0:.{max(place, 0)}f}" for each in (value, low, high)]
    return f"{shown[0]} [{shown[1]}, {shown[2]}] {unit}".rstrip()


def columns(
    head: Sequence[str], rows: Sequence[Sequence[str]], *, indent: int = 2, first: str = "<"
) -> list[str]:
    """Return a table as lines, columns aligned to the right, the ``first`` to the left unless it is ``>``."""
    table = [list(head), *map(list, rows)]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = []
    for label, *others in table:
        cells = [f"{label:{first}{widths[0]}}"]
        cells += [f"{cell:>{size}}" for cell, size in zip(others, widths[1:], strict=True)]
        lines.append((" " * indent + "  ".join(cells)).rstrip())
    return lines


def labelled(rows: Sequence[tuple[str, str]], *, indent: int = 2) -> list[str]:
    """Return labels with their text beside them, as lines."""
    size = max((len(label) for label, _ in rows), default=0)
    return [f"{' ' * indent}{label:<{size}}  {text}" for label, text in rows]
