"""What every result can do: describe its fields, say itself in words, as JSON and as a table, be drawn."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import polars as pl

#: Longest one-line form of a result.
LINE = 120
#: A number behind its name and before its unit (empty for a pure number).
Fact = tuple[str, float | None, str]


class Means(NamedTuple):
    """What the schema says of a field, as ``upper: Annotated[float, Means("the fold", "m/s", open=True)]``.

    ``shape`` is that of an array, ``(n,)`` where none is given; ``open`` numbers may be infinite or missing,
    which JSON says as null.
    """

    text: str = ""
    unit: str = ""
    shape: str = ""
    open: bool = False

    @property
    def description(self) -> str:
        """Meaning, unit and shape on one line."""
        shape = f"shape {self.shape}" if self.shape else ""
        return ", ".join(part for part in (self.text, self.unit, shape) if part)


#: A number that may be infinite or missing.
OPEN = Means(open=True)


class Record:
    """A frozen data class that describes itself: JSON, schema and documentation follow from its fields.

    ``also_stated`` names properties and methods (without arguments) that JSON holds too, ``not_stated``
    fields that it does not.
    """

    if TYPE_CHECKING:  # else they would be among the types of the fields
        also_stated: ClassVar[tuple[str, ...]]
        not_stated: ClassVar[tuple[str, ...]]
    else:
        also_stated = not_stated = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the result as JSON can hold it, in SI; None for what is infinite or missing."""
        return json_record({name: _stated(self, name) for name in stated_names(type(self))})

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        """Return how a part of the document holds the record: as it is, and in JSON by its own fields."""
        from hersey.schema.record import held

        return held(cls, handler)


def stated_names(record: type) -> list[str]:
    """Return the names of what JSON holds of a record, in order."""
    if not is_dataclass(record):
        return list(getattr(record, "_fields", ()))
    left_out = getattr(record, "not_stated", ())
    own = [field.name for field in fields(record) if field.name not in left_out]
    return own + list(getattr(record, "also_stated", ()))


def _stated(record: Any, name: str) -> Any:
    value = getattr(record, name)
    return value() if callable(value) else value


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
        from hersey.schema.record import declared

        stated = {name: _stated(self, name) for name in stated_names(type(self))}
        return table_of(
            (name, value, declared(type(self), name)[1].unit)
            for name, value in stated.items()
            if isinstance(value, float | int) and not isinstance(value, bool)
        )

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

    A record (data class or named tuple) becomes a dictionary of its fields, an error its words.
    """
    if isinstance(value, Record):
        return value.to_dict()
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: json_value(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): json_value(item) for key, item in value.items()}
    if hasattr(value, "_asdict"):
        return json_value(value._asdict())
    if isinstance(value, list | tuple):
        return [json_value(item) for item in value]
    if isinstance(value, np.ndarray | np.generic):
        return json_value(value.tolist())
    if isinstance(value, BaseException):
        return str(value)
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
