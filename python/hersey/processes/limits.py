"""How much memory and processor time a process may take.

On Linux its parent sets the limits, from outside: what runs in the process cannot raise them. Elsewhere the
process sets them itself, as far as the system keeps to them.
"""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

#: Whether limits are set from outside.
FROM_OUTSIDE = sys.platform == "linux"
#: What `limit` was given, for systems that do not count memory by themselves.
_allowed = math.inf


def limit(memory: float, seconds: float) -> None:
    """Let this process take so much more, unless its parent sees to it.

    Parameters
    ----------
    memory
        Bytes, counted by the readers (`memory_left`).
    seconds
        Processor time, s; it ends with the signal `SIGXCPU`. Infinity lifts it.
    """
    global _allowed
    _allowed = memory
    if os.name == "posix" and not FROM_OUTSIDE:
        import resource

        used = resource.getrusage(resource.RUSAGE_SELF)
        ceiling = resource.getrlimit(resource.RLIMIT_CPU)[1]
        soft = _at_most(used.ru_utime + used.ru_stime + seconds, ceiling)
        resource.setrlimit(resource.RLIMIT_CPU, (soft, ceiling))


def limit_other(pid: int, memory: float, seconds: float) -> None:
    """Let a child of this process take so much more; Linux.

    Parameters
    ----------
    memory
        Bytes beyond those that it holds now; more raises `MemoryError` there. Infinity lifts the limit.
    seconds
        Processor time, s, after which the signal `SIGXCPU` ends it. Infinity lifts the limit.

    Raises
    ------
    OSError
        If there is no such child, or the system forbids it.
    """
    import resource

    for kind, wanted in (
        (resource.RLIMIT_AS, _memory_held(pid) + memory),
        (resource.RLIMIT_CPU, processor_time(pid) + seconds),
    ):
        ceiling = resource.prlimit(pid, kind)[1]
        resource.prlimit(pid, kind, (_at_most(wanted, ceiling), ceiling))


def _at_most(wanted: float, ceiling: int) -> int:
    import resource

    if wanted == math.inf:
        return ceiling
    return math.ceil(wanted) if ceiling == resource.RLIM_INFINITY else min(math.ceil(wanted), ceiling)


def memory_left() -> float:
    """Return how many bytes more this process may take, infinity without a limit."""
    if sys.platform != "linux":
        return _allowed
    import resource

    soft = resource.getrlimit(resource.RLIMIT_AS)[0]
    return _allowed if soft == resource.RLIM_INFINITY else soft - _memory_held("self")


def processor_time(pid: int) -> float:
    """Return the processor time that a process has taken, s; Linux.

    Raises
    ------
    OSError
        If there is no such process.
    """
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _memory_held(pid: int | str) -> int:
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[0])
    return pages * os.sysconf("SC_PAGE_SIZE")
