"""What every result can do: say itself in words, as JSON, as a table, and find its chart."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import polars as pl

#: Longest one-line form of a result.
LINE = 120
#: A number behind its name and before its unit (empty for a pure number).
Fact = tuple[str, float | None, str]


class Result:
    """A result that answers like all others: in words, as JSON, as a table, as a chart.

    Each result defines `summary`, `to_dict` and `to_frame`; the rest follows. A data class of arrays takes
    ``repr=False``, so that it is shown in one line.
    """

    def summary(self) -> str:
        """Return the result as text, with its units."""
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """Return the result as JSON can hold it, in SI; None for what is infinite or missing."""
        raise NotImplementedError

    def to_frame(self) -> pl.DataFrame:
        """Return the result as a table whose columns carry their units."""
        raise NotImplementedError

    def chart(self) -> Any:
        """Return the chart of the result."""
        from hersey.charts import chart_of

        return chart_of(self)

    def headline(self) -> str:
        """Return the result in a few words, without its class: the first line of the summary."""
        return self.summary().split("\n", 1)[0]

    def __repr__(self) -> str:
        """Return class and headline on one line."""
        line = f"{type(self).__name__}: {' '.join(self.headline().split())}"
        return f"<{line if len(line) <= LINE else line[: LINE - 1] + '…'}>"

    def _repr_html_(self) -> str:
        """Return summary and chart for a notebook; nothing is loaded from elsewhere."""
        from hersey.charts.render import picture

        drawing = picture(self.chart(), ".svg").decode()
        return f"<pre>{html.escape(self.summary())}</pre>{drawing}"


def json_value(value: Any) -> Any:
    """Return the value with arrays as lists, and None for every number that is infinite or missing.

    A record (data class) becomes a dictionary of its fields.
    """
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: json_value(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): json_value(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [json_value(item) for item in value]
    if isinstance(value, np.ndarray | np.generic):
        return json_value(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def json_record(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return named values as JSON can hold them."""
    return {name: json_value(value) for name, value in values.items()}


def table_of(facts: Iterable[Fact]) -> pl.DataFrame:
    """Return numbers as a table of ``name``, ``value`` and ``unit``, without those that are None."""
    import polars as pl

    rows = [(name, float(value), unit) for name, value, unit in facts if value is not None]
    return pl.DataFrame(
        rows, schema={"name": pl.String, "value": pl.Float64, "unit": pl.String}, orient="row"
    )
