"""Frames whose columns are not numbers: text that is one, objects, and what is neither."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError, UnitError
from tests.log.test_formats import TIME, assert_same, frame


def test_numbers_as_text_in_a_frame() -> None:
    texts = {name: [str(v) for v in column] for name, column in frame().to_dict(as_series=False).items()}
    commas = {name: [text.replace(".", ",") for text in column] for name, column in texts.items()}
    for each in (texts, commas):
        assert_same(hersey.read(pl.DataFrame(each)))
        assert_same(hersey.read(pd.DataFrame(each)))
    commas["Torque [N*m]"][3] = None
    assert hersey.read(pd.DataFrame(commas)).files[0].missing_rows == 1
    commas["Torque [N*m]"][3] = "Fehler"
    said = r"no torque column found.* Not numbers: 'Torque \[N\*m\]' \(text, e\.g\. 'Fehler'\)"
    with pytest.raises(ChannelError, match=said):
        hersey.read(pd.DataFrame(commas))


@pytest.mark.parametrize("made", [str, lambda stamp: stamp.to_pydatetime(), lambda stamp: stamp])
def test_time_stamps_as_text_and_objects(made: Any) -> None:
    stamps = pd.Timestamp("2024-03-01 08:00") + pd.to_timedelta(TIME, unit="s")
    table = pd.DataFrame(frame().drop("Time [s]").to_dict(as_series=False))
    table["Time"] = pd.Series([made(stamp) for stamp in stamps], dtype=object)
    assert_same(hersey.read(table))
    table["Time"] = [stamp.strftime("%d.%m.%Y %H:%M:%S.%f") for stamp in stamps]
    with pytest.raises(ChannelError, match=r"Not numbers: 'Time' \(text, e\.g\. '01\.03\.2024"):
        hersey.read(table)


def test_all_columns_without_units_are_named_at_once(tmp_path: Path) -> None:
    names = ["time", "torque", "speed", "temperature"]
    table = frame().rename(dict(zip(frame().columns, names, strict=True)))
    units = {"time": "s", "torque": "N*m", "speed": "rpm", "temperature": "degC"}
    use = f"se units={units}, with your units"
    for each in (table, pd.DataFrame(table.to_dict(as_series=False))):
        with pytest.raises(UnitError) as error:
            hersey.read(each)
        assert str(error.value) == (
            f"frame: columns 'time', 'torque', 'speed', 'temperature' have no units. U{use}"
        )
        assert_same(hersey.read(each, units=units))
    with pytest.raises(
        UnitError, match=r"^frame: column 'speed' has no unit. Use units={'speed': 'rpm'}, with"
    ):
        hersey.read(table, units={role: unit for role, unit in units.items() if role != "speed"})
    with pytest.raises(
        UnitError, match=r"^table: columns 'torque', 'speed' have no units. Use units={'torque': "
    ):
        hersey.SteadyPoints.from_table(table.drop("time"), units={"temperature": "degC"})
    with pytest.raises(UnitError, match=r"^frame: columns 'torque', 'temperature' have no units. Use"):
        hersey.read(table.rename({"time": "time [s]", "speed": "speed [rpm]"}))
    table.write_csv(tmp_path / "log.csv")
    with pytest.raises(UnitError) as error:
        hersey.read(tmp_path / "log.csv")
    head = "Write units in the header, e.g. 'time [s]', add a row of units, or u"
    assert str(error.value).endswith(f"'temperature' have no units. {head}{use}")
