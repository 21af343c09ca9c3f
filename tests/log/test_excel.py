"""Workbooks, arrays of NumPy and cells of MATLAB: what engineers keep beside text."""

from __future__ import annotations

import csv
import io
import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.errors import ChannelError, UnreadableLogError
from hersey.log import list_channels
from hersey.log.formats import format_of, opened
from hersey.log.means import is_means_table, read_means
from hersey.log.recording import LONGEST_CELL
from tests.conftest import shared
from tests.untrusted_input.other_blocks import xlsx

pytest.importorskip("fastexcel")
HEAD = ["Time [s]", "Torque [N*m]", "Speed [rpm]", "Temp [degC]", "Remark"]
ROWS = 120


def rows() -> list[list[Any]]:
    return [[i * 0.1, 1.0 + 0.01 * i, 60.0 + i, 150.0 + 0.1 * i, "ok"] for i in range(ROWS)]


def workbook(path: Path, **sheets: list[list[Any]]) -> Path:
    path.write_bytes(xlsx(sheets))
    return path


def assert_same(log: hersey.TorqueLog) -> None:
    (run,) = log.runs
    table = np.array([row[:4] for row in rows()])
    assert run.temperature is not None
    np.testing.assert_allclose(run.time, table[:, 0], rtol=1e-12)
    np.testing.assert_allclose(run.torque, table[:, 1], rtol=1e-12)
    np.testing.assert_allclose(run.speed, table[:, 2] * np.pi / 30, rtol=1e-12)
    np.testing.assert_allclose(run.temperature, table[:, 3] + 273.15, rtol=1e-12)


def test_a_sheet_is_read_whatever_stands_above_its_table(tmp_path: Path) -> None:
    above = [["Rig 3", "by me"], [], ["Serial", 12]]
    path = workbook(tmp_path / "a.xlsx", Notes=[["Operator", "me"]], Run=[*above, HEAD, *rows()])
    assert_same(hersey.read(path))
    assert_same(hersey.read(path.rename(tmp_path / "export.dat")))  # the first bytes tell
    assert list_channels(tmp_path / "export.dat")[1] == ("Torque", "N*m")
    names, units = ["t", "Tq", "n", "T1 temp"], ["s", "N*m", "rpm", "degC"]
    assert_same(hersey.read(workbook(tmp_path / "u.xlsx", Run=[names, units, *(r[:4] for r in rows())])))


def test_the_sheet_with_torque_and_speed_is_taken_or_asked_for(tmp_path: Path) -> None:
    calibration = [["Load [kg]", "Torque [N*m]"], *([float(i), 0.1 * i] for i in range(30))]
    path = workbook(tmp_path / "two.xlsx", Calibration=calibration, Run=[HEAD, *rows()])
    assert_same(hersey.read(path))
    path = workbook(tmp_path / "three.xlsx", First=[HEAD, *rows()[:50]], Second=[HEAD, *rows()])
    with pytest.raises(
        ChannelError, match=r"'First/Torque .* or 'Second/Torque .*\. Choose one with channels="
    ):
        hersey.read(path)
    assert_same(hersey.read(path, channels={"torque": "Second/Torque"}))


@pytest.mark.parametrize("bad", ["OVERFLOW", "#N/A", None, 1e99])
def test_one_bad_cell_costs_its_row(bad: object, tmp_path: Path) -> None:
    table = rows()
    table[40][1] = bad
    log = hersey.read(workbook(tmp_path / "a.xlsx", Run=[["Rig 3"], [], HEAD, *table]))
    assert (log.rows, log.files[0].missing_rows) == (ROWS - 1, 1)
    assert any("excluded: channel 'Torque', row 44: " in str(each) for each in log.files[0].warnings)
    if bad == "OVERFLOW":
        odd = log.files[0].warnings[0]
        assert (odd.kind, odd.values["row"], odd.values["cell"]) == ("cell that is no number", 44, bad)
        assert str(odd) == "Row 44, column 'Torque': 'OVERFLOW' is not a number."


def test_rows_count_from_the_first_of_the_sheet_and_a_summary_is_none(tmp_path: Path) -> None:
    table = rows()
    table[40][1] = "OVERFLOW"
    log = hersey.read(
        workbook(tmp_path / "a.xlsx", Run=[[], [], HEAD, *table, [], *[["Mean", 1.5, 60.0]] * 5])
    )
    assert (log.rows, log.files[0].missing_rows) == (ROWS - 1, 1)
    below, *others = log.files[0].warnings
    assert (below.kind, below.values["lines"]) == ("lines below the table", 5)
    assert str(below).startswith("5 rows below the table were skipped: 'Mean")
    assert "Row 44, column 'Torque': 'OVERFLOW' is not a number." in map(str, others)


