"""Small files that hold a great deal, or say so: memory has a limit, which the message names."""

from __future__ import annotations

import contextlib
import io
import resource
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import HerseyError
from hersey.log import list_channels
from hersey.log.formats import opening
from tests.conftest import mostly_nightly
from tests.untrusted_input.mdf_blocks import Channel, mf4
from tests.untrusted_input.other_blocks import MAT5_HEAD, lvm, matrix, tdms, xlsx
from tests.untrusted_input.seeds import ROWS, SPEED, TABLE, TEMPERATURE, TIME, TORQUE
from tests.untrusted_input.watching import children, linux, peak_memory, processor_time

h5py = pytest.importorskip("h5py")
pytest.importorskip("nptdms")
pytest.importorskip("asammdf")
pytestmark = linux
#: What a process may hold beside the limit, bytes: Python and its libraries.
LIMIT, BESIDE = 2e9, 5e8
#: Processor time of a call, s.
MOST_TIME = 8.0


def zeros(count: int, head: bytes = b"") -> bytes:
    """A stream of zlib that holds a head and so many zeros, made without packing them all."""
    block = bytes(1 << 24)
    packer = zlib.compressobj(9)
    start = packer.compress(head) + packer.flush(zlib.Z_FULL_FLUSH)
    again = packer.compress(block) + packer.flush(zlib.Z_FULL_FLUSH)  # starts anew: it may stand many times
    total = zlib.adler32(head)
    for _ in range(count >> 24):
        total = zlib.adler32(block, total)
    rest = bytes(count & ((1 << 24) - 1))
    end = zlib.compressobj(9, zlib.DEFLATED, -15)
    last = end.compress(rest) + end.flush()
    return start + again * (count >> 24) + last + struct.pack(">I", zlib.adler32(rest, total))


def squeezed(head: bytes, count: int) -> bytes:
    """A compressed element of MATLAB: a head, then zeros."""
    data = zeros(count, head)
    return MAT5_HEAD + struct.pack("<II", 15, len(data)) + data


def matrix_head(rows: int, size: int) -> bytes:
    """The start of a column of ``rows`` doubles in an element of ``size`` bytes."""
    inner = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, rows, 1)
    inner += struct.pack("<II8s", 1, 6, b"torque") + struct.pack("<II", 9, min(8 * rows, 2**32 - 1))
    return struct.pack("<II", 14, size) + inner


def mat_honest() -> bytes:
    rows = 370_000_000
    return squeezed(matrix_head(rows, 8 * rows + 56), 8 * rows)


def mat_dishonest() -> bytes:
    return squeezed(matrix_head(10, 136), 3_000_000_000)


def mat_claims() -> bytes:
    return squeezed(matrix_head(500_000_000, 4_000_000_056), 1000)


def mat_inner() -> bytes:
    return MAT5_HEAD + matrix("torque", TORQUE, rows=2**31 - 1)


def mat_4() -> bytes:
    return struct.pack("<5i", 0, 2**31 - 1, 2**31 - 1, 0, 2) + b"t\0" + bytes(100)


def mat_text() -> bytes:
    return struct.pack("<5i", 1, 2**31 - 1, 1, 0, 2) + b"t\0" + bytes(100)


def hdf5(**kept: object) -> bytes:
    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:
        for name, unit in (("time", "s"), ("torque", "N*m"), ("speed", "rpm"), ("temperature", "degC")):
            file.create_dataset(name, dtype="<f8", **kept).attrs["units"] = unit
    return memory.getvalue()


def hdf5_petabyte() -> bytes:
    return hdf5(shape=(125_000_000_000_000,), chunks=(1 << 20,))


def hdf5_fill() -> bytes:
    return hdf5(shape=(10_000_000_000,), chunks=(1 << 20,), fillvalue=1.0)


def hdf5_zeros() -> bytes:
    memory, chunk = io.BytesIO(), zlib.compress(bytes(8 << 24), 9)
    with h5py.File(memory, "w") as file:
        for name, unit in (("time", "s"), ("torque", "N*m"), ("speed", "rpm"), ("temperature", "degC")):
            made = file.create_dataset(name, (100_000_000,), "<f8", chunks=(1 << 24,), compression="gzip")
            made.attrs["units"] = unit
            for start in range(0, 100_000_000, 1 << 24):
                made.id.write_direct_chunk((start,), chunk)
    return memory.getvalue()


def hdf5_matrix() -> bytes:
    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:
        file.create_dataset("torque", (256, 1_000_000_000), "<f8", chunks=(1, 1 << 20))
    return memory.getvalue()


def parquet() -> bytes:
    """Columns of one value: a run length for a thousand million rows."""
    import polars

    memory = io.BytesIO()
    rows = 33_000_000
    flat = polars.select(polars.repeat(1.0, rows)).to_series()
    time = polars.select(polars.repeat(0.0, rows)).to_series()
    names = {"Time [s]": time, "Torque [N*m]": flat, "Speed [rpm]": flat, "Temp [degC]": flat}
    frame = polars.DataFrame(names)
    frame.write_parquet(memory, compression="zstd", statistics=False)
    return memory.getvalue()


