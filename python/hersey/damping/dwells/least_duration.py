"""Speeds or temperatures that a log holds, but not for as long as was asked for."""

from __future__ import annotations

import math

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import MIN_DWELL, MIN_SAMPLES, distinct_speeds, groups_of_temperature
from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.dwells.rejection import Rejection
from hersey.errors import Setting
from hersey.log.torque_log import TorqueLog


def speeds_lost(points: SteadyPoints) -> str:
    """Return that a shorter least duration gives more speeds, and which to type; or an empty text."""
    speed, short = points.column("speed"), _too_short(points)
    every = np.abs(np.concatenate([speed, [each.speed for each in short]]))
    return _said(points, short) if distinct_speeds(every) > distinct_speeds(np.abs(speed)) else ""


def temperatures_lost(points: SteadyPoints) -> str:
    """Return that a shorter least duration gives more temperatures, and which to type; or an empty text."""
    kelvin, short = points.column("temperature"), _too_short(points)
    every = np.concatenate([kelvin, [_temperature(points, each) for each in short]])
    return _said(points, short) if _levels(every) > _levels(kelvin) else ""


def _too_short(points: SteadyPoints) -> list[Rejection]:
    """Dwells of the usual duration that are too short for the one asked for."""
    return [
        each
        for each in points.rejected
        if each.why.kind == "too short" and each.why.lasts >= MIN_DWELL and each.why.rows >= MIN_SAMPLES
    ]


def _said(points: SteadyPoints, short: list[Rejection]) -> str:
    enough = max(MIN_DWELL, math.floor(10.0 * min(each.why.lasts for each in short) - 0.5) / 10.0)
    how = Setting("min_dwell").to(f"{enough:g} s", python=f"{enough:g}")
    return (
        f"only {len(points)} of {len(points) + len(short)} dwells last {short[0].why.needed:g} s or more. "
        f"Use a shorter least duration, e.g. {how}"
    )


def _temperature(points: SteadyPoints, dwell: Rejection) -> float:
    """Mean temperature of a stretch, K."""
    assert isinstance(points.log, TorqueLog)
    run = points.log.runs[dwell.run]
    assert run.temperature is not None
    return float(np.mean(run.temperature[(run.time >= dwell.start) & (run.time <= dwell.end)]))


def _levels(kelvin: FloatArray) -> int:
    return sum(1 for _ in groups_of_temperature(kelvin))
