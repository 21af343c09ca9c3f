"""Reading the runs of a campaign in their order: a few here, many in two processes, or by workers.

It is also the script of such a process: see `hersey.processes.server`.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import asdict, replace
from functools import lru_cache, partial
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import TYPE_CHECKING, Any

from hersey.arrays import one_thread
from hersey.cli.options import Reading
from hersey.errors import HerseyError, UnreadableLogError
from hersey.files.reading import hash_of
from hersey.life.campaign import Entry
from hersey.processes.child import Child, FailedError, LostError

if TYPE_CHECKING:
    from hersey.cli.workers import AtWork
    from hersey.machine import Machine

#: Processes that read, runs that are read ahead of the one that is added, and those that are read here.
_PROCESSES, _AHEAD, FEW = 2, 6, 8


def settings_of(reading: Reading, log: Path, machine: Path | None) -> str:
    """Return how a log is read, as the campaign keeps it: the recipe, and hashes of the other files."""
    recipe = reading.recipe([log])
    beside = {"mapping": recipe.chosen.source, "no_load": recipe.no_load, "machine": machine}
    files = {name: {"path": str(path), "sha256": hash_of(path)} for name, path in beside.items() if path}
    kept = replace(recipe, logs=(), mapping=None, no_load=None).to_dict()
    return json.dumps({"recipe": kept, "files": files}, sort_keys=True)


def entry(reading: Reading, log: Path, machine_file: Path | None, settings: str) -> Entry:
    """Read a log, reduce and fit it."""
    from hersey.life.campaign.conversion import entry_of

    how = json.loads(settings)
    machine = None if machine_file is None else _machine_of(machine_file, how["files"]["machine"]["sha256"])
    with one_thread():
        points = reading.points([log], reading.log([log], machine), machine)
        return entry_of(points, log, temperature_scale=reading.temperature_scale, settings=how)


@lru_cache(maxsize=1)
def _machine_of(path: Path, sha256: str) -> Machine:  # noqa: ARG001 - another content is another machine
    """The machine of a file, the same for all runs."""
    from hersey.machine.machine import read_machine

    return read_machine(path)


def _tried(reading: Reading, machine: Path | None, run: tuple[Path, str]) -> Entry | HerseyError:
    """Read a run in this process; an error is returned, not raised."""
    try:
        return entry(reading, run[0], machine, run[1])
    except HerseyError as error:
        return error


def answer(request: dict[str, Any], _payload: bytes) -> tuple[dict[str, Any], bytes]:
    """Read a run in a worker process, or load what that takes."""
    machine = request["machine"] and Path(request["machine"])
    if "log" not in request:
        from hersey.life.campaign import conversion  # noqa: F401 - which loads the rest

        if machine is not None:
            _machine_of(machine, hash_of(machine))
        return {}, b""
    read = entry(Reading(**request["reading"]), Path(request["log"]), machine, request["settings"])
    return asdict(read), b""


@contextmanager
def readers(machine: Path | None) -> Iterator[list[Child]]:
    """Yield the processes that read runs, which begin to load what they need; they end with the context."""
    children = [Child(Path(__file__)) for _ in range(_PROCESSES)]

    def load(child: Child) -> None:
        with suppress(FailedError, LostError):  # as reading a run will say
            child.ask({"machine": machine and str(machine)})

    loading = [Thread(target=load, args=(child,), daemon=True) for child in children]
    for thread in loading:
        thread.start()
    try:
        yield children
    finally:
        for thread, child in zip(loading, children, strict=True):
            child.stop()
            thread.join()  # which may just have started its process
            child.stop()


def entries(
    reading: Reading,
    logs: Sequence[tuple[Path, str]],
    machine: Path | None,
    client: AtWork = None,
    children: Sequence[Child] = (),
) -> Iterator[Entry | HerseyError]:
    """Read logs, each with its settings, and yield the entry or the error of each, in order.

    ``children`` are the `readers` of this machine, where they have begun already.
    """
    if client is not None:
        from hersey.log.many import each_of

        task = partial(_tried, reading.anywhere(), machine and machine.absolute())
        whole = [(log.absolute(), settings) for log, settings in logs]
        yield from each_of(task, whole, called=lambda run: run[0], client=client)
        return
    if len(logs) < FEW:
        yield from (_tried(reading, machine, run) for run in logs)
        return
    with nullcontext(children) if children else readers(machine) as started:
        yield from _in_processes(reading, logs, machine, started)


def _in_processes(
    reading: Reading, logs: Sequence[tuple[Path, str]], machine: Path | None, started: Sequence[Child]
) -> Iterator[Entry | HerseyError]:
    """Read logs in worker processes, a few ahead of the one that is yielded."""
    children: SimpleQueue[Child] = SimpleQueue()
    for child in started:
        children.put(child)

    def read(log: Path, settings: str) -> Entry | HerseyError:
        child = children.get()
        asked = {"log": str(log), "machine": machine and str(machine), "settings": settings}
        try:
            return Entry(**child.ask({"reading": asdict(reading), **asked})[0])
        except FailedError as error:
            return UnreadableLogError(str(error))
        except LostError as error:
            return UnreadableLogError(
                f"{log.name}: the process that read it ended ({error}); add this log alone"
            )
        finally:
            children.put(child)

    with ThreadPoolExecutor(_PROCESSES) as pool:
        pending: deque[Future[Entry | HerseyError]] = deque()
        try:
            for log, settings in logs:
                pending.append(pool.submit(read, log, settings))
                if len(pending) > _AHEAD:
                    yield pending.popleft().result()
            while pending:
                yield pending.popleft().result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            while not children.empty():
                children.get().stop()
