"""The notebooks of the tutorial: the Python block of each page, cut into cells.

A paragraph of the block is a cell, and its first comments are the text above it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from website.navigation import DOCS, title_of

_BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_COMMENTS = re.compile(r"((?:# [^\n]*\n)*)(.*)", re.DOTALL)
#: What the tutorial types as `hersey examples examples`.
_EXAMPLES = """\
from pathlib import Path

from hersey.files.shipped import copy_examples

if not Path("examples").exists():
    copy_examples(Path("examples"))"""
_ABOUT = "Run the cells from top to bottom. The page of the tutorial with this title explains each result."


def notebooks() -> Iterator[tuple[Path, str]]:
    """Return each notebook, beside its page, and its text."""
    for page in sorted((DOCS / "tutorial").glob("*.md")):
        yield page.with_suffix(".ipynb"), notebook(title_of(page), page.read_text(encoding="utf-8"))


def notebook(title: str, page: str) -> str:
    """Return the notebook of a page in the format of Jupyter, version 4.5."""
    cells = [("markdown", f"# {title}\n\n{_ABOUT}"), ("markdown", "Copy the examples."), ("code", _EXAMPLES)]
    for block in _BLOCK.findall(page):
        for paragraph in re.split(r"\n{2,}", block.strip()):
            comments, code = _COMMENTS.fullmatch(paragraph).groups()  # type: ignore[union-attr]  # all fits
            words = " ".join(line.removeprefix("# ") for line in comments.splitlines())
            cells += [("markdown", words)] * bool(words) + [("code", code)] * bool(code)
    document = {
        "cells": [_cell(number, kind, text) for number, (kind, text) in enumerate(cells, 1)],
        "metadata": {
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"name": "python"},
        },
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def _cell(number: int, kind: str, text: str) -> dict[str, Any]:
    cell = {
        "cell_type": kind,
        "id": f"cell-{number}",
        "metadata": {},
        "source": text.splitlines(keepends=True),
    }
    return cell | {"execution_count": None, "outputs": []} if kind == "code" else cell
