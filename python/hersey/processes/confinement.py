"""What a process may reach while it reads an untrusted file: Python's files and libraries, nothing else.

Landlock (Linux 5.13 and later) limits which files it can open, seccomp which system calls it can make. Where
a system lacks one of them the other still stands.
"""

from __future__ import annotations

import ctypes
import os
import struct
import sys
import sysconfig
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from hersey.processes.system_calls import refuse_other_calls

#: Landlock's system calls, the same on every architecture of 64 bits.
_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_RULE_PATH_BENEATH = 1
_READ_FILE, _READ_FOLDER = 1 << 2, 1 << 3
#: How many rights to files a version of Landlock knows; later ones than these know 16.
_RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15}
#: The versions that know rights to the network, and scopes of signals and abstract sockets.
_KNOWS_NETWORK, _KNOWS_SCOPES = 4, 6
_PR_SET_NO_NEW_PRIVS = 38
#: Where a system keeps libraries and time zones.
_SYSTEM = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/share/zoneinfo")
#: What libraries look at: how much memory and how many processors there are, and their own memory.
_MACHINE = ("/dev/null", "/dev/urandom", "/proc/meminfo", "/sys/devices/system/cpu")
_OWN = ("/proc/self/statm", "/proc/self/maps")
#: The libraries that read files, which may have been installed in a place of their own.
_READERS = ("asammdf", "fastexcel", "h5py", "nptdms", "numpy", "polars", "scipy")
_PACKAGE = Path(__file__).absolute().parents[1]
#: Names of folders into which libraries are installed.
_INSTALLED = ("site-packages", "dist-packages")


def only_read_libraries() -> tuple[str, ...]:
    """Let this process open nothing but Python's own files and libraries, for good.

    Files that are open stay open for reading. No file can be written or changed, no process started, no
    socket made and no other process reached. Threads can be started.

    Returns
    -------
    tuple of str
        What the system lacks for that: ``"landlock"``, ``"seccomp"``, or both; empty where all holds.
    """
    if os.name == "posix":
        import resource

        for kind in (resource.RLIMIT_FSIZE, resource.RLIMIT_CORE):
            resource.setrlimit(kind, (0, 0))
    if sys.platform != "linux":
        return "landlock", "seccomp"
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    holds = {"landlock": _open_no_others(libc), "seccomp": refuse_other_calls(libc)}
    return tuple(name for name, done in holds.items() if not done)


def _open_no_others(libc: ctypes.CDLL) -> bool:
    """Let this process open no files but `_places`; return whether the kernel sees to it."""
    version = libc.syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), 1)
    if version < 1:
        return False
    all_rights = (1 << _RIGHTS.get(version, 16)) - 1
    words = [all_rights, 0b11, 0b11][: 1 + (version >= _KNOWS_NETWORK) + (version >= _KNOWS_SCOPES)]
    ruled = struct.pack(f"={len(words)}Q", *words)
    rules = libc.syscall(_CREATE_RULESET, ruled, ctypes.c_size_t(len(ruled)), 0)
    if rules < 0:
        return False
    for place in {*_SYSTEM, *_MACHINE, *_OWN, *places()}:
        _allow_reading(libc, rules, place)
    confined = libc.syscall(_RESTRICT_SELF, rules, 0) == 0
    os.close(rules)
    return bool(confined)


def places() -> set[str]:
    """Return the files and folders that hold Python, this package and what is installed beside them.

    A folder on the import path counts only if libraries are installed there: of another, such as that of a
    script, only the packages count that an installer has recorded there.
    """
    known = {*sysconfig.get_paths().values()} - {sysconfig.get_path(name) for name in ("scripts", "data")}
    known |= {
        str(Path(prefix, name)) for prefix in (sys.prefix, sys.base_prefix) for name in ("lib", "lib64")
    }
    known.add(str(_PACKAGE))
    for place in filter(None, sys.path):
        if Path(place).name in _INSTALLED or place.endswith(".zip"):
            known.add(place)
        else:
            known.update(_installed_in(Path(place)))
    for name in _READERS:
        spec = find_spec(name)
        known.update((spec and spec.submodule_search_locations) or ())
    return known


def _installed_in(place: Path) -> Iterator[str]:
    """Yield the packages that an installer has put into a folder, by its records."""
    if not any(place.glob("*.dist-info")):
        return
    from importlib.metadata import distributions

    for distribution in distributions(path=[str(place)]):
        for file in distribution.files or ():
            if file.parts[0] not in ("..", "/"):
                yield str(place / file.parts[0])


def _allow_reading(libc: ctypes.CDLL, rules: int, place: str) -> None:
    try:
        opened = os.open(place, os.O_PATH | os.O_CLOEXEC)
    except OSError:  # there is no such place here
        return
    right = _READ_FILE | _READ_FOLDER if Path(place).is_dir() else _READ_FILE
    rule = struct.pack("=Qi", right, opened)
    libc.syscall(_ADD_RULE, rules, _RULE_PATH_BENEATH, rule, 0)
    if place not in _OWN:  # the kernel forgets what it shows of a process unless somebody holds it
        os.close(opened)
