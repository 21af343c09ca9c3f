"""One table in every dialect and format, for the readers of traces and of temperature profiles."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy.io import savemat

import hersey
from hersey.errors import (
    ChannelError,
    HerseyError,
    MissingFileError,
    ParameterError,
    UnitError,
    UnreadableLogError,
)
from hersey.identification.trace_file import read_trace
from hersey.log import open_columns
from hersey.machine.temperature_profile import MOST_POINTS, read_temperature_profile

TIME = 0.5 * np.arange(40)
FORCE = 10.25 + 0.5 * np.sin(TIME)
WARM = 20.5 + 3.25 * TIME
#: Name and unit of each column of the table.
UNITS = {"time": "s", "force": "N", "temperature": "degC"}
VALUES = dict(zip(UNITS, (TIME, FORCE, WARM), strict=True))


def text(
    names: tuple[str, ...] = tuple(UNITS),
    cell: str = ",",
    point: str = ".",
    units: str = "[]",
    above: str = "",
) -> str:
    """The table as text; ``units`` are the brackets in the header, or a row below it if empty."""
    heads = [f"{name} {units[0]}{UNITS[name]}{units[1]}" if units else name for name in names]
    lines = [cell.join(heads)] if units else [cell.join(heads), cell.join(UNITS[name] for name in names)]
    rows = zip(*(VALUES[name] for name in names), strict=True)
    lines += [cell.join(f"{value:.6f}".replace(".", point) for value in row) for row in rows]
    return above + "\n".join(lines) + "\n"


DIALECTS = {
    "commas": text(),
    "round brackets": text(units="()"),
    "semicolons": text(cell=";"),
    "decimal comma": text(cell=";", point=","),
    "tabs and decimal comma": text(cell="\t", point=","),
    "a row of units": text(units=""),
    "a row of units and decimal comma": text(cell=";", point=",", units=""),
    "a preamble": text(above="Bench 2\nOperator;Ann\nmade on 2024-03-01\n\n"),
    "comments": text(above="# SYNTHETIC\n# seed 3\n"),
    "a line below": text() + "mean,10.3\n",
}


def write_tdms(path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    clock = {"wf_increment": 0.5, "wf_start_offset": 0.0}
    channels = [
        nptdms.ChannelObject("Rig", name, VALUES[name], clock | {"unit_string": UNITS[name]})
        for name in ("force", "temperature")
    ]
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment(channels)


def write_mf4(path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        file.append(
            [asammdf.Signal(VALUES[n], TIME, name=n, unit=UNITS[n]) for n in ("force", "temperature")],
            common_timebase=True,
        )
        file.save(path, overwrite=True)


def write_hdf5(path: Path, userblock: int = 0) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w", userblock_size=userblock) as file:
        for name, values in VALUES.items():
            file.create_dataset(name, data=values.reshape(1, -1) if userblock else values)
            file[name].attrs["units"] = UNITS[name]
    if userblock:
        with path.open("r+b") as raw:
            raw.write(b"MATLAB 7.3 MAT-file, by a test".ljust(126) + b"\x00\x02IM"[:2])


def write_parquet(path: Path) -> None:
    pl.DataFrame({f"{name} [{UNITS[name]}]": values for name, values in VALUES.items()}).write_parquet(path)


def write_lvm(path: Path) -> None:
    head = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tOne\n"
    head += "***End_of_Header***\t\n\t\n"
    part = "Channels\t2\t\nSamples\t40\t40\t\nY_Unit_Label\tN\tdegC\t\nX0\t0\t0\t\nDelta_X\t0,5\t0,5\t\n"
    part += "***End_of_Header***\t\t\t\nX_Value\tforce\ttemperature\tComment\n"
    rows = "".join(
        f"{t:.1f}\t{f:.6f}\t{w:.6f}\t\n".replace(".", ",") for t, f, w in zip(TIME, FORCE, WARM, strict=True)
    )
    path.write_bytes((head + part + rows).replace("\n", "\r\n").encode())


WRITERS: dict[str, Callable[[Path], object]] = {
    "a.tdms": write_tdms,
    "a.mf4": write_mf4,
    "a.h5": write_hdf5,
    "v73.mat": lambda path: write_hdf5(path, 512),
    "a.parquet": write_parquet,
    "a.lvm": write_lvm,
    "a.mat": lambda path: savemat(path, {"time_s": TIME, "force_N": FORCE, "temperature_degC": WARM}),
}
TABLES = [*WRITERS, *DIALECTS]


def written(name: str, folder: Path) -> Path:
    path = folder / (name if name in WRITERS else "table.csv")
    if name in WRITERS:
        WRITERS[name](path)
    else:
        path.write_text(DIALECTS[name])
    return path


@pytest.mark.parametrize("name", TABLES)
def test_a_trace_of_every_kind(name: str, tmp_path: Path) -> None:
    trace = read_trace(written(name, tmp_path))
    assert (trace.quantity, trace.unit) == ("force", "N")
    np.testing.assert_allclose(trace.time, TIME, atol=1e-9)
    np.testing.assert_allclose(trace.value, FORCE, atol=1e-6)


@pytest.mark.parametrize("name", TABLES)
def test_a_temperature_profile_of_every_kind(name: str, tmp_path: Path) -> None:
    profile = read_temperature_profile(written(name, tmp_path))
    np.testing.assert_allclose(profile.times, TIME, atol=1e-9)
    np.testing.assert_allclose(profile.values, WARM + 273.15, atol=1e-6)


@pytest.mark.parametrize("cell", [";", "\t", "|"])
@pytest.mark.parametrize("units", ["[]", ""])
def test_two_columns_with_decimal_comma(cell: str, units: str, tmp_path: Path) -> None:
    """``0,5;1,5`` is no row of ``0``, ``5;1`` and ``5``."""
    path = tmp_path / "two.csv"
    path.write_text(text(("time", "force"), cell, ",", units))
    with open_columns(path) as opened:
        assert [str(column) for column in opened.columns] == ["time [s]", "force [N]"]
        times, forces = opened.numbers(*opened.columns)
    np.testing.assert_allclose(times, TIME)
    np.testing.assert_allclose(forces, FORCE, atol=1e-6)
    np.testing.assert_allclose(read_trace(path).value, FORCE, atol=1e-6)


def test_a_log_of_three_columns_with_decimal_comma_is_read(tmp_path: Path) -> None:
    rows = [f"{0.1 * i:.1f};{1 + 0.01 * i:.2f};{3 + 0.5 * i:.1f}".replace(".", ",") for i in range(30)]
    (tmp_path / "log.csv").write_text("\n".join(["t [s];Torque [N*m];Speed [rpm]", *rows]))
    log = hersey.read(tmp_path / "log.csv", isothermal=True)
    assert log.runs[0].torque[10] == pytest.approx(1.1)


def test_stamps_and_missing_numbers(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("time,force [N],temperature [degC]\n08:00:00.5,1,20\n08:00:01.5,,21\n08:00:03.5,3,-\n")
    trace = read_trace(path)
    np.testing.assert_allclose(trace.time, [0.0, 1.0, 3.0])
    np.testing.assert_allclose(trace.value, [1.0, np.nan, 3.0])
    with pytest.raises(
        UnreadableLogError, match=r"table\.csv, line 4, column 'temperature': '-' instead"
    ) as told:
        read_temperature_profile(path)
    assert "drop_missing" not in str(told.value)
    pl.DataFrame({"time [s]": [0.0, 1.0], "temperature [K]": [300.0, None]}).write_parquet(
        tmp_path / "a.parquet"
    )
    with pytest.raises(
        UnreadableLogError, match=r"a\.parquet, channel 'temperature', sample 2: the number is missing"
    ):
        read_temperature_profile(tmp_path / "a.parquet")


def test_names_of_a_trace(tmp_path: Path) -> None:
    path = tmp_path / "pull.csv"
    path.write_text("t [s],pull [N],force [N],pull [N]\n0,1,2,3\n1,2,3,4\n")
    assert read_trace(path).value[0] == 2.0
    assert read_trace(path, value="pull#2").value[0] == 3.0
    assert read_trace(path, value="force (N)").value[0] == 2.0
    with pytest.raises(ChannelError, match=r"pull \[N\] or pull \[N\]\. Name it with value"):
        read_trace(path, value="pull")
    path.write_text("0,1\n1,2\n2,3\n")
    with pytest.raises(
        UnreadableLogError, match=r"line 1: there is no header above the numbers.*e.g. value='#2'"
    ):
        read_trace(path)
    assert read_trace(path, time="#1", value="#2", time_unit="ms", unit="N").time[2] == pytest.approx(2e-3)
    savemat(tmp_path / "a.mat", {"t": TIME, "force_N": FORCE})
    assert read_trace(tmp_path / "a.mat", value="force_N", time_unit="s").name == "force [N]"


PROFILES: dict[str, tuple[str, type[HerseyError], str]] = {
    "no name of time": (
        "t [s],temperature [K]\n0,300\n",
        ChannelError,
        "no column is named time. Write 'time [s]' in the first line",
    ),
    "two temperatures": (
        "time [s],temperature 1 [K],temperature 2 [K]\n0,300,1\n",
        ChannelError,
        "more than one column is named temperature",
    ),
    "no unit": (
        "time [s],temperature\n0,300\n",
        ChannelError,
        "temperature has no unit. Write 'temperature [degC]'",
    ),
    "a unit of length": ("time [m],temperature [K]\n0,300\n", UnitError, "'time': unit 'm' is not a unit"),
    "no header": ("0,300\n1,310\n", UnreadableLogError, "needs a header line"),
    "no rows": ("time [s],temperature [K]\n", UnreadableLogError, "no rows of numbers"),
    "a word": (
        "time [s],temperature [K]\n0,300\n1,warm\n",
        UnreadableLogError,
        "line 3, column 'temperature': 'warm' is not a number",
    ),
    "time backwards": ("time [s],temperature [K]\n1,300\n0,310\n", ParameterError, "times must ascend"),
    "too many points": (
        "time [s],temperature [K]\n" + "".join(f"{i},300\n" for i in range(MOST_POINTS + 1)),
        ParameterError,
        f"{MOST_POINTS + 1} points are too many. Keep at most {MOST_POINTS}",
    ),
    "too long": (
        "time [s],temperature [K]\n" + "0,300\n" * 200_000,
        ParameterError,
        "too long for a temperature profile",
    ),
    "bytes": ("\x00\x01\x02" * 40, UnreadableLogError, "binary file"),
}


@pytest.mark.parametrize("case", PROFILES)
def test_what_is_no_profile_says_why(case: str, tmp_path: Path) -> None:
    content, kind, says = PROFILES[case]
    path = tmp_path / "warming.csv"
    path.write_text(content)
    with pytest.raises(kind) as told:
        read_temperature_profile(path)
    assert "warming.csv" in str(told.value)
    assert says in str(told.value)


def test_as_many_points_as_are_possible(tmp_path: Path) -> None:
    path = tmp_path / "warming.csv"
    path.write_text("time [s],temperature [K]\n" + "".join(f"{i},300\n" for i in range(MOST_POINTS)))
    assert np.asarray(read_temperature_profile(path).times).size == MOST_POINTS
    with pytest.raises(MissingFileError, match="File not found"):
        read_temperature_profile(tmp_path / "none.csv")
