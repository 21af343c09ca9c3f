"""Tasks by threads and by workers: each once, results as they end, and what goes wrong in one line."""

from __future__ import annotations

import math
import os
import signal
import threading
import time
from functools import partial
from typing import TYPE_CHECKING, Any

import pytest

from hersey import _core
from hersey.errors import MissingFileError, ParameterError, UnfinishedError
from hersey.scale import cluster, tasks
from hersey.scale.tasks import done, in_order

if TYPE_CHECKING:
    from distributed import Client


def marked(folder: str, item: int) -> int:
    """Leave a mark, and take a moment."""
    with open(f"{folder}/{item}", "a") as file:  # noqa: PTH123 - shorter
        file.write("x")
    time.sleep(0.02)
    return item * item


@pytest.mark.parametrize("threads", [1, 3])
def test_threads_do_each_item_once(threads: int, tmp_path: Any) -> None:
    seen: list[tuple[int, int]] = []
    items = range(20)
    found = done(
        partial(marked, str(tmp_path)),
        items,
        threads=threads,
        progress=lambda now, of: seen.append((now, of)),
        size=lambda item: item,
    )
    assert sorted(found) == [(i, i * i) for i in items]
    assert [file.read_text() for file in tmp_path.iterdir()] == ["x"] * 20
    assert seen[-1] == (190, 190)


def test_threads_begin_little_ahead_and_stop_with_who_asks(tmp_path: Any) -> None:
    taken: list[int] = []

    class Items(list[int]):
        def __getitem__(self, index: Any) -> Any:
            taken.append(index)
            return index

    found = done(partial(marked, str(tmp_path)), Items(range(1000)), threads=2)
    for _ in range(5):
        next(found)
    assert max(taken) < 5 + 2 * 4
    found.close()  # type: ignore[attr-defined]
    time.sleep(0.1)
    assert len(list(tmp_path.iterdir())) <= 5 + 2 * 4


def test_results_in_the_order_of_the_items() -> None:
    assert list(in_order([(2, "c"), (0, "a"), (1, "b"), (3, "d")])) == list("abcd")


@pytest.mark.parametrize("threads", [0, -1, 1.5, True])
def test_no_threads_are_refused(threads: Any) -> None:
    with pytest.raises(ParameterError, match="threads is"):
        list(done(math.factorial, [1], threads=threads))


def test_workers_do_each_item_and_an_error_comes_through(client: Client) -> None:
    seen: list[tuple[int, int]] = []
    found = done(math.factorial, range(40), client=client, progress=lambda now, of: seen.append((now, of)))
    assert sorted(found) == [(i, math.factorial(i)) for i in range(40)]
    assert seen[-1] == (40, 40)
    with pytest.raises(ValueError, match="math domain error"):
        list(done(math.sqrt, [1.0, -1.0], client=client))


def test_workers_are_given_little_ahead(client: Client, tmp_path: Any) -> None:
    found = done(partial(marked, str(tmp_path)), range(500), client=client)
    for _ in range(4):
        next(found)
    found.close()  # type: ignore[attr-defined]
    time.sleep(0.3)
    assert len(list(tmp_path.iterdir())) <= 4 + 2 * 4


def test_a_killed_worker_costs_its_task_alone(client: Client) -> None:
    pids = client.run(os.getpid)

    def kill() -> None:
        time.sleep(0.3)
        os.kill(next(iter(pids.values())), signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    found = sorted(done(partial(_slow, 0.1), range(16), client=client))
    killer.join()
    assert found == [(i, i) for i in range(16)]
    client.wait_for_workers(2, timeout=60)


def _slow(seconds: float, item: int) -> int:
    time.sleep(seconds)
    return item


def test_an_item_that_ends_every_worker_is_named(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    from distributed.scheduler import KilledWorker

    class Future:
        def result(self) -> Any:
            raise KilledWorker("task", None, 3)  # type: ignore[arg-type, no-untyped-call]

    window = tasks._Window(math.factorial, [1, 2], client, "tcp://somewhere:1")
    begun: list[tuple[int, int]] = []
    monkeypatch.setattr(window, "_begin", lambda index, asked: begun.append((index, asked)))
    assert window._result(Future(), 1, 3) == []  # type: ignore[arg-type]
    assert begun == [(1, 4)]
    with pytest.raises(UnfinishedError, match="item 1 ended 48 workers") as caught:
        window._result(Future(), 1, 12)  # type: ignore[arg-type]
    assert caught.value.index == 1


def test_that_no_worker_is_left_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    class Deserted:
        status = "running"

        def scheduler_info(self, n_workers: int) -> dict[str, Any]:  # noqa: ARG002
            return {"workers": {}}

    monkeypatch.setattr(tasks, "_PATIENCE", 0.01)
    monkeypatch.setattr(tasks, "WITHOUT_WORKERS", 0.05)
    window = tasks._Window(math.factorial, [1], Deserted(), "tcp://somewhere:1")  # type: ignore[arg-type]
    with pytest.raises(UnfinishedError, match="tcp://somewhere:1 has no workers left"):
        window._ended()


def test_a_worker_of_another_version_is_refused(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ParameterError, match=f"hersey {_core.VERSION}, but 9.9.9 is needed"):
        tasks._checked("9.9.9", math.sqrt, 4.0)
    monkeypatch.setattr(cluster, "version", lambda: "0.0.0")
    with pytest.raises(ParameterError, match=r"has hersey 0.0.0, but .*. Install the same version there"):
        list(done(math.sqrt, [4.0], client=client))
    monkeypatch.setattr(cluster, "version", _lacking)
    with pytest.raises(ParameterError, match=r"worker tcp://.* has no hersey. Install hersey"):
        list(done(math.sqrt, [4.0], client=client))


def _lacking() -> str:
    raise ModuleNotFoundError("No module named 'hersey'")


def test_no_scheduler_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_ANSWER", 0.3)
    with pytest.raises(ParameterError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9\. "):
        list(done(math.sqrt, [4.0], client="tcp://127.0.0.1:9"))
    with pytest.raises(ParameterError, match="'nonsense' is not the address of a scheduler"):
        list(done(math.sqrt, [4.0], client="nonsense"))
    with pytest.raises(ParameterError, match="client is a int"):
        list(done(math.sqrt, [4.0], client=3))  # type: ignore[arg-type]


def test_without_dask_the_way_out_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(MissingFileError, match=r"pip install 'hersey\[scale\]'"):
        list(done(math.sqrt, [4.0], client="tcp://127.0.0.1:9"))
