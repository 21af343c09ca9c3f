"""How a drive ages, and what ends it.

================  =====================================================================
age               an age with its unit: pages, hours, cycles
campaign          the file of a life test: units, ages, their steady points and fits
indicator         one way to fail: a number of each run against a limit
torque_surface    the torque of a run between its dwells, without a law
run_dwells        the runs of a campaign with their dwells, as a torque surface takes them
corners           the states at which a drive that ages fails first
at_states         what the runs of a campaign say of some states: torque, and its curve
sticking          speeds of stick-slip against those of the points
gear_fatigue      the damage of a gear per age
indicators        from the runs of a campaign to each way to fail
drying            a layer that side flow and evaporation thin at once
growth_laws       how an indicator may grow with age
growth_posterior  how far units, spread and law are known: draws and evidence
limit_ages        the ages at which units and population reach a limit
growth            the growth of an indicator over units
joined            draws of several ways to fail side by side
next_run          what to measure next, and how far it would narrow an interval
aged_torque       the torque of a drive at an age, by its parts
units_with_age    values of runs that change with age, differently in each unit
drift_fit         the joint fit of all runs
drift_quantities  what moved with age, in numbers
drift_readings    what a drift points to
drift             what moved with age, and what it points to
record_blocks     a continuous record as a few values with their errors
fatigue           cycles of torque counted, and the damage that they do to a part
population        ages at failure over many units: Weibull law, B10 and B50
ending            what ends each unit, and when
filled_dwells     the dwells of all runs as arrays
starved_drag      torque against viscosity, rest of the drive and layer of oil
layer             the layer of oil and the viscosity that each run tells
depletion_law     how the layer thins over ages and units: draws
depletion         the film through life, the oil that is left, and when it starves
ageing_maps       the operating map of a unit when new, now and at its end
following         a life test followed, in one answer
================  =====================================================================
"""
