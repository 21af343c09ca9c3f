"""Worker processes of this machine: each item once, what goes wrong in one line, and nobody else gets in."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import threading
import time
import warnings
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

import hersey
from hersey.errors import ExtrapolationWarning, ParameterError, UnfinishedError
from hersey.scale.local import LocalWorkers, local_workers
from hersey.scale.tasks import done
from tests.cli.command import HERSEY
from tests.scale.test_sweeps import DRAG, GRID, SCENARIO, TRAIN, assert_same, finished
from tests.untrusted_input.watching import is_gone, linux, wait_until


@pytest.fixture(scope="module")
def workers() -> Iterator[LocalWorkers]:
    with local_workers(2) as workers:
        yield workers


def pid_after(seconds: float, _item: int) -> int:
    time.sleep(seconds)
    return os.getpid()


def killing(folder: str, item: int) -> int:
    """End the worker at item 3, as often as there is no mark of it."""
    if item == 3 and not (mark := Path(folder, "mark")).exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return item


def ending(item: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return item


class Untravelled(Exception):  # noqa: N818 - as a library may have it
    """An exception that cannot be made again from its arguments."""

    def __init__(self, first: str, second: str) -> None:
        super().__init__(first + second)


def raising(item: int) -> int:
    if item == 0:
        raise Untravelled("a", "b")
    raise ParameterError("it is item 1", index=item)


def warning(item: int) -> int:
    warnings.warn(ExtrapolationWarning(f"item {item}"), stacklevel=1)
    return item


def test_each_item_is_done_once_in_two_processes(workers: LocalWorkers) -> None:
    seen: list[tuple[int, int]] = []
    found = done(math.factorial, range(40), client=workers, progress=lambda now, of: seen.append((now, of)))
    assert sorted(found) == [(i, math.factorial(i)) for i in range(40)]
    assert seen[-1] == (40, 40)
    pids = {pid for _, pid in done(partial(pid_after, 0.1), range(4), client=workers)}
    assert len(pids) == 2
    assert os.getpid() not in pids


def test_what_a_task_raises_or_warns_of_comes_through(workers: LocalWorkers) -> None:
    with pytest.raises(ParameterError, match="it is item 1") as refused:
        workers.do(raising, 1)
    assert refused.value.index == 1
    with pytest.raises(RuntimeError, match="Untravelled: ab"):
        workers.do(raising, 0)
    with pytest.warns(ExtrapolationWarning, match="item 5"):
        assert workers.do(warning, 5) == 5


def test_a_killed_worker_costs_its_task_alone(workers: LocalWorkers, tmp_path: Path) -> None:
    found = done(partial(killing, str(tmp_path)), range(8), client=workers)
    assert sorted(found) == [(i, i) for i in range(8)]
    assert (tmp_path / "mark").exists()


def test_an_item_that_ends_every_worker_is_an_error(workers: LocalWorkers) -> None:
    with pytest.raises(UnfinishedError, match="4 worker processes in a row ended at the same item"):
        workers.do(ending, 1)
    assert workers.do(math.factorial, 3) == 6


def test_the_bits_of_a_sweep_are_those_of_one_process(workers: LocalWorkers, tmp_path: Path) -> None:
    memory = hersey.sweep(TRAIN, DRAG, **GRID)
    assert_same(hersey.sweep(TRAIN, DRAG, **GRID, work=hersey.Work(client=workers, chunk=6)), memory)
    kept = hersey.sweep(
        TRAIN, DRAG, **GRID, work=hersey.Work(client=workers, chunk=6), out=tmp_path / "a.zarr"
    )
    assert_same(kept, memory)
    given = {"stiffness": np.geomspace(300.0, 3000.0, 5), "mass": [0.5, 2.0]}
    bands = hersey.hysteresis_sweep(TRAIN, DRAG, **given)
    assert bands.identical(hersey.hysteresis_sweep(TRAIN, DRAG, **given, work=hersey.Work(client=workers)))


def test_they_end_with_the_block_also_at_work() -> None:
    said: list[Any] = []
    with local_workers(2) as workers:
        pids = {pid for _, pid in done(partial(pid_after, 0.1), range(4), client=workers)}
        thread = threading.Thread(target=lambda: said.append(ended_early(workers)))
        thread.start()
        time.sleep(0.1)
    thread.join(20.0)
    assert [type(each) for each in said] == [UnfinishedError]
    assert len(pids) == 2
    assert all(map(is_gone, pids))


def ended_early(workers: LocalWorkers) -> Exception | None:
    try:
        workers.do(partial(pid_after, 600.0), 1)
    except UnfinishedError as error:
        return error
    return None


@linux
def test_nobody_else_can_have_the_workers_run_anything(tmp_path: Path) -> None:
    """While a sweep has workers, no process of it listens; whoever did would be asked to run something."""
    (tmp_path / "s.toml").write_text(SCENARIO.replace("count = 50", "count = 400"))
    typed = [*HERSEY, "sweep", "s.toml", "--out", "a.zarr", "--chunk", "500", "--workers", "2"]
    with subprocess.Popen(typed, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            wait_until(lambda: process.poll() is not None or finished(tmp_path / "a.zarr"))
            assert process.poll() is None
            command = psutil.Process(process.pid)
            tree = [command, *command.children(recursive=True)]
            assert len(tree) == 3
            listening = [
                end.laddr
                for each in tree
                for end in each.net_connections(kind="all")
                if end.status == psutil.CONN_LISTEN or (end.laddr and end.status == psutil.CONN_NONE)
            ]
            assert [address for address in listening if runs_code(address)] == []
            assert listening == []
        finally:
            process.kill()


def runs_code(address: Any) -> bool:
    """Whether a client without credentials has something run there."""
    from distributed import Client

    try:
        with Client(f"tcp://{address.ip}:{address.port}", timeout=5, set_as_default=False) as client:
            return isinstance(client.run_on_scheduler(os.getpid), int)
    except Exception:  # whatever it is that answers
        return False
