"""The table ``[layout]`` of a mapping: how an export is to be read that does not show it by itself."""

from __future__ import annotations

import codecs
import re
from dataclasses import fields
from typing import Annotated

from pydantic import AfterValidator, ValidationInfo
from pydantic.dataclasses import dataclass

from hersey.errors import ParameterError, UnitError
from hersey.files.toml import Table, Text, quoted
from hersey.log.layouts.pattern import pattern
from hersey.log.roles import role_conversion
from hersey.log.text.separators import BLANKS

#: What may stand between cells, as it is called, and encodings of plain text.
DELIMITERS = {"tab": "\t", "semicolon": ";", "comma": ",", "bar": "|", "blanks": BLANKS}
_DECIMALS = {"point": False, "comma": True}
_PLAIN_TEXT = re.compile(
    r"(?i)(utf|cp|windows|iso|latin|ascii|shift|s-?jis|euc|gb|big5|koi8|mac)[a-z0-9_-]{0,20}$"
)
_MOST_PATTERNS, _MOST_LINE = 20, 1_000_000


def _pattern(text: str) -> str:
    pattern(text)
    return text


def _conditions(text: str) -> str:
    if not pattern(text).names:
        raise ParameterError('has no number of a condition in it. Write e.g. "{channel} {speed} rpm"')
    return text


def _patterns(texts: tuple[str, ...]) -> tuple[str, ...]:
    if len(texts) > _MOST_PATTERNS:
        raise ParameterError(f"has {len(texts)} patterns; at most {_MOST_PATTERNS} are allowed")
    return texts


def _encoding(text: str) -> str:
    if not text:
        return text
    try:
        known = codecs.lookup(text).name if _PLAIN_TEXT.match(text) else ""
    except LookupError:
        known = ""
    if not known:
        raise ParameterError(f'is \'{text[:40]}\', an unknown encoding. Write e.g. "cp932" or "utf-16"')
    return text


def _one_of(known: dict[str, object]) -> AfterValidator:
    def checked(text: str) -> str:
        if text and text not in known:
            raise ParameterError(f"is '{text[:40]}'. Write one of {', '.join(map(quoted, known))}")
        return text

    return AfterValidator(checked)


def _line(number: int, info: ValidationInfo) -> int:
    if not (1 if info.context else 0) <= number <= _MOST_LINE:
        raise ParameterError(f"is {number}: lines are counted from 1")
    return number


def _clock(unit: str) -> str:
    if unit:
        try:
            role_conversion("time", unit)
        except UnitError as error:
            raise ParameterError(f"is '{unit[:40]}': {error}") from None
    return unit


Pattern = Annotated[Text, AfterValidator(_pattern)]
LineNumber = Annotated[int, AfterValidator(_line)]


@dataclass(frozen=True)
class LogLayout(Table):
    """How an export is laid out; whatever is not stated is found as in any file."""

    #: Layout of a known instrument, replaced by what else is stated.
    preset: Text = ""
    #: Encoding of the text, e.g. "cp932".
    encoding: Annotated[Text, AfterValidator(_encoding)] = ""
    #: What stands between cells: "tab", "semicolon", "comma", "bar" or "blanks".
    delimiter: Annotated[Text, _one_of(dict(DELIMITERS))] = ""
    #: Decimal mark: "point" or "comma".
    decimal: Annotated[Text, _one_of(dict(_DECIMALS))] = ""
    #: Sign with which lines begin that are left out.
    comment: Text = ""
    #: Line of the names of the columns, counted from 1.
    header_line: LineNumber = 0
    #: Line of their units, where it is not the one below.
    units_line: LineNumber = 0
    #: Line of the first row, where other lines stand between.
    first_row: LineNumber = 0
    #: Line above each of several tables: the names of the columns, or how they begin.
    header: Pattern | None = None
    #: Line with which a section begins; its numbers hold for the whole section.
    section: Pattern | None = None
    #: Lines above a table whose numbers hold for its rows.
    values: Annotated[tuple[Pattern, ...], AfterValidator(_patterns)] = ()
    #: Lines that are left out.
    skip: Annotated[tuple[Pattern, ...], AfterValidator(_patterns)] = ()
    #: Sheets of a workbook to be read, each a run; numbers in their names hold for their rows.
    sheets: Pattern | None = None
    #: Names of columns of which each condition has its own.
    wide: Annotated[Text, AfterValidator(_conditions)] | None = None
    #: Line above the names that holds the conditions instead.
    condition_line: LineNumber = 0
    #: Whether runs stand side by side under the same names.
    side_by_side: bool = False
    #: Whether a channel is a row, not a column.
    transposed: bool = False
    #: Unit of the clocks, if each channel has its own in the column to its left.
    paired_clocks: Annotated[Text, AfterValidator(_clock)] = ""
    #: Column of milliseconds that belong to the time stamps beside it.
    milliseconds: Text = ""
    #: Column that names the channel of each row, in a table with one value a row.
    channel_column: Text = ""
    #: Column of these values.
    value_column: Text = ""

    @property
    def separators(self) -> str:
        """What stands between cells, or nothing if that is to be found."""
        return DELIMITERS.get(self.delimiter, "")

    @property
    def decimal_comma(self) -> bool | None:
        """Whether the decimal mark is a comma, or None if that is to be found."""
        return _DECIMALS.get(self.decimal)

    def toml(self) -> str:
        """Return the table as it stands in a file, without what is as usual."""
        return "\n".join(["[layout]", *self.keys()])

    def keys(self) -> list[str]:
        """Return the lines of the table, without what is as usual."""
        values = {each: getattr(self, each.name) for each in fields(self)}
        return [f"{of.name} = {_written(value)}" for of, value in values.items() if value != of.default]


def _written(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return f"[{', '.join(quoted(each) for each in value)}]"
    return str(value) if isinstance(value, int) else quoted(str(value))
