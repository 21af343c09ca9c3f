"""Lines of a page cut into sections: each with a header of its own, or the one before, and what it states."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from hersey.errors import UnreadableLogError
from hersey.log.layouts.pattern import Value, pattern
from hersey.log.layouts.table import LogLayout
from hersey.log.text.numbers import is_missing, looks_numeric
from hersey.log.text.separators import BLANKS, SEPARATORS, split
from hersey.log.text.stamps import is_stamp

#: Sections of a file at the most.
_MOST = 10_000
#: A line with its number in the file, counted from 1.
Line = tuple[int, str]


@dataclass
class Section:
    """One table: its lines, and what holds for all its rows; ``line`` is where it begins."""

    line: int
    values: dict[str, Value] = field(default_factory=dict)
    head: list[Line] = field(default_factory=list)  #: lines above the rows, header and units among them
    rows: list[Line] = field(default_factory=list)
    below: list[Line] = field(default_factory=list)  #: lines that are no rows, below them


def sections_of(
    lines: Sequence[str], layout: LogLayout, place: str, stated: Mapping[str, Value]
) -> list[Section]:
    """Return the tables of a page; ``stated`` are numbers that hold for all of it.

    Raises
    ------
    UnreadableLogError
        If a line stands among the rows that is none, or a section lacks a number that others state.
    """
    found = _Cutting(layout, place, stated)
    for number, line in _kept(lines, layout, found.read_on):
        found.add(number, line)
    return found.whole()


def _kept(lines: Sequence[str], layout: LogLayout, look: Callable[[str], None]) -> Iterator[Line]:
    """The lines that are not left out, after a look at each."""
    skipped = [pattern(each) for each in layout.skip]
    for number, line in enumerate(lines, start=1):
        look(line)
        if not line.strip() or (layout.comment and line.lstrip().startswith(layout.comment)):
            continue
        if not any(each.match(line) for each in skipped):
            yield number, line


class _Cutting:
    """The sections of a page while its lines are gone through."""

    def __init__(self, layout: LogLayout, place: str, stated: Mapping[str, Value]) -> None:
        self.layout, self.place = layout, place
        self.section = pattern(layout.section) if layout.section else None
        self.header = pattern(layout.header) if layout.header else None
        self.values = [pattern(each) for each in layout.values]
        self.only = pattern(layout.only) if layout.only else None
        self.reads, self.word = self.only is None, ""
        self.done: list[Section] = []
        self.now = Section(1, dict(stated))

    def read_on(self, line: str) -> None:
        """Note whether rows below a line are read: those up to the next line that begins with its word."""
        if self.only is None or not line.strip():
            return
        word = line.split(maxsplit=1)[0]
        if self.only.match(line):
            self.reads, self.word = True, word
        elif word == self.word:
            self.reads = False

    def add(self, number: int, line: str) -> None:
        """Take the next line."""
        if self.section and (found := self.section.match(line)):
            self._begin(number, found.values)
        elif found := next((m for each in self.values if (m := each.match(line))), None):
            if self.now.rows:
                self._begin(number, {})
            self.now.values |= found.values
        elif self._is_header(number, line):
            if self.now.rows:
                self._begin(number, {})
            if self.layout.header_line:
                self.now.head = [line for line in self.now.head if line[0] == self.layout.units_line]
            self.now.head.append((number, line))
        elif self._is_row(number, line):
            if self.reads:
                self._add_row(number, line)
        elif self.now.rows:
            self.now.below.append((number, line))
        elif not self._is_passed_over(number):
            self.now.head.append((number, line))

    def _begin(self, number: int, values: Mapping[str, Value]) -> None:
        """End the section, and begin the next; what no section states anew holds on."""
        if self.now.rows:
            self.done.append(self.now)
        if len(self.done) > _MOST:
            raise UnreadableLogError(f"{self.place} has more than {_MOST} sections")
        kept = self.now.values if not self.now.rows else {}
        self.now = Section(number, {**kept, **values}, [] if self.now.rows else self.now.head)

    def _add_row(self, number: int, line: str) -> None:
        if self.now.below:
            other, text = self.now.below[0]
            if not (self.section or self.header or self.values):  # a row without numbers: counted as such
                self.now.rows += self.now.below
            else:
                raise UnreadableLogError(
                    f"{self.place}, line {other}: '{text.strip()[:60]}' stands among the rows, and no "
                    "pattern of [layout] matches it",
                    remedy="mend section, header or values, or name such lines in skip",
                )
            self.now.below.clear()
        self.now.rows.append((number, line))

    def _is_header(self, number: int, line: str) -> bool:
        if self.header:
            return self.header.match(line) is not None
        return number == self.layout.header_line

    def _is_row(self, number: int, line: str) -> bool:
        if number < max(self.layout.first_row, self.layout.header_line + 1):
            return False
        if number == self.layout.units_line:
            return False
        if self.now.rows and _is_like(line, self.now.rows[-1][1]):
            return True
        return is_row(line, self.layout.separators, named=bool(self.layout.channel_column))

    def _is_passed_over(self, number: int) -> bool:
        """Whether a line above the rows is neither names nor units, where the layout says which are."""
        return bool(self.layout.header_line) and number not in (
            self.layout.header_line,
            self.layout.units_line,
        )

    def whole(self) -> list[Section]:
        """Return all sections, each with a header."""
        if self.now.rows:
            self.done.append(self.now)
        if self.only and not self.done:
            raise UnreadableLogError(
                f"{self.place}: no rows stand below a line that matches '{self.layout.only}'"
            )
        if self.layout.header_line and self.layout.units_line:
            for each in self.done[:1]:  # the units may stand above the names
                each.head.sort(key=lambda line: line[0] != self.layout.header_line)
        self._require_values()
        head: list[Line] = []
        for each in self.done:
            each.head = head = each.head if _has_names(each.head, self.layout) else head
        return self.done

    def _require_values(self) -> None:
        """Raise if a section does not state what others do: the one before is no answer."""
        names = {name for each in self.done for name in each.values}
        for each in self.done:
            if lacking := sorted(names - each.values.keys()):
                line = each.rows[0][0]
                raise UnreadableLogError(
                    f"{self.place}, line {line}: no line above these rows states the {lacking[0]}, as it "
                    "does above others",
                    remedy="mend section or values of [layout], or add the line",
                )


def _is_like(line: str, row: str) -> bool:
    """Whether a line begins with a number and has as many cells as a row: some of them may be empty."""
    for each in SEPARATORS:
        if each in row and line.count(each) == row.count(each):
            first = next((cell for cell in split(line, each) if cell), "")
            return looks_numeric(first) or is_stamp(first)
    return False


def _has_names(head: Sequence[Line], layout: LogLayout) -> bool:
    """Whether lines above rows hold at least two cells of words, which may be names."""
    return any(
        sum(not looks_numeric(cell) for cell in split(line, each) if cell) > 1
        for _, line in head[-3:]
        for each in (layout.separators or (SEPARATORS + BLANKS))
        if each in line
    )


def is_row(line: str, separators: str = "", *, named: bool = False) -> bool:
    """Return whether a line is one of a table: at least two cells, most numbers, the first no word.

    ``named``: whether rows name their channels, so that half of the cells may be words.
    """
    for each in separators or (SEPARATORS + BLANKS):
        if each not in line:
            continue
        cells = [cell for cell in split(line, each) if not is_missing(cell)]
        numbers = sum(looks_numeric(cell) or is_stamp(cell) for cell in cells)
        first = cells[0] if cells else ""
        if named and numbers > 1 and 2 * numbers >= len(cells):
            return True
        if numbers > 1 and 2 * numbers > len(cells) and not first[:1].isalpha():
            return True
        if separators and numbers and not any(cell[:1].isalpha() for cell in cells):
            return True
    return False
