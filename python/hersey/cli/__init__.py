"""The commands: each mirrors a verb of the package and computes nothing of its own.

============  ==================================================================
application   the program: its verbs, errors in one line
interruption  Ctrl-C, whatever the program is in the midst of
streams       stdin, stdout and stderr: those that are closed, a result that cannot be written
asking        questions in a terminal, or answers from a pipe
amounts       numbers of a belt: with units, bare, or from the machine's file
loading       what a verb needs, loaded at once
belt          the options that describe a belt, its spring and its drag
columns       columns of a small CSV: a drive's speed over time, a drag curve
groups        an option with its help, and options that belong together as a data class
options       options that several verbs share, and the reading of a log by them
recipe_file   a recipe file as options
quantities    shares, ranges, temperatures and speeds that options name as text
warming       a machine that warms up: its heat and its drag
workers       who works: this process, others of this machine, or a scheduler's
outputs       files that a verb writes: refused early, never replaced unasked
progress      spinner and bar on a terminal
terminal      the one way to print for people: nothing that steers a terminal passes
report ...    one module per verb
============  ==================================================================

A mistake of the user's ends in one line on stderr and exit code 2. The version is printed without loading
the program, the list of verbs without loading a verb.
"""

from __future__ import annotations

import sys

__all__ = ["main"]


def main() -> None:
    """Run the command line."""
    from hersey.cli.streams import standard_streams

    with standard_streams():
        _run()


def _run() -> None:
    if sys.argv[1:] == ["--version"]:
        from hersey import __version__

        print(f"hersey {__version__}")
        return
    from hersey.cli.interruption import comes_of_interrupt, end, interruptible

    try:
        with interruptible():
            from hersey.cli.application import main as run

            run()
    except KeyboardInterrupt:
        end()
    except Exception as error:
        if comes_of_interrupt(error):
            end()
        raise
