"""The quickest drive-speed profile from rest that ends in steady sliding, with its own proof.

Between the transition speed and the fold both sliding and stick-slip exist: a drive that comes straight up
may end in stick-slip, one that comes from above the fold slides. The search decides between coming
straight up, overshooting, and waiting for another temperature; draws it has not seen say how often the answer
works.

========= ==================================================================
module    what it holds
========= ==================================================================
trial     one profile on one machine: shape, temperature profile, outcome
draws     machines drawn from what is not known of one, and what must hold
grid      the profiles tried first
search    the quickest profile that works on all but a few of them
probing   the profile that asks least of the drive
obstacles why there is none: the limit, and the number that would do
result    the plan, its table and its words
warming   the film's temperature where heater and plan make it
proof     what fresh draws say of a profile
planner   the whole way: search, proof on fresh draws, plan
of_log    the same for the machine whose drag a log tells
========= ==================================================================
"""

from hersey.stability.plan.of_log import check_temperature, plan_of_log
from hersey.stability.plan.planner import plan_profile
from hersey.stability.plan.result import LimitUse, Plan

__all__ = ["LimitUse", "Plan", "check_temperature", "plan_of_log", "plan_profile"]
