"""How a drive ages, and what ends it.

==========  =====================================================================
age         an age with its unit: pages, hours, cycles
campaign    the file of a life test: units, ages, their steady points and fits
growth      how an indicator grows over several units
fatigue     cycles of torque counted, and the damage that they do to a part
population  ages at failure over many units: Weibull law, B10 and B50
==========  =====================================================================
"""
