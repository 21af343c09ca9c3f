"""Friction against age in one log at one speed: run-in, growth, steady value.

=========  ====================================================================
record     the rows of a log at one speed: age, friction, temperature
blocks     a record as means of blocks, and the correlation of their noise
shapes     the courses of growth laws, up or down
comparing  courses compared by their likelihood, and draws of what they say
jumps      sudden changes that no course explains
said       numbers of draws: steady value, its age, time constant, rate
shown      ages, rates and friction in the units that people read
doubts     warnings: jumps, temperature, log too short, rows left out
result     `FrictionTrend`
fit        `trend`: friction against time, distance or revolutions
=========  ====================================================================
"""
