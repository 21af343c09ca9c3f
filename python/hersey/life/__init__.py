"""How a drive ages, and what ends it.

==========  =====================================================================
fatigue     cycles of torque counted, and the damage that they do to a part
population  ages at failure over many units: Weibull law, B10 and B50
==========  =====================================================================
"""
