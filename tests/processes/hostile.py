"""What a hostile file could make the process try that reads it; run in that process, each attempt once.

An attempt that gains something returns, one that is refused raises `OSError`. Calls that must never be made
in earnest are given arguments that the kernel refuses later than a sandbox does: `reached` tells the two.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import fcntl
import mmap
import os
import platform
import resource
import runpy
import signal
import socket
import struct
import sys
import threading
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

_reader = find_spec("hersey.log.formats.answering")
assert _reader is not None
assert _reader.origin is not None

LIBC = ctypes.CDLL(None, use_errno=True)
#: Numbers of system calls: x86_64, aarch64; None where an architecture lacks one.
NUMBERS: dict[str, tuple[int | None, int | None]] = {
    "acct": (163, 89), "add_key": (248, 217), "bpf": (321, 280), "capset": (126, 91),
    "chmod": (90, None), "chroot": (161, 51), "clock_settime": (227, 112), "clone": (56, 220),
    "clone3": (435, 435), "copy_file_range": (326, 285), "creat": (85, None), "delete_module": (176, 106),
    "execveat": (322, 281), "fallocate": (285, 47), "fanotify_init": (300, 262), "fchmod": (91, 52),
    "fchmodat": (268, 53), "fchmodat2": (452, 452), "fchown": (93, 55), "fchownat": (260, 54),
    "finit_module": (313, 273), "flock": (73, 32), "fork": (57, None), "fsetxattr": (190, 7),
    "ftruncate": (77, 46), "init_module": (175, 105), "inotify_init1": (294, 26), "io_setup": (206, 0),
    "io_uring_setup": (425, 425), "ioperm": (173, None), "iopl": (172, None), "ioprio_set": (251, 30),
    "kcmp": (312, 272), "kexec_load": (246, 104), "keyctl": (250, 219), "kill": (62, 129),
    "landlock_create_ruleset": (444, 444), "linkat": (265, 37),
    "memfd_create": (319, 279), "memfd_secret": (447, 447), "migrate_pages": (256, 238),
    "mkdirat": (258, 34), "mknodat": (259, 33), "mount": (165, 40), "move_pages": (279, 239),
    "mq_open": (240, 180), "msgget": (68, 186), "name_to_handle_at": (303, 264), "open_tree": (428, 428),
    "openat2": (437, 437), "open_by_handle_at": (304, 265), "perf_event_open": (298, 241),
    "personality": (135, 92), "pidfd_getfd": (438, 438), "pidfd_open": (434, 434),
    "pidfd_send_signal": (424, 424), "pivot_root": (155, 41), "process_madvise": (440, 440),
    "process_vm_readv": (310, 270), "process_vm_writev": (311, 271), "ptrace": (101, 117),
    "quotactl": (179, 60), "reboot": (169, 142), "renameat2": (316, 276), "request_key": (249, 218),
    "rt_sigqueueinfo": (129, 138), "sched_setaffinity": (203, 122), "sched_setattr": (314, 274),
    "sched_setscheduler": (144, 119), "seccomp": (317, 277), "semget": (64, 190), "sendfile": (40, 71),
    "setdomainname": (171, 162), "setgroups": (116, 159),
    "sethostname": (170, 161), "setns": (308, 268), "setpgid": (109, 154), "setpriority": (141, 140),
    "setresuid": (117, 147), "setsid": (112, 157), "settimeofday": (164, 170), "setuid": (105, 146),
    "shmget": (29, 194), "splice": (275, 76), "swapoff": (168, 225),
    "swapon": (167, 224), "symlinkat": (266, 36), "syslog": (103, 116),
    "tgkill": (234, 131), "tkill": (200, 130), "truncate": (76, 45),
    "umount2": (166, 39), "unlinkat": (263, 35), "unshare": (272, 97), "userfaultfd": (323, 282),
    "utimensat": (280, 88),
}  # fmt: skip
_COLUMN = 0 if platform.machine() == "x86_64" else 1
AT_FDCWD = -100
#: What `refused` counts as a refusal by the sandbox.
REFUSALS = {errno.EPERM, errno.EACCES, errno.ENOSYS}
ATTEMPTS: dict[str, Callable[[dict[str, Any]], object]] = {}


def attempt(name: str) -> Callable[[Callable[[dict[str, Any]], object]], Callable[[dict[str, Any]], object]]:
    """List an attempt by its name."""

    def listed(function: Callable[[dict[str, Any]], object]) -> Callable[[dict[str, Any]], object]:
        assert name not in ATTEMPTS
        ATTEMPTS[name] = function
        return function

    return listed


def call(name: str, *arguments: Any) -> int:
    """Make a system call; raise its error."""
    number = NUMBERS[name][_COLUMN]
    if number is None:
        raise OSError(errno.ENOSYS, "no such call here")
    return raw(number, *arguments)


def raw(number: int, *arguments: Any) -> int:
    """Make a system call by its number; raise its error."""
    wide = [ctypes.c_long(each) if isinstance(each, int) else each for each in arguments]
    LIBC.syscall.restype = ctypes.c_long
    done: int = LIBC.syscall(ctypes.c_long(number), *wide)
    if done == -1:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return done


def reached(name: str, *arguments: Any) -> int:
    """Make a call whose arguments the kernel refuses: return how, unless it was the sandbox that did."""
    try:
        return call(name, *arguments)
    except OSError as error:
        if error.errno in REFUSALS:
            raise
        return error.errno or 0


def child_of(number: int) -> int:
    """Return the process that a call made; it ends at once."""
    if number == 0:
        os._exit(0)
    os.waitpid(number, 0x40000000)  # __WALL
    return number


# --- reading ---------------------------------------------------------------------------------------------

for _name, _path in {
    "read a file in the script's folder": "{secret}",
    "read a key of the user": "{home}/.ssh/id_ed25519",
    "read a file beside the log": "{neighbour}",
    "read /etc/passwd": "/etc/passwd",
    "read /etc/shadow": "/etc/shadow",
    "read /etc/hostname": "/etc/hostname",
    "read the parent's environment": "/proc/{parent}/environ",
    "read the parent's memory": "/proc/{parent}/mem",
    "read the parent's map of memory": "/proc/{parent}/maps",
    "read the parent's command": "/proc/{parent}/cmdline",
    "read which sockets the machine has": "/proc/self/net/unix",
    "read which connections the machine has": "/proc/self/net/tcp",
    "read what is mounted": "/proc/self/mountinfo",
    "read its own groups of control": "/proc/self/cgroup",
    "read the settings of the kernel": "/proc/sys/kernel/osrelease",
    "read through its own root": "/proc/self/root{secret}",
    "read through its own root, by the system": "/proc/self/root{system}",
    "open a device": "/dev/zero",
    "open the memory of the machine": "/dev/mem",
    "open the messages of the kernel": "/dev/kmsg",
    "open the terminal": "/dev/tty",
}.items():

    def _read(place: dict[str, Any], path: str = _path) -> object:
        with Path(path.format(**place)).open("rb") as file:
            return file.read(1) or True

    attempt(_name)(_read)

for _name, _path in {
    "list the script's folder": "{folder}",
    "list the user's folder": "{home}",
    "list the root": "/",
    "list the temporary files": "/tmp",
    "list the parent's open files": "/proc/{parent}/fd",
    "list the processes": "/proc",
    "list the devices": "/dev",
}.items():
    attempt(_name)(lambda place, path=_path: os.listdir(path.format(**place)))  # noqa: PTH208

attempt("read the parent's folder")(lambda place: os.readlink(f"/proc/{place['parent']}/cwd"))  # noqa: PTH115


@attempt("go to the script's folder and read there")
def _go(place: dict[str, Any]) -> object:
    os.chdir(place["folder"])
    with Path(Path(place["secret"]).name).open("rb") as file:
        return file.read()


@attempt("read through a descriptor of a path")
def _path_descriptor(place: dict[str, Any]) -> object:
    number = os.open(place["secret"], os.O_PATH)
    with open(f"/proc/self/fd/{number}", "rb") as file:  # noqa: PTH123 - a link of the kernel
        return file.read()


@attempt("open a file by openat2")
def _openat2(place: dict[str, Any]) -> object:
    how = ctypes.create_string_buffer(struct.pack("=QQQ", os.O_RDONLY, 0, 0))
    return call("openat2", AT_FDCWD, place["secret"].encode(), how, 24)


@attempt("take the handle of a file")
def _handle(place: dict[str, Any]) -> object:
    handle = ctypes.create_string_buffer(struct.pack("=Ii", 128, 0) + bytes(128))
    return call(
        "name_to_handle_at", AT_FDCWD, place["secret"].encode(), handle, ctypes.byref(ctypes.c_int()), 0
    )


@attempt("open a file by a handle")
def _by_handle(_place: dict[str, Any]) -> object:
    return reached(
        "open_by_handle_at", AT_FDCWD, ctypes.create_string_buffer(struct.pack("=Ii", 8, 1) + bytes(8)), 0
    )


@attempt("copy a file by sendfile")
def _sendfile(place: dict[str, Any]) -> object:
    return call("sendfile", os.pipe()[1], place["file"], 0, 1)


@attempt("copy a file by copy_file_range")
def _copy(place: dict[str, Any]) -> object:
    return reached("copy_file_range", place["file"], 0, place["file"], 0, 1, 0)


@attempt("copy a file by splice")
def _splice(place: dict[str, Any]) -> object:
    return call("splice", place["file"], 0, os.pipe()[1], 0, 1, 0)


@attempt("clone the tree of mounts")
def _tree(_place: dict[str, Any]) -> object:
    return reached("open_tree", AT_FDCWD, b"/", 1)


@attempt("read the log of the kernel")
def _syslog(_place: dict[str, Any]) -> object:
    return call("syslog", 10, 0, 0)


# --- writing ---------------------------------------------------------------------------------------------

for _name, _flags in {
    "make a file": os.O_WRONLY | os.O_CREAT,
    "make a file without a name": os.O_RDWR | getattr(os, "O_TMPFILE", 0),
}.items():
    attempt(_name)(
        lambda place, flags=_flags: os.open(place["folder" if flags & os.O_DIRECTORY else "marker"], flags)
    )
attempt("make a file by creat")(lambda place: call("creat", place["marker"].encode(), 0o600))
attempt("make a file in shared memory")(
    lambda _: os.open(f"/dev/shm/hersey-{os.getpid()}", os.O_CREAT | os.O_RDWR)
)
attempt("write over a file")(lambda place: os.open(place["secret"], os.O_WRONLY))
attempt("cut a file while it is opened")(lambda place: os.open(place["secret"], os.O_RDONLY | os.O_TRUNC))
attempt("write over a library")(lambda _: os.open(json_path(), os.O_RDWR))
attempt("write to its own map of users")(lambda _: os.open("/proc/self/uid_map", os.O_WRONLY))
attempt("rename itself in /proc")(lambda _: os.write(os.open("/proc/self/comm", os.O_WRONLY), b"x"))
attempt("be spared when memory is short")(lambda _: os.open("/proc/self/oom_score_adj", os.O_WRONLY))
attempt("open the log anew to write")(lambda place: os.open(f"/proc/self/fd/{place['file']}", os.O_RDWR))
attempt("write to the log")(lambda place: os.write(place["file"], b"x"))
attempt("cut the log")(lambda place: reached("ftruncate", place["file"], 0))
attempt("lengthen the log")(lambda place: reached("fallocate", place["file"], 0, 0, 1 << 20))
attempt("cut a file")(lambda place: call("truncate", place["secret"].encode(), 0))
attempt("make a folder")(lambda place: call("mkdirat", AT_FDCWD, place["marker"].encode(), 0o700))
attempt("make a pipe with a name")(
    lambda place: call("mknodat", AT_FDCWD, place["marker"].encode(), 0o010600, 0)
)
attempt("make a device")(lambda place: call("mknodat", AT_FDCWD, place["marker"].encode(), 0o020600, 0x103))
attempt("make a link")(lambda place: call("symlinkat", b"/etc/passwd", AT_FDCWD, place["marker"].encode()))
attempt("make a hard link")(
    lambda place: call("linkat", AT_FDCWD, place["secret"].encode(), AT_FDCWD, place["marker"].encode(), 0)
)
attempt("rename a file")(
    lambda place: call("renameat2", AT_FDCWD, place["secret"].encode(), AT_FDCWD, place["marker"].encode(), 0)
)
attempt("remove a file")(lambda place: call("unlinkat", AT_FDCWD, place["secret"].encode(), 0))
attempt("remove a folder")(lambda place: call("unlinkat", AT_FDCWD, place["empty"].encode(), 0x200))


def json_path() -> str:
    """A file of Python's own library, which may be read."""
    import json

    return json.__file__


