"""Processes of our own in which libraries run that may break down, run away, or cannot be interrupted.

============  =====================================================================
child         a process that answers what it is asked, and never outlives its parent
server        what runs in it: takes requests, gives them to a script, replies
starting      processes started so that the kernel ends them with this one
limits        how much memory and processor time a process may take
confinement   what a process may reach while it reads an untrusted file
system_calls  the system calls that it may make then
forks         whether this process was forked from one in which polars had run
============  =====================================================================

Requests and replies are JSON with a block of bytes, never pickles: nothing that runs there can make code run
here. A script imports nothing of this package, so that its process starts in a moment.
"""
