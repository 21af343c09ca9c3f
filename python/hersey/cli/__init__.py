"""The commands: each calls a function of the package and computes nothing of its own.

============  ==================================================================
application   the program: its commands in groups, errors in one line
interruption  Ctrl-C at any moment
streams       stdin, stdout and stderr: closed streams, a result that cannot be written
asking        questions in a terminal, or answers from a pipe
amounts       numbers of a belt: with units, bare, or from the machine file
loading       loading many modules at once
belt          the options that describe a belt, its spring and its drag
columns       columns of a small CSV: a drive speed over time, a drag curve
groups        an option with its help, and options that belong together as a data class
options       options that several commands share, and the reading of a log by them
mistyped      what to type instead of a command line that cannot be understood
light_help    help without what typer loads for it in vain
long_dashes   the same where a word processor has joined the dashes of an option
completed     the options that an export cannot do without, for a line that is proposed
recipe_file   a recipe file as options
quantities    shares, ranges, temperatures and speeds of options
named_logs    the logs that words name, without tables that hersey wrote
traces        what a recording for a trace lacks, and how to read it for itself
no_torque     what to type for a log without a torque
no_load       the no-load log of a machine, given among the logs of its film
warming       a machine that heats up: its heat balance and its drag
workers       worker processes on this machine, or those of a scheduler
outputs       files that a command writes: refused early, never replaced without being asked
printing      how much a command prints: --verbose, --quiet, --json
figures       numbers with three figures and units, intervals, tables
progress      progress on stderr: spinner and bar, or plain lines
terminal      the one way to print for people: no control codes, no line too wide
report ...    one module per command
============  ==================================================================

An error of the user ends in one line on stderr and exit code 2. The version is printed without loading the
program, the list of commands without loading a command.
"""

from __future__ import annotations

import sys
from typing import NoReturn

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
    from hersey.cli.loading import loading

    try:
        with interruptible():
            with loading():
                from hersey.cli.application import main as run
            run()
    except KeyboardInterrupt:
        end()
    except OSError as error:  # a stream that is closed
        if comes_of_interrupt(error):
            end()
        raise
    except Exception as error:
        if comes_of_interrupt(error):
            end()
        _report_fault()


def _report_fault() -> NoReturn:
    """Print the traceback of an error that is a fault of the program, and exit."""
    import traceback

    from hersey.cli.application import FAULT

    traceback.print_exc()
    sys.stderr.write("hersey: this is a fault of hersey. Please report it with the lines above.\n")
    sys.exit(FAULT)
