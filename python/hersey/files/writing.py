"""Writing a file whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from hersey.errors import OutputError

#: End of the name of a file that is not whole yet.
SUFFIX = ".part"
#: Bytes of the name that it shall get in its own, which has a few more.
_NAME_BYTES = 200
#: Files that are not whole yet.
_unfinished: set[Path] = set()


def write_atomically(path: Path, content: str | bytes, *, overwrite: bool) -> None:
    """Write a file whole or not at all; never over an existing one unless told to.

    Raises
    ------
    OutputError
        If the file exists and ``overwrite`` is false, or it cannot be written.
    """
    with written(path, overwrite=overwrite) as file:
        file.write(content.encode("utf-8") if isinstance(content, str) else content)


def write_all(contents: Mapping[Path, bytes], *, overwrite: bool) -> None:
    """Write files of which none takes its place before all are there; as `write_atomically` for each."""
    with ExitStack() as stack:
        for path, content in contents.items():
            stack.enter_context(written(path, overwrite=overwrite)).write(content)


@contextmanager
def written(path: Path, *, overwrite: bool) -> Iterator[BinaryIO]:
    """Yield a new file that takes the place of ``path`` at the end, or goes if anything fails meanwhile.

    What a process that was killed leaves beside the path is never opened again.

    Raises
    ------
    OutputError
        If the file exists and ``overwrite`` is false, or it cannot be written.
    """
    if path.is_dir():
        raise OutputError(f"{path} is a directory: name a file in it")
    if path.exists() and not overwrite:
        raise OutputError(f"{path} exists: say --force to replace it, or name another file with --out")
    part = _part(path)
    _unfinished.add(part)  # before it is there, so that no moment is without it
    try:
        with part.open("xb") as file:
            yield file
        part.replace(path)
    except OutputError:  # of another file that is written meanwhile
        raise
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        _unfinished.discard(part)


def remove_unfinished() -> None:
    """Remove every file that is not whole: for a process that ends at once."""
    for part in list(_unfinished):
        with suppress(OSError):
            part.unlink(missing_ok=True)


def _part(path: Path) -> Path:
    """A new name beside a path; one has 255 bytes at the most, so the last of a long one are left out."""
    name = os.fsencode(path.name)[:_NAME_BYTES].decode(errors="ignore")
    return path.with_name(f".{name}.{secrets.token_hex(8)}{SUFFIX}")
