"""Channels that begin at times of their own are joined by these times."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.log.formats import opened
from tests.log.test_formats import ROWS, SPEED, TORQUE, kind_of, lvm


def test_an_offset_of_tdms_counts_beside_a_start_time(tmp_path: Path) -> None:
    """Torque begins half a second after speed, which has the same start time."""
    nptdms = pytest.importorskip("nptdms")
    clock = {"wf_start_time": np.datetime64("2024-03-01T08:00:00"), "wf_increment": 0.01}
    late = clock | {"wf_start_offset": 0.5, "unit_string": "N*m"}
    with nptdms.TdmsWriter(str(tmp_path / "a.tdms")) as writer:
        speed = nptdms.ChannelObject("Rig", "Speed", SPEED, clock | {"unit_string": "rpm"})
        writer.write_segment([nptdms.ChannelObject("Rig", "Torque", TORQUE, late), speed])
    (run,) = hersey.read(tmp_path / "a.tdms", isothermal=True).runs
    assert run.time.size == ROWS - 50
    np.testing.assert_allclose(run.torque, TORQUE[:-50], rtol=1e-9)
    np.testing.assert_allclose(run.speed, SPEED[50:] * np.pi / 30, rtol=1e-9)


def test_channels_of_lvm_have_start_times_of_their_own(tmp_path: Path) -> None:
    """The second segment of torque begins a second later than that of speed: two seconds after the first."""
    first, second = lvm(2, x=False).replace("X_Columns\tOne", "X_Columns\tNo").split("Channels\t3")[1:]
    head = lvm(2, x=False).split("Channels\t3")[0]
    begin, again = "10:00:00.500000", "10:00:01.500000"
    assert begin in first
    assert again in second
    second = second.replace(again, "10:00:02.500000", 1)
    (tmp_path / "a.lvm").write_bytes("Channels\t3".join([head, first, second]).encode())
    with opened(tmp_path / "a.lvm", kind_of(tmp_path / "a.lvm")) as recording:
        torque, speed = (signal.clock() for signal in recording.signals[:2] if signal.clock)
    half = 0.01 * np.arange(ROWS // 2)
    np.testing.assert_allclose(torque, np.concatenate([half, 2.0 + half]), atol=1e-9)
    np.testing.assert_allclose(speed, np.concatenate([half, 1.0 + half]), atol=1e-9)