# --- what belongs to a file ------------------------------------------------------------------------------

attempt("change the mode of a file")(lambda place: os.chmod(place["secret"], 0o777))  # noqa: PTH101
attempt("change the mode of a file by chmod")(lambda place: call("chmod", place["secret"].encode(), 0o777))
attempt("change the mode of the log")(lambda place: os.fchmod(place["file"], 0o777))
attempt("change the mode of a file by fchmodat2")(
    lambda place: call("fchmodat2", AT_FDCWD, place["secret"].encode(), 0o777, 0)
)
attempt("change the owner of a file")(
    lambda place: call("fchownat", AT_FDCWD, place["secret"].encode(), os.getuid(), os.getgid(), 0)
)
attempt("change the owner of the log")(lambda place: call("fchown", place["file"], os.getuid(), os.getgid()))
attempt("change the times of a file")(lambda place: os.utime(place["secret"], (1, 1)))
attempt("change the times of the log")(lambda place: os.utime(place["file"], (1, 1)))
attempt("set an attribute of a file")(lambda place: os.setxattr(place["secret"], "user.hostile", b"x"))
attempt("set an attribute of the log")(lambda place: os.setxattr(place["file"], "user.hostile", b"x"))
attempt("remove an attribute")(lambda place: os.removexattr(place["secret"], "user.there"))
attempt("lock the log")(lambda place: call("flock", place["file"], fcntl.LOCK_EX | fcntl.LOCK_NB))
attempt("lock a part of the log")(lambda place: fcntl.lockf(place["file"], fcntl.LOCK_SH | fcntl.LOCK_NB))
attempt("lease the log")(lambda place: fcntl.fcntl(place["file"], 1024, fcntl.F_RDLCK))
attempt("set the flags of the log's inode")(
    lambda place: fcntl.ioctl(place["file"], 0x40086602, struct.pack("=Q", 0))
)
attempt("set the flags of the log's descriptor")(
    lambda place: fcntl.fcntl(place["file"], fcntl.F_SETFL, os.O_APPEND | os.O_NONBLOCK)
)


