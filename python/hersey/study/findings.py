"""What was found of a log and its machine, before anything is decided."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from hersey.damping.compare import LogComparison
from hersey.damping.dwells import SteadyPoints
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.surface import DampingSurface
from hersey.decision.behaviour import Behaviour
from hersey.machine.machine import Machine
from hersey.stability.operating_map import OperatingMap
from hersey.study.nip_film import FilmPart
from hersey.study.simulation import SimulationPart
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.regime import Regime

#: From so much on torque is shown in N m, N m.
_LARGE = 1.0


@dataclass(frozen=True, repr=False, kw_only=True)
class Findings:
    """What a log and its machine tell, each piece None where it is not asked for or cannot be had.

    Attributes
    ----------
    points, surface, regime
        Dwells, the fitted law, and what the exponents alone say.
    machine, machine_file
        None without a machine, or where it was not read from a file.
    friction
        Coulomb, viscous and Stribeck friction, if that describes the dwells at least as well.
    nip, torque_budget
        Film theory of the nip, and what film, contact and the no-load torque take; None where the machine
        does not state them.
    behaviour, simulation, why
        What the machine does, and its typical belt below the transition; None without a machine or where
        nothing can be computed, and why not.
    comparison, against
        This log over an earlier one, and the dwells of that one; None unless asked for.
    """

    points: SteadyPoints
    surface: DampingSurface
    regime: Regime
    friction: FrictionCurve | None = None
    machine: Machine | None = None
    machine_file: Path | None = None
    nip: FilmPart | None = None
    torque_budget: TorqueBudgetPart | None = None
    behaviour: Behaviour | None = None
    simulation: SimulationPart | None = None
    why: str = ""
    comparison: LogComparison | None = None
    against: SteadyPoints | None = None

    @property
    def map(self) -> OperatingMap | None:
        """The operating map, if there is one."""
        return None if self.behaviour is None else self.behaviour.map

    @cached_property
    def units(self) -> dict[str, str]:
        """The one unit in which each quantity is shown; torque by the greatest that is spoken of."""
        if not self.points.domain.is_torque:
            unit, speed = self.points.domain.shown[0], self.points.domain.shown_speed[0]
            return {
                "torque": unit,
                "belt_speed": "mm/s",
                "roll_speed": speed,
                "temperature": "°C",
                "force": "N",
            }
        torques = [float(np.abs(self.points.column("torque")).max())]
        if self.map is not None:
            torques += [float(np.max(self.map.holding)), self.map.torque_limit or 0.0]
        return {
            "torque": "N·m" if max(torques) >= _LARGE else "mN·m",
            "belt_speed": "mm/s",
            "roll_speed": "rpm",
            "temperature": "°C",
            "force": "N",
        }
