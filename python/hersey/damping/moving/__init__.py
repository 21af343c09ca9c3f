"""Logs whose torque and speed vary all the time: friction, inertia, gravity and offset from every sample.

===============  ===================================================================
stretches        parts of a log with an even clock
filtering        one low-pass for torque, speed and acceleration alike
speed_noise      noise of the speed, and how wide the low-pass must be
gravity          a load that varies with the angle of the drive
misfit           whether friction departs from the law
refusals         logs that cannot be fitted, and what to do about each
model            the torque of a law of friction with inertia, gravity, offset and delay
correlated       noise whose neighbours are correlated
fitting          least squares with such noise
fit              `fit_moving`: the law is chosen, and what is not friction refused
friction         the numbers: friction, inertia, offset, and what was used
result           `MovingFit`
moving_warnings  what is to be known of it
windows          windows of speed and temperature as steady points
beside_dwells    motion that the dwells of a log leave out
curve            the law as a friction curve, judged by the windows
===============  ===================================================================
"""
