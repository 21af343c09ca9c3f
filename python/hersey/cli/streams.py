"""stdin, stdout and stderr: streams that are closed, and a result that cannot be written."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

#: Exit code if the result cannot be written, the same as for wrong use.
UNWRITTEN = 2


@contextmanager
def standard_streams() -> Iterator[None]:
    """Run the program with all three streams, and end with an error if its result cannot be written.

    A pipe that its reader closes is not an error.
    """
    lacks_stdout = sys.stdout is None
    _open_missing()
    if lacks_stdout:
        _complain("stdout is closed, so no result can be shown: send it to a file, or to /dev/null")
        sys.exit(UNWRITTEN)
    code: object = 0
    try:
        try:
            yield
        except SystemExit as end:  # also that of typer if a pipe is closed
            code = 0 if isinstance(end.__context__, BrokenPipeError) else end.code
        sys.stdout.flush()
    except BrokenPipeError:
        _give_up_stdout()
    except OSError as error:
        _give_up_stdout()
        _complain(f"cannot write the result: {error.strerror}")
        code = UNWRITTEN
    sys.exit(code)  # type: ignore[arg-type]  # as another SystemExit had it


def _open_missing() -> None:
    """Open the null device for each closed stream, so that no other file gets its number."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free
    sys.stdin = sys.stdin or open(os.devnull, encoding="utf-8")  # noqa: PTH123,SIM115 - to the end
    sys.stdout = sys.stdout or open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123,SIM115
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123,SIM115


def _give_up_stdout() -> None:
    """Discard what is still to be written, or Python would fail on it at exit."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complain(message: str) -> None:
    from hersey.cli.terminal import say

    with suppress(OSError):
        say(f"hersey: {message}", file=sys.stderr)
