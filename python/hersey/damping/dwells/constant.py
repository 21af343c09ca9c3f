"""Whether torque and temperature of dwells vary at all: a channel that stands still measures nothing."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.points import SteadyPoints
from hersey.errors import InsufficientDataError, Setting
from hersey.log.channels import is_dead
from hersey.units import celsius

#: Differences below this share of a reading are rounding of the arithmetic.
ROUNDING = 1e-9


def constant_torque(points: SteadyPoints) -> float | None:
    """Return the torque, N m, that all readings of all dwells show but for one step, or None if they vary.

    A friction that is constant shows more: the noise of its sensor. Readings that flicker between two values
    within a dwell are a step apart; two values of which each dwell holds one are a friction that changes.
    """
    dwells = _readings(points)
    low = min(float(each.min()) for each in dwells)
    high = max(float(each.max()) for each in dwells)
    least = ROUNDING * max(abs(low), abs(high))
    if high - low <= least:
        return high
    two = not any(np.any((each > low + least) & (each < high - least)) for each in dwells)
    flickers = any(float(np.ptp(each)) > least for each in dwells)
    return 0.5 * (low + high) if two and flickers else None


def refuse_constant_torque(points: SteadyPoints) -> None:
    """Raise if torque does not vary.

    Raises
    ------
    InsufficientDataError
        It says at which torque it stands.
    """
    torque = constant_torque(points)
    if torque is not None:
        raise InsufficientDataError(
            f"{points.log.files[0].name}: {points.domain.quantity} ({_name(points, 'torque')}) "
            f"reads {points.domain.small(torque, '.4g')} "
            "at all speeds, within its resolution, so it does not measure friction. Check the sensor, "
            f"or name another column with {Setting('torque', 'channel').to()}"
        )


def _readings(points: SteadyPoints) -> list[FloatArray]:
    """Torque of the rows of each dwell without the sign of the rotation, N m; of means alone these."""
    if not points.log.runs or not {"start", "end"} <= set(points.table.columns):
        return list(np.abs(points.column("torque"))[:, None])
    parts = []
    for index, start, end in points.table.select("run", "start", "end").iter_rows():
        run = points.log.runs[index]
        rows = slice(np.searchsorted(run.time, start), np.searchsorted(run.time, end, side="right"))
        parts.append(run.torque[rows] * np.sign(np.mean(run.speed[rows])))
    return parts


def dead_temperature(points: SteadyPoints) -> str:
    """Return that the temperature is the same in every row of a recorded log; empty if it is not."""
    recorded = [run.temperature for run in points.log.runs if run.temperature is not None]
    if not recorded or not is_dead(np.concatenate(recorded)):
        return ""
    reads = f"{celsius(float(recorded[0][0])):.4g} degC"
    return f"{_name(points, 'temperature')} reads {reads} in every row, so the sensor may be dead"


def _name(points: SteadyPoints, role: str) -> str:
    """The channel of a role as the file has it."""
    return next((f"'{c.name}'" for c in points.log.files[0].channels if c.role == role), role)