def mf4_packed() -> bytes:
    return mf4(_columns(), packed_length=3_000_000_000, packed=zeros(3_000_000_000), cycles=93_750_000)


def mf4_lying() -> bytes:
    return mf4(_columns(), packed_length=32 * ROWS, packed=zeros(3_000_000_000))


def mf4_claims() -> bytes:
    return mf4(_columns(), packed_length=2**62)


def mf4_cycles() -> bytes:
    return mf4(_columns(), cycles=2**40)


def mf4_most_cycles() -> bytes:
    return mf4(_columns(), cycles=2**64 - 1)


def _columns() -> list[Channel]:
    names = (("Torque", "N*m", TORQUE), ("Speed", "rpm", SPEED), ("Temp", "degC", TEMPERATURE))
    return [Channel("t", TIME, "s", kind=2), *(Channel(name, values, unit) for name, unit, values in names)]


def tdms_claims() -> bytes:
    return tdms(TABLE, count=2**62)


def tdms_many() -> bytes:
    return tdms(TABLE, count=10**10)


def tdms_segment() -> bytes:
    return tdms(TABLE, count=2**62, next_segment=2**63 - 1)


def lvm_wide() -> bytes:
    return lvm([(f"Torque {i}", "N*m", TORQUE[:2]) for i in range(100_000)])


def csv_wide() -> bytes:
    cells = [f"Torque {i} [N*m]" for i in range(100_000)]
    return (",".join(cells) + "\n" + ",".join(["1"] * 100_000) + "\n").encode() * 2


def lvm_long_cell() -> bytes:
    return lvm(TABLE).replace(b"1.001", b"9" * 3_000_000, 1)


def _workbook(sheet: str, strings: str = "") -> bytes:
    """A workbook of one sheet with this text in it, and a table of strings that its cells may name."""
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    memory, sound = io.BytesIO(), io.BytesIO(xlsx({"Run": [["Time [s]", "Torque [N*m]"], [0.0, 1.0]]}))
    with (
        zipfile.ZipFile(sound) as old,
        zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as new,
    ):
        for name in old.namelist():
            if not name.endswith("sheet1.xml"):
                new.writestr(name, old.read(name))
        new.writestr("xl/worksheets/sheet1.xml", f"<worksheet {space}>{sheet}</worksheet>")
        new.writestr("xl/sharedStrings.xml", f"<sst {space}>{strings}</sst>")
    return memory.getvalue()


def xlsx_corners() -> bytes:
    cells = '<c r="{0}{1}"><v>1</v></c>'
    rows = "".join(f'<row r="{n}">{cells.format(c, n)}</row>' for c, n in (("A", 1), ("XFD", 1_048_576)))
    return _workbook(f"<sheetData>{rows}</sheetData>")


def xlsx_strings() -> bytes:
    row = '<row r="{0}"><c r="A{0}" t="s"><v>0</v></c></row>'
    rows = "".join(row.format(number) for number in range(1, 20_001))
    return _workbook(f"<sheetData>{rows}</sheetData>", f"<si><t>{'a' * 1_000_000}</t></si>")


def xlsx_blanks() -> bytes:
    return _workbook(f"<sheetData>{' ' * 1_500_000_000}</sheetData>")


def npz(rows: int, stored: int) -> bytes:
    """An array that says it has so many rows, and a stream of so many zeros behind that."""
    memory = io.BytesIO()
    with (
        zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("torque.npy", "w", force_zip64=True) as member,
    ):
        head = {"descr": "<f8", "fortran_order": False, "shape": (rows,)}
        np.lib.format.write_array_header_1_0(member, head)
        for _ in range(stored >> 24):
            member.write(bytes(1 << 24))
    return memory.getvalue()


def npz_zeros() -> bytes:
    return npz(300_000_000, 2_400_000_000)


def npz_claims() -> bytes:
    return npz(2**50, 1 << 24)


#: Each with the ending of the file, what makes it, and whether memory is the reason for which it is refused.
BOMBS: dict[str, tuple[str, Callable[[], bytes], bool]] = {
    "a compressed element of 3 GB": (".mat", mat_honest, True),
    "one that says it is short": (".mat", mat_dishonest, False),
    "one that says it is long": (".mat", mat_claims, True),
    "a matrix that says it is long": (".mat", mat_inner, False),
    "one of version 4": (".mat", mat_4, False),
    "a text of version 4": (".mat", mat_text, False),
    "a data set of 1 PB": (".h5", hdf5_petabyte, True),
    "10,000 million rows of a fill value": (".h5", hdf5_fill, True),
    "zeros by gzip": (".h5", hdf5_zeros, True),
    "a matrix of 2 TB": (".h5", hdf5_matrix, False),
    "runs of one value": (".parquet", parquet, True),
    "a zipped block of 3 GB": (".mf4", mf4_packed, True),
    "one that says it is short, of MDF": (".mf4", mf4_lying, False),
    "one that says it is long, of MDF": (".mf4", mf4_claims, False),
    "a great many cycles": (".mf4", mf4_cycles, False),
    "the most cycles": (".mf4", mf4_most_cycles, False),
    "a segment that says 2^62 values": (".tdms", tdms_claims, False),
    "a segment that never ends": (".tdms", tdms_segment, False),
    "a sheet with far corners": (".xlsx", xlsx_corners, False),
    "a long word in many cells": (".xlsx", xlsx_strings, False),
    "a sheet of blanks": (".xlsx", xlsx_blanks, False),
    "2.4 GB of zeros": (".npz", npz_zeros, True),
    "an array that says it is long": (".npz", npz_claims, False),
    "100,000 columns of LabVIEW": (".lvm", lvm_wide, False),
    "100,000 columns of text": (".csv", csv_wide, False),
    "a cell of 3 million digits": (".lvm", lvm_long_cell, False),
}


