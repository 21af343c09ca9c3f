"""The tags of a MATLAB v5 file, walked before scipy reads it: scipy trusts them, and a wrong one ends Python.

Source: MathWorks, MAT-File Format, Level 5.
"""

from __future__ import annotations

import math
import struct
import zlib

from hersey.errors import UnreadableLogError
from hersey.processes.limits import memory_left

_HEADER = 128
_INT8, _INT32, _UINT32, _MATRIX, _COMPRESSED, _UTF8 = 1, 5, 6, 14, 15, 16
#: Kinds of numbers and text: 8 to 64 bit integers, single, double, UTF-8, -16 and -32.
_DATA = {1, 2, 3, 4, 5, 6, 7, 9, 12, 13, 16, 17, 18}
#: Bytes of a number by its type.
_SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8}
_NUMERIC = range(6, 16)  # classes of matrices of numbers
_COMPLEX = 0x800  # a flag: an imaginary part follows
_OPAQUE = 17  # class of a table or another object, which has no dimensions
_DEPTH = 20


def check_tags(data: bytes, file: str) -> None:
    """Refuse a MATLAB v5 file whose elements do not follow one another up to its end.

    A compressed element that holds more than this process may take raises `MemoryError`, before it is.

    Raises
    ------
    UnreadableLogError
        If an element has an unknown type, or is longer than what holds it.
    """
    order = ">" if data[126:128] == b"MI" else "<"
    try:
        for kind, start, end in _elements(data, _HEADER, len(data), order):
            if kind == _COMPRESSED:
                inner = _unpacked(data[start:end], order)
                for inner_kind, first, last in _elements(inner, 0, len(inner), order):
                    _check(inner, inner_kind, first, last, order, 0)
            else:
                _check(data, kind, start, end, order, 0)
    except (_TagError, struct.error, zlib.error):
        raise UnreadableLogError(
            f"{file} cannot be read as a MATLAB file: it is damaged or cut off"
        ) from None


def _unpacked(packed: bytes, order: str) -> bytes:
    """A compressed element, which holds one other of the size that its tag says."""
    unpacking = zlib.decompressobj()
    tag = unpacking.decompress(packed, 8)
    word, size = struct.unpack(f"{order}II", tag)
    size = 0 if word >> 16 else size  # a small element holds its bytes in the tag
    if 2 * size > memory_left():  # here, and in scipy
        raise MemoryError
    inner = tag + unpacking.decompress(unpacking.unconsumed_tail, size + 8)
    if unpacking.decompress(unpacking.unconsumed_tail, 1) or not unpacking.eof:
        raise _TagError
    return inner


class _TagError(Exception):
    """A tag that cannot be."""


def _elements(data: bytes, start: int, end: int, order: str) -> list[tuple[int, int, int]]:
    """Type, first and last byte of each element between two bytes."""
    out = []
    while start < end:
        (word,) = struct.unpack_from(f"{order}I", data, start)
        small = word >> 16
        if small:
            kind, size, first, after = word & 0xFFFF, small, start + 4, start + 8
        else:
            kind, (size,) = word, struct.unpack_from(f"{order}I", data, start + 4)
            first = start + 8
            after = first + (size if kind == _COMPRESSED else -(-size // 8) * 8)
        if first + size > end or (small and size > 4):
            raise _TagError
        out.append((kind, first, first + size))
        start = after
    return out


def _check(data: bytes, kind: int, start: int, end: int, order: str, depth: int) -> None:
    if kind in _DATA:
        return
    if kind != _MATRIX or depth > _DEPTH:
        raise _TagError
    if start == end:  # an empty cell
        return
    parts = _elements(data, start, end, order)
    kinds = [part for part, *_ in parts]
    if len(parts) < 2 or kinds[0] != _UINT32 or parts[0][2] - parts[0][1] != 8:
        raise _TagError
    (flags,) = struct.unpack_from(f"{order}I", data, parts[0][1])
    kind = flags & 0xFF
    if kind != _OPAQUE:
        if len(parts) < 3 or kinds[1] not in (_INT32, _UINT32) or kinds[2] not in (_INT8, _UTF8):
            raise _TagError
        wanted = 5 if flags & _COMPLEX else 4
        if kind in _NUMERIC and (len(parts) != wanted or any(k not in _SIZES for k in kinds[3:])):
            raise _TagError
        if kind in _NUMERIC:
            sides = struct.unpack_from(f"{order}{(parts[1][2] - parts[1][1]) // 4}I", data, parts[1][1])
            if any(last - first != math.prod(sides) * _SIZES[k] for k, first, last in parts[3:]):
                raise _TagError
    for part, first, last in parts:
        _check(data, part, first, last, order, depth + 1)
