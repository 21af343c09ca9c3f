"""Friction from a coast-down: speed against time and a known moment of inertia, no torque.

    J dw/dt = -(T_0 + k w + q w^2)

The speeds themselves are fitted, by the solution of this equation; nothing is differentiated.

===========  ==========================================================================
closed_form  speed against time in closed form, with its derivatives
noise        noise of the speeds, and what correlation does to a fit
fitting      one law fitted to all coasts
steps        falls between held speeds, which a drive sets
coasts       the coasts of a log, and what else it holds
ends         rows at the ends of a coast in which something still acts
departures   another shape of the law, coasts that differ
windows      friction in windows of speed, for `hersey.fit`
doubts       warnings: terms that cannot be separated, misfit, braking
result       `CoastDown`: terms, torque against speed, points
coasting     from a log to all of that
===========  ==========================================================================

Friction of the three terms is never negative and never falls with speed.
"""

from hersey.damping.coast_down.coasting import coast_down
from hersey.damping.coast_down.result import CoastDown

__all__ = ["CoastDown", "coast_down"]
