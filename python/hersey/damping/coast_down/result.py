"""What coast-downs tell of friction: its terms, torque against speed, and points for `hersey.fit`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.coast_down.coasts import Coast, LeftOut, rows_averaged
from hersey.damping.coast_down.departures import deceleration
from hersey.damping.coast_down.fitting import TERMS, CoastFit
from hersey.damping.coast_down.windows import Window
from hersey.damping.distributions import student_quantile
from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.dwells.reasons import Reason
from hersey.damping.dwells.rejection import Rejection
from hersey.damping.estimate import CONFIDENCE, Estimate
from hersey.damping.inertia import NORMAL
from hersey.errors import InsufficientDataError
from hersey.log.torque_log import Correction, TorqueLog
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import celsius, rpm, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Names of the terms, in order, with their units.
COULOMB, VISCOUS, WINDAGE = "Coulomb", "viscous", "windage"
NAMES = (COULOMB, VISCOUS, WINDAGE)
UNITS = ("N m", "N m s/rad", "N m s^2/rad^2")
#: Speeds at which the torque is stated.
_SPEEDS = 40


@dataclass(frozen=True)
class Friction:
    """The law with its errors: coefficients of the torque, none negative, and how they were found.

    ``covariance`` is that of the fit without a bound, whose coefficients are ``free``; ``shared`` is the
    standard error of all torques together as a share: of the inertia, and of coasts that differ.
    """

    law: FloatArray
    free: FloatArray
    covariance: FloatArray
    freedom: float
    shared: float

    def estimate(self, weights: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return value, standard error and 95 % limits of sums of the coefficients, one for each row.

        The limits are those of the fit without a bound, as far as they are not negative, so they hold for a
        term that is truly 0 as for any other. A fit that lies far below the bound counts as one standard
        error below it: its limit would promise more than the data can show.
        """
        value, centre = weights @ self.law, weights @ self.free
        own = np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", weights, self.covariance, weights), 0.0))
        quantile = float(student_quantile(0.5 + CONFIDENCE / 2, self.freedom))
        half = np.hypot(quantile * own, NORMAL * self.shared * np.abs(value))
        low = np.maximum(np.minimum(centre, value + own) - half, 0.0)
        high = np.maximum(centre, value - own) + half
        return value, np.hypot(own, self.shared * value), low, high


