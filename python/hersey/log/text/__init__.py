"""Text tables: CSV and its relatives.

===============  ================================================
numbers          how a text file writes numbers
stamps           how it writes times
split_seconds    times in whole seconds beside a column of milliseconds
column           a column: name and unit
decimal_commas   commas between the columns that are decimal marks too
separators       what stands between cells, and the rows of numbers that it makes
header           names and units of the columns, from the lines above
dated_numbers    dates that a spreadsheet has made of numbers
units_in_cells   numbers with their unit, where the header should have it
orientation      tables whose channels are not columns, which are refused
layout           where the table starts, and what its columns are
footer           where it ends
repeated_header  a header that stands again among the rows
unit_pairs       two units given for one column
blocks           its lines, a block at a time
cells            the cells of a block as numbers
delimited        the table of a file: its channels, and the rows that can be used
===============  ================================================
"""
