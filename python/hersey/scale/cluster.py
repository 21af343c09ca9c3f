"""Who works: processes of this machine, or a cluster of Dask whose workers have the same hersey."""

from __future__ import annotations

import asyncio
import logging
import re
import warnings
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from hersey import _core
from hersey.errors import MissingFileError, ParameterError
from hersey.scale.local import LocalWorkers

if TYPE_CHECKING:
    from distributed import Client

#: Time within which a scheduler answers, s.
_ANSWER = 8.0
#: Time that the first worker has to come, and one after all are lost, s.
_FIRST, WITHOUT_WORKERS = 20.0, 60.0
_WAY_OUT = "pip install 'hersey[scale]'"


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
        raise MissingFileError(f"workers need Dask, which is not installed. Run {_WAY_OUT}") from None


@contextmanager
def connected(client: Client | LocalWorkers | str) -> Iterator[tuple[Client | LocalWorkers, str]]:
    """Yield who works, a client made where an address is given, and the name of its scheduler.

    Raises
    ------
    ParameterError
        If it is no address, or nothing answers there within some seconds.
    """
    if isinstance(client, LocalWorkers):
        yield client, "this machine"
        return
    needs_dask()
    if not isinstance(client, str):
        if not hasattr(client, "submit") or not hasattr(client, "scheduler_info"):
            raise ParameterError(
                f"client is a {type(client).__name__}. Give a distributed.Client or an address"
            )
        yield client, _address(client)
        return
    from distributed import Client

    if not re.fullmatch(r"(tcp|tls|ws|wss|ucx)://.+:\d+", client):
        raise ParameterError(
            f"'{client}' is not the address of a scheduler. Give one such as tcp://host:8786"
        )
    quiet()
    try:
        with warnings.catch_warnings():  # of other versions: that of hersey counts, and is asked
            warnings.simplefilter("ignore")
            with ThreadPoolExecutor(1) as apart:  # where no loop runs
                apart.submit(asyncio.run, _answered(client)).result()
            made: Client = Client(client, timeout=_ANSWER, set_as_default=False)
    except Exception:  # what answers there may be anything
        raise ParameterError(
            f"no Dask scheduler answers at {client}. Start one with 'dask scheduler' and give the "
            "address that it prints, e.g. tcp://host:8786"
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


def quiet() -> None:
    """Let Dask print nothing: what matters is said in words of ours."""
    import distributed  # noqa: F401 - sets up its loggers when it is imported

    for name in ["tornado", "asyncio", *logging.root.manager.loggerDict]:
        if name.partition(".")[0] in ("distributed", "tornado", "asyncio"):  # some have a level of their own
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


def threads_of(client: Client | LocalWorkers) -> int:
    """Return how many threads work for a client now."""
    if isinstance(client, LocalWorkers):
        return client.count
    workers: dict[str, Any] = client.scheduler_info(n_workers=-1)["workers"]
    return sum(int(worker["nthreads"]) for worker in workers.values())


def refuse_others(client: Client | LocalWorkers) -> None:
    """Refuse workers with another hersey, or none; wait a while for the first.

    Raises
    ------
    ParameterError
        It names the worker and the way out.
    """
    if isinstance(client, LocalWorkers):  # which are this hersey
        return
    from distributed import TimeoutError as NoneCameError

    try:
        client.wait_for_workers(1, timeout=_FIRST)
    except NoneCameError:
        raise ParameterError(
            f"{_address(client)} has no worker. Start some with 'dask worker {_address(client)}'"
        ) from None
    versions = client.run(version, on_error="return")
    for worker, found in versions.items():
        if isinstance(found, BaseException):
            said = "no hersey" if isinstance(found, ImportError) else f"a hersey that does not work ({found})"
            raise ParameterError(f"worker {worker} has {said}. Install hersey {_core.VERSION} there")
        if found != _core.VERSION:
            raise ParameterError(
                f"worker {worker} has hersey {found}, but this machine has {_core.VERSION}. Install the "
                "same version there"
            )


def version() -> str:
    """Return the version of hersey where this runs."""
    return _core.VERSION


def _address(client: Client) -> str:
    scheduler = client.scheduler
    return str(scheduler.address) if scheduler is not None else "the scheduler"
