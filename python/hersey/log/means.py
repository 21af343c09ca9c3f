"""A table of means: one row per dwell, as test reports and papers print it, without a clock.

Columns of speed and torque are needed; temperature, load, the standard error of the torque or its deviation
with a count, the error of torque that all rows share, a run and the approach may stand beside them. A row
with a cell that is no number costs that row alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from hersey.arguments.door import Keys
from hersey.arguments.numbers import described
from hersey.arrays import FloatArray
from hersey.errors import HerseyError, InsufficientDataError, ParameterError
from hersey.log.cell_table import CellTable, cells_of
from hersey.log.channels import ChannelChoice, Stated, called, find_channel
from hersey.log.friction import beside, computed, domain_of, in_domain, unused
from hersey.log.mean_roles import (
    Role,
    as_long_as_torque,
    in_si,
    mean_roles,
    measured,
    plain_column,
    shared_errors,
    torque_errors,
)
from hersey.log.not_a_log import is_one, refuse_not_a_log
from hersey.log.pooling import refuse_mixed
from hersey.log.replaced import replaced_units
from hersey.log.roles import CHANNELS, SIGNS, UNITS
from hersey.log.rolling import of_rolling
from hersey.log.sensors import Sensors
from hersey.log.text.column import Column
from hersey.log.torque_log import LARGEST, Channel, LogFile, TorqueLog, title_of
from hersey.result import Result, json_record
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Rows and bytes of a file that is taken for a table of means without being called one, at the most.
FEW_ROWS, FEW_BYTES = 300, 200_000
#: Share of neighbouring rows at one speed from which on rows are samples and no means.
SAMPLED = 0.7
#: Roles of the columns, and the dictionaries by role.
_ROLES = ("torque", "speed", "temperature", "load", "radius")
_CHANNELS, _UNITS = Keys(_ROLES, CHANNELS.example), Keys(_ROLES, UNITS.example, UNITS.suffix)
#: Rows left out that a warning names at the most.
_NAMED = 5
#: Approaches as people write them.
_APPROACHES = {
    **dict.fromkeys(("from below", "below", "up", "rising", "increasing"), "from below"),
    **dict.fromkeys(("from above", "above", "down", "falling", "decreasing"), "from above"),
}


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
    shared_error: float = 0.0  #: standard error of torque that all rows of its table share
    table: int = 0  #: of several, from 0


@dataclass(frozen=True, repr=False)
class MeansTable(Result):
    """Means of dwells, and the files they came from; there is no trace behind them.

    Attributes
    ----------
    means
        One `MeanRow` per row that could be read.
    files
        Each with the rows left out among its warnings.
    stated_errors
        Whether the table states errors of torque.
    """

    means: tuple[MeanRow, ...]
    files: tuple[LogFile, ...]
    stated_errors: bool
    corrections: tuple[Any, ...] = ()  #: none: what is corrected is corrected in the table
    runs: tuple[Any, ...] = ()  #: none: no trace was recorded
    sensors: Sensors = field(default_factory=Sensors)
    domain: Domain = TORQUE  #: what ``torque`` and ``speed`` of the means hold

    @property
    def rows(self) -> int:
        """Rows that could be read."""
        return len(self.means)

    @property
    def title(self) -> str:
        """Name of the first file, and how many more there are."""
        return title_of(self.files)

    @property
    def has_temperature(self) -> bool:
        """Whether every row has a temperature."""
        return all(row.temperature is not None for row in self.means)

    def summary(self) -> str:
        """Return how many rows of which files, and what was left out."""
        lines = [f"{file.name}: table of means, {file.rows} rows" for file in self.files]
        warnings = [str(each.within(file.name)) for file in self.files for each in file.warnings]
        return "\n".join([*lines, *warnings])

    def to_dict(self) -> dict[str, Any]:
        """Return files and rows, in SI."""
        rows = [asdict(row) for row in self.means]
        return json_record({"files": self.files, "means": rows})

    def to_frame(self) -> pl.DataFrame:
        """Return one row per dwell, in SI."""
        return pl.DataFrame([asdict(row) for row in self.means])


@takes_si(radius="length", load="force", channels=_CHANNELS, units=_UNITS, signs=SIGNS)
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
    listed = [tables] if is_one(tables) or not isinstance(tables, Iterable) else list(tables)
    for table in listed:
        _refuse_other(table)
    means: list[MeanRow] = []
    files: list[LogFile] = []
    stated = []
    domains = []
    choices = _choices(dict(channels or {}), dict(units or {}))
    radii, loads = (_for_each(name, of, len(listed)) for name, of in (("radius", radius), ("load", load)))
    whole = Stated(None, _of_all(radii), _of_all(loads))
    for number, table in enumerate(listed):
        cells = cells_of(table, f"table {number + 1}" if len(listed) > 1 else "table")
        said = Stated(None, radii[number], loads[number])
        rows, file, errors, domain = _read(cells, choices, (said, whole), isothermal, means)
        means += [replace(row, table=number) for row in rows]
        files.append(file)
        stated.append(errors)
        domains.append((file.name, domain))
    refuse_mixed(domains)
    means = [_turned(row, signs or {}) for row in means]
    return MeansTable(tuple(means), tuple(files), all(stated), domain=domains[0][1])


def _turned(row: MeanRow, signs: Mapping[str, int]) -> MeanRow:
    torque, speed = (signs.get(role, 1) for role in ("torque", "speed"))
    return replace(row, torque=torque * row.torque, speed=speed * row.speed)


def _choices(channels: dict[str, str], units: dict[str, str]) -> dict[str, ChannelChoice]:
    return {role: ChannelChoice(channels.get(role, ""), units.get(role, "")) for role in _ROLES}


def _for_each(name: str, given: float | Sequence[float] | None, tables: int) -> list[float | None]:
    """What is said of a load or a radius, for each table."""
    if given is None:
        return [None] * tables
    values = [float(v) for v in np.ravel(given)] * (1 if np.ndim(given) else tables)
    if len(values) != tables:
        raise ParameterError(
            f"{name} has {len(values)} values for {tables} tables. Give one value for each table"
        )
    for value in values:
        if not 0 < value < LARGEST:
            raise ParameterError(f"{name} is {value:g} (SI): it must be greater than 0")
    return list(values)


def _of_all(values: list[float | None]) -> tuple[float, ...] | float | None:
    """What is said of all tables: one value, one for each, or nothing."""
    known = tuple(value for value in values if value is not None)
    return (known if len(set(known)) > 1 else known[0]) if known else None


def is_means_table(path: Path, channels: Mapping[str, str], units: Mapping[str, str]) -> bool:
    """Return whether a file is one: few rows with speed and torque, no clock, few speeds twice running."""
    try:
        if not path.is_file() or path.stat().st_size > FEW_BYTES:
            return False
        cells = cells_of(path, path.name)
        lengths = {len(each) for each in cells.cells}
        if len(lengths) != 1 or not 0 < max(lengths) <= FEW_ROWS or _clock(cells.columns):
            return False
        if (clock := channels.get("time")) and called(clock, cells.columns):
            return False
        columns = measured(cells.columns)
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


def _refuse_other(table: Any) -> None:
    """Refuse what is no table of means."""
    if isinstance(table, TorqueLog):
        raise ParameterError(
            "a log is not a table of means", remedy="its dwells are log.steady(tare='standing')"
        )
    if isinstance(table, Sequence | np.ndarray) and not isinstance(table, str | bytes):
        raise ParameterError(
            f"{described(table)} is not a table of means",
            remedy="give columns by name, e.g. {'speed [rpm]': [10, 20], 'torque [mN*m]': [25, 26]}",
        )
    if not isinstance(table, Mapping):
        refuse_not_a_log(table, "hersey.SteadyPoints.from_table")


def _read(
    cells: CellTable,
    choices: dict[str, ChannelChoice],
    stated: tuple[Stated, Stated],
    isothermal: bool,
    before: list[MeanRow],
) -> tuple[list[MeanRow], LogFile, bool, Domain]:
    """The rows of a table, its record, whether it states errors, and its domain.

    ``stated`` is what the user says of this table and of all, ``before`` are rows of other tables.
    """
    said, of_all = stated
    cells = as_long_as_torque(cells, choices)
    roles = mean_roles(cells, choices, isothermal)
    used = roles | beside(cells.columns, choices, said, roles, cells.name)
    held = {role: in_si(cells, *role_of) for role, role_of in used.items()}
    seen = unused(cells.columns, used, said, cells.numbers)
    domain = of_rolling(domain_of(used, of_all), seen)
    lever = in_domain(held | {"torque": np.ones_like(held["torque"])}, used, said, domain)["torque"]
    error = torque_errors(cells, roles["torque"])
    values = in_domain(held, used, said, domain)
    needed = {role: values[role] for role in roles}
    if error is not None:
        needed["torque error"] = values["error"] = error * lever
    if (shared := shared_errors(cells, roles["torque"])) is not None:
        needed["shared torque error"] = values["shared"] = shared * lever
    bad = {name: ~np.isfinite(column) for name, column in needed.items()}
    gone = np.logical_or.reduce(list(bad.values()))
    known = _with_labels(cells, values, max((row.run for row in before), default=-1) + 1)
    rows = [_row({name: each[i] for name, each in known.items()}) for i in np.flatnonzero(~gone)]
    left_out = [
        _bad(cells, int(i), next(name for name in bad if bad[name][i]), roles) for i in np.flatnonzero(gone)
    ]
    if not rows:
        named = f"{', '.join(list(bad)[:-1])} and {list(bad)[-1]}"
        first = f", e.g. {left_out[0]}" if left_out else ""
        raise InsufficientDataError(
            f"{cells.name}: no row has numbers of {named}{first}",
            remedy="write numbers alone in the cells, and their unit behind the name of the column",
        )
    channels = tuple(Channel(role, column.name, unit.unit) for role, (column, unit) in used.items())
    warnings = (
        *computed(used, said, domain),
        *replaced_units(used),
        *seen,
        *_rows_left_out(left_out),
    )
    file = LogFile(
        name=cells.name,
        sha256=cells.sha256,
        bytes=cells.size,
        rows=len(rows),
        missing_rows=len(left_out),
        channels=channels,
        comments=cells.comments,
        warnings=warnings,
    )
    return rows, file, error is not None, domain


def _with_labels(cells: CellTable, values: dict[str, FloatArray], first_run: int) -> dict[str, Any]:
    """What a table holds by the fields of `MeanRow`, with count, run and approach of each row."""
    count, run, approach = (plain_column(cells, name) for name in ("count", "run", "approach"))
    size = values["torque"].size
    ways = [_APPROACHES.get(text.lower(), "start") for text in cells.texts(approach)] if approach else None
    return values | {
        "count": np.ones(size) if count is None else np.maximum(cells.numbers(count), 1.0),
        "run": first_run + (_indices(cells.texts(run)) if run else np.zeros(size, dtype=np.intp)),
        "approach": ways or ["start"] * size,
    }


def _row(of: Mapping[str, Any]) -> MeanRow:
    load = of.get("load", np.nan)
    return MeanRow(
        run=int(of["run"]),
        speed=float(of["speed"]),
        torque=float(of["torque"]),
        torque_error=abs(float(of.get("error", 0.0))),
        temperature=float(of["temperature"]) if "temperature" in of else None,
        load=float(load) if np.isfinite(load) else None,
        count=float(of["count"]) if np.isfinite(of["count"]) else 1.0,
        approach=of["approach"],
        shared_error=abs(float(of.get("shared", 0.0))),
    )


def _indices(texts: list[str]) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Index of each text, in the order in which they first appear."""
    order = {text: i for i, text in enumerate(dict.fromkeys(texts))}
    return np.array([order[text] for text in texts], dtype=np.intp)


def _bad(cells: CellTable, row: int, role: str, columns: dict[str, Role]) -> str:
    """Which row is left out, and for which cell."""
    text = cells.texts(columns[role][0])[row] if role in columns else ""
    return f"row {row + 1} ({role} {text!r})" if text else f"row {row + 1} (no {role})"


def _rows_left_out(named: list[str]) -> list[Warning]:
    if not named:
        return []
    return [
        Warning(
            "rows of means left out",
            "{rows} {rows:row was|rows were} skipped because a cell is not a number: {first}"
            + (" and {others} more" if len(named) > _NAMED else ""),
            rows=len(named),
            first=", ".join(named[:_NAMED]),
            others=max(0, len(named) - _NAMED),
        )
    ]
