"""A sweep described by a file: `hersey sweep scenario.toml`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass as plain_dataclass
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import StrictBool, ValidationInfo
from pydantic.dataclasses import dataclass

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, Setting, printable
from hersey.files.toml import Quantity, Table, naming, read_tables, read_toml
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag
from hersey.motion.parameters import MOST_SETS, PARAMETERS
from hersey.motion.simulation import TOLERANCE
from hersey.motion.sweep import planned, sweep
from hersey.motion.work import ALONE, Work

if TYPE_CHECKING:
    import xarray as xr

    from hersey.motion.checkpoint import Checkpoint
    from hersey.scale.store import SweepFolder


@plain_dataclass(frozen=True)
class Scenario:
    """Parameters (SI, or numbers in consistent units) and options of a sweep.

    ``grip``, ``rest_force`` and ``rest_damping`` are those of `Drivetrain` and `Drag`, the same in every set.
    """

    parameters: dict[str, FloatArray]
    closure: str
    bristle_stiffness: float | None
    bristle_damping: float | None
    start: str
    duration: float | None
    tolerance: float
    zip: bool
    grip: float | None = None
    rest_force: float = 0.0
    rest_damping: float = 0.0
    #: SI, or consistent for bare numbers of any consistent set of units.
    units: str = "SI"

    @property
    def sets(self) -> int:
        """How many parameter sets the sweep has."""
        sizes = [values.size for values in self.parameters.values()]
        return max(sizes) if self.zip else int(np.prod(sizes, dtype=float))

    def run(self, work: Work = ALONE) -> xr.Dataset:
        """Return what each parameter set settles to, as exactly as the scenario says; see `hersey.sweep`."""
        train, drag, varied = self._arguments()
        return sweep(
            train,
            drag,
            **varied,
            zip=self.zip,
            start=self.start,
            duration=self.duration,
            work=replace(work, tolerance=self.tolerance),
        )

    def keep(self, out: Path | SweepFolder, work: Work = ALONE) -> Checkpoint:
        """Keep each chunk of sets in a folder as it ends."""
        from hersey.motion.checkpoint import checkpointed

        how: dict[str, Any] = {"start": self.start, "duration": self.duration, "tolerance": self.tolerance}
        sets, rules = planned(*self._arguments(), zip=self.zip, **how)
        return checkpointed(sets, rules, out, work, units=self.units)

    def _arguments(self) -> tuple[Drivetrain, Drag, dict[str, Any]]:
        """What `hersey.sweep` takes: train, drag, and each parameter."""
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
            rest_force=self.rest_force,
            rest_damping=self.rest_damping,
        )
        varied: dict[str, Any] = {
            name: values if values.size > 1 else float(values.flat[0])
            for name, values in self.parameters.items()
        }
        return Drivetrain(first["stiffness"], first["mass"], grip=self.grip), drag, varied


#: A range as it is written in words, and the longest text that is looked at.
_NUMBER = r"[-+]?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?"
_RANGE = re.compile(
    rf"\s*({_NUMBER})(?:\s*(\S*?)\s+to\s+|\s*(?:\.\.\.?|[-\u2013:])\s*)({_NUMBER})\s*(.*?)\s*"
)
_LONGEST = 100


class _Values(Quantity):
    """A value, a list of them, or a table ``{from, to, count}``."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> Any:
        """Return the values in SI, shape (count,)."""
        if isinstance(given, dict):
            return self._between(given, info)
        if given == []:
            raise ParameterError("is empty")
        if isinstance(given, str) and (meant := _several(given)):
            raise ParameterError(f"is '{given}', not one value. Write {meant}")
        many = given if isinstance(given, list) else [given]
        return np.array([super(_Values, self).checked(value, info) for value in many])

    def _between(self, table: dict[str, Any], info: ValidationInfo[Any]) -> FloatArray:
        keys = ("from", "to", "count", "spacing")
        if unknown := sorted(set(table) - set(keys)):
            raise ParameterError(f"has an unknown key '{unknown[0]}'. Known keys: {', '.join(keys)}")
        if lacking := [key for key in keys[:3] if key not in table]:
            raise ParameterError(f"needs the key '{lacking[0]}'")
        ends = []
        for key in keys[:2]:
            with naming(f".{key}"):
                ends.append(super().checked(table[key], info))
        count, spacing = table["count"], table.get("spacing", "linear")
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= MOST_SETS:
            raise ParameterError(f".count is {count}: it must be a whole number from 1 to {MOST_SETS:.0e}")
        if spacing not in ("linear", "log"):
            raise ParameterError(f".spacing is {spacing!r}: it must be linear or log")
        if spacing == "log" and not ends[0] * ends[1] > 0:
            raise ParameterError("needs two values of the same sign, neither of them zero, for log spacing")
        spaced = np.geomspace if spacing == "log" else np.linspace
        return np.asarray(spaced(ends[0], ends[1], count), dtype=float)


def _several(text: str) -> str:
    """How a range or a list in one text is written, or nothing."""
    if len(text) > _LONGEST:
        return ""
    if match := _RANGE.fullmatch(text):
        low, first, high, unit = match.groups()
        ends = [f"{low} {first or unit}".strip(), f"{high} {unit}".strip()]
        low, high = ends if not unit else (f'"{each}"' for each in ends)
        return f"{{ from = {low}, to = {high}, count = 10 }}"
    parts = [part.strip() for part in re.split(r"[,;]\s+", text)]
    if len(parts) < 2:
        return ""
    unit = parts[-1].lstrip("+-.0123456789eE").strip()
    quote = '"' if unit else ""
    units = ["" if re.search(r"[A-Za-z]", part) else f" {unit}" for part in parts[:-1]] + [""]
    listed = [f"{quote}{part}{own}".rstrip() + quote for part, own in zip(parts, units, strict=True)]
    return f"[{', '.join(listed)}]"


