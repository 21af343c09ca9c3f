"""How a text file writes numbers: decimal mark, thousands mark, and words for a value that is missing."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import polars as pl

from hersey.arrays import FloatArray

#: Characters of a number at the most: longer cells are text, whatever they hold.
LONGEST_NUMBER = 60
#: Spellings of a value that was not measured.
MISSING = (
    *("", "nan", "-nan", "na", "n/a", "null", "none", "-", "--", "---", "inf", "-inf", "+inf"),
    *("ovl", "overload", "over", "ol", "#n/a", "#value!", "#div/0!", "#num!", "#ref!"),
    *("#nv", "#wert!", "#zahl!", "#bezug!", "#name?", "#null!"),  # those of Excel in German too
    *("1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind", "1.#inf", "-1.#inf", "nan(ind)", "-nan(ind)"),
)
#: The same, as polars takes them.
NULLS = sorted({s for word in MISSING for s in (word, word.upper(), word.capitalize())} | {"NaN"})
#: Thousands marks: no-break, narrow and thin spaces are written for a blank.
BLANKS = " \u00a0\u202f\u2009"
_MISSING = frozenset(MISSING)
_EXPONENT = r"([eE][-+]?[0-9]+)?"  # \d would take the digits of every script


@dataclass(frozen=True)
class NumberStyle:
    """Decimal comma or point, and the thousands mark (empty if there is none, a blank for any blank)."""

    decimal_comma: bool = False
    thousands: str = ""

    @property
    def is_plain(self) -> bool:
        """Whether cells are numbers as they stand."""
        return not self.decimal_comma and not self.thousands

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        mark = "," if self.decimal_comma else r"\."
        plain = rf"[-+]?([0-9]+{mark}?[0-9]*|{mark}[0-9]+){_EXPONENT}"
        if not self.thousands:
            return re.compile(plain)
        group = f"[{BLANKS}]" if self.thousands == " " else re.escape(self.thousands)
        return re.compile(rf"{plain}|[-+]?[0-9]{{1,3}}({group}[0-9]{{3}})+({mark}[0-9]*)?{_EXPONENT}")

    def is_number(self, cell: str) -> bool:
        """Return whether a cell is a finite number in this style."""
        return len(cell) <= LONGEST_NUMBER and bool(self._pattern.fullmatch(cell))

    def value(self, cell: str) -> float:
        """Return the number in a cell that is one."""
        for mark in BLANKS if self.thousands == " " else self.thousands:
            cell = cell.replace(mark, "")
        return float(cell.replace(",", ".") if self.decimal_comma else cell)

    def readable(self, cells: pl.Series) -> pl.Series:
        """Return for each cell of text whether it is a number or stands for a missing one."""
        text = cells.str.strip_chars()
        good = text.str.contains(f"^(?:{self._pattern.pattern})$") & (text.str.len_chars() <= LONGEST_NUMBER)
        return _missing(text) | good.fill_null(False)

    def values(self, cells: pl.Series) -> FloatArray | None:
        """Return cells of text as numbers, NaN where one is missing, or None if some are no numbers."""
        if not self.readable(cells).all():
            return None
        text = cells.str.strip_chars()
        missing = _missing(text)
        for mark in BLANKS if self.thousands == " " else self.thousands:
            text = text.str.replace_all(mark, "", literal=True)
        if self.decimal_comma:
            text = text.str.replace_all(",", ".", literal=True)
        numbers = text.set(missing, None).cast(pl.Float64, strict=True)
        return np.asarray(numbers.fill_null(np.nan).to_numpy(), dtype=float)


def is_missing(cell: str) -> bool:
    """Return whether a cell stands for a value that was not measured."""
    return cell.lower() in _MISSING


def _missing(text: pl.Series) -> pl.Series:
    return text.is_null() | text.str.to_lowercase().is_in(MISSING).fill_null(True)


def decimal_comma(cells: list[str]) -> bool:
    """Return whether more cells are numbers with a decimal comma than with a point."""
    commas = sum("," in cell and _COMMA.is_number(cell) for cell in cells)
    points = sum("." in cell and _POINT.is_number(cell) for cell in cells)
    return commas > points


def style_of(cells: list[str]) -> NumberStyle:
    """Return the style of a file from some of its cells.

    A thousands mark is believed only where a cell leaves no doubt: it stands twice, beside a decimal mark, or
    is a blank or an apostrophe.
    """
    plain = NumberStyle(decimal_comma(cells))
    if not _THOUSANDS_SURELY.search("\n".join(cells)):
        return plain
    telling = [cell for cell in cells if _THOUSANDS_SURELY.search(cell)]
    readable = sum(plain.is_number(cell) for cell in cells)
    for style in _THOUSANDS:
        if any(style.is_number(cell) for cell in telling):
            marked = NumberStyle(_decimal_comma_beside(style, cells), style.thousands)
            if sum(marked.is_number(cell) for cell in cells) > readable:
                return marked
    return plain


def with_thousands(style: NumberStyle, cells: list[str]) -> NumberStyle:
    """Return the style with the thousands mark that some cells it cannot read surely have, or as it is."""
    telling = [cell for cell in cells if _THOUSANDS_SURELY.search(cell)]
    marked = [s for s in _THOUSANDS if s.decimal_comma == style.decimal_comma]
    return next((s for s in marked if telling and all(map(s.is_number, telling))), style)


def looks_numeric(cell: str) -> bool:
    """Return whether a cell is a number in some style."""
    if _POINT.is_number(cell):  # as most are
        return True
    if len(cell) > LONGEST_NUMBER or not _LIKELY.fullmatch(cell):
        return False
    return any(style.is_number(cell) for style in (_COMMA, *_THOUSANDS))


def _decimal_comma_beside(style: NumberStyle, cells: list[str]) -> bool:
    """The decimal mark, which a blank or an apostrophe as thousands mark leaves open."""
    return style.decimal_comma if style.thousands in ",." else decimal_comma(cells)


_POINT, _COMMA = NumberStyle(), NumberStyle(decimal_comma=True)
_THOUSANDS = (
    NumberStyle(False, ","),
    NumberStyle(True, "."),
    *(NumberStyle(comma, mark) for mark in " '" for comma in (False, True)),
)
_THOUSANDS_SURELY = re.compile(
    rf"\d([.,])\d{{3}}\1\d{{3}}(\D|$)|\d,\d{{3}}\.|\d\.\d{{3}},|\d[{BLANKS}']\d{{3}}(\D|$)", re.ASCII
)
_LIKELY = re.compile(rf"[-+]?[\d.,][\d.,'{BLANKS}]*([eE][-+]?\d+)?", re.ASCII)
