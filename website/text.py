"""Markdown: tables, and pages cut into the sections of their headings."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence

_SECTION = re.compile(r"^## (.+)$", re.MULTILINE)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; a column without a cell in any row is left out."""
    rows = [[cell.replace("|", r"\|").replace("\n", " ") for cell in row] for row in rows]
    kept = [i for i in range(len(heads)) if i == 0 or any(row[i] for row in rows)]
    lines = [[heads[i] for i in kept], ["---"] * len(kept), *([row[i] for i in kept] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def sections(text: str) -> tuple[str, dict[str, str]]:
    """Return what stands above the first heading of the second level, and the text of each section."""
    first, *others = _SECTION.split(text)
    return first.strip(), {
        title.strip(): body.strip() for title, body in zip(others[::2], others[1::2], strict=True)
    }


def joined(parts: Iterable[str]) -> str:
    """Return paragraphs, tables and headings as a page; blank ones are left out."""
    return "\n\n".join(part.strip("\n") for part in parts if part.strip()) + "\n"


def wrapped(paragraph: str) -> str:
    """Return a paragraph in lines of the usual width."""
    return textwrap.fill(paragraph, 110, break_long_words=False, break_on_hyphens=False)
