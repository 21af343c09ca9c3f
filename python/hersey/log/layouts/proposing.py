"""The layout proposed for a file that cannot be read as it stands: the first that makes a log of it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from hersey.errors import HerseyError, TimeOrderError, UnitError
from hersey.log.assembly import Assembly
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.layouts.grids import VALUE
from hersey.log.layouts.laid_out import recording_of
from hersey.log.layouts.pages import Page, Pages, pages_of
from hersey.log.layouts.pattern import pattern
from hersey.log.layouts.presets import BEGINNING, presets_in, with_preset
from hersey.log.layouts.seen import LOOKED_AT, Seen, stated_by_all, stated_in
from hersey.log.layouts.stacking import SECTION
from hersey.log.layouts.table import LogLayout
from hersey.log.reading import read
from hersey.log.roles import OTHER_ROLES, ROLES, is_called, is_of_kind
from hersey.log.text.column import Column, split_unit
from hersey.log.text.header import is_units_row
from hersey.log.text.numbers import looks_numeric
from hersey.log.text.split_seconds import is_milliseconds
from hersey.log.torque_log import LogFile, Run
from hersey.log.wanted import Wanted

#: Names of channels with a number behind.
_NUMBERED = re.compile(r"(.*?[A-Za-z°\u0370-\u9fff])([ _.:#-]{0,3})([0-9]{1,4})")
_TITLED = re.compile(r"([^0-9{}*]{0,40}?)([0-9]{1,6}(?:[.,][0-9]{1,3})?)([^0-9{}*]{0,20})")
#: Layouts that are tried at the most.
_MOST = 60


@dataclass(frozen=True)
class Proposal:
    """A layout, roles whose channels must be named, and whether temperature is to be left out.

    ``is_doubtful`` is whether it is a guess: its columns may be sensors instead of runs, or which column
    holds the values is not known.
    """

    layout: LogLayout
    channels: Mapping[str, str]
    isothermal: bool = False
    lacks_units: bool = False
    is_doubtful: bool = False


def proposed_layout(
    path: Path,
    channels: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    *,
    is_refused: bool = False,
) -> Proposal | None:
    """Return the layout by which a file becomes a log, or None if none is known.

    ``channels`` and ``units`` are those that a user states, by role. ``is_refused`` is whether the file
    cannot be read as it stands, not even without a few rows.
    """
    try:
        pages = pages_of(path)
    except HerseyError:
        return None
    pages = replace(pages, pages=tuple(Page(p.title, p.lines[:LOOKED_AT]) for p in pages.pages))
    best: Proposal | None = None
    plain = _plain_rank(path, channels or {}, units or {})
    for number, layout in enumerate(_candidates(pages)):
        found = _tried(pages, layout, channels or {}, units or {})
        least = plain if best is None else _rank(best)
        if best is None and is_refused and (layout.preset or layout.header):  # its headers are no rows
            least = (True, True)
        if found is not None and _rank(found) < least:
            best = found
        if number >= _MOST or (best is not None and _rank(best) == (False, False)):
            break
    return None if best is None else replace(best, is_doubtful=_is_doubtful(best, pages))


def _is_doubtful(proposal: Proposal, pages: Pages) -> bool:
    """Whether a layout is a guess, whatever numbers it gives."""
    layout = proposal.layout
    if layout.sheets == "*" or (layout.channel_column and not layout.preset and proposal.lacks_units):
        return True
    if proposal.isothermal and _is_of_lines(layout):  # the file as it stands, without its temperature
        return True
    headers = [line for page in pages.pages for line in _headers(Seen(page.lines, pages.is_workbook))]
    if layout.side_by_side or "{run}" in (layout.wide or ""):  # two sensors have one clock
        return max((_count("time", line) for line in headers), default=0) < 2
    return "{speed" in (layout.wide or "") and any(_count("speed", line) for line in headers)


def _headers(seen: Seen) -> Iterator[list[Column]]:
    """The columns of each line that may be a header."""
    for at in seen.words_above():
        yield [_unnumbered(Column(0, *split_unit(cell))) for cell in seen.cells(at) if cell]


def _count(role: str, header: list[Column]) -> int:
    """How many columns are called like a role, and have a unit of it."""
    return sum(is_called(role, c) and is_of_kind(role, c.unit) for c in header)


def _unnumbered(column: Column) -> Column:
    return replace(column, name=column.name.rstrip("0123456789 _.:#-"))


def _plain_rank(path: Path, channels: Mapping[str, str], units: Mapping[str, str]) -> tuple[bool, bool]:
    """The rank of a file as it stands: a layout has to make more of it; the last if it is no log so."""
    for isothermal in (False, True):
        kept = {role: of for role, of in channels.items() if not isothermal or role != "temperature"}
        try:
            read(path, channels=kept, units=dict(units), isothermal=isothermal, drop_missing=True)
        except UnitError:
            return True, False
        except HerseyError:
            continue
        else:
            return False, isothermal
    return True, True


def _rank(proposal: Proposal) -> tuple[bool, bool]:
    return proposal.lacks_units, proposal.isothermal


def _tried(
    pages: Pages, layout: LogLayout, channels: Mapping[str, str], units: Mapping[str, str]
) -> Proposal | None:
    """What a layout makes of a file, if that is a log with more than one speed."""
    try:
        recording = replace(recording_of(pages, with_preset(layout)), source=pages.source)
    except HerseyError:
        return None
    lacks_units = False
    for more in ({}, {"run": SECTION}):
        named = {**more, **channels}
        for isothermal in (False, True):
            choices = {r: ChannelChoice(named.get(r, ""), units.get(r, "")) for r in (*ROLES, *OTHER_ROLES)}
            try:
                runs = Assembly(recording, Wanted(choices, Stated(), isothermal)).runs()
            except TimeOrderError:
                break
            except UnitError:
                lacks_units = True
                continue
            except HerseyError:
                continue
            if _varies(runs):
                return Proposal(layout, more, isothermal)
    is_known = bool(layout.preset) or (lacks_units and not _is_of_lines(layout))
    is_known = is_known or any(signal.name == VALUE for signal in recording.signals)
    return Proposal(layout, {}, lacks_units=True) if is_known else None


def _is_of_lines(layout: LogLayout) -> bool:
    """Whether a layout says no more than which lines hold names, units and the first row."""
    return replace(layout, header_line=0, units_line=0, first_row=0) == LogLayout()


def _varies(runs: list[tuple[Run, LogFile]]) -> bool:
    """Whether there are at least two speeds."""
    speeds = [float(run.speed.mean()) for run, _ in runs]
    return max(speeds) > min(speeds) or any(run.speed.min() < run.speed.max() for run, _ in runs)


def _candidates(pages: Pages) -> Iterator[LogLayout]:
    """Layouts of which the file shows a sign, the simplest first."""
    seen = [Seen(page.lines, pages.is_workbook) for page in pages.pages]
    top = "\n".join(line for each in seen for line in each.lines[:BEGINNING])
    yield from (LogLayout(preset=name) for name in presets_in(top))
    one = next((each for each in seen if each.blocks), None)
    if one is None or _is_transposed(one):
        yield LogLayout(transposed=True)
    if one is None:
        return
    values = stated_by_all([each for each in seen if each.blocks])
    if pages.is_workbook and len(pages.pages) > 1:
        yield from _of_sheets(pages, values)
    else:
        yield from _of_sections(one, values)
    yield from _of_wide(one)
    yield from _of_header(one, values)
    yield from _of_rows(one)


def _is_transposed(seen: Seen) -> bool:
    """Whether each of a few lines is a name and numbers."""
    lines = [i for i, line in enumerate(seen.lines) if line.strip()]
    rows = [[cell for cell in seen.cells(i) if cell] for i in lines[:100]]
    return (
        1 < len(lines) < len(max(rows, key=len, default=[]))
        and sum(bool(row) and not looks_numeric(row[0]) for row in rows) > len(rows) / 2
    )


def _of_sheets(pages: Pages, values: tuple[str, ...]) -> Iterator[LogLayout]:
    """A run in each sheet, which its title or a line above may state."""
    titles = [page.title for page in pages.pages]
    templates = {stated_in(title) for title in titles} | {_with_run(title) for title in titles}
    yield LogLayout(sheets=_any_run(titles))
    for template in sorted(templates - {""}):
        if "{" in template:
            yield LogLayout(sheets=template)
    if values:
        yield LogLayout(values=values)


def _any_run(titles: list[str]) -> str:
    """A pattern of the titles that are alike but for a number; all sheets if none are."""
    alike = Counter(_with_run(title) for title in titles)
    template, count = alike.most_common(1)[0]
    return template if template and count > 1 else "*"


def _with_run(title: str) -> str:
    match = _TITLED.fullmatch(" ".join(title.split()))
    return f"{match[1]}{{run}}{match[3]}" if match else ""


def _of_sections(seen: Seen, values: tuple[str, ...]) -> Iterator[LogLayout]:
    """Blocks below each other, each with a header, a line that states something, or both."""
    if len(seen.blocks) < 2:
        return
    for at in reversed(list(seen.words_above())):
        template = beginning(seen, at)
        if template and all(
            any(same_beginning(seen, at, other) for other in block.above) for block in seen.blocks
        ):
            yield LogLayout(header=template)
            if values:
                yield LogLayout(header=template, values=values)
    if values:
        yield LogLayout(values=values)


def beginning(seen: Seen, at: int) -> str:
    """Return a pattern of lines that begin as a header does; nothing if there is none."""
    line = " ".join(seen.lines[at].split())
    first = next((cell for cell in seen.cells(at) if cell), "")
    end = line.find(first) + len(first) if first in line else 0
    behind = line[end : end + 1]
    return f"{line[:end]}{behind}*" if end and not set(line[:end]) & set("{}*") else ""


def same_beginning(seen: Seen, at: int, other: int) -> bool:
    """Return whether two lines begin with the same cell."""
    first = next((cell for cell in seen.cells(at) if cell), "")
    return first == next((cell for cell in seen.cells(other) if cell), "")


def _of_wide(seen: Seen) -> Iterator[LogLayout]:
    """Columns that hold one condition each, by their names or by a line above them."""
    above = list(seen.words_above())
    for at in reversed(above):
        cells = [cell for cell in seen.cells(at) if cell]
        names = [split_unit(cell)[0] for cell in cells]
        templates = Counter(filter(None, map(_condition, names)))
        for template, count in templates.most_common(3):
            matched = [cell for cell in cells if pattern(template).match(split_unit(cell)[0])]
            if count > 1 and ("{run}" not in template or _hold_runs(matched)):
                yield LogLayout(wide=template)
        counts = Counter(names)
        if _hold_runs([cell for cell, name in zip(cells, names, strict=True) if counts[name] > 1]):
            yield LogLayout(side_by_side=True)
    if not seen.blocks[0].above:
        return
    for at in reversed(seen.blocks[0].above[-6:]):
        cells = [cell for cell in seen.cells(at) if cell]
        unit = split_unit(cells[0])[1]
        if len(cells) > 2 and is_of_kind("speed", unit) and all(map(looks_numeric, cells[1:])):
            yield LogLayout(wide=f"{{speed:{unit}}}", condition_line=at + 1)
        templates = Counter(filter(None, (stated_in(cell) or _with_run(cell) for cell in cells)))
        for template, count in templates.most_common(2):
            runs = "{run}" not in template or _hold_runs([c for i in above for c in seen.cells(i)])
            if count > 1 and runs and template != "{run}":
                yield LogLayout(wide=template, condition_line=at + 1)


def _hold_runs(headers: list[str]) -> bool:
    """Whether columns are those of runs, and no second sensor: a clock or a speed is among them."""
    columns = [Column(0, *split_unit(header)) for header in headers]
    return any(
        is_of_kind("speed", c.unit)
        or is_called("speed", c)
        or (is_called("time", c) and is_of_kind("time", c.unit))
        for c in map(_unnumbered, columns)
    )


def _condition(name: str) -> str:
    """A pattern of the name of a column that ends with its condition, or with the number of its run."""
    if stated := stated_in(name):
        before, _, behind = stated.partition("{")
        channel = re.match(r"[^\W\d_]+(?: [^\W\d_]+)*", before)
        if channel and channel[0].strip():
            return f"{{channel}}{before[channel.end() :]}{{{behind}"
        return "" if before.strip() else stated
    match = _NUMBERED.fullmatch(name)
    return f"{{channel}}{match[2]}{{run}}" if match else ""


def _of_header(seen: Seen, values: tuple[str, ...]) -> Iterator[LogLayout]:
    """Names and units that do not stand just above the rows."""
    first = seen.blocks[0].first + 1
    above = list(seen.words_above())
    for names in reversed(above):
        for units in [i for i in above if i != names and is_units_row(seen.cells(i))]:
            yield LogLayout(header_line=names + 1, units_line=units + 1, first_row=first)
            if values:
                yield LogLayout(header_line=names + 1, units_line=units + 1, first_row=first, values=values)
        yield LogLayout(header_line=names + 1, first_row=first)
        if values:
            yield LogLayout(header_line=names + 1, first_row=first, values=values)


def _of_rows(seen: Seen) -> Iterator[LogLayout]:
    """Milliseconds beside time stamps, and rows that name their channels."""
    for at in reversed(list(seen.words_above())):
        cells = seen.cells(at)
        yield from (LogLayout(milliseconds=c) for c in cells if is_milliseconds(c))
    header = next((i for i, line in enumerate(seen.lines[:BEGINNING]) if len(seen.cells(i)) > 2), None)
    if header is None:
        return
    names, below = (
        seen.cells(header),
        [seen.cells(i) for i in range(header + 1, min(header + 200, len(seen.lines)))],
    )
    columns = list(zip(*[row for row in below if len(row) == len(names)], strict=True))
    words = [
        i for i, cells in enumerate(columns) if not any(map(looks_numeric, cells)) and len(set(cells)) < 20
    ]
    numbers = [
        i for i, cells in enumerate(columns) if len(set(cells)) > 20 and all(map(looks_numeric, cells))
    ]
    for i in words:
        for j in numbers:
            if names[i] and names[j]:
                yield LogLayout(header_line=header + 1, channel_column=names[i], value_column=names[j])
