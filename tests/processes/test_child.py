"""A child answers, is lost without harm, starts again, and never outlives its parent."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from hersey.processes.child import Child, FailedError, LostError

SCRIPT = """
import ctypes, os, signal, sys, time

def answer(request, payload):
    match request["what"]:
        case "echo":
            print("noise on stdout")
            return {"back": request["words"], "pid": os.getpid()}, payload
        case "abort":
            os.abort()
        case "leave":
            sys.exit(3)
        case "raise":
            raise ValueError("no such thing")
        case "modules":
            return {"modules": sorted(sys.modules)}, b""
        case "wait":
            open(request["sign"], "w").write("here")
            while not os.path.exists(request["until"]):
                time.sleep(0.01)
            return {}, b""
        case "hold":  # in compiled code that lets go of nothing
            open(request["sign"], "w").write(str(os.getpid()))
            ctypes.PyDLL(None).sleep(600)
"""
#: Signals do not end a read here, as with libraries that have handlers of their own.
PARENT = """
import signal
import sys
import polars  # lets the kernel go on with a read that a signal interrupted
from pathlib import Path
from hersey.processes.child import Child
signal.siginterrupt(signal.SIGINT, False)
child = Child(Path(sys.argv[1]))
child.ask({"what": "hold", "sign": sys.argv[2]})
"""
linux = pytest.mark.skipif(sys.platform != "linux", reason="the kernel's signal of a closed pipe")


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "script.py"
    path.write_text(SCRIPT)
    return path


@pytest.fixture
def child(script: Path) -> Child:
    return Child(script)


def pid_of(child: Child) -> int:
    reply, _ = child.ask({"what": "echo", "words": ""})
    return int(reply["pid"])


def is_gone(pid: int) -> bool:
    """Whether a process has ended; one that nobody has waited for yet counts as such."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] in {"Z", "X"}
    except OSError:
        return True


def wait_until(condition: object, seconds: float = 60.0) -> None:
    assert callable(condition)
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "did not happen"
        time.sleep(0.01)


def test_words_and_bytes_come_back(child: Child) -> None:
    content = os.urandom(3_000_000)
    for words in ("", "a\n\x1b[31m €", "\udc80"):
        reply, back = child.ask({"what": "echo", "words": words}, content)
        assert (reply["back"], back) == (words, content)
    assert child.ask({"what": "echo", "words": "again"})[1] == b""


def test_it_stays_for_the_next_question(child: Child) -> None:
    assert pid_of(child) == pid_of(child) != os.getpid()


def test_it_loads_nothing_of_the_package(child: Child) -> None:
    modules = child.ask({"what": "modules"})[0]["modules"]
    assert not {"hersey", "numpy", "altair", "subprocess"} & set(modules)


def test_an_exception_is_told_and_costs_no_process(child: Child) -> None:
    pid = pid_of(child)
    with pytest.raises(FailedError, match="no such thing") as caught:
        child.ask({"what": "raise"})
    assert caught.value.kind == "ValueError"
    with pytest.raises(FailedError):
        child.ask({"what": "leave"})
    assert pid_of(child) == pid


def test_a_lost_process_is_told_with_its_signal_and_replaced(child: Child) -> None:
    with pytest.raises(LostError) as caught:
        child.ask({"what": "abort"})
    assert caught.value.code == -signal.SIGABRT
    assert pid_of(child) > 0


def test_one_that_was_killed_while_idle_is_replaced(child: Child) -> None:
    pid = pid_of(child)
    os.kill(pid, signal.SIGKILL)
    wait_until(lambda: is_gone(pid))
    assert pid_of(child) != pid


def test_a_script_that_is_not_there_is_told(tmp_path: Path) -> None:
    child = Child(tmp_path / "none.py")
    with pytest.raises(FailedError, match="FileNotFoundError") as caught:
        child.ask({})
    assert caught.value.kind == "NotStarted"
    child.stop()


def test_an_answer_that_is_late_or_too_long_is_a_loss(tmp_path: Path) -> None:
    (tmp_path / "slow.py").write_text(
        "import time\n"
        "def answer(request, payload):\n"
        "    time.sleep(request['wait'])\n"
        "    return {}, b'12345678'\n"
    )
    child = Child(tmp_path / "slow.py")
    assert child.ask({"wait": 0}, most=8)[1] == b"12345678"
    with pytest.raises(LostError, match="reply is invalid"):
        child.ask({"wait": 0}, most=7)
    with pytest.raises(LostError, match="does not respond"):
        child.ask({"wait": 1000}, within=0.3)
    assert not child.running