@attempt("have the kernel signal the parent of a descriptor")
def _own(place: dict[str, Any]) -> object:
    reading, writing = os.pipe()
    fcntl.fcntl(reading, fcntl.F_SETOWN, place["parent"])
    fcntl.fcntl(reading, 10, signal.SIGUSR1)  # F_SETSIG
    fcntl.fcntl(reading, fcntl.F_SETFL, os.O_ASYNC)
    return os.write(writing, b"x")


@attempt("watch a folder by signals")
def _notify(_place: dict[str, Any]) -> object:
    return fcntl.fcntl(os.open(str(Path(json_path()).parent), os.O_RDONLY), fcntl.F_NOTIFY, 0x1)


@attempt("lengthen a pipe")
def _pipe(_place: dict[str, Any]) -> object:
    return fcntl.fcntl(os.pipe()[1], 1031, 1 << 20)


attempt("watch files")(lambda _: call("inotify_init1", 0))
attempt("watch all files")(lambda _: call("fanotify_init", 0x200, 0))

# --- processes -------------------------------------------------------------------------------------------

attempt("fork")(lambda _: child_of(os.fork()))
attempt("fork by the call")(lambda _: child_of(call("fork")))
attempt("clone a process")(lambda _: child_of(call("clone", int(signal.SIGCHLD), 0, 0, 0, 0)))
attempt("clone a process that nobody waits for")(lambda _: child_of(call("clone", 0, 0, 0, 0, 0)))
for _name, _flag in {
    "user": 0x10000000,
    "files": 0x20000,
    "network": 0x40000000,
    "processes": 0x20000000,
}.items():
    attempt(f"clone a process with {_name} of its own")(
        lambda _, flag=_flag: child_of(call("clone", flag | int(signal.SIGCHLD), 0, 0, 0, 0))
    )
    if _name != "processes":  # the next child would be in it, and nobody its first
        attempt(f"have {_name} of its own")(lambda _, flag=_flag: reached("unshare", flag))


