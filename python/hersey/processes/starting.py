"""Processes that end with this one, however it ends: the kernel sees to it on Linux.

The kernel ends them when the thread ends that started them, so one thread starts all and lasts as long as
this process.
"""

from __future__ import annotations

import os
import queue
import subprocess
import threading
from collections.abc import Callable
from concurrent.futures import Future

_Start = Callable[[], "subprocess.Popen[bytes]"]


def started(start: _Start) -> subprocess.Popen[bytes]:
    """Return the process that a function starts; it is called in the thread that lasts.

    Raises
    ------
    OSError
        If it cannot be started.
    """
    future: Future[subprocess.Popen[bytes]] = Future()
    try:
        requests = _requests()
    except RuntimeError:  # memory is too short for a thread: the process may end with this one, which is safe
        return start()
    requests.put((start, future))
    try:
        return future.result()
    except BaseException:  # Ctrl-C: nobody will hold what starts now
        future.add_done_callback(_end)
        raise


def _end(future: Future[subprocess.Popen[bytes]]) -> None:
    if future.exception() is None:
        future.result().kill()
        future.result().wait()


_Requests = queue.SimpleQueue[tuple[_Start, "Future[subprocess.Popen[bytes]]"]]
_lock = threading.Lock()
_asked: _Requests | None = None


def _requests() -> _Requests:
    """The requests to the thread, which is started with the first."""
    global _asked
    with _lock:
        if _asked is None:
            asked: _Requests = queue.SimpleQueue()
            threading.Thread(target=_serve, args=(asked,), name="hersey-starts", daemon=True).start()
            _asked = asked
        return _asked


def _serve(requests: _Requests) -> None:
    while True:
        start, future = requests.get()
        try:
            future.set_result(start())
        except BaseException as error:
            future.set_exception(error)
        del start, future  # which hold the process


def _forget_thread() -> None:
    """Have a thread of its own in a forked process: that of its parent is not in it."""
    global _asked, _lock
    _asked, _lock = None, threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_thread)
