"""Arrays: as arguments, the axes they span, the core called over them, threads, corners of a curve."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from contextvars import copy_context
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey.errors import MissingFileError, ParameterError, meant, printable

R = TypeVar("R")
T = TypeVar("T")
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]
BoolArray = NDArray[np.bool_]


def refuse_without_xarray(what: str) -> None:
    """Refuse what needs xarray where it is not installed; ``what`` begins the sentence.

    Raises
    ------
    MissingFileError
        Naming the line that installs it.
    """
    try:
        import xarray  # noqa: F401
    except ImportError:
        raise MissingFileError(
            f"{what} needs xarray, which is not installed: pip install 'hersey[sweep]'"
        ) from None


class _OneThread:
    """The limit of one thread as all that are inside share it: the library knows only one for the process."""

    def __init__(self) -> None:
        self.lock, self.inside = threading.Lock(), 0
        self.limit: Any = None

    def enter(self) -> None:
        """Set the limit for the first that comes."""
        from threadpoolctl import threadpool_limits

        with self.lock:
            if not self.inside:
                self.limit = threadpool_limits(1, user_api="blas")
            self.inside += 1

    def leave(self) -> None:
        """Give the library its own number back after the last."""
        with self.lock:
            self.inside -= 1
            if not self.inside:
                self.limit.restore_original_limits()


_one_thread = _OneThread()
if hasattr(os, "register_at_fork"):  # a thread that holds the lock is not in the child

    def _unlocked() -> None:
        _one_thread.lock = threading.Lock()

    os.register_at_fork(after_in_child=_unlocked)


@contextmanager
def one_thread() -> Iterator[None]:
    """Let the linear algebra inside use one thread, as a context or a decorator.

    Many small matrices are quicker so (ten times where the machine is busy), and the bits of a result do not
    hang on the number of processors. Threads of ours that overlap keep it until the last is out.
    """
    _one_thread.enter()
    try:
        yield
    finally:
        _one_thread.leave()


def side_by_side(function: Callable[[T], R], items: Sequence[T]) -> Iterator[R]:
    """Yield a function of each item, in their order, with as many threads as there are processors.

    It pays where arrays are large: NumPy computes them beside each other. An item must not need another's
    result; then the number of threads changes no bit.
    """
    processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    threads = min(processors, len(items))
    contexts = [copy_context() for _ in items]
    with ThreadPoolExecutor(max(threads, 1)) as pool:
        found: Iterator[R] = map(function, items)
        if threads > 1:
            with suppress(RuntimeError):  # memory is too short for a thread
                found = pool.map(lambda context, each: context.run(function, each), contexts, items)
        yield from found


def numbers_of(name: str, value: ArrayLike) -> FloatArray:
    """Return a parameter as an array of numbers; refuse anything else by its name."""
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(f"{name} is not a number or an array of numbers") from None
    if numbers.size == 0:
        raise ParameterError(f"{name} is empty")
    return numbers


def refuse_unknown(
    taker: str, given: Iterable[str], known: Sequence[str], elsewhere: Mapping[str, str] | None = None
) -> None:
    """Refuse a keyword that is none of those known; the message names the nearest, or all of them.

    ``elsewhere`` says what to write for one that belongs into another argument.

    Examples
    --------
    >>> refuse_unknown("sweep", ["stifness"], ["stiffness", "mass"])
    Traceback (most recent call last):
        ...
    hersey.errors.ParameterError: sweep has no argument 'stifness'. Did you mean stiffness?
    """
    for name in given:
        if name not in known:
            parts = [each for each in known if name in each.split("_")]
            near = f"{', '.join(parts[:-1])} or {parts[-1]}" if parts[1:] else meant(name, known)
            remedy = f"Did you mean {near}?" if near else f"Its arguments are {', '.join(known)}"
            if elsewhere and name in elsewhere:
                remedy = f"Write {elsewhere[name]}"
            raise ParameterError(f"{taker} has no argument '{printable(name)}'. {remedy}", quantity=name)


def crossed(given: dict[str, FloatArray]) -> tuple[list[str], dict[str, FloatArray]]:
    """One axis per array, in the order of the core."""
    for name, numbers in given.items():
        if numbers.ndim > 1:
            raise ParameterError(
                f"{name} has {numbers.ndim} dimensions. To take arrays element by element, use zip=True"
            )
    axes = [name for name, numbers in given.items() if numbers.ndim]
    grids = np.meshgrid(*(np.atleast_1d(given[name]) for name in given), indexing="ij")
    shape = [given[name].size for name in axes]
    return axes, {name: grid.reshape(shape) for name, grid in zip(given, grids, strict=True)}


def together(given: dict[str, FloatArray]) -> tuple[list[str], dict[str, FloatArray]]:
    """NumPy's rules of broadcasting."""
    try:
        arrays = np.broadcast_arrays(*given.values())
    except ValueError:
        shapes = ", ".join(f"{name} {numbers.shape}" for name, numbers in given.items() if numbers.ndim)
        raise ParameterError(f"the shapes of the arrays do not match: {shapes}") from None
    dimensions = arrays[0].ndim
    axes = ["set"] if dimensions == 1 else [f"dim_{i}" for i in range(dimensions)]
    return axes[:dimensions], dict(zip(given, arrays, strict=True))


def pointwise(function: Callable[[Sequence[FloatArray]], R], *given: ArrayLike) -> R:
    """Return what a core function makes of arrays, each spread to the shape that the arguments span together.

    Raises
    ------
    ParameterError
        With the core's words, which name the quantity.
    """
    return function(np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in given)))


def corners(x: FloatArray, y: FloatArray, off: float, keep: tuple[int, ...] = ()) -> IntArray:
    """Return the points that straight lines need to follow all of them within ``off`` of y.

    D. H. Douglas and T. K. Peucker, Cartographica 10 (1973) 112. Both ends, and the points ``keep``, are
    among them.
    """
    kept, spans = {0, x.size - 1, *keep}, [(0, x.size - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        line = y[first] + (y[last] - y[first]) * (x[first:last] - x[first]) / (x[last] - x[first])
        missed = np.abs(y[first:last] - line)
        if missed.max() > off:
            middle = first + int(np.argmax(missed))
            kept.add(middle)
            spans += [(first, middle), (middle, last)]
    return np.array(sorted(kept), dtype=np.intp)
