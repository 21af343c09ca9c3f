"""Numbers that would be ordinary in another unit than the one they are read in."""

from __future__ import annotations

import re

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import Setting
from hersey.log.believed import TENTHS, as_written, in_si
from hersey.log.means import MeansTable
from hersey.log.roles import EVERY, is_frequency, is_of_kind
from hersey.log.torque_log import NO_CLOCK, Channel, TorqueLog
from hersey.schema.warning import Warning
from hersey.units import celsius, conversion

#: A log of a drive has rows more often than so, s, and no lubricant is hotter, degC.
RARE, TOO_HOT = 10.0, 320.0
#: No drive is colder, and one that starts cold starts between these, degC.
TOO_COLD, ROOM = -60.0, (5.0, 40.0)
#: One revolution per second, rad/s.
_TURN = conversion("speed", "rev/s").scale
#: Share of the temperatures that is looked at: a spike of the sensor is no unit.
_MOST = 0.99


def doubtful_units(log: TorqueLog | MeansTable) -> list[Warning]:
    """Return which unit of a log is doubtful, with the option that mends it; often none."""
    out = []
    steps = [run.sampling_interval for run in log.runs]
    if steps and min(steps) >= RARE:
        out.append(_slow(min(steps), stated=any(c.name == NO_CLOCK for c in log.files[0].channels)))
    electrical = next((c.name for c in log.files[0].channels if _may_be_electrical(c)), "")
    if electrical:
        out.append(
            Warning(
                "pole pairs doubtful",
                "'{channel}' is a frequency, read as revolutions per second; that of an inverter is higher, "
                "by the pole pairs of the motor",
                severity="watch",
                remedy="divide its unit by them, e.g. for 2 use {how:rev/s/2}; for 1 use {how:rev/s/1}",
                channel=electrical,
                how=Setting("speed", "unit"),
            )
        )
    temperatures = _temperatures(log)
    hottest = max((float(np.quantile(each, _MOST)) for each in temperatures), default=0.0)
    if celsius(hottest) > TOO_HOT:
        coldest = min(float(np.quantile(each, 1.0 - _MOST)) for each in temperatures)
        first, second, *_ = (*_likely_units(log, coldest, hottest), None, None)
        out.append(
            Warning(
                "unit of temperature doubtful",
                "temperature reaches {temperature:.0f degC}, more than a lubricant withstands",
                severity="watch",
                remedy="if the numbers are in {first}, use {how:{first}}; if in {second}, use {how:{second}}"
                if second
                else "if the numbers are in {first}, use {how:{first}}"
                if first
                else "check the column and its unit",
                temperature=hottest,
                first=first,
                second=second,
                how=Setting("temperature", "unit"),
            )
        )
    return out


def _slow(interval: float, *, stated: bool) -> Warning:
    """A time between rows that no logger of a drive has, read from a column or stated for all rows."""
    words = "the clock gives one row every {interval:.4g} s, which is unusually slow"
    remedy = "if it counts milliseconds, use {how:ms}"
    if stated:
        words = "rows are {interval:.4g} s apart ({how}), which is unusually slow"
        remedy = "if that is milliseconds, use {how:{meant}}"
    return Warning(
        "unit of time doubtful",
        words,
        severity="watch",
        remedy=remedy,
        interval=interval,
        meant=f"{interval:.6g} ms",
        how=EVERY if stated else Setting("time", "unit"),
    )


def _may_be_electrical(channel: Channel) -> bool:
    """Whether a speed is called a frequency, and read in revolutions that no number divides."""
    if channel.role != "speed" or not is_frequency(channel.name) or re.search(r"/\s*\d", channel.unit):
        return False
    return is_of_kind("speed", channel.unit) and conversion("speed", channel.unit).scale == _TURN


def _likely_units(log: TorqueLog | MeansTable, coldest: float, hottest: float) -> list[str]:
    """The units in which temperatures, K as read, would be those of a lubricant; from a cold start if any."""
    read_as = next((c.unit for c in log.files[0].channels if c.role == "temperature"), "")
    if not read_as:
        return []
    written = as_written(np.array([coldest, hottest]), conversion("temperature", read_as))
    ends = {unit: in_si(written, conversion("temperature", unit)) for unit in ("K", "degF", "degC", *TENTHS)}
    degrees = {unit: (celsius(low), celsius(high)) for unit, (low, high) in ends.items()}
    likely = {unit: (low, high) for unit, (low, high) in degrees.items() if low > TOO_COLD and high < TOO_HOT}
    cold = [unit for unit, (low, high) in likely.items() if ROOM[0] < low < ROOM[1] < high]
    whole = [unit for unit in likely if unit not in TENTHS]
    return [u for u in cold if u in whole] or cold + whole or list(likely)


def _temperatures(log: TorqueLog | MeansTable) -> list[FloatArray]:
    """The temperatures of each run, or of the rows of a table, K; none unless all have one."""
    if not log.has_temperature:
        return []
    if isinstance(log, MeansTable):
        return [np.array([row.temperature for row in log.means], dtype=float)]
    return [run.temperature for run in log.runs if run.temperature is not None]
