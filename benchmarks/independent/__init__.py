"""Torque logs of a generator of its own, and what hersey says of them.

The generator (``laws``, ``logs``, ``known``) is written from physics alone and imports nothing of hersey; the
parts that judge (``intervals``, ``verdicts``, ``transitions``) use its public names only.

===========  ==========================================================================
laws         what torque is: films, friction, thinning, heating
logs         from a law, a plan of the test and the sensors' errors to a CSV file
known        the least error of each parameter, where the structure of errors is known
judged       one log through `hersey.read`, `steady`, `fit` and `regime`
own          part 0: the generator judged by itself
intervals    part A: do 95 % intervals hold the truth, and how wide are they
verdicts     part B: is a regime named that is not the truth's
transitions  part C: transitions announced that are none, and missed
===========  ==========================================================================

Speed in rad/s, temperature in degC (film or reading, as said), torque in N m.
"""
