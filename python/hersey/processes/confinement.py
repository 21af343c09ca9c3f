"""What a process of our own may use while it reads a file of a stranger: bounds, and no other file.

Limits are those of POSIX; the wall around files is Landlock's (Linux 5.13 and later), and a filter of system
calls (seccomp) lets no socket be made. Where a system lacks one of them the others still stand.
"""

from __future__ import annotations

import ctypes
import errno
import math
import os
import struct
import sys
from pathlib import Path

#: Landlock's system calls, the same on every processor of 64 bit, and `prctl`'s no-new-privileges.
_CREATE, _ADD, _RESTRICT, _NO_NEW_PRIVILEGES = 444, 445, 446, 38
_READ_FILE, _READ_FOLDER = 1 << 2, 1 << 3
#: How many rights to files a version of Landlock knows; network from the 4th, signals from the 6th.
_RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15}
#: By processor: its number in a filter, and its calls socket, socketpair, connect and io_uring_setup, which
#: could make one as well.
_SOCKETS = {"x86_64": (0xC000003E, (41, 53, 42, 425)), "aarch64": (0xC00000B7, (198, 199, 203, 425))}
_SECCOMP, _FILTER, _ALLOW, _REFUSE = 22, 2, 0x7FFF0000, 0x00050000 | errno.EPERM
_LIBRARIES = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/share/zoneinfo")
_DEVICES = ("/dev/null", "/dev/urandom", "/proc/self", "/proc/meminfo", "/sys/devices/system/cpu")

#: What `limit_memory` was told, for systems that do not keep to it by themselves.
_allowed = math.inf


def limit_memory(extra: int) -> None:
    """Let this process take so many bytes more than it holds; what goes beyond raises `MemoryError`."""
    global _allowed
    _allowed = extra
    if sys.platform == "linux":
        import resource

        ceiling = resource.getrlimit(resource.RLIMIT_AS)[1]
        wanted = _memory_held() + extra
        limit = wanted if ceiling == resource.RLIM_INFINITY else min(wanted, ceiling)
        resource.setrlimit(resource.RLIMIT_AS, (limit, ceiling))


def memory_left() -> float:
    """Return how many bytes more this process may take, infinity without a limit."""
    if sys.platform != "linux":
        return _allowed
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return _allowed if limit == resource.RLIM_INFINITY else limit - _memory_held()


def _memory_held() -> int:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    return pages * os.sysconf("SC_PAGE_SIZE")


def limit_time(seconds: float) -> None:
    """End this process after so much more processor time, s, by the signal `SIGXCPU`; infinity lifts it."""
    if os.name == "posix":
        import resource

        used = resource.getrusage(resource.RUSAGE_SELF)
        ceiling = resource.getrlimit(resource.RLIMIT_CPU)[1]
        limit = ceiling
        if seconds < math.inf:
            limit = math.ceil(used.ru_utime + used.ru_stime + seconds)
            limit = limit if ceiling == resource.RLIM_INFINITY else min(limit, ceiling)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, ceiling))


def only_read_libraries() -> bool:
    """Let this process open nothing but Python's own files and libraries, for good; return whether it is so.

    Files that are open stay open. No file can be written, made or run, no address connected to.
    """
    if os.name == "posix":
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
    if sys.platform != "linux" or os.uname().machine not in _SOCKETS:
        return False
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    _refuse_sockets(libc)
    version = libc.syscall(_CREATE, None, ctypes.c_size_t(0), 1)
    if version < 1:
        return False
    all_rights = (1 << _RIGHTS.get(version, 16)) - 1
    words = [all_rights, 0b11, 0b11][: 1 if version < 4 else 2 if version < 6 else 3]
    ruled = struct.pack(f"={len(words)}Q", *words)
    rules = libc.syscall(_CREATE, ruled, ctypes.c_size_t(len(ruled)), 0)
    if rules < 0:
        return False
    for place in _places():
        _allow_reading(libc, rules, place)
    confined = libc.syscall(_RESTRICT, rules, 0) == 0
    os.close(rules)
    return bool(confined)


def _refuse_sockets(libc: ctypes.CDLL) -> None:
    """Let no socket be made: Landlock knows neither datagrams nor sockets in the file system."""
    processor, calls = _SOCKETS[os.uname().machine]
    load, equal, at_least, end = 0x20, 0x15, 0x35, 0x06  # words of a filter
    last = len(calls) + 1  # steps from the first comparison of calls to the refusal
    steps = [
        (load, 0, 0, 4),
        (equal, 0, last + 2, processor),
        (load, 0, 0, 0),
        (at_least, last, 0, 0x40000000),  # calls of another width
        *((equal, last - 1 - i, 0, call) for i, call in enumerate(calls)),
        (end, 0, 0, _ALLOW),
        (end, 0, 0, _REFUSE),
    ]
    words = ctypes.create_string_buffer(b"".join(struct.pack("=HBBI", *step) for step in steps))
    program = struct.pack("@HP", len(steps), ctypes.addressof(words))
    libc.prctl(_SECCOMP, _FILTER, program, 0, 0)


def _places() -> set[str]:
    return {*sys.path, sys.prefix, sys.base_prefix, *_LIBRARIES, *_DEVICES} - {""}


def _allow_reading(libc: ctypes.CDLL, rules: int, place: str) -> None:
    try:
        opened = os.open(place, os.O_PATH | os.O_CLOEXEC)
    except OSError:  # there is no such place here
        return
    right = _READ_FILE | _READ_FOLDER if Path(place).is_dir() else _READ_FILE
    rule = struct.pack("=Qi", right, opened)
    libc.syscall(_ADD, rules, 1, rule, 0)
    os.close(opened)
