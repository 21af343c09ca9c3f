"""What every result can do: describe its fields, say itself in words, as JSON and as a table, be drawn."""

from __future__ import annotations

import html
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from hersey.errors import MissingFileError
from hersey.schema.record import (
    OPEN,
    Means,
    Record,
    declared,
    json_record,
    json_value,
    stated,
    stated_names,
)

if TYPE_CHECKING:
    import polars as pl

__all__ = [
    "OPEN",
    "Fact",
    "Means",
    "Record",
    "Result",
    "json_record",
    "json_value",
    "stated_names",
    "table_of",
]

#: Longest one-line form of a result.
LINE = 120
#: A number behind its name and before its unit (empty for a pure number).
Fact = tuple[str, float | None, str]


class Result(Record):
    """A result that answers like all others: in words, as JSON, as a table, as a chart.

    Each result defines `summary`, and `to_frame` if it is more than single numbers; the rest follows. A data
    class of arrays takes ``repr=False``, so that it is shown in one line.
    """

    def summary(self) -> str:
        """Return the result as text, with its units."""
        raise NotImplementedError

    def to_frame(self) -> pl.DataFrame:
        """Return a table whose columns carry their units: here the single numbers, a row each."""
        values = {name: stated(self, name) for name in stated_names(type(self))}
        return table_of(
            (name, value, declared(type(self), name)[1].unit)
            for name, value in values.items()
            if isinstance(value, float | int) and not isinstance(value, bool)
        )

    def to_pandas(self) -> Any:
        """Return the table of `to_frame` as a pandas frame.

        Raises
        ------
        MissingFileError
            If pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError:
            raise MissingFileError(
                "to_pandas needs pandas, which is not installed. Run pip install pandas, or use "
                "to_frame() for a polars frame"
            ) from None
        # polars' own conversion needs pyarrow
        return pd.DataFrame({column.name: column.to_numpy() for column in self.to_frame()})

    def chart(self) -> Any:
        """Return the chart of the result."""
        from hersey.charts import chart_of

        return chart_of(self)

    def plot(self) -> Any:
        """Return the chart, as `chart` does: the name that plotting packages have made usual."""
        return self.chart()

    def headline(self) -> str:
        """Return the result in a few words, without its class: the first line of the summary."""
        return self.summary().split("\n", 1)[0]

    def __repr__(self) -> str:
        """Return class and headline on one line."""
        line = f"{type(self).__name__}: {' '.join(self.headline().split())}"
        return f"<{line if len(line) <= LINE else line[: LINE - 1] + '…'}>"

    def _repr_html_(self) -> str:
        """Return summary and chart, if it has one, for a notebook; nothing is loaded from elsewhere."""
        from hersey.charts import has_chart
        from hersey.charts.render import picture

        text = f"<pre>{html.escape(self.summary())}</pre>"
        if type(self).chart is Result.chart and not has_chart(type(self)):
            return text
        try:
            return text + picture(self.chart(), ".svg").decode()
        except MissingFileError as error:  # of the package that draws
            return f"{text}<p>{html.escape(str(error))}</p>"


def table_of(facts: Iterable[Fact]) -> pl.DataFrame:
    """Return numbers as a table of ``name``, ``value`` and ``unit``, without those that are None."""
    import polars as pl

    rows = [(name, float(value), unit) for name, value, unit in facts if value is not None]
    return pl.DataFrame(
        rows, schema={"name": pl.String, "value": pl.Float64, "unit": pl.String}, orient="row"
    )
