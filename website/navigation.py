"""Which page stands where: parts in the order of a reader, and in each part its pages.

Pages of a folder follow the list here, then the links of its ``index.md``, then their names.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"


@dataclass(frozen=True)
class Part:
    """One entry at the top: a page of its own, or the pages of a folder."""

    title: str
    page: str = ""
    folder: str = ""
    #: Pages of the folder that come first, by name; ``index`` is that of the part itself.
    first: tuple[str, ...] = ()


PARTS = (
    Part("Home", page="index.md"),
    Part("Tutorial", folder="tutorial"),
    Part("How to", folder="how-to", first=("index",)),
    Part(
        "Theory",
        folder="theory",
        first=(
            "index",
            "models",
            "verdict",
            "film",
            "mixed",
            "reynolds",
            "motion",
            "closures",
            "hysteresis",
            "operating-map",
            "plan",
            "thermal",
            "cycles",
            "decision",
            "life",
        ),
    ),
    Part(
        "Reference",
        folder="reference",
        first=("index", "commands", "python", "files", "document", "logs", "report", "inspect", "app"),
    ),
    Part("Gallery", page="gallery.md"),
    Part(
        "Validation",
        folder="validation",
        first=(
            "index",
            "measurements",
            "joints",
            "moving",
            "coast-down",
            "trends",
            "failures",
            "layouts",
            "paper",
            "growth",
        ),
    ),
    Part("Glossary", page="glossary.md"),
)

#: A page that an index links to in its own folder.
_LINKED = re.compile(r"\]\(([\w-]+)\.md[)#]")
#: A title and its page, or the pages below it.
Entry = dict[str, "str | list[Entry]"]


def navigation(docs: Path = DOCS) -> list[Entry]:
    """Return the entries of the navigation, as the configuration of the site holds them."""
    entries: list[Entry] = []
    for part in PARTS:
        if part.page:
            entries += [{part.title: part.page}] * (docs / part.page).is_file()
        elif below := _folder(docs, docs / part.folder, part.first):
            entries.append({part.title: below})
    return entries


def missing(docs: Path = DOCS) -> list[str]:
    """Return what the parts name and the docs lack: pages, and folders without a page."""
    lacking = []
    for part in PARTS:
        if part.page:
            lacking += [part.page] * (not (docs / part.page).is_file())
            continue
        if not _pages(docs / part.folder):
            lacking.append(f"{part.folder}/*.md")
        for name in part.first:
            page = docs / part.folder / name
            if name != "index" and not page.with_suffix(".md").is_file() and not page.is_dir():
                lacking.append(f"{part.folder}/{name}.md")
    return lacking


def reached(entries: list[Entry]) -> list[str]:
    """Return the pages that entries lead to, in their order."""
    found: list[str] = []
    for entry in entries:
        for target in entry.values():
            found += [target] if isinstance(target, str) else reached(target)
    return found


def title_of(page: Path) -> str:
    """Return the first heading of a page."""
    fenced = False
    for line in page.read_text(encoding="utf-8").splitlines():
        fenced ^= line.startswith("```")
        if line.startswith("# ") and not fenced:
            return line[2:].strip().replace("`", "").replace("\\", "")
    return page.stem.replace("-", " ").capitalize()


def _pages(folder: Path) -> list[Path]:
    """The pages of a folder, and the folders in it that have pages."""
    if not folder.is_dir():
        return []
    return sorted(
        each
        for each in folder.iterdir()
        if each.suffix == ".md" or (each.is_dir() and any(each.glob("*.md")))
    )


def _folder(docs: Path, folder: Path, first: tuple[str, ...]) -> list[Entry]:
    pages = {each.stem: each for each in _pages(folder)}
    linked = _LINKED.findall(pages["index"].read_text(encoding="utf-8")) if "index" in pages else []
    order = dict.fromkeys(name for name in (*first, *linked, *pages) if name in pages)
    entries: list[Entry] = []
    for name in order:
        page = pages[name]
        if page.is_dir():
            index = page / "index.md"
            title = title_of(index) if index.is_file() else name.capitalize()
            entries.append({title: _folder(docs, page, ("index",))})
        else:
            entries.append({title_of(page): page.relative_to(docs).as_posix()})
    return entries
