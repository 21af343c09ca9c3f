"""Whether the decisions of a report hold on the machine that it is about.

True machines are drawn at random and moved by an integrator of this package. hersey sees only a log and a
machine file, and is asked as a user would ask it: ``hersey report --json``. Nothing of hersey is imported.

========  =============================================================================
curves    shapes of drag curves
belt      a belt on a spring: drag at every speed, and how it comes to rest
motion    its motion, and what that comes to
fold      V*, the drive speed above which stick-slip cannot last
machines  machines drawn at random
logs      their logs, traces and machine files
said      what a report says, read from its JSON document
judged    one report against its machine
table     the results as Markdown
check     the integrator against exact reference values
========  =============================================================================

SI units throughout; temperatures in degC.
"""
