"""Exports that do not show by themselves how they are to be read: ``[layout]`` of a mapping says it.

=============  ====================================================================
pattern        patterns with placeholders, as "Step {run}: {speed} rpm"
table          the table ``[layout]``
presets        layouts of known instruments
pages          the lines of a text, or of each sheet of a workbook
sections       lines cut into tables, each with what it states
grids          the table of a section, and the runs of a wide one
stacking       runs below each other as one recording
signals_apart  channels with clocks of their own
current        the layout by which files are read at the moment
laid_out       a file read by a layout
seen           what of a file may be its layout
proposing      the layout proposed for a file
recognized     what becomes of a file that is no log as it stands
=============  ====================================================================
"""
