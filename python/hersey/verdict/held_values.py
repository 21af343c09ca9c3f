"""Readings that keep one value where they should vary: a sensor at the end of its range, or a stuck one."""

from __future__ import annotations

from hersey.arrays import FloatArray
from hersey.damping.dwells.resolution import quantisation_step
from hersey.inspection.faults import Fault, clipping, stuck
from hersey.log.means import MeansTable
from hersey.log.torque_log import Run, TorqueLog
from hersey.schema.warning import Warning


def held_values(log: TorqueLog | MeansTable) -> list[Warning]:
    """Return which channels of a log are clipped or stuck; often none."""
    return [
        _said(name, fault, file.name)
        for file, run in zip(log.files, log.runs, strict=False)
        for name, fault in _faults(run)
    ]


def _said(name: str, fault: Fault, file: str) -> Warning:
    return Warning(
        fault.kind,
        "{channel} is {fault} at "
        + ("{value:.4g degC}" if name == "temperature" else "{value:.4g} N m")
        + " for {rows} rows, "
        + (
            "so its true value there is unknown"
            if fault.kind == "stuck"
            else "because the range of sensor or logger ends there, so dwells at this value are wrong"
        ),
        severity="watch",
        where=file,
        channel=name,
        fault=fault.kind,
        value=float(fault.value),
        rows=int(fault.rows),
    )


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
