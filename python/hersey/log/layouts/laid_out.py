"""A file read by a layout, as a recording."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from hersey.errors import HerseyError, UnreadableLogError
from hersey.log.layouts.grids import grids_of, transposed
from hersey.log.layouts.pages import Page, Pages, pages_of
from hersey.log.layouts.pattern import Found, pattern
from hersey.log.layouts.presets import with_preset
from hersey.log.layouts.sections import sections_of
from hersey.log.layouts.signals_apart import recording_of_pairs, recording_of_values
from hersey.log.layouts.stacking import Stack
from hersey.log.layouts.table import LogLayout
from hersey.log.recording import Recording


def laid_out(path: Path, layout: LogLayout) -> Recording:
    """Return what a file holds by a layout.

    Raises
    ------
    HerseyError
        It names the file, and the line or the key of ``[layout]``.
    """
    layout = with_preset(layout)
    pages = pages_of(path, layout.encoding)
    return recording_of(pages, layout)


def recording_of(pages: Pages, layout: LogLayout) -> Recording:
    """Return what the pages of a file hold by a layout without a preset."""
    file = pages.source.name
    stack = Stack(layout, file)
    for page, found, place in _chosen(pages, layout):
        lines = transposed(page.lines, layout, place) if layout.transposed else page.lines
        for section in sections_of(lines, layout, place, found.values):
            for grid in grids_of(section, lines, layout, place):
                if layout.paired_clocks:
                    return replace(recording_of_pairs(grid, layout, place), source=pages.source)
                if layout.channel_column:
                    return replace(recording_of_values(grid, layout, place), source=pages.source)
                stack.add(grid, place)
    return replace(stack.recording(pages.format), source=pages.source)


def _chosen(pages: Pages, layout: LogLayout) -> Iterator[tuple[Page, Found, str]]:
    """The pages that are read, what their titles state, and their places in words."""
    file = pages.source.name
    if not pages.is_workbook:
        yield pages.pages[0], Found({}), file
        return
    of = pattern(layout.sheets) if layout.sheets else None
    matched = [(page, of.match(page.title) if of else Found({})) for page in pages.pages]
    chosen = [(page, found) for page, found in matched if found is not None]
    if not chosen:
        titles = ", ".join(f"'{page.title}'" for page in pages.pages[:40])
        raise UnreadableLogError(f'{file}: no sheet matches sheets = "{layout.sheets}". Sheets: {titles}')
    read, first = 0, None
    for page, found in chosen:
        place = f"{file}, sheet '{page.title}'"
        try:
            has_rows = bool(sections_of(page.lines, layout, place, {})) or layout.transposed
        except HerseyError as error:
            first = first or error
            continue
        if has_rows:
            read += 1
            yield page, found, place
    if not read:
        raise first or UnreadableLogError(f"{file}: no sheet holds a table of numbers")
