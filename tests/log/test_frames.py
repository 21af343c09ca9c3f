"""Frames whose columns are not numbers: text that is one, objects, and what is neither."""

from __future__ import annotations

from typing import Any

import pandas as pd
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError
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
