"""A process that answers what it is asked, and never outlives its parent."""

from __future__ import annotations

import atexit
import json
import math
import os
import select
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from hersey.processes.limits import limit_other, processor_time
from hersey.processes.starting import started

_LENGTHS = struct.Struct("<QQ")
_SERVER, _PACKAGE = Path(__file__).with_name("server.py"), str(Path(__file__).absolute().parents[2])
#: Longest head of a reply, bytes: the rest of a reply is its block of bytes.
_LONGEST_HEAD = 1 << 28
#: Where pipes can be waited for, and the time after which to look up, ms.
_POLL = getattr(select, "poll", None)
_LOOK_UP = 100
#: Processor time that a process may take beyond its limit before it is ended from here, s.
_GRACE = 2.0


class LostError(Exception):
    """The process ended before it answered, or did not start.

    ``code`` is its exit code, negative for the signal that ended it, and None if it did not start.
    """

    def __init__(self, message: str, code: int | None = None) -> None:
        """Take what happened and the exit code."""
        super().__init__(message)
        self.code = code


class _SpentError(EOFError):
    """The process has taken more processor time than it may."""


class FailedError(Exception):
    """What was asked raised an exception of the ``kind`` named; its text is the message."""

    def __init__(self, message: str, kind: str = "") -> None:
        """Take the text and the kind."""
        super().__init__(message)
        self.kind = kind


