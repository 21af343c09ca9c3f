"""Dwells of friction against the Hersey number: viscosity times speed over normal load.

With the viscosity at its own temperature, and its own load, each dwell takes its place on one Stribeck curve.
The Hersey number is often written with the mean pressure, eta v/p; eta v/N here, in 1/m, is that over the
area of contact, which tribometers do not state.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import groups_of_temperature
from hersey.errors import ParameterError, Setting
from hersey.log.means import MeansTable
from hersey.log.pooling import SAME_LOAD
from hersey.log.torque_log import TorqueLog
from hersey.schema.domain import HERSEY_NUMBER, Domain

#: Column of the table of dwells: which temperature and load they were measured at, counted from 0.
CURVE = "curve"


class Viscous(Protocol):
    """A lubricant: its viscosity is known at any temperature."""

    def viscosity(self, temperature: FloatArray) -> FloatArray:
        """Return the dynamic viscosity, Pa s, at temperatures (K)."""

    def temperature_exponent(self, temperature: FloatArray) -> FloatArray:
        """Return d ln viscosity/d ln temperature."""


def against_hersey_number(
    table: pl.DataFrame, log: TorqueLog | MeansTable, viscosity: Viscous | float
) -> tuple[pl.DataFrame, TorqueLog | MeansTable]:
    """Return the table of dwells with the Hersey number (1/m) in the place of the speed, and their log.

    Parameters
    ----------
    viscosity
        The lubricant, or one viscosity, Pa s.

    Raises
    ------
    ParameterError
        If they are no friction coefficients against a speed in m/s, or lack loads or temperatures.
    """
    _refuse_others(table, log, viscosity)
    names = ("speed", "speed_error", "load", "temperature", "temperature_error")
    speed, speed_error, load, kelvin, off = (table[name].to_numpy() for name in names)
    if isinstance(viscosity, float | int):
        factor, spread = np.full(load.size, float(viscosity)) / load, np.zeros(load.size)
    else:
        factor = viscosity.viscosity(kelvin) / load
        spread = np.nan_to_num(np.abs(viscosity.temperature_exponent(kelvin)) * off / kelvin)
    error = factor * np.hypot(speed_error, speed * spread)
    dwells = table.with_columns(
        pl.Series("speed", speed * factor),
        pl.Series("speed_error", error),
        pl.Series(CURVE, _curves(kelvin if log.has_temperature else None, load)),
    )
    return dwells, _without_temperature(log, Domain(log.domain.quantity, HERSEY_NUMBER))


def _refuse_others(table: pl.DataFrame, log: TorqueLog | MeansTable, viscosity: Viscous | float) -> None:
    name, of = log.files[0].name, log.domain
    if of.quantity != "friction coefficient" or of.speed_unit != "m/s":
        raise ParameterError(
            f"{name}: the Hersey number needs a friction coefficient against a speed in m/s, but the log is "
            f"of a {of.quantity} against {of.speed}",
            remedy=f"give {Setting('load').to('10 N')}, and for a rotation the radius of each run, e.g. "
            f"{Setting('radius').to('25 mm, 25 mm')}",
        )
    if "load" not in table.columns or table["load"].null_count():
        raise ParameterError(
            f"{name}: the Hersey number needs the normal load",
            remedy=f"give it, e.g. {Setting('load').to('10 N')}, or name its column",
        )
    if not log.has_temperature and not isinstance(viscosity, float | int):
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


def _without_temperature(log: TorqueLog | MeansTable, domain: Domain) -> TorqueLog | MeansTable:
    """The log of the dwells: the Hersey number has its temperatures in it."""
    if isinstance(log, MeansTable):
        means = tuple(replace(row, temperature=None) for row in log.means)
        return replace(log, means=means, domain=domain)
    return replace(log, runs=tuple(replace(run, temperature=None, domain=domain) for run in log.runs))
