"""The entries of a folder: each is whole and of this key or counts as absent, and all together are bounded.

An entry is one file: the hash of all that follows, the length of the JSON, the JSON, the arrays. Nothing in
it is run. It is written under another name first, so that several processes can write and read at once.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
import shutil
import time
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from hersey.cache.encoding import Decoder, UnstorableError, is_kept
from hersey.errors import OutputError
from hersey.files.writing import SUFFIX, written

#: Bytes of all entries together, and of one of them, at the most.
LIMIT = 500_000_000
_LARGEST = LIMIT // 3
#: Entries at the most.
_MOST = 5000
#: Bytes that are written before the folder is looked through again.
_UNSEEN = LIMIT // 10
#: Share of the free space that an entry may take.
_OF_FREE = 0.1
#: Age at which an entry that is not whole belongs to no process any more, s.
_ABANDONED = 3600.0
#: Bytes of the hash with its end of line, and of the length.
_HASH, _LENGTH = 65, 12
#: Arrays begin at multiples of this.
_STEP = 64
_NAME = re.compile(r"[0-9a-f]{64}\.kept")
_PART = re.compile(rf"\.[0-9a-f]{{64}}\.kept\.[0-9a-f]+{re.escape(SUFFIX)}")

Array = np.ndarray[Any, Any]


class Entries:
    """The entries of one folder. What cannot be read is absent; what cannot be written is not kept."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._unseen = _UNSEEN  # the first entry that is written looks the folder through

    def read(self, key: str, known: list[Any]) -> tuple[Any] | None:
        """Return the value of a key, alone in a tuple, or None; ``known`` are the objects of its key."""
        path = self._path(key)
        try:
            content = _content(path)
            header, arrays = _opened(content, key)
            value = Decoder([*known], arrays).decoded(header["value"])
        except FileNotFoundError:
            return None
        except Exception:  # whatever stands there was not written by this version, or not wholly
            with suppress(OSError):
                path.unlink()
            return None
        with suppress(OSError):
            os.utime(path)  # used just now
        return (value,)

    def write(self, key: str, value: Any, arrays: list[Array]) -> None:
        """Keep a value as an `Encoder` wrote it, if there is a place for it."""
        text = json.dumps({"key": key, "value": value}, separators=(",", ":")).encode()
        size = _HASH + _LENGTH + len(text) + sum(each.nbytes + _STEP for each in arrays)
        with suppress(OSError, OutputError):
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if size > min(_LARGEST, _OF_FREE * shutil.disk_usage(self._folder).free):
                return
            digest = hashlib.sha256()
            for piece in _pieces(text, arrays):
                digest.update(piece)
            with written(self._path(key), overwrite=True) as file:
                file.write(digest.hexdigest().encode() + b"\n")
                file.writelines(_pieces(text, arrays))
            self._unseen += size
            if self._unseen > _UNSEEN:
                self._unseen = 0
                self._bound()

    def _path(self, key: str) -> Path:
        return self._folder / f"{key}.kept"

    def _bound(self) -> None:
        """Delete the entries that were not used for longest, and what processes left that were killed."""
        found = []
        for each in os.scandir(self._folder):
            with suppress(OSError):  # another process deletes, too
                at = each.stat(follow_symlinks=False)
                if _NAME.fullmatch(each.name):
                    found.append((at.st_mtime, at.st_size, each.path))
                elif _PART.fullmatch(each.name) and time.time() - at.st_mtime > _ABANDONED:
                    os.unlink(each.path)  # noqa: PTH108
        size = 0
        for number, (_, bytes_, path) in enumerate(sorted(found, reverse=True)):
            size += bytes_
            if size > LIMIT or number >= _MOST:
                with suppress(OSError):
                    os.unlink(path)  # noqa: PTH108


@cache
def entries_of(folder: Path) -> Entries:
    """Return the entries of a folder, the same for all who ask."""
    return Entries(folder)


def _content(path: Path) -> Array:
    """The bytes of an entry, which may be written to: arrays are views of them."""
    if not path.is_file():  # a pipe would keep its reader waiting
        raise FileNotFoundError(path)
    with path.open("rb") as file:
        size = os.fstat(file.fileno()).st_size
        if size > _LARGEST:
            raise UnstorableError(f"{size} bytes")
        content = np.empty(size, dtype=np.uint8)
        if file.readinto(content.data) != size:
            raise UnstorableError("cut off")
    return content


def _opened(content: Array, key: str) -> tuple[Any, _Arrays]:
    """JSON and arrays of an entry, if it is whole and of this key."""
    digest = hashlib.sha256(content[_HASH:].data).hexdigest()
    if content[:_HASH].tobytes() != digest.encode() + b"\n":
        raise UnstorableError("other bytes than were written")
    begin = _HASH + _LENGTH
    end = begin + int(content[_HASH:begin].tobytes())
    header = json.loads(content[begin:end].tobytes())
    if header["key"] != key:
        raise UnstorableError("of another key")
    return header, _Arrays(content, end)


class _Arrays:
    """The arrays of an entry in their order."""

    def __init__(self, content: Array, at: int) -> None:
        self._content, self._at = content, at

    def __call__(self, kind: str, layout: Any, shape: tuple[int, ...]) -> Array:
        """Return the next array, of this type, layout and shape."""
        dtype = np.dtype(kind)
        if not is_kept(dtype):
            raise UnstorableError(kind)
        begin = _aligned(self._at)
        self._at = begin + dtype.itemsize * math.prod(shape)
        flat = self._content[begin : self._at].view(dtype)
        if layout == "F":
            return flat.reshape(shape[::-1]).T
        if layout == "C":
            return flat.reshape(shape)
        return _spread(flat.reshape(shape), layout)


def _spread(values: Array, strides: list[int]) -> Array:
    """Values at distances in memory, of which the rounding of linear algebra depends."""
    if not values.size:
        return values
    span = sum((size - 1) * step for size, step in zip(values.shape, strides, strict=True))
    if min(strides) < 0 or span > _LARGEST:
        raise UnstorableError(f"strides {strides}")
    room = np.zeros(span + values.itemsize, dtype=np.uint8)
    spread: Array = np.ndarray(values.shape, values.dtype, room.data, 0, tuple(strides))
    spread[...] = values
    return spread


def _pieces(text: bytes, arrays: list[Array]) -> Iterator[Any]:
    """What an entry holds after its hash, without a copy of long arrays."""
    yield f"{len(text):{_LENGTH}d}".encode()
    yield text
    at = _HASH + _LENGTH + len(text)
    for each in arrays:
        yield bytes(_aligned(at) - at)
        by_memory = each.T if each.flags.f_contiguous and not each.flags.c_contiguous else each
        yield np.ascontiguousarray(by_memory).reshape(-1).view(np.uint8).data
        at = _aligned(at) + each.nbytes


def _aligned(at: int) -> int:
    return -(-at // _STEP) * _STEP
