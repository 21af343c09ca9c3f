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

from hersey.posterior.evidence import BreakAway, Start, StickSlip
from hersey.posterior.result import PointProbability, Posterior
from hersey.posterior.sampling import posterior
from hersey.schema.callable_room import make_callable

__all__ = ["BreakAway", "PointProbability", "Posterior", "Start", "StickSlip", "posterior"]

make_callable(__name__, "hersey.posterior.sampling", "posterior")
