"""How indicators grow with age over specimens, and when they reach a limit.

=============  ===========================================================
laws           how an indicator may grow with age
points         the runs of an indicator as rows of specimens
marginal       the likelihood of what specimens share, specimens integrated out
peaks          where the posterior of what they share is highest
importance     adaptive importance sampling of any density from its mode
posterior      how far specimens, spread and law are known: draws and evidence
law_weights    how the laws are weighed by their evidence
draws          equally probable draws of specimens, and their ages at a limit
limit_ages     the ages at which specimens and population reach a limit
fit            `fit_growth`: the growth of an indicator over specimens
record_blocks  a continuous record as a few values with their errors
=============  ===========================================================
"""
