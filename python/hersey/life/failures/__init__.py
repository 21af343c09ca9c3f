"""Failures and suspensions, typed in: their law, and what it says of specimens that still run.

=============  ======================================================================
distributions  Weibull, lognormal and gamma law of ages
maximum        the greatest of a function, many rows at once
crossing       where functions pass 0, many at once
likelihood     of ages known exactly, at least, at most or between two
sample         failures and suspensions, with counts, failure modes and stress
cells          cells of a table of specimens
table          from a table to a sample
replicates     samples drawn from a fitted law under the plan of the real one
fit            the law of greatest likelihood and its calibrated bounds
draws          parameters that the sample leaves possible
positions      shares failed without any law: Kaplan and Meier, Turnbull
goodness       how well a law fits: Anderson and Darling
acceleration   life against temperature or load
records        parameters, laws compared, failure modes
law            the law as a result, and in words
warnings       few failures, none, or another law that fits better
estimate       from a sample to its law: `weibull`
forecast       the remaining life of a specimen, the failures of a fleet
test_plan      how many specimens to test, and how long
answers        all that is asked at once
=============  ======================================================================
"""
