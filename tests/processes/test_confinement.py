"""A hostile file takes over the process that reads it, and gets nothing: no file, no process, no parent."""

from __future__ import annotations

import errno
import fcntl
import math
import os
import pickle
import resource
import signal
import socket
import struct
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import hersey
from hersey.errors import SandboxWarning
from hersey.files.reading import OpenFile, open_file
from hersey.log.formats import opening
from hersey.log.formats.opening import _ENVIRONMENT
from hersey.processes.child import Child, FailedError, LostError
from hersey.processes.confinement import places
from hersey.processes.system_calls import filter_of
from tests.untrusted_input.seeds import SEEDS
from tests.untrusted_input.watching import children, is_gone, state, wait_until

HOSTILE = Path(__file__).with_name("hostile.py")
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the sandbox is Linux's")


#: Reads as where the kernel lacks something.
LACKING = """
import runpy
from hersey.processes import confinement, system_calls
if "landlock" in {missing!r}:
    confinement._CREATE_RULESET = 100_000
if "seccomp" in {missing!r}:
    system_calls._SECCOMP_MODE_FILTER = 100_000
answer = runpy.run_path({answering!r}, run_name="__main__")["answer"]
"""
#: Starts a hostile process and waits for the end.
PARENT = """
import sys
from pathlib import Path
from hersey.log.formats.opening import _ENVIRONMENT
from hersey.processes.child import Child
child = Child(Path(sys.argv[1]), _ENVIRONMENT)
child.ask({"do": "thread"})
print(child._process.pid, flush=True)
child.ask({"do": "outlive"})
import time
time.sleep(600)
"""


