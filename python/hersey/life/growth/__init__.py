"""How indicators grow with age over units, and when they reach a limit.

=============  ===========================================================
laws           how an indicator may grow with age
posterior      how far units, spread and law are known: draws and evidence
limit_ages     the ages at which units and population reach a limit
fit            `fit_growth`: the growth of an indicator over units
record_blocks  a continuous record as a few values with their errors
=============  ===========================================================
"""
