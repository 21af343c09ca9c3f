"""Processes of our own in which libraries run that may break down, run away, or cannot be interrupted.

===========  =====================================================================
child        a process that answers what it is asked, and never outlives its parent
server       what runs in it: takes requests, gives them to a script, replies
confinement  what it may use while it reads a file of a stranger
forks        whether this process was forked from one in which polars had run
===========  =====================================================================

Requests and replies are JSON with a block of bytes, never pickles: nothing that runs there can make code run
here. A script imports nothing of this package, so that its process starts in a moment.
"""
