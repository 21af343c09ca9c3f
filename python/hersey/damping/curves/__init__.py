"""Drag curves that the dwells allow: every law that is not rejected, and a smooth curve without a formula.

===========  ======================================================================
shapes       ln torque over ln Hersey number: the laws, with priors of their numbers
shared_load  the law of the contact that the machine file states
dwells       what a law must predict: dwells with their errors, shared ones too
fitting      the likeliest numbers of a law, their covariance, and its AICc
beyond       how curves go on where there are no dwells
mixture      all laws by weight, and curves drawn from them
words        the laws by weight, as text
===========  ======================================================================

A law is a function of the Hersey number, viscosity times speed: temperature moves its speeds. Laws are
weighted by AICc, which estimates how well they predict dwells that were excluded. One that misses the dwells
by more than chance, judged by the curve without a formula, is rejected. Beyond the dwells the slope of every
curve is free to drift, and each drawn curve drifts in its own way.
"""

from hersey.damping.curves.mixture import CurveMixture, LawWeight, fit_curves

__all__ = ["CurveMixture", "LawWeight", "fit_curves"]
