"""The verdict on a drive speed at a temperature: the one place where probabilities become a verdict."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.surface import DampingSurface
from hersey.errors import HerseyError
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine
from hersey.posterior import PointProbability, Posterior
from hersey.posterior.result import SAFE

#: ``smooth``: from any start. ``depends``: it slides once it slides, not from every start. ``sticks``: from
#: any start. ``not started``: the drive does not break the belt away. ``stalls``: sliding takes more than the
#: drive gives. ``too fast``: beyond the drive's own limit. ``unknown``: none of them is sure.
Kind = Literal["smooth", "depends", "sticks", "not started", "stalls", "too fast", "unknown"]


@dataclass(frozen=True)
class Verdict:
    """What happens at a drive speed (m/s) and temperature (K), and how sure that is.

    ``starts`` is the probability that the drive breaks a belt at rest away, ``bears`` that it withstands the
    torque of steady sliding.
    """

    kind: Kind
    probability: PointProbability
    starts: float
    bears: float


@dataclass(frozen=True)
class Unjudged:
    """An operating point without a verdict, and why."""

    point: OperatingPoint
    error: HerseyError


def judge(found: Posterior, kelvin: float | None, speed: float) -> Verdict:
    """Return the verdict on a drive speed (m/s) at a temperature (K; None if isothermal).

    A verdict needs 97.5 % probability; smooth sliding counts only where the drive starts the belt.
    """
    machine = found.model.machine
    chances = found.probability(kelvin=kelvin, speed=speed)
    limit = drive_limit(machine.limits, machine.roll_radius, machine.train.grip)
    starts, bears = 1.0, 1.0
    if math.isfinite(limit):
        starts = float(np.mean(found.edges(kelvin).holding <= limit))
        bears = float(np.mean(steady_force(found, kelvin, speed) <= limit))
    return Verdict(_kind(machine.limits, chances, speed, starts, bears), chances, starts, bears)


def _kind(limits: Limits, chances: PointProbability, speed: float, starts: float, bears: float) -> Kind:
    if limits.speed is not None and speed > limits.speed * (1.0 + 1e-9):
        return "too fast"
    if starts <= 1.0 - SAFE:
        return "not started"
    if bears <= 1.0 - SAFE:
        return "stalls"
    if min(chances.smooth, starts, bears) >= SAFE:
        return "smooth"
    if chances.sticks >= SAFE:
        return "sticks"
    if chances.smooth + chances.from_above >= SAFE and min(starts, bears) >= SAFE:
        return "depends"
    return "unknown"


def drive_limit(limits: Limits, roll_radius: float, grip: float | None) -> float:
    """Return the greatest force (N) that motor and grip give at the belt; infinite if neither is stated."""
    motor = math.inf if limits.motor_torque is None else limits.motor_torque / roll_radius
    return min(motor, math.inf if grip is None else grip)


def steady_force(found: Posterior, kelvin: float | None, speed: float) -> FloatArray:
    """Return the force (N) that sliding takes at a drive speed (m/s) in each draw."""
    constant, damping = found.model.no_load(kelvin)
    return found.model.force_at(found.drives, kelvin, speed) + constant + damping * speed


def meaningless(surface: DampingSurface, machine: Machine) -> tuple[Unjudged, ...]:
    """Return the operating points at whose temperature the law of the fit has no meaning."""
    out = []
    for point in machine.points:
        try:
            surface.check_temperature(point.temperature)
        except HerseyError as error:
            out.append(Unjudged(point, error))
    return tuple(out)
