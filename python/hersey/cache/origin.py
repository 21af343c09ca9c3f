"""What every result depends on besides its arguments: this program, its libraries and the processor."""

from __future__ import annotations

import hashlib
import os
import platform
import sys
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]


@cache
def origin() -> str:
    """Return a hash that differs as soon as a file of the package was written to.

    A version number does not tell a checkout from the one before an edit. Names, sizes and times do, in a
    hundredth of the time that a fit takes: no tool can set the time of the last change of a file.

    Raises
    ------
    OSError
        If the package is not a folder.
    """
    parts = [sys.version, platform.machine(), *_libraries(), *_processor(), *_files(_PACKAGE)]
    return hashlib.sha256("\0".join(parts).encode(errors="surrogateescape")).hexdigest()


def _files(folder: str | Path) -> Iterator[str]:
    """Path, size and times of every file of a package."""
    with os.scandir(folder) as entries:
        inside = sorted(entries, key=lambda each: each.name)
    for each in inside:
        if each.is_dir():
            if each.name != "__pycache__":
                yield from _files(each.path)
        else:
            at = each.stat()
            yield f"{each.path} {at.st_size} {at.st_mtime_ns} {at.st_ctime_ns}"


def _libraries() -> Iterator[str]:
    """Every installed distribution with its version."""
    for folder in filter(os.path.isdir, sys.path):
        yield from sorted(name for name in os.listdir(folder) if name.endswith(".dist-info"))  # noqa: PTH208


def _processor() -> list[str]:
    """What the processor can do: linear algebra rounds by it, and several machines may share a folder."""
    features: dict[str, bool] = import_module("numpy._core._multiarray_umath").__cpu_features__
    return sorted(name for name, has in features.items() if has)
