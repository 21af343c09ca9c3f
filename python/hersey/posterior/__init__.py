"""What dwells, starts, break-away and stick-slip say together: one likelihood, and draws from its posterior.

==========  ======================================================================
priors      stick speed, stiffness, mass, static friction and closure before any start
evidence    what a recording shows beyond its dwells: starts, stick-slip, break-away
traces      evidence found in a recording of torque, speed and temperature
drives      draws of the drive: curve, closure and numbers, and their motion in the core
likelihood  how likely the evidence is for each draw
sampler     tempered sequential Monte Carlo, with its convergence
result      the posterior: V*, probabilities of an operating point, draws
sampling    from log and machine to the posterior
drags       draws as drivetrains and tables of drag, also through many temperatures
typical     the draw whose motion is shown, as a drivetrain and a table of drag
==========  ======================================================================
"""

import sys
from types import ModuleType
from typing import Any

from hersey.posterior.evidence import BreakAway, Start, StickSlip
from hersey.posterior.result import PointProbability, Posterior
from hersey.posterior.sampling import posterior

__all__ = ["BreakAway", "PointProbability", "Posterior", "Start", "StickSlip", "posterior"]


class _Room(ModuleType):
    """Make ``hersey.posterior(points, machine)`` work once the room of that name is imported."""

    def __call__(self, *given: Any, **named: Any) -> Posterior:
        return posterior(*given, **named)


sys.modules[__name__].__class__ = _Room
