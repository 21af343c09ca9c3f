"""The first line of a small table: what separates its cells, and names with units in brackets."""

from __future__ import annotations

import re
from collections.abc import Sequence

_HEADING = re.compile(r"\s*(.*?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")


def separator_of(line: str) -> str:
    """Return what separates the cells of a line: a comma, a semicolon or a tab."""
    return max(",;\t", key=line.count)


def headings_of(cells: Sequence[str]) -> list[tuple[str, str]]:
    """Return name and unit of each heading, the name in small letters.

    Examples
    --------
    >>> headings_of(["Age [pages]", "status"])
    [('age', 'pages'), ('status', '')]
    """
    found = (_HEADING.fullmatch(cell) for cell in cells)
    return [(match[1].casefold(), match[2] or "") if match else ("", "") for match in found]