@attempt("clone a process by clone3")
def _clone3(_place: dict[str, Any]) -> object:
    told = ctypes.create_string_buffer(struct.pack("=11Q", 0, 0, 0, 0, int(signal.SIGCHLD), 0, 0, 0, 0, 0, 0))
    return child_of(call("clone3", told, 88))


attempt("run a program")(lambda _: child_of(os.posix_spawn("/bin/true", ["true"], {})))


@attempt("become a program")
def _execute_nothing(_place: dict[str, Any]) -> object:
    try:
        os.execv("/nonexistent/program", ["x"])
    except FileNotFoundError:
        return "looked for"


@attempt("run a program in memory")
def _memory_program(_place: dict[str, Any]) -> object:
    number = call("memfd_create", b"x", 0)
    os.write(number, b"#!")
    return call("execveat", number, b"", 0, 0, 0x1000)


attempt("have a file in memory")(lambda _: call("memfd_create", b"x", 0))
attempt("have secret memory")(lambda _: reached("memfd_secret", 0))
attempt("leave the session")(lambda _: call("setsid"))
attempt("leave the group of processes")(lambda _: call("setpgid", 0, 0))
attempt("enter a room of names")(lambda _: reached("setns", os.open("/proc/self/ns/user", os.O_RDONLY), 0))

