"""Dwells of friction against the Hersey number: viscosity times speed over normal load.

With the viscosity at its own temperature, and its own load, each dwell takes its place on one Stribeck curve.
The Hersey number is often written with the mean pressure, eta v/p; eta v/N here, in 1/m, is that over the
area of contact, which tribometers do not state.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import groups_of_temperature
from hersey.errors import ParameterError, Setting
from hersey.log.means import MeansTable
from hersey.log.pooling import SAME_LOAD
from hersey.log.torque_log import TorqueLog
from hersey.schema.domain import HERSEY_NUMBER, Domain

if TYPE_CHECKING:
    from hersey.damping.dwells.points import SteadyPoints

#: Column of the table of dwells: which temperature and load they were measured at, counted from 0.
CURVE = "curve"


class Viscous(Protocol):
    """A lubricant: its viscosity is known at any temperature."""

    def viscosity(self, temperature: FloatArray) -> FloatArray:
        """Return the dynamic viscosity, Pa s, at temperatures (K)."""

    def temperature_exponent(self, temperature: FloatArray) -> FloatArray:
        """Return d ln viscosity/d ln temperature."""


def against_hersey_number(points: SteadyPoints, viscosity: Viscous | float) -> SteadyPoints:
    """Return the dwells with the Hersey number (1/m) in the place of the speed, whatever their temperature.

    Parameters
    ----------
    viscosity
        The lubricant, or one viscosity, Pa s.

    Raises
    ------
    ParameterError
        If the points are no friction coefficients against a speed in m/s, or lack loads or temperatures.
    """
    _refuse_others(points, viscosity)
    speed, load = points.column("speed"), points.column("load")
    kelvin = points.column("temperature") if points.log.has_temperature else None
    if isinstance(viscosity, float | int):
        factor, spread = np.full(len(points), float(viscosity)) / load, np.zeros(len(points))
    else:
        assert kelvin is not None  # see `_refuse_others`
        factor = viscosity.viscosity(kelvin) / load
        off = points.column("temperature_error") / kelvin
        spread = np.nan_to_num(np.abs(viscosity.temperature_exponent(kelvin)) * off)
    error = factor * np.hypot(points.column("speed_error"), speed * spread)
    table = points.table.with_columns(
        pl.Series("speed", speed * factor),
        pl.Series("speed_error", error),
        pl.Series(CURVE, _curves(kelvin, load)),
    )
    return replace(
        points,
        table=table,
        log=_without_temperature(points, Domain(points.domain.quantity, HERSEY_NUMBER)),
        rejected=tuple(replace(each, speed=float("nan")) for each in points.rejected),
        resolutions=tuple(each for each in points.resolutions if each.quantity == "torque"),
        temperature_rates=np.empty(0),
    )


def _refuse_others(points: SteadyPoints, viscosity: Viscous | float) -> None:
    name, of = points.log.files[0].name, points.domain
    if of.quantity != "friction coefficient" or of.speed_unit != "m/s":
        raise ParameterError(
            f"{name}: the Hersey number needs a friction coefficient against a speed in m/s, but the log is "
            f"of a {of.quantity} against {of.speed}",
            remedy=f"give {Setting('load').to('10 N')}, and for a rotation the radius of each run, e.g. "
            f"{Setting('radius').to('25 mm, 25 mm')}",
        )
    if "load" not in points.table.columns or points.table["load"].null_count():
        raise ParameterError(
            f"{name}: the Hersey number needs the normal load",
            remedy=f"give it, e.g. {Setting('load').to('10 N')}, or name its column",
        )
    if not points.log.has_temperature and not isinstance(viscosity, float | int):
        raise ParameterError(
            f"{name}: the log has no temperatures, at which the lubricant has its viscosity",
            remedy=f"give the viscosity itself, e.g. {Setting('hersey').to('20 mPa*s', python='0.02')}",
        )


def _curves(kelvin: FloatArray | None, load: FloatArray) -> FloatArray:
    """Which dwells have one temperature and one load."""
    hot = np.zeros(load.size)
    if kelvin is not None:
        for number, members in enumerate(groups_of_temperature(kelvin)):
            hot[members] = number
    heavy = np.round(np.log(load / load.min()) / np.log(SAME_LOAD))
    return np.asarray(np.unique(np.column_stack([hot, heavy]), axis=0, return_inverse=True)[1].ravel())


def _without_temperature(points: SteadyPoints, domain: Domain) -> TorqueLog | MeansTable:
    """The log of the dwells: the Hersey number has its temperatures in it."""
    log = points.log
    if isinstance(log, MeansTable):
        means = tuple(replace(row, temperature=None) for row in log.means)
        return replace(log, means=means, domain=domain)
    return replace(log, runs=tuple(replace(run, temperature=None, domain=domain) for run in log.runs))
