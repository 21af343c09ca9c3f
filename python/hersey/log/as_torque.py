"""Friction as the torque of a rotation, where somebody has a radius and asks for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hersey.errors import ParameterError, Setting
from hersey.log.means import MeansTable
from hersey.log.pooling import SAME_LOAD
from hersey.log.torque_log import LogFile, TorqueLog
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.warning import Warning


def factors(of: Domain, radius: float, load: float | None) -> tuple[float, float]:
    """Return by what a quantity and a speed are multiplied to be torque (N m) and rotation (rad/s)."""
    known = {"radius": radius, "load": 1.0 if load is None else load}
    torque, speed = of.converted(TORQUE, np.ones(1), np.ones(1), **known)
    return float(torque[0]), float(speed[0])


def one_load(log: TorqueLog | MeansTable, load: float | None = None) -> float | None:
    """Return the normal load (N) at which a coefficient becomes a torque: as given, or that of the log.

    Raises
    ------
    ParameterError
        If the log has none, or several.
    """
    if load is not None or log.domain.quantity != "friction coefficient":
        return load
    recorded = [run.load for run in log.runs] or [row.load for row in getattr(log, "means", ())]
    known = [np.atleast_1d(each) for each in recorded if each is not None]
    why = "no normal load is known"
    if known and len(known) == len(recorded):
        loads = np.array([float(np.median(each)) for each in known])
        if loads.max() <= SAME_LOAD * loads.min():
            return float(np.median(loads))
        why = f"the log has loads of {loads.min():.3g} to {loads.max():.3g} N"
    raise ParameterError(
        f"{log.files[0].name}: a friction coefficient becomes a torque at one normal load, but {why}",
        remedy=f"give it, e.g. {Setting('load').to('50 N')}",
    )


def log_as_torque(
    log: TorqueLog | MeansTable, *, radius: float, load: float | None = None
) -> TorqueLog | MeansTable:
    """Return a log, or a table of means, as the torque of a rotation at a radius (m) and a load (N).

    Raises
    ------
    ParameterError
        If a load is needed and the log has none, or several.
    """
    if log.domain.is_torque:
        return log
    at = one_load(log, load)
    by, per = factors(log.domain, radius, at)
    files = tuple(_said(file, log.domain, radius, at) for file in log.files)
    if isinstance(log, MeansTable):
        means = tuple(
            replace(row, torque=by * row.torque, torque_error=by * row.torque_error, speed=per * row.speed)
            for row in log.means
        )
        return replace(log, means=means, files=files, domain=TORQUE)
    runs = tuple(
        replace(run, torque=by * run.torque, speed=per * run.speed, domain=TORQUE) for run in log.runs
    )
    return replace(log, runs=runs, files=files)


def _said(file: LogFile, of: Domain, radius: float, load: float | None) -> LogFile:
    """The record of a file with what its torque was made of."""
    words = (
        "torque is the {quantity} x radius ({radius:g} m)"
        if load is None or of.quantity != "friction coefficient"
        else "torque is the {quantity} x load ({load:g} N) x radius ({radius:g} m)"
    )
    made = Warning("friction as torque", words, quantity=of.quantity, radius=radius, load=load)
    return replace(file, warnings=(*file.warnings, made))