class Surroundings:
    """What a hostile file would like to reach, and what it was before."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.home = folder / "scripts", folder / "home"
        self.secret, self.key = self.folder / "secret.py", self.home / ".ssh" / "id_ed25519"
        self.log = folder / "log.mf4"
        self.abstract = f"hersey-{os.getpid()}-{folder.name}"
        for path in (self.secret, self.key, self.log, folder / "other.csv"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("secret")
            path.chmod(0o640)
        (self.folder / "empty").mkdir()
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind("\0" + self.abstract)
        self.socket.setblocking(False)
        self.signals: list[int] = []

    def place(self) -> dict[str, Any]:
        return {
            "secret": str(self.secret),
            "folder": str(self.folder),
            "home": str(self.home),
            "system": "/etc/passwd",
            "neighbour": str(self.log.with_name("other.csv")),
            "marker": str(self.folder / "MARK"),
            "empty": str(self.folder / "empty"),
            "parent": os.getpid(),
            "core": resource.getrlimit(resource.RLIMIT_CORE)[1],
            "nice": os.getpriority(os.PRIO_PROCESS, 0),
            "abstract": self.abstract,
        }

    def state(self) -> Any:
        """All that must be as before."""
        paths = sorted(self.log.parent.rglob("*"))
        return (
            [(path, stat.st_mode, stat.st_uid, stat.st_mtime_ns, stat.st_ctime_ns, stat.st_nlink)
             for path in paths if (stat := path.lstat())],
            [(path, path.read_text(), os.listxattr(path)) for path in paths if path.is_file()],
            [resource.getrlimit(kind) for kind in range(16)],
            os.getpriority(os.PRIO_PROCESS, 0),
            os.sched_getaffinity(0),
            os.sched_getscheduler(0),
            Path.cwd(),
            self.signals,
            Path("/proc/sysvipc/shm").read_text(),
            Path("/proc/sysvipc/msg").read_text(),
            Path("/proc/sysvipc/sem").read_text(),
            sorted(Path("/dev/shm").glob("hersey-*")),
            socket.gethostname(),
        )  # fmt: skip


@pytest.fixture
def surroundings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Surroundings]:
    made = Surroundings(tmp_path)
    monkeypatch.syspath_prepend(made.folder)  # as of `python scripts/mine.py`
    usual = signal.signal(signal.SIGUSR1, lambda number, _: made.signals.append(number))
    yield made
    signal.signal(signal.SIGUSR1, usual)
    made.socket.close()


def test_a_hostile_file_gets_nothing(surroundings: Surroundings) -> None:
    needs_whole_sandbox()
    before, processes = surroundings.state(), set(children())
    child = Child(HOSTILE, _ENVIRONMENT)
    try:
        with surroundings.log.open("rb") as log:
            said, _ = child.ask({"do": "try", **surroundings.place()}, file=log.fileno())
            assert log.tell() == 0
        (pid,) = set(children()) - processes
        assert Path(f"/proc/{pid}/task/{pid}/children").read_text() == ""
    finally:
        child.stop()
    refused = said["refused"]
    assert len(refused) > 100
    assert [what for what, how in refused.items() if how is None] == []
    assert surroundings.state() == before
    with pytest.raises(BlockingIOError):
        surroundings.socket.recv(1)


def needs_whole_sandbox() -> None:
    """Skip where the kernel has no Landlock, or seccomp is refused."""
    missing = subprocess.run(
        [sys.executable, "-c", ASKING], capture_output=True, text=True, check=True
    ).stdout.strip()
    if missing:
        pytest.skip(f"this system lacks {missing}")


ASKING = """
import os
from hersey.processes.confinement import only_read_libraries
os.write(1, " ".join(only_read_libraries()).encode())
"""


@pytest.fixture
def hostile() -> Iterator[Child]:
    child = Child(HOSTILE, _ENVIRONMENT)
    yield child
    child.stop()


def test_threads_start_and_memory_stays_limited(hostile: Child) -> None:
    assert hostile.ask({"do": "thread"})[0] == {"threads": 20}
    hostile.limit(300e6, 100.0)
    assert hostile.ask({"do": "take", "bytes": 250_000_000})[0] == {"taken": 250_000_000}
    with pytest.raises(FailedError) as failed:
        hostile.ask({"do": "take", "bytes": 900_000_000})
    assert failed.value.kind == "MemoryError"
    hostile.limit(math.inf, math.inf)
    assert hostile.ask({"do": "take", "bytes": 900_000_000})[0] == {"taken": 900_000_000}


def test_one_that_heeds_no_signal_is_ended_at_its_time(hostile: Child) -> None:
    hostile.ask({"do": "thread"})
    hostile.limit(1e9, 0.1)
    with pytest.raises(LostError) as lost:
        hostile.ask({"do": "spin"})
    assert lost.value.code == -signal.SIGXCPU
    assert not hostile.running


def test_one_that_answers_a_byte_at_a_time_is_late(hostile: Child) -> None:
    hostile.ask({"do": "thread"})
    with pytest.raises(LostError, match="does not respond"):
        hostile.ask({"do": "dribble"}, within=0.5)


def test_it_does_not_outlive_a_parent_that_is_killed() -> None:
    """Not even one that blocks signals and ends its first thread."""
    parent = subprocess.Popen([sys.executable, "-c", PARENT, str(HOSTILE)], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    with parent.stdout:
        try:
            pid = int(parent.stdout.readline())
            wait_until(lambda: state(pid)[0] == "Z")  # its first thread
            others = [int(task.name) for task in Path(f"/proc/{pid}/task").iterdir() if task.name != str(pid)]
            assert not all(map(is_gone, others))
        finally:
            parent.kill()
            parent.wait()
    wait_until(lambda: all(map(is_gone, others)))


@pytest.fixture
def log(tmp_path: Path) -> Path:
    (tmp_path / "run.npz").write_bytes(SEEDS["run.npz"]())
    return tmp_path / "run.npz"


#: Runs a command where a container forbids Landlock and filters of its own.
FORBIDDEN = """
import ctypes, errno, os, platform, struct, sys
prctl, refuse = {"x86_64": 157, "aarch64": 167}[platform.machine()], 0x00050000 | errno.EPERM
steps = [(0x20, 0, 0, 0), (0x15, 0, 1, 444), (6, 0, 0, refuse), (0x15, 0, 3, prctl), (0x20, 0, 0, 16),
         (0x15, 0, 1, 22), (6, 0, 0, refuse), (6, 0, 0, 0x7FFF0000)]
