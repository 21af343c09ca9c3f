"""MATLAB files: v4 to v7.2 through scipy.io; v7.3 is HDF5 and goes through h5py."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, BinaryIO

import numpy as np
from scipy.io import loadmat

from hersey.errors import UnreadableLogError
from hersey.log.formats.cells import cell_signals
from hersey.log.formats.hdf5 import is_hdf5, open_hdf5
from hersey.log.formats.matlab_tags import check_tags
from hersey.log.formats.matrices import array_signals
from hersey.log.recording import Recording, Signal, library_warning

_DATA = ("data", "values", "value", "signal", "samples")
_UNITS = ("unit", "units", "Unit", "Units")
#: Structs within structs are followed to this depth.
_DEPTH = 4
#: Cells of an array that are looked into one by one, at the most.
_MOST_CELLS = 256


@contextmanager
def open_matlab(file: BinaryIO, name: str) -> Iterator[Recording]:
    """Open a MATLAB file: vectors, columns of matrices, fields of structs, and cells."""
    start = file.read(1024)
    file.seek(0)
    if is_hdf5(start):
        with open_hdf5(file, name) as recording:
            recording.format = "MATLAB v7.3"
            yield recording
        return
    if start[126:128] in (b"IM", b"MI"):
        check_tags(file.read(), name)
    signals: list[Signal] = []
    others: list[str] = []
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        variables = loadmat(file, chars_as_strings=True)  # type: ignore[arg-type] # it takes files, too
    for variable, value in variables.items():
        if not variable.startswith("__"):
            _walk(variable, value, "", signals, others, 0)
    objects = [o for o in others if "object" in o]
    nothing = (
        f"{', '.join(objects)}: only MATLAB can open tables and timetables. In MATLAB, run s = "
        "table2struct(T, 'ToScalar', true) and save s"
    )
    yield Recording(
        "MATLAB",
        tuple(signals),
        tuple(others),
        warnings=[library_warning("scipy", str(warning.message)) for warning in heard],
        nothing=nothing if objects else "",
    )


def _walk(name: str, value: Any, group: str, signals: list[Signal], others: list[str], depth: int) -> None:
    place = f"'{group}/{name}'" if group else f"'{name}'"
    if not isinstance(value, np.ndarray) or type(value).__name__ == "MatlabOpaque":
        others.append(f"{place} (MATLAB object)")
    elif value.dtype.names and value.size == 1 and depth < _DEPTH:
        _walk_struct(name, value.reshape(-1)[0], group, signals, others, depth)
    elif value.dtype.kind in "iufb":
        vectors = array_signals(name, value.shape, value.view, group=group)
        signals.extend(vectors)
        if not vectors:
            others.append(f"{place} ({'x'.join(map(str, value.shape))})")
    elif value.dtype.kind == "O" and depth < _DEPTH and cell_signals(name, value, group, signals):
        pass
    elif value.dtype.kind == "O" and depth < _DEPTH and 0 < value.size <= _MOST_CELLS:
        for number, cell in enumerate(value.reshape(-1), start=1):
            _walk(f"{name}#{number}", cell, group, signals, others, depth + 1)
    else:
        what = {"O": "cells", "U": "text", "S": "text", "c": "complex"}.get(value.dtype.kind, "structs")
        others.append(f"{place} ({what})")


def _walk_struct(
    name: str, struct: Any, group: str, signals: list[Signal], others: list[str], depth: int
) -> None:
    """A struct is a group; one with data and unit is a channel."""
    fields = {str(field): struct[field] for field in struct.dtype.names}
    data = next((fields[k] for k in _DATA if k in fields and fields[k].dtype.kind in "iufb"), None)
    unit = next((fields[k] for k in _UNITS if k in fields and fields[k].dtype.kind == "U"), None)
    path = f"{group}/{name}" if group else name
    if data is not None and unit is not None:
        if unit.size != 1:
            raise UnreadableLogError(f"the unit of '{path}' is not text")
        signals.extend(array_signals(name, data.shape, data.view, str(unit.reshape(-1)[0]), group))
        return
    for field, value in fields.items():
        _walk(field, value, path, signals, others, depth + 1)
