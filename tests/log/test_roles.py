"""A column plays one role: it is no candidate for another, and no advice proposes it for one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError, UnitError


def ramps(*names: str) -> pl.DataFrame:
    """A frame of columns that rise, the first of which can be a clock."""
    return pl.DataFrame({name: np.arange(100) / 10 + 150 * number for number, name in enumerate(names)})


def test_a_column_that_plays_one_role_is_no_candidate_for_another(tmp_path: Path) -> None:
    frame = ramps("t [s]", "Drag [N*m]", "Heater speed", "Temp", "Drag 2 [N*m]")
    units = {"speed": "rpm", "temperature": "degC"}
    with pytest.raises(ChannelError, match=r"'Drag \[N\*m\]' or 'Drag 2 \[N\*m\]'"):
        hersey.read(frame, units=units)
    frame = frame.with_columns((pl.col("t [s]") > 5).cast(pl.Float64).alias("Drag 2 [N*m]"))
    frame.write_csv(tmp_path / "log.csv")
    for log in (frame, tmp_path / "log.csv"):
        read = hersey.read(log, units=units, channels={"run": "Drag 2"})
        assert len(read.runs) == 2
        names = [each.name for each in read.files[0].channels]
        assert names == ["t", "Drag", "Heater speed", "Temp", "Drag 2"]


def test_advice_on_a_column_proposes_none_that_has_a_role() -> None:
    frame = ramps("t [s]", "Torque [N*m]", "Speed [rpm]", "Temp [degC]")
    with pytest.raises(ChannelError, match="there is no column 'Sped'") as refused:
        hersey.read(frame, channels={"speed": "Speed", "temperature": "Sped"})
    assert refused.value.remedy == ""
    with pytest.raises(ChannelError, match=r"Did you mean channels=\{'speed': 'Speed'\}"):
        hersey.read(frame, channels={"speed": "Sped"})


def test_advice_on_swapped_columns_can_be_followed() -> None:
    frame = ramps("t [s]", "Torque [degC]", "Speed [rpm]", "Temp [N*m]")
    channels = {"torque": "Torque", "temperature": "Temp"}
    with pytest.raises(UnitError, match="swapped") as refused:
        hersey.read(frame, channels=channels)
    advised = eval(refused.value.remedy.removeprefix("use channels="))
    assert advised == {"torque": "Temp", "temperature": "Torque"}
    assert hersey.read(frame, channels=channels | advised).rows == 100