def test_dates_of_a_sheet_are_times(tmp_path: Path) -> None:
    dated = [[(45352.0 + row[0] / 86400,), *row[1:]] for row in rows()]
    path = workbook(tmp_path / "d.xlsx", Run=[["Date", *HEAD[1:]], *dated])
    log = hersey.read(path)
    np.testing.assert_allclose(log.runs[0].time, np.arange(ROWS) * 0.1, atol=1e-3)
    assert any(
        "an ISO date and was read as seconds since 2024-03-01" in str(each) for each in log.files[0].warnings
    )


def test_a_workbook_without_a_table_says_what_it_holds(tmp_path: Path) -> None:
    path = workbook(tmp_path / "n.xlsx", Notes=[["Operator", "me"]], More=[["a", "b"], ["c", "d"]])
    with pytest.raises(ChannelError, match=r"n\.xlsx has no channel of numbers, only sheet 'Notes' "):
        hersey.read(path)


def test_rheometer_workbooks_by_others() -> None:
    folder = shared("data/rheology/rheofit_flow_curve")
    assert dict(list_channels(folder / "Flow_curve_example.xls"))["Flow sweep - 1/Stress"] == "Pa"
    path = folder / "10sle1s_85castoroil-3.xls"
    with pytest.raises(ChannelError, match="torque column could be 'Amplitude sweep - 1/Oscillation torque"):
        hersey.read(path)
    log = hersey.read(
        path,
        channels={"torque": "Flow sweep - 2/Torque", "speed": "Flow sweep - 2/Shear rate"},
        units={"speed": "rad/s"},
        isothermal=True,
    )
    assert log.runs[0].torque[0] == pytest.approx(16042.9e-6)


def test_an_archive_of_another_kind_names_the_way_out(tmp_path: Path) -> None:
    path = tmp_path / "logs.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("bench.csv", "t,T\n")
    with pytest.raises(UnreadableLogError, match=r"logs\.zip is an archive. Unpack it"):
        hersey.read(path)


ARRAYS = {
    "t_s": np.arange(ROWS) * 0.1,
    "torque_Nm": 1.0 + 0.01 * np.arange(ROWS),
    "speed_rpm": 60.0 + np.arange(ROWS),
    "temp_degC": 150.0 + 0.1 * np.arange(ROWS),
}


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_of_numpy(save: Any, tmp_path: Path) -> None:
    save(tmp_path / "a.npz", **ARRAYS, note="by me")
    assert_same(hersey.read(tmp_path / "a.npz"))
    table = np.column_stack(list(ARRAYS.values()))
    np.save(tmp_path / "a.npy", table)
    chosen = dict(
        zip(("time", "torque", "speed", "temperature"), (f"array#{i}" for i in (1, 2, 3, 4)), strict=True)
    )
    units = {"time": "s", "torque": "N*m", "speed": "rpm", "temperature": "degC"}
    assert_same(hersey.read(tmp_path / "a.npy", channels=chosen, units=units))
    fields = np.rec.fromarrays(list(ARRAYS.values()), names=list(ARRAYS))
    np.save(tmp_path / "fields.npy", np.asfortranarray(fields))
    assert_same(hersey.read(tmp_path / "fields.npy"))


