"""Threads, forks and deaths: each file has its own reader, and none outlives what asked for it."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import HerseyError
from hersey.log.formats import opening
from hersey.log.formats.opening import _Reader
from hersey.processes.child import Child
from tests.conftest import ROOT
from tests.untrusted_input.mdf_blocks import Channel, mf4
from tests.untrusted_input.other_blocks import tdms
from tests.untrusted_input.seeds import COLUMNS, ROWS, SEEDS, SPEED, TEMPERATURE, TIME
from tests.untrusted_input.watching import children, is_gone, linux, open_files, state, wait_until

h5py = pytest.importorskip("h5py")
pytest.importorskip("nptdms")
pytest.importorskip("asammdf")
pytestmark = linux
#: A reader that never ends loading numbers.
SPINNING = """
import runpy
space = runpy.run_path({answering!r}, run_name="__main__")

def answer(request, payload):
    while request["do"] == "load":
        pass
    return space["answer"](request, payload)
"""
#: A program that reads with such a reader.
READING = """
import sys
from pathlib import Path
import hersey
from hersey.log.formats import opening
opening._SCRIPT = Path(sys.argv[1])
opening._TIME = 1e6
hersey.read(sys.argv[2])
"""


def spinning(pid: int) -> bool:
    """Whether a reader has been busy for longer than it takes to start."""
    fields = state(pid)
    return bool(fields) and int(fields[11]) / os.sysconf("SC_CLK_TCK") > 3.0


def children_of(pid: int) -> list[int]:
    tasks = Path(f"/proc/{pid}/task").iterdir()
    return [int(child) for task in tasks for child in (task / "children").read_text().split()]


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "spinning.py"
    path.write_text(SPINNING.format(answering=str(opening._SCRIPT)))
    return path


@pytest.fixture
def log(tmp_path: Path) -> Path:
    path = tmp_path / "run.h5"
    path.write_bytes(SEEDS["run.h5"]())
    return path


@pytest.fixture
def fresh_readers(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[object]]:
    """No reader waits at the start, and none is left at the end."""
    monkeypatch.setattr(opening._Reader, "_waiting", [])
    yield opening._Reader._waiting
    for reader in opening._Reader._waiting:
        reader.stop()


@pytest.fixture
def program(script: Path, log: Path) -> Iterator[subprocess.Popen[bytes]]:
    """Another program, in which a reader is busy."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", READING, str(script), str(log)]
    with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE) as process:
        wait_until(lambda: any(spinning(pid) for pid in children_of(process.pid)), 120.0)
        yield process
        process.kill()


def write_differing(folder: Path, number: int) -> tuple[Path, float]:
    """A log of one of four formats, and the torque that only it holds."""
    torque = np.full(ROWS, 1.0 + number)
    channels = [("Torque", "N*m", torque), ("Speed", "rpm", SPEED), ("Temp", "degC", TEMPERATURE)]
    kind = ("mf4", "h5", "parquet", "tdms")[number % 4]
    path = folder / f"log{number}.{kind}"
    if kind == "mf4":
        clock = Channel("t", TIME, "s", kind=2)
        path.write_bytes(mf4([clock, *(Channel(name, values, unit) for name, unit, values in channels)]))
    elif kind == "h5":
        with h5py.File(path, "w") as file:
            for name, values in (COLUMNS | {"torque_Nm": torque}).items():
                file[name] = values
    elif kind == "parquet":
        import polars

        polars.DataFrame(COLUMNS | {"torque_Nm": torque}).write_parquet(path)
    else:
        path.write_bytes(tdms(channels))
    return path, float(torque[0])


