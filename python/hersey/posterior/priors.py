"""What is known of a drive before any start: ranges of the machine file, otherwise defaults.

================  =======================================================================
number            default, where the machine file states nothing
================  =======================================================================
stick speed       a factor of 3 either way, every order of magnitude as likely
stiffness, mass   95 % within 20 %
static friction   95 % within 20 % of e times the drag at the stick speed (Eq. 29)
closure           ``retained`` 45 %, ``stiction`` 45 %, ``stribeck`` 10 %
================  =======================================================================
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.distributions import normal_above
from hersey.machine.machine import Machine
from hersey.machine.uncertainty import Uncertainty

#: Closures in the order of the core, and how likely each is before any evidence.
CLOSURES: Mapping[str, float] = {"retained": 0.45, "stiction": 0.45, "stribeck": 0.10}
#: Numbers of the drive, in the order of their latents.
NUMBERS = ("stick_speed", "stiffness", "mass", "static_ratio")
#: Factor by which a stick speed may differ whose range is not stated.
STICK_SPEED_REACH = 3.0
#: Share by which stiffness, mass and static friction may differ (95 %) that nothing is stated of.
SHARE = 0.2
#: Standard deviation of ln static friction over that of Eq. 29 where a start or a statement measures it.
MEASURED_STATIC = 0.6
_DEVIATIONS = 1.96


@dataclass(frozen=True)
class DrivePriors:
    """Priors of `NUMBERS` in SI; the stick speed is that at the temperature at which it is stated."""

    nominal: tuple[float, float, float, float]
    spread: tuple[Uncertainty, Uncertainty, Uncertainty, Uncertainty]

    @classmethod
    def of(cls, machine: Machine, *, break_away_known: bool = False) -> DrivePriors:
        """Return what a machine file states, with defaults for the rest."""
        stick = machine.stick_speed
        stated = machine.uncertainty
        default_range = Uncertainty(limits=(stick / STICK_SPEED_REACH, stick * STICK_SPEED_REACH))
        static = np.expm1(_DEVIATIONS * MEASURED_STATIC) if break_away_known else SHARE
        return cls(
            nominal=(stick, machine.stiffness, machine.mass, float(np.e)),
            spread=(
                stated.get("stick_speed", default_range),
                stated.get("stiffness", Uncertainty(share=SHARE)),
                stated.get("mass", Uncertainty(share=SHARE)),
                Uncertainty(share=float(static)),
            ),
        )

    def at(self, latent: FloatArray) -> FloatArray:
        """Return the numbers, shape (draws, 4), of standard normal latents of the same shape."""
        columns = [
            _value(nominal, spread, latent[:, i])
            for i, (nominal, spread) in enumerate(zip(self.nominal, self.spread, strict=True))
        ]
        columns[3] = np.maximum(columns[3], 1.02)  # a belt at rest withstands more than one that slides
        return np.column_stack(columns)

    def range_of(self, name: str) -> tuple[float, float]:
        """Return the 95 % range of a number before any evidence."""
        index = NUMBERS.index(name)
        ends = _value(self.nominal[index], self.spread[index], np.array([-_DEVIATIONS, _DEVIATIONS]))
        return float(ends[0]), float(ends[1])


def _value(nominal: float, spread: Uncertainty, latent: FloatArray) -> FloatArray:
    if spread.limits is not None:
        low, high = spread.limits
        return np.asarray(low * (high / low) ** normal_above(-latent))
    assert spread.share is not None
    return np.asarray(nominal * np.exp(np.log1p(spread.share) / _DEVIATIONS * latent))