def test_pickles_in_arrays_of_numpy_are_never_loaded(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[Any, ...]:
            return (Path.touch, (tmp_path / "sprung",))

    memory = io.BytesIO()
    np.lib.format.write_array_header_1_0(memory, {"descr": "|O", "fortran_order": False, "shape": (1,)})
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("torque.npy", memory.getvalue() + pickle.dumps(Trap()))
    with pytest.raises(ChannelError, match=r"'torque' .Python objects, which only pickle could load."):
        hersey.read(tmp_path / "a.npz")
    np.save(tmp_path / "b.npy", np.array([(1.0, Trap())], dtype=[("x", "f8"), ("y", "O")]), allow_pickle=True)
    with pytest.raises(ChannelError, match=r"'array' .Python objects, which only pickle could load."):
        hersey.read(tmp_path / "b.npy")
    assert not (tmp_path / "sprung").exists()


def test_film_thickness_of_others_in_an_npz() -> None:
    path = shared("data/ehd-film/demo_ehd_data.npz")
    assert format_of(path) == "numpy_arrays"
    assert dict(list_channels(path))["rolling_speed"] == "mm/s"
    with pytest.raises(ChannelError, match=r"could be 'ball_speed_1' or 'disc_speed_1'.* no unit for"):
        hersey.read(path)


def cells(*rows: list[Any]) -> Any:
    array = np.empty((len(rows), len(rows[0])), dtype=object)
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            array[i, j] = cell
    return array


UNITS = {"t": "s", "torque": "N*m", "speed": "rpm", "temp": "degC"}
LISTED = [[name, unit, values] for (name, unit), values in zip(UNITS.items(), ARRAYS.values(), strict=True)]
CELLS = {
    "a channel in each row": cells(*LISTED),
    "a channel in each column": cells(*LISTED).T,
    "names with units": cells(*([f"{name} [{unit}]", values] for name, unit, values in LISTED)),
    "a table": cells(list(UNITS), list(UNITS.values()), *np.column_stack(list(ARRAYS.values())).tolist()),
    "a table, units in the names": cells(
        [f"{name} ({unit})" for name, unit in UNITS.items()], *np.column_stack(list(ARRAYS.values())).tolist()
    ),
    "structs": cells([{"data": values, "unit": unit} for _, unit, values in LISTED]),
}


@pytest.mark.parametrize("case", CELLS)
def test_cells_of_matlab(case: str, tmp_path: Path) -> None:
    from scipy.io import savemat

    savemat(tmp_path / "a.mat", {"rig": CELLS[case], "note": "hello"})
    named = {"time": "rig#1", "torque": "rig#2", "speed": "rig#3", "temperature": "rig#4"}
    assert_same(hersey.read(tmp_path / "a.mat", channels=named if case == "structs" else None))


MEANS = [
    ["Run", "Speed [rpm]", "Torque [mN*m]", "Torque error", "Temp [degC]", "Approach", "n", "Remark"],
    ["new roll", 10.0, 5.0, 0.1, 120.0, "up", 12.0, "first try"],
    ["new roll", 20.5, 5.6, 0.1, 121.25, "up", 11.0, None],
    ["new roll", 40.0, 6.3, 0.2, 122.0, "start", 12.0, "ok"],
    ["old roll", 40.0, "n/a", 0.2, 122.0, "Down", 12.0, "cable off"],
    ["old roll", 20.0, 5.7, 0.1, 121.0, "falling", 12.0, "ok"],
    ["old roll", None, 5.1, 0.1, 120.0, "down", 12.0, "ok"],
    ["old roll", 10.0, 5.1, 0.1, 120.0, "from above", 12.0, 'a "quoted" \N{GREEK SMALL LETTER MU}'],
]


def delimited(table: list[list[Any]], path: Path) -> Path:
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["" if cell is None else cell for cell in row] for row in table])
    return path


@pytest.mark.parametrize(
    "numbers", [str, float, lambda x: str(x).replace(".", ",")], ids=["text", "numbers", "commas"]
)
def test_means_of_a_workbook_are_those_of_the_same_cells_in_a_text(numbers: Any, tmp_path: Path) -> None:
    """Words too: runs by name, the approach; rows left out, and why."""
    head, *table = MEANS
    sheet = [[numbers(cell) if isinstance(cell, float) else cell for cell in row] for row in table]
    book = workbook(
        tmp_path / "means.xlsx", Notes=[["Operator", "me"]], Means=[["~ SYNTHETIC"], head, *sheet]
    )
    text = delimited([["~ SYNTHETIC"], *MEANS], tmp_path / "means.csv")
    assert is_means_table(book, {}, {})
    assert is_means_table(text, {}, {})
    of_book, of_text = (read_means(path) for path in (book, text))
    assert of_book.means == of_text.means
    assert [row.run for row in of_book.means] == [0, 0, 0, 1, 1]
    assert [row.approach for row in of_book.means] == ["from below"] * 2 + ["start"] + ["from above"] * 2
    assert of_book.stated_errors
    (first,), (second,) = of_book.files, of_text.files
    assert (first.warnings, first.comments, first.missing_rows) == (second.warnings, second.comments, 2)
    assert first.comments == ("SYNTHETIC",)
    assert first.warnings[-1].values["rows"] == 2
    assert "row 4 (torque 'n/a'), row 6 (no speed)" in str(first.warnings[-1])


def test_a_cell_of_a_workbook_is_cut_where_no_name_is_as_long(tmp_path: Path) -> None:
    long = [[*row[:-1], "é" * 5000 if row[-1] else None] for row in MEANS[1:]]
    path = workbook(tmp_path / "long.xlsx", Means=[MEANS[0], *long])
    with opened(path, "excel") as recording:
        remark = recording.cells[-1]
        assert (remark.name, remark.load()[0]) == ("Remark", "é" * LONGEST_CELL)
    assert len(read_means(path).means) == 5
