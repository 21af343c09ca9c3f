"""The system calls that may be made while an untrusted file is read, and the filter that refuses others.

What is not listed is refused. Numbers are those of Linux's ``asm/unistd_64.h`` (x86_64) and
``asm-generic/unistd.h`` (aarch64); the filter is a program of classic BPF, see seccomp(2).
"""

from __future__ import annotations

import ctypes
import errno
import os
import struct
from collections.abc import Iterator
from dataclasses import dataclass

#: By architecture: its number in a filter (``AUDIT_ARCH_*``), and the column of the tables below.
_ARCHITECTURES = {"x86_64": (0xC000003E, 0), "aarch64": (0xC00000B7, 1)}
#: Calls that read, compute, wait, and take memory: whatever their arguments.
_ALLOWED: dict[str, tuple[int | None, int | None]] = {
    # what is open
    "read": (0, 63), "readv": (19, 65), "pread64": (17, 67), "preadv": (295, 69), "write": (1, 64),
    "writev": (20, 66), "lseek": (8, 62), "close": (3, 57), "close_range": (436, 436), "dup": (32, 23),
    "dup2": (33, None), "dup3": (292, 24), "fstat": (5, 80), "getdents64": (217, 61), "fadvise64": (221, 223),
    "getsockopt": (55, 209), "getsockname": (51, 204), "recvmsg": (47, 212),
    # names of files
    "stat": (4, None), "lstat": (6, None), "newfstatat": (262, 79), "statx": (332, 291), "access": (21, None),
    "faccessat": (269, 48), "faccessat2": (439, 439), "readlink": (89, None), "readlinkat": (267, 78),
    "getcwd": (79, 17),
    # memory
    "brk": (12, 214), "mmap": (9, 222), "mremap": (25, 216), "munmap": (11, 215), "mprotect": (10, 226),
    "mincore": (27, 232),
    # threads
    "futex": (202, 98), "set_robust_list": (273, 99), "rseq": (334, 293), "membarrier": (324, 283),
    "sched_yield": (24, 124), "sched_getaffinity": (204, 123), "sched_getparam": (143, 121),
    "sched_getscheduler": (145, 120), "sched_get_priority_max": (146, 125),
    "sched_get_priority_min": (147, 126), "getcpu": (309, 168), "exit": (60, 93), "exit_group": (231, 94),
    "restart_syscall": (219, 128),
    # signals to itself
    "rt_sigaction": (13, 134), "rt_sigprocmask": (14, 135), "rt_sigreturn": (15, 139),
    "sigaltstack": (131, 132),
    # waiting
    "poll": (7, None), "ppoll": (271, 73), "select": (23, None), "pselect6": (270, 72),
    "epoll_create1": (291, 20), "epoll_ctl": (233, 21), "epoll_wait": (232, None), "epoll_pwait": (281, 22),
    "eventfd2": (290, 19), "pipe2": (293, 59), "nanosleep": (35, 101), "clock_nanosleep": (230, 115),
    # what it is, and the time
    "getpid": (39, 172), "getppid": (110, 173), "gettid": (186, 178), "getuid": (102, 174),
    "geteuid": (107, 175), "getgid": (104, 176), "getegid": (108, 177), "getrlimit": (97, 163),
    "getrusage": (98, 165), "times": (100, 153), "sysinfo": (99, 179), "uname": (63, 160),
    "getrandom": (318, 278), "time": (201, None), "gettimeofday": (96, 169), "clock_gettime": (228, 113),
    "clock_getres": (229, 114),
}  # fmt: skip
#: From this number on an unknown call is one that older kernels lack: libraries then take another.
_RECENT = 424
#: Operations of a filter.
_LOAD, _AND, _EQUAL, _AT_LEAST, _RETURN = 0x20, 0x54, 0x15, 0x35, 0x06
#: What a filter answers.
_ALLOW, _REFUSE = 0x7FFF0000, 0x00050000
#: Places in what a filter sees: number of the call, architecture, first argument.
_NUMBER, _ARCHITECTURE, _ARGUMENTS = 0, 4, 16
_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER = 22, 2
_WHOLE = 0xFFFFFFFF