def test_it_imports_what_its_parent_does_and_sees_only_the_environment_it_is_given(tmp_path: Path) -> None:
    (tmp_path / "found").mkdir()
    (tmp_path / "found" / "beside.py").write_text("HERE = 7\n")
    (tmp_path / "says.py").write_text(
        "import beside, os\n"
        "def answer(request, payload):\n"
        "    return {'here': beside.HERE, **os.environ}, b''\n"
    )
    sys.path.insert(0, str(tmp_path / "found"))
    try:
        child = Child(tmp_path / "says.py", {"ONLY": "this"})
        said, _ = child.ask({})
    finally:
        sys.path.remove(str(tmp_path / "found"))
        child.stop()
    assert (said.pop("here"), said.pop("ONLY")) == (7, "this")
    assert set(said) <= {"PYTHONPATH", "LC_CTYPE"}


def test_stopping_ends_it(child: Child) -> None:
    pid = pid_of(child)
    assert child.stop() == -signal.SIGKILL
    assert is_gone(pid)
    assert child.stop() is None


def test_threads_get_their_own_replies(child: Child) -> None:
    replies: dict[int, set[str]] = {}

    def ask(number: int) -> None:
        replies[number] = {
            child.ask({"what": "echo", "words": f"{number}"}, b"%d" % number)[0]["back"] for _ in range(20)
        }

    threads = [threading.Thread(target=ask, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert replies == {number: {f"{number}"} for number in range(8)}


def test_it_outlives_the_thread_that_started_it(child: Child) -> None:
    pids: list[int] = []
    thread = threading.Thread(target=lambda: pids.append(pid_of(child)))
    thread.start()
    thread.join()
    assert pid_of(child) == pids[0]


@linux
def test_a_forked_process_has_its_own(child: Child, tmp_path: Path) -> None:
    """Also one that is forked while a thread waits for the parent's."""
    pid = pid_of(child)
    sign = tmp_path / "sign"
    question = {"what": "wait", "sign": str(sign), "until": str(tmp_path / "end")}
    thread = threading.Thread(target=child.ask, args=(question,))
    thread.start()
    wait_until(lambda: sign.exists() and sign.read_text())
    fork = multiprocessing.get_context("fork")
    ours, theirs = fork.Pipe()
    process = fork.Process(target=lambda: theirs.send(pid_of(child)))
    process.start()
    assert ours.poll(60.0)
    other = ours.recv()
    process.join()
    (tmp_path / "end").touch()
    thread.join(60.0)
    assert other != pid
    assert pid_of(child) == pid
    wait_until(lambda: is_gone(other))


def test_whoever_waits_learns_that_it_was_stopped(child: Child, tmp_path: Path) -> None:
    lost: list[LostError] = []
    sign = tmp_path / "sign"

    def ask() -> None:
        try:
            child.ask({"what": "hold", "sign": str(sign)})
        except LostError as error:
            lost.append(error)

    thread = threading.Thread(target=ask)
    thread.start()
    wait_until(lambda: sign.exists() and sign.read_text())
    child.stop()
    thread.join(60.0)
    assert len(lost) == 1
    assert pid_of(child) > 0


@linux
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGINT])
def test_it_ends_with_its_parent(script: Path, tmp_path: Path, end: signal.Signals) -> None:
    """Also where compiled code lets no signal handler and no thread of Python run."""
    sign = tmp_path / "sign"
    parent = subprocess.Popen(
        [sys.executable, "-c", PARENT, str(script), str(sign)], stderr=subprocess.DEVNULL
    )
    try:
        wait_until(lambda: sign.exists() and sign.read_text())
        pid = int(sign.read_text())
        assert not is_gone(pid)
        parent.send_signal(end)
        assert parent.wait(60.0) == -end
    finally:
        parent.kill()
    wait_until(lambda: is_gone(pid))


def test_a_child_that_nobody_holds_ends(script: Path) -> None:
    child = Child(script)
    pid = pid_of(child)
    del child
    assert is_gone(pid)
