"""Dwells: stretches of constant speed, reduced to one steady point each, with honest standard errors.

==============  =======================================================================
groups          points that share a temperature or a speed
columns         a column of the steady points by its name
points          `SteadyPoints`: one row per dwell, and what is not used
rejection       a stretch of a log that is not used, and why
film_torque     the torque of the film alone: dwells less the no-load torque
counted_speed   slow speeds of an encoder that reads 0 or one count
segments        stretches of a run in which the speed holds
ripple          dwells whose speed ripples with the shaft, put together again
noise           the standard error of a mean where neighbours are correlated
shared_noise    the noise of all dwells together: slow noise is seen
reasons         why a stretch is not used: a kind with its numbers, and the words of it
disturbances    spikes and ripples without which a dwell would be steady
steadiness      whether a stretch is a steady dwell, and why not
settling        where a dwell has settled, by itself and by what all show together
judging         which rows of a stretch are a dwell, or why none are
few_rows        speeds that are held for too few rows to be dwells
one_speed       the speeds that a log holds, however long each lasts
nothing_steady  why a log has no dwell at all, and what to do
zero            the zero of the torque over the log, from every standing stretch
least_duration  speeds and temperatures that only the least duration asked for excludes
doubtful        what is doubtful before a fit: the tare, and what goes together with time
constant        whether the torque varies at all
resolution      the step of a sensor, and the error that rounding leaves in a dwell
relaxation      torque that still relaxes after each change of speed
misleading      errors that the order of a log hides or that its sensors leave
several_loads   what another column changes beside the speed: refused
hersey_number   dwells against viscosity times speed over load
reduction       `steady_points`: from a log to its dwells
reduced         what to write where steady points are needed and something else is given
==============  =======================================================================

The settling at the start of a dwell is cut by the marginal standard error rule (White, Simulation 69
(1997) 323): drop as many samples as makes the standard error of the rest least.
"""

from hersey.damping.dwells.few_rows import held_for_few_rows, rows_of_means
from hersey.damping.dwells.groups import SAME_SPEED, distinct_speeds, groups_of_temperature
from hersey.damping.dwells.noise import mean_and_error
from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.dwells.reduction import steady_points
from hersey.damping.dwells.rejection import Rejection

__all__ = [
    "SAME_SPEED",
    "Rejection",
    "SteadyPoints",
    "distinct_speeds",
    "groups_of_temperature",
    "held_for_few_rows",
    "mean_and_error",
    "rows_of_means",
    "steady_points",
]
