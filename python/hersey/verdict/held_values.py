"""Readings that keep one value where they should vary: a sensor at the end of its range, or a stuck one."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.cache.kept import kept
from hersey.damping.dwells import SteadyPoints
from hersey.inspection.faults import Fault, clipping, stuck
from hersey.log.counters import quantisation_step
from hersey.log.torque_log import Run
from hersey.schema.warning import Warning

#: Share of the rows of a dwell at the end of a range from which its mean counts as wrong.
NOTABLE = 0.01
#: Such dwells that are listed, at the most.
_LISTED = 4


def held_values(points: SteadyPoints) -> list[Warning]:
    """Return which channels of a log are clipped or stuck; often none.

    A clipped channel comes with the dwells that have `NOTABLE` of their rows at the end of its range.
    """
    log = points.log
    return [
        _stuck(name, fault, file.name)
        if fault.kind == "stuck"
        else _clipped(name, fault, file.name, _dwells_at(points, number, name, fault.value))
        for number, (file, run) in enumerate(zip(log.files, log.runs, strict=False))
        for name, fault in _faults(run)
    ]


def _stuck(name: str, fault: Fault, file: str) -> Warning:
    return Warning(
        fault.kind,
        ("{measured}" if name == "torque" else "{channel}")
        + " is {fault} at "
        + ("{value:.4g degC}" if name == "temperature" else "{value:.4g N m}")
        + " for {rows} rows, so its true value there is unknown",
        severity="watch",
        where=file,
        channel=name,
        fault=fault.kind,
        value=float(fault.value),
        rows=int(fault.rows),
    )


def _clipped(name: str, fault: Fault, file: str, dwells: list[str]) -> Warning:
    """A channel at the end of its range, with the dwells that reach it."""
    return Warning(
        fault.kind,
        ("{measured}" if name == "torque" else "{channel}")
        + " is {fault} at "
        + ("{value:.4g degC}" if name == "temperature" else "{value:.4g N m}")
        + " in {rows} rows, where the range of sensor or logger ends"
        + (
            ". {dwells} {dwells:dwell reaches this value and is|dwells reach this value and are} wrong: "
            "{first}"
            if dwells
            else ""
        )
        + (" and {others} more" if len(dwells) > _LISTED else ""),
        severity="act" if dwells else "watch",
        remedy="record {dwells:it|them} again with a wider range, or delete {dwells:its|their} rows"
        if dwells
        else "no dwell reaches this value",
        where=file,
        channel=name,
        fault=fault.kind,
        value=float(fault.value),
        rows=int(fault.rows),
        dwells=len(dwells),
        first=", ".join(dwells[:_LISTED]),
        others=max(0, len(dwells) - _LISTED),
    )


def _dwells_at(points: SteadyPoints, number: int, name: str, end: float) -> list[str]:
    """The dwells of a run in which a channel is at the end of its range: their speeds and times."""
    run = points.log.runs[number]
    time, at_end = run.time, getattr(run, name) == end
    return [
        f"{points.domain.at(abs(speed))} at {start:.6g} to {last:.6g} s"
        for of, start, last, speed in points.table.select("run", "start", "end", "speed").iter_rows()
        if of == number and np.mean(at_end[(time >= start) & (time <= last)]) >= NOTABLE
    ]


@kept()
def _faults(run: Run) -> list[tuple[str, Fault]]:
    """Name of the channel, and the fault."""
    torque = [("torque", each) for each in _of(run.torque, stands=True)]
    if run.temperature is None:
        return torque
    return torque + [("temperature", each) for each in _of(run.temperature, stands=False)]


def _of(values: FloatArray, *, stands: bool) -> list[Fault]:
    if values.size < 2 or values.min() == values.max():
        return []
    step = quantisation_step(values)
    return [*clipping(values, step, stands=stands), *stuck(values, step, stands=stands)]
