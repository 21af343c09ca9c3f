"""Writing a file whole or not at all, and never over one that nobody said to replace.

Where nothing may be replaced, the new file gets its name by a link, which fails if the name is taken. Of two
processes that write the same name exactly one succeeds.
"""

from __future__ import annotations

import os
import secrets
import shlex
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from hersey.errors import OVERWRITE, ExistingFileError, OutputError, way_in

#: End of the name of a file that is not whole yet.
SUFFIX = ".part"
#: Bytes of the name that it shall get in its own, which has a few more.
_NAME_BYTES = 200
#: Files that are not whole yet.
_unfinished: set[Path] = set()


def refuse_without_folder(path: Path) -> None:
    """Refuse a file, or a folder, that would be in a folder that does not exist.

    Raises
    ------
    OutputError
        It says how to make the folder.
    """
    folder = path.parent
    if folder.is_dir():
        return
    make = f"mkdir -p {shlex.quote(str(folder))}" if way_in() == "terminal" else "Path.mkdir(parents=True)"
    raise OutputError(f"{path}: there is no directory {folder}", remedy=f"make it first: {make}")


def write_atomically(path: Path, content: str | bytes, *, overwrite: bool) -> None:
    """Write a file whole or not at all; never over an existing one unless told to.

    Raises
    ------
    ExistingFileError
        If the file exists and ``overwrite`` is false, even where it appears during the write.
    OutputError
        If it cannot be written.
    """
    with written(path, overwrite=overwrite) as file:
        file.write(content.encode("utf-8") if isinstance(content, str) else content)


def write_all(contents: Mapping[Path, bytes], *, overwrite: bool | Mapping[Path, bool]) -> None:
    """Write files of which none takes its place before all are written; as `write_atomically` for each.

    ``overwrite`` is for all, or by path. If a name turns out to be taken, nothing is replaced and no new file
    stays. A process that is killed in the last steps may leave some new and some old, each whole.
    """
    replace = dict.fromkeys(contents, overwrite) if isinstance(overwrite, bool) else overwrite
    with ExitStack() as stack:
        parts = {path: stack.enter_context(_part_of(path, replace[path])) for path in contents}
        for path, content in contents.items():
            with _named(path):
                parts[path].write_bytes(content)
        placed: list[Path] = []
        try:
            for path in sorted(parts, key=lambda path: replace[path]):  # new ones first: they alone may fail
                with _named(path):
                    _place(parts[path], path, replace[path])
                placed.append(path)
        except ExistingFileError:
            for path in placed:  # each of them new
                path.unlink(missing_ok=True)
            raise


@contextmanager
def written(path: Path, *, overwrite: bool) -> Iterator[BinaryIO]:
    """Yield a new file that takes the place of ``path`` at the end, or goes if anything fails meanwhile.

    What a process that was killed leaves beside the path is never opened again.

    Raises
    ------
    ExistingFileError
        If the file exists and ``overwrite`` is false, at the beginning or at the end.
    OutputError
        If it cannot be written.
    """
    with _part_of(path, overwrite) as part, _named(path):
        with part.open("xb") as file:
            yield file
        _place(part, path, overwrite)


@contextmanager
def _part_of(path: Path, overwrite: bool) -> Iterator[Path]:
    """Yield the name of what will replace a file; at the end nothing of that name is there."""
    if path.is_dir():
        raise OutputError(f"{path} is a folder. Name a file in it")
    if path.exists() and not overwrite:
        raise _exists(path)
    part = unfinished(path)
    _unfinished.add(part)  # before it is there, so that no moment is without it
    try:
        yield part
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        _unfinished.discard(part)


def _place(part: Path, path: Path, overwrite: bool) -> None:
    """Give a whole file its name: over another one, or only if the name is free."""
    if overwrite:
        part.replace(path)
        return
    try:
        try:
            os.link(part, path)
        except FileExistsError:
            raise
        except OSError:  # a file system without links, such as FAT: take the name first, empty
            path.open("xb").close()
            part.replace(path)
    except FileExistsError:
        raise _exists(path) from None


def _exists(path: Path) -> ExistingFileError:
    return ExistingFileError(f"{path} exists: use {OVERWRITE.to()} to replace it, or name another file")


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Name the file in what goes wrong."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None


def remove_unfinished() -> None:
    """Remove every file that is not whole: for a process that ends at once."""
    for part in list(_unfinished):
        with suppress(OSError):
            part.unlink(missing_ok=True)


def unfinished(path: Path) -> Path:
    """Return a new name beside a path; of a long one the last are left out, for it has 255 bytes at most."""
    name = os.fsencode(path.name)[:_NAME_BYTES].decode(errors="ignore")
    return path.with_name(f".{name}.{secrets.token_hex(8)}{SUFFIX}")
