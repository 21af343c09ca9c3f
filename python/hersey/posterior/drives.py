"""Draws of a drive: a drag curve of the dwells, a closure, and the numbers of the machine; their motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray, IntArray
from hersey.damping.curves import CurveMixture
from hersey.damping.surface import FIXED, DampingSurface
from hersey.machine.machine import Machine
from hersey.motion.parameters import MOST_STEPS
from hersey.posterior.priors import NUMBERS, DrivePriors

#: Distance of the points of a drawn curve in ln speed, and how far they reach: below the slowest stick speed
#: and above the fastest dwell, as factors.
STEP, BELOW, ABOVE = 0.08, 0.6, 4.0
#: Ratio of speeds just below the fastest dwell over which the slope there is taken, and the fall in ln force
#: from which drag still falls.
_LAST, _FALLS = 1.25, 0.002


@dataclass(frozen=True)
class Drives:
    """Draws: the law and the latents of each, and its closure (an index of `CLOSURES`).

    ``latent`` has shape (draws, numbers of the drive + those of the curve), standard normal before the
    dwells.
    """

    law: IntArray
    closure: IntArray
    latent: FloatArray

    def __len__(self) -> int:
        """Return how many draws there are."""
        return int(self.law.size)

    def take(self, index: IntArray) -> Drives:
        """Return the draws at an index."""
        return Drives(self.law[index], self.closure[index], self.latent[index])


@dataclass(frozen=True)
class DriveModel:
    """A machine whose drag the dwells leave open; turns draws into motion."""

    curves: CurveMixture
    surface: DampingSurface
    machine: Machine
    priors: DrivePriors

    @property
    def size(self) -> int:
        """How many latents a draw has."""
        return len(NUMBERS) + self.curves.size

    def numbers(self, drives: Drives) -> FloatArray:
        """Return `NUMBERS` of each draw, the stick speed at the temperature at which it is stated."""
        return self.priors.at(drives.latent[:, : len(NUMBERS)])

    def log_weight(self, drives: Drives) -> FloatArray:
        """Return ln of the likelihood of the dwells over the density that the draws come from."""
        return self.curves.log_weight(drives.law, drives.latent[:, len(NUMBERS) :])

    def speeds(self, kelvin: float | None = None, above: float = ABOVE) -> FloatArray:
        """Return the speeds (m/s) of the points of the curves at a temperature (K).

        They end ``above`` times the fastest dwell.
        """
        if (kelvin, above) not in self._speeds:
            self._speeds[kelvin, above] = self._spread(kelvin, above)
        return self._speeds[kelvin, above]

    @cached_property
    def _speeds(self) -> dict[tuple[float | None, float], FloatArray]:
        return {}

    def _spread(self, kelvin: float | None, above: float) -> FloatArray:
        radius = self.machine.roll_radius
        stick = self.priors.range_of("stick_speed")[0] * min(self._moves_stick_speed(kelvin), 1.0)
        low = BELOW * min(stick, self.surface.speed_range[0] * radius)
        high = above * self.surface.speed_range[1] * radius
        count = max(int(np.ceil(np.log(high / low) / STEP)), 8)
        return np.asarray(low * np.exp(STEP * np.arange(count + 1)))

    def _moves_stick_speed(self, kelvin: float | None) -> float:
        """The stick speed at a temperature over the stated one, of the likeliest curves."""
        law = np.arange(len(self.curves.laws), dtype=np.intp)
        drives = Drives(law, np.zeros_like(law), np.zeros((law.size, self.size)))
        return float(np.min(self.stick_speed(drives, kelvin) / self.numbers(drives)[:, 0]))

    def log_force(self, drives: Drives, kelvin: float | None, above: float = ABOVE) -> FloatArray:
        """Return ln of the drag of the film (N) of each draw at `speeds`, shape (draws, speeds)."""
        radius = self.machine.roll_radius
        latent = drives.latent[:, len(NUMBERS) :]
        torque = self.curves.log_torque(drives.law, latent, self.speeds(kelvin, above) / radius, kelvin)
        return np.asarray(torque - np.log(radius))

    def turns_by(self, drives: Drives, kelvin: float | None, curve: FloatArray) -> FloatArray:
        """Return the speed (m/s) at a temperature (K) up to which drag falls in the dwells, (draws,).

        ``curve`` is their `log_force` there.

        It is that of the dwell with the greatest Hersey number if drag still falls there, as nothing bounds
        the speed at which it turns then; otherwise it is infinite.
        """
        latent = drives.latent[:, len(NUMBERS) :]
        fastest = self.machine.roll_radius * self.curves.fastest(drives.law, latent, kelvin)
        before = self._on(curve, kelvin, fastest / _LAST)
        falls = np.log(self._on(curve, kelvin, fastest) / before) < -_FALLS
        return np.where(falls, fastest, np.inf)

    def force_at(self, drives: Drives, kelvin: float | None, speed: FloatArray | float) -> FloatArray:
        """Return the drag of the film (N) of each draw at a speed (m/s), common or of its own, (draws,)."""
        return self._on(self.log_force(drives, kelvin), kelvin, speed)

    def _on(self, curve: FloatArray, kelvin: float | None, speed: FloatArray | float) -> FloatArray:
        grid = np.log(self.speeds(kelvin))
        at = np.broadcast_to(np.log(speed), (len(curve),))
        place = np.clip((at - grid[0]) / STEP, 0.0, None)
        left = np.minimum(place.astype(np.intp), grid.size - 2)
        row = np.arange(len(curve))
        # beyond the last point the curve goes on straight
        low, high = curve[row, left], curve[row, left + 1]
        return np.asarray(np.exp(low + (place - left) * (high - low)))

    def stick_speed(self, drives: Drives, kelvin: float | None) -> FloatArray:
        """Return the stick speed (m/s) of each draw at a temperature (K), by the rule of the machine."""
        stated, machine = self.numbers(drives)[:, 0], self.machine
        if kelvin is None or machine.stick_speed_rule == FIXED or self.surface.b is None:
            return stated
        at = machine.stick_speed_temperature or self.surface.reference_temperature
        latent = drives.latent[:, len(NUMBERS) :]
        moved = self.curves.shift(drives.law, latent, at) - self.curves.shift(drives.law, latent, kelvin)
        return np.asarray(stated * np.exp(moved))

    def no_load(self, kelvin: float | None) -> tuple[float, float]:
        """Return the no-load drag at a temperature: a constant (N) and a part per speed (N s/m)."""
        rest = self.surface.rest
        if rest is None:
            return 0.0, 0.0
        at_the_belt = rest.at_the_belt(self.machine.roll_radius, kelvin)
        return float(at_the_belt["rest_force"]), float(at_the_belt["rest_damping"])

    def folds(
        self,
        drives: Drives,
        kelvin: float | None,
        *,
        accuracy: float = 1e-3,
        threads: int = 1,
        stick_speed: FloatArray | None = None,
        factors: FloatArray | None = None,
        slips: bool = True,
        curve: FloatArray | None = None,
    ) -> _core.CurveFolds:
        """Return transition, V* and the force that starts a belt (m/s, m/s, N) of each draw.

        ``stick_speed`` (m/s, at this temperature) takes the place of those drawn. ``factors``, shape
        (draws, 3), multiply stick speed, stiffness and mass. Unless it ``slips`` the roll grips any force.
        ``curve`` is their `log_force` there, where that is known already.
        """
        curves, columns = self._belts(drives, kelvin, curve)
        if stick_speed is not None:
            columns[2] = np.ascontiguousarray(stick_speed)
        if factors is not None:
            columns[2], columns[0], columns[1] = np.stack([columns[2], columns[0], columns[1]]) * factors.T
        grip = self.machine.train.grip if slips else None
        return _core.curve_folds(curves, columns, grip, accuracy, threads, None, int(MOST_STEPS))

    def starts(
        self,
        drives: Drives,
        kelvin: float | None,
        drive_speed: float,
        *,
        accuracy: float = 1e-3,
        threads: int = 1,
    ) -> _core.CurveStarts:
        """Return what becomes of each draw, started from rest at a drive speed (m/s)."""
        curves, columns = self._belts(drives, kelvin)
        speed = np.full(len(drives), drive_speed)
        grip = self.machine.train.grip
        return _core.curve_starts(curves, columns, speed, grip, accuracy, threads, int(MOST_STEPS))

    def start_ups(
        self,
        drives: Drives,
        kelvin: float | None,
        profile: list[tuple[float, float]],
        *,
        accuracy: float = 1e-3,
        threads: int = 1,
    ) -> _core.CurveStartUps:
        """Return what a profile of drive speed, corners of time (s) and speed (m/s), does to each draw."""
        curves, columns = self._belts(drives, kelvin)
        grip = self.machine.train.grip
        return _core.curve_start_ups(curves, columns, profile, grip, accuracy, threads, int(MOST_STEPS))

    def _belts(
        self, drives: Drives, kelvin: float | None, curve: FloatArray | None = None
    ) -> tuple[tuple[float, float, FloatArray], list[FloatArray]]:
        """Curves and numbers of the draws, as the core takes them."""
        speeds, numbers = self.speeds(kelvin), self.numbers(drives)
        log_force = np.ascontiguousarray(self.log_force(drives, kelvin) if curve is None else curve)
        stick = self.stick_speed(drives, kelvin)
        force, damping = self.no_load(kelvin)
        one = np.ones(len(drives))
        columns = [numbers[:, 1], numbers[:, 2], stick, numbers[:, 3], force * one, damping * one]
        columns.append(drives.closure.astype(np.float64))
        return (float(np.log(speeds[0])), STEP, log_force), [np.ascontiguousarray(c) for c in columns]
