"""What runs in a process of its own: takes one request from stdin, says how far it is, leaves a result.

It ends when stdin does: with the process that started it, even one that is killed.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import warnings
from pathlib import Path
from typing import Any

from hersey.errors import HerseyError, speak
from hersey.files.writing import write_atomically


def main() -> None:
    """Answer one request."""
    speak("page")
    request = json.loads(sys.stdin.buffer.readline())
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            answer = _answer(request)
        write_atomically(Path(request["result"]), json.dumps(answer), overwrite=True)
        tell(done=True)
    except HerseyError as error:
        tell(refused=str(error), problem=error.to_dict())
    except MemoryError:
        full = HerseyError("the log does not fit into the memory of this computer: thin it or cut it")
        tell(refused=str(full), problem=full.to_dict())


def tell(**words: Any) -> None:
    """Send a message to the process that waits."""
    sys.stdout.write(json.dumps(words) + "\n")
    sys.stdout.flush()


def step(name: str, share: float | None = None) -> None:
    """Report a step, and the share of the whole if it is known."""
    tell(step=name, share=share)


def _answer(request: dict[str, Any]) -> dict[str, Any]:
    if request["task"] == "look":
        from hersey.app.looking import look

        return look(Path(request["path"]))
    from hersey.app.running import run

    return run(request, step)


def _end_with_parent() -> None:
    sys.stdin.buffer.read()
    os._exit(1)


if __name__ == "__main__":
    main()
