"""A warm-up as it was found: the course of drive speed and temperatures, its words and its table."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.motion.schedule import Schedule
from hersey.motion.trajectory import Trajectory
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import celsius

if TYPE_CHECKING:
    import polars as pl

#: Points of the temperature profile for a plan.
_OF_PROFILE = 101
#: Rows of the summary.
_ROWS = 12


@dataclass(frozen=True, repr=False)
class WarmUp(Result):
    """A profile of drive speed from a cold start, with its temperatures.

    SI; arrays have shape (points,). ``force_limit`` is kept with a reserve of ``margin``.
    """

    also_stated = ("verdict", "beside")
    not_stated = ("response",)

    target_speed: float
    force_limit: float
    margin: Annotated[float, Means("share of the limit kept in reserve")]
    acceleration: Annotated[float, Means(unit="m/s^2")]
    time: FloatArray
    drive_speed: Annotated[FloatArray, Means("joined by straight lines", shape="(n,)")]
    film_temperature: FloatArray
    roll_temperature: FloatArray
    drag: Annotated[FloatArray, Means("in steady sliding; null at standstill", shape="(n,)", open=True)]
    start: Annotated[float, Means("when the drive starts; null if it cannot", open=True)]
    full_speed: Annotated[
        float, Means("when it is reached; null if not within the time simulated", open=True)
    ]
    slides_from: Annotated[float, Means("when steady sliding begins; null if never", open=True)]
    peak_force: Annotated[float, Means("largest, of the spring")]
    drag_at_once: Annotated[float, Means("largest, if run at full speed from the start")]
    within_at_once: Annotated[
        float, Means("when that stays within the limit; null if not in time", open=True)
    ]
    full_speed_standing: Annotated[
        float, Means("when reached by standing until warm; null if not in time", open=True)
    ]
    rounds: int
    warnings: tuple[Warning, ...]
    response: Trajectory

    @property
    def found(self) -> bool:
        """Whether full speed is reached, and the belt slides."""
        return math.isfinite(max(self.full_speed, self.slides_from))

    @property
    def schedule(self) -> Schedule:
        """Drive speed against time, m/s."""
        return Schedule(self.time, self.drive_speed)

    @property
    def profile(self) -> Schedule:
        """Film temperature against time, K, thinned: the ``temperature`` of `plan_profile`."""
        kept = np.unique(np.linspace(0, self.time.size - 1, _OF_PROFILE).round().astype(int))
        return Schedule(self.time[kept], self.film_temperature[kept])

    def verdict(self) -> str:
        """Return the profile in a sentence or two."""
        end = _temperature_words(self, -1)
        target = _speed(self.target_speed)
        if not math.isfinite(self.start):
            return (
                f"The drive cannot start within {self.time[-1]:.4g} s: even at {end}, reached by then, "
                f"drag is below {self.kept_below:.4g} N at no speed up to {target}."
            )
        first = "Start at once" if self.start == 0 else f"Wait {self.start:.4g} s, then start"
        if not math.isfinite(self.full_speed):
            last = _speed(float(self.drive_speed[-1]))
            return f"{first}; {target} is not reached within {self.time[-1]:.4g} s, only {last} at {end}."
        at = int(np.searchsorted(self.time, self.full_speed))
        sliding = "" if math.isfinite(self.slides_from) else " It sticks there."
        how = "" if self.full_speed - self.start <= self._least_ramp else ", slowly until warm"
        when = f"full speed {target} after {self.full_speed:.4g} s, at {_temperature_words(self, at)}"
        return f"{first}{how}: {when}.{sliding}"

    @property
    def kept_below(self) -> float:
        """Limit minus margin, N."""
        return self.force_limit * (1.0 - self.margin)

    @property
    def _least_ramp(self) -> float:
        """Time that the acceleration alone takes, and the points of the course make of it, s."""
        return self.target_speed / self.acceleration + 2.0 * float(self.time[1])

    def beside(self) -> list[str]:
        """Return the results of the two alternatives, a sentence each."""
        times = self.drag_at_once / self.force_limit
        if not math.isfinite(self.within_at_once):
            until = f"not below the limit within {self.time[-1]:.4g} s"
        else:
            until = (
                f"below the limit after {self.within_at_once:.4g} s"
                if self.within_at_once > 0
                else "below the limit"
            )
        at_once = f"Full speed at once: {self.drag_at_once:.4g} N, {times:.3g} times the limit, {until}."
        if not math.isfinite(self.full_speed_standing):
            return [at_once, f"Waiting until warm: full speed is not reached within {self.time[-1]:.4g} s."]
        return [at_once, f"Waiting until warm: full speed after {self.full_speed_standing:.4g} s."]

    def table(self) -> str:
        """Return the profile as CSV, which `hersey plan --temperature-profile` can read."""
        lines = ["time [s],drive speed [m/s],temperature [degC],roll [degC]"]
        columns = (
            self.time,
            self.drive_speed,
            celsius(self.film_temperature),
            celsius(self.roll_temperature),
        )
        lines += [",".join(f"{value:.9g}" for value in row) for row in zip(*columns, strict=True)]
        return "\n".join(lines) + "\n"

    def summary(self) -> str:
        """Return the profile, its limits, alternatives and warnings as text."""
        limit = f"{self.force_limit:.4g} N less {100 * self.margin:.3g} %"
        lines = [self.verdict(), f"Drag stays below {self.kept_below:.4g} N ({limit}).", *self.beside(), ""]
        if not math.isfinite(self.start):
            del lines[1]
        lines.append(
            f"  {'time (s)':>9s}  {'drive (mm/s)':>12s}  {'film (degC)':>11s}  {'counterbody (degC)':>18s}"
        )
        last = min(self.time.size - 1, int(np.searchsorted(self.time, self.full_speed)))
        for i in np.unique(np.linspace(0, last, _ROWS).round().astype(int)).tolist():
            film, roll = celsius(self.film_temperature[i]), celsius(self.roll_temperature[i])
            lines.append(
                f"  {self.time[i]:9.4g}  {1e3 * self.drive_speed[i]:12.4g}  {film:11.1f}  {roll:18.1f}"
            )
        return "\n".join([*lines, *(f"- {warning}" for warning in self.warnings)])

    def headline(self) -> str:
        """Return target and time."""
        target = f"warm-up to {_speed(self.target_speed)}"
        return f"{target}, {self.full_speed:.4g} s" if self.found else f"{target}: not reached"

    def to_frame(self) -> pl.DataFrame:
        """Return the profile, one row per point."""
        import polars as pl

        return pl.DataFrame(
            {
                "time (s)": self.time,
                "drive speed (m/s)": self.drive_speed,
                "film (K)": self.film_temperature,
                "roll (K)": self.roll_temperature,
                "drag (N)": self.drag,
            }
        )


def _temperature_words(warm: WarmUp, at: int) -> str:
    film, roll = celsius(warm.film_temperature[at]), celsius(warm.roll_temperature[at])
    return f"{film:.4g} degC (counterbody {roll:.4g} degC)"


def _speed(speed: float) -> str:
    return f"{1e3 * speed:.4g} mm/s"
