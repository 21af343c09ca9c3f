"""Links and headings of Markdown, as GitHub reads them."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from website.build import LINK
from website.navigation import DOCS

_FENCED = re.compile(r"^(```|~~~).*?^\1\s*$", re.DOTALL | re.MULTILINE)
_CODE = re.compile(r"`[^`\n]*`")
_HEADING = re.compile(r"^#{1,6} (.+?)\s*$", re.MULTILINE)
#: Anchors that mkdocstrings makes.
_NAMED = re.compile(r"^::: (\S+)$", re.MULTILINE)
#: Anchors that a page writes itself.
_WRITTEN = re.compile(r'<a id="([^"]+)"></a>')


def links(page: Path) -> list[str]:
    """Return the targets of all links and pictures of a page that lead to a file or a heading."""
    text = _CODE.sub("", _FENCED.sub("", page.read_text(encoding="utf-8")))
    return [target for _, _, target in LINK.findall(text) if not re.match(r"[a-z]+:", target)]


@cache
def anchors(page: Path) -> set[str]:
    """Return the anchors of a page: of its headings, and of the names that it documents."""
    text = _FENCED.sub("", page.read_text(encoding="utf-8"))
    found: set[str] = set()
    for heading in _HEADING.findall(text):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").replace("\\", "")
        anchor = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
        number = next(i for i in range(1000) if (f"{anchor}-{i}" if i else anchor) not in found)
        found.add(f"{anchor}-{number}" if number else anchor)
    return found | set(_NAMED.findall(text)) | set(_WRITTEN.findall(text))


def broken(page: Path) -> list[str]:
    """Return the links of a page that lead nowhere."""
    wrong = []
    for target in links(page):
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists() or (anchor and file.suffix == ".md" and anchor not in anchors(file)):
            wrong.append(target)
    return wrong


def pages(root: Path) -> list[Path]:
    """Return every page of the repository that people read."""
    return [
        *sorted(root.glob("*.md")),
        *sorted(DOCS.rglob("*.md")),
        *sorted((root / "benchmarks").glob("*.md")),
    ]
