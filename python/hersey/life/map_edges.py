"""Transition and V* of the operating map of a worn specimen, and where its map is measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import isotonic_regression
from scipy.spatial import ConvexHull, QhullError

from hersey.arrays import BoolArray, FloatArray
from hersey.life.indicators.sticking import belt_drag, edges
from hersey.life.indicators.torque_surface import RunDwells

if TYPE_CHECKING:
    from hersey.damping.no_load_torque import NoLoadTorque
    from hersey.machine.machine import Machine

#: Kelvin that count as much as one unit of ln speed, and how far beyond the dwells, in these, is measured.
_TEMPERATURE_SCALE, _SLACK = 50.0, 0.1
#: A transition that falls with temperature by more than this (logarithm) is worth a warning.
_FALLS = 0.2


class MapEdges(NamedTuple):
    """Transition and V* (m/s) at each temperature, 0 below the speeds of the map.

    ``falls`` says whether the dwells show a transition that falls with temperature.
    """

    transition: FloatArray
    upper: FloatArray
    falls: bool


def edges_of(
    machine: Machine, belt: FloatArray, rest: NoLoadTorque | None, hot: FloatArray, speed: FloatArray
) -> MapEdges:
    """Return the edges of a belt of such ln torque, shape (temperatures, speeds), at K and m/s.

    The transition rises with temperature, for viscosity falls: where the dwells show the opposite it is
    level, by least squares.
    """
    rows = zip(np.exp(belt), hot.tolist(), strict=True)
    each = [edges(machine.train, belt_drag(machine, rest, speed, row, kelvin)) for row, kelvin in rows]
    transition, upper = np.nan_to_num(np.array(each)).T
    seen = np.log(np.maximum(transition, speed[0]))
    level = np.asarray(isotonic_regression(seen).x)
    rising = _kept(np.exp(level), speed)
    above = np.where(rising > 0.0, np.maximum(upper, rising), 0.0)
    return MapEdges(rising, above, bool((np.abs(seen - level) > _FALLS).any()))


def moved_edges(over_life: Sequence[MapEdges], ages: FloatArray, age: float, speed: FloatArray) -> MapEdges:
    """Return the edges at an age after the last of the runs.

    The logarithm of the transition goes with age as it did over the runs, by one slope for all temperatures,
    so it goes on to rise with temperature; V* goes with it.
    """
    away = square = 0.0
    for column in np.array([each.transition for each in over_life]).T:
        known = column > 0.0
        if known.sum() > 1:
            step = ages[known] - ages[known].mean()
            away += float(step @ np.log(column[known]))
            square += float(step @ step)
    factor = float(np.exp(away / square * (age - ages[-1]))) if square > 0.0 else 1.0
    last = over_life[-1]
    return MapEdges(_kept(last.transition * factor, speed), _kept(last.upper * factor, speed), falls=False)


def _kept(edge: FloatArray, speed: FloatArray) -> FloatArray:
    """An edge so far as it is above the slowest speed; 0 below."""
    return np.where(edge > speed[0] * (1.0 + 1e-9), edge, 0.0)


def measured_at(dwells: RunDwells | None, hot: FloatArray, rolls: FloatArray) -> BoolArray:
    """Return which temperatures (K) and speeds (rad/s) lie among dwells: in their convex hull or close."""
    kelvin, speeds = np.meshgrid(hot / _TEMPERATURE_SCALE, np.log(rolls), indexing="ij")
    if dwells is None:
        return np.zeros(kelvin.shape, dtype=bool)
    at = np.stack([dwells.temperature / _TEMPERATURE_SCALE, np.log(dwells.speed)], axis=1)
    try:
        sides = ConvexHull(at).equations
    except QhullError:  # all on one line
        return np.zeros(kelvin.shape, dtype=bool)
    places = np.stack([kelvin, speeds, np.ones_like(kelvin)], axis=-1)
    return np.asarray((places @ sides.T <= _SLACK).all(axis=-1))
