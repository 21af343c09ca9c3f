"""Who works: threads of this process, processes on this machine, or the workers of a scheduler."""

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

    #: Who works; None is this process alone.
    AtWork = Client | LocalWorkers | None

_SCHEDULER = "Let the workers of this scheduler of Dask work, as tcp://host:8786."
_WORKERS = "Use N worker processes on this machine."


@dataclass(frozen=True)
class Crew:
    """Who works, if not this process alone."""

    scheduler: Annotated[str | None, option(_SCHEDULER, metavar="ADDRESS")] = None
    count: Annotated[int | None, option(_WORKERS, "--workers", metavar="N", min=1)] = None

    @property
    def asked(self) -> bool:
        """Whether anybody is asked."""
        return self.scheduler is not None or self.count is not None

    def at_work(self) -> AbstractContextManager[AtWork]:
        """Yield as `workers` does."""
        return workers(self.scheduler, self.count)


@contextmanager
def workers(scheduler: str | None, count: int | None) -> Iterator[AtWork]:
    """Yield the client of a scheduler, or so many processes on this machine; None where neither is asked.

    Raises
    ------
    ParameterError
        If both are asked for, or nothing answers at the address.
    MissingFileError
        If a scheduler is given and Dask is not installed.
    """
    if scheduler is not None and count is not None:
        raise ParameterError("--scheduler and --workers both say who works: give one")
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
