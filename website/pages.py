"""The pages of the docs that are made: which they are, and what they hold."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from hersey.report import glossary
from website import commands, document, files, names, notebooks
from website.navigation import DOCS

REFERENCE = DOCS / "reference"


@cache
def made() -> dict[Path, str]:
    """Return every page that is made, with its text."""
    single = {
        "commands.md": commands.page(),
        "document.md": document.page(),
        "files.md": files.page(),
    }
    rooms = {f"python/{name}": text for name, text in names.pages()}
    reference = {REFERENCE / name: text for name, text in (single | rooms).items()}
    return reference | {DOCS / "glossary.md": glossary.markdown()} | dict(notebooks.notebooks())


def renew() -> list[Path]:
    """Write the pages that have changed, delete those of names that are gone, and return both."""
    pages = made()
    changed = [
        page for page, text in pages.items() if not page.is_file() or page.read_text(encoding="utf-8") != text
    ]
    for page in changed:
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text(pages[page], encoding="utf-8")
    gone = [page for page in (REFERENCE / "python").glob("*.md") if page not in pages]
    for page in gone:
        page.unlink()
    return changed + gone
