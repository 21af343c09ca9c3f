"""Channels that no column holds: from file names, a table of runs, a schedule, a position, a direction.

=============  ============================================================================
file_names     speed, load, radius or temperature in the names of the files, by a pattern
run_table      the same in a table with a row for each file
set_points     speed, temperature or load of a log by a schedule: what was asked for
schedule_file  a schedule in a table of its own
position       speed from a position, an angle or counts
direction      the sign of a speed that was recorded without one
given          what all this gives for one file
speeds         the speed that a position and a direction make, and what is to be said of it
sources        what is said of all this, for all files of a log
text           a text file as a recording, whose columns can be taken one by one
=============  ============================================================================
"""