# --- the parent ------------------------------------------------------------------------------------------

attempt("ask whether the parent is there")(lambda place: os.kill(place["parent"], 0))
attempt("signal the parent")(lambda place: os.kill(place["parent"], signal.SIGUSR1))
attempt("signal the parent's thread")(
    lambda place: call("tgkill", place["parent"], place["parent"], int(signal.SIGUSR1))
)
attempt("signal any thread")(lambda place: call("tkill", place["parent"], int(signal.SIGUSR1)))
attempt("signal the group")(lambda _: os.kill(0, 0))


@attempt("signal the parent with a value")
def _queue(place: dict[str, Any]) -> object:
    told = struct.pack("=iii", int(signal.SIGUSR1), 0, -1) + bytes(116)
    return call("rt_sigqueueinfo", place["parent"], int(signal.SIGUSR1), ctypes.create_string_buffer(told))


attempt("hold the parent")(lambda place: call("pidfd_open", place["parent"], 0))
attempt("signal by a hold")(lambda place: reached("pidfd_send_signal", place["file"], 0, 0, 0))
attempt("take a descriptor of the parent")(lambda place: reached("pidfd_getfd", place["file"], 0, 0))
attempt("trace the parent")(lambda place: call("ptrace", 0x4206, place["parent"], 0, 0))
attempt("be traced by the parent")(lambda _: call("ptrace", 0, 0, 0, 0))
attempt("compare with the parent")(lambda place: call("kcmp", os.getpid(), place["parent"], 1, 0, 0))


def _vectors() -> tuple[Any, Any]:
    here = ctypes.create_string_buffer(8)
    return ctypes.create_string_buffer(struct.pack("=QQ", ctypes.addressof(here), 8)), here