words = ctypes.create_string_buffer(b"".join(struct.pack("=HBBI", *step) for step in steps))
libc = ctypes.CDLL(None)
assert libc.prctl(38, 1, 0, 0, 0) == 0
assert libc.prctl(22, 2, struct.pack("@HP", len(steps), ctypes.addressof(words)), 0, 0) == 0
from hersey.cli import main
main()
"""


def test_a_container_that_forbids_the_sandbox_has_one_line_on_the_terminal(log: Path) -> None:
    needs_whole_sandbox()
    (log.parent / "other.npz").write_bytes(log.read_bytes())
    done = subprocess.run(
        [sys.executable, "-c", FORBIDDEN, "inspect", str(log), str(log.parent / "other.npz")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stderr == (
        "hersey: The sandbox for untrusted files is incomplete. A file could open other files (this system "
        "has no Landlock) and start processes and change files (this system has no seccomp). Open only files "
        "you trust.\n"
    )
    assert done.returncode == 0
    assert "60" in done.stdout


@pytest.mark.parametrize("missing", [("landlock",), ("seccomp",), ("landlock", "seccomp")])
def test_what_the_kernel_lacks_is_said_once(
    missing: tuple[str, ...], log: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs_whole_sandbox()
    script = tmp_path / "lacking.py"
    script.write_text(LACKING.format(missing=missing, answering=str(opening._SCRIPT)))
    monkeypatch.setattr(opening, "_SCRIPT", script)
    monkeypatch.setattr(opening, "_warned", False)
    monkeypatch.setattr(opening._Reader, "_waiting", [])
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        assert [hersey.read(log).rows for _ in range(2)] == [60, 60]
        opening._Reader._waiting.clear()
        assert hersey.read(log).rows == 60
    assert [type(each.message) for each in heard] == [SandboxWarning]
    said = heard[0].message
    assert isinstance(said, SandboxWarning)
    assert said.missing == missing
    again = pickle.loads(pickle.dumps(said))
    assert (again.missing, str(again)) == (missing, str(said))


def test_a_whole_sandbox_is_worth_no_word(log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    needs_whole_sandbox()
    monkeypatch.setattr(opening, "_warned", False)
    monkeypatch.setattr(opening._Reader, "_waiting", [])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert hersey.read(log).rows == 60


def test_what_the_process_does_to_its_descriptor_is_not_seen_here(log: Path) -> None:
    with open_file(log) as file, opening._own_descriptor(OpenFile(log, file)) as descriptor:
        os.lseek(descriptor, 7, os.SEEK_SET)
        fcntl.fcntl(descriptor, fcntl.F_SETFL, os.O_APPEND)
        assert os.lseek(file.fileno(), 0, os.SEEK_CUR) == 0
        assert not fcntl.fcntl(file.fileno(), fcntl.F_GETFL) & os.O_APPEND
        assert fcntl.fcntl(descriptor, fcntl.F_GETFL) & os.O_ACCMODE == os.O_RDONLY


def test_only_what_is_installed_on_the_import_path_can_be_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A folder of scripts cannot, nor what stands beside packages that were installed there."""
    (tmp_path / "here" / "extra").mkdir(parents=True)
    (tmp_path / "here" / "extra" / "__init__.py").touch()
    (tmp_path / "here" / "mine.py").touch()
    records = tmp_path / "here" / "extra-1.0.dist-info"
    records.mkdir()
    (records / "METADATA").write_text("Metadata-Version: 2.1\nName: extra\nVersion: 1.0\n")
    (records / "RECORD").write_text(
        "extra/__init__.py,,\nextra-1.0.dist-info/RECORD,,\n../../bin/extra,,\n/etc/passwd,,\n"
    )
    (tmp_path / "lib" / "site-packages").mkdir(parents=True)
    before = places()
    monkeypatch.syspath_prepend(tmp_path / "here")
    monkeypatch.syspath_prepend(tmp_path / "lib" / "site-packages")
    monkeypatch.syspath_prepend(tmp_path)
    assert places() - before == {
        str(tmp_path / "here" / "extra"),
        str(records),
        str(tmp_path / "lib" / "site-packages"),
    }
    assert not {sys.prefix, sys.base_prefix, "/usr", "/", str(Path.home())} & places()


