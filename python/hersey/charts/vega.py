"""Vega in a process of its own: draw a chart, bundle the runtime of the pages.

Vega runs in V8, which ends its process where memory runs out and hears no Ctrl-C while it draws: there it
brings down no command, and is stopped at once.
"""

from __future__ import annotations

import json
import signal
from collections.abc import Sequence
from importlib.util import find_spec
from itertools import accumulate, pairwise
from pathlib import Path

import altair as alt

from hersey.charts.style import Row
from hersey.errors import MissingFileError, OutputError
from hersey.processes.child import Child, FailedError, LostError

#: Version of Vega-Lite that altair speaks, as vl-convert names it.
VEGA_LITE = alt.SCHEMA_VERSION.removeprefix("v").rsplit(".", 1)[0]
_process = Child(Path(__file__).with_name("vega_script.py"))


def drawn(specification: Row, kinds: Sequence[str]) -> list[bytes]:
    """Return a chart as a file of each kind: svg, pdf, or png with two pixels per point.

    Raises
    ------
    OutputError
        If it cannot be drawn, such as for lack of memory.
    """
    content = json.dumps(specification, allow_nan=False).encode()
    reply, files = _asked({"what": "draw", "kinds": list(kinds)}, content)
    ends = accumulate(reply["lengths"], initial=0)
    return [files[start:end] for start, end in pairwise(ends)]


def bundled(snippet: str) -> str:
    """Return one script that holds Vega, Vega-Lite and Vega-Embed, and then runs a line of its own.

    Raises
    ------
    OutputError
        If it cannot be bundled, such as for lack of memory.
    """
    return _asked({"what": "bundle"}, snippet.encode())[1].decode()


def _asked(request: Row, content: bytes) -> tuple[Row, bytes]:
    if find_spec("vl_convert") is None:
        raise MissingFileError(
            "Drawing a figure needs vl-convert, which is not installed: pip install 'hersey[figures]'"
        )
    try:
        reply, block = _process.ask(request | {"version": VEGA_LITE}, content)
        return reply, bytes(block)
    except LostError as error:
        raise OutputError(f"the figures cannot be drawn: {_why(error)}") from None
    except FailedError as error:
        reason = str(error).partition("\n")[0][:200] or error.kind
        raise OutputError(f"the figures cannot be drawn: {reason}") from None


def _why(error: LostError) -> str:
    """Why the renderer ended, from its exit code."""
    if error.code is None:
        return f"the renderer does not run: {error}"
    limit = _memory_limit()
    if limit is not None:
        return (
            "the renderer ran out of memory (the limit of virtual memory is "
            f"{limit / 1e9:.3g} GB: see ulimit -v)"
        )
    if error.code == -getattr(signal, "SIGKILL", 9):
        return "the renderer was killed, as it is where memory runs out"
    return f"the renderer broke down (exit code {error.code})"


def _memory_limit() -> int | None:
    """The limit of virtual memory, bytes; None where there is none, or no such limits."""
    try:
        import resource
    except ImportError:
        return None
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if limit == resource.RLIM_INFINITY else limit
