"""Every format of a data logger is read to the same run, and damaged files say so."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError, UnitError, UnreadableLogError
from hersey.log import list_channels
from hersey.log.formats import READERS, format_of, opened
from hersey.log.formats.recognition import FILES
from hersey.log.recording import library
from hersey.log.torque_log import LogFile, Run
from tests.conftest import shared

ROWS, SLOW = 200, 21
TIME = np.arange(ROWS) * 0.01
TORQUE = 1.0 + 0.1 * np.sin(7.0 * TIME)
SPEED = 60.0 + TIME
SLOW_TIME = np.arange(SLOW) * 0.1
SLOW_TEMPERATURE = 150.0 + 0.25 * np.arange(SLOW)  #: a straight line, which interpolation leaves as it is
TEMPERATURE = 150.0 + 2.5 * TIME


def write_tdms(path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    clock = {"wf_increment": 0.01, "wf_start_offset": 0.0}
    with nptdms.TdmsWriter(str(path)) as writer:
        for part in range(4):
            rows, slow = (
                slice(part * 50, part * 50 + 50),
                slice(part * 5, SLOW if part == 3 else part * 5 + 5),
            )
            writer.write_segment(
                [
                    nptdms.ChannelObject("Rig", "Torque", TORQUE[rows], clock | {"unit_string": "N*m"}),
                    nptdms.ChannelObject("Rig", "Speed", SPEED[rows], clock | {"unit_string": "rpm"}),
                    nptdms.ChannelObject(
                        "Rig",
                        "Film temp",
                        SLOW_TEMPERATURE[slow],
                        {"wf_increment": 0.1, "wf_start_offset": 0.0, "unit_string": "degC"},
                    ),
                ]
            )


def write_mf4(path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        file.append(
            [
                asammdf.Signal(TORQUE, TIME, name="Torque", unit="Nm"),
                asammdf.Signal(SPEED, TIME, name="Speed", unit="rpm"),
            ],
            common_timebase=True,
        )
        file.append([asammdf.Signal(SLOW_TEMPERATURE, SLOW_TIME, name="Temp", unit="degC")])
        file.save(path, overwrite=True)


def write_mat(path: Path) -> None:
    from scipy.io import savemat

    savemat(path, {"t_s": TIME, "torque_Nm": TORQUE, "speed_rpm": SPEED, "temp_degC": TEMPERATURE})


def write_mat73(path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (
            ("t_s", TIME),
            ("torque_Nm", TORQUE),
            ("speed_rpm", SPEED),
            ("temp_degC", TEMPERATURE),
        ):
            file.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    data = bytearray(path.read_bytes())
    data[:19] = b"MATLAB 7.3 MAT-file"
    path.write_bytes(data)


def write_hdf5(path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        for name, values, unit in (
            ("time", TIME, "s"),
            ("torque", TORQUE, "N*m"),
            ("speed", SPEED, "rpm"),
            ("temperature", TEMPERATURE, "degC"),
        ):
            file[f"run/{name}"] = values
            file[f"run/{name}"].attrs["units"] = unit


def frame() -> pl.DataFrame:
    return pl.DataFrame(
        {"Time [s]": TIME, "Torque [N*m]": TORQUE, "Speed [rpm]": SPEED, "Temp [degC]": TEMPERATURE}
    )


def write_parquet(path: Path) -> None:
    frame().write_parquet(path)


LVM_HEADER = """LabVIEW Measurement\t
Writer_Version\t2
Reader_Version\t2
Separator\tTab
Decimal_Separator\t.
Multi_Headings\tNo
X_Columns\tOne
Time_Pref\tRelative
Date\t2024/01/02
Time\t10:00:00.5
***End_of_Header***\t
\t
"""
LVM_SEGMENT = """Channels\t3\t\t\t
Samples\t{rows}\t{rows}\t{rows}\t
Date\t2024/01/02\t2024/01/02\t2024/01/02\t
Time\t{start}\t{start}\t{start}\t
Y_Unit_Label\tN*m\trpm\tdegC\t
X_Dimension\tTime\tTime\tTime\t
X0\t0\t0\t0\t
Delta_X\t0.01\t0.01\t0.01\t
***End_of_Header***\t\t\t\t
X_Value\tTorque\tSpeed\tTemp\tComment
"""


def lvm(parts: int = 1, x: bool = True, separator: str = "\t", decimal: str = ".") -> str:
    text, rows = LVM_HEADER, ROWS // parts
    for part in range(parts):
        seconds = f"10:00:{0.5 + part * rows * 0.01:09.6f}"
        text += LVM_SEGMENT.format(rows=rows, start=seconds)
        for i in range(part * rows, (part + 1) * rows):
            first = f"{(i - part * rows) * 0.01:.2f}" if x else ""
            text += f"{first}\t{TORQUE[i]:.15f}\t{SPEED[i]:.15f}\t{TEMPERATURE[i]:.15f}\t\n"
    text = text.replace("Separator\tTab", "Separator\tComma") if separator == "," else text
    text = text.replace("Decimal_Separator\t.", f"Decimal_Separator\t{decimal}")
    text = "\n".join(
        line.replace(".", decimal) if line[:1].isdigit() or line.startswith("\t") else line
        for line in text.split("\n")
    )
    return text.replace("\t", separator).replace("\n", "\r\n")


def write_lvm(path: Path) -> None:
    path.write_bytes(lvm().encode())


def write_csv(path: Path) -> None:
    frame().write_csv(path, float_precision=6)


WRITERS: dict[str, Callable[[Path], None]] = {
    "a.tdms": write_tdms,
    "a.mf4": write_mf4,
    "a.mat": write_mat,
    "v73.mat": write_mat73,
    "a.h5": write_hdf5,
    "a.parquet": write_parquet,
    "a.lvm": write_lvm,
    "a.csv": write_csv,
}


def kind_of(path: Path) -> str:
    kind = format_of(path)
    assert kind is not None
    return kind


def assert_same(log: hersey.TorqueLog, rtol: float = 1e-12) -> LogFile:
    (run,), (file,) = log.runs, log.files
    np.testing.assert_allclose(run.time - run.time[0], TIME, rtol=0, atol=1e-9)
    np.testing.assert_allclose(run.torque, TORQUE, rtol=rtol)
    np.testing.assert_allclose(run.speed, SPEED * np.pi / 30, rtol=rtol)
    assert run.temperature is not None
    np.testing.assert_allclose(run.temperature, TEMPERATURE + 273.15, rtol=rtol)
    assert [channel.role for channel in file.channels] == ["time", "torque", "speed", "temperature"]
    assert not file.cut_off
    assert file.rows == ROWS
    return file


@pytest.mark.parametrize("name", WRITERS)
def test_every_format_holds_the_same_run(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    WRITERS[name](path)
    file = assert_same(hersey.read(path), 1e-12 if name != "a.csv" else 1e-5)
    assert file.bytes == path.stat().st_size
    odd = path.rename(tmp_path / "recording.dat")  # the first bytes tell, whatever the suffix
    assert_same(hersey.read(odd), 1e-12 if name != "a.csv" else 1e-5)
    units = {unit for _, unit in list_channels(odd)}
    assert {"rpm", "degC"} <= units


def test_frames_in_memory() -> None:
    assert_same(hersey.read(frame()))
    assert_same(hersey.read(frame().lazy()))
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"torque": TORQUE, "speed": SPEED, "temp": TEMPERATURE})
    table.attrs["units"] = {"torque": "N*m", "speed": "rpm", "temp": "degC"}
    table.index = pandas.Timestamp("2024-03-01 08:00", tz="CET") + pandas.to_timedelta(TIME, unit="s")
    assert_same(hersey.read(table))
    assert list_channels(table)[:2] == [("time", "s"), ("torque", "N*m")]
    with pytest.raises(hersey.HerseyError, match="one is a copy of the other"):
        hersey.read([frame(), table])
    table["torque"] *= 1.01
    both = hersey.read([frame(), table])
    assert [run.name for run in both.runs] == ["frame 1", "frame 2"]
    with pytest.raises(hersey.HerseyError, match="each file once"):
        hersey.read([frame(), frame()])


def test_a_missing_value_in_a_frame_is_refused_or_counted() -> None:
    gap = frame().with_columns(
        pl.when(pl.col("Time [s]") == 0.5).then(None).otherwise("Torque [N*m]").alias("Torque [N*m]")
    )
    log = hersey.read(gap)
    assert (log.rows, log.files[0].missing_rows) == (ROWS - 1, 1)
    (warning,) = log.files[0].warnings
    assert (warning.kind, warning.values["rows"]) == ("rows left out", 1)
    assert "1 row was excluded: channel 'Torque', sample 51: the number is missing" in str(warning)
    many = frame().with_columns(pl.when(pl.col("Time [s]") < 0.5).then("Torque [N*m]").alias("Torque [N*m]"))
    with pytest.raises(
        UnreadableLogError, match=r"'Torque', sample 51: the .* 150 such rows, of 200.\. Too few"
    ):
        hersey.read(many, drop_missing=True)
    some = frame().with_columns(pl.when(pl.col("Time [s]") < 1.5).then("Torque [N*m]").alias("Torque [N*m]"))
    with pytest.raises(UnreadableLogError, match=r"'Torque', sample 151: the number .*drop_missing=True"):
        hersey.read(some)
    assert hersey.read(some, drop_missing=True).rows == 150


@pytest.mark.parametrize("name", ["a.tdms", "a.mf4"])
def test_channels_at_different_rates_are_aligned_in_words(name: str, tmp_path: Path) -> None:
    WRITERS[name](tmp_path / name)
    (warning,) = hersey.read(tmp_path / name).files[0].warnings
    assert warning.kind == "clocks aligned"
    assert warning.values["role"] == "temperature"
    intervals = [warning.values[key] for key in ("interval", "torque_interval", "longest")]
    assert intervals == pytest.approx([0.1, 0.01, 0.1])
    assert "(10 Hz, torque 100 Hz) and was interpolated linearly" in str(warning)


def test_nothing_is_extrapolated(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    start = np.datetime64("2024-03-01T08:00:00")
    path = tmp_path / "late.tdms"
    late = {"wf_start_time": start + np.timedelta64(505, "ms"), "wf_increment": 0.1, "unit_string": "degC"}
    fast = {"wf_start_time": start, "wf_increment": 0.01}
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [
                nptdms.ChannelObject("Rig", "Torque", TORQUE, fast | {"unit_string": "N*m"}),
                nptdms.ChannelObject("Rig", "Speed", SPEED, fast | {"unit_string": "rpm"}),
                nptdms.ChannelObject("Rig", "Temp", 150.0 + np.arange(11.0), late),
            ]
        )
    log = hersey.read(path)
    (run,) = log.runs
    inside = (TIME >= 0.505) & (TIME <= 1.505)
    np.testing.assert_allclose(run.time, TIME[inside])
    np.testing.assert_allclose(run.torque, TORQUE[inside])
    assert run.temperature is not None
    np.testing.assert_allclose(run.temperature, 423.15 + (TIME[inside] - 0.505) * 10)
    outside = {each.kind: each for each in log.files[0].warnings}["samples outside another channel"]
    assert (outside.values["samples"], outside.values["all"]) == (100, 200)


def test_scalings_of_tdms_are_applied_or_refused(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    scale = {
        "NI_Number_Of_Scales": 1,
        "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": 0.002,
        "NI_Scale[0]_Linear_Y_Intercept": 1.0,
        "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
    }

    def write(properties: dict[str, Any]) -> Path:
        clock = {"wf_increment": 0.01}
        with nptdms.TdmsWriter(str(tmp_path / "s.tdms")) as writer:
            raw = np.arange(ROWS, dtype=np.int16)
            torque = nptdms.ChannelObject("g", "Torque", raw, clock | {"unit_string": "N*m"} | properties)
            speed = nptdms.ChannelObject("g", "Speed", SPEED, clock | {"unit_string": "rpm"})
            writer.write_segment([torque, speed])
        return tmp_path / "s.tdms"

    run = hersey.read(write(scale), isothermal=True).runs[0]
    np.testing.assert_allclose(run.torque, 1.0 + 0.002 * np.arange(ROWS))
    with pytest.raises(UnreadableLogError, match=r"'Torque'.*'Magic', which cannot be applied"):
        hersey.read(write(scale | {"NI_Scale[0]_Scale_Type": "Magic"}), isothermal=True)


def test_the_part_with_the_torque_is_preferred(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "two.h5"
    with h5py.File(path, "w") as file:
        for part in ("bench", "motor"):
            for name, values, unit in (
                ("time", TIME, "s"),
                ("speed", SPEED, "rpm"),
                ("temperature", TEMPERATURE, "K"),
            ):
                file[f"{part}/{name}"] = values + (part == "motor")
                file[f"{part}/{name}"].attrs["unit"] = unit
        file["bench/torque"] = TORQUE
        file["bench/torque"].attrs["unit"] = "N*m"
    run = hersey.read(path).runs[0]
    np.testing.assert_allclose(run.speed, SPEED * np.pi / 30)
    other = hersey.read(path, channels={"speed": "motor/speed"})
    np.testing.assert_allclose(other.runs[0].speed, np.interp(TIME, TIME + 1, SPEED + 1)[100:] * np.pi / 30)
    assert other.files[0].warnings[0].kind == "clocks aligned"
    with h5py.File(path, "a") as file:
        file["motor/torque"] = TORQUE
        file["motor/torque"].attrs["unit"] = "N*m"
    with pytest.raises(
        ChannelError, match=r"torque column could be 'bench/torque .* or 'motor/torque .*\. Choose one with"
    ):
        hersey.read(path)
    assert hersey.read(path, channels={"torque": "bench/torque"}).rows == ROWS


def test_matrices_structs_and_compounds(tmp_path: Path) -> None:
    from scipy.io import savemat

    h5py = pytest.importorskip("h5py")
    table = np.column_stack([TIME, TORQUE, SPEED, TEMPERATURE])
    chosen = {"time": "data#1", "torque": "data#2", "speed": "data#3", "temperature": "data#4"}
    units = {"time": "s", "torque": "N*m", "speed": "rpm", "temperature": "degC"}
    savemat(tmp_path / "m.mat", {"data": table, "note": "hello"})
    assert_same(hersey.read(tmp_path / "m.mat", channels=chosen, units=units))
    rig = {"Torque": {"data": TORQUE, "unit": "N*m"}, "Speed": {"data": SPEED, "unit": "rpm"}}
    savemat(
        tmp_path / "s.mat", {"rig": rig | {"time": {"values": TIME, "units": "s"}, "temp_degC": TEMPERATURE}}
    )
    assert_same(hersey.read(tmp_path / "s.mat"))
    kinds = [("time_s", "f8"), ("torque_Nm", "f8"), ("speed_rpm", "f8"), ("temp_degC", "f8"), ("note", "S4")]
    rows = np.zeros(ROWS, dtype=kinds)
    for (name, _), values in zip(kinds[:4], table.T, strict=True):
        rows[name] = values
    with h5py.File(tmp_path / "c.h5", "w") as file:
        file["table"] = rows
    assert_same(hersey.read(tmp_path / "c.h5"))


@pytest.mark.parametrize("parts", [1, 4])
@pytest.mark.parametrize("x", [True, False])
@pytest.mark.parametrize(("separator", "decimal"), [("\t", "."), ("\t", ","), (",", ".")])
def test_lvm_in_segments(parts: int, x: bool, separator: str, decimal: str, tmp_path: Path) -> None:
    path = tmp_path / "a.lvm"
    path.write_bytes(lvm(parts, x, separator, decimal).encode("cp1252"))
    assert_same(hersey.read(path))


def test_a_missing_library_names_the_way_out() -> None:
    with pytest.raises(
        UnreadableLogError, match=r"HDF5 files needs h6py. Run pip install 'hersey\[formats\]'"
    ):
        library("h6py", "HDF5 files")


def test_channels_without_units_are_refused_with_what_the_file_holds(tmp_path: Path) -> None:
    from scipy.io import savemat

    savemat(tmp_path / "a.mat", {"t_s": TIME, "torque": TORQUE, "speed_rpm": SPEED})
    with pytest.raises(UnitError, match="column 'torque' has no unit"):
        hersey.read(tmp_path / "a.mat", isothermal=True)
    assert hersey.read(tmp_path / "a.mat", isothermal=True, units={"torque": "N*m"}).rows == ROWS
    savemat(tmp_path / "b.mat", {"t_s": TIME, "force_N": TORQUE})
    with pytest.raises(ChannelError, match=r"no torque column found. Columns: 't \[s\]', 'force \[N\]'"):
        hersey.read(tmp_path / "b.mat")


# Files by others -----------------------------------------------------------------------------------------


def test_tdms_by_labview() -> None:
    path = shared("data/daq-formats/tdms/raw_timestamps.tdms")
    with opened(path, kind_of(path)) as recording:
        (signal,) = recording.signals
        values, clock = signal.load(), signal.clock and signal.clock()
    assert (signal.name, signal.rows, values.size) == ("Untitled", 128, 128)
    np.testing.assert_allclose(clock, np.arange(128) * 0.001)
    digital = shared("data/daq-formats/tdms/Digital_Input.tdms")
    assert len(list_channels(digital)) == 3
    with pytest.raises(ChannelError, match=r"no torque column found. Columns:"):
        hersey.read(digital)


def test_mf4_by_others_keeps_every_raster() -> None:
    path = shared("data/daq-formats/mf4/ASAP2_Demo_V171.mf4")
    names = dict(list_channels(path))
    assert names["1/ASAM.M.SCALAR.UBYTE.FORM_X_PLUS_4"] == "rpm"
    with opened(path, kind_of(path)) as recording:
        by_group = {signal.group: signal for signal in recording.signals}
        assert {group: signal.rows for group, signal in by_group.items()} == {
            "0": 124, "1": 1240, "2": 12402, "3": 12402, "4": 12402, "5": 12402, "6": 2,
        }  # fmt: skip
        clock = by_group["1"].clock
        assert clock is not None
        steps = np.diff(clock())
        with pytest.raises(UnreadableLogError, match="holds text"):
            next(s for s in recording.signals if s.name.endswith("TAB_VERB_DEFAULT_VALUE")).load()
    np.testing.assert_allclose(steps, 0.01, rtol=1e-4)
    # channels of several rates, given roles by name: 1240 samples at 100 Hz decide, 10 Hz is interpolated
    log = hersey.read(
        path,
        channels={
            "torque": "1/ASAM_[15].M.MATRIX_DIM_16.UBYTE.IDENTICAL",
            "speed": "1/ASAM.M.SCALAR.UBYTE.FORM_X_PLUS_4",
            "temperature": "0/ASAM.M.SCALAR.SBYTE.IDENTICAL.DISCRETE",
        },
        units={"torque": "N*m", "temperature": "degC"},
    )
    assert log.rows == 1230
    aligned = [each.values for each in log.files[0].warnings if each.kind == "clocks aligned"]
    assert any((each["rate"], each["torque_rate"]) == ("10 Hz", "100 Hz") for each in aligned)


@pytest.mark.parametrize("name", ["2F6913DB_00000001.MF4", "94C49784_00000002.MF4"])
def test_a_bus_log_is_told_so(name: str) -> None:
    with pytest.raises(ChannelError, match=r"bus frames \(CAN_DataFrame\), not physical signals. Decode"):
        hersey.read(shared(f"data/daq-formats/mf4-bus/{name}"))


MATLAB = {
    "testdouble_4.2c_SOL2.mat": [("testdouble", "")],
    "testdouble_6.1_SOL2.mat": [("testdouble", "")],
    "testdouble_7.4_GLNX86.mat": [("testdouble", "")],
    "testhdf5_7.4_GLNX86.mat": [("testdouble", "")],
    "teststruct_7.4_GLNX86.mat": [("teststruct/doublefield", "")],
    "big_endian.mat": [("floats#1", ""), ("floats#2", "")],
    "testcell_7.4_GLNX86.mat": [("testcell#3", ""), ("testcell#4", "")],
}


@pytest.mark.parametrize("name", MATLAB)
def test_matlab_by_others(name: str) -> None:
    path = shared(f"data/daq-formats/mat/{name}")
    assert list_channels(path) == MATLAB[name]
    with opened(path, kind_of(path)) as recording:
        values = [signal.load() for signal in recording.signals]
    if "testdouble" in name or "testhdf5" in name:
        np.testing.assert_allclose(values[0], np.arange(9) * np.pi / 4, atol=1e-12)
    if name == "big_endian.mat":
        np.testing.assert_allclose(np.column_stack(values), [[2, 3], [3, 4]])
    with pytest.raises(ChannelError, match=r"no torque column found. Columns:"):
        hersey.read(path)


def test_the_matlab_files_of_scipy_are_read_or_refused_as_scipy_does() -> None:
    import scipy.io

    folder = Path(scipy.io.__file__).parent / "matlab" / "tests" / "data"
    if not folder.is_dir():
        pytest.skip("scipy was installed without its test data")
    read = 0
    for path in sorted(folder.glob("*.mat")):
        try:
            list_channels(path)
            read += 1
        except hersey.HerseyError as error:
            one_line(error, path)
            if "tables and timetables" in str(error):
                continue
            with pytest.raises(Exception):  # noqa: B017, PT011
                scipy.io.loadmat(path)
    assert read > 80


@pytest.mark.parametrize("kind_of_data", [4, 6, 137])
def test_a_wrong_type_in_a_matlab_file_does_not_end_python(kind_of_data: int, tmp_path: Path) -> None:
    """Scipy 1.17 ends with a segmentation fault on a type it does not know, which one flipped bit makes."""
    write_mat(tmp_path / "a.mat")
    data = bytearray((tmp_path / "a.mat").read_bytes())
    tag = data.index(b"\x09\x00\x00\x00\x40\x06\x00\x00")  # double, 1600 bytes
    data[tag] = kind_of_data
    (tmp_path / "a.mat").write_bytes(data)
    with pytest.raises(UnreadableLogError, match=r"a\.mat cannot be read as a MATLAB file"):
        hersey.read(tmp_path / "a.mat")


@pytest.mark.parametrize("suffix", [suffix for suffix in READERS if suffix != ".lvm"])
def test_a_damaged_file_is_called_what_its_owner_calls_it(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"no such thing\n" * 40)
    with pytest.raises(UnreadableLogError) as caught:
        hersey.read(path)
    one_line(caught.value, path)
    called = rf"a{suffix} cannot be read as {FILES[READERS[suffix]]} \([.a-z0-9, ]*{suffix}\b"
    assert re.match(called, str(caught.value))


def test_every_format_has_a_name_of_its_own() -> None:
    assert set(FILES) == set(READERS.values())
    assert not any(kind in name for kind, name in FILES.items())


def test_the_spring_pulled_slider_by_others() -> None:
    path = min(shared("data/stick-slip").glob("k1002Nm_v4300*.mat"))
    with pytest.raises(ChannelError, match=r"no torque column found. Columns: 'Fnorm', 't'"):
        hersey.read(path)
    roles = {"torque": "Fnorm", "speed": "Fnorm"}
    with pytest.raises(ChannelError, match="cannot be both"):
        hersey.read(
            path, channels=roles, units={"torque": "N*m", "speed": "rpm", "time": "s"}, isothermal=True
        )


@pytest.mark.parametrize("name", ["compound-dtype-complex.h5", "vlen_string_dset.h5"])
def test_hdf5_without_series_says_what_it_holds(name: str) -> None:
    with pytest.raises(ChannelError, match="no channel of numbers, only '"):
        hersey.read(shared(f"data/daq-formats/hdf5/{name}"))


def test_lvm_by_labview() -> None:
    path = shared("data/daq-formats/lvm/demo_1_labview.lvm.txt")
    assert list_channels(path) == [("fx_N", "N"), ("fy_N", "N"), ("fz_N", "N"), ("dx_um", "micrometer")]
    with opened(path, kind_of(path)) as recording:
        values = {signal.name: signal.load() for signal in recording.signals}
        (missing, *_) = recording.warnings
        clock = recording.signals[0].clock
        assert clock is not None
        with pytest.raises(UnreadableLogError, match="segment 2 starts at 0 s, before the previous one ends"):
            clock()  # shortened by hand: all three segments start at the same time
    assert (missing.kind, missing.values["samples"], missing.values["promised"]) == (
        "segment short",
        6,
        2000,
    )
    assert str(missing) == "Segment 1 of 3 has 6 samples instead of 2000."
    np.testing.assert_allclose(
        values["fx_N"][:6], [0.211219, 0.212512, 0.209925, 0.213159, 0.208631, 0.206690]
    )
    assert values["dx_um"].size == 18


def test_pin_on_disc_by_others() -> None:
    path = shared("data/friction/te67_pin_on_disc/PPS_60N_2.tsv")
    with pytest.raises(ChannelError, match=r"the time column could be 'Time \[s\]' or 'Test Time'"):
        hersey.read(path)  # for the torque there is one coefficient
    with pytest.raises(ChannelError, match="'Friction Force#1' or 'Friction Force#2'"):
        hersey.read(path, channels={"torque": "Friction Force"}, units={"torque": "0.022 N*m"})
    with pytest.raises(ChannelError, match=r"time column could be 'Time \[s\]' or 'Test Time'"):
        hersey.read(path, channels={"torque": "Friction Force#1"}, units={"torque": "0.022 N*m"})
    logs = [
        hersey.read(
            path,
            channels={
                "time": "Time",
                "torque": f"Friction Force#{copy}",
                "speed": "Speed",
                "temperature": "Specimen Temp",
            },
            units={"torque": "0.022 N*m", "speed": "rpm", "temperature": "degC"},  # radius 22 mm
        )
        for copy in (1, 2)
    ]
    run, file = logs[0].runs[0], logs[0].files[0]
    np.testing.assert_array_equal(run.torque, logs[1].runs[0].torque)
    assert run.time[0] == 0
    assert run.torque[1] == pytest.approx(1.3 * 0.022)
    assert run.temperature is not None
    assert run.temperature[0] == pytest.approx(25.9 + 273.15)
    warnings_by_kind = {each.kind: each.values for each in file.warnings}
    assert warnings_by_kind["time stamps read"]["since"] == "20:32:21"
    assert warnings_by_kind["lines below the table"]["first"] == "Test completed at 21:02:28 on 2019-04-12"
    assert not file.cut_off


def test_a_table_without_header_by_others() -> None:
    path = shared("data/friction/newport_oil_stribeck/Motor_oil_glass/1rps1N.txt")
    with pytest.raises(UnreadableLogError, match=r"line 2: there is no header .* name the columns by number"):
        hersey.read(path)
    log = hersey.read(
        path,
        channels={"time": "#2", "torque": "#4", "speed": "#6"},
        units={"time": "s", "torque": "N*m", "speed": "rev/s"},
        isothermal=True,
    )
    assert log.runs[0].torque[0] == -0.000320
    assert log.runs[0].speed[2] == pytest.approx(1.000837 * 2 * np.pi)


def test_the_couette_cell_has_no_torque() -> None:
    for path in sorted(shared("data/friction/couette_rheometer_pi").glob("*.csv")):
        with pytest.raises(ChannelError, match=r"no torque column found. Columns: 't \[s\]'"):
            hersey.read(path)


# Damage ---------------------------------------------------------------------------------------------------


def arrays(run: Run) -> list[np.ndarray[Any, np.dtype[np.float64]]]:
    assert run.temperature is not None
    return [run.time, run.torque, run.speed, run.temperature]


def one_line(error: hersey.HerseyError, path: Path) -> str:
    assert path.name in str(error)
    assert "\n" not in str(error)
    return str(error)


def attempt(path: Path) -> hersey.TorqueLog | str:
    """What a reader makes of a file: a log, or the message; anything else fails the test."""
    try:
        log = hersey.read(path)
    except hersey.HerseyError as error:
        return one_line(error, path)
    for run in log.runs:
        for values in arrays(run):
            assert values.size == run.time.size
            assert np.isfinite(values).all()
        assert (np.diff(run.time) >= 0).all()
    return log


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_cut_off_anywhere(name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    good = tmp_path / name
    WRITERS[name](good)
    data, whole = good.read_bytes(), arrays(hersey.read(good).runs[0])
    cut = tmp_path / f"cut{good.suffix}"
    for percent in range(100):
        cut.write_bytes(data[: len(data) * percent // 100])
        log = attempt(cut)
        if isinstance(log, str):
            continue
        (run,), (file,) = log.runs, log.files
        rows = run.time.size
        assert rows < ROWS
        ends_at_a_line = name == "a.csv" and cut.read_bytes().endswith(b"\n")
        assert ends_at_a_line or file.warnings
        for part, values in zip(arrays(run), whole, strict=True):
            # the last number of a text table may lack digits: a warning says so
            sure = rows - 1 if name == "a.csv" and not ends_at_a_line else rows
            np.testing.assert_allclose(part[:sure], values[:sure], rtol=1e-12)
    assert capfd.readouterr() == ("", "")


#: Of 200 copies with a flipped bit, how many at the most may change more rows than the one it stands in, or
#: those between the neighbours of a sample of a slow channel. No library here verifies a checksum, so a bit
#: in the rate of a clock, in a scale or in a compressed page cannot be noticed.
FAR = {"a.csv": 0, "a.mat": 0, "v73.mat": 0, "a.h5": 0, "a.lvm": 0, "a.tdms": 2, "a.mf4": 2, "a.parquet": 20}
NEAR = 20


@pytest.mark.parametrize("name", WRITERS)
def test_a_flipped_byte(name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    good = tmp_path / name
    WRITERS[name](good)
    data, reference = good.read_bytes(), hersey.read(good)
    whole = arrays(reference.runs[0])
    bad, random = tmp_path / f"bad{good.suffix}", np.random.default_rng(7)
    noticed = changed = far = 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(200):
            copy = bytearray(data)
            copy[int(random.integers(len(copy)))] ^= 1 << int(random.integers(8))
            bad.write_bytes(copy)
            log = attempt(bad)
            if isinstance(log, str) or log.files[0].warnings != reference.files[0].warnings:
                noticed += 1
            else:
                parts = arrays(log.runs[0])
                assert parts[0].size == ROWS, "rows are missing and nothing says so"
                rows = [np.flatnonzero(p != w) for p, w in zip(parts, whole, strict=True)]
                changed += any(r.size for r in rows)
                far += any(r.size and np.ptp(r) > NEAR for r in rows)
    assert far <= FAR[name]
    assert noticed > 0
    assert changed > 0
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    "name", ["tdms/raw_timestamps.tdms", "mf4/test_batch.mf4", "mat/testdouble_7.4_GLNX86.mat",
             "mat/testhdf5_7.4_GLNX86.mat", "mat/teststruct_7.4_GLNX86.mat", "hdf5/vlen_string_dset.h5",
             "lvm/demo_1_labview.lvm.txt"]
)  # fmt: skip
def test_damaged_files_by_others(name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    data = shared(f"data/daq-formats/{name}").read_bytes()
    path, random = tmp_path / Path(name).name, np.random.default_rng(11)
    copies = [data[: len(data) * percent // 100] for percent in range(100)]
    for _ in range(200):
        copy = bytearray(data)
        copy[int(random.integers(len(copy)))] ^= 1 << int(random.integers(8))
        copies.append(bytes(copy))
    for copy in copies:
        path.write_bytes(copy)
        try:
            if format_of(path) is None:  # its first bytes say nothing now: text
                list_channels(path)
                continue
            with opened(path, kind_of(path)) as recording:
                for signal in recording.signals:
                    signal.load()
                    if signal.clock:
                        signal.clock()
        except hersey.HerseyError as error:
            one_line(error, path)
    assert capfd.readouterr() == ("", "")
