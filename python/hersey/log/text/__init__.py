"""Text tables: CSV and its relatives.

===============  ================================================
numbers          how a text file writes numbers
stamps           how it writes times
layout           where the table starts, and what its columns are
footer           where it ends
repeated_header  a header that stands again among the rows
unit_pairs       two units given for one column
delimited        the table, read in blocks
===============  ================================================
"""
