"""The streams of the program: those that it was started without, and a result that nobody can receive."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

#: Exit code of a result that could not be written, as of any mistake of the user's.
UNWRITTEN = 2


@contextmanager
def standard_streams() -> Iterator[None]:
    """Run the program with all three streams, and end with an error where its result cannot be written.

    A closed pipe is no error: whoever reads has seen enough.
    """
    lacks_stdout = sys.stdout is None
    _open_missing()
    if lacks_stdout:
        _complain("stdout is closed, so that no result can be shown: send it to a file, or to /dev/null")
        sys.exit(UNWRITTEN)
    code: object = 0
    try:
        try:
            yield
        except SystemExit as end:  # also that of typer where a pipe is closed
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
    """Open the null device for each stream that is closed, so that no file of ours gets its number."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free
    sys.stdin = sys.stdin or open(os.devnull, encoding="utf-8")  # noqa: PTH123,SIM115 - to the end
    sys.stdout = sys.stdout or open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123,SIM115
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123,SIM115


def _give_up_stdout() -> None:
    """Let what waits to be written go nowhere, or Python would fail on it at its end."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complain(message: str) -> None:
    from hersey.cli.terminal import say

    with suppress(OSError):
        say(f"hersey: {message}", file=sys.stderr)
