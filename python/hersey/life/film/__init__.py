"""The film through life: the layer of oil that runs tell, how it thins, and when it starves.

==============  ===============================================================================
filled_dwells   the dwells of all runs as arrays
starved_drag    torque against viscosity, no-load torque, layer of oil and what does not follow it
run_search      what is most likely in each run: a damped search of all runs at once
common_to_runs  what all runs have in common, fitted to all of them together
layer           the layer of oil and the viscosity of each run
shares          how much of the drag does not follow the film, and how likely that is
depletion_law   how the layer thins over ages and specimens
depletion_draws draws of that law
of_runs         the film that each run shows, and starvation as an indicator
starving        when specimens starve, and the oil that they have left
warnings        what is not known of it
through_life    `film_life`: film, oil that is left, ages at which specimens starve
==============  ===============================================================================
"""
