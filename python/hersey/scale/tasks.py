"""Tasks done in threads, in processes of this machine or by the workers of Dask: results as they end."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from hersey import _core
from hersey.errors import ParameterError, UnfinishedError
from hersey.scale.cluster import WITHOUT_WORKERS, connected, refuse_others, threads_of
from hersey.scale.local import LocalWorkers

if TYPE_CHECKING:
    from distributed import Client, Future

Item = TypeVar("Item")
R = TypeVar("R")

#: Tasks under way per thread that works: while one is done the next ones lie ready.
_AHEAD = 3
#: Times that a task is asked for anew after Dask has given it up: each such time it has ended four workers.
_ASKED = 12
#: Time after which one looks whether anybody still works, s.
_PATIENCE = 5.0


def one(_item: object) -> int:
    """Return the size of an item where all count alike."""
    return 1


def done(
    task: Callable[[Item], R],
    items: Sequence[Item],
    *,
    client: Client | LocalWorkers | str | None = None,
    threads: int = 1,
    progress: Callable[[int, int], object] | None = None,
    size: Callable[[Item], int] = one,
) -> Iterator[tuple[int, R]]:
    """Yield what a task makes of each item as it ends, with the index of the item.

    What is begun ahead is bounded, a few items per thread that works, so neither items nor results pile up.
    What a task raises ends all, and comes through. Where this ends early (Ctrl-C) what waits is
    cancelled; what runs elsewhere comes to the end of its item, unheard.

    Parameters
    ----------
    task
        A function of a module, or a `functools.partial` of one, small: it travels with each item.
    client
        Worker processes of this machine, a ``distributed.Client``, or the address of a scheduler: one item is
        one task. Without it ``threads``
        of this process work; with one thread that is this one.
    progress
        Called with (done, all), counted by ``size``.

    Raises
    ------
    ParameterError
        If the scheduler cannot be reached, a worker has another version of hersey, or none, or ``threads`` is
        below 1.
    UnfinishedError
        If the scheduler or all workers are lost, or an item ends one worker after the other.
    """
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise ParameterError(f"threads is {threads}: it must be a whole number, at least 1")
    total, finished = sum(map(size, items)), 0
    if isinstance(client, LocalWorkers):
        found = _by_threads(partial(client.do, task), items, client.count)
    elif client is not None:
        found = _by_workers(task, items, client)
    elif threads == 1:
        found = ((index, task(item)) for index, item in enumerate(items))
    else:
        found = _by_threads(task, items, threads)
    for index, result in found:
        finished += size(items[index])
        if progress is not None:
            progress(finished, total)
        yield index, result


def in_order(found: Iterable[tuple[int, R]]) -> Iterator[R]:
    """Yield results in the order of their items; what ended early is held back until then."""
    early: dict[int, R] = {}
    following = 0
    for index, result in found:
        early[index] = result
        while following in early:
            yield early.pop(following)
            following += 1


def _by_threads(task: Callable[[Item], R], items: Sequence[Item], threads: int) -> Iterator[tuple[int, R]]:
    ended: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
    pool = ThreadPoolExecutor(threads)

    def begin(index: int) -> None:
        future = pool.submit(task, items[index])
        future.add_done_callback(lambda future: ended.put((index, future)))

    try:
        begun = min(threads * _AHEAD, len(items))
        for index in range(begun):
            begin(index)
        for _ in range(len(items)):
            index, future = ended.get()
            if begun < len(items):
                begin(begun)
                begun += 1
            yield index, future.result()
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def _by_workers(
    task: Callable[[Item], R], items: Sequence[Item], client: Client | str
) -> Iterator[tuple[int, R]]:
    with connected(client) as (known, name):
        assert not isinstance(known, LocalWorkers)
        refuse_others(known)
        yield from _Window(task, items, known, name).results()


class _Window:
    """The items that a scheduler has now."""

    def __init__(self, task: Callable[[Any], Any], items: Sequence[Any], client: Client, name: str) -> None:
        self.task, self.items = partial(_checked, _core.VERSION, task), items
        self.client, self.name = client, name
        self.ended: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self.begun: dict[Future[Any], tuple[int, int]] = {}
        self.next = 0
        self.threads, self.asked = 0, -_PATIENCE

    def results(self) -> Iterator[tuple[int, Any]]:
        try:
            while self.next < len(self.items) or self.begun:
                self._fill()
                future = self._ended()
                index, asked = self.begun.pop(future)
                for result in self._result(future, index, asked):
                    yield index, result
        finally:
            if self.begun:
                with suppress(Exception):  # of a scheduler that is gone
                    self.client.cancel(list(self.begun))

    def _fill(self) -> None:
        if time.monotonic() - self.asked > _PATIENCE:  # an answer takes as long as a short task
            self.threads, self.asked = threads_of(self.client), time.monotonic()
        most = max(_AHEAD * self.threads, 1)
        while self.next < len(self.items) and len(self.begun) < most:
            self._begin(self.next, 1)
            self.next += 1

    def _begin(self, index: int, asked: int) -> None:
        from cloudpickle import dumps  # type: ignore[import-untyped]

        try:
            parcel = dumps((self.task, self.items[index]))
            future = self.client.submit(_opener(), parcel, pure=False)
        except Exception as error:
            raise self._lost() from error
        self.begun[future] = index, asked
        future.add_done_callback(self.ended.put)

    def _ended(self) -> Future[Any]:
        """Return the next that ends; who waits looks now and then whether anybody works."""
        unseen = 0
        while True:
            try:
                return self.ended.get(timeout=_PATIENCE)
            except queue.Empty:
                if self.client.status != "running":
                    raise self._lost() from None
                unseen = 0 if threads_of(self.client) else unseen + 1
                if unseen * _PATIENCE > WITHOUT_WORKERS:
                    raise UnfinishedError(
                        f"{self.name} has no workers left. Start some, and repeat the command"
                    ) from None

    def _result(self, future: Future[Any], index: int, asked: int) -> list[Any]:
        """Return the one result, or none where the item is asked for anew."""
        from distributed.client import FutureCancelledError
        from distributed.scheduler import KilledWorker

        try:
            return [future.result()]
        except FutureCancelledError:
            raise self._lost() from None
        except ModuleNotFoundError as error:
            if (error.name or "").partition(".")[0] != "hersey":
                raise
            raise ParameterError(
                f"a new worker of {self.name} has no hersey. Install hersey {_core.VERSION} there"
            ) from None
        except KilledWorker:
            if asked >= _ASKED:
                raise UnfinishedError(
                    f"item {index} ended {4 * asked} workers of {self.name} in a row. Does it need more "
                    "memory than they have?",
                    index=index,
                ) from None
            self._begin(index, asked + 1)
            return []

    def _lost(self) -> UnfinishedError:
        return UnfinishedError(
            f"the connection to scheduler {self.name} is lost. Check that it is running, and repeat the "
            "command"
        )


def _opener() -> Callable[[bytes], Any]:
    """Return what opens a parcel at a worker and does the task in it.

    Made inside a function it travels as its code, and the parcel as bytes: a scheduler opens what it passes
    on, and need not have hersey.
    """

    def opened(parcel: bytes) -> Any:
        from pickle import loads

        task, item = loads(parcel)
        return task(item)

    return opened


def _checked(version: str, task: Callable[[Item], R], item: Item) -> R:
    """Do a task where the version is that of whoever asks: a worker may have joined later."""
    if version != _core.VERSION:
        raise ParameterError(
            f"a new worker has hersey {_core.VERSION}, but {version} is needed. Install the same "
            "version there"
        )
    return task(item)
