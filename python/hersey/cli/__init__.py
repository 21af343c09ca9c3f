"""The commands: each mirrors a verb of the package and computes nothing of its own.

===========  ==================================================================
application  the program: its verbs, errors in one line, Ctrl-C
options      options that several verbs share, and the reading of a log by them
outputs      files that a verb writes: refused early, never replaced unasked
progress     spinner and bar on a terminal
report ...   one module per verb
===========  ==================================================================

A mistake of the user's ends in one line on stderr and exit code 2.
"""

from hersey.cli.application import app, main

__all__ = ["app", "main"]
