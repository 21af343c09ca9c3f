"""A cluster of Dask: on this machine or by its address, with workers that have the same hersey."""

from __future__ import annotations

import asyncio
import logging
import os
import re
import signal
import warnings
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

from hersey import _core
from hersey.errors import MissingFileError, ParameterError, UnfinishedError

if TYPE_CHECKING:
    from distributed import Client

#: Time within which a scheduler answers, s.
_ANSWER = 8.0
#: Time that the first worker has to come, and one after all are lost, s.
_FIRST, _WORKERS = 20.0, 60.0
#: Workers of ours: Ctrl-C is for their parent alone, with which they end, and one that could not start again
#: is made anew soon.
_SETTINGS = {
    "distributed.worker.daemon": True,
    "distributed.worker.preload": ["import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"],
    "distributed.deploy.lost-worker-timeout": "2s",
}
#: What the standard library says of a process that was ended at once, when it clears up behind it.
_LEAKED = "ignore::UserWarning:multiprocessing.resource_tracker"
_WAY_OUT = "pip install 'hersey[scale]'"


def without_workers() -> float:
    """Return the time after which nobody is waited for any longer, s."""
    return _WORKERS


def needs_dask() -> None:
    """Refuse what needs Dask where it is not.

    Raises
    ------
    MissingFileError
        With the way out.
    """
    try:
        import distributed  # noqa: F401 - whether it is there
    except ImportError:
        raise MissingFileError(f"workers need Dask, which is not installed: {_WAY_OUT}") from None


@contextmanager
def connected(client: Client | str) -> Iterator[tuple[Client, str]]:
    """Yield a client, made where an address is given, and the name of its scheduler.

    Raises
    ------
    ParameterError
        If it is no address, or nothing answers there within some seconds.
    """
    needs_dask()
    if not isinstance(client, str):
        if not hasattr(client, "submit") or not hasattr(client, "scheduler_info"):
            raise ParameterError(
                f"client is a {type(client).__name__}: give a distributed.Client or an address"
            )
        yield client, _address(client)
        return
    from distributed import Client

    if not re.fullmatch(r"(tcp|tls|ws|wss|ucx)://.+:\d+", client):
        raise ParameterError(f"'{client}' is no address of a scheduler: give one as tcp://host:8786")
    quiet()
    try:
        with warnings.catch_warnings():  # of other versions: that of hersey counts, and is asked
            warnings.simplefilter("ignore")
            with ThreadPoolExecutor(1) as apart:  # where no loop runs
                apart.submit(asyncio.run, _answered(client)).result()
            made: Client = Client(client, timeout=_ANSWER, set_as_default=False)
    except Exception:  # what answers there may be anything
        raise ParameterError(
            f"no scheduler of Dask answers at {client}: start one with 'dask scheduler', and give the "
            f"address that it prints, as tcp://host:8786"
        ) from None
    try:
        yield made, client
    finally:
        made.close(timeout=2)


async def _answered(address: str) -> None:
    """Wait for the answer of a scheduler; a client that gets none takes long to give up, and complains."""
    from distributed import Security
    from distributed.core import rpc

    async def ask() -> None:
        credentials = Security().get_connection_args("client")
        async with rpc(address, timeout=_ANSWER, connection_args=credentials) as scheduler:
            await scheduler.identity()

    await asyncio.wait_for(ask(), _ANSWER)


@contextmanager
def local_cluster(processes: int) -> Iterator[Client]:
    """Yield the client of a cluster of so many processes on this machine, which end with this one.

    Raises
    ------
    UnfinishedError
        If they cannot be started.
    """
    needs_dask()
    import dask
    from distributed import Client, LocalCluster

    quiet()
    with ExitStack() as stack:
        try:
            stack.enter_context(dask.config.set(_SETTINGS))
            with _without_words(), _deaf_to_ctrl_c():
                cluster = stack.enter_context(
                    LocalCluster(
                        n_workers=processes,
                        processes=True,
                        threads_per_worker=1,
                        dashboard_address=None,
                        silence_logs=logging.CRITICAL,
                    )
                )
            client = stack.enter_context(Client(cluster, set_as_default=False))
        except Exception as error:
            reason = str(error).partition("\n")[0]
            raise UnfinishedError(
                f"{processes} workers could not be started on this machine ({reason}): ask for fewer, or try "
                f"again"
            ) from None
        yield client


@contextmanager
def _without_words() -> Iterator[None]:
    """Let nothing be printed of a port that another has, nor of what is cleared up after a sudden end."""
    before = os.environ.get("PYTHONWARNINGS")
    os.environ["PYTHONWARNINGS"] = ",".join(filter(None, (before, _LEAKED)))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        if before is None:
            del os.environ["PYTHONWARNINGS"]
        else:
            os.environ["PYTHONWARNINGS"] = before


@contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """Start threads and processes that Ctrl-C does not reach: it is for this one, which ends them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # which, where it is started, lets Ctrl-C through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def mend(client: Client) -> None:
    """Have the workers of a cluster of ours that could not start again be made anew."""
    cluster: Any = getattr(client, "cluster", None)
    if hasattr(cluster, "worker_spec") and len(cluster.workers) < len(cluster.worker_spec):
        cluster.scale(len(cluster.worker_spec))


def quiet() -> None:
    """Let Dask print nothing: what matters is said in words of ours."""
    import distributed  # noqa: F401 - sets up its loggers when it is imported

    for name in ["tornado", "asyncio", *logging.root.manager.loggerDict]:
        if name.partition(".")[0] in ("distributed", "tornado", "asyncio"):  # some have a level of their own
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


def threads_of(client: Client) -> int:
    """Return how many threads work for a client now."""
    workers: dict[str, Any] = client.scheduler_info(n_workers=-1)["workers"]
    return sum(int(worker["nthreads"]) for worker in workers.values())


def refuse_others(client: Client) -> None:
    """Refuse workers with another hersey, or none; wait a while for the first.

    Raises
    ------
    ParameterError
        It names the worker and the way out.
    """
    from distributed import TimeoutError as NoneCameError

    try:
        client.wait_for_workers(1, timeout=_FIRST)
    except NoneCameError:
        raise ParameterError(
            f"{_address(client)} has no worker: start some with 'dask worker {_address(client)}'"
        ) from None
    versions = client.run(version, on_error="return")
    for worker, found in versions.items():
        if isinstance(found, BaseException):
            said = "no hersey" if isinstance(found, ImportError) else f"no hersey that works ({found})"
            raise ParameterError(f"worker {worker} has {said}: install hersey {_core.VERSION} there, as here")
        if found != _core.VERSION:
            raise ParameterError(
                f"worker {worker} has hersey {found}, not {_core.VERSION}: install the same there"
            )


def version() -> str:
    """Return the version of hersey where this runs."""
    return _core.VERSION


def _address(client: Client) -> str:
    scheduler = client.scheduler
    return str(scheduler.address) if scheduler is not None else "the scheduler"
