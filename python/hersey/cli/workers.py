"""Who works: threads of this process, processes on this machine, or the workers of a scheduler."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.errors import ParameterError

if TYPE_CHECKING:
    from distributed import Client

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
    typer.Option(
        "--workers", metavar="N", help="Let so many processes on this machine work, by Dask.", min=1
    ),
]


@contextmanager
def workers(scheduler: str | None, count: int | None) -> Iterator[Client | None]:
    """Yield the client of a scheduler, or of so many processes on this machine; None where neither is asked.

    Raises
    ------
    ParameterError
        If both are asked for, or nothing answers at the address.
    MissingFileError
        If Dask is not installed.
    """
    if scheduler is not None and count is not None:
        raise ParameterError("--scheduler and --workers both say who works: give one")
    if scheduler is not None:
        from hersey.scale.cluster import connected

        with connected(scheduler) as (client, _name):
            yield client
    elif count is not None:
        from hersey.scale.cluster import local_cluster

        with local_cluster(count) as client:
            yield client
    else:
        yield None
