"""What is kept of a run, from its steady points and back: whole, with the fit, and how they were read."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells import Rejection, SteadyPoints
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.damping.soundness import LARGEST, faults_of_rest
from hersey.errors import HerseyError, ParameterError
from hersey.life.campaign.entry import COLUMNS, Entry
from hersey.life.campaign.records import plain, read_json, refuse_others, restored
from hersey.log.means import MeansTable
from hersey.log.sensors import OF_ROLE, Sensors
from hersey.log.torque_log import Correction, LogFile, TorqueLog
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

    from hersey.damping.surface import DampingSurface

#: What is kept of a log, of a table of means besides, and of the reduction.
_LOG = {
    "runs": tuple[()],
    "files": tuple[LogFile, ...],
    "corrections": tuple[Correction, ...],
    "sensors": Sensors,
    "kept_rows": int,
    "thermal": bool,
    "domain": Domain,
}
_MEANS = {"means": tuple[()], "stated_errors": bool}
_REDUCTION = {
    "means": bool,
    "log": dict,
    "rejected": tuple[Rejection, ...],
    "tare": float,
    "standing_torque": float | None,
    "tare_errors": FloatArray,
    "warnings": tuple[Warning, ...],
    "rest": NoLoadTorque | None,
    "rest_errors": FloatArray,
    "relaxation_errors": FloatArray,
    "window_errors": FloatArray,
    "temperature_rates": FloatArray,
    "of_every_sample": bool,
}
#: Kept since later than the rest: of dwells, and of a torque, where they are not stated.
_LATER = ("relaxation_errors", "window_errors", "temperature_rates", "of_every_sample")
#: Numbers of each dwell in rows of a table, and one by one.
_OF_DWELLS = {
    "tare_errors": 2,
    "rest_errors": 2,
    "relaxation_errors": 2,
    "window_errors": 2,
    "temperature_rates": 1,
}


def entry_of(
    points: SteadyPoints,
    path: str | Path,
    *,
    fit: DampingSurface | None = None,
    temperature_scale: str = "degC",
    settings: dict[str, Any] | None = None,
) -> Entry:
    """Return what is kept of the steady points of one log.

    Parameters
    ----------
    points
        Of one log in one file.
    path
        The file; its hash is that of the bytes that were read.
    fit
        Its damping surface; fitted here if left out. Where no law fits, the reason is kept.
    temperature_scale
        As `hersey.fit` takes it.
    settings
        How the log was read, as JSON can hold it.

    Raises
    ------
    ParameterError
        If the points are of several files.
    """
    from hersey import _core
    from hersey.damping.fit import fit as fitted

    path = Path(path)
    if len(points.log.files) != 1:
        names = ", ".join(file.name for file in points.log.files)
        raise ParameterError(
            f"a run of a campaign is one log, but these are several: {names}. Add them one by one"
        )
    no_fit = ""
    if fit is None:
        try:
            fit = fitted(points, temperature_scale=temperature_scale)
        except HerseyError as error:
            no_fit = str(error)
    try:
        written: float | None = path.stat().st_mtime
    except OSError:
        written = None
    return Entry(
        path=str(path.absolute()),
        sha256=points.log.files[0].sha256,
        written=written,
        version=_core.VERSION,
        settings=json.dumps(settings or {}, sort_keys=True),
        reduction=json.dumps(plain(_reduction(points))),
        fit=None if fit is None else json.dumps(fit.to_dict()),
        no_fit=no_fit,
        dwells=[list(row) for row in points.table.select(list(COLUMNS)).rows()],
    )


def points_of(reduction: str, dwells: Iterable[tuple[Any, ...]]) -> SteadyPoints:
    """Return the steady points of a run as they were added; no rows of the log come with them."""
    import polars as pl

    kinds = {"INTEGER": pl.Int64, "REAL": pl.Float64, "TEXT": pl.String}
    schema = {name: kinds[kind]() for name, kind in COLUMNS.items()}
    read = read_json(reduction)
    held = restored(
        read, {name: kind for name, kind in _REDUCTION.items() if name in read or name not in _LATER}
    )
    means, about, table = held.pop("means"), held.pop("log"), list(dwells)
    about = {"domain": TORQUE} | about
    refuse_others(about, _LOG | _MEANS if means else _LOG, "log.")
    for name, ndim in _OF_DWELLS.items():
        if name in held and (held[name].ndim != ndim or len(held[name]) not in (0, len(table))):
            raise ParameterError(f"'{name}' does not have one row per dwell")
    _refuse_unsound(held["rest"], about["sensors"])
    log = (_KeptMeans if means else _KeptLog)(**about)
    return SteadyPoints(pl.DataFrame(table, schema=schema, orient="row"), log=log, **held)


def rests_of(dwells: pl.DataFrame, rests: Mapping[int, NoLoadTorque | None]) -> FloatArray:
    """Return what was subtracted as the no-load torque of each dwell, N m with its sign; shape (dwells,).

    ``dwells`` holds ``run_id``, ``speed`` and ``temperature`` in SI; ``rests`` go with the runs, and
    equal ones are one object.
    """
    import polars as pl

    runs_with: dict[int, list[int]] = {}
    for run, rest in rests.items():
        runs_with.setdefault(id(rest), []).append(run)
    taken = np.zeros(dwells.height)
    speed, kelvin = (dwells[name].cast(pl.Float64).to_numpy() for name in ("speed", "temperature"))
    for runs in runs_with.values():
        if (rest := rests[runs[0]]) is not None:
            of = np.isin(dwells["run_id"].to_numpy(), runs)
            thermal = bool(np.isfinite(kelvin[of]).all())
            taken[of] = rest.torque(speed[of], temperature=kelvin[of] if thermal else None)
    return taken


def drive_of(
    reduction: str, same: dict[str, tuple[NoLoadTorque | None, Sensors]]
) -> tuple[NoLoadTorque | None, Sensors]:
    """Return the no-load torque that was subtracted from a run, and its sensors; ``same``: those met before.

    Raises
    ------
    ParameterError
        If they are not as they are written, naming the key.
    """
    held = read_json(reduction)
    log = held.get("log")
    both = {"rest": held.get("rest"), "sensors": log.get("sensors") if isinstance(log, dict) else None}
    key = json.dumps(both)
    if key not in same:
        found = restored(both, {"rest": NoLoadTorque | None, "sensors": Sensors})
        _refuse_unsound(**found)
        same[key] = found["rest"], found["sensors"]
    return same[key]


def _refuse_unsound(rest: NoLoadTorque | None, sensors: Sensors) -> None:
    """Refuse numbers that no rest of a drive and no sensor has."""
    for field, asked in () if rest is None else faults_of_rest(rest):
        raise ParameterError(f"'rest.{field}' must be {asked}")
    for name in (name for names in OF_ROLE.values() for name in names):
        value = getattr(sensors, name)
        if value is not None and not 0.0 <= value <= LARGEST:
            raise ParameterError(f"'log.sensors.{name}' must be from 0 to {LARGEST:g}")


@dataclass(frozen=True, repr=False)
class _WithoutRows:
    """What is known of rows that are not kept."""

    kept_rows: int = 0
    thermal: bool = False

    @property
    def rows(self) -> int:
        return self.kept_rows

    @property
    def has_temperature(self) -> bool:
        return self.thermal


@dataclass(frozen=True, repr=False)
class _KeptLog(_WithoutRows, TorqueLog):
    """A log of which only its files, corrections, sensors and domain are kept."""

    domain: Domain = TORQUE


@dataclass(frozen=True, repr=False)
class _KeptMeans(_WithoutRows, MeansTable):
    """A table of means of which only its files and sensors are kept."""


def _reduction(points: SteadyPoints) -> dict[str, Any]:
    log, means = points.log, isinstance(points.log, MeansTable)
    about = {
        "runs": (),
        "files": log.files,
        "corrections": log.corrections,
        "sensors": log.sensors,
        "kept_rows": log.rows,
        "thermal": log.has_temperature,
        "domain": log.domain,
    }
    if isinstance(log, MeansTable):
        about |= {"means": (), "stated_errors": log.stated_errors}
    names = _REDUCTION.keys() - {"means", "log"}
    return {"means": means, "log": about} | {name: getattr(points, name) for name in sorted(names)}
