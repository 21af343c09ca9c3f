"""What is kept of a grid that is worked out chunk by chunk: a folder that tells whose it is and what is done.

A chunk is written by whoever worked it out: its values first, then that it is finished. Every file takes its
place whole (`hersey.files.writing`), so a process that is killed leaves no half of one, and two that
write one chunk write the same bytes.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from math import prod
from pathlib import Path
from typing import Any, Protocol

from numpy.typing import NDArray

from hersey.arguments.frozen import explained
from hersey.errors import OVERWRITE, OutputError, Setting, way_in
from hersey.files.writing import SUFFIX, refuse_without_folder, unfinished, write_atomically
from hersey.scale.cutting import Cut
from hersey.schema.warning import Warning

#: What is written of a chunk, or of all: columns of one length by their names.
Columns = Mapping[str, NDArray[Any]]
#: The record of a chunk beside its values, as JSON takes it.
Note = dict[str, Any]
#: What decides the values, as JSON takes it; `refused` names what differs.
Scenario = dict[str, Any]
_NO_RESUME = Setting("resume", flag="--no-resume")


@dataclass(frozen=True)
class Variable:
    """A quantity over the grid: name, type and what is said of it; ``fill`` stands where there is none.

    Of one that counts kinds ``words`` are their names, where a format can hold them.
    """

    name: str
    dtype: str
    attributes: Mapping[str, Any]
    fill: float
    words: Sequence[str] = ()


@dataclass(frozen=True)
class Coordinate:
    """What stands along axes of the grid, or a single number."""

    axes: tuple[str, ...]
    values: NDArray[Any]
    attributes: Mapping[str, Any]


@dataclass(frozen=True)
class Layout:
    """The grid: axes and how it is cut, quantities over it, coordinates, and what is said of the whole."""

    axes: tuple[str, ...]
    cut: Cut
    variables: tuple[Variable, ...]
    coordinates: Mapping[str, Coordinate]
    attributes: Mapping[str, Any] = field(default_factory=dict)


class Folder(Protocol):
    """A folder of chunks of one kind; it travels to workers, so it holds little."""

    @property
    def path(self) -> Path:
        """Where it is."""

    @property
    def cut(self) -> Cut:
        """How its grid is cut."""

    @property
    def mended(self) -> tuple[Warning, ...]:
        """What was damaged beside the chunks and has been written again."""

    def note(self, number: int) -> Note | None:
        """Return the note of a chunk that is finished and whole; None of any other."""

    def finished(self) -> list[int]:
        """Return the numbers of the chunks that are marked as finished, whole or not, ascending."""

    def write(self, number: int, values: Columns, beside: Columns, note: Note) -> None:
        """Keep a chunk: values over it, flat; ``beside`` is what formats without axes need of the axes."""


class Kind(Protocol):
    """What makes and opens folders of one kind."""

    #: File of the folder that holds the manifest, and the one that is locked.
    manifest: str
    lock: str
    #: Number of the format, which stands in the manifest.
    format: int

    def create(self, path: Path, layout: Layout, manifest: Scenario) -> None:
        """Make an empty folder at a path where there is none."""

    def read_manifest(self, path: Path) -> Scenario | None:
        """Return the manifest; None where no folder of ours is."""

    def open(self, path: Path, cut: Cut, variables: tuple[Variable, ...]) -> Folder:
        """Return a folder that is there."""

    def mend(self, path: Path, layout: Layout, manifest: Scenario) -> tuple[Warning, ...]:
        """Write again what is damaged beside the chunks and the manifest; return a warning for each."""


def sha256_of(scenario: Scenario) -> str:
    """Return the hash of what decides the values."""
    return hashlib.sha256(json.dumps(scenario, sort_keys=True).encode()).hexdigest()


@explained
@dataclass(frozen=True)
class SweepFolder:
    """Folder of a sweep, and how to treat an existing one.

    Parameters
    ----------
    path
        Folder whose name ends in .zarr or .parquet.
    resume
        Whether finished parts of the same sweep are used and not computed again.
    overwrite
        Whether another sweep there is replaced; otherwise it is an error.
    """

    path: str | Path
    resume: bool = True
    overwrite: bool = False

    @classmethod
    def of(cls, given: str | Path | SweepFolder) -> SweepFolder:
        """Return the folder as given, or one for a path."""
        return given if isinstance(given, SweepFolder) else cls(given)

    @property
    def absolute(self) -> Path:
        """Absolute path."""
        return Path(self.path).absolute()


@contextmanager
def opened(
    out: SweepFolder,
    kind: Kind,
    scenario: Scenario,
    layout: Callable[[Cut], Layout],
    *,
    shape: tuple[int, ...],
    planned: Callable[[], Cut],
    asked: Cut | None = None,
) -> Iterator[Folder]:
    """Yield the folder: the one begun for the same scenario, or a new one; nobody else has it.

    ``layout`` is that of the grid of ``shape`` in a cut; a new one is cut as ``planned``. A folder that is
    cut otherwise than ``asked`` is refused, and so is one whose manifest is not, to the letter, what this
    sweep would write.

    Raises
    ------
    OutputError
        If the folder is of another scenario, holds something else, is at work elsewhere, or cannot be
        written; it says what differs.
    """
    path = out.absolute
    try:
        with _taken(kind, out, scenario) as begun:
            if begun is not None:
                _refuse_older(path, kind, begun)
            cut = planned() if begun is None else _cut_of(path, begun, shape)
            whole = layout(cut)
            manifest = _manifest(kind, scenario, whole)
            if begun is None:
                _create(kind, path, whole, manifest)
            elif manifest != {**begun, "about": None}:
                raise _damaged(path)
            with _locked(path / kind.lock, path):
                if asked is not None and asked != cut:
                    raise OutputError(
                        f"{path} has chunks of {prod(cut.chunk)} sets, not {prod(asked.chunk)}. Omit "
                        f"the chunk to continue, or start again with {_anew()}"
                    )
                mended = () if begun is None else kind.mend(path, whole, manifest)
                yield replace(kind.open(path, cut, whole.variables), mended=mended)  # type: ignore[type-var]
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{path} cannot be written: {error.strerror or error}") from None


def _refuse_older(path: Path, kind: Kind, manifest: Scenario) -> None:
    """Refuse to go on with chunks that cannot be checked."""
    found = manifest.get("format")
    if type(found) is int and 0 < found < kind.format:
        raise OutputError(
            f"{path} was written by an older version of hersey without checksums, so it cannot be "
            f"continued (xarray can read it). Name another folder, or start again with {_anew()}"
        )


def _manifest(kind: Kind, scenario: Scenario, layout: Layout) -> Scenario:
    """What stands in a folder of ours; ``about`` is for readers, and free."""
    return {
        "format": kind.format,
        "scenario": scenario,
        "scenario_sha256": sha256_of(scenario),
        "shape": list(layout.cut.shape),
        "chunk": list(layout.cut.chunk),
        "variables": [[each.name, each.dtype, _written(each.fill)] for each in layout.variables],
        "about": None,
    }


def _cut_of(path: Path, manifest: Scenario, shape: tuple[int, ...]) -> Cut:
    chunk = manifest.get("chunk")
    cut = Cut(shape, tuple(chunk) if isinstance(chunk, list) else ())
    if not cut.is_sound:
        raise _damaged(path)
    return cut


def _anew() -> str:
    """How a sweep starts anew in a folder that holds one."""
    joint = " " if way_in() == "terminal" else " and "
    return f"{_NO_RESUME.to(python='False')}{joint}{OVERWRITE.to()}"


def _damaged(path: Path) -> OutputError:
    return OutputError(
        f"{path}: its metadata are damaged, or from another version of hersey. Name another folder, or "
        f"start again with {_anew()}"
    )


def _written(fill: float) -> float | str:
    """A number as JSON holds it, which has none that is not a number."""
    return "NaN" if fill != fill else fill


@contextmanager
def _taken(kind: Kind, out: SweepFolder, scenario: Scenario) -> Iterator[Scenario | None]:
    """Yield the manifest of what was begun and shall go on, or None; what shall go is gone then."""
    path = out.absolute
    refuse_without_folder(path)
    if not path.exists() or (path.is_dir() and not any(path.iterdir())):
        yield None
        return
    if not path.is_dir():
        raise OutputError(f"{path} is a file, but chunks need a folder. Name another one")
    manifest = kind.read_manifest(path)
    if manifest is None:
        raise OutputError(f"{path} exists and was not made by a hersey sweep. Name another folder")
    if out.resume:
        refuse_another(path, manifest, scenario)
        yield manifest
        return
    if not out.overwrite:
        raise OutputError(
            f"{path} exists: use {OVERWRITE.to()} to replace it, or omit "
            f"{_NO_RESUME.to(python='False')} to continue it"
        )
    with _locked(path / kind.lock, path):
        gone = unfinished(path)
        path.rename(gone)
    shutil.rmtree(gone, ignore_errors=True)
    yield None


def _create(kind: Kind, path: Path, layout: Layout, manifest: Scenario) -> None:
    """Make the folder beside, and give it its name when it is whole."""
    part = unfinished(path)
    try:
        kind.create(part, layout, manifest)
        (part / kind.lock).touch()
        with suppress(OSError):  # there is none, or it holds something, which renaming refuses
            path.rmdir()
        part.rename(path)
    finally:
        shutil.rmtree(part, ignore_errors=True)


@contextmanager
def _locked(lock: Path, path: Path) -> Iterator[None]:
    """Hold a file that only one process holds; the system gives it back when that ends, however it ends."""
    try:
        import fcntl
    except ImportError:  # not on this system: two at work write the same bytes
        yield
        return
    with lock.open("ab") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise OutputError(
                f"{path} is in use by another process. Wait until it has finished, or name another folder"
            ) from None
        except OSError:  # a file system without locks: two at work write the same bytes
            pass
        yield


def refuse_another(path: Path, manifest: Scenario, scenario: Scenario) -> None:
    """Refuse the folder of another scenario, in words that say what differs.

    Raises
    ------
    OutputError
        If any part of the scenario differs.
    """
    there = manifest.get("scenario")
    if there == scenario:
        return
    try:
        differs = difference(there or {}, scenario)
    except (AttributeError, KeyError, TypeError, ValueError):
        raise _damaged(path) from None
    raise OutputError(
        f"{path} belongs to another scenario: {differs}. Name another folder, or start again with {_anew()}"
    )


def difference(there: Scenario, here: Scenario) -> str:
    """Return in words the first thing that differs."""
    mine, theirs = here.get("parameters", {}), there.get("parameters", {})
    for name in [key for key in (*here, *there) if key != "parameters"]:
        if there.get(name) != here.get(name):
            return f"{name.replace('_', ' ')} is {there.get(name)} there, but {here.get(name)} here"
    for name in (*mine, *theirs):
        one, other = theirs.get(name), mine.get(name)
        if one == other:
            continue
        if one is None or other is None:
            return f"{name} is varied only {'here' if one is None else 'there'}"
        if one["values"] != other["values"]:
            return f"{name} has {_values(one)} there, but {_values(other)} here"
        if (one["first"], one["last"]) != (other["first"], other["last"]):
            return f"{name} is {_range(one)} there, but {_range(other)} here"
        return f"{name} has other values there"
    return "the parameters have another order"


def _values(parameter: Mapping[str, Any]) -> str:
    return f"{parameter['values']} value{'' if parameter['values'] == 1 else 's'}"


def _range(parameter: Mapping[str, Any]) -> str:
    first, last = parameter["first"], parameter["last"]
    return f"{first:.9g}" if first == last else f"{first:.9g} to {last:.9g}"


def write_file(path: Path, content: bytes) -> None:
    """Write a file of a folder whole, with the folders above it; another's of the same name is replaced.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None
    write_atomically(path, content, overwrite=True)


def remove_unfinished_of(path: Path) -> None:
    """Remove what processes that were killed left half-written, once all is finished."""
    for part in path.rglob(f".*{SUFFIX}"):
        with suppress(OSError):
            part.unlink()


def refuse_unseen(path: Path, kind: Kind, sha256: str) -> None:
    """Refuse a machine that does not see the folder.

    Raises
    ------
    OutputError
        If there is no folder of this scenario.
    """
    manifest = kind.read_manifest(path)
    if manifest is None or manifest.get("scenario_sha256") != sha256:
        import socket

        raise OutputError(
            f"{path} is not visible on {socket.gethostname()}, where workers write. Name a folder that "
            "all machines share"
        )
