"""From a log to the law of its damping.

==========  =========================================================
dwells      dwells, reduced to steady points with honest errors
estimation  weighted least squares with an unknown scatter
law         B = a T^b w^c in logarithms, and the data it is fitted to
branches    two branches of the law: whether, and where they meet
surface     the fitted damping surface
candidates  every law fitted to the same dwells, one chosen
compare     two logs against each other
design      which dwells to record next
==========  =========================================================
"""
