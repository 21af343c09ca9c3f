"""How a drive ages, and what ends it.

===============  ==================================================================
age              an age with its specimen: pages, hours, cycles
campaign         the file of a life test: specimens, ages, their steady points and fits
indicator        one failure mode: a number of each run against a limit
indicators       from the runs of a campaign to each failure mode
diagnostics      which runs do not fit the others, and the likeliest slip behind each
fatigue          cycles of torque counted, and the damage that they do to a part
failures         failures and suspensions typed in: their law, remaining life, a fleet, the next test
growth           how indicators grow, and the ages at their limits
drift            what moved with age, and what it points to
maintenance      what was done to a specimen, and the stretches of its life between
padded_rows      lists of runs or dwells as rows of equal length
oil_layer        the layer of oil: how it thins, and how far it starves the film
film             the film through life, the oil that is left, and when it starves
replacement      the age at which a planned replacement costs least
time_to_failure  what ends each specimen, and when
other_uses       the same where limit, coldest start or duty is another one
ageing_maps      the operating map of a specimen when new, now and at its end
map_edges        transition and V* of these maps, and where they are measured
trend            friction against age in one log at one speed
following        a life test followed, in one answer
===============  ==================================================================
"""
