"""The local app: a page on this computer alone, from dropped logs to the report.

========  =====================================================================
starting  a free port, a token, a folder of this start's own; until Ctrl-C
server    what the page may ask, and the answers
door      connections: those that only hold one open are ended
guard     who may ask: this computer, this page, with this start's token
uploads   dropped files, to disk as they come, within bounds
session   the analyses of one start
analysis  one analysis: files, choices, machine, and how far it is
channels  what is wrong with the choices, where, and what mends it
checking  what stands before a run
view      what the page shows of an analysis
course    how long a run takes, once one like it has ended
machine   what is wrong with the answers about the machine
recipe    a recipe that was dropped
workers   processes that read and compute, ended by whoever waits for them
worker    what runs in such a process
looking   what the page shows of a file
running   from files and choices to a report
kept      reports of earlier starts, and the summary of a report
static    the page
========  =====================================================================

Files are known to the page by numbers drawn at random, never by a path; what a file says reaches it as text.
"""