@dataclass(frozen=True, repr=False)
class CoastDown(Result):
    """Friction torque T = T_0 + k w + q w^2 of a wheel that coasts down; arrays have shape (n,).

    A term whose interval begins at 0 is not shown to be there; the upper end is its limit.
    """

    also_stated = ("terms_shown",)
    not_stated = ("friction", "fit", "windows", "log")

    inertia: Annotated[Estimate, Means("moment of inertia as stated", "kg m^2")]
    coulomb: Annotated[Estimate, Means("constant friction torque T_0", "N m")]
    viscous: Annotated[Estimate, Means("linear coefficient k", "N m s/rad")]
    windage: Annotated[Estimate, Means("quadratic coefficient q", "N m s^2/rad^2")]
    speeds: Annotated[FloatArray, Means("speeds of the torque below", "rad/s")]
    torque: Annotated[FloatArray, Means("friction torque", "N m")]
    low: Annotated[FloatArray, Means("95 % limit at each speed", "N m")]
    high: Annotated[FloatArray, Means("95 % limit at each speed", "N m")]
    coasts: Annotated[tuple[Coast, ...], Means("one for each coast-down that was found")]
    left_out: Annotated[tuple[LeftOut, ...], Means("stretches of the log that are no coast")]
    noise: Annotated[float, Means("standard deviation of the speeds about the fit", "rad/s")]
    effective_rows: Annotated[float, Means("rows of independent noise that tell as much")]
    difference: Annotated[float, Means("standard deviation of the torque between coasts, as a share")]
    warnings: tuple[Warning, ...]
    friction: Friction
    fit: CoastFit
    windows: tuple[Window, ...]
    log: TorqueLog

    @property
    def terms_shown(self) -> Annotated[tuple[str, ...], Means("terms that are shown to be there")]:
        """Names of the terms whose interval does not reach 0."""
        terms = (self.coulomb, self.viscous, self.windage)
        return tuple(name for name, term in zip(NAMES, terms, strict=True) if term.low > 0)

    @takes_si(speed="speed")
    def torque_at(self, speed: FloatArray | float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the friction torque, N m, at speeds, rad/s, and its pointwise 95 % limits.

        Examples
        --------
        >>> import numpy as np, polars as pl, hersey
        >>> time = np.arange(0.0, 30.0, 0.05)
        >>> log = pl.DataFrame({"time [s]": time, "speed [rad/s]": 100.0 * np.exp(-0.1 * time)})
        >>> found = hersey.coast_down(log, inertia="0.01 kg*m^2")
        >>> [round(float(each[0]), 3) for each in found.torque_at("50 rad/s")]
        [0.05, 0.05, 0.05]
        """
        at = np.atleast_1d(np.asarray(speed, dtype=float))
        value, _, low, high = self.friction.estimate(at[:, None] ** np.arange(TERMS))
        return value, low, high

    def points(self) -> SteadyPoints:
        """Return the friction in windows of speed as steady points, for `hersey.fit` and the rest.

        Windows share no row, so the errors in the table are independent. What all of them share, the error
        of the inertia and the difference between coasts, is in ``window_errors``; all other rows of the log
        are in ``rejected``, with the reason.

        Raises
        ------
        InsufficientDataError
            If no window determines its torque.
        """
        import polars as pl

        if not self.windows:
            raise InsufficientDataError(
                f"{self.log.files[0].name}: no window of speed determines its torque. Record more coasts"
            )
        torque = np.array([self.inertia.value * each.rate for each in self.windows])
        table = pl.DataFrame(
            [self._row(each) for each in self.windows],
            schema_overrides={"temperature": pl.Float64, "temperature_error": pl.Float64, "load": pl.Float64},
        )
        runs = []
        for run in self.log.runs:
            own = np.sign(run.speed) * self.friction_torque(np.abs(run.speed))
            runs.append(replace(run, torque=own))
        made = Correction(
            "torque from coast-down", (("moment_of_inertia", f"{self.inertia.value:g} kg m^2"),), ()
        )
        exact = replace(
            self.log.sensors, torque_gain=0.0, torque_zero=0.0, stated=("torque", *self.log.sensors.stated)
        )
        done = (*self.log.corrections, made)
        log = replace(self.log, runs=tuple(runs), corrections=done, sensors=exact)  # no sensor of a torque
        signs = np.sign(table["speed"].to_numpy())
        shared = (self.friction.shared * torque * signs)[:, None]
        return SteadyPoints(
            table,
            self._rejected(table),
            0.0,
            None,
            log,
            warnings=self.warnings,
            window_errors=shared if shared.any() else np.empty((0, 0)),
            temperature_rates=np.zeros(torque.size),
            of_every_sample=True,
        )

    def table(self) -> str:
        """Return the points as a table of means, CSV, which ``hersey fit --means`` reads.

        A column holds the standard error that all torques share; a comment says what is excluded.
        """
        points = self.points()
        columns = {"speed [rpm]": rpm(points.column("speed"))}
        if points.table["temperature"].null_count() == 0:
            columns["temperature [degC]"] = celsius(points.column("temperature"))
        columns |= {
            "torque [N*m]": points.column("torque"),
            "torque error [N*m]": points.column("torque_error"),
        }
        if points.window_errors.size:
            columns["shared torque error [N*m]"] = np.abs(points.window_errors[:, 0])
        lines = [
            f"# coast-down: windows of speed; moment of inertia {self.inertia.value:g} kg m^2",
            *(
                f"# excluded: {each.rows} rows at {each.start:.7g} to {each.end:.7g} s, {each.reason}"
                for each in points.rejected
            ),
            ",".join(columns),
        ]
        rows = zip(*columns.values(), strict=True)
        return "\n".join([*lines, *(",".join(f"{each:.7g}" for each in row) for row in rows), ""])

    def friction_torque(self, speed: FloatArray) -> FloatArray:
        """Return the friction torque, N m, of the fitted law at speeds, rad/s."""
        return deceleration(self.friction.law, speed)

    def _row(self, window: Window) -> dict[str, object]:
        """A window as a steady point."""
        coast, inertia = self.coasts[window.coast], self.inertia.value
        sign = 1.0 if coast.forward else -1.0
        rows = window.end - window.start
        raw = rows * rows_averaged(self.log.runs[coast.run])
        of_noise = max(1.0, self.fit.noise.rows / self.fit.noise.effective_rows)
        first, last = coast.start + coast.time[window.start], coast.start + coast.time[window.end - 1]
        hot = self._temperature(coast.run, float(first), float(last))
        return {
            "run": coast.run,
            "start": float(first),
            "end": float(last),
            "speed": sign * window.speed,
            "speed_error": window.speed_error,
            "torque": sign * inertia * window.rate,
            "torque_error": inertia * window.rate_error,
            "temperature": hot,
            "temperature_error": None if hot is None else 0.0,
            "rows": raw,
            "effective_rows": rows / of_noise,
            "settling_rows": 0,
            "approach": "from above",
            "load": None,
            "tare": 0.0,
        }

    def _rejected(self, table: pl.DataFrame) -> tuple[Rejection, ...]:
        """Stretches that are no coast, and rows of coasts in no window."""
        found = [Rejection(e.run, e.start, e.end, e.rows, Reason(e.why)) for e in self.left_out]
        for index, run in enumerate(self.log.runs):
            used = int(table.filter(table["run"] == index)["rows"].sum())
            left = run.time.size - used - sum(each.rows for each in found if each.run == index)
            coasts = [each for each in self.coasts if each.run == index]
            if left > 0:
                start = coasts[0].start if coasts else float(run.time[0])
                end = coasts[-1].end if coasts else float(run.time[-1])
                found.append(Rejection(index, start, end, left, Reason("no window")))
        return tuple(sorted(found, key=lambda each: (each.run, each.start)))

    def _temperature(self, run: int, start: float, end: float) -> float | None:
        """Mean temperature between two times, K."""
        of = self.log.runs[run]
        if of.temperature is None or not self.log.has_temperature:
            return None
        inside = (of.time >= start) & (of.time <= end)
        return float(of.temperature[inside].mean())

    def summary(self) -> str:
        """Return terms, torque and warnings as text."""
        lines = [self.headline()]
        for name, unit, term in zip(NAMES, UNITS, (self.coulomb, self.viscous, self.windage), strict=True):
            shown = f"{term} {unit}" if term.low > 0 else f"not shown, at most {term.high:.3g} {unit}"
            lines.append(f"  {name}: {shown}")
        for i in (0, self.speeds.size // 2, self.speeds.size - 1):
            ends = f"[{self.low[i]:.4g}, {self.high[i]:.4g}]"
            lines.append(f"  at {rpm(float(self.speeds[i])):.4g} rpm: {self.torque[i]:.4g} {ends} N m")
        return "\n".join([*lines, *(f"- {warning.sentence}" for warning in self.warnings)])

    def headline(self) -> str:
        """Return the number of coasts, their speeds and the torque."""
        slow, fast = (rpm(float(end)) for end in (self.speeds[0], self.speeds[-1]))
        count = len(self.coasts)
        return (
            f"{count} coast{'s' if count > 1 else ''} from {fast:.4g} rpm to {slow:.4g} rpm: friction torque "
            f"{self.torque[-1]:.3g} N m falling to {self.torque[0]:.3g} N m"
        )

    def to_frame(self) -> pl.DataFrame:
        """Return the friction torque with its limits at each speed."""
        import polars as pl

        return pl.DataFrame(
            {
                "speed (rad/s)": self.speeds,
                "torque (N m)": self.torque,
                "torque low (N m)": self.low,
                "torque high (N m)": self.high,
            }
        )


def estimates_of(friction: Friction, speeds: FloatArray, most: FloatArray) -> list[Estimate]:
    """Return the coefficients with their intervals.

    No term exceeds the whole torque, whose upper limits at speeds are ``most``: at the slowest for the
    constant term, at the fastest for the others.
    """
    found = []
    for power, each in enumerate(zip(*friction.estimate(np.eye(TERMS)), strict=True)):
        value, error, low, high = map(float, each)
        end = 0 if power == 0 else -1
        limit = max(float(most[end] / speeds[end] ** power), value)
        found.append(Estimate(value, error, low, min(high, limit), friction.freedom))
    return found


def speeds_of(fit: CoastFit) -> FloatArray:
    """Return the speeds at which the torque is stated, over the range of the coasts."""
    ends = [fit.predicted(i, trace.time[[0, -1]]) for i, trace in enumerate(fit.traces)]
    slowest, fastest = min(float(e[1]) for e in ends), max(float(e[0]) for e in ends)
    return np.geomspace(max(slowest, 1e-4 * fastest), fastest, _SPEEDS)
