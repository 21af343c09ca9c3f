"""The typical drive of a posterior: the one whose motion is drawn, and that a reader may change."""

from __future__ import annotations

import numpy as np

from hersey.motion.belt import Drivetrain
from hersey.motion.drag import DragTable
from hersey.posterior.drags import drags_at, drags_through
from hersey.posterior.drives import Drives
from hersey.posterior.priors import NUMBERS
from hersey.posterior.result import Posterior

#: Share of the draws of a closure whose V* is nearest its median, of which the most ordinary is taken.
_NEAR = 0.1
#: Numbers that a machine file states.
_STATED = ("stiffness", "mass")


def typical_drag(found: Posterior, kelvin: float | None) -> tuple[Drivetrain, DragTable]:
    """Return the typical draw at a temperature (K; None if isothermal): drivetrain and table of drag."""
    return drags_at(found.model, typical_draw(found, kelvin), kelvin)[0]


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
    """Return the drag of the typical draw at the temperature of the headline, varying with temperature."""
    kelvin = found.temperature
    if kelvin is None or found.model.surface.temperature_range is None:
        return typical_drag(found, kelvin)[1]
    return drags_through(found.model, typical_draw(found, kelvin), kelvin)[0][1]
