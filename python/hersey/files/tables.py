"""Tables as files, of which a spreadsheet runs no text.

A spreadsheet runs a cell of a CSV that begins with =, +, -, @, a tab or an end of line as a formula, even if
it is the name of a log or a specimen. As OWASP advises (CSV Injection), such a text gets an apostrophe before
it, also where a spreadsheet that separates by semicolons or tabs would begin a new cell. Numbers stay as they
are. `text_of` removes the apostrophes again.
"""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import polars as pl

#: Kinds of file that a table is written to.
TABLES = (".csv", ".parquet")
#: What begins a formula, also behind quotes and blanks; the last four are as wide as a sign of Chinese.
_FORMULA = r"""["'\s]*[=+\-@\t\r\n\uff1d\uff0b\uff0d\uff20]"""
#: Places where a cell may begin.
_BEGINS = r"(^|[;\t\r\n])"
_OPEN = re.compile(f"{_BEGINS}(?={_FORMULA})")
_CLOSED = re.compile(f"{_BEGINS}'(?={_FORMULA})")
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")


def table(frame: pl.DataFrame, suffix: str) -> bytes:
    """Return a table as the content of a file of one of `TABLES`, in a CSV every text by `as_cell`."""
    content = io.BytesIO()
    if suffix == ".parquet":
        frame.write_parquet(content)
    else:
        _safe(frame).write_csv(content)
    return content.getvalue()


def as_cell(text: str) -> str:
    """Return a text as a cell of a CSV that no spreadsheet runs as a formula.

    Examples
    --------
    >>> as_cell("=1+1"), as_cell("F12"), as_cell("-1.5")
    ("'=1+1", 'F12', '-1.5')
    """
    return text if _NUMBER.fullmatch(text) else _OPEN.sub(r"\1'", text)


def text_of(cell: str) -> str:
    """Return the text that `as_cell` made a cell of.

    Examples
    --------
    >>> text_of("'=1+1"), text_of("'quoted'")
    ('=1+1', "'quoted'")
    """
    return _CLOSED.sub(r"\1", cell)


def _safe(frame: pl.DataFrame) -> pl.DataFrame:
    """The same table with every text, and every heading, as a cell."""
    import polars as pl

    columns = []
    for column in frame.iter_columns():
        if column.dtype in (pl.String, pl.Categorical, pl.Enum):
            texts = column.cast(pl.String)
            cells = {text: as_cell(text) for text in texts.unique().drop_nulls()}
            changed = {text: cell for text, cell in cells.items() if cell != text}
            columns.append(texts.replace(list(changed), list(changed.values())) if changed else texts)
        else:
            columns.append(column)
    return pl.DataFrame(columns).rename(as_cell)