_Force = Annotated[Any, _Values("force")]
_Speed = Annotated[Any, _Values("belt speed")]
_Exponent = Annotated[Any, _Values(None)]


@dataclass(frozen=True)
class _ParametersTable(Table):
    #: Spring stiffness.
    stiffness: Annotated[Any, _Values("stiffness")] = None
    #: Moving mass, at the belt.
    mass: Annotated[Any, _Values("mass")] = None
    #: Drag at the transition speed.
    transition_force: _Force = None
    #: Transition speed.
    transition_speed: _Speed = None
    #: Exponent of damping in speed above the transition.
    ehl_exponent: _Exponent = None
    #: Exponent of damping in speed below the transition.
    mixed_exponent: _Exponent = None
    #: Stick speed.
    stick_speed: _Speed = None
    #: Speed of the drive.
    drive_speed: _Speed = None


@dataclass(frozen=True)
class _OptionsTable(Table):
    #: Motion below the stick speed: "retained", "stiction", "stribeck" or "lugre".
    closure: str = "retained"
    #: Force per deflection of the bristles; for "lugre".
    bristle_stiffness: Annotated[float, Quantity("stiffness")] | None = None
    #: Force per rate of deflection; for "lugre".
    bristle_damping: Annotated[float, Quantity("translational damping")] | None = None
    #: "rest", or "steady": sliding with the drive.
    start: str = "rest"
    #: Time simulated; without it until the orbit closes.
    duration: Annotated[float, Quantity("time")] | None = None
    #: Relative tolerance of the motion.
    tolerance: Annotated[float, Quantity(None)] = TOLERANCE
    #: "consistent": plain numbers in any consistent set of units.
    units: Literal["SI", "consistent"] = "SI"
    #: Whether lists of equal length are taken together instead of being crossed.
    zip: StrictBool = False


@dataclass(frozen=True, kw_only=True)
class _ScenarioFile(Table):
    options: _OptionsTable = field(default_factory=_OptionsTable)
    parameters: _ParametersTable


#: What a machine states of a belt beside its parameters.
_BESIDE = ("grip", "rest_force", "rest_damping")
#: A line for each parameter that a scenario may lack.
_LINES = {
    "stiffness": '"11 N/mm"',
    "mass": '"11 kg"',
    "transition_force": '"14 N"',
    "transition_speed": '"25 mm/s"',
    "ehl_exponent": "-0.7",
    "mixed_exponent": "-1.2",
    "stick_speed": '"0.3 mm/s"',
    "drive_speed": '"30 mm/s"',
}


def read_scenario(
    path: str | Path,
    *,
    stated: Mapping[str, float] | None = None,
    stated_in: str = "",
    most: float = MOST_SETS,
) -> Scenario:
    """Read a scenario: a table ``[parameters]`` with all eight, and ``[options]``.

    ``stated`` are parameters in SI that the scenario need not state, from the file ``stated_in``; what it
    states holds. They may have the ``grip`` of the roll, and ``rest_force`` and ``rest_damping`` too. More
    sets than ``most`` are refused: those that fit in memory, unless each chunk is kept as it ends.

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
    if "drivetrain" in document:
        raise ParameterError(
            f"{path.name} is a machine file ([drivetrain]), not a scenario",
            remedy="name a scenario, e.g. the scenario.toml that 'hersey examples' writes, and give the "
            f"machine file as {Setting('machine').to(printable(str(path)))}",
        )
    plain = _is_plain(document.get("options"))
    if stated is not None and plain:
        raise ParameterError(
            f"{path.name}: {stated_in} is in SI. Write values with their units, and delete units = "
            '"consistent"'
        )
    tables = read_tables(path, _ScenarioFile, plain=plain)
    options = dict(vars(tables.options))
    options |= {name: value for name, value in (stated or {}).items() if name in _BESIDE}
    scenario = Scenario(parameters=_filled(path, tables.parameters, stated, stated_in), **options)
    if scenario.sets > most:
        raise ParameterError(
            f"{path.name}: {scenario.sets:.3g} parameter sets are more than the limit of {most:.0e}"
        )
    return scenario


def _filled(
    path: Path, table: _ParametersTable, stated: Mapping[str, float] | None, stated_in: str
) -> dict[str, FloatArray]:
    """All eight parameters, those of the scenario first."""
    parameters: dict[str, FloatArray] = {}
    for name in PARAMETERS:
        values = getattr(table, name)
        if values is None and name in (stated or {}):
            values = np.array([(stated or {})[name]])
        if values is None:
            also = f", and {stated_in} does not have it. Add {name} = {_LINES[name]}" if stated_in else ""
            raise ParameterError(f"{path.name}: [parameters] has no '{name}'{also}")
        parameters[name] = values
    return parameters


def _is_plain(options: object) -> bool:
    return isinstance(options, dict) and options.get("units") == "consistent"


def rows(result: xr.Dataset, suffix: str) -> bytes:
    """Return the sweep as a table with one row per set, in the format of ``suffix`` (.parquet or .csv)."""
    import polars as pl

    from hersey.files.tables import table

    shape = tuple(result.sizes.values())
    columns = {}
    for name in [*PARAMETERS, *(name for name in result.data_vars if name not in PARAMETERS)]:
        values = result[name].broadcast_like(result["frequency"]).transpose(*result["frequency"].dims)
        columns[str(name)] = np.asarray(values).reshape(shape).ravel()
    return table(pl.DataFrame(columns), suffix)


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
