"""Readings that keep one value where they should vary: a sensor at the end of its range, or a stuck one."""

from __future__ import annotations

from hersey.arrays import FloatArray
from hersey.damping.dwells.resolution import quantisation_step
from hersey.inspection.faults import Fault, clipping, stuck
from hersey.log.means import MeansTable
from hersey.log.torque_log import Run, TorqueLog
from hersey.units import celsius


def held_values(log: TorqueLog | MeansTable) -> list[str]:
    """Return in sentences which channels of a log are clipped or stuck; often none."""
    out = []
    for file, run in zip(log.files, log.runs, strict=False):
        for name, shown, fault in _faults(run):
            rows = f"{fault.rows} rows"
            why = (
                "what it was there is not known"
                if fault.kind == "stuck"
                else "the range of sensor or logger ends there, and dwells at it are wrong"
            )
            out.append(f"{file.name}: {name} is {fault.kind} at {shown} for {rows}: {why}.")
    return out


def _faults(run: Run) -> list[tuple[str, str, Fault]]:
    """Name of the channel, the value in words, and the fault."""
    torque = [("torque", f"{each.value:.4g} N m", each) for each in _of(run.torque, stands=True)]
    if run.temperature is None:
        return torque
    heat = _of(run.temperature, stands=False)
    return torque + [("temperature", f"{celsius(each.value):.4g} degC", each) for each in heat]


def _of(values: FloatArray, *, stands: bool) -> list[Fault]:
    if values.size < 2 or values.min() == values.max():
        return []
    step = quantisation_step(values)
    return [*clipping(values, step, stands=stands), *stuck(values, step, stands=stands)]
