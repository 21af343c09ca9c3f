"""The bytes of the file that was named are read, no others: neither by links in it, nor by its name."""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.errors import HerseyError, MissingFileError, printable
from hersey.log import list_channels
from tests.untrusted_input.other_blocks import tdms
from tests.untrusted_input.seeds import COLUMNS, ROWS, SEEDS, SPEED, TORQUE
from tests.untrusted_input.watching import linux

h5py = pytest.importorskip("h5py")
pytest.importorskip("nptdms")
pytest.importorskip("asammdf")
UNITS = dict(zip(COLUMNS, ("s", "N*m", "rpm", "degC"), strict=True))


def assert_read(path: Path | str, scale: float = 1.0) -> None:
    """The log's torque is that of the sound files times a factor, its hash that of the bytes."""
    log = hersey.read(path)
    np.testing.assert_allclose(log.runs[0].torque, scale * TORQUE, atol=1e-6)
    content = Path(path).read_bytes()
    assert (log.files[0].sha256, log.files[0].bytes) == (hashlib.sha256(content).hexdigest(), len(content))
    assert log.files[0].name == printable(Path(path).name)


def write(path: Path, change: Callable[[Any], None], *, matlab: bool) -> Path:
    """An HDF5 file without torque, to which ``change`` adds one."""
    with h5py.File(path, "w", userblock_size=512 if matlab else 0) as file:
        for name, values in COLUMNS.items():
            if name != "torque_Nm":
                file[name] = values
                file[name].attrs["units"] = UNITS[name]
        change(file)
        if "torque_Nm" in file and isinstance(file.get("torque_Nm"), h5py.Dataset):
            file["torque_Nm"].attrs["units"] = "N*m"
    if matlab:
        content = bytearray(path.read_bytes())
        content[:19] = b"MATLAB 7.3 MAT-file"
        path.write_bytes(content)
    return path


def _stored_outside(file: Any) -> None:
    file.create_dataset("torque_Nm", (ROWS,), "<f8", external=[("torque.bin", 0, 8 * ROWS)])


def _stored_in_a_file_of_the_system(file: Any) -> None:
    file.create_dataset("torque_Nm", (ROWS,), "<u1", external=[("/etc/passwd", 0, ROWS)])


def _virtual(file: Any) -> None:
    layout = h5py.VirtualLayout((ROWS,), "<f8")
    layout[:] = h5py.VirtualSource("other.h5", "torque", (ROWS,))
    file.create_virtual_dataset("torque_Nm", layout)


def _virtual_of_itself(file: Any) -> None:
    file["kept"] = TORQUE
    layout = h5py.VirtualLayout((ROWS,), "<f8")
    layout[:] = h5py.VirtualSource(".", "kept", (ROWS,))
    file.create_virtual_dataset("torque_Nm", layout)


def _linked(file: Any) -> None:
    file["torque_Nm"] = h5py.ExternalLink("other.h5", "/torque")


def _group_linked(file: Any) -> None:
    file["rig"] = h5py.ExternalLink("other.h5", "/")


def _linked_in_a_group(file: Any) -> None:
    file.create_group("a/b")["torque_Nm"] = h5py.ExternalLink("other.h5", "/torque")


def _soft_to_a_link(file: Any) -> None:
    file["elsewhere"] = h5py.ExternalLink("other.h5", "/torque")
    file["torque_Nm"] = h5py.SoftLink("/elsewhere")


OUTSIDE = [
    _stored_outside, _stored_in_a_file_of_the_system, _virtual, _virtual_of_itself, _linked, _group_linked,
    _linked_in_a_group, _soft_to_a_link,
]  # fmt: skip


