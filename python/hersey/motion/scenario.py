"""A sweep described by a file: `hersey sweep scenario.toml`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, UnitError
from hersey.files.toml import read_toml
from hersey.motion.drag import Drag
from hersey.motion.parameters import KINDS, PARAMETERS
from hersey.motion.simulation import TOLERANCE, Drivetrain
from hersey.motion.sweep import sweep
from hersey.units import parse

if TYPE_CHECKING:
    import xarray as xr

#: Most parameter sets of one sweep, which fit in some gigabytes.
MOST_SETS = 20_000_000

_TABLES = ("parameters", "options")
_OPTIONS = (
    "closure",
    "bristle_stiffness",
    "bristle_damping",
    "start",
    "duration",
    "tolerance",
    "units",
    "zip",
)


@dataclass(frozen=True)
class Scenario:
    """Parameters (SI, or numbers in consistent units) and options of a sweep."""

    parameters: dict[str, FloatArray]
    closure: str
    bristle_stiffness: float | None
    bristle_damping: float | None
    start: str
    duration: float | None
    tolerance: float
    zip: bool

    @property
    def sets(self) -> int:
        """How many parameter sets the sweep has."""
        sizes = [values.size for values in self.parameters.values()]
        return max(sizes) if self.zip else int(np.prod(sizes, dtype=float))

    def run(self, *, threads: int = 1, progress: Callable[[int, int], object] | None = None) -> xr.Dataset:
        """Return what each parameter set settles to; see `hersey.sweep`."""
        first = {name: float(values.flat[0]) for name, values in self.parameters.items()}
        drag = Drag(
            first["transition_force"],
            first["transition_speed"],
            ehl_exponent=first["ehl_exponent"],
            mixed_exponent=first["mixed_exponent"],
            stick_speed=min(first["stick_speed"], 0.5 * first["transition_speed"]),
            closure=self.closure,
            bristle_stiffness=self.bristle_stiffness,
            bristle_damping=self.bristle_damping,
        )
        varied: dict[str, Any] = {
            name: values if values.size > 1 else float(values.flat[0])
            for name, values in self.parameters.items()
        }
        return sweep(
            Drivetrain(first["stiffness"], first["mass"]),
            drag,
            **varied,
            zip=self.zip,
            start=self.start,
            duration=self.duration,
            threads=threads,
            tolerance=self.tolerance,
            progress=progress,
        )


def read_scenario(path: str | Path) -> Scenario:
    """Read a scenario: a table ``[parameters]`` with all eight, and ``[options]``.

    A parameter is a string with its unit (``"11 N/mm"``), a list of such strings, or a table ``{from, to,
    count}`` with ``spacing = "linear"`` or ``"log"``. With ``units = "consistent"`` among the options it is a
    number instead, in any consistent set of units.

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key.
    """
    path = Path(path)
    document = read_toml(path)
    _refuse_unknown(path.name, "table", document, _TABLES)
    options = _table(path.name, document, "options", required=False)
    given = _table(path.name, document, "parameters", required=True)
    _refuse_unknown(path.name, "option", options, _OPTIONS)
    _refuse_unknown(path.name, "parameter", given, PARAMETERS)
    units = options.get("units", "SI")
    if units not in ("SI", "consistent"):
        raise ParameterError(
            f"{path.name}: options.units is {units!r}: 'SI' (each value with its unit) or 'consistent'"
        )
    plain = units == "consistent"
    parameters = {}
    for name in PARAMETERS:
        if name not in given:
            raise ParameterError(f"{path.name}: [parameters] lacks '{name}'")
        where = f"{path.name}: parameters.{name}"
        parameters[name] = _values(where, None if plain else KINDS[name], given[name])

    def option(name: str, kind: str, default: float | None) -> float | None:
        if name not in options:
            return default
        return float(_number(f"{path.name}: options.{name}", None if plain else kind, options[name]))

    tolerance = _number(f"{path.name}: options.tolerance", None, options.get("tolerance", TOLERANCE))
    scenario = Scenario(
        parameters=parameters,
        closure=str(options.get("closure", "retained")),
        bristle_stiffness=option("bristle_stiffness", "stiffness", None),
        bristle_damping=option("bristle_damping", "translational damping", None),
        start=str(options.get("start", "rest")),
        duration=option("duration", "time", None),
        tolerance=tolerance,
        zip=bool(options.get("zip", False)),
    )
    if scenario.sets > MOST_SETS:
        raise ParameterError(f"{path.name}: {scenario.sets:.3g} parameter sets are more than {MOST_SETS:.0e}")
    return scenario


def _table(file: str, document: dict[str, Any], name: str, *, required: bool) -> dict[str, Any]:
    table = document.get(name, None if required else {})
    if not isinstance(table, dict):
        raise ParameterError(f"{file}: there is no table [{name}]")
    return table


def _refuse_unknown(file: str, what: str, given: dict[str, Any], known: tuple[str, ...]) -> None:
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise ParameterError(f"{file}: there is no {what} '{unknown[0]}': {', '.join(known)}")


def _values(where: str, kind: str | None, given: object) -> FloatArray:
    if isinstance(given, list):
        if not given:
            raise ParameterError(f"{where} is empty")
        return np.array([_number(where, kind, item) for item in given])
    if isinstance(given, dict):
        _refuse_unknown(where, "key", given, ("from", "to", "count", "spacing"))
        for key in ("from", "to", "count"):
            if key not in given:
                raise ParameterError(f"{where} lacks '{key}'")
        low, high = (_number(f"{where}.{key}", kind, given[key]) for key in ("from", "to"))
        count, spacing = given["count"], given.get("spacing", "linear")
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= MOST_SETS:
            raise ParameterError(
                f"{where}.count is {count}: a whole number from 1 to {MOST_SETS:.0e} is needed"
            )
        if spacing == "linear":
            return np.linspace(low, high, count)
        if spacing != "log":
            raise ParameterError(f"{where}.spacing is {spacing!r}: linear or log")
        if not low * high > 0:
            raise ParameterError(f"{where}: log spacing needs two values of one sign, and none zero")
        return np.asarray(np.geomspace(low, high, count))
    return np.array([_number(where, kind, given)])


def _number(where: str, kind: str | None, given: object) -> float:
    if kind is None:
        if isinstance(given, bool) or not isinstance(given, (int, float)):
            raise ParameterError(f"{where} is {given!r}: a plain number is needed")
        return float(given)
    if not isinstance(given, str):
        raise UnitError(f"{where} is {given}: write a string with its unit")
    try:
        return parse(kind, given)
    except UnitError as error:
        raise UnitError(f"{where}: {error}") from None


def rows(result: xr.Dataset, suffix: str) -> bytes:
    """Return the sweep as a table with one row per set, in the format of ``suffix`` (.parquet or .csv)."""
    import io

    import polars as pl

    shape = tuple(result.sizes.values())
    columns = {}
    for name in [*PARAMETERS, *(name for name in result.data_vars if name not in PARAMETERS)]:
        values = result[name].broadcast_like(result["frequency"]).transpose(*result["frequency"].dims)
        columns[str(name)] = np.asarray(values).reshape(shape).ravel()
    table = pl.DataFrame(columns)
    content = io.BytesIO()
    if suffix == ".parquet":
        table.write_parquet(content)
    else:
        table.write_csv(content)
    return content.getvalue()


def summary(result: xr.Dataset) -> dict[str, Any]:
    """Return how many sets have each outcome, and the range of the cycles' numbers."""
    kinds, counts = np.unique(result["kind"], return_counts=True)
    sticking = np.asarray(result["kind"]) == "stick_slip"
    ranges = {}
    if sticking.any():
        for name in ("frequency", "stuck_fraction", "speed_max", "stretch_max"):
            values = np.asarray(result[name])[sticking]
            ranges[name] = [float(values.min()), float(values.max())]
    return {
        "sets": int(result["kind"].size),
        "kinds": {str(kind): int(count) for kind, count in zip(kinds, counts, strict=True)},
        "stick_slip": ranges,
        "failures": list(result.attrs["failures"]),
    }
