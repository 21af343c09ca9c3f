"""Text tables: CSV and its relatives.

=========  ================================================
numbers    how a text file writes numbers
stamps     how it writes times
layout     where the table starts, and what its columns are
footer     where it ends
delimited  the table, read in blocks
=========  ================================================
"""
