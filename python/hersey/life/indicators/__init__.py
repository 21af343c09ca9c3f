"""From the runs of a campaign to indicators: what each run says of each failure mode.

==============  ========================================================================
run_dwells      the runs of a campaign with their dwells, as a torque surface takes them
torque_surface  the torque of a run between its dwells, without a law
shared_kernel   how torque deviates from its trend, learned from all runs
least_torque    the speed of least torque of a run, and how far it is known
load_cases      the states at which a drive that ages fails first
at_states       what the runs say of some states: torque, and its curve
sticking        speeds of stick-slip against those of the points
gear_fatigue    the damage of a gear per age
of_campaign     `indicators_of`: all failure modes whose limits the machine states
==============  ========================================================================
"""
