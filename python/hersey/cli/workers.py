"""Worker processes on this machine, or the workers of a Dask scheduler."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import option
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from distributed import Client

    from hersey.scale.local import LocalWorkers

    #: The workers; None is this process alone.
    AtWork = Client | LocalWorkers | None

_SCHEDULER = "Use the workers of a Dask scheduler, e.g. tcp://host:8786."
_WORKERS = "Use N worker processes on this machine (Dask)."


@dataclass(frozen=True)
class Crew:
    """The workers that are used, if not this process alone."""

    scheduler: Annotated[str | None, option(_SCHEDULER, metavar="ADDRESS")] = None
    count: Annotated[int | None, option(_WORKERS, "--workers", metavar="N", min=1)] = None

    @property
    def asked(self) -> bool:
        """Whether workers are asked for."""
        return self.scheduler is not None or self.count is not None

    def at_work(self) -> AbstractContextManager[AtWork]:
        """Yield as `workers` does."""
        return workers(self.scheduler, self.count)


@contextmanager
def workers(scheduler: str | None, count: int | None) -> Iterator[AtWork]:
    """Yield the client of a scheduler, or ``count`` processes on this machine, or None for neither.

    Raises
    ------
    ParameterError
        If both are asked for, or nothing answers at the address.
    MissingFileError
        If a scheduler is given and Dask is not installed.
    """
    if scheduler is not None and count is not None:
        raise ParameterError("--scheduler and --workers exclude each other: give one of them")
    if scheduler is not None:
        from hersey.scale.cluster import connected

        with connected(scheduler) as (client, _name):
            yield client
    elif count is not None:
        from hersey.scale.local import local_workers

        with local_workers(count) as processes:
            yield processes
    else:
        yield None
