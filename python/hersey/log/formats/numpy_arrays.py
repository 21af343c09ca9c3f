"""Arrays that NumPy saved, ``.npz`` and ``.npy``; pickled objects are never loaded."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, BinaryIO

import numpy as np
from numpy.lib import format as npy

from hersey.log.formats.matrices import array_signals
from hersey.log.recording import Recording, Signal

#: Kinds of numbers; what else an array may hold is reported, not read.
_NUMBERS = "iufbmM"
_KINDS = {"O": "Python objects, which only pickle could load", "U": "text", "S": "text", "c": "complex"}


@contextmanager
def open_numpy_arrays(file: BinaryIO, _name: str) -> Iterator[Recording]:
    """Open vectors, columns of matrices and fields of records; units stand at the end of their names."""
    start = file.read(len(npy.MAGIC_PREFIX))
    file.seek(0)
    signals: list[Signal] = []
    others: list[str] = []
    if start == npy.MAGIC_PREFIX:
        _add("array", file, signals, others)
    else:
        with zipfile.ZipFile(file) as archive:
            for member in archive.namelist():
                if not member.endswith(".npy"):
                    others.append(f"'{member}' (not an array)")
                    continue
                with archive.open(member) as content:
                    _add(member.removesuffix(".npy"), content, signals, others)
    yield Recording("NumPy", tuple(signals), tuple(others))


def _add(name: str, content: Any, signals: list[Signal], others: list[str]) -> None:
    version = npy.read_magic(content)
    read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    shape, column_major, kind = read(content)
    if kind.hasobject or (kind.kind not in _NUMBERS and not kind.names):
        others.append(f"'{name}' ({_KINDS.get('O' if kind.hasobject else kind.kind, 'no numbers')})")
        return
    values = np.frombuffer(content.read(), dtype=kind)
    values = values.reshape(shape, order="F" if column_major else "C")
    fields = {f"{name}/{field}": values[field] for field in kind.names} if kind.names else {name: values}
    for path, numbers in fields.items():
        group, _, plain = path.rpartition("/")
        if numbers.dtype.kind in _NUMBERS:
            vectors = array_signals(plain, numbers.shape, numbers.view, group=group)
            signals.extend(vectors)
        else:
            vectors = []
        if not vectors:
            others.append(f"'{path}' ({'x'.join(map(str, numbers.shape)) or 'one value'})")
