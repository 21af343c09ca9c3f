"""Numbers that would be ordinary in another unit than the one they are read in."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import Setting
from hersey.log.means import MeansTable
from hersey.log.torque_log import Run, TorqueLog
from hersey.schema.warning import Warning
from hersey.units import celsius

#: A log of a drive has rows more often than so, s, and no lubricant is hotter, degC.
RARE, TOO_HOT = 10.0, 320.0
#: Share of the temperatures that is looked at: a spike of the sensor is no unit.
_MOST = 0.99
#: A torque beyond this, N m, at no speed beyond that, rad/s, is of few drives; and nearly all of them hold
#: their speed more closely than this share of what the torque does from row to row.
_GREAT, _SLOW, _STEADIER = 10.0, 0.1, 1.0 / 3.0


def doubtful_units(log: TorqueLog | MeansTable) -> list[Warning]:
    """Return which unit of a log is doubtful, with the option that mends it; often none."""
    out = []
    steps = [run.sampling_interval for run in log.runs]
    if steps and min(steps) >= RARE:
        out.append(
            Warning(
                "unit of time doubtful",
                "the clock gives one row every {interval:.4g} s, which is unusually slow",
                severity="watch",
                remedy="if it counts milliseconds, use {how:ms}",
                interval=min(steps),
                how=Setting("time", "unit"),
            )
        )
    hottest = max((float(np.quantile(each, _MOST)) for each in _temperatures(log)), default=0.0)
    if celsius(hottest) > TOO_HOT:
        out.append(
            Warning(
                "unit of temperature doubtful",
                "temperature reaches {temperature:.0f degC}, more than a lubricant withstands",
                severity="watch",
                remedy="if the numbers are in K, use {how:K}",
                temperature=hottest,
                how=Setting("temperature", "unit"),
            )
        )
    if any(_look_exchanged(run) for run in log.runs):
        out.append(
            Warning(
                "torque and speed exchanged",
                "torque is large and steadier than speed, and speed is almost zero",
                severity="watch",
                remedy="check whether the torque and speed columns are swapped",
            )
        )
    return out


def _look_exchanged(run: Run) -> bool:
    """Whether what is called a torque behaves as a speed does, and the other way round."""
    torque, speed = np.abs(run.torque), np.abs(run.speed)
    if torque.size < 3 or np.quantile(torque, _MOST) < _GREAT or np.quantile(speed, _MOST) > _SLOW:
        return False
    return _unrest(torque) < _STEADIER * _unrest(speed)


def _unrest(values: FloatArray) -> float:
    """Median change from row to row over the median."""
    return float(np.median(np.abs(np.diff(values)))) / max(float(np.median(values)), 1e-300)


def _temperatures(log: TorqueLog | MeansTable) -> list[FloatArray]:
    """The temperatures of each run, or of the rows of a table, K; none unless all have one."""
    if not log.has_temperature:
        return []
    if isinstance(log, MeansTable):
        return [np.array([row.temperature for row in log.means], dtype=float)]
    return [run.temperature for run in log.runs if run.temperature is not None]
