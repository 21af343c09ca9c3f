"""What torque is: each law gives torque (N m) at speeds (rad/s) and temperatures of the film (degC)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
RPM = 2.0 * np.pi / 60.0
#: Width in ln w over which two branches merge: it adds 0.07 % of torque at most, less than noise does.
CORNER = 0.002
#: Temperature at which the constants of a law are given, degC.
MIDDLE = 130.0


class TorqueLaw(Protocol):
    """Anything with a torque."""

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m; speed (rad/s) and film temperature (degC) of one shape."""


@dataclass(frozen=True)
class Vogel:
    """Viscosity over that at `MIDDLE`: ln of it is steepness/(T - zero), in K (Vogel, Fulcher, Tammann).

    The default falls to about a tenth from 80 to 180 degC, as an ordinary grease does.
    """

    steepness: float = 900.0
    zero: float = 200.0

    def viscosity(self, celsius: Array) -> Array:
        """Return the ratio at temperatures in degC."""
        at = self.steepness / (MIDDLE + 273.15 - self.zero)
        return np.asarray(np.exp(self.steepness / (celsius + 273.15 - self.zero) - at))

    def sensitivity(self, celsius: float) -> float:
        """Return -d ln viscosity / dT in 1/K."""
        return self.steepness / (celsius + 273.15 - self.zero) ** 2


@dataclass(frozen=True)
class PowerLaw:
    """B = a T^b w^c with T in degC (Eq. 4 of the paper)."""

    a: float = 250.0
    b: float = -0.9
    c: float = -0.7

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m."""
        return np.asarray(self.a * celsius**self.b * speed ** (1.0 + self.c))


@dataclass(frozen=True)
class TwoBranches(PowerLaw):
    """The same above a transition at one Hersey number, exponent ``mixed`` below it.

    Torque varies as viscosity^(1 + c), so viscosity as T^(b/(1 + c)) and the transition speed as its inverse.
    ``at`` is that speed (rad/s) at the temperature ``celsius``.
    """

    mixed: float = -1.2
    at: float = 25.0 * RPM
    celsius: float = MIDDLE

    def transition_speed(self, celsius: Array) -> Array:
        """Return where the branches meet, rad/s."""
        return np.asarray(self.at * (celsius / self.celsius) ** (-self.b / (1.0 + self.c)))

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m."""
        away = np.log(speed / self.transition_speed(celsius))
        below = -CORNER * np.logaddexp(0.0, -away / CORNER)
        return np.asarray(super().torque(speed, celsius) * np.exp((self.mixed - self.c) * below))


@dataclass(frozen=True)
class DriftingExponent:
    """A power law whose exponent moves, by ``by_speed`` per ln w and ``by_kelvin`` per K, about ``c``.

    It stays above -1 for every speed and temperature that the benchmark uses: torque never falls.
    """

    level: float = 1.0
    b: float = -0.9
    c: float = -0.7
    by_speed: float = 0.0
    by_kelvin: float = 0.0
    middle: float = 36.0 * RPM

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m."""
        z = np.log(speed / self.middle)
        power = 1.0 + self.c + 0.5 * self.by_speed * z + self.by_kelvin * (celsius - MIDDLE)
        return np.asarray(self.level * (celsius / MIDDLE) ** self.b * np.exp(power * z))


@dataclass(frozen=True)
class Film:
    """A film that obeys a power law in viscosity times speed, plus a torque that depends on neither.

    ``film`` is the film's torque at ``middle`` (rad/s) and `MIDDLE`. With ``c`` = 0 the film has one
    thickness and the law is Coulomb friction plus viscous drag.
    """

    film: float
    constant: float
    c: float
    middle: float
    grease: Vogel = Vogel()

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m."""
        hersey = self.grease.viscosity(celsius) * speed / self.middle
        return np.asarray(self.constant + self.film * hersey ** (1.0 + self.c))


@dataclass(frozen=True)
class VogelPower:
    """A power law in speed, w^(1 + c), whose level follows Vogel with ``share`` of the viscosity's exponent.

    ``share`` is apart from 1 + c so that a torque without speed dependence may depend on temperature.
    """

    level: float
    c: float
    share: float
    middle: float
    grease: Vogel = Vogel()

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m."""
        warm = self.grease.viscosity(celsius) ** self.share
        return np.asarray(self.level * warm * (speed / self.middle) ** (1.0 + self.c))


@dataclass(frozen=True)
class Carreau:
    """A film of one thickness that thins with shear (Carreau, 1972).

    Its viscosity is eta0 (1 + (lambda w)^2)^((n - 1)/2).
    The relaxation time lambda varies as eta0 with temperature (time-temperature superposition).
    """

    level: float
    n: float
    middle: float  #: speed at which lambda w = 1 at `MIDDLE`, rad/s
    grease: Vogel = Vogel()

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m."""
        ratio = self.grease.viscosity(celsius)
        sheared = ratio * speed / self.middle
        return np.asarray(self.level * sheared * (1.0 + sheared**2) ** ((self.n - 1.0) / 2.0))


@dataclass(frozen=True)
class Stribeck:
    """Boundary friction that fades with the Hersey number, plus viscous drag; the fading is slow, so wide."""

    boundary: float
    least: float
    fading: float  #: speed (rad/s) over which boundary friction fades, at `MIDDLE`
    viscous: float  #: viscous torque at ``middle`` and `MIDDLE`
    middle: float
    power: float = 0.5
    grease: Vogel = Vogel()

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m."""
        moved = self.grease.viscosity(celsius) * speed
        fades = np.exp(-((moved / self.fading) ** self.power))
        return np.asarray(
            self.least + (self.boundary - self.least) * fades + self.viscous * moved / self.middle
        )


@dataclass(frozen=True)
class ShearHeating:
    """A film of one thickness that heats itself.

    It is hotter than the wall by ``resistance`` x torque x speed.
    The sensor sits in the wall. ``resistance`` in K/W.
    """

    film: float
    resistance: float
    middle: float
    grease: Vogel = Vogel()

    def torque(self, speed: Array, celsius: Array) -> Array:
        """Return torque in N m, by bisection of the film's own temperature (one root: it only thins)."""
        low, high = np.zeros_like(speed), self.resistance * self._at(speed, celsius) * speed
        for _ in range(60):
            rise = 0.5 * (low + high)
            enough = self.resistance * self._at(speed, celsius + rise) * speed <= rise
            low, high = np.where(enough, low, rise), np.where(enough, rise, high)
        return self._at(speed, celsius + 0.5 * (low + high))

    def _at(self, speed: Array, film: Array) -> Array:
        return np.asarray(self.film * self.grease.viscosity(film) * speed / self.middle)

    def heated(self, strength: float, fastest: float) -> ShearHeating:
        """Return it with such a resistance that, unthinned, the film at the fastest speed has thinned so far.

        ``strength`` is the fall of ln viscosity that the power at that speed and `MIDDLE` would cause.
        """
        power = self.film * fastest / self.middle * fastest
        return replace(self, resistance=strength / (self.grease.sensitivity(MIDDLE) * power))
