"""The dwells of all runs of a campaign, as rows by specimen and age."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.indicator import most_ages
from hersey.life.padded_rows import PaddedRows

if TYPE_CHECKING:
    import polars as pl

#: Ratio of the fastest to the slowest speed from which speeds tell anything.
_APART = 1.5
#: Dwells that most runs must have.
_FEWEST = 4
#: Columns of numbers of `Campaign.dwells`.
_NUMBERS = ("speed (rad/s)", "torque (N m)", "torque error (N m)", "temperature (K)")
#: Those that a dwell may lack: the scatter gives the error, and no dwell at all may have a temperature.
_MAY_LACK = _NUMBERS[2:]


@dataclass(frozen=True, repr=False)
class Dwells:
    """Dwells of runs as rows, filled up where ``given`` is false; runs by specimen and age."""

    speed: FloatArray
    temperature: FloatArray
    torque: FloatArray
    error: FloatArray
    given: BoolArray
    age: FloatArray  #: of each run, over the greatest
    specimen: IntArray  #: place of its specimen, ascending


def dwells_of(table: pl.DataFrame, age_name: str) -> tuple[Dwells, tuple[str, ...], float]:
    """Return dwells as rows of runs, names of the specimens, and the oldest age; errors as `fit_drift`."""
    needed = ("run_id", "unit", *_NUMBERS)
    missing = [name for name in needed if name not in table.columns] + ["age (...)"] * (not age_name)
    if missing:
        raise ParameterError(
            f"the table of dwells has no column {', '.join(map(repr, missing))}. Use Campaign.dwells()"
        )
    table = table.sort("unit", age_name, "run_id", maintain_order=True)
    columns = _columns(table, age_name)
    run = table["run_id"].to_numpy()
    rows = PaddedRows.of(np.cumsum(np.r_[False, run[1:] != run[:-1]]))
    _refuse_too_little(columns["speed (rad/s)"], rows)
    age, names = columns[age_name][rows.first], table["unit"].cast(str).to_numpy()[rows.first]
    units = tuple(dict.fromkeys(names.tolist()))
    places = {name: i for i, name in enumerate(units)}
    place = np.array([places[name] for name in names])
    if most_ages(place, age) < 2:
        raise InsufficientDataError(
            "no specimen was measured at two ages, so no change can be seen. Add runs at another age"
        )
    oldest = float(age.max())
    speed, torque, error, kelvin = (rows.filled(columns[name]) for name in _NUMBERS)
    return Dwells(speed, kelvin, torque, error, rows.given, age / oldest, place), units, oldest


def _columns(table: pl.DataFrame, age_name: str) -> dict[str, FloatArray]:
    """The columns of numbers, speed and torque in the sense of rotation."""
    found = {name: table[name].cast(float).fill_null(np.nan).to_numpy() for name in (age_name, *_NUMBERS)}
    for name, column in found.items():
        for i in np.flatnonzero(~np.isfinite(column) & ~(np.isnan(column) & (name in _MAY_LACK))):
            raise ParameterError(f"{name} of dwell {i + 1} (run {table['run_id'][int(i)]}) is not a number")
    speed = found["speed (rad/s)"]
    for i in np.flatnonzero(speed == 0.0):
        raise ParameterError(f"speed of dwell {i + 1} (run {table['run_id'][int(i)]}) is 0. Remove the dwell")
    unknown = np.isnan(found["temperature (K)"])
    if unknown.any() and not unknown.all():
        run = table["run_id"][int(np.flatnonzero(unknown)[0])]
        raise ParameterError(
            f"run {run} has dwells without a temperature, but other dwells have one. Use only one kind"
        )
    if not table.height:
        raise InsufficientDataError("there are no dwells. Add runs to the campaign")
    torque, error = (found[name] for name in ("torque (N m)", "torque error (N m)"))
    signless = {"speed (rad/s)": np.abs(speed), "torque (N m)": torque * np.sign(speed)}
    return {**found, **signless, "torque error (N m)": np.nan_to_num(error)}


def _refuse_too_little(speed: FloatArray, rows: PaddedRows) -> None:
    way_out = (
        "level, exponent and film cannot be distinguished. Record dwells at several speeds, or follow "
        "the torque itself with hersey.fit_growth"
    )
    if speed.max() < _APART * speed.min():
        raise InsufficientDataError(f"all dwells have the same speed, so {way_out}")
    if np.median(rows.given.sum(axis=1)) < _FEWEST:
        raise InsufficientDataError(f"most runs have fewer than {_FEWEST} dwells, so {way_out}")