@attempt("read the parent's memory by a call")
def _vm_read(place: dict[str, Any]) -> object:
    vector, _kept = _vectors()
    return reached("process_vm_readv", place["parent"], vector, 1, vector, 1, 0)


@attempt("write the parent's memory by a call")
def _vm_write(place: dict[str, Any]) -> object:
    vector, _kept = _vectors()
    return reached("process_vm_writev", place["parent"], vector, 1, vector, 0, 0)


attempt("see the parent's limits")(lambda place: resource.prlimit(place["parent"], resource.RLIMIT_CORE))
attempt("change the parent's limits")(
    lambda place: resource.prlimit(place["parent"], resource.RLIMIT_CORE, (0, place["core"]))
)
attempt("slow the parent")(lambda place: os.setpriority(os.PRIO_PROCESS, place["parent"], place["nice"] + 1))
attempt("bind the parent to a processor")(lambda place: os.sched_setaffinity(place["parent"], {0}))
attempt("schedule the parent")(
    lambda place: os.sched_setscheduler(place["parent"], os.SCHED_BATCH, os.sched_param(0))
)
attempt("schedule the parent's input and output")(
    lambda place: call("ioprio_set", 1, place["parent"], 3 << 13)
)
attempt("move the parent's memory")(lambda place: reached("move_pages", place["parent"], 0, 0, 0, 0, 0))
attempt("move all of the parent's memory")(lambda place: reached("migrate_pages", place["parent"], 0, 0, 0))

# --- its own bounds --------------------------------------------------------------------------------------

for _name, _kind in {
    "memory": resource.RLIMIT_AS, "processor time": resource.RLIMIT_CPU, "open files": resource.RLIMIT_NOFILE,
    "the length of files": resource.RLIMIT_FSIZE, "processes": resource.RLIMIT_NPROC,
}.items():  # fmt: skip

    def _raise(_place: dict[str, Any], kind: int = _kind) -> object:
        hard = resource.getrlimit(kind)[1]
        resource.setrlimit(kind, (hard, hard))
        return True

    attempt(f"raise the limit of {_name}")(_raise)


def _prctl(*arguments: int) -> int:
    if LIBC.prctl(*map(ctypes.c_ulong, arguments)) == -1:
        raise OSError(ctypes.get_errno(), "prctl")
    return 1


attempt("outlive the parent: no signal at its death")(lambda _: _prctl(1, 0, 0, 0, 0))
attempt("outlive the parent: another that waits")(lambda _: _prctl(36, 1, 0, 0, 0))
attempt("leave an image of the memory")(lambda _: _prctl(4, 1, 0, 0, 0))
attempt("let others trace it")(lambda _: _prctl(0x59616D61, ctypes.c_ulong(-1).value, 0, 0, 0))
attempt("add a filter")(lambda _: reached("seccomp", 2, 0, 0))  # operation 2 asks what the kernel has
attempt("ask for rules of files")(lambda _: reached("landlock_create_ruleset", 0, 0, 1))
attempt("be another personality")(lambda _: call("personality", 0x0040000))
attempt("be another user")(lambda _: call("setuid", os.getuid()))
attempt("be another user thrice")(lambda _: call("setresuid", -1, os.getuid(), -1))
attempt("have other groups")(lambda _: reached("setgroups", 70000, 0))
attempt("have other capabilities")(
    lambda _: reached("capset", ctypes.create_string_buffer(struct.pack("=Ii", 0x20080522, 0)), 0)
)


@attempt("call as a program of 32 bits")
def _other_width(_place: dict[str, Any]) -> object:
    if _COLUMN:
        raise OSError(errno.ENOSYS, "no such calls here")
    code = mmap.mmap(-1, 4096, prot=mmap.PROT_READ | mmap.PROT_WRITE | mmap.PROT_EXEC)
    code.write(b"\x53\xb8\x14\x00\x00\x00\xcd\x80\x5b\xc3")  # getpid of 32 bits
    done = ctypes.CFUNCTYPE(ctypes.c_int)(ctypes.addressof(ctypes.c_char.from_buffer(code)))()
    if done < 0:
        raise OSError(-done, "int 0x80")
    return done