@pytest.mark.parametrize("change", OUTSIDE)
@pytest.mark.parametrize("matlab", [False, True])
def test_numbers_in_another_file_are_refused(
    change: Callable[[Any], None], matlab: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    TORQUE.tofile("torque.bin")
    with h5py.File("other.h5", "w") as other:
        other["torque"] = TORQUE
        other["torque"].attrs["units"] = "N*m"
    path = write(tmp_path / "log.h5", change, matlab=matlab)
    for call in (hersey.read, list_channels, hersey.inspect):
        with pytest.raises(HerseyError, match=r"log\.h5: .*another (place|file).*h5repack"):
            call(path)


@pytest.mark.parametrize("matlab", [False, True])
def test_links_in_circles(matlab: bool, tmp_path: Path) -> None:
    def turn(file: Any) -> None:
        file["torque_Nm"] = TORQUE
        file["loop"] = h5py.SoftLink("/loop")
        file["ping"], file["pong"] = h5py.SoftLink("/pong"), h5py.SoftLink("/ping")
        group = file.create_group("group")
        group["up"] = file["/"]
        group["itself"] = group
        file["again"] = h5py.SoftLink("/torque_Nm")
        file["nothing"] = h5py.SoftLink("/not/there")

    path = write(tmp_path / "log.h5", turn, matlab=matlab)
    assert len(list_channels(path)) == 4
    assert_read(path)


def test_an_index_beside_a_tdms_file_is_not_read(tmp_path: Path) -> None:
    from nptdms import TdmsFile

    path = tmp_path / "log.tdms"
    path.write_bytes(SEEDS["run.tdms"]())
    lied = tdms([("Torque", "N*m", 7 * TORQUE), ("Speed", "rpm", SPEED), ("Temp", "degC", SPEED)], step=0.5)
    index = lied[: 28 + int.from_bytes(lied[20:28], "little")].replace(b"TDSm", b"TDSh", 1)
    path.with_suffix(".tdms_index").write_bytes(index)
    assert_read(path)
    assert hersey.read(path).runs[0].time[1] == pytest.approx(0.01)
    with TdmsFile.open(path) as file:  # the library by itself believes the index
        assert file["Rig"]["Torque"].properties["wf_increment"] == 0.5


NAMES = [
    "run[1]", "run*", "*", "?", "[a-z]*", "{a,b}", "**", "-run", "--help", "~", "~root", "$HOME", "%s", " ",
    "a\nb", "a\tb", "'", '"', "a;b", "s3:run", "s3:/bucket/run", "http:/localhost/run", "file:/etc/run",
    "torque=5/run", "a\\b", "\N{RIGHT-TO-LEFT OVERRIDE}run", "\x1b[2J", "x" * 200, "\udcff\udcfe",
]  # fmt: skip
ENDINGS = {
    ".parquet": "run.parquet", ".csv": "comma.csv", ".mf4": "packed.mf4", ".h5": "run.h5", ".mat": "v5.mat",
    ".tdms": "run.tdms", ".lvm": "run.lvm",
}  # fmt: skip


@linux
@pytest.mark.parametrize("ending", ENDINGS)
def test_a_name_is_no_pattern(ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside a file of any name stand others that a pattern would take, with other numbers."""
    monkeypatch.chdir(tmp_path)
    sound = SEEDS[ENDINGS[ending]]()
    decoys = ("run1", "runaway", "a", "b", "run", "zz")
    for decoy in decoys:
        Path(f"{decoy}{ending}").write_bytes(sound[: len(sound) // 2])
    for stem in NAMES:
        path = Path(f"{stem}{ending}")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(sound)
        assert_read(path)
        assert_read(str(path))
        path.unlink()


@linux
def test_the_longest_name(tmp_path: Path) -> None:
    path = tmp_path / ("x" * 247 + ".parquet")
    path.write_bytes(SEEDS["run.parquet"]())
    assert_read(path)
    with pytest.raises(MissingFileError, match="cannot be read"):
        hersey.read(tmp_path / ("x" * 300 + ".parquet"))
    with pytest.raises(HerseyError):
        hersey.read(tmp_path / "a\0b.parquet")


@linux
@pytest.mark.parametrize("ending", ENDINGS)
def test_a_link_is_the_file_that_it_leads_to(ending: str, tmp_path: Path) -> None:
    (tmp_path / f"real{ending}").write_bytes(SEEDS[ENDINGS[ending]]())
    (tmp_path / f"link{ending}").symlink_to(tmp_path / f"real{ending}")
    (tmp_path / f"hard{ending}").hardlink_to(tmp_path / f"real{ending}")
    assert_read(tmp_path / f"link{ending}")
    assert_read(tmp_path / f"hard{ending}")
    (tmp_path / f"loop{ending}").symlink_to(tmp_path / f"loop{ending}")
    (tmp_path / f"broken{ending}").symlink_to(tmp_path / "nothing")
    for name in ("loop", "broken"):
        with pytest.raises(MissingFileError):
            hersey.read(tmp_path / f"{name}{ending}")


@linux
@pytest.mark.parametrize("ending", ENDINGS)
def test_what_is_no_ordinary_file_is_refused(ending: str, tmp_path: Path) -> None:
    """None is waited for, and none read without an end."""
    (tmp_path / f"folder{ending}").mkdir()
    os.mkfifo(tmp_path / f"pipe{ending}")
    for name in ("zero", "full", "null", "stdin", "urandom", "tty"):
        (tmp_path / f"{name}{ending}").symlink_to(f"/dev/{name}")
    for path in sorted(tmp_path.iterdir()):
        for call in (hersey.read, list_channels, hersey.inspect):
            with pytest.raises(MissingFileError):
                call(path)


@linux
@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("name", ["status", "maps", "environ", "mem", "stat", "mountinfo"])
def test_files_of_the_kernel_are_no_logs(ending: str, name: str, tmp_path: Path) -> None:
    """Their size is 0, whatever they hold."""
    path = tmp_path / f"log{ending}"
    path.symlink_to(f"/proc/self/{name}")
    for call in (hersey.read, list_channels, hersey.inspect):
        with pytest.raises(HerseyError, match=r"log\."):
            call(path)


def test_a_table_that_grows_out_of_a_file_without_size(tmp_path: Path) -> None:
    """What is read is what was hashed, also where the size of a file says 0 and it holds a table."""
    path = tmp_path / "log.csv"
    path.write_bytes(b"")
    with pytest.raises(HerseyError, match=r"log\.csv"):
        hersey.read(path)


def test_hdf5_in_memory_of_another(tmp_path: Path) -> None:
    """A file in a file: the outer one is read."""
    inner = SEEDS["run.h5"]()
    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:
        file["blob"] = np.frombuffer(inner, dtype=np.uint8)
    (tmp_path / "log.h5").write_bytes(memory.getvalue())
    assert list_channels(tmp_path / "log.h5") == [("blob", "")]


def test_a_folder_with_hives(tmp_path: Path) -> None:
    """Folders called as a hive's partitions add no column."""
    folder = tmp_path / "speed=9" / "torque_Nm=5"
    folder.mkdir(parents=True)
    (folder / "run.parquet").write_bytes(SEEDS["run.parquet"]())
    assert len(list_channels(folder / "run.parquet")) == 4
    assert_read(folder / "run.parquet")
