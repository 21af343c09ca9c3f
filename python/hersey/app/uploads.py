"""Dropped files, written to disk as they arrive, within bounds; their names are never used as paths."""

from __future__ import annotations

import re
import shutil
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import printable

#: Characters of a name at the most.
_LONGEST_NAME = 120
#: What a name holds of a path, and what no system takes in one.
_NO_NAME = re.compile(r'[\\/:*?"<>|\x00-\x1f]')


@dataclass(frozen=True)
class Bounds:
    """Limits of one start: bytes of a file and of all files, files, analyses, bytes of a request."""

    file: int = 2_000_000_000
    all_files: int = 8_000_000_000
    files: int = 40
    analyses: int = 40
    request: int = 1_000_000


class TooMuchError(Exception):
    """More than the bounds allow; the message is for the user."""


def clean_name(name: str) -> str:
    r"""Return what a file is called in a folder of its own: the last part of a path, without what leads out.

    Examples
    --------
    >>> clean_name("../../etc/passwd"), clean_name("C:\\logs\\drive 3.csv"), clean_name("..")
    ('passwd', 'drive 3.csv', 'log')
    """
    last = re.split(r"[\\/]", name)[-1]
    plain = _NO_NAME.sub("_", printable(last)).lstrip(".").strip()
    if len(plain) > _LONGEST_NAME:
        stem, dot, ending = plain.rpartition(".")
        keeps = dot + ending if dot and len(ending) < 10 else ""
        plain = (stem if keeps else plain)[: _LONGEST_NAME - len(keeps)] + keeps
    return plain if plain and plain not in (".", "..") else "log"


def megabytes(size: int) -> str:
    """Return a number of bytes as readers write it."""
    return f"{size / 1e9:.3g} GB" if size >= 1e9 else f"{size / 1e6:.3g} MB"


async def receive(
    chunks: AsyncIterator[bytes], path: Path, most: int, received: Callable[[int], None]
) -> int:
    """Write what comes to a file, and return its bytes; what is too long leaves nothing.

    Raises
    ------
    TooMuchError
        If more than ``most`` bytes come, or the disk has no room.
    """
    size = 0
    try:
        with path.open("xb") as file:
            async for chunk in chunks:
                size += len(chunk)
                if size > most:
                    raise TooMuchError(f"the file is larger than the {megabytes(most)} that the app takes")
                file.write(chunk)
                received(size)
    except OSError as error:
        path.unlink(missing_ok=True)
        free = megabytes(shutil.disk_usage(path.parent).free)
        raise TooMuchError(f"the file cannot be stored: {error.strerror} ({free} free on the disk)") from None
    except BaseException:
        path.unlink(missing_ok=True)
        raise
    return size
