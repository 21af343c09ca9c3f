"""HDF5 files, and MATLAB v7.3 which is HDF5, through h5py."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, BinaryIO

import numpy as np

from hersey.errors import UnreadableLogError
from hersey.log.formats.matrices import array_signals
from hersey.log.recording import Recording, Signal, library

MAGIC = b"\x89HDF\r\n\x1a\n"
_UNITS = ("units", "unit", "Units", "Unit", "UNITS", "UNIT")
#: Attributes of the CF conventions: numbers are packed as (number - offset)/factor; some stand for none.
_PACKED = ("scale_factor", "add_offset")
_MISSING = ("_FillValue", "missing_value")
#: MATLAB keeps the contents of cells and objects here.
_HIDDEN = ("#refs#", "#subsystem#")
_WAY_OUT = "Copy the referenced data into the file itself, e.g. with h5repack or h5py"


def is_hdf5(start: bytes) -> bool:
    """Return whether a file starts as HDF5 does, at byte 0 or behind the 512 bytes of MATLAB."""
    start = start[: 512 + len(MAGIC)]
    return start.startswith(MAGIC) or start[512:] == MAGIC


@contextmanager
def open_hdf5(opened: BinaryIO, _name: str) -> Iterator[Recording]:
    """Open an HDF5 file: data sets of one or two dimensions, units in their attributes."""
    h5py = library("h5py", "HDF5 files")
    with h5py.File(opened, "r") as file:
        signals: list[Signal] = []
        others: list[str] = []

        def visit(name: str, item: Any) -> None:
            if not isinstance(item, h5py.Dataset) or name.startswith(_HIDDEN):
                return
            _check_kind(h5py, name, item)
            _check_place(name, item)
            vectors = list(_data_set(name, item))
            signals.extend(vectors)
            if not vectors:
                others.append(f"'{name}' ({item.dtype}, {'x'.join(map(str, item.shape or ()))})")

        file.visititems(visit)
        outside: list[str] = []

        def follow(name: str, link: Any) -> None:
            if isinstance(link, h5py.ExternalLink):  # not raised here: h5py lets no exception through
                outside.append(f"'{name}' refers to another file, '{link.filename}'")

        file.visititems_links(follow)
        if outside:
            raise UnreadableLogError(f"{outside[0]}. {_WAY_OUT}")
        comments = tuple(f"{key}: {_text(value)}"[:200] for key, value in file.attrs.items())[:5]
        yield Recording("HDF5", tuple(signals), tuple(others), comments)


def _data_set(path: str, item: Any) -> Iterator[Signal]:
    group, _, name = path.rpartition("/")
    shape = tuple(int(n) for n in item.shape or ())
    unit = next((_text(item.attrs[key]) for key in _UNITS if key in item.attrs), "")
    if item.dtype.names:
        for field in item.dtype.names:
            if item.dtype[field].kind in "iufb" and not item.dtype[field].shape:
                yield from array_signals(field, shape, partial(item.__getitem__, field), group=path)
    elif item.dtype.kind in "iufb" and shape:
        yield from array_signals(name, shape, _numbers(path, item), unit, group)


def _check_kind(h5py: Any, path: str, item: Any) -> None:
    """Numbers of a kind that no machine has come from a damaged description: they would be read wrongly."""
    if item.dtype.kind in "iuf" and not item.id.get_type().equal(h5py.h5t.py_create(item.dtype)):
        raise UnreadableLogError(f"data set '{path}' has numbers of an unusual type. The file is damaged")


def _check_place(path: str, item: Any) -> None:
    """Numbers in another file are not those that were hashed, nor those that a user means to give."""
    if item.external or item.is_virtual:
        raise UnreadableLogError(f"data set '{path}' stores its numbers in another place. {_WAY_OUT}")


def _numbers(path: str, item: Any) -> Callable[[], Any]:
    """Read the numbers, unpacked and without those that stand for none, as the CF conventions have it."""
    factor, offset = (_number(path, item, key, none) for key, none in zip(_PACKED, (1.0, 0.0), strict=True))
    missing = [_number(path, item, key, np.nan) for key in _MISSING if key in item.attrs]
    if not missing and (factor, offset) == (1.0, 0.0):
        return lambda: item[()]

    def unpacked() -> Any:
        raw = np.asarray(item[()])
        none = np.isin(raw, missing)
        return np.where(none, np.nan, raw * factor + offset)

    return unpacked


def _number(path: str, item: Any, key: str, none: float) -> float:
    """An attribute that is a number."""
    if key not in item.attrs:
        return none
    value = np.asarray(item.attrs[key])
    if value.size != 1 or value.dtype.kind not in "iuf" or not np.isfinite(value).all():
        if key in _PACKED:
            raise UnreadableLogError(f"data set '{path}': attribute {key} is not a number")
        return np.nan
    return float(value.reshape(-1)[0])


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray):
        value = value.reshape(-1)[0] if value.size == 1 else ""
    return value.decode("utf-8", errors="replace") if isinstance(value, bytes) else str(value)
