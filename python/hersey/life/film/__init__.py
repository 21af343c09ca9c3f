"""The film through life: the layer of oil that runs tell, how it thins, and when it starves.

=============  ===============================================================
filled_dwells  the dwells of all runs as arrays
starved_drag   torque against viscosity, no-load torque and layer of oil
layer          the layer of oil and the viscosity of each run
depletion_law  how the layer thins over ages and specimens: draws
of_runs        the film that each run shows, and starvation as an indicator
starving       when specimens starve, and the oil that they have left
through_life   `film_life`: film, oil that is left, ages at which specimens starve
=============  ===============================================================
"""
