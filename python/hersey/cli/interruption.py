"""Ctrl-C at any moment.

Python raises `KeyboardInterrupt` between two of its own instructions, so a library that computes for long in
native code delays it, and one that catches every exception loses it. A thread here sees the signal at once,
gives the program a moment to end, and then ends it.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

#: Exit code after Ctrl-C, as shells have it.
INTERRUPTED = 130
#: Time that the program has to end, s.
_PATIENCE = 0.25
_ending = threading.Lock()


@contextmanager
def interruptible() -> Iterator[None]:
    """Raise `KeyboardInterrupt` on Ctrl-C and on SIGTERM; end the process where that does not end it."""
    if threading.current_thread() is not threading.main_thread():  # which alone sees signals
        yield
        return
    ours, theirs = socket.socketpair()
    theirs.setblocking(False)
    before = signal.signal(signal.SIGTERM, _raise)
    wakeup = signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_watch, args=(ours,), daemon=True).start()
    hook, sys.unraisablehook = sys.unraisablehook, _swallowed
    try:
        yield
    finally:
        sys.unraisablehook = hook
        signal.set_wakeup_fd(wakeup)
        signal.signal(signal.SIGTERM, before)
        theirs.close()  # which ends the thread


def comes_of_interrupt(error: BaseException) -> bool:
    """Whether an error was caused by Ctrl-C, which Python replaces while it creates a class."""
    cause = error.__cause__
    return cause is not None and (isinstance(cause, KeyboardInterrupt) or comes_of_interrupt(cause))


def end() -> NoReturn:
    """End at once: remove unfinished files, and end worker processes with this one."""
    _ending.acquire()  # never released: the first thread here ends the process
    try:
        from hersey.files.writing import remove_unfinished

        remove_unfinished()
        shown_cursor = "\x1b[?25h" if sys.stderr.isatty() else ""  # a progress bar hides it
        sys.stderr.write(f"{shown_cursor}hersey: interrupted\n")
        sys.stderr.flush()
    finally:  # also if nobody reads the message
        os._exit(INTERRUPTED)


def _watch(signals: socket.socket) -> None:
    with signals:
        while number := signals.recv(1):
            if number[0] in (signal.SIGINT, signal.SIGTERM):
                time.sleep(_PATIENCE)
                end()


def _swallowed(lost: sys.UnraisableHookArgs) -> None:
    """Ignore an interrupt that Python loses: the watching thread ends the program."""
    if not issubclass(lost.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(lost)


def _raise(_signal: int, _frame: object) -> None:
    raise KeyboardInterrupt