class Child:
    """A process that runs a script's ``answer(request, payload)``; see `hersey.processes.server`.

    It starts when it is first asked, stays for what comes next, and starts again after it was lost. Threads
    wait for each other; a forked process has a child of its own. It ends with this process, even one that is
    killed, and is ended by whatever interrupts a question (Ctrl-C).

    Parameters
    ----------
    script
        The script's path; it may import no more than it needs.
    environment
        Its environment; that of this process if left out. What this process imports, it can import too.
    """

    def __init__(self, script: Path, environment: Mapping[str, str] | None = None) -> None:
        """Remember the script: nothing is started yet."""
        self._script, self._environment = script, environment
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        #: When it has to answer, by the clock, and the processor time that it may have taken by then, s.
        self._late, self._spent = math.inf, math.inf
        self._looked = -math.inf  # when its processor time was last looked at
        self._files: socket.socket | None = None
        _children.add(self)

    def __del__(self) -> None:
        """End the process of a child that nobody holds any more."""
        self.stop()

    def ask(
        self,
        request: dict[str, Any],
        payload: bytes = b"",
        *,
        file: int | None = None,
        most: float = math.inf,
        within: float = math.inf,
    ) -> tuple[dict[str, Any], bytearray]:
        """Return the reply to a request, and its block of bytes.

        Parameters
        ----------
        file
            The descriptor of an open file: the script gets one of its own as ``request["file"]``, where the
            system can pass it (not on Windows).
        most
            Bytes of the reply's block.
        within
            Time for the answer, s, by the clock: far more than it can need, for what waits for ever.

        Raises
        ------
        LostError
            If the process ends before it has answered, or its answer is late or too long.
        FailedError
            If the script raises an exception.
        """
        with self._lock, self._whole():
            self._late = time.monotonic() + within
            process = self._running()
            if file is not None and self._files is not None:
                socket.send_fds(self._files, [b"\0"], [file])
                request = request | {"file": True}
            head = json.dumps(request).encode()
            self._write(process, _LENGTHS.pack(len(head), len(payload)) + head)
            self._write(process, payload)
            first, second = _LENGTHS.unpack(self._read(process, _LENGTHS.size))
            if first > _LONGEST_HEAD or second > most:
                raise LostError("its reply is invalid")
            answer, content = json.loads(self._read(process, first)), self._read(process, second)
        if "failed" in answer:
            raise FailedError(answer["message"], answer["failed"])
        return answer["reply"], content

    @property
    def running(self) -> bool:
        """Whether the process has started and was not lost."""
        return self._process is not None and self._process.poll() is None

    def stop(self) -> int | None:
        """End the process, also one that another thread waits for; return its exit code."""
        process, files = self._process, self._files
        code = None
        if process is not None:
            if process.returncode is None and os.name == "posix":
                with suppress(OSError):
                    os.killpg(process.pid, signal.SIGKILL)  # with what it may have started
            with suppress(OSError):
                process.kill()  # no harm to one that has ended
            code = process.wait()
        self._process, self._files = None, None
        _close(process, files)
        return code

    def limit(self, memory: float, seconds: float) -> None:
        """Let the process take so much more memory, bytes, and processor time, s; infinity lifts a limit.

        Linux; elsewhere a script limits itself (`hersey.processes.limits`).

        Raises
        ------
        LostError
            If the process has ended, or the system forbids it.
        """
        with self._lock, self._whole():
            if self._process is None:
                raise EOFError("the process ended before its limits were set")
            limit_other(self._process.pid, memory, seconds)
            self._spent = processor_time(self._process.pid) + seconds + _GRACE

    @contextmanager
    def _whole(self) -> Iterator[None]:
        """Stop the process after anything but a whole reply: its next would answer another question."""
        try:
            yield
        except (EOFError, OSError, ValueError, RecursionError) as error:
            code = self.stop()
            if isinstance(error, _SpentError):
                code = -signal.SIGXCPU
            raise LostError(str(error) or "the process ended before it answered", code) from None
        except BaseException:
            self.stop()
            raise

    def _running(self) -> subprocess.Popen[bytes]:
        if not self.running:
            self.stop()  # lost while nothing was asked of it
        return self._process or self._start()

    def _start(self) -> subprocess.Popen[bytes]:
        self._spent = math.inf
        theirs: tuple[int, ...] = ()
        if os.name == "posix":
            self._files, files = socket.socketpair()
            theirs = (files.detach(),)
        # -P: without the folder of the server, whose modules would hide those of Python
        command = [sys.executable, "-P", str(_SERVER), str(self._script), *map(str, (os.getpid(), *theirs))]
        environment = os.environ if self._environment is None else self._environment
        try:
            self._process = started(
                lambda: subprocess.Popen(
                    command,
                    bufsize=0,
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,
                    env={**environment, **import_path()},
                    pass_fds=theirs,
                    start_new_session=True,  # a group of its own, without a terminal
                )
            )
        finally:
            for end in theirs:
                os.close(end)
        if _POLL is not None and self._process.stdin is not None:
            os.set_blocking(
                self._process.stdin.fileno(), False
            )  # a write waits for room where Ctrl-C is heard
        return self._process

    def _write(self, process: subprocess.Popen[bytes], content: bytes) -> None:
        assert process.stdin is not None
        rest = memoryview(content)
        while rest:
            self._wait_for(process.stdin)
            rest = rest[process.stdin.write(rest) or 0 :]

    def _read(self, process: subprocess.Popen[bytes], length: int) -> bytearray:
        assert process.stdout is not None
        content = bytearray()
        while len(content) < length:
            self._wait_for(process.stdout)
            part = process.stdout.read(min(length - len(content), 1 << 20))
            if not part:
                raise EOFError
            content += part
        return content

    def _wait_for(self, stream: IO[bytes]) -> None:
        """Wait until a pipe can be read or written, and let Ctrl-C through.

        A library with a handler of its own for signals may have the kernel go on with a read that one came
        into, and Python then never hears of it; this waiting ends with a signal, and looks up now and then
        for one that came just before.
        """
        if _POLL is None:
            return
        poll = _POLL()
        poll.register(stream, select.POLLOUT if stream.writable() else select.POLLIN)
        while True:
            ready = poll.poll(_LOOK_UP)
            now = time.monotonic()
            if now > self._late:  # also one that answers a byte at a time
                raise EOFError("the process does not respond")
            if now > self._looked + _LOOK_UP / 1000:
                self._looked = now
                self._refuse_overtime()
            if ready:
                return

    def _refuse_overtime(self) -> None:
        """Raise if the process has taken more time than it may: one that does not heed the signal."""
        process = self._process
        if self._spent == math.inf or process is None:
            return
        with suppress(FileNotFoundError, ProcessLookupError):  # it has ended
            if processor_time(process.pid) > self._spent:
                raise _SpentError("the process takes too much processor time")

    def _leave_to_parent(self) -> None:
        """Let go, in a forked process, of the child that is the parent's."""
        process, files = self._process, self._files
        self._lock, self._process, self._files = threading.Lock(), None, None
        if process is not None:
            process.returncode = 0  # none of ours to wait for
        _close(process, files)


def import_path() -> dict[str, str]:
    """Return what, in its environment, lets a process import the modules that this one can, ours too."""
    places = [str(Path(place).absolute()) for place in sys.path if place]
    if _PACKAGE not in places:
        places.append(_PACKAGE)
    return {"PYTHONPATH": os.pathsep.join(places)}


def _close(process: subprocess.Popen[bytes] | None, files: socket.socket | None) -> None:
    """Close our ends of the pipes: the last that a process started half-way needs to end."""
    for stream in (process.stdin, process.stdout) if process is not None else ():
        if stream is not None:
            stream.close()
    if files is not None:
        files.close()


_children: weakref.WeakSet[Child] = weakref.WeakSet()


def _leave_all() -> None:
    for child in list(_children):
        child._leave_to_parent()


@atexit.register
def _stop_all() -> None:
    for child in list(_children):
        child.stop()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_leave_all)
