"""Worker processes on this machine, asked through pipes that nobody else can reach: no port, no scheduler."""

from __future__ import annotations

import os
import pickle
import queue
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hersey.errors import UnfinishedError
from hersey.processes.child import Child, FailedError, LostError

_SCRIPT = Path(__file__).with_name("worker.py")
#: Each worker computes in one thread.
_ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
#: Workers that an item may end before it is given up.
_WORKERS_PER_ITEM = 4


class LocalWorkers:
    """So many worker processes, each of which does one task at a time and ends with this process."""

    def __init__(self, count: int) -> None:
        """Prepare them: each starts with its first task."""
        self.count = count
        self._workers = [Child(_SCRIPT, {**os.environ, **_ONE_THREAD}) for _ in range(count)]
        self._idle: queue.SimpleQueue[Child] = queue.SimpleQueue()
        self._closed = False
        for worker in self._workers:
            self._idle.put(worker)

    def do(self, task: Callable[[Any], Any], item: Any) -> Any:
        """Return what a task makes of an item in the next worker that is idle; raise what it raises.

        Raises
        ------
        UnfinishedError
            If the item ends one worker after the other, or a worker cannot be started.
        """
        worker = self._idle.get()
        try:
            return self._done_by(worker, pickle.dumps((task, item)))
        finally:
            self._idle.put(worker)

    def _done_by(self, worker: Child, parcel: bytes) -> Any:
        for _ in range(_WORKERS_PER_ITEM):
            if self._closed:
                break
            try:
                _, answer = worker.ask({}, parcel)
            except LostError as error:
                if error.code is None and not self._closed:
                    raise UnfinishedError(
                        f"a worker process cannot be started ({error}). Use fewer workers"
                    ) from None
                continue
            except FailedError as error:
                raise UnfinishedError(f"a worker process failed ({error.kind}: {error})") from None
            result, raised, heard = pickle.loads(answer)
            for warning in heard:
                warnings.warn(warning, stacklevel=2)
            if raised is not None:
                raise raised
            return result
        raise UnfinishedError(
            f"{_WORKERS_PER_ITEM} worker processes in a row ended at the same item. It may need more "
            "memory than there is. Try fewer workers"
        )

    def close(self) -> None:
        """End the processes, also those at work."""
        self._closed = True
        for worker in self._workers:
            worker.stop()


@contextmanager
def local_workers(count: int) -> Iterator[LocalWorkers]:
    """Yield so many worker processes on this machine, which end with the block."""
    workers = LocalWorkers(count)
    try:
        yield workers
    finally:
        workers.close()
