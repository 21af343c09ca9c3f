"""Many logs, each by itself: read in turn, in threads, or by the workers of a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from hersey.arguments.frozen import explained
from hersey.arrays import one_thread
from hersey.errors import HerseyError, MissingFileError, ParameterError, UnfinishedError, followed_by
from hersey.files.patterns import files_of
from hersey.log.reading import read
from hersey.scale.tasks import done, in_order
from hersey.units import takes_si

if TYPE_CHECKING:
    from distributed import Client

    from hersey.log.torque_log import TorqueLog
    from hersey.scale.local import LocalWorkers

Item = TypeVar("Item")
R = TypeVar("R")


@explained
@dataclass(frozen=True, repr=False)
class ManyLogs(Mapping[Path, R], Generic[R]):
    """Results of many files, by path and in order; ``failures`` holds the error of each file that failed."""

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
        """Return the count, and a line for each file that was skipped."""
        total = len(self.found) + len(self.failures)
        head = f"read {len(self.found)} of {total} logs"
        return "\n".join([head, *(f"- {failure_line(path, error)}" for path, error in self.failures.items())])

    def __repr__(self) -> str:
        """Return the counts on one line."""
        return f"<ManyLogs: {len(self.found)} logs, {len(self.failures)} skipped>"


@takes_si()
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
    """Read each file as a separate log and keep the result of ``then``.

    The result is identical whatever workers are used and whichever file is read first.

    Parameters
    ----------
    paths
        Files and patterns (``logs/*.csv``), which are sorted.
    then
        Function of each log, called where it is read so that few logs are in memory at once, e.g. ``lambda
        log: log.steady(tare="standing").table``. Default: the logs are kept. Steady points keep their log in
        memory; tables and fits do not.
    client
        A ``distributed.Client``, or the address of a scheduler. Its workers read one file per task and must
        see the files at the same paths.
    threads
        Number of threads without a client. Most of the work runs in Python, one thread at a time, so workers
        are faster.
    keep_going
        Whether to skip files that cannot be read, or for which ``then`` raises a `HerseyError`, and list them
        in ``failures``. Otherwise the first error in file order is raised.
    progress
        Called with files done and total files.
    **reading
        Arguments of `read`, for every file.

    Raises
    ------
    HerseyError
        If a pattern matches no file, a file is given twice, or as `read`.

    Examples
    --------
    >>> import hersey
    >>> dwells = hersey.read_many("examples/ben*.csv", then=lambda log: log.steady(tare="standing").table)
    >>> [(path.name, table.height > 20) for path, table in dwells.items()]
    [('bench.csv', True)]
    """
    files = files_of(paths)
    if not files:
        raise ParameterError("no log file is given")
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
    if isinstance(error, MissingFileError) and error.path == str(path):
        return f"{path}: {followed_by('File not found', error.remedy)}"
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
