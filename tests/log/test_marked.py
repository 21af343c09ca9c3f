"""Samples that an MDF file itself marks as invalid cost their rows, by name."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import UnreadableLogError
from hersey.inspection import inspect
from hersey.log.impossible import Reason

asammdf = pytest.importorskip("asammdf")

ROWS = 400
TIME = np.arange(ROWS) / 10.0
RANDOM = np.random.default_rng(0)
CHANNELS = {
    "speed": (np.repeat([10.0, 20.0, 40.0, 80.0], 100), "rpm"),
    "torque": (300.0 * np.repeat([10.0, 20.0, 40.0, 80.0], 100) ** 0.4, "mN*m"),
    "temperature": (100.0 + 0.1 * RANDOM.standard_normal(ROWS), "degC"),
}


def write(path: Path, marked: dict[str, Any], *, groups: bool = False) -> Path:
    """Write the channels, rows of some marked as invalid; ``time`` marks those of the clock."""
    with asammdf.MDF(version="4.10") as file:
        signals = []
        for name, (values, unit) in CHANNELS.items():
            bits = np.zeros(ROWS, dtype=bool)
            bits[marked.get(name, [])] = True
            if name == "speed" and "time" in marked:
                bits[marked["time"]] = True
            bits_or_none = bits if bits.any() else None
            wrong = np.where(bits, 0.5 * values, values)  # what stands there is not to be used
            signals.append(asammdf.Signal(wrong, TIME, name=name, unit=unit, invalidation_bits=bits_or_none))
        for part in [[signal] for signal in signals] if groups else [signals]:
            file.append(part)
        if "time" in marked:  # asammdf writes no such mark: that of the speed becomes that of the clock
            clock, speed = file.groups[0].channels[:2]
            clock.flags, clock.pos_invalidation_bit, speed.flags = speed.flags, speed.pos_invalidation_bit, 0
        file.save(path, overwrite=True)
    return path


CASES: dict[str, tuple[dict[str, Any], dict[str, int]]] = {
    "torque": ({"torque": [5, 100, 300]}, {"torque": 3}),
    "speed": ({"speed": [5, 6]}, {"speed": 2}),
    "two channels": ({"torque": [5, 7], "temperature": [7, 8, 9]}, {"torque": 2, "temperature": 3}),
    "a tenth": ({"torque": slice(40, 80)}, {"torque": 40}),
    "the clock": ({"time": [5, 100]}, {"time": 2}),
}


@pytest.mark.parametrize("case", CASES)
def test_samples_marked_invalid_cost_their_rows(case: str, tmp_path: Path) -> None:
    marked, counts = CASES[case]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        log = hersey.read(write(tmp_path / "log.mf4", marked))
    gone = np.unique(np.concatenate([np.arange(ROWS)[rows] for rows in marked.values()]))
    run, file = log.runs[0], log.files[0]
    np.testing.assert_array_equal(run.time, np.delete(TIME, gone))
    np.testing.assert_allclose(run.torque, np.delete(CHANNELS["torque"][0], gone) * 1e-3, rtol=1e-12)
    assert file.missing_rows == gone.size
    assert {each.role: each.rows for each in file.impossible} == counts
    assert {each.reason for each in file.impossible} == {Reason.MARKED}
    warned = {each.values["role"]: each for each in file.warnings if each.values.get("reason") == "marked"}
    assert {role: each.values["rows"] for role, each in warned.items()} == counts
    for role, count in counts.items():
        times = "once" if count == 1 else f"{count} times"
        assert f": {role} is marked as invalid in the file ({times})" in str(warned[role])


def test_the_first_of_them_is_named(tmp_path: Path) -> None:
    (warning,) = hersey.read(write(tmp_path / "log.mf4", {"torque": [5, 100, 300]})).files[0].warnings
    assert "channel 'torque', sample 6: torque is" in str(warning)


@pytest.mark.parametrize("name", list(CHANNELS))
def test_a_channel_that_is_invalid_throughout_is_refused(name: str, tmp_path: Path) -> None:
    path = write(tmp_path / "log.mf4", {name: slice(None)})
    with pytest.raises(UnreadableLogError, match=rf"{name} is marked .*100% of the channel \(400 of 400"):
        hersey.read(path, drop_missing=True)
    if name == "temperature":
        log = hersey.read(path, isothermal=True)
        assert (log.rows, log.files[0].impossible) == (ROWS, ())


def test_a_third_is_refused_unless_asked_for(tmp_path: Path) -> None:
    path = write(tmp_path / "log.mf4", {"torque": slice(0, 133)})
    with pytest.raises(UnreadableLogError, match=r"33% of the channel .*drop_missing=True"):
        hersey.read(path)
    assert hersey.read(path, drop_missing=True).rows == ROWS - 133


def test_a_channel_on_a_clock_of_its_own(tmp_path: Path) -> None:
    """Its invalid samples are bridged, those of the torque cost rows."""
    log = hersey.read(write(tmp_path / "log.mf4", {"torque": [7], "temperature": [20, 21]}, groups=True))
    assert log.rows == ROWS - 1
    assert {each.role: each.rows for each in log.files[0].impossible} == {"torque": 1, "temperature": 2}
    run = log.runs[0]
    assert run.temperature is not None
    between = np.interp(TIME[20:22], TIME[[19, 22]], CHANNELS["temperature"][0][[19, 22]])
    np.testing.assert_allclose(run.temperature[19:21], between + 273.15, rtol=1e-12)


def test_inspect_shows_them_as_missing(tmp_path: Path) -> None:
    found = inspect(write(tmp_path / "log.mf4", {"torque": [5, 100, 300]}))
    (torque,) = (c for c in found.files[0].channels if c.role == "torque")
    assert torque.traits.missing == 3
    assert "torque is marked as invalid in the file (3 times)" in found.summary()


def test_a_file_without_marks_keeps_every_row(tmp_path: Path) -> None:
    log = hersey.read(write(tmp_path / "log.mf4", {}))
    assert (log.rows, log.files[0].warnings) == (ROWS, ())
    assert log.to_frame().select(pl.len()).item() == ROWS
