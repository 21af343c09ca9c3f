"""Who works at a benchmark: this process, processes of this machine, or a cluster. In their order."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib import import_module
from typing import TypeVar

from hersey.cli.workers import workers
from hersey.scale.tasks import done, in_order

Item = TypeVar("Item")
R = TypeVar("R")

#: Threads that libraries may start in each process: the processes are the parallel part.
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "POLARS_MAX_THREADS", "RAYON_NUM_THREADS")


def takes_workers(parser: ArgumentParser) -> None:
    """Give a benchmark the options that say who works."""
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine; 1 is this one")
    parser.add_argument("--scheduler", help="instead: address of a scheduler of Dask, as tcp://host:8786")


def worked(task: Callable[[Item], R], items: Sequence[Item], given: Namespace) -> Iterator[R]:
    """Yield what a task makes of each item, in their order, by those that the options name.

    Workers of a scheduler must find ``benchmarks`` as this process does: in the folder where they start.
    """
    for variable in _THREADS:
        os.environ.setdefault(variable, "1")
    here = given.scheduler is None and given.workers == 1
    with workers(given.scheduler, None if here or given.scheduler else given.workers) as client:
        yield from in_order(done(task if here else _by_name(task), items, client=client))


def _by_name(task: Callable[[Item], R]) -> Callable[[Item], R]:
    """Return a task of the module that runs as that of the module by its name, which workers can load."""
    if isinstance(task, partial):
        return partial(_by_name(task.func), *task.args, **task.keywords)
    spec = sys.modules["__main__"].__spec__
    if task.__module__ != "__main__" or spec is None:
        return task
    found: Callable[[Item], R] = getattr(import_module(spec.name), task.__name__)
    return found
