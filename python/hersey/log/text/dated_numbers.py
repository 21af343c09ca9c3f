"""Dates that a spreadsheet has made of numbers: 5.1 has become ``05. Jan``, and what it was is lost."""

from __future__ import annotations

import re

from hersey.log.text.stamps import is_clock_name

_MONTH = (
    "(?i:jan(uar|uary)?|feb(ruar|ruary)?|m[aä]r(z|ch)?|mrz|apr(il)?|ma[iy]|jun[ei]?|jul[iy]?|aug(ust)?"
    "|sept?(ember)?|o[ck]t(ober)?|nov(ember)?|de[cz](ember)?)"
)
_MIDNIGHT = r"([ T]0{1,2}:00(:00(\.0+)?)?)?"
_DATE = re.compile(
    rf"[0-9]{{1,2}}[. -]{{1,2}}{_MONTH}\.?([. -]{{1,2}}[0-9]{{2,4}})?"  # 05. Jan, 5-Jan, 5-Jan-26
    rf"|{_MONTH}\.?[. -]{{1,2}}[0-9]{{1,4}}"  # Jan 05, Jan-05, Jan 2005
    rf"|[0-9]{{1,2}}(?P<mark>[./-])[0-9]{{1,2}}(?P=mark)[0-9]{{4}}{_MIDNIGHT}"  # 05.01.2026, 1/5/2026
    rf"|[0-9]{{4}}-[0-9]{{2}}-[0-9]{{2}}{_MIDNIGHT}",
    re.ASCII | re.IGNORECASE,
)


def is_date(cell: str) -> bool:
    """Return whether a cell is a day without a time, as spreadsheets write it.

    Examples
    --------
    >>> is_date("05. Jan"), is_date("5-Jan"), is_date("Jan 05"), is_date("05.01.2026"), is_date("5.1")
    (True, True, True, True, False)
    """
    return len(cell) <= 40 and bool(_DATE.fullmatch(cell.strip()))


def was_number(column: str, cell: str) -> bool:
    """Return whether a cell of a column so called is a date where a number must have been."""
    return not is_clock_name(column) and is_date(cell)


def numbers_lost(column: str) -> str:
    """Return what to do about a column in which numbers have become dates."""
    return (
        f"A spreadsheet has made dates of numbers in column '{column}', and this file has lost these "
        "numbers. Export it again from the original file, with the column formatted as number"
    )
