"""The file of a life test: steady points and fits of many runs of many specimens, in one SQLite file.

=============  =======================================================================
entry          a run as it is kept: its dwells, and all else as text
kept_warnings  its warnings as JSON, and back
records        its records as JSON, and back
conversion     what is kept of a run, from its steady points and back
guarded        a connection to a file from anywhere: limits of length and work
content        whether a file holds what this package writes
store          the file: its schema and version, opening, transactions, errors
adding         which runs are new, there already, changed or under another specimen
events         maintenance of specimens, as the file keeps it
table          a table of runs: log, specimen and age in each row
checks         whether files, ages and fits are as they should be
kept_reads     what was read, kept until somebody changes the file
listing        the runs as a table, and the specimens as text
diagnosed      the runs as `life.diagnostics` compares them
dwells         the dwells of all runs, as a table or as numbers
file           `Campaign`: add, list, read back, export
=============  =======================================================================

Logs stay where they are; the file holds their paths and hashes. What is committed survives a process that is
killed at any moment; writers wait for each other.
"""

from hersey.life.campaign.adding import Added
from hersey.life.campaign.checks import CampaignCheck
from hersey.life.campaign.entry import Entry
from hersey.life.campaign.file import Campaign
from hersey.life.campaign.table import RunsTable, RunToAdd, lists_runs, read_runs, rows_of

__all__ = [
    "Added",
    "Campaign",
    "CampaignCheck",
    "Entry",
    "RunToAdd",
    "RunsTable",
    "lists_runs",
    "read_runs",
    "rows_of",
]
