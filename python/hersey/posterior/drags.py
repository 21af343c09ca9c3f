"""Draws as drivetrains and tables of drag that the motion follows, at one temperature or through many."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray, corners
from hersey.errors import ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import DragTable
from hersey.posterior.drives import ABOVE, DriveModel, Drives
from hersey.posterior.priors import CLOSURES, NUMBERS

#: Change of ln force by which the straight lines of a table may miss the curve.
_STRAIGHT = 1e-3
#: Greatest factor of speed by which a table reaches farther for a colder film.
_FARTHEST = 1e4
#: Temperatures at which the powers of a draw are fitted to its law.
_LEVELS = 9


def drags_at(
    model: DriveModel, draws: Drives, kelvin: float | None, *, above: float = ABOVE
) -> list[tuple[Drivetrain, DragTable]]:
    """Return each draw at a temperature (K; None if isothermal), up to so many times the fastest dwell."""
    numbers, stick = model.numbers(draws), model.stick_speed(draws, kelvin)
    speeds, force = model.speeds(kelvin, above), np.exp(model.log_force(draws, kelvin, above))
    constant, damping = model.no_load(kelvin)
    static = numbers[:, 3] * model.force_at(draws, kelvin, stick)
    out = []
    for i in range(len(draws)):
        table = DragTable(
            *_needed(speeds, force[i], float(stick[i])),
            float(stick[i]),
            closure=list(CLOSURES)[int(draws.closure[i])],
            static_force=float(static[i]),
            rest_force=constant,
            rest_damping=damping,
        )
        train = Drivetrain(float(numbers[i, 1]), float(numbers[i, 2]), grip=model.machine.train.grip)
        out.append((train, table))
    return out


def drags_through(
    model: DriveModel, draws: Drives, kelvin: float, coldest: float | None = None
) -> list[tuple[Drivetrain, DragTable]]:
    """Return each draw with a drag that varies with temperature, exact at one temperature (K).

    Powers of temperature stand for the draw's law of viscosity, over the temperatures of the dwells and down
    to the ``coldest`` (K) that is asked for. The tables reach as fast as that temperature needs: a cold film
    is that of a faster roll.

    Raises
    ------
    ParameterError
        If the dwells have one temperature only.
    """
    surface, radius = model.surface, model.machine.roll_radius
    if surface.b is None or surface.temperature_range is None:
        raise ParameterError("the log is isothermal, so its drag does not depend on temperature")
    low, high = surface.temperature_range
    low = low if coldest is None else min(coldest, low)
    levels = np.linspace(low, high, _LEVELS)
    away = np.log((levels - surface.temperature_zero) / (kelvin - surface.temperature_zero))
    weight = away / float(away @ away)
    speed, force = _moved(model, draws, levels)
    here_speed, here_force = _moved(model, draws, np.array([kelvin]))
    of_speed, of_force = (speed - here_speed) @ weight, (force - here_force) @ weight
    rest = None if surface.rest is None else surface.rest.at_the_belt(radius, kelvin)
    colder = float(np.exp(np.max(here_speed - speed))) if coldest is not None else 1.0
    above = ABOVE * min(max(colder, 1.0), _FARTHEST)
    out = []
    for i, (train, table) in enumerate(drags_at(model, draws, kelvin, above=above)):
        varying = replace(
            table,
            reference_temperature=kelvin,
            temperature_zero=surface.temperature_zero,
            speed_temperature_exponent=float(of_speed[i]),
            force_temperature_exponent=float(of_force[i]),
            rest_temperature_slope=0.0 if rest is None else rest["rest_temperature_slope"],
        )
        out.append((train, varying))
    return out


def _needed(
    speeds: FloatArray, force: FloatArray, stick: float
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Speeds and forces of a table that follows a curve whose least force must lie above the stick speed."""
    if speeds[np.argmin(force)] <= stick:  # drag that rises from the stick speed on is least right above it
        speeds, force = speeds[speeds > stick], force[speeds > stick]
    kept = corners(np.log(speeds), np.log(force), _STRAIGHT, (int(np.argmin(force)),))
    return tuple(speeds[kept].tolist()), tuple(force[kept].tolist())


def _moved(model: DriveModel, draws: Drives, levels: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ln of the factors of speed and force at temperatures (K), shape (draws, temperatures)."""
    curves, latent = model.curves, draws.latent[:, len(NUMBERS) :]
    speed = [-curves.shift(draws.law, latent, t) for t in levels.tolist()]
    force = [curves.level(draws.law, latent, t) for t in levels.tolist()]
    return np.column_stack(speed), np.column_stack(force)
