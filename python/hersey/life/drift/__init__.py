"""What moved with age, and what it points to: all runs fitted together.

==============  =============================================================
aged_torque     the torque of a drive at an age, by its parts
mixed_effects   values of runs that change with age, differently in each specimen
dwells          the dwells of all runs as the fit takes them
fit             the joint fit of all runs
quantities      what moved with age, in numbers
readings        what a drift points to
result          `fit_drift`, and `Drift` with its words
==============  =============================================================
"""