attempt("call in the way of x32")(lambda _: raw(0x40000000 + 39))

# --- the network and other processes ---------------------------------------------------------------------

for _name, _family, _type in (
    ("the Internet", socket.AF_INET, socket.SOCK_STREAM),
    ("datagrams", socket.AF_INET, socket.SOCK_DGRAM),
    ("raw packets", socket.AF_INET, socket.SOCK_RAW),
    ("the new Internet", socket.AF_INET6, socket.SOCK_STREAM),
    ("the system", socket.AF_UNIX, socket.SOCK_STREAM),
    ("the kernel", 16, socket.SOCK_RAW),
    ("the wire", 17, socket.SOCK_RAW),
    ("the host", 40, socket.SOCK_STREAM),
    ("ciphers", 38, socket.SOCK_SEQPACKET),
    ("Bluetooth", 31, socket.SOCK_RAW),
    ("a bus", 29, socket.SOCK_RAW),
    ("express data", 44, socket.SOCK_RAW),
):
    attempt(f"have a socket of {_name}")(
        lambda _, family=_family, kind=_type: socket.socket(family, kind).close() or True
    )
attempt("have a pair of sockets")(lambda _: socket.socketpair())


def _over_inherited(place: dict[str, Any]) -> socket.socket:
    return socket.socket(fileno=os.dup(place["socket"]))


attempt("connect the socket that it has")(
    lambda place: _over_inherited(place).connect("\0" + place["abstract"])
)
attempt("bind the socket that it has")(lambda place: _over_inherited(place).bind("\0hostile"))
attempt("listen on the socket that it has")(lambda place: _over_inherited(place).listen())
attempt("send through the socket that it has")(lambda place: _over_inherited(place).send(b"x"))
attempt("send elsewhere through the socket that it has")(
    lambda place: _over_inherited(place).sendto(b"x", "\0" + place["abstract"])
)
attempt("pass a descriptor to the parent")(
    lambda place: socket.send_fds(_over_inherited(place), [b"x"], [place["file"]])
)
attempt("end the socket of the parent")(lambda place: _over_inherited(place).shutdown(socket.SHUT_RDWR))
attempt("share memory with others")(lambda _: call("shmget", 0, 4096, 0o1600))
attempt("have a queue of messages")(lambda _: call("msgget", 0, 0o1600))
attempt("have semaphores")(lambda _: call("semget", 0, 1, 0o1600))
attempt("have a queue with a name")(lambda _: call("mq_open", b"hostile", os.O_CREAT | os.O_RDWR, 0o600, 0))
attempt("keep a key")(lambda _: call("add_key", b"user", b"hostile", b"x", 1, -2))
attempt("ask for a key")(lambda _: reached("request_key", b"user", b"hostile", 0, 0))
attempt("list its keys")(lambda _: call("keyctl", 0, -3, 1))
attempt("type at a terminal")(lambda _: type_at(0))


def type_at(number: int) -> object:
    """Put a sign into what a terminal reads; what is no terminal says so."""
    try:
        return fcntl.ioctl(number, 0x5412, b"x")
    except OSError as error:
        if error.errno == errno.ENOTTY and sys.stdin.isatty():
            return True
        raise


# --- the kernel ------------------------------------------------------------------------------------------

