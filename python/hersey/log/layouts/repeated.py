"""The layout of a table that stands in blocks, each below the same header."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from hersey.errors import HerseyError
from hersey.log.layouts.pages import Page, pages_of
from hersey.log.layouts.pattern import pattern
from hersey.log.layouts.presets import BEGINNING, PRESETS, presets_in
from hersey.log.layouts.proposing import beginning, same_beginning
from hersey.log.layouts.sections import is_row
from hersey.log.layouts.seen import LOOKED_AT, Seen, stated_by_all
from hersey.log.layouts.table import LogLayout


def layout_of_blocks(path: Path) -> LogLayout | None:
    """Return the layout of a text in which one header stands above several blocks of rows, or None."""
    try:
        pages = pages_of(path)
    except HerseyError:
        return None
    lines = pages.pages[0].lines[:LOOKED_AT] if pages.pages else ()
    if pages.is_workbook or not _repeats_a_header(lines):
        return None
    if preset := _preset(lines):
        return LogLayout(preset=preset)
    seen = Seen(Page("", lines).lines)
    if len(seen.blocks) < 2:
        return None
    for at in reversed(list(seen.words_above())):
        template = beginning(seen, at)
        if template and all(any(same_beginning(seen, at, o) for o in block.above) for block in seen.blocks):
            values = stated_by_all([seen])
            return LogLayout(header=template, section=_title(seen, values), values=values)
    return None


def _repeats_a_header(lines: tuple[str, ...]) -> bool:
    """Whether a line of at least two words stands twice; quick, as any file may be asked."""
    counts = Counter(line.strip() for line in lines)
    return any(
        count > 1 and any(each in line for each in "\t;,|") and any(map(str.isalpha, line))
        and not is_row(line)
        for line, count in counts.items()
    )  # fmt: skip


def _preset(lines: tuple[str, ...]) -> str:
    """The known instrument whose export has sections and begins so."""
    known = presets_in("\n".join(lines[:BEGINNING]))
    return next((name for name in known if PRESETS[name].layout.section), "")


def titles_of(path: Path, layout: LogLayout) -> tuple[tuple[str, ...], bool]:
    """Return the different lines that stand above blocks as titles, and whether each is of another test."""
    lines = pages_of(path).pages[0].lines[:LOOKED_AT]
    if layout.preset:
        above = PRESETS[layout.preset].layout.skip[:1]
        titles = [line for line in lines if any(pattern(each).match(line) for each in above)]
        return tuple(dict.fromkeys(map(_plain, titles))), True
    return tuple(dict.fromkeys(map(_plain, _last_alone(Seen(lines))))), False


def _plain(line: str) -> str:
    return " ".join(line.split())


def _title(seen: Seen, values: tuple[str, ...]) -> str | None:
    """A pattern of the titles of the blocks, if all begin with one word and state nothing."""
    stated = [pattern(each) for each in values]
    titles = [line for line in _last_alone(seen) if not any(each.match(line) for each in stated)]
    words = {line.split()[0] for line in titles}
    if len(titles) < len(seen.blocks) or len(words) > 1 or set(word := words.pop()) & set("{}*"):
        return None
    return f"{word} *"


def _last_alone(seen: Seen) -> list[str]:
    """The last line of one cell above each block."""
    found = []
    for block in seen.blocks:
        alone = [seen.lines[at] for at in block.above if len(list(filter(None, seen.cells(at)))) == 1]
        found += alone[-1:]
    return found
