"""What dwells are reduced to: one steady point each, and what is not used."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
import polars as pl

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.dwells.columns import column_of
from hersey.damping.dwells.film_torque import film_torque
from hersey.damping.dwells.hersey_number import Viscous, against_hersey_number
from hersey.damping.dwells.reasons import Reason, joined, opposite_signs
from hersey.damping.dwells.rejection import Rejection, record_of, turned_rejection
from hersey.damping.dwells.relaxation import Relaxation
from hersey.damping.dwells.resolution import Resolution
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.errors import InsufficientDataError, ParameterError
from hersey.log.as_torque import factors, log_as_torque, one_load
from hersey.log.means import MeanRow, MeansTable, read_means
from hersey.log.pooling import SAME_LOAD
from hersey.log.torque_log import TorqueLog
from hersey.result import Result, json_record
from hersey.schema.domain import Domain
from hersey.schema.warning import Warning
from hersey.units import argument, takes_si

#: What errors that points share do to each torque.
_SHARED_ERRORS = ("tare_errors", "rest_errors", "relaxation_errors", "window_errors")


class HowRead(Protocol):
    """How logs became dwells, for whoever shows it: `hersey.Recipe` is one."""

    def by_name(self) -> HowRead:
        """Return the same with files by their names, without folders."""

    def to_dict(self) -> dict[str, Any]:
        """Return what is not the default, as JSON."""

    def toml(self) -> str:
        """Return the text of its file."""


@dataclass(frozen=True, repr=False)
class SteadyPoints(Result):
    """One row per dwell.

    Attributes
    ----------
    table
        Columns ``run`` (index), ``start``, ``end`` (s), ``speed``, ``speed_error`` (rad/s), ``torque``,
        ``torque_error`` (N m), ``temperature``, ``temperature_error`` (K, null if not recorded), ``rows``,
        ``effective_rows`` (independent samples), ``settling_rows`` (cut at the ends), ``approach``
        (``from below``, ``from above`` or ``start``), ``load`` (N, null if not known), ``tare`` (N m).
        Errors are standard errors of the mean.
        Speed and torque carry the sign of the rotation.
    rejected
        Every other stretch, with the reason. Rows of the table and of this list add up to the log's.
    tare
        Torque subtracted, N m: the mean over the dwells.
    tare_errors
        What one standard error of each independent disturbance of the tare does to the torque of each dwell,
        N m, shape (points, disturbances); one column for a zero that is constant, none without a tare.
    warnings
        What is to be known of the tare, or of a table of means.
    standing_torque
        Mean torque while the drive stood, N m, or None if it never did.
    log
        What was reduced, or the table that states them.
    rest
        The no-load torque, subtracted so that torque is that of the film (see `without`); None if none is.
    rest_errors
        What one standard error of each independent error of it does to the torque of each dwell, N m, shape
        (points, errors).
    resolutions
        Steps in which the sensors count, with the error that rounding leaves in each dwell; the errors of the
        table contain it.
    relaxation
        How torque still relaxes within the dwells after each change of speed, or None if it does not show.
    relaxation_errors
        What is left of it in the torque of each dwell at the most, N m, shape (points, 0 or 1).
    window_errors
        What one standard error of each number that all windows of a moving log share (inertia, offset, the
        moment of inertia of a coast-down), or all rows of a table of means, does to the torque of each point,
        N m, shape (points, errors).
    of_every_sample
        Whether the points are windows of a fit to every sample of a log, not dwells.
    temperature_rates
        How fast the reading of temperature changes over each dwell, K/s, 0 within its noise, shape (points,).
    recipe
        The recipe that made the dwells; None if they were reduced without one.
    """

    table: pl.DataFrame
    rejected: tuple[Rejection, ...]
    tare: float
    standing_torque: float | None
    log: TorqueLog | MeansTable
    tare_errors: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    warnings: tuple[Warning, ...] = ()
    rest: NoLoadTorque | None = None
    rest_errors: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    resolutions: tuple[Resolution, ...] = ()
    relaxation: Relaxation | None = None
    relaxation_errors: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    window_errors: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    temperature_rates: FloatArray = field(default_factory=lambda: np.empty(0))
    of_every_sample: bool = False
    recipe: HowRead | None = None

    def __post_init__(self) -> None:
        """Give what has no tare, no rest subtracted or no relaxation, no disturbances of it."""
        for name in _SHARED_ERRORS:
            if not getattr(self, name).size:
                object.__setattr__(self, name, np.empty((self.table.height, 0)))

    @property
    def zero_errors(self) -> FloatArray:
        """What each independent error that points share does to each torque, N m, shape (points, errors)."""
        return np.hstack([self.tare_errors, self.rest_errors, self.relaxation_errors, self.window_errors])

    @property
    def tare_error(self) -> float:
        """Standard error of the tare, N m: root mean square over the dwells."""
        return float(np.sqrt(np.mean(np.sum(self.tare_errors**2, axis=1))))

    @classmethod
    @takes_si(radius="length", load="force")
    def from_table(
        cls,
        table: Any,
        *,
        channels: dict[str, str] | None = None,
        units: dict[str, str] | None = None,
        isothermal: bool = False,
        rotation: str = "both",
        radius: float | Sequence[float] | None = None,
        load: float | Sequence[float] | None = None,
    ) -> SteadyPoints:
        """Return the steady points of a table of means: one row per dwell, no time column.

        Parameters
        ----------
        table
            A file, columns by name or a polars or pandas frame, with speed and torque; temperature, load, the
            standard error of the torque (or its deviation and a count), the error that all rows share, run
            and approach may stand beside them. Units stand in the names of the columns. Also several, or a
            `MeansTable`.
        channels, units
            Column and unit by role (``torque``, ``speed``, ``temperature``), where the names do not say.
        isothermal
            Leave temperature out.
        rotation
            ``both``, or only ``forward`` (positive speed) or ``reverse`` rows.
        radius, load
            At which a friction force acts and a sliding speed is measured, m, and normal load, N, where no
            column holds them; strings such as ``"25 mm"`` and pint quantities too.

        Raises
        ------
        HerseyError
            If the table lacks speed or torque, or no row of it can be used.

        Examples
        --------
        >>> points = SteadyPoints.from_table({"speed [rpm]": [10, 20, 40], "torque [mN*m]": [5.0, 5.6, 6.3]})
        >>> len(points)
        3
        """
        if not isinstance(table, MeansTable):
            table = read_means(
                table, channels=channels, units=units, isothermal=isothermal, radius=radius, load=load
            )
        dwells, rejected = _stated(table, rotation)
        if not dwells and {r.why.kind for r in rejected if r.is_dwell} == {"opposite signs"}:
            raise opposite_signs(f"{table.files[0].name}: no row can be used")
        if not dwells:
            raise InsufficientDataError(f"{table.files[0].name}: no row can be used: {rejected[0].reason}")
        kinds = dict.fromkeys(("temperature", "temperature_error", "load"), pl.Float64)
        frame = pl.DataFrame(dwells, schema_overrides=kinds)
        shared = _shared(table, rotation)
        return cls(
            frame, tuple(rejected), 0.0, None, table, warnings=(_of_means(table),), window_errors=shared
        )

    @takes_si()
    def without(self, rest: NoLoadTorque) -> SteadyPoints:
        """Return the same dwells with the torque of the film alone: the no-load torque is subtracted.

        Its errors are shared by all dwells, like those of the tare.

        Raises
        ------
        InsufficientDataError
            If a no-load log does not cover the speeds, or leaves nothing for the film at one dwell, or
            nothing beyond its errors at a quarter of them. Fewer such dwells are rejected.
        ParameterError
            If a no-load torque was already subtracted.

        Examples
        --------
        >>> from hersey import NoLoadTorque
        >>> table = {"speed [rpm]": [10, 20, 40], "torque [mN*m]": [25.0, 25.6, 26.3]}
        >>> rest = NoLoadTorque.stated(constant=0.020, uncertainty=0.05)
        >>> SteadyPoints.from_table(table).without(rest).column("torque").round(4).tolist()
        [0.005, 0.0056, 0.0063]
        """
        self.domain.require_torque("subtracting a no-load torque")
        self.refuse_subtracted()
        name = self.log.files[0].name
        speed, torque, error = (self.column(n) for n in ("speed", "torque", "torque_error"))
        kelvin = None
        if self.log.has_temperature and rest.reference_temperature is not None:
            kelvin = self.column("temperature")
        rest.refuse_beyond(speed, name)
        variance = error**2 + np.sum(self.tare_errors**2, axis=1)
        runs = self.log.runs
        logs = [runs[run].name if runs else name for run in self.table["run"].to_list()]
        film, errors, hidden = film_torque(speed, torque, variance, kelvin, rest, logs)
        whole = replace(self, table=self.table.with_columns(torque=film), rest=rest, rest_errors=errors)
        return whole.without_dwells(hidden, Reason("no film"))

    def without_dwells(self, out: BoolArray, why: Reason) -> SteadyPoints:
        """Return the points without some dwells, shape (points,); those are rejected for a reason."""
        if not out.any():
            return self
        gone = self.table.filter(pl.Series(out)).to_dicts()
        rejected = [
            Rejection(row["run"], row["start"], row["end"], row["rows"], why, row["speed"]) for row in gone
        ]
        relaxation = self.relaxation
        return replace(
            self,
            table=self.table.filter(pl.Series(~out)),
            rejected=(*self.rejected, *rejected),
            resolutions=tuple(replace(each, errors=each.errors[~out]) for each in self.resolutions),
            relaxation=None if relaxation is None else replace(relaxation, left=relaxation.left[~out]),
            temperature_rates=self.temperature_rates[~out] if self.temperature_rates.size else np.empty(0),
            **{name: getattr(self, name)[~out] for name in _SHARED_ERRORS},
        )

    def refuse_subtracted(self) -> None:
        """Raise `ParameterError` if a no-load torque was already subtracted, be it by the mapping."""
        if self.rest is not None or any(c.name.startswith("no-load") for c in self.log.corrections):
            raise ParameterError(
                f"{self.log.files[0].name}: the no-load torque is already subtracted. Remove no_load from "
                "the mapping, or omit the no-load torque"
            )

    def __len__(self) -> int:
        """Return the number of steady points."""
        return self.table.height

    def column(self, name: str) -> FloatArray:
        """Return a column as an array of shape (points,); `ChannelError` if there is none of that name."""
        return column_of(self.table, name).to_numpy()

    def summary(self) -> str:
        """Return the number of dwells, their ranges, the tare, and what is excluded, as text."""
        rows = f"{self.table['rows'].sum()} of {self.log.rows} rows used"
        of = self.domain
        lines = [f"{self.headline()}; {rows}", f"tare {of.amount(self.tare, '.4g')}"]
        if self.standing_torque is not None:
            lines[-1] += f", {of.quantity} at standstill {of.amount(self.standing_torque, '.4g')}"
        if self.rest is not None:
            lines.append(f"no-load torque subtracted: {self.rest}")
        lines += [f"  excluded: {rows} rows, {why}" for why, rows in self._unused().items()]
        return "\n".join(
            [
                *lines,
                *(warning.sentence for warning in self.warnings),
                *([dropped] if (dropped := self.dropped()) else []),
            ]
        )

    def headline(self) -> str:
        """Return the number of dwells and the ranges of speed and torque."""
        speed, torque = np.abs(self.column("speed")), np.abs(self.column("torque"))
        of = self.domain
        name = "" if of.is_torque else f"{of.quantity} "
        return (
            f"{len(self)} dwells, {of.between(float(speed.min()), float(speed.max()), '.4g')}, "
            f"{name}{torque.min():.4g} to {of.amount(float(torque.max()), '.4g')}"
        )

    @property
    def domain(self) -> Domain:
        """What the points are of: a torque, or a friction force or coefficient, against which speed."""
        return self.log.domain

    @takes_si(radius="length", load="force")
    def as_torque(self, *, radius: float, load: float | None = None) -> SteadyPoints:
        """Return the points as the torque of a rotation at a radius (m), at a normal load (N).

        Parameters
        ----------
        radius
            At which the friction acts.
        load
            For a friction coefficient; default: that of the log, if it has one.

        Raises
        ------
        ParameterError
            If a load is needed and the log has none, or several.

        Examples
        --------
        >>> table = {"speed [m/s]": [0.1, 0.2, 0.4], "COF": [0.12, 0.12, 0.12]}
        >>> points = SteadyPoints.from_table(table).as_torque(radius="10 mm", load="50 N")
        >>> points.column("torque").round(6).tolist()
        [0.06, 0.06, 0.06]
        """
        load = one_load(self.log, load)
        by, per = factors(self.domain, radius, load)
        scaled = {"torque": by, "torque_error": by, "tare": by, "speed": per, "speed_error": per}
        table = self.table.with_columns(**{name: factor * pl.col(name) for name, factor in scaled.items()})
        standing = None if self.standing_torque is None else by * self.standing_torque
        return replace(
            self,
            table=table,
            tare=by * self.tare,
            standing_torque=standing,
            rejected=tuple(turned_rejection(each, per) for each in self.rejected),
            log=log_as_torque(self.log, radius=radius, load=load),
            resolutions=tuple(_scaled(each, scaled) for each in self.resolutions),
            **{name: by * getattr(self, name) for name in _SHARED_ERRORS},
        )

    @takes_si()
    def against_hersey_number(self, viscosity: Viscous | float) -> SteadyPoints:
        """Return the points against the Hersey number: viscosity times speed over normal load, 1/m.

        Dwells at several temperatures and loads then share one Stribeck curve, if there is one.

        Parameters
        ----------
        viscosity
            A `hersey.Lubricant`, at the temperature of each dwell, or one viscosity, Pa s.

        Raises
        ------
        ParameterError
            If they are no friction coefficients against a speed in m/s, or lack loads or temperatures.

        Examples
        --------
        >>> table = {"speed [m/s]": [0.1, 0.2, 0.4], "COF": [0.12, 0.12, 0.12]}
        >>> points = SteadyPoints.from_table(table, load="10 N").against_hersey_number("20 mPa*s")
        >>> points.column("speed").tolist()
        [0.0002, 0.0004, 0.0008]
        """
        if not hasattr(viscosity, "temperature_exponent"):
            viscosity = float(argument("viscosity", "viscosity", viscosity, one=True))
        table, log = against_hersey_number(self.table, self.log, viscosity)
        return replace(
            self,
            table=table,
            log=log,
            rejected=tuple(replace(each, speed=float("nan")) for each in self.rejected),
            resolutions=tuple(each for each in self.resolutions if each.quantity == "torque"),
            temperature_rates=np.empty(0),
        )

    @property
    def varying_load(self) -> tuple[float, float] | None:
        """Least and greatest load of the dwells, N, if their ratio is beyond `SAME_LOAD`."""
        loads = self.table["load"].drop_nulls() if "load" in self.table.columns else pl.Series()
        if loads.is_empty():
            return None
        low, high = (float(np.asarray(loads).min()), float(np.asarray(loads).max()))
        return (low, high) if high > SAME_LOAD * low else None

    def dropped(self) -> str:
        """Return a sentence on the excluded dwells, their speeds and the reasons; empty if there are none."""
        lost = [r for r in self.rejected if r.is_dwell]
        if not lost:
            return ""
        speeds = np.abs([r.speed for r in lost])
        where = _placed(speeds, np.abs(self.column("speed")), self.domain)
        verb = "was" if len(lost) == 1 else "were"
        why = joined([r.why for r in lost])
        return f"{len(lost)} of {len(lost) + len(self)} dwells ({where}) {verb} excluded: {why}."

    def _unused(self) -> dict[str, int]:
        """Rows of every other stretch by its reason."""
        rows: dict[str, int] = {}
        for stretch in self.rejected:
            rows[stretch.reason] = rows.get(stretch.reason, 0) + stretch.rows
        return rows

    def to_dict(self) -> dict[str, Any]:
        """Return the dwells, what is excluded, and the tare, in SI."""
        plain = ("tare", "tare_error", "tare_errors", "warnings", "standing_torque", "rest", "rest_errors")
        return json_record(
            {"points": self.table.to_dicts(), "rejected": [record_of(r) for r in self.rejected]}
            | {name: getattr(self, name) for name in plain}
        )

    def to_frame(self) -> pl.DataFrame:
        """Return one row per dwell."""
        units = {
            "start": "s",
            "end": "s",
            "speed": self.domain.speed_unit,
            "torque": self.domain.unit or "1",
            "temperature": "K",
            "load": "N",
            "tare": self.domain.unit or "1",
        }
        units |= {f"{name}_error": units[name] for name in ("speed", "torque", "temperature")}
        names = {name: name.replace("_", " ").replace("torque", self.domain.quantity) for name in units}
        names["speed"], names["speed_error"] = self.domain.speed, f"{self.domain.speed} error"
        return self.table.rename({name: f"{names[name]} ({unit})" for name, unit in units.items()})


def _scaled(resolution: Resolution, by: dict[str, float]) -> Resolution:
    """The step of a sensor in another unit."""
    factor = by.get(resolution.quantity, 1.0)
    return replace(resolution, step=factor * resolution.step, errors=factor * resolution.errors)


def _stated(table: MeansTable, rotation: str) -> tuple[list[dict[str, object]], list[Rejection]]:
    """Rows of the table of steady points, and those that state no dwell asked for."""
    dwells: list[dict[str, object]] = []
    rejected = []
    for row in table.means:
        reason = _no_mean(row, rotation)
        if reason:
            rejected.append(Rejection(0, 0.0, 0.0, 1, reason, row.speed))
            continue
        hot = row.temperature is not None and table.has_temperature
        dwells.append(
            {
                "run": row.run,
                "start": 0.0,
                "end": 0.0,
                "speed": row.speed,
                "speed_error": 0.0,
                "torque": row.torque,
                "torque_error": row.torque_error,
                "temperature": row.temperature if hot else None,
                "temperature_error": 0.0 if hot else None,
                "rows": 1,
                "effective_rows": row.count,
                "settling_rows": 0,
                "approach": row.approach,
                "load": row.load,
                "tare": 0.0,
            }
        )
    return dwells, rejected


def _shared(table: MeansTable, rotation: str) -> FloatArray:
    """What one standard error that all rows of a table share does to each of them, N m."""
    used = [row for row in table.means if _no_mean(row, rotation) is None]
    columns = [
        [math.copysign(row.shared_error, row.torque) * (row.table == each) for row in used]
        for each in dict.fromkeys(row.table for row in used if row.shared_error)
    ]
    return np.array(columns).T if columns else np.empty((0, 0))


def _no_mean(row: MeanRow, rotation: str) -> Reason | None:
    """Why a row of a table of means is not used, or None."""
    if row.speed == 0.0:
        return Reason("standing")
    if rotation != "both" and (row.speed > 0) != (rotation == "forward"):
        return Reason("other rotation", asked=rotation)
    if row.torque == 0.0:
        return Reason("zero torque")
    if row.torque * row.speed < 0.0:
        return Reason("opposite signs")
    return None


def _of_means(table: MeansTable) -> Warning:
    """What a table of means cannot tell, and what it leaves out."""
    return Warning(
        "table of means",
        "a table of means, one row per dwell: stick-slip, drift, settling, torque zero and clock "
        "cannot be checked. Errors of torque: "
        + ("as stated" if table.stated_errors else "not stated; the scatter about the fit is used instead"),
        where=table.files[0].name + (f" and {len(table.files) - 1} more" if len(table.files) > 1 else ""),
        files=len(table.files),
    )


def _placed(lost: FloatArray, used: FloatArray, of: Domain) -> str:
    """Where the speeds of dwells not used lie beside those used."""
    every = "all " if lost.size > 1 else ""
    if lost.max() < used.min():
        return f"{every}below {of.at(float(used.min()))}"
    if lost.min() > used.max():
        return f"{every}above {of.at(float(used.max()))}"
    low, high = of.at(float(lost.min())), of.at(float(lost.max()))
    return f"at {low}" if low == high else f"at {of.between(float(lost.min()), float(lost.max()))}"
