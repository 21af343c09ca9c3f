"""Whether a log is reduced to dwells, or fitted to every sample since its speed hardly ever holds."""

from __future__ import annotations

from collections.abc import Callable

from hersey.damping.dwells import SteadyPoints
from hersey.damping.fit import fit
from hersey.damping.moving.result import MovingFit
from hersey.errors import MOVING, HerseyError, InsufficientDataError

#: Share of the rows in dwells below which a log moves all the time, if no law can be fitted to these dwells.
HELD = 0.3


def held_or_moving(
    rows: int, dwells: Callable[[], SteadyPoints], moving: Callable[[], MovingFit]
) -> SteadyPoints | MovingFit:
    """Return the dwells of a log of so many rows, or the fit to every sample if it moves all the time.

    Raises
    ------
    InsufficientDataError
        If there is no dwell, and the log does not move or friction cannot be fitted to its motion.
    """
    points = None
    try:
        points = dwells()
        if float(points.column("rows").sum()) < HELD * rows:
            fit(points)
        return points
    except InsufficientDataError as error:
        if points is None and error.setting != MOVING:
            raise
        try:
            return moving()
        except HerseyError:
            if points is None:
                raise error from None
            return points