#: Those of which three of four channels are within the limit.
LARGE = ("zeros by gzip", "runs of one value")
#: Those that cost a row alone.
ONE_ROW = ("a cell of 3 million digits",)


@contextlib.contextmanager
def measured() -> Iterator[dict[str, float]]:
    """Peaks of memory above what was held, here and there, and processor time."""
    Path("/proc/self/clear_refs").write_text("5")  # the peak starts anew
    here, spent, taken = peak_memory(), processor_time(), {}
    before = set(children())
    yield taken
    taken["here"] = peak_memory() - here
    taken["there"] = max([peak_memory(pid) for pid in set(children()) - before], default=0.0)
    taken["time"] = processor_time() - spent


#: Those that take longest, beside another of the same format and refusal.
LONGEST = (
    "zeros by gzip",
    "one that says it is short, of MDF",
    "a sheet of blanks",
    "a long word in many cells",
)


@pytest.mark.parametrize("bomb", mostly_nightly(BOMBS, *(BOMBS.keys() - {*LONGEST})))
def test_a_bomb(bomb: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ending, make, by_memory = BOMBS[bomb]
    path = tmp_path / f"log{ending}"
    path.write_bytes(make())
    monkeypatch.setattr(opening._Reader, "_waiting", [])
    ended = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024.0
    # what may be read is looked at as a whole, which takes its time: no bomb is needed for that
    for call in (list_channels, hersey.read, *([] if bomb in LARGE else [hersey.inspect])):
        told = ""
        with measured() as taken:
            try:
                done = call(path)
                if bomb in ONE_ROW and call is hersey.read:
                    told = " ".join([path.name, *map(str, done.files[0].warnings)])
            except HerseyError as error:
                told = str(error)
        assert taken["here"] < LIMIT, call
        assert taken["there"] < LIMIT + BESIDE
        assert taken["time"] < MOST_TIME + 2e-6 * path.stat().st_size
        assert "\n" not in told
        assert len(told) < 3000
        if call is hersey.read:
            assert path.name in told
            assert bomb not in ONE_ROW or "1 row was excluded" in told
            assert not by_memory or "memory_limit" in told
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024.0
    assert peak == ended or peak < LIMIT + BESIDE
    for reader in opening._Reader._waiting:
        reader.stop()


def test_a_segment_that_says_more_values_than_it_has_is_cut_off(tmp_path: Path) -> None:
    (tmp_path / "log.tdms").write_bytes(tdms(TABLE, count=10**10))
    log = hersey.read(tmp_path / "log.tdms")
    np.testing.assert_array_equal(log.runs[0].torque, TORQUE)
    assert log.files[0].cut_off
    assert "last segment incomplete" in [each.kind for each in log.files[0].warnings]


def test_the_limit_may_be_raised_and_lowered(tmp_path: Path) -> None:
    """A matrix of 240 MB, which takes a multiple of that while it is read."""
    rows = 30_000_000
    path = tmp_path / "log.mat"
    path.write_bytes(squeezed(matrix_head(rows, 8 * rows + 56), 8 * rows))
    with hersey.memory_limit("300 MB"), pytest.raises(HerseyError, match=r"0\.3 GB of memory.*memory_limit"):
        list_channels(path)
    assert list_channels(path) == [("torque", "")]
    with hersey.memory_limit("8 GB"):
        assert opening._memory == 8e9
        assert list_channels(path) == [("torque", "")]


@pytest.mark.nightly  # a smaller one is read and refused above, and a bomb at the usual limit
def test_what_exceeds_the_limit_is_read_with_a_higher_one(tmp_path: Path) -> None:
    """1.04 GB in a compressed element are too much for 2 GB, since they are held twice, and not for 8 GB."""
    rows = 130_000_000
    path = tmp_path / "log.mat"
    path.write_bytes(squeezed(matrix_head(rows, 8 * rows + 56), 8 * rows))
    with pytest.raises(HerseyError, match=r"2 GB of memory.*memory_limit\('8 GB'\)"):
        list_channels(path)
    with hersey.memory_limit("8 GB"):
        assert list_channels(path) == [("torque", "")]