attempt("have calls done by rings")(lambda _: reached("io_uring_setup", 1, ctypes.create_string_buffer(120)))
attempt("have calls done later")(lambda _: call("io_setup", 1, ctypes.byref(ctypes.c_ulong())))
attempt("run code in the kernel")(lambda _: reached("bpf", 0, ctypes.create_string_buffer(128), 128))
attempt("count what happens")(
    lambda _: reached(
        "perf_event_open", ctypes.create_string_buffer(struct.pack("=II", 1, 112) + bytes(104)), 0, -1, -1, 0
    )
)
attempt("halt the kernel at a page")(lambda _: call("userfaultfd", 1))
attempt("advise on memory of others")(lambda place: reached("process_madvise", place["file"], 0, 0, 0, 0))
attempt("poison its memory")(lambda _: poison())
attempt("mount")(lambda place: reached("mount", b"none", place["empty"].encode(), b"nonexistent", 0, 0))
attempt("unmount")(lambda place: reached("umount2", place["empty"].encode(), 0))
attempt("change the root")(lambda _: call("chroot", b"/"))
attempt("turn the root")(lambda _: reached("pivot_root", b"/nonexistent", b"/nonexistent"))
attempt("swap")(lambda place: reached("swapon", place["marker"].encode(), 0))
attempt("swap no more")(lambda place: reached("swapoff", place["marker"].encode()))
attempt("start the machine anew")(lambda _: reached("reboot", 1, 2, 3, 0))
attempt("start another kernel")(lambda _: reached("kexec_load", 0, 1000, 0, 0))
attempt("load a module")(lambda _: reached("init_module", 0, 0, b""))
attempt("load a module from a file")(lambda place: reached("finit_module", place["file"], b"", 0))
attempt("remove a module")(lambda _: reached("delete_module", b"hersey-none", 0o4000))
attempt("set the clock")(
    lambda _: reached("settimeofday", ctypes.create_string_buffer(struct.pack("=qq", 0, -1)), 0)
)
attempt("set a clock")(
    lambda _: reached("clock_settime", 0, ctypes.create_string_buffer(struct.pack("=qq", 0, -1)))
)
attempt("name the machine")(lambda _: reached("sethostname", 0, -1))
attempt("name the domain")(lambda _: reached("setdomainname", 0, -1))
attempt("keep accounts")(lambda place: reached("acct", place["marker"].encode()))
attempt("set quotas")(lambda place: reached("quotactl", 0x800007, place["marker"].encode(), 0, 0))
attempt("speak with devices")(lambda _: call("iopl", 3))
attempt("speak with a port")(lambda _: call("ioperm", 0x80, 1, 1))


def poison() -> object:
    """Ask the kernel to fail a page of none."""
    if LIBC.madvise(ctypes.c_void_p(0x1000), ctypes.c_size_t(0), 100) == -1:
        raise OSError(ctypes.get_errno(), "madvise")
    return True


runpy.run_path(_reader.origin, run_name="__main__")  # from here on as while a file is read


def tried(what: str, place: dict[str, Any]) -> str | None:
    """Make one attempt; return how it was refused, None if it was not."""
    try:
        ATTEMPTS[what](place)
    except OSError as error:
        return errno.errorcode.get(error.errno or 0, str(error))
    except ValueError as error:  # what Python makes of a limit that is refused
        return str(error)
    return None


def answer(request: dict[str, Any], _payload: bytes) -> tuple[dict[str, Any], bytes]:
    """Do what is asked."""
    match request["do"]:
        case "try":
            place = request | {"socket": int(sys.argv[3])}
            return {"refused": {what: tried(what, place) for what in ATTEMPTS}}, b""
        case "take":  # so many bytes
            return {"taken": len(bytearray(request["bytes"]))}, b""
        case "thread":
            together = threading.Barrier(21)
            threads = [threading.Thread(target=together.wait) for _ in range(20)]
            for thread in threads:
                thread.start()
            together.wait()
            for thread in threads:
                thread.join()
            return {"threads": len(threads)}, b""
        case "spin":  # and heed no signal
            signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
            while True:
                pass
        case "outlive":  # heed no signal, and leave the thread that the kernel watches
            signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
            threading.Thread(target=time.sleep, args=(600.0,)).start()
            LIBC.syscall(60 if _COLUMN == 0 else 93, 0)  # exit, of this thread alone
        case "dribble":  # an answer of which a byte comes now and then
            for number in range(3, 20):
                with contextlib.suppress(OSError):
                    os.write(number, struct.pack("<QQ", 1000, 0))
                    while True:
                        os.write(number, b" ")
                        time.sleep(0.02)
    return {}, b""
