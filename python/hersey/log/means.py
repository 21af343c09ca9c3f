"""A table of means: one row per dwell, as test reports and papers print it, without a clock.

Columns of speed and torque are needed; temperature, load, the standard error of the torque or its deviation
with a count, a run and the approach may stand beside them. A row with a cell that is no number
costs that row alone.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.errors import (
    HerseyError,
    InsufficientDataError,
    ParameterError,
    UnreadableLogError,
)
from hersey.log.channels import ChannelChoice, Stated, called, find_channel, no_channel, role_conversion
from hersey.log.formats import format_of, opened
from hersey.log.formats.frame import is_frame
from hersey.log.friction import beside, in_rotation, notes_on, unused
from hersey.log.recording import Cells, Signal, split_unit
from hersey.log.sensors import Sensors
from hersey.log.text.column import Column
from hersey.log.text.delimited import open_delimited
from hersey.log.text.repeated_header import refuse_another_header
from hersey.log.text.separators import split
from hersey.log.torque_log import LARGEST, Channel, LogFile
from hersey.result import Result, json_record
from hersey.units import Conversion, takes_si

#: Rows and bytes of a file that is taken for a table of means without being called one, at the most.
FEW_ROWS, FEW_BYTES = 300, 200_000
#: Share of neighbouring rows at one speed from which on rows are samples and no means.
SAMPLED = 0.7
#: Rows left out that a note names at the most.
_SHOWN = 5
_ERROR = re.compile(r"error|uncert|\bsem\b|\bse\b|±", re.IGNORECASE)
_DEVIATION = re.compile(r"\bsd\b|\bstd|st\.? ?dev|deviation|scatter", re.IGNORECASE)
_PLAIN = {
    "load": re.compile(r".*\bload\b.*|normal force|n force|f_?n|weight", re.IGNORECASE),
    "count": re.compile(r"counts?|samples|rows|repeats?|n samples|number.*", re.IGNORECASE),
    "run": re.compile(r"run|series|specimen|sample|unit|test", re.IGNORECASE),
    "approach": re.compile(r"approach|direction|branch|way", re.IGNORECASE),
}
#: Approaches as people write them.
_BELOW, _ABOVE = (
    {"from below", "below", "up", "rising", "increasing"},
    {
        "from above",
        "above",
        "down",
        "falling",
        "decreasing",
    },
)


@dataclass(frozen=True)
class MeanRow:
    """A dwell as its table states it: rad/s, N m, K, N; None where the table says nothing."""

    run: int
    speed: float
    torque: float
    torque_error: float
    temperature: float | None
    load: float | None
    count: float
    approach: str


@dataclass(frozen=True, repr=False)
class MeansTable(Result):
    """Means of dwells, and the files they came from; there is no trace behind them.

    Attributes
    ----------
    means
        One `MeanRow` per row that could be read.
    files
        Each with the rows left out in its notes.
    stated_errors
        Whether the table states errors of torque.
    """

    means: tuple[MeanRow, ...]
    files: tuple[LogFile, ...]
    stated_errors: bool
    corrections: tuple[Any, ...] = ()  #: none: what is corrected is corrected in the table
    runs: tuple[Any, ...] = ()  #: none: no trace was recorded
    sensors: Sensors = field(default_factory=Sensors)

    @property
    def rows(self) -> int:
        """Rows that could be read."""
        return len(self.means)

    @property
    def title(self) -> str:
        """Name of the first file, and how many more there are."""
        first = self.files[0].name
        return first if len(self.files) == 1 else f"{first} and {len(self.files) - 1} more"

    @property
    def has_temperature(self) -> bool:
        """Whether every row has a temperature."""
        return all(row.temperature is not None for row in self.means)

    def summary(self) -> str:
        """Return how many rows of which files, and what was left out."""
        lines = [f"{file.name}: table of means, {file.rows} rows" for file in self.files]
        return "\n".join([*lines, *(f"{file.name}: {n}" for file in self.files for n in file.notes)])

    def to_dict(self) -> dict[str, Any]:
        """Return files and rows, in SI."""
        rows = [asdict(row) for row in self.means]
        return json_record({"files": [asdict(file) for file in self.files], "means": rows})

    def to_frame(self) -> pl.DataFrame:
        """Return one row per dwell, in SI."""
        return pl.DataFrame([asdict(row) for row in self.means])


@dataclass(frozen=True)
class _Cells:
    """A table as it stands: cells of text or numbers by column."""

    name: str
    sha256: str
    size: int
    columns: tuple[Column, ...]
    cells: tuple[Sequence[object], ...]
    number: Any  #: from a cell of text to a number
    comments: tuple[str, ...] = ()

    def numbers(self, column: Column) -> FloatArray:
        """Return a column as written, NaN where a cell is no number."""
        cells = self.cells[self.columns.index(column)]
        values = np.array([self._number(cell) for cell in cells], dtype=np.float64)
        for row in np.flatnonzero(np.isnan(values)):
            cell = cells[int(row)]
            if isinstance(cell, str):
                refuse_another_header(f"{self.name}, row {row + 1}", column, cell, self.columns)
        return values

    def texts(self, column: Column) -> list[str]:
        """Return a column as text."""
        return ["" if cell is None else str(cell).strip() for cell in self.cells[self.columns.index(column)]]

    def _number(self, cell: object) -> float:
        if isinstance(cell, str):
            with suppress(ValueError, HerseyError):
                return float(self.number(cell.strip()))
            return float("nan")
        return float("nan") if cell is None else float(cell)  # type: ignore[arg-type]


@takes_si(radius="length", load="force")
def read_means(
    tables: Any,
    *,
    channels: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    isothermal: bool = False,
    radius: float | Sequence[float] | None = None,
    load: float | Sequence[float] | None = None,
    signs: Mapping[str, int] | None = None,
) -> MeansTable:
    """Read a table of means, or several.

    Parameters
    ----------
    tables
        File or files, a polars or pandas frame, or columns by name.
    channels, units
        Column and unit by role (``torque``, ``speed``, ``temperature``; ``load``, ``radius``), where the
        header does not say. Torque may be a friction force or a coefficient, speed one of sliding.
    isothermal
        Leave temperature out.
    radius, load
        At which a friction force acts and a sliding speed is measured, m, and normal load, N, where no column
        holds them; one for all tables, or one for each.
    signs
        -1 by role, ``torque`` or ``speed``, turns the sign.

    Raises
    ------
    HerseyError
        If a file cannot be read, lacks speed or torque, or has a unit that is none.
    """
    listed = [tables] if _is_one(tables) else list(tables)
    means: list[MeanRow] = []
    files: list[LogFile] = []
    stated = []
    choices = _choices(dict(channels or {}), dict(units or {}))
    radii, loads = (_for_each(name, of, len(listed)) for name, of in (("radius", radius), ("load", load)))
    for number, table in enumerate(listed):
        cells = _cells(table, f"table {number + 1}" if len(listed) > 1 else "table")
        said = Stated(None, radii[number], loads[number])
        rows, file, errors = _read(cells, choices, said, isothermal, means)
        means += rows
        files.append(file)
        stated.append(errors)
    return MeansTable(tuple(_turned(row, signs or {}) for row in means), tuple(files), all(stated))


def _turned(row: MeanRow, signs: Mapping[str, int]) -> MeanRow:
    torque, speed = (signs.get(role, 1) for role in ("torque", "speed"))
    return replace(row, torque=torque * row.torque, speed=speed * row.speed)


def _choices(channels: dict[str, str], units: dict[str, str]) -> dict[str, ChannelChoice]:
    return {
        role: ChannelChoice(channels.get(role, ""), units.get(role, ""))
        for role in ("torque", "speed", "temperature", "load", "radius")
    }


def _for_each(name: str, given: float | Sequence[float] | None, tables: int) -> list[float | None]:
    """What is said of a load or a radius, for each table."""
    if given is None:
        return [None] * tables
    values = [float(v) for v in np.ravel(given)] * (1 if np.ndim(given) else tables)
    if len(values) != tables:
        raise ParameterError(f"{name} has {len(values)} values for {tables} tables: give one for each")
    for value in values:
        if not 0 < value < LARGEST:
            raise ParameterError(f"{name} is {value:g} in SI: it must be greater than 0")
    return list(values)


def is_means_table(path: Path, channels: Mapping[str, str], units: Mapping[str, str]) -> bool:
    """Return whether a file is one: few rows with speed and torque, no clock, few speeds twice running."""
    try:
        if not path.is_file() or path.stat().st_size > FEW_BYTES:
            return False
        cells = _cells(path, path.name)
        lengths = {len(each) for each in cells.cells}
        if len(lengths) != 1 or not 0 < max(lengths) <= FEW_ROWS or _clock(cells.columns):
            return False
        if (clock := channels.get("time")) and called(clock, cells.columns):
            return False
        columns = _measured(cells.columns)
        choices = {r: ChannelChoice(channels.get(r, ""), units.get(r, "")) for r in ("speed", "torque")}
        found = {role: find_channel(role, columns, choice, cells.name) for role, choice in choices.items()}
    except (HerseyError, OSError):  # whoever reads it as a log says what is wrong
        return False
    speed, torque = found["speed"], found["torque"]
    if speed is None or torque is None:
        return False
    held = cells.numbers(speed[0])
    same = np.abs(np.diff(held)) <= 0.01 * np.abs(held[1:])
    return bool(held.size < 2 or np.mean(same) < SAMPLED)


def _clock(columns: tuple[Column, ...]) -> bool:
    """Whether a column may be a clock."""
    try:
        return find_channel("time", columns, ChannelChoice(), "") is not None
    except HerseyError:
        return True


def _is_one(tables: Any) -> bool:
    return is_frame(tables) or isinstance(tables, str | Path | Mapping)


def _cells(table: Any, name: str) -> _Cells:
    """A table as it stands, from a file or from memory."""
    if isinstance(table, Mapping):
        table = pl.DataFrame(dict(table), strict=False)
    if is_frame(table):
        return _of_frame(table, name)
    path = Path(table)
    if kind := format_of(path):
        with opened(path, kind) as recording:
            held: Sequence[Cells | Signal] = recording.cells or recording.signals
            columns = tuple(Column(i, s.name, s.unit, s.group) for i, s in enumerate(held))
            loaded: tuple[Sequence[object], ...] = tuple(list(each.load()) for each in held)
            source, comments = recording.source, recording.comments
        if source is None:
            content = path.read_bytes()
            return _Cells(path.name, _sha(content), len(content), columns, loaded, float, comments)
        return _Cells(path.name, source.sha256, source.bytes, columns, loaded, float, comments)
    with open_delimited(path) as file:
        layout = file.layout
        text, _ = file.text()
    lines = list(_lines(text.decode(layout.encoding, errors="replace"), layout.first_line, layout.comment))
    rows = [split(line, layout.separator) for line in lines]
    named = tuple(column for column in layout.columns if column.name)
    cells = tuple([row[c.index] if c.index < len(row) else "" for row in rows] for c in named)
    return _Cells(path.name, _sha(text), len(text), named, cells, layout.style.value, layout.comments)


def _lines(text: str, first: int, comment: str) -> Iterator[str]:
    for line in text.splitlines()[first - 1 :]:
        if line.strip() and not (comment and line.startswith(comment)):
            yield line


def _sha(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _of_frame(frame: Any, name: str) -> _Cells:
    if isinstance(frame, pl.LazyFrame):
        frame = frame.collect()
    by_name = {str(c): list(frame[c]) for c in frame.columns}
    columns = tuple(Column(i, *split_unit(title)) for i, title in enumerate(by_name))
    content = repr(by_name).encode()
    return _Cells(name, _sha(content), len(content), columns, tuple(by_name.values()), float)


def _measured(columns: tuple[Column, ...]) -> tuple[Column, ...]:
    """Columns that are no error, deviation, count or label of others."""
    return tuple(
        c
        for c in columns
        if not (_ERROR.search(c.name) or _DEVIATION.search(c.name))
        and not any(_plays(c, name, columns) for name in _PLAIN)
    )


def _plays(column: Column, name: str, columns: tuple[Column, ...]) -> bool:
    """Whether a column plays a role without a conversion; n is a count beside a speed, or the speed."""
    if name == "count" and column.name.lower() == "n" and not column.unit:
        return any(c != column and re.search("speed|rpm|drehzahl", str(c), re.IGNORECASE) for c in columns)
    if name == "load" and re.search("torque|moment", column.name, re.IGNORECASE):  # a load torque is a torque
        return False
    return bool(_PLAIN[name].fullmatch(column.name))


def _read(
    cells: _Cells,
    choices: dict[str, ChannelChoice],
    said: Stated,
    isothermal: bool,
    before: list[MeanRow],
) -> tuple[list[MeanRow], LogFile, bool]:
    cells = _as_long_as_torque(cells, choices)
    roles = _roles(cells, choices, isothermal)
    others = beside(cells.columns, choices, said, roles, cells.name)
    values = {role: _si(cells, *role_of) for role, role_of in (roles | others).items()}
    lever = in_rotation(values | {"torque": np.ones_like(values["torque"])}, roles, said)["torque"]
    error = _errors(cells, roles["torque"])
    error = None if error is None else error * lever
    values = in_rotation(values, roles, said)
    count = _plain(cells, "count")
    counts = np.ones_like(values["torque"]) if count is None else np.maximum(cells.numbers(count), 1.0)
    run, approach = (_plain(cells, name) for name in ("run", "approach"))
    runs = _indices(cells.texts(run)) if run is not None else np.zeros(counts.size, dtype=np.intp)
    runs = runs + (max(row.run for row in before) + 1 if before else 0)
    ways = [_way(text) for text in cells.texts(approach)] if approach is not None else ["start"] * counts.size
    loads = values.get("load")
    temperature = values.get("temperature")
    needed = {role: values[role] for role in roles} | ({} if error is None else {"torque error": error})
    rows, left_out = [], []
    for i in range(counts.size):
        bad = [name for name, column in needed.items() if not np.isfinite(column[i])]
        if bad:
            left_out.append(_bad(cells, i, bad, roles))
            continue
        rows.append(
            MeanRow(
                int(runs[i]),
                float(values["speed"][i]),
                float(values["torque"][i]),
                0.0 if error is None else abs(float(error[i])),
                None if temperature is None else float(temperature[i]),
                None if loads is None or not np.isfinite(loads[i]) else float(loads[i]),
                float(counts[i]) if np.isfinite(counts[i]) else 1.0,
                ways[i],
            )
        )
    if not rows:
        raise InsufficientDataError(f"{cells.name}: no row holds both a speed and a torque")
    used = tuple(Channel(role, c[0].name, c[1].unit) for role, c in (roles | others).items())
    notes = (*notes_on(roles | others, said), *unused(cells.columns, roles | others, said), *_named(left_out))
    file = LogFile(
        cells.name, cells.sha256, cells.size, len(rows), len(left_out), used, cells.comments, False, notes
    )
    return rows, file, error is not None


def _as_long_as_torque(cells: _Cells, choices: dict[str, ChannelChoice]) -> _Cells:
    """The columns that have as many rows as the torque; one that is named must have."""
    size = {column: len(each) for column, each in zip(cells.columns, cells.cells, strict=True)}
    if len(set(size.values())) < 2:
        return cells
    among = cells.columns if choices["torque"].name else _measured(cells.columns)
    torque = find_channel("torque", among, choices["torque"], cells.name)
    if torque is None:
        raise no_channel("torque", among, cells.name)
    rows = size[torque[0]]
    for role, choice in choices.items():
        named = called(choice.name, cells.columns) if choice.name else []
        if named and all(size[column] != rows for column in named):
            raise UnreadableLogError(
                f"{cells.name}: column '{named[0]}' ({role}) has {size[named[0]]} rows and column "
                f"'{torque[0]}' (torque) {rows}: name columns of one table"
            )
    kept = [i for i, column in enumerate(cells.columns) if size[column] == rows]
    return replace(
        cells,
        columns=tuple(cells.columns[i] for i in kept),
        cells=tuple(cells.cells[i] for i in kept),
    )


Role = tuple[Column, Conversion]


def _roles(cells: _Cells, choices: dict[str, ChannelChoice], isothermal: bool) -> dict[str, Role]:
    """Columns of torque, speed and, if there is one, temperature, with their conversions."""
    measured = _measured(cells.columns)
    roles = {}
    for role in ("torque", "speed", "temperature"):
        if role == "temperature" and isothermal:
            continue
        columns = cells.columns if choices[role].name else measured
        channel = find_channel(role, columns, choices[role], cells.name)
        if channel is not None:
            roles[role] = channel
        elif role != "temperature":
            raise no_channel(role, measured, cells.name)
    return roles


def _si(cells: _Cells, column: Column, unit: Conversion) -> FloatArray:
    return np.asarray(unit.scale * cells.numbers(column) + unit.offset)


def _errors(cells: _Cells, torque: Role) -> FloatArray | None:
    """Standard errors of what the column of torque holds, in SI, from errors, or deviations and counts."""
    about_torque = [c for c in cells.columns if c != torque[0] and _is_of_torque(c)]
    count = _plain(cells, "count")
    for column in about_torque:
        if _ERROR.search(column.name):
            return _scaled(cells, column, torque)
    for column in about_torque:
        if _DEVIATION.search(column.name) and count is not None:
            return _scaled(cells, column, torque) / np.sqrt(np.maximum(cells.numbers(count), 1.0))
    return None


def _is_of_torque(column: Column) -> bool:
    """Whether a column of errors is one of the torque: by its name, or because it names nothing else."""
    name = column.name.lower()
    if any(word in name for word in ("speed", "rpm", "temp", "load")):
        return False
    return bool(_ERROR.search(name) or _DEVIATION.search(name))


def _scaled(cells: _Cells, column: Column, torque: Role) -> FloatArray:
    if column.unit == "%":
        return np.asarray(cells.numbers(column) / 100.0 * np.abs(_si(cells, *torque)))
    scale = role_conversion("torque", column.unit)[1].scale if column.unit else torque[1].scale
    return np.asarray(scale * cells.numbers(column))


def _plain(cells: _Cells, name: str) -> Column | None:
    """The column of a role without a conversion, or None."""
    return next((c for c in cells.columns if _plays(c, name, cells.columns)), None)


def _indices(texts: list[str]) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Index of each text, in the order in which they first appear."""
    order = {text: i for i, text in enumerate(dict.fromkeys(texts))}
    return np.array([order[text] for text in texts], dtype=np.intp)


def _way(text: str) -> str:
    if text.lower() in _BELOW:
        return "from below"
    return "from above" if text.lower() in _ABOVE else "start"


def _bad(cells: _Cells, row: int, roles: list[str], columns: dict[str, Role]) -> str:
    """Which row is left out, and for which cell."""
    role = roles[0]
    where = f"row {row + 1}"
    if role in columns:
        text = cells.texts(columns[role][0])[row]
        return f"{where} ({role} {text!r})" if text else f"{where} (no {role})"
    return f"{where} (no {role})"


def _named(left_out: list[str]) -> list[str]:
    if not left_out:
        return []
    more = f" and {len(left_out) - _SHOWN} more" if len(left_out) > _SHOWN else ""
    return [f"left out for a cell that is no number: {', '.join(left_out[:_SHOWN])}{more}"]


def refuse_corrections(stated: bool, name: str) -> None:
    """Refuse corrections of a mapping: they are made on a trace."""
    if stated:
        raise ParameterError(
            f"{name} states corrections (signs, tare, gears, lag): they are made on a trace, and a table of "
            "means has none; correct the table, and name its columns of torque, speed and temperature"
        )
