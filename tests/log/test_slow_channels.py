"""A temperature at 1 Hz in a table of 50 Hz: interpolated between its own values, and never beyond them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import UnreadableLogError
from hersey.inspection import inspect
from hersey.log.slow_channels import SlowChannel

RATE, LASTS, EVERY = 50, 60, 50
TIME = np.arange(RATE * LASTS) / RATE
TORQUE = 1.0 + 0.001 * np.arange(TIME.size)
#: Exact between whole seconds: a straight line with a kink at 30 s, which is a value of the channel.
HEAT = np.where(TIME < 30.0, 100.0 + TIME, 130.0 - 2.0 * (TIME - 30.0))


def sparse(values: np.ndarray, every: int = EVERY, *, first: int = 0) -> list[float | None]:
    """One value in so many rows, nothing between."""
    return [float(v) if i >= first and (i - first) % every == 0 else None for i, v in enumerate(values)]


def table(**columns: object) -> pl.DataFrame:
    """A log of 60 s; further columns, or others of the same name."""
    held = {"Time [s]": TIME, "Torque [N*m]": TORQUE, "Speed [rpm]": np.full(TIME.size, 60.0)}
    return pl.DataFrame(held | {"Temp [degC]": sparse(HEAT)} | columns)


def sources(frame: pl.DataFrame, folder: Path) -> list[object]:
    """The same table as text, as Parquet and in memory."""
    frame.write_csv(folder / "a.csv")
    frame.write_parquet(folder / "a.parquet")
    return [folder / "a.csv", folder / "a.parquet", frame]


def test_a_slow_temperature_is_interpolated_between_its_values(tmp_path: Path) -> None:
    for source in sources(table(), tmp_path):
        log = hersey.read(source)
        (run,) = log.runs
        within = TIME <= 59.0
        np.testing.assert_allclose(run.time, TIME[within], rtol=1e-12)
        assert run.temperature is not None
        np.testing.assert_allclose(run.temperature - 273.15, HEAT[within], atol=1e-9)
        np.testing.assert_array_equal(run.torque, TORQUE[within])
        assert log.files[0].missing_rows == 49
        interpolated, outside = log.files[0].warnings
        assert (interpolated.kind, outside.kind) == (
            "slow channel interpolated",
            "rows outside a slow channel",
        )
        assert [interpolated.values[key] for key in ("rows_per_value", "interval")] == pytest.approx([50, 1])
        assert "temperature 'Temp' has 1 value per 50 rows (every 1 s)" in str(interpolated)
        assert outside.values["rows"] == 49


def test_rows_before_the_first_value_are_left_out(tmp_path: Path) -> None:
    for source in sources(table(**{"Temp [degC]": sparse(HEAT, first=500)}), tmp_path):
        log = hersey.read(source)
        assert log.runs[0].time[0] == pytest.approx(10.0)
        assert log.files[0].missing_rows == 500 + 49


def test_a_long_gap_is_not_bridged(tmp_path: Path) -> None:
    holes = [None if 20.0 < t < 25.0 else v for t, v in zip(TIME, sparse(HEAT), strict=True)]
    for source in sources(table(**{"Temp [degC]": holes}), tmp_path):
        with pytest.raises(UnreadableLogError, match=r"temperature 'Temp' has a gap .* 249 such rows"):
            hersey.read(source)
        log = hersey.read(source, drop_missing=True)
        time = log.runs[0].time
        assert not np.any((time > 20.0 + 1e-9) & (time < 25.0 - 1e-9))
        assert log.files[0].missing_rows == 249 + 49
        gaps = {each.kind: each.values for each in log.files[0].warnings}["gaps of a slow channel"]
        assert (gaps["rows"], gaps["role"], gaps["longest"]) == (249, "temperature", pytest.approx(3.0))
    with pytest.raises(UnreadableLogError, match=r"a\.csv, line 1003: temperature"):
        hersey.read(tmp_path / "a.csv")


@pytest.mark.parametrize("role", ["Torque [N*m]", "Speed [rpm]"])
def test_torque_and_speed_are_never_interpolated(role: str, tmp_path: Path) -> None:
    for source in sources(table(**{role: sparse(TORQUE), "Temp [degC]": HEAT}), tmp_path):
        for drop in (False, True):
            with pytest.raises(UnreadableLogError, match=r"2940 such rows, of 3000\)\. Too few rows remain"):
                hersey.read(source, drop_missing=drop)


def test_a_slow_load_is_interpolated_unless_the_quantity_is_made_of_it(tmp_path: Path) -> None:
    load = 50.0 + TIME
    columns = {"Temp [degC]": HEAT, "Load [N]": sparse(load)}
    for source in sources(table(**columns), tmp_path):
        (run,) = hersey.read(source, channels={"load": "Load"}).runs
        assert run.load is not None
        np.testing.assert_allclose(run.load, load[TIME <= 59.0], rtol=1e-12)
    force = table(**columns).rename({"Torque [N*m]": "Friction force [N]"})
    for source in sources(force, tmp_path):
        with pytest.raises(UnreadableLogError, match="2940 such rows, of 3000"):
            hersey.read(source, channels={"load": "Load"})


def test_no_value_is_interpolated_across_two_runs(tmp_path: Path) -> None:
    twice = pl.concat([table(), table(**{"Temp [degC]": sparse(HEAT + 50.0)})])
    for source in sources(twice, tmp_path):
        log = hersey.read(source)
        assert [run.time.size for run in log.runs] == [2951, 2951]
        assert [file.missing_rows for file in log.files] == [98, 0]
        for run, offset in zip(log.runs, (0.0, 50.0), strict=True):
            assert run.temperature is not None
            np.testing.assert_allclose(run.temperature - 273.15 - offset, HEAT[TIME <= 59.0], atol=1e-9)


def test_what_is_not_slow_is_missing_as_before(tmp_path: Path) -> None:
    holes = [None if i % 10 == 3 else v for i, v in enumerate(HEAT)]
    for source in sources(table(**{"Temp [degC]": holes}), tmp_path):
        with pytest.raises(UnreadableLogError, match="the first of 300 such rows, of 3000"):
            hersey.read(source)
        assert hersey.read(source, drop_missing=True).rows == 2700


@pytest.mark.parametrize("every", [1500, 550])
def test_values_few_and_far_between_tell_nothing_of_what_lies_between(every: int, tmp_path: Path) -> None:
    """8 values, or 11 s between values: as where a temperature is written when it changes alone."""
    long = pl.concat([table(), *(table(**{"Time [s]": TIME + 60.0 * i}) for i in range(1, 4))])
    heat = pl.Series("Temp [degC]", sparse(np.tile(HEAT, 4), every))
    for source in sources(long.with_columns(heat), tmp_path):
        with pytest.raises(UnreadableLogError, match=r"such rows, of 12000.*\. Too few rows remain"):
            hersey.read(source, drop_missing=True)


def test_both_values_beside_a_long_gap_are_kept() -> None:
    """A value every 10 s: the gap from 20 to 60 s is beyond three of them, and loses what lies between."""
    time = np.arange(101.0)
    heat = np.where((time % 10.0 == 0.0) & ~((time > 20.0) & (time < 60.0)), 300.0 + time, np.nan)
    channel = SlowChannel.of("temperature", "Temp", time, np.isfinite(heat))
    filled = channel.filled(time, heat, "row {}".format)
    expected = np.where((time > 20.0) & (time < 60.0), np.nan, 300.0 + time)
    np.testing.assert_allclose(filled, expected, rtol=1e-14)
    assert (channel.in_gaps, channel.outside) == (39, 0)


@pytest.mark.parametrize("text", [True, False])
def test_an_empty_temperature_can_be_done_without(text: bool, tmp_path: Path) -> None:
    frame = table(**{"Temp [degC]": pl.Series([None] * TIME.size, dtype=pl.Float64)})
    path = tmp_path / "log.csv"
    frame.write_csv(path)
    source = path if text else frame
    with pytest.raises(UnreadableLogError, match="isothermal=True"):
        hersey.read(source)
    assert not hersey.read(source, isothermal=True).has_temperature


@pytest.mark.parametrize("filler", ["#NV", "", "---.-"])
@pytest.mark.parametrize("first", [0, 1500])
def test_inspect_sees_the_slow_temperature_that_is_read(filler: str, first: int, tmp_path: Path) -> None:
    hot = [f"{120 + i / 100:.2f}" if i >= first and i % 20 == 0 else filler for i in range(4000)]
    rows = [f"{0.05 * i:.2f},1.5,60,{cell}" for i, cell in enumerate(hot)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["Time [s],Torque [N*m],Speed [rpm],Temperature [degC]", *rows]))
    assert hersey.read(path, drop_missing=True).has_temperature
    report = inspect(path, drop_missing=True)
    assert report.problem == ""
    assert "temperature" not in report.files[0].without
    (channel,) = [each for each in report.files[0].channels if each.role == "temperature"]
    assert channel.traits.missing == sum(cell == filler for cell in hot)
