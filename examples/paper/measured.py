"""What Figs. 2 to 8 are drawn of: the dwells of a log, the surface fitted to them, its branches."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.estimate import Estimate
from hersey.damping.fit import fit
from hersey.damping.surface import DampingSurface
from hersey.units import celsius
from hersey.verdict.regime import branch_exponents

#: Names of the branch on which torque falls with speed, and of one alone, as `BranchExponent` has them.
FALLING, ALONE = "mixed", "all"


@dataclass(frozen=True)
class Branch:
    """Dwells of one temperature (K; None if not recorded) on one branch, and the power law through them.

    Damping is ``level`` (N m s/rad at 1 rad/s) times speed (rad/s) to the ``exponent``; ``index`` names the
    dwells.
    """

    kelvin: float | None
    falls: bool
    index: IntArray
    exponent: Estimate
    level: float

    def damping(self, speed: FloatArray) -> FloatArray:
        """Return the damping of the power law at speeds (rad/s), N m s/rad."""
        return np.asarray(self.level * speed**self.exponent.value)

    @property
    def where(self) -> str:
        """The temperature in words, if it is known."""
        return "" if self.kelvin is None else f" at {celsius(self.kelvin):.0f} degC"


@dataclass(frozen=True)
class Measured:
    """The dwells of a log and the surface fitted to them."""

    points: SteadyPoints
    surface: DampingSurface

    @classmethod
    def of(cls, points: SteadyPoints, *, temperature_scale: str = "degC") -> Measured:
        """Fit the surface to steady points.

        Raises
        ------
        InsufficientDataError
            If they cannot determine it.
        """
        return cls(points, fit(points, temperature_scale=temperature_scale))

    @cached_property
    def speed(self) -> FloatArray:
        """Of the dwells, rad/s."""
        return np.abs(self.points.column("speed"))

    @cached_property
    def torque(self) -> FloatArray:
        """Of the dwells, N m."""
        return np.abs(self.points.column("torque"))

    @property
    def damping(self) -> FloatArray:
        """Of the dwells, N m s/rad."""
        return np.asarray(self.torque / self.speed)

    @property
    def name(self) -> str:
        """The file, as titles name it, and whether its torque is that of the film alone."""
        name = self.points.log.files[0].name
        return name if self.points.rest is None else f"{name}, no-load torque taken off"

    @cached_property
    def groups(self) -> list[tuple[float | None, IntArray]]:
        """Each temperature, K, with the indices of its dwells, coldest first."""
        if self.surface.b is None:
            return [(None, np.arange(self.speed.size))]
        kelvin = np.asarray(self.points.column("temperature"), dtype=float)
        return [(float(kelvin[group].mean()), group) for group in groups_of_temperature(kelvin)]

    @cached_property
    def kelvin(self) -> list[float | None]:
        """Temperature of the group of each dwell, K."""
        of: list[float | None] = [None] * self.speed.size
        for kelvin, group in self.groups:
            for i in group:
                of[i] = kelvin
        return of

    @cached_property
    def branches(self) -> list[Branch]:
        """Every branch with an exponent, as the verdict on the regime has them."""
        found = []
        of = dict(self.groups)
        for each in branch_exponents(self.points, self.surface):
            group = of[each.temperature]
            speed = self.speed[group]
            index = group[(speed >= each.speed_low) & (speed <= each.speed_high)]
            logs = np.log(self.damping[index]) - each.exponent.value * np.log(self.speed[index])
            falls = each.branch == FALLING or (each.branch == ALONE and each.exponent.value < -1.0)
            found.append(Branch(each.temperature, falls, index, each.exponent, float(np.exp(logs.mean()))))
        return found

    @property
    def rising(self) -> list[Branch]:
        """Branches on which torque rises with speed."""
        return [branch for branch in self.branches if not branch.falls]
