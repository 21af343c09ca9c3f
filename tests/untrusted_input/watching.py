"""What a call has cost and left behind, here and in the process that reads; of Linux's ``/proc``."""

from __future__ import annotations

import contextlib
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

linux = pytest.mark.skipif(sys.platform != "linux", reason="watched through /proc")
_TICK = os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 100


def children() -> list[int]:
    """Processes that this one has started and that it has not waited for."""
    pids: list[int] = []
    for task in Path("/proc/self/task").iterdir():
        with contextlib.suppress(OSError):
            pids += map(int, (task / "children").read_text().split())
    return pids


def state(pid: int) -> list[str]:
    """The fields of a process behind its name, none if it is gone."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return []


def is_gone(pid: int) -> bool:
    """Whether a process has ended; one that nobody has waited for yet counts as such."""
    return not (fields := state(pid)) or fields[0] in {"Z", "X"}


def processor_time() -> float:
    """Processor time of this process and of all that it started, s."""
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    living = sum(int(f[11]) + int(f[12]) for pid in children() if (f := state(pid)))
    return time.process_time() + ended.ru_utime + ended.ru_stime + living / _TICK


def peak_memory(pid: int | str = "self") -> float:
    """Most memory that a process has held, bytes."""
    with contextlib.suppress(OSError):
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024.0
    return 0.0


def open_files() -> int:
    """How many descriptors this process holds."""
    return len(list(Path("/proc/self/fd").iterdir()))


def wait_until(condition: Callable[[], object], seconds: float = 60.0) -> None:
    """Wait for a condition, and fail if it does not come."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "did not happen"
        time.sleep(0.02)


@contextlib.contextmanager
def listening_to_output(kept: Path) -> Iterator[None]:
    """Let what anybody writes on stdout or stderr, also a library or a child, go to a file."""
    sys.stdout.flush()
    sys.stderr.flush()
    before = [os.dup(1), os.dup(2)]
    with kept.open("wb") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        try:
            yield
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for number, end in enumerate(before, start=1):
                os.dup2(end, number)
                os.close(end)


@contextlib.contextmanager
def temporary_files_in(folder: Path) -> Iterator[None]:
    """Let temporary files of this process, and of those started meanwhile, be made in a folder."""
    before = os.environ.get("TMPDIR"), tempfile.tempdir
    os.environ["TMPDIR"], tempfile.tempdir = str(folder), None
    try:
        yield
    finally:
        tempfile.tempdir = before[1]
        os.environ.pop("TMPDIR")
        if before[0] is not None:
            os.environ["TMPDIR"] = before[0]
