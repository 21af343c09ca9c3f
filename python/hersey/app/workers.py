"""Processes that read and compute: each ends with its task, with whoever waits for it, and with the app."""

from __future__ import annotations

import asyncio
import json
import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from hersey.processes.child import import_path

#: Longest line that such a process says: results go through a file.
_LONGEST = 1 << 20


class EndedError(Exception):
    """A process ended without a result: killed for lack of memory, or crashed."""


class Refused(Exception):  # noqa: N818 - no fault of the program: what was asked cannot be done
    """The request cannot be fulfilled, in words for the user; ``problem`` is the error as data."""

    def __init__(self, words: str, problem: Mapping[str, Any]) -> None:
        """Take the words, and what `HerseyError.to_dict` gives."""
        super().__init__(words)
        self.problem = problem


async def ask(
    request: dict[str, Any], folder: Path, said: Callable[[str, float | None], None]
) -> dict[str, Any]:
    """Run `hersey.app.worker` on a request and return its result.

    Parameters
    ----------
    request
        What it is asked, JSON.
    folder
        Where it may leave its result.
    said
        Called with each step and the share of the whole, None where it is not known.

    Raises
    ------
    Refused
        If what was asked cannot be done; the message is for the user.
    EndedError
        If the process ended without a result.
    """
    result = folder / f"{request['task']}.json"
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        "-P",
        "-m",
        "hersey.app.worker",
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.DEVNULL,
        env={**os.environ, **import_path()},
        limit=_LONGEST,
        start_new_session=True,  # Ctrl-C is for the server, which ends what it started
    )
    assert process.stdin is not None
    assert process.stdout is not None
    refused: Refused | None = None
    ended = False
    try:
        process.stdin.write(json.dumps(request | {"result": str(result)}).encode() + b"\n")
        await process.stdin.drain()
        async for line in process.stdout:
            word = json.loads(line)
            if "refused" in word:
                refused = Refused(word["refused"], word["problem"])
            elif "step" in word:
                said(word["step"], word["share"])
            elif word.get("done"):
                ended = True
                return dict(json.loads(await asyncio.to_thread(result.read_text)))
        ended = True
        raise refused or EndedError("it ended without a result")
    except (ConnectionError, ValueError) as error:
        raise EndedError(str(error)) from None
    finally:
        process.stdin.close()  # which it takes for the end
        if not ended:
            with suppress(ProcessLookupError):
                process.kill()
        await process.wait()
