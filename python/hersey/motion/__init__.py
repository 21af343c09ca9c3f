"""The motion of the belt: names, units and results over the core's physics.

============  ============================================================================
schedule      drive speed, torque or temperature against time
drag          drag laws: force against belt speed and temperature
heat          temperature as a state: two bodies, a heater and friction
whole_torque  a torque of film and drive together where the machine states the no-load torque
belt          what moves: a drivetrain with its drag, or a machine with the law of its log
trajectory    a motion as it was found: samples, changes of mode, energies
simulation    stick-slip motion of the belt, and what it settles to
stepper       the same motion from call to call, with inputs given on the way
parameters    names of the parameters, and the kinds of their units
sets          the parameter sets of a sweep, laid out only as far as they are followed
work          how they are worked out: how exactly, and by whom
following     following them, here or at a worker
checkpoint    a sweep that is kept chunk by chunk, and goes on where it stopped
sweep         what thousands of belts settle to, in one call
scenario      a sweep described by a file
============  ============================================================================
"""