#: A new thread, and namespaces of its own; threads share memory, files and the filter.
_CLONE_THREAD, _CLONE_NEW = 0x00010000, 0x7E020000
#: Access for writing, and flags that make or cut a file: O_ACCMODE, O_CREAT, O_TRUNC, __O_TMPFILE.
_O_WRITING = 0o3 | 0o100 | 0o1000 | 0o20000000
#: F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_DUPFD_CLOEXEC.
_FCNTL = (0, 1, 2, 3, 1030)
#: TCGETS (is it a terminal?), FIONREAD, FIONCLEX, FIOCLEX.
_IOCTL = (0x5401, 0x541B, 0x5450, 0x5451)
#: PR_SET_NAME, PR_GET_NAME, PR_CAPBSET_READ, PR_SET_VMA (names of threads and of memory).
_PRCTL = (15, 16, 23, 0x53564D41)
#: Advice on memory below 32; MADV_HWPOISON is above.
_MADVICE = _WHOLE & ~31


@dataclass(frozen=True)
class _Argument:
    """What 32 bits of an argument must be, behind a mask."""

    place: int
    values: tuple[int, ...]
    mask: int = _WHOLE
    upper: bool = False

    @property
    def offset(self) -> int:
        """Where they are in what a filter sees."""
        return _ARGUMENTS + 8 * self.place + 4 * self.upper


@dataclass(frozen=True)
class _Rule:
    """A call that is allowed with some arguments alone."""

    numbers: tuple[int | None, int | None]
    arguments: tuple[_Argument, ...]
    refusal: int = errno.EPERM


def _rules(pid: int) -> tuple[_Rule, ...]:
    return (
        _Rule((56, 220), (_Argument(0, (_CLONE_THREAD,), _CLONE_THREAD | _CLONE_NEW),)),  # clone
        _Rule((2, None), (_Argument(1, (0,), _O_WRITING),), errno.EACCES),  # open
        _Rule((257, 56), (_Argument(2, (0,), _O_WRITING),), errno.EACCES),  # openat
        _Rule((72, 25), (_Argument(1, _FCNTL),)),  # fcntl
        _Rule((16, 29), (_Argument(1, _IOCTL),), errno.ENOTTY),  # ioctl
        _Rule((157, 167), (_Argument(0, _PRCTL),)),  # prctl
        _Rule((28, 233), (_Argument(2, (0,), _MADVICE),)),  # madvise
        _Rule((234, 131), (_Argument(0, (pid,)),)),  # tgkill, by which a library aborts
        # prlimit64: its own limits, and only to see them
        _Rule((302, 261), (_Argument(0, (0, pid)), _Argument(2, (0,)), _Argument(2, (0,), upper=True))),
    )


def filter_of(machine: str, pid: int) -> bytes | None:
    """Return the filter of a process, None for an architecture without a table.

    Parameters
    ----------
    machine
        The architecture as ``uname`` names it.
    pid
        The process, which may send signals to itself.
    """
    if machine not in _ARCHITECTURES or struct.calcsize("P") != 8:
        return None
    number, column = _ARCHITECTURES[machine]
    steps = [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_EQUAL, 1, 0, number),
        (_RETURN, 0, 0, _REFUSE | errno.EPERM),
        (_LOAD, 0, 0, _NUMBER),
    ]
    for numbers in _ALLOWED.values():
        if (call := numbers[column]) is not None:
            steps += [(_EQUAL, 0, 1, call), (_RETURN, 0, 0, _ALLOW)]
    for rule in _rules(pid):
        if (call := rule.numbers[column]) is not None:
            body = list(_checks(rule))
            steps += [(_EQUAL, 0, len(body), call), *body]
    steps += [
        (_AT_LEAST, 0, 1, _RECENT),
        (_RETURN, 0, 0, _REFUSE | errno.ENOSYS),
        (_RETURN, 0, 0, _REFUSE | errno.EPERM),
    ]
    return b"".join(struct.pack("=HBBI", *step) for step in steps)


def _checks(rule: _Rule) -> Iterator[tuple[int, int, int, int]]:
    for argument in rule.arguments:
        yield _LOAD, 0, 0, argument.offset
        yield _AND, 0, 0, argument.mask
        for left, value in zip(reversed(range(len(argument.values))), argument.values, strict=True):
            yield _EQUAL, left + 1, 0, value  # to the next argument
        yield _RETURN, 0, 0, _REFUSE | rule.refusal
    yield _RETURN, 0, 0, _ALLOW


def refuse_other_calls(libc: ctypes.CDLL) -> bool:
    """Refuse this process all calls but those listed, for good; return whether the kernel does so."""
    steps = filter_of(os.uname().machine, os.getpid())
    if steps is None:
        return False
    kept = ctypes.create_string_buffer(steps)
    program = struct.pack("@HP", len(steps) // 8, ctypes.addressof(kept))
    return bool(libc.prctl(_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER, program, 0, 0) == 0)
