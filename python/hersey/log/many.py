"""Many logs, each by itself: read in turn, in threads, or by the workers of a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from hersey.arrays import one_thread
from hersey.errors import HerseyError, ParameterError, UnfinishedError
from hersey.files.patterns import files_of
from hersey.log.reading import read
from hersey.scale.tasks import done, in_order

if TYPE_CHECKING:
    from distributed import Client

    from hersey.log.torque_log import TorqueLog
    from hersey.scale.local import LocalWorkers

Item = TypeVar("Item")
R = TypeVar("R")


@dataclass(frozen=True, repr=False)
class ManyLogs(Mapping[Path, R], Generic[R]):
    """What came of many files, by path in their order; ``failures`` says by path why others gave nothing."""

    found: Mapping[Path, R]
    failures: Mapping[Path, HerseyError]

    def __getitem__(self, path: Path | str) -> R:
        """Return what came of a file."""
        return self.found[Path(path)]

    def __iter__(self) -> Iterator[Path]:
        """Yield the paths."""
        return iter(self.found)

    def __len__(self) -> int:
        """Return of how many something came."""
        return len(self.found)

    def summary(self) -> str:
        """Return the count, and a line for each file that was left out."""
        total = len(self.found) + len(self.failures)
        head = f"{len(self.found)} of {total} logs"
        return "\n".join([head, *(f"- {failure_line(path, error)}" for path, error in self.failures.items())])

    def __repr__(self) -> str:
        """Return the counts on one line."""
        return f"<ManyLogs: {len(self.found)} logs, {len(self.failures)} left out>"


def read_many(
    paths: str | Path | Iterable[str | Path],
    *,
    then: Callable[[TorqueLog], Any] | None = None,
    client: Client | LocalWorkers | str | None = None,
    threads: int = 1,
    keep_going: bool = False,
    progress: Callable[[int, int], object] | None = None,
    **reading: Any,
) -> ManyLogs[Any]:
    """Read each file as a log of its own, and keep what ``then`` makes of it.

    The result is the same, bit for bit, whoever works and whichever file is read first.

    Parameters
    ----------
    paths
        Files and patterns (``logs/*.csv``), which are sorted.
    then
        What is made of each log where it is read, so that memory holds no more logs than are read at once,
        for example ``lambda log: log.steady(tare="standing").table``; without it the logs are kept. Steady
        points hold their log, tables and fits do not.
    client
        A ``distributed.Client``, or the address of a scheduler: its workers read, a file a task, and must see
        the files by the same paths.
    threads
        Threads that read without a client. Reading and reducing compute mostly in Python, of which one thread
        runs at a time: workers are quicker.
    keep_going
        Leave out files that cannot be read, and those of which ``then`` raises a `HerseyError`; they are told
        in ``failures``. Otherwise the first in the order of the files is raised.
    progress
        Called with files done and files in all.
    **reading
        As `read` takes it, for every file alike.

    Raises
    ------
    HerseyError
        If a pattern matches no file, a file is named twice, or as `read`.

    Examples
    --------
    >>> import hersey
    >>> dwells = hersey.read_many("examples/ben*.csv", then=lambda log: log.steady(tare="standing").table)
    >>> [(path.name, table.height > 20) for path, table in dwells.items()]
    [('bench.csv', True)]
    """
    files = files_of(paths)
    if not files:
        raise ParameterError("no log file was named")
    task = partial(_one, then, reading)
    results = each_of(task, files, client=client, threads=threads, progress=progress)
    return collected(files, results, keep_going)


def each_of(
    task: Callable[[Item], R],
    items: Sequence[Item],
    *,
    called: Callable[[Item], object] = str,
    client: Client | LocalWorkers | str | None = None,
    threads: int = 1,
    progress: Callable[[int, int], object] | None = None,
) -> Iterator[R]:
    """Yield what a task makes of each item, in their order; errors as `done`, of which one names the item.

    That is an item that ends one worker after the other; ``called`` is how the user knows it.
    """
    try:
        yield from in_order(done(task, items, client=client, threads=threads, progress=progress))
    except UnfinishedError as error:
        if error.index is None:
            raise
        raise error.within(str(called(items[error.index]))) from None


def collected(files: Iterable[Path], results: Iterable[R | HerseyError], keep_going: bool) -> ManyLogs[R]:
    """Return results with those that failed apart; unless ``keep_going`` the first of these is raised."""
    found: dict[Path, R] = {}
    failures: dict[Path, HerseyError] = {}
    for path, result in zip(files, results, strict=True):
        if not isinstance(result, HerseyError):
            found[path] = result
        elif keep_going:
            failures[path] = result
        else:
            raise result
    return ManyLogs(found, failures)


def failure_line(path: Path, error: HerseyError) -> str:
    """Return why a file gave nothing, in a line that begins with its path."""
    text = str(error)
    for name in (str(path), path.name):
        text = text.removeprefix(f"{name}: ")
    return f"{path}: {text}"


def _one(then: Callable[[TorqueLog], Any] | None, reading: Mapping[str, Any], path: Path) -> Any:
    """Read one file where this runs; what is wrong with it is a result like another."""
    try:
        with one_thread():
            log = read(path, **reading)
            return log if then is None else then(log)
    except HerseyError as error:
        return error if path.name in str(error) else error.within(str(path))
