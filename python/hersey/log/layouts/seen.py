"""What the first lines of a file show of its layout: rows, and numbers with units beside them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from hersey.errors import UnitError
from hersey.log.layouts.pattern import pattern
from hersey.log.layouts.sections import is_row
from hersey.log.roles import role_conversion
from hersey.log.text.numbers import looks_numeric
from hersey.log.text.separators import BLANKS, SEPARATORS, number_rows, split

#: Lines that are looked at, and characters of a line that may state something.
LOOKED_AT, _LONGEST = 20_000, 200
#: Rows in a block at the least; lines above one that may be names or units.
_LEAST, _ABOVE = 3, 12
_NUMBER = r"[-+]?[0-9]{1,15}(?:[.,][0-9]{1,15})?"
#: A number with a unit behind it, and one with its unit before it.
_BEHIND = re.compile(
    rf"(?<![A-Za-z0-9.,])({_NUMBER})([\s;]?)([A-Za-z°µ][A-Za-z°/⁻¹*·^-]{{0,11}}|(?<=\s)1/[a-z]{{1,4}})(?!\w)"
)
_BEFORE = re.compile(rf"[(\[]([^()\[\]]{{1,12}})[)\]]\s*[:=;,]?\s*({_NUMBER})(?![\w.])")
#: Words beside a number that is not what the rows were measured at.
_NO_SET_POINT = re.compile(
    r"(?i)(?<!/)\b(max|min(?!-1|\(-1|⁻|\^)|mean|avg|average|limit|alarm|ambient|room|raum|umgebung|grenz|mittel|start|end|initial"
    r"|final|ramp|accel|fan|range|scale|rated|nenn)"
)
#: A number behind a unit that is called instead of the quantity.
_CALLED = re.compile(rf"(?i)(?<![\w/])(rpm|1/min|U/min|rad/s)\s?[:=]\s?({_NUMBER})(?![\w.])")
#: Roles that a line above a table may state; force and length are no load and no radius but by their word.
_STATED = ("speed", "temperature", "load", "radius")
_WORDS = {
    "load": re.compile(
        r"(?i)\b(load|last|normal ?force|normalkraft|axial ?force|weight)\b(?! ?cell)[^0-9]{0,20}$"
    ),
    "radius": re.compile(r"(?i)\b(radius|track)\b[^0-9A-Za-z]{0,20}$"),
}


@dataclass(frozen=True)
class Block:
    """Rows that follow each other: the first and the last, counted from 0, and the lines above them."""

    first: int
    last: int
    above: tuple[int, ...]


@dataclass(frozen=True)
class Seen:
    """The first lines of a text or a sheet."""

    lines: tuple[str, ...]
    workbook: bool = False

    @cached_property
    def blocks(self) -> tuple[Block, ...]:
        """Rows of numbers, in blocks of at least three."""
        found: list[Block] = []
        end = 0
        rows = [is_row(line, "\t" if self.workbook else "") for line in self.lines]
        at = 0
        while at < len(rows):
            if not rows[at]:
                at += 1
                continue
            last = at
            while last + 1 < len(rows) and (rows[last + 1] or not self.lines[last + 1].strip()):
                last += 1
            if sum(rows[at : last + 1]) >= _LEAST:
                above = tuple(i for i in range(end, at) if self.lines[i].strip())
                found.append(Block(at, last, above))
                end = last + 1
            at = last + 1
        return tuple(found)

    @cached_property
    def separator(self) -> str:
        """What stands between cells."""
        if self.workbook:
            return "\t"
        numbered = list(enumerate(self.lines[:2000]))
        best = max((number_rows(numbered, each) for each in SEPARATORS), key=lambda table: table.score)
        return best.separator if best.score else BLANKS

    def cells(self, at: int) -> list[str]:
        """Return the cells of a line."""
        return split(self.lines[at], self.separator)

    def words_above(self) -> Iterator[int]:
        """Yield the lines just above the first rows that hold at least two cells of words."""
        for block in self.blocks[:1]:
            for at in block.above[-_ABOVE:]:
                cells = [cell for cell in self.cells(at) if cell]
                if len(cells) > 1 and sum(not looks_numeric(cell) for cell in cells) > 1:
                    yield at


def stated_in(text: str) -> str:
    """Return a pattern of a text that states a speed or a temperature; nothing of any other text.

    Its other numbers may be any.
    """
    plain = " ".join(text.split())
    if not plain or len(plain) > _LONGEST or set(plain) & set("{}*") or _NO_SET_POINT.search(plain):
        return ""
    placeholders: dict[tuple[int, int], str] = {}
    roles = set[str]()
    for match in _BEHIND.finditer(plain):
        if role := _role_of(match[3], plain[: match.start()]):
            if role in roles:  # from one speed to another: no set point
                return ""
            roles.add(role)
            alone = plain[match.end() : match.end() + 1] in ("", " ")
            unit = "" if alone else f":{match[3]}"
            placeholders[match.span()] = f"{{{role}{unit}}}{match[2]}{match[3]}"
    for match in (*_BEFORE.finditer(plain), *_CALLED.finditer(plain)):
        if (role := _role_of(match[1], plain[: match.start()])) and role not in roles:
            roles.add(role)
            placeholders[match.span(2)] = f"{{{role}:{match[1].strip()}}}"
    if not placeholders:
        return ""
    template, last = "", 0
    for span in sorted(placeholders):
        template += _without_numbers(plain[last : span[0]]) + placeholders[span]
        last = span[1]
    template += _without_numbers(plain[last:])
    return template if pattern(template).match(plain) else ""


def _without_numbers(text: str) -> str:
    return re.sub(rf"(?<!\w){_NUMBER}", "*", text)


def _role_of(unit: str, before: str) -> str:
    """The role of which a unit is, among those that lines state; ``before`` stands before the number."""
    for role in _STATED:
        if role in _WORDS and not _WORDS[role].search(before):
            continue
        try:
            role_conversion(role, unit.strip())
        except UnitError:
            continue
        if unit.strip() not in ("K", "C", "F", "1", "-"):  # letters of anything
            return role
    return ""


def stated_by_all(seen: Sequence[Seen]) -> tuple[str, ...]:
    """Return the patterns that a line above every block matches and whose numbers vary, one for each role.

    Where two of a role vary, and differ, neither is returned: which is the set point is not known.
    """
    blocks = [[each.lines[at] for at in block.above[-2 * _ABOVE :]] for each in seen for block in each.blocks]
    templates = {template for lines in blocks for line in lines if (template := stated_in(line))}
    found: dict[tuple[str, ...], dict[tuple[float, ...], str]] = {}
    for template in sorted(templates):
        numbers = [_last_stated(template, lines) for lines in blocks]
        if None not in numbers and len(set(numbers)) > 1:
            series = tuple(number for each in numbers for number in each or ())
            found.setdefault(pattern(template).names, {}).setdefault(series, template)
    return tuple(next(iter(each.values())) for each in found.values() if len(each) == 1)


def _last_stated(template: str, lines: Sequence[str]) -> tuple[float, ...] | None:
    """The numbers of the last line that a pattern matches."""
    matches = [match for line in lines if (match := pattern(template).match(line))]
    return tuple(value.number for value in matches[-1].values.values()) if matches else None
