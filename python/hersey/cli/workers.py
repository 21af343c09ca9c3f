"""Who works: threads of this process, processes on this machine, or the workers of a scheduler."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.errors import ParameterError

if TYPE_CHECKING:
    from distributed import Client

    from hersey.scale.local import LocalWorkers

Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="ADDRESS",
        help="Let the workers of this scheduler of Dask work, as tcp://host:8786.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option("--workers", metavar="N", help="Use N worker processes on this machine.", min=1),
]


@contextmanager
def workers(scheduler: str | None, count: int | None) -> Iterator[Client | LocalWorkers | None]:
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
