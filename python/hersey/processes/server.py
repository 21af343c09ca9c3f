"""What runs in a process of our own: it answers requests with a script's function, until there are no more.

Run as ``python -P server.py SCRIPT PARENT [FILES]`` by `hersey.processes.child`: the number of its parent and
the descriptor of a socket, where the system can pass files. The script defines ``answer(request, payload)``,
which returns a dictionary that JSON can hold and a block of bytes; ``request["file"]`` is the descriptor of a
file. A message is the length of its JSON and of its bytes (8 bytes each, little-endian), then both; the JSON
of a reply holds ``reply``, or ``failed`` (the kind of exception) and ``message``.
"""

from __future__ import annotations

import json
import os
import runpy
import signal
import socket
import struct
import sys
from collections.abc import Callable
from typing import Any, BinaryIO

_LENGTHS = struct.Struct("<QQ")
_PR_SET_PDEATHSIG = 1
_Answer = Callable[[dict[str, Any], bytes], tuple[dict[str, Any], bytes]]


def serve(answer: _Answer, requests: BinaryIO, replies: BinaryIO, files: int = -1) -> None:
    """Answer requests until their end; ``files`` is the descriptor of the socket through which files come."""
    while lengths := requests.read(_LENGTHS.size):
        if len(lengths) < _LENGTHS.size:
            return
        first, second = _LENGTHS.unpack(lengths)
        request, payload = json.loads(requests.read(first)), requests.read(second)
        if len(payload) < second:
            return
        if request.get("file"):
            request["file"] = received(files)
        try:
            reply, content = answer(request, payload)
            head = json.dumps({"reply": reply}).encode()
        except BaseException as error:  # a panic of a compiled library is no Exception
            kind = MemoryError if isinstance(error, MemoryError) else type(error)  # NumPy has one of its own
            head, content = json.dumps({"failed": kind.__name__, "message": str(error)}).encode(), b""
        replies.write(_LENGTHS.pack(len(head), len(content)) + head)
        replies.write(content)
        replies.flush()


def received(files: int) -> int:
    """Return the descriptor of the next file that comes through a socket."""
    with socket.socket(fileno=os.dup(files)) as end:
        return socket.recv_fds(end, 1, 1)[1][0]


def die_with_parent(parent: int) -> None:
    """Let the kernel end this process with its parent, whatever it does then.

    Elsewhere than on Linux the process ends with its requests. The kernel looks at the thread that started
    this process, see `hersey.processes.starting`.
    """
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it ended before the kernel was asked
            os._exit(1)


def leave_no_core() -> None:
    """Let a library that breaks down leave no image of the memory in the user's folder."""
    if os.name == "posix":
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def answering(script: str) -> _Answer:
    """Return the script's function; one that cannot be started answers each request with the reason."""
    try:
        answer: _Answer = runpy.run_path(script, run_name="__main__")["answer"]
    except BaseException as error:
        reason = f"{type(error).__name__}: {error}"

        def failed(_request: dict[str, Any], _payload: bytes) -> tuple[dict[str, Any], bytes]:
            raise NotStarted(reason)

        return failed
    return answer


class NotStarted(Exception):  # noqa: N818 # its name tells the parent what happened
    """The script itself failed."""


def main() -> None:
    """Serve a script; what it prints goes nowhere."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the parent too, which stops its processes
    script, parent, files = sys.argv[1], *map(int, [*sys.argv[2:], "-1"][:2])
    die_with_parent(parent)
    leave_no_core()
    replies = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    serve(answering(script), sys.stdin.buffer, replies, files)


if __name__ == "__main__":
    main()
