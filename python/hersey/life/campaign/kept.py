"""What is kept of a run, from its steady points and back: whole, with the fit, and how they were read."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells import Rejection, SteadyPoints
from hersey.damping.estimate import Estimate
from hersey.damping.rest import RestOfDrive
from hersey.errors import HerseyError, ParameterError
from hersey.life.campaign.entry import COLUMNS, Entry
from hersey.log.means import MeansTable
from hersey.log.sensors import Sensors
from hersey.log.torque_log import Channel, Correction, Effect, LogFile, TorqueLog

if TYPE_CHECKING:
    import polars as pl

    from hersey.damping.surface import DampingSurface

#: Records that are written and read back, by name.
_RECORDS = {
    kind.__name__: kind
    for kind in (Channel, Correction, Effect, Estimate, LogFile, Rejection, RestOfDrive, Sensors)
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
        raise ParameterError(f"a run of a campaign is one log, and these are several: {names}: add each")
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
        reduction=json.dumps(_plain(_reduction(points))),
        fit=None if fit is None else json.dumps(fit.to_dict()),
        no_fit=no_fit,
        dwells=[list(row) for row in points.table.select(list(COLUMNS)).rows()],
    )


def points_of(reduction: str, dwells: Iterable[tuple[Any, ...]]) -> SteadyPoints:
    """Return the steady points of a run as they were added; no rows of the log come with them."""
    import polars as pl

    kinds = {"INTEGER": pl.Int64, "REAL": pl.Float64, "TEXT": pl.String}
    schema = {name: kinds[kind]() for name, kind in COLUMNS.items()}
    held = _restored(json.loads(reduction))
    log = (_KeptMeans if held.pop("means") else _KeptLog)(**held.pop("log"))
    return SteadyPoints(pl.DataFrame(list(dwells), schema=schema, orient="row"), log=log, **held)


def rests_of(dwells: pl.DataFrame, reductions: Iterable[tuple[int, str]]) -> FloatArray:
    """Return what was taken off as the rest of the drive of each dwell, N m with its sign; shape (dwells,).

    ``dwells`` holds ``run_id``, ``speed`` and ``temperature`` in SI; ``reductions`` go with the runs.
    """
    import polars as pl

    runs_with: dict[str, list[int]] = {}
    for run, reduction in reductions:
        if (rest := json.loads(reduction)["rest"]) is not None:
            runs_with.setdefault(json.dumps(rest), []).append(run)
    taken = np.zeros(dwells.height)
    speed, kelvin = (dwells[name].cast(pl.Float64).to_numpy() for name in ("speed", "temperature"))
    for text, runs in runs_with.items():
        rest, of = _restored(json.loads(text)), np.isin(dwells["run_id"].to_numpy(), runs)
        thermal = bool(np.isfinite(kelvin[of]).all())
        taken[of] = rest.torque(speed[of], kelvin[of] if thermal else None)
    return taken


def drive_of(
    reduction: str, same: dict[str, tuple[RestOfDrive | None, Sensors]]
) -> tuple[RestOfDrive | None, Sensors]:
    """Return the rest of the drive that was taken off a run, and its sensors; ``same``: those met before."""
    held = json.loads(reduction)
    both = [held["rest"], held["log"]["sensors"]]
    key = json.dumps(both)
    if key not in same:
        same[key] = _restored(both)
    return same[key]


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
    """A log of which only its files, corrections and sensors are kept."""


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
    }
    if isinstance(log, MeansTable):
        about |= {"means": (), "stated_errors": log.stated_errors}
    names = ("rejected", "tare", "standing_torque", "tare_errors", "notes", "rest", "rest_errors")
    return {"means": means, "log": about} | {name: getattr(points, name) for name in names}


def _plain(value: Any) -> Any:
    """A value as JSON, records by their names, so that `_restored` gives it back with every digit."""
    if is_dataclass(value) and not isinstance(value, type):
        return {"kind": type(value).__name__} | {
            f.name: _plain(getattr(value, f.name)) for f in fields(value)
        }
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        return {"array": value.tolist(), "shape": list(value.shape)}
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def _restored(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(_restored(item) for item in value)
    if not isinstance(value, dict):
        return value
    if "shape" in value:
        return np.array(value["array"], dtype=float).reshape(value["shape"])
    inside = {name: _restored(item) for name, item in value.items()}
    return _RECORDS[inside.pop("kind")](**inside) if "kind" in inside else inside
