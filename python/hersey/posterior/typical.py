"""The typical drive of a posterior: the one whose motion is drawn, and that a reader may change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.motion.drag import DragTable
from hersey.motion.simulation import Drivetrain
from hersey.posterior.drives import Drives
from hersey.posterior.priors import CLOSURES, NUMBERS
from hersey.posterior.result import Posterior

#: Share of the draws of a closure whose V* is nearest its median, of which the most ordinary is taken.
_NEAR = 0.1
#: Numbers that a machine file states.
_STATED = ("stiffness", "mass")
#: Change of ln force by which the straight lines of a table may miss the curve.
_STRAIGHT = 1e-3
#: Temperatures at which the powers of a typical drive are fitted to its law.
_LEVELS = 9


def typical_drag(found: Posterior, kelvin: float | None) -> tuple[Drivetrain, DragTable]:
    """Return the typical draw at a temperature (K; None if isothermal): drivetrain and table of drag."""
    model, draw = found.model, typical_draw(found, kelvin)
    numbers = model.numbers(draw)[0]
    stick = float(model.stick_speed(draw, kelvin)[0])
    speeds, force = model.speeds(kelvin), np.exp(model.log_force(draw, kelvin)[0])
    static = float(numbers[3]) * float(np.exp(np.interp(np.log(stick), np.log(speeds), np.log(force))))
    if speeds[np.argmin(force)] <= stick:  # drag that rises from the stick speed on is least right above it
        speeds, force = speeds[speeds > stick], force[speeds > stick]
    needed = _needed(np.log(speeds), np.log(force))
    constant, damping = model.no_load(kelvin)
    drag = DragTable(
        tuple(speeds[needed].tolist()),
        tuple(force[needed].tolist()),
        stick,
        closure=list(CLOSURES)[int(draw.closure[0])],
        static_force=static,
        rest_force=constant,
        rest_damping=damping,
    )
    return Drivetrain(float(numbers[1]), float(numbers[2]), grip=model.machine.train.grip), drag


def _needed(x: FloatArray, y: FloatArray) -> IntArray:
    """Return the points that straight lines need to follow all of them (Ramer, Douglas and Peucker)."""
    kept, spans = {0, x.size - 1, int(np.argmin(y))}, [(0, x.size - 1)]
    while spans:
        first, last = spans.pop()
        line = y[first] + (y[last] - y[first]) * (x[first:last] - x[first]) / (x[last] - x[first])
        off = np.abs(y[first:last] - line)
        if off.max() > _STRAIGHT:
            middle = first + int(np.argmax(off))
            kept.add(middle)
            spans += [(first, middle), (middle, last)]
    return np.array(sorted(kept), dtype=np.intp)


def typical_draw(found: Posterior, kelvin: float | None) -> Drives:
    """Return a draw of the likeliest closure whose V* is near the median of that closure.

    Of those the one is taken whose stiffness and mass are nearest the stated ones, and whose other numbers
    are nearest the middle of the draws.
    """
    drives = found.drives
    mine = np.flatnonzero(drives.closure == np.bincount(drives.closure).argmax())
    fold = found.edges(kelvin).fold[mine]
    ranks = np.argsort(np.argsort(fold, kind="stable"), kind="stable") / max(fold.size - 1, 1)
    near = mine[np.abs(ranks - 0.5) <= 0.5 * _NEAR + 0.5 / fold.size]
    latent = drives.latent[:, : len(NUMBERS)]
    middle = np.median(latent, axis=0)
    middle[[NUMBERS.index(name) for name in _STATED]] = 0.0
    spread = np.maximum(latent.std(axis=0), 1e-9)
    away = (((latent[near] - middle) / spread) ** 2).sum(axis=1)
    return drives.take(near[[int(np.argmin(away))]])


def typical_of_all_temperatures(found: Posterior) -> DragTable:
    """Return the drag of the typical draw at the temperature of the headline, varying with temperature.

    Powers of temperature stand for the law of viscosity of the draw, over the temperatures of the dwells.
    """
    _, drag = typical_drag(found, found.temperature)
    surface, kelvin = found.model.surface, found.temperature
    if kelvin is None or surface.temperature_range is None:
        return drag
    draw = typical_draw(found, kelvin)
    levels = np.linspace(*surface.temperature_range, _LEVELS)
    speed, force = _moved(found, draw, levels)
    here_speed, here_force = (each[0] for each in _moved(found, draw, np.array([kelvin])))
    away = np.log((levels - surface.temperature_zero) / (kelvin - surface.temperature_zero))
    weight = away / float(away @ away)
    rest = None if surface.rest is None else surface.rest.at_the_belt(found.model.machine.roll_radius, kelvin)
    return replace(
        drag,
        reference_temperature=kelvin,
        temperature_zero=surface.temperature_zero,
        speed_temperature_exponent=float(weight @ (speed - here_speed)),
        force_temperature_exponent=float(weight @ (force - here_force)),
        rest_temperature_slope=0.0 if rest is None else rest["rest_temperature_slope"],
    )


def _moved(found: Posterior, draw: Drives, levels: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ln of the factors of speed and force at temperatures (K)."""
    curves, latent = found.model.curves, draw.latent[:, len(NUMBERS) :]
    speed = [-float(curves.shift(draw.law, latent, t)[0]) for t in levels.tolist()]
    force = [float(curves.level(draw.law, latent, t)[0]) for t in levels.tolist()]
    return np.array(speed), np.array(force)