#: Calls by their numbers on each architecture, their arguments, and the error of the filter, None if allowed.
CALLS: list[tuple[str, dict[str, int], tuple[int, ...], int | None]] = [
    ("read", {"x86_64": 0, "aarch64": 63}, (0,), None),
    ("fork", {"x86_64": 57}, (), errno.EPERM),
    ("vfork", {"x86_64": 58}, (), errno.EPERM),
    ("clone of a thread", {"x86_64": 56, "aarch64": 220}, (0x003D0F00,), None),
    ("clone of a process", {"x86_64": 56, "aarch64": 220}, (0x01200011,), errno.EPERM),
    ("clone of a process in memory", {"x86_64": 56, "aarch64": 220}, (0x4111,), errno.EPERM),
    ("clone with files", {"x86_64": 56, "aarch64": 220}, (0x003F0F00,), errno.EPERM),
    ("clone3", {"x86_64": 435, "aarch64": 435}, (0,), errno.ENOSYS),
    ("a call of the future", {"x86_64": 999, "aarch64": 999}, (), errno.ENOSYS),
    ("x32", {"x86_64": 0x40000000}, (), errno.ENOSYS),
    ("openat to read", {"x86_64": 257, "aarch64": 56}, (0, 0, 0o2000000), None),
    ("openat to write", {"x86_64": 257, "aarch64": 56}, (0, 0, 0o1), errno.EACCES),
    ("openat to read and write", {"x86_64": 257, "aarch64": 56}, (0, 0, 0o2), errno.EACCES),
    ("openat that makes", {"x86_64": 257, "aarch64": 56}, (0, 0, 0o100), errno.EACCES),
    ("openat that cuts", {"x86_64": 257, "aarch64": 56}, (0, 0, 0o1000), errno.EACCES),
    ("open to read", {"x86_64": 2}, (0, 0), None),
    ("open that makes", {"x86_64": 2}, (0, 0o101), errno.EACCES),
    ("a descriptor anew", {"x86_64": 72, "aarch64": 25}, (0, 1030), None),
    ("an owner of signals", {"x86_64": 72, "aarch64": 25}, (0, 8), errno.EPERM),
    ("flags of a descriptor", {"x86_64": 72, "aarch64": 25}, (0, 4), errno.EPERM),
    ("is it a terminal?", {"x86_64": 16, "aarch64": 29}, (0, 0x5401), None),
    ("typing at a terminal", {"x86_64": 16, "aarch64": 29}, (0, 0x5412), errno.ENOTTY),
    ("a name of a thread", {"x86_64": 157, "aarch64": 167}, (15,), None),
    ("no death with the parent", {"x86_64": 157, "aarch64": 167}, (1,), errno.EPERM),
    ("to see a limit", {"x86_64": 302, "aarch64": 261}, (0, 9, 0), None),
    ("to set a limit", {"x86_64": 302, "aarch64": 261}, (0, 9, 1), errno.EPERM),
    ("to set a limit from far", {"x86_64": 302, "aarch64": 261}, (0, 9, 1 << 40), errno.EPERM),
    ("to see another's limit", {"x86_64": 302, "aarch64": 261}, (1, 9, 0), errno.EPERM),
    ("to abort", {"x86_64": 234, "aarch64": 131}, (4242, 4242, 6), None),
    ("to signal another", {"x86_64": 234, "aarch64": 131}, (1, 1, 6), errno.EPERM),
    ("memory not needed", {"x86_64": 28, "aarch64": 233}, (0, 0, 4), None),
    ("poisoned memory", {"x86_64": 28, "aarch64": 233}, (0, 0, 100), errno.EPERM),
    ("execve", {"x86_64": 59, "aarch64": 221}, (), errno.EPERM),
    ("socket", {"x86_64": 41, "aarch64": 198}, (2, 1), errno.EPERM),
    ("setrlimit", {"x86_64": 160, "aarch64": 164}, (9, 0), errno.EPERM),
    ("fchmodat", {"x86_64": 268, "aarch64": 53}, (), errno.EPERM),
    ("utimensat", {"x86_64": 280, "aarch64": 88}, (), errno.EPERM),
    ("setxattr", {"x86_64": 188, "aarch64": 5}, (), errno.EPERM),
    ("shmget", {"x86_64": 29, "aarch64": 194}, (), errno.EPERM),
    ("unshare", {"x86_64": 272, "aarch64": 97}, (), errno.EPERM),
    ("kill", {"x86_64": 62, "aarch64": 129}, (4242, 9), errno.EPERM),
]


def run_filter(program: bytes, seen: bytes) -> int:
    """What a filter answers, by the rules of classic BPF."""
    steps = [struct.unpack_from("=HBBI", program, at) for at in range(0, len(program), 8)]
    held, at = 0, 0
    while True:
        code, then, other, value = steps[at]
        at += 1
        if code == 0x20:
            held = struct.unpack_from("=I", seen, value)[0]
        elif code == 0x54:
            held &= value
        elif code in (0x15, 0x35):
            at += then if (held == value if code == 0x15 else held >= value) else other
        else:
            assert code == 0x06
            return int(value)


@pytest.mark.parametrize("architecture", ["x86_64", "aarch64"])
def test_the_filter_of_each_architecture(architecture: str) -> None:
    audit = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
    program = filter_of(architecture, 4242)
    assert program is not None
    assert len(program) // 8 < 4096
    for what, numbers, arguments, error in CALLS:
        if architecture in numbers:
            given = [*arguments, *[0] * (6 - len(arguments))]
            seen = struct.pack("=IIQ6Q", numbers[architecture], audit[architecture], 0, *given)
            answer = 0x7FFF0000 if error is None else 0x00050000 | error
            assert run_filter(program, seen) == answer, what
    foreign = struct.pack("=IIQ6Q", 0, 0x40000003, 0, *[0] * 6)  # a program of 32 bits
    assert run_filter(program, foreign) == 0x00050000 | errno.EPERM
    assert filter_of("riscv64", 1) is None