def test_eight_threads_read_forty_files_each(tmp_path: Path) -> None:
    files = [write_differing(tmp_path, number) for number in range(40)]
    wrong: list[str] = []
    right: list[str] = []

    def read(first: int) -> None:
        for number in range(40):
            path, torque = files[(first * 5 + number) % 40]
            try:
                run = hersey.read(path).runs[0]
            except Exception as error:
                wrong.append(f"{path.name}: {error!r}")
                continue
            alone = bool(np.all(run.torque == torque)) and run.name.startswith(path.stem)
            (right if alone else wrong).append(path.name)

    threads = [threading.Thread(target=read, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []
    assert len(right) == 320
    assert len(opening._Reader._waiting) <= 9


def test_a_reader_that_is_killed_is_told_and_replaced(
    script: Path, log: Path, fresh_readers: list[object], monkeypatch: pytest.MonkeyPatch
) -> None:
    before = set(children())
    told: list[str] = []

    def read() -> None:
        try:
            hersey.read(log)
        except HerseyError as error:
            told.append(str(error))

    with monkeypatch.context() as changed:
        changed.setattr(opening, "_SCRIPT", script)
        changed.setattr(opening, "_TIME", 1e6)
        thread = threading.Thread(target=read)
        thread.start()
        wait_until(lambda: any(spinning(pid) for pid in set(children()) - before), 120.0)
        (pid,) = set(children()) - before
        os.kill(pid, signal.SIGKILL)
        thread.join(60.0)
    assert len(told) == 1
    assert told[0].startswith("run.h5 ")
    assert is_gone(pid)
    fresh_readers.clear()
    assert hersey.read(log).rows == ROWS


def test_a_reader_that_runs_away_is_ended(
    script: Path, log: Path, fresh_readers: list[object], monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as changed:
        changed.setattr(opening, "_SCRIPT", script)
        with pytest.raises(HerseyError, match=r"run\.h5 takes more processor time than a sound file"):
            hersey.read(log)
    assert len(fresh_readers) == 1
    fresh_readers.clear()
    assert hersey.read(log).rows == ROWS


def test_it_ends_when_its_parent_is_killed(program: subprocess.Popen[bytes]) -> None:
    readers = children_of(program.pid)
    program.kill()
    program.wait()
    wait_until(lambda: all(is_gone(pid) for pid in readers), 20.0)


def test_ctrl_c_ends_both(program: subprocess.Popen[bytes]) -> None:
    readers = children_of(program.pid)
    program.send_signal(signal.SIGINT)
    _, words = program.communicate(timeout=20.0)
    assert program.returncode == -signal.SIGINT
    assert words.rstrip().endswith(b"KeyboardInterrupt")
    assert all(is_gone(pid) for pid in readers)


FORKING = """
import os, sys
import hersey
text, *binary = sys.argv[1:]
hersey.read(text)
hersey.read(binary[0])
if os.fork() == 0:
    try:
        hersey.read(text)
    except hersey.errors.ForkedError as error:
        print("refused", flush=True)
    for path in binary:
        print(hersey.read(path).rows, flush=True)
    os._exit(0)
os.wait()
for path in sys.argv[1:]:
    print(hersey.read(path).rows, flush=True)
"""


def test_a_forked_process_reads_what_needs_no_polars(tmp_path: Path) -> None:
    names = ("comma.csv", "run.mf4", "run.h5", "run.tdms", "v5.mat", "run.parquet", "run.lvm")
    for name in names:
        (tmp_path / name).write_bytes(SEEDS[name]())
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", FORKING, *names],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False, timeout=120.0,
    )  # fmt: skip
    assert done.stderr == ""
    assert done.stdout.split() == ["refused", *["60"] * 6, *["60"] * 7]


def rows_of(path: Path) -> int:
    return hersey.read(path).rows


def test_processes_that_are_spawned_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT)
    paths = [write_differing(tmp_path, number)[0] for number in range(8)]
    (tmp_path / "a.csv").write_bytes(SEEDS["comma.csv"]())
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map(rows_of, [*paths, tmp_path / "a.csv"]) == [ROWS] * 9


def test_fifty_files_leave_nothing_behind(tmp_path: Path, fresh_readers: list[object]) -> None:
    paths = [write_differing(tmp_path, number)[0] for number in range(4)]
    damaged = tmp_path / "damaged.h5"
    damaged.write_bytes(SEEDS["run.h5"]()[:3000])
    hersey.read(paths[0])
    processes, files = children(), open_files()
    for number in range(50):
        hersey.read(paths[number % 4])
        with pytest.raises(HerseyError):
            hersey.read(damaged)
    assert children() == processes
    assert open_files() == files
    assert [fields[0] for pid in children() if (fields := state(pid)) and fields[0] == "Z"] == []
    assert len(fresh_readers) == 1


def test_a_process_that_does_not_start_is_no_damage_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "log.parquet").write_bytes(SEEDS["run.parquet"]())
    monkeypatch.setattr(_Reader, "_waiting", [])
    with monkeypatch.context() as broken:
        broken.setattr(sys, "executable", str(tmp_path / "no-python"))
        with pytest.raises(
            hersey.HerseyError, match="the process that reads such files cannot be started"
        ) as told:
            hersey.read(tmp_path / "log.parquet")
    assert "damaged" not in str(told.value)
    assert hersey.read(tmp_path / "log.parquet").rows > 0


def test_a_process_that_ran_out_of_memory_reads_no_other_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    waiting: list[Child] = []
    monkeypatch.setattr(_Reader, "_waiting", waiting)
    first = {"time": "time#1", "torque": "torque#1", "speed": "speed#1", "temperature": "temp#1"}
    with h5py.File(tmp_path / "many.h5", "w") as file:
        for name in ("time_s", "torque_Nm", "speed_rpm", "temp_degC"):
            file.create_dataset(name, shape=(8, 10_000_000), dtype="f8", chunks=(1, 1_000_000), fillvalue=1.0)
    (tmp_path / "log.parquet").write_bytes(SEEDS["run.parquet"]())
    with hersey.memory_limit("300 MB"), pytest.raises(hersey.HerseyError, match="memory_limit"):
        hersey.read(tmp_path / "many.h5", channels=first)
    assert [child.running for child in waiting] == [False]
    assert hersey.read(tmp_path / "log.parquet").rows > 0


def test_the_limit_of_memory_holds_for_threads(tmp_path: Path) -> None:
    path = tmp_path / "many.h5"
    with h5py.File(path, "w") as file:
        for name in ("time_s", "torque_Nm", "speed_rpm", "temp_degC"):
            file.create_dataset(name, shape=(15_000_000,), dtype="f8", chunks=(1_000_000,), fillvalue=1.0)
    with hersey.memory_limit("300 MB"), ThreadPoolExecutor(1) as threads:
        told = threads.submit(hersey.read, path).exception()
    assert "needs more than 0.3 GB" in str(told)


def test_signals_beyond_all_bounds_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "wide.h5"
    with h5py.File(path, "w") as file:
        for number in range(400):
            file.create_dataset(f"m{number}", shape=(1000, 256), dtype="f4", chunks=(1000, 256))
    with pytest.raises(hersey.HerseyError, match=r"wide\.h5: holds 102400 channels; at most 100000"):
        hersey.read(path)


def test_who_only_imports_the_reader_is_not_confined(tmp_path: Path) -> None:
    importing = "import hersey.log.formats.answering, sys; open(sys.argv[1], 'w').write('free')"
    subprocess.run([sys.executable, "-c", importing, tmp_path / "out"], cwd=ROOT, check=True)
    assert (tmp_path / "out").read_text() == "free"
