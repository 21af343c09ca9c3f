"""HDF5 numbers that are packed by the CF conventions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import UnreadableLogError

ROWS = 200
TIME = np.arange(ROWS) * 0.01
SPEED = 60.0 + TIME


def test_packed_numbers_are_unpacked_and_fill_values_left_out(tmp_path: Path) -> None:
    """Torque in counts of 1e-4 N m from -0.02 N m on, as the CF conventions write it, with two of none."""
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "packed.h5"
    counts = np.arange(ROWS, dtype=np.int32) % 500 + 4000
    counts[[7, 150]] = -9999
    with h5py.File(path, "w") as file:
        file["time"], file["speed"], file["torque"] = TIME, SPEED, counts
        for name, unit in (("time", "s"), ("speed", "rpm"), ("torque", "N*m")):
            file[name].attrs["units"] = unit
        file["torque"].attrs.update({"scale_factor": 1e-4, "add_offset": -0.02, "_FillValue": -9999})
    log = hersey.read(path, isothermal=True, drop_missing=True)
    expected = np.delete(np.arange(ROWS) % 500 * 1e-4 + 0.38, [7, 150])
    np.testing.assert_allclose(log.runs[0].torque, expected, rtol=1e-12)
    with h5py.File(path, "a") as file:
        file["torque"].attrs["scale_factor"] = "ten"
    with pytest.raises(UnreadableLogError, match="data set 'torque': attribute scale_factor is not a number"):
        hersey.read(path, isothermal=True)
