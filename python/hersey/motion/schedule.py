"""Drive speed, torque or temperature against time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.units import takes_si

#: What a schedule may be one of.
_KINDS = ("belt speed", "speed", "temperature", "force", "torque")
#: Times, values, and cubics between them unless they are joined by straight lines.
ScheduleArguments = tuple[list[float], list[float], list[list[float]] | None]


@takes_si(times="time", values=_KINDS)
@dataclass(frozen=True, eq=False)
class Schedule:
    """A quantity at ``times``, joined by straight lines, or smoothly without overshoot if ``smooth``.

    The value is constant before the first and after the last time. Two equal times in a row make a jump (with
    straight lines only).

    Raises
    ------
    ParameterError
        If there is no point, a number is not finite, or time runs backwards.

    Examples
    --------
    >>> Schedule([0, 1, 3], [2.5, 2.5, 1.0]).at(2.0)
    1.75
    """

    times: ArrayLike
    values: ArrayLike
    smooth: bool = False

    def __post_init__(self) -> None:
        """Check the points and freeze them."""
        times, values = (np.atleast_1d(np.asarray(x, dtype=float)) for x in (self.times, self.values))
        if times.ndim != 1 or times.shape != values.shape:
            raise ParameterError(f"schedule: {times.size} times, but {values.size} values")
        if times.size == 0:
            raise ParameterError("schedule: there are no points")
        if not (np.isfinite(times).all() and np.isfinite(values).all()):
            raise ParameterError("schedule: a number is not finite")
        steps = np.diff(times)
        backwards = np.flatnonzero(steps <= 0 if self.smooth else steps < 0)
        if backwards.size:
            i = int(backwards[0]) + 1
            raise ParameterError(f"schedule: times must ascend, but {times[i]} follows {times[i - 1]}")
        if self.smooth and times.size < 2:
            raise ParameterError("schedule: a smooth schedule needs two points")
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "values", values)

    @classmethod
    def of(cls, given: float | Schedule) -> Schedule:
        """Return ``given`` as a schedule; a number becomes a constant one."""
        return given if isinstance(given, Schedule) else cls([0.0], [float(given)])

    def shifted(self, by: float) -> Schedule:
        """Return the schedule with every value moved."""
        return Schedule(self.times, np.asarray(self.values) + by, self.smooth)

    @property
    def first(self) -> float:
        """The value at time 0."""
        return self.at(0.0)

    @takes_si(time="time")
    def at(self, time: float) -> float:
        """Return the value at ``time``, before the jump if there is one."""
        times, values = self._points
        if self.smooth:
            from scipy.interpolate import PchipInterpolator

            return float(PchipInterpolator(times, values)(np.clip(time, times[0], times[-1])))
        return float(np.interp(time, times, values))

    @property
    def arguments(self) -> ScheduleArguments:
        """What the core takes."""
        times, values = self._points
        return times.tolist(), values.tolist(), self._cubics().tolist() if self.smooth else None

    def _cubics(self) -> FloatArray:
        from scipy.interpolate import PchipInterpolator

        return np.ascontiguousarray(PchipInterpolator(*self._points).c[::-1].T)

    @property
    def _points(self) -> tuple[FloatArray, FloatArray]:
        return np.asarray(self.times, dtype=float), np.asarray(self.values, dtype=float)
