"""Entries of a folder: whole or absent, bounded, and shared by several processes."""

from __future__ import annotations

import errno
import os
import shutil
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hersey.cache import entries
from hersey.cache.encoding import Encoder
from hersey.cache.entries import Entries

KEY, OTHER = "a" * 64, "b" * 64
ARRAYS = {
    "rows": np.arange(12.0).reshape(3, 4),
    "columns": np.asfortranarray(np.arange(6.0).reshape(2, 3)),
    "part": np.arange(100.0).reshape(10, 10)[2:5, 3:6],
    "column": np.arange(8.0).reshape(4, 2)[:, 1],
    "none": np.empty((0, 3)),
    "one": np.array(1.5),
    "truths": np.array([True, False]),
    "texts": np.array(["a", "µm"]),
    "whole": np.arange(5, dtype=np.int16),
}


def keep(folder: Path, value: Any, key: str = KEY) -> Path:
    """Keep a value, and return its file."""
    encoder = Encoder()
    Entries(folder).write(key, encoder.encoded(value), encoder.arrays)
    return folder / f"{key}.kept"


def kept(folder: Path, key: str = KEY) -> Any:
    return Entries(folder).read(key, [])


def parts(folder: Path) -> list[Path]:
    """Files that are not whole."""
    return [path for path in folder.rglob("*") if path.name.endswith(".part")]


def test_arrays_come_back_with_their_layout(tmp_path: Path) -> None:
    keep(tmp_path, ARRAYS)
    (found,) = kept(tmp_path)
    for name, array in ARRAYS.items():
        assert found[name].dtype == array.dtype
        assert found[name].shape == array.shape
        assert array.size == 0 or found[name].strides == array.strides, name
        assert np.array_equal(found[name], array)
        assert found[name].flags.writeable
        found[name][...] = found[name]  # into memory that is its own


def test_the_folder_is_for_nobody_else(tmp_path: Path) -> None:
    file = keep(tmp_path / "of" / "ours", 1)
    assert stat.S_IMODE(file.parent.stat().st_mode) == 0o700


def test_what_is_not_there_is_absent(tmp_path: Path) -> None:
    assert kept(tmp_path) is None
    assert kept(tmp_path / "none") is None


def test_nothing_kept_is_not_the_same_as_absent(tmp_path: Path) -> None:
    keep(tmp_path, None)
    assert kept(tmp_path) == (None,)


def test_a_changed_byte_is_seen_wherever_it_is(tmp_path: Path) -> None:
    content = keep(tmp_path, ["a", 0.5, np.arange(3.0)]).read_bytes()
    file = tmp_path / f"{KEY}.kept"
    for place in range(len(content)):
        file.write_bytes(content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :])
        assert kept(tmp_path) is None, place
        assert not file.exists()  # so that it is written again


def test_a_file_that_was_cut_off_is_absent(tmp_path: Path) -> None:
    content = keep(tmp_path, ["a", 0.5, np.arange(3.0)]).read_bytes()
    file = tmp_path / f"{KEY}.kept"
    for size in range(len(content)):
        file.write_bytes(content[:size])
        assert kept(tmp_path) is None, size
    file.write_bytes(content + b"\0")
    assert kept(tmp_path) is None


def test_an_entry_of_another_key_is_absent(tmp_path: Path) -> None:
    keep(tmp_path, 1).rename(tmp_path / f"{OTHER}.kept")
    assert kept(tmp_path, OTHER) is None


def test_a_pipe_or_a_folder_in_its_place_is_absent(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / f"{KEY}.kept")
    assert kept(tmp_path) is None
    assert keep(tmp_path, 1).is_file()
    (tmp_path / f"{OTHER}.kept").mkdir()
    assert kept(tmp_path, OTHER) is None
    keep(tmp_path, 1, OTHER)
    assert kept(tmp_path, OTHER) is None


def test_where_nothing_can_be_written_nothing_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("no folder")
    keep(tmp_path / "file" / "cache", 1)
    assert kept(tmp_path / "file" / "cache") is None

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    keep(tmp_path, 1)
    assert list(tmp_path.iterdir()) == [tmp_path / "file"]


def test_an_entry_takes_no_large_share_of_the_free_space(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=100_000))
    assert keep(tmp_path, np.zeros(1000)).exists()
    assert not keep(tmp_path, np.zeros(2000), OTHER).exists()


def test_an_interrupt_leaves_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        keep(tmp_path, 1)
    assert list(tmp_path.iterdir()) == []


def test_an_entry_stays_whole_while_it_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever reads while another process writes finds what was there before, not a part of what will be."""
    keep(tmp_path, 1)
    pieces, seen = entries._pieces, []

    def slowly(text: bytes, arrays: Any) -> Iterator[Any]:
        for piece in pieces(text, arrays):
            yield piece
            seen.append(kept(tmp_path))

    monkeypatch.setattr(entries, "_pieces", slowly)
    keep(tmp_path, 2)
    assert len(seen) > 2
    assert set(seen) == {(1,)}
    assert kept(tmp_path) == (2,)


def test_the_least_recently_used_go_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(entries, "LIMIT", 25_000)
    keys = [f"{number:064x}" for number in range(6)]
    for number, key in enumerate(keys[:5]):
        file = keep(tmp_path, np.zeros(1000), key)  # 8 kB and a little
        os.utime(file, (1e9 + number, 1e9 + number))
        if number == 2:  # used last, although it was written first
            assert kept(tmp_path, keys[0]) is not None
    keep(tmp_path, np.zeros(1000), keys[5])
    left = [key for key in keys if (tmp_path / f"{key}.kept").exists()]
    assert left == [keys[0], keys[4], keys[5]]
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) <= 25_000


def test_there_are_so_many_entries_at_the_most(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(entries, "_MOST", 3)
    for number in range(6):
        keep(tmp_path, number, f"{number:064x}")
    assert len(list(tmp_path.iterdir())) == 3


def test_files_of_others_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(entries, "LIMIT", 0)
    others = [tmp_path / name for name in ("notes.txt", "x.kept", f".{KEY}.kept.part", ".notes.part")]
    for other in others:
        other.write_text("mine")
        os.utime(other, (0, 0))
    abandoned, busy = (tmp_path / f".{key}.kept.{'0' * 16}.part" for key in (KEY, OTHER))
    for part in (abandoned, busy):
        part.write_text("half")
    os.utime(abandoned, (0, 0))
    keep(tmp_path, 1)
    assert sorted(tmp_path.iterdir()) == sorted([*others, busy])


_WRITER = """
import sys
from collections.abc import Iterator
from pathlib import Path
import numpy as np
from hersey.cache.encoding import Encoder
from hersey.cache.entries import Entries
folder = Path(sys.argv[1])
for turn in range(100):
    key = f"{turn % 5:064x}"
    encoder = Encoder()
    Entries(folder).write(key, encoder.encoded([turn % 5, np.full(2000, turn % 5)]), encoder.arrays)
    found = Entries(folder).read(key, [])
    if found is not None:
        assert found[0][0] == turn % 5 and (found[0][1] == turn % 5).all()
print("done")
"""


def test_several_processes_write_and_read_at_once(tmp_path: Path) -> None:
    command = [sys.executable, "-c", _WRITER, str(tmp_path)]
    writers = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [writer.communicate(timeout=120)[0] for writer in writers] == ["done\n"] * 3
    assert [kept(tmp_path, f"{number:064x}")[0][0] for number in range(5)] == [*range(5)]
    assert parts(tmp_path) == []
