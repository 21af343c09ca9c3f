"""The table of a section as columns of cells, and what a layout makes of it: runs from wide tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from hersey.errors import UnreadableLogError
from hersey.log.layouts.pattern import Value, pattern
from hersey.log.layouts.sections import Line, Section
from hersey.log.layouts.table import LogLayout
from hersey.log.text.column import Column, split_unit
from hersey.log.text.layout import SNIFFED, Layout, find_layout
from hersey.log.text.numbers import NumberStyle
from hersey.log.text.separators import SEPARATORS, split
from hersey.log.text.stamps import StampStyle
from hersey.schema.warning import Warning

#: Line ends that stand for lines above a section, so that messages name lines of the file.
_MOST_ABOVE = SNIFFED // 4
#: Conditions of a table at the most.
_MOST_CONDITIONS = 1000


#: Name of the columns of conditions whose names say no more than that.
VALUE = "value"


@dataclass(frozen=True)
class Grid:
    """Rows of one run: the cells of each column, which lines they stand in, and numbers that hold for all."""

    columns: tuple[Column, ...]
    cells: tuple[list[str], ...]
    lines: tuple[int, ...]
    style: NumberStyle
    stamps: dict[int, StampStyle]  # by place among the columns
    values: dict[str, Value]
    warnings: tuple[Warning, ...] = ()


def grids_of(section: Section, page: Sequence[str], layout: LogLayout, place: str) -> Iterator[Grid]:
    """Yield the runs of a section.

    Raises
    ------
    UnreadableLogError
        If its lines make no table, or a name of ``[layout]`` is none of its columns.
    """
    grid, above = _table(section, page, layout, place)
    if layout.wide:
        yield from _conditions(grid, layout, above, place)
    elif layout.side_by_side:
        yield from _side_by_side(grid, place)
    else:
        yield grid


def transposed(lines: Sequence[str], layout: LogLayout, place: str) -> tuple[str, ...]:
    """Return the lines of a table whose rows are channels as one whose columns are."""
    separator = layout.separators or max(SEPARATORS, key=lambda each: sum(line.count(each) for line in lines))
    rows = [split(line, separator) for line in lines if line.strip()]
    usual = Counter(map(len, rows)).most_common(1)[0][0] if rows else 0
    rows = [row for row in rows if len(row) == usual]
    if usual < 3:
        raise UnreadableLogError(f"{place}: no rows of numbers to transpose were found")
    return tuple("\t".join(cells) for cells in zip(*rows, strict=True))


def _table(
    section: Section, page: Sequence[str], layout: LogLayout, place: str
) -> tuple[Grid, dict[int, str]]:
    """The table of a section, and the conditions that stand above its columns, by column."""
    separators = layout.separators or ("\t" if layout.transposed else SEPARATORS)
    text, where = _text(section, place)
    found = find_layout(text, where, separators=separators, long=bool(layout.channel_column))
    if layout.decimal_comma is not None:
        found = replace(found, style=NumberStyle(layout.decimal_comma, found.style.thousands))
    rows, lines = _rows(section, found, place)
    columns = tuple(c for c in found.columns if c.index not in found.texts or _is_named(layout, c))
    cells = tuple([row[c.index] for row in rows] for c in columns)
    stamps = {at: found.stamps[c.index] for at, c in enumerate(columns) if c.index in found.stamps}
    warnings = (*found.warnings, *_below(section))
    grid = Grid(columns, cells, tuple(lines), found.style, stamps, section.values, warnings)
    above: dict[int, str] = {}
    if layout.condition_line:
        line = page[layout.condition_line - 1] if layout.condition_line <= len(page) else ""
        above = _carried_on(split(line, found.separator), len(found.columns), layout)
    return grid, above


def _is_named(layout: LogLayout, column: Column) -> bool:
    return column.name in (layout.channel_column, layout.value_column)


def _text(section: Section, place: str) -> tuple[bytes, str]:
    """The lines of a section as a text, and its place; its lines have their numbers, so far as they can."""
    lines = [*_numbered_head(section), *section.rows]
    first = lines[0][0]
    text = [""] * (first - 1) if first <= _MOST_ABOVE else []
    size = len(text)
    above = first - len(text) - 1
    for number, line in lines:
        blank = number - above - 1 - len(text)
        text += [*[""] * min(blank, _MOST_ABOVE), line]
        size += blank + len(line) + 1
        if size > SNIFFED:
            break
    where = place if not above else f"{place}, from line {first}"
    return "\n".join(text).encode(errors="replace")[: SNIFFED - 1], where


def _numbered_head(section: Section) -> list[Line]:
    """Header lines with numbers just above the first row, where they stand elsewhere."""
    first = section.rows[0][0]
    head = section.head[-20:]
    if all(number < first for number, _ in head) and [n for n, _ in head] == sorted(n for n, _ in head):
        return head
    return [(max(1, first - len(head) + i), line) for i, (_, line) in enumerate(head)]


def _rows(section: Section, found: Layout, place: str) -> tuple[list[list[str]], list[int]]:
    width, rows, lines = len(found.columns), [], []
    for number, line in section.rows:
        row = split(line, found.separator)
        if any(row[width:]):
            raise UnreadableLogError(f"{place}, line {number}: {len(row)} cells, but the header has {width}")
        rows.append((row + [""] * (width - len(row)))[:width])
        lines.append(number)
    return rows, lines


def _below(section: Section) -> list[Warning]:
    """What was skipped below the rows."""
    if not section.below:
        return []
    words = "{lines} {lines:line|lines} below the table {lines:was|were} skipped: '{first}'"
    first = section.below[0][1].strip()[:60]
    return [Warning("lines below the table", words, lines=len(section.below), first=first)]


def _carried_on(cells: Sequence[str], width: int, layout: LogLayout) -> dict[int, str]:
    """The condition above each column: an empty cell goes on with the one to its left."""
    of, found, last = pattern(layout.wide or "*"), dict[int, str](), ""
    for index in range(width):
        cell = cells[index] if index < len(cells) else ""
        last = cell or last
        if last and of.match(last):
            found[index] = last
    return found


def _conditions(grid: Grid, layout: LogLayout, above: dict[int, str], place: str) -> Iterator[Grid]:
    """The run of each condition: its own columns beside those of all."""
    of = pattern(layout.wide or "*")
    runs: dict[tuple[Value, ...], dict[int, Column]] = {}
    shared: dict[int, Column] = {}
    counts = Counter(column.name.lower() for column in grid.columns)
    before: dict[int, Column] = {}  # columns of one name, each of the condition to its right
    for at, column in enumerate(grid.columns):
        text = above.get(column.index, "") if layout.condition_line else column.name
        match = of.match(text) if text else None
        if match is None:
            (shared if counts[column.name.lower()] == 1 else before)[at] = column
            continue
        name = column.name if layout.condition_line else match.channel or VALUE
        plain, own = split_unit(name)
        own_column = replace(column, name=name if column.unit else plain, unit=column.unit or own)
        runs.setdefault(tuple(match.values.values()), {}).update({**before, at: own_column})
        before = {}
    shared |= before
    if not runs:
        raise UnreadableLogError(
            f'{place}: no column matches wide = "{layout.wide}"', remedy="mend wide of [layout]"
        )
    _refuse_conditions(len(runs), place)
    for values, of_run in runs.items():
        yield _part(grid, shared | of_run, of_run, dict(zip(of.names, values, strict=True)), place)


def _side_by_side(grid: Grid, place: str) -> Iterator[Grid]:
    """The run of each repetition of the names."""
    counts, seen = Counter(c.name.lower() for c in grid.columns), Counter[str]()
    runs: dict[int, dict[int, Column]] = {}
    shared: dict[int, Column] = {}
    for at, column in enumerate(grid.columns):
        name = column.name.lower()
        if counts[name] == 1:
            shared[at] = column
            continue
        seen[name] += 1
        runs.setdefault(seen[name], {})[at] = column
    if len(runs) < 2 or len({len(own) for own in runs.values()}) > 1:
        raise UnreadableLogError(
            f"{place}: the names of the columns do not repeat evenly",
            remedy="delete side_by_side of [layout]",
        )
    _refuse_conditions(len(runs), place)
    for own in runs.values():
        yield _part(grid, shared | own, own, {}, place)


def _refuse_conditions(count: int, place: str) -> None:
    if count > _MOST_CONDITIONS:
        raise UnreadableLogError(f"{place} has {count} conditions; at most {_MOST_CONDITIONS} are read")


def _part(
    grid: Grid, chosen: dict[int, Column], own: dict[int, Column], values: dict[str, Value], place: str
) -> Grid:
    """Some columns of a grid, without the rows in which a condition has no number of its own."""
    names = Counter(column.name.lower() for column in chosen.values())
    if (twice := names.most_common(1)[0])[1] > 1:
        raise UnreadableLogError(
            f"{place}: two columns of one condition are called '{twice[0]}'", remedy="mend wide of [layout]"
        )
    kept = [row for row in range(len(grid.lines)) if any(grid.cells[at][row] for at in own)]
    order = sorted(chosen)
    return replace(
        grid,
        columns=tuple(chosen[at] for at in order),
        cells=tuple([grid.cells[at][row] for row in kept] for at in order),
        lines=tuple(grid.lines[row] for row in kept),
        stamps={new: grid.stamps[at] for new, at in enumerate(order) if at in grid.stamps},
        values={**grid.values, **values},
    )
