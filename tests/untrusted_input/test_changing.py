"""A file that changes while it is read: an error or a warning; the hash is that of the bytes read."""

from __future__ import annotations

import hashlib
import itertools
import mmap
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.errors import HerseyError
from hersey.files.reading import OpenFile
from hersey.log.formats import opening
from tests.conftest import mostly_nightly
from tests.untrusted_input.seeds import SEEDS, SPEED, TORQUE
from tests.untrusted_input.watching import linux

pytest.importorskip("h5py")
pytest.importorskip("nptdms")
pytest.importorskip("asammdf")
pytestmark = linux
BINARY = [
    *("run.lvm", "run.tdms", "run.mf4", "run.mdf", "v4.mat", "v5.mat", "v73.mat", "run.h5", "run.parquet"),
]
TEXT = ["comma.csv", "tab.txt", "stamps.csv"]
#: Text is read in one piece: nothing comes after.
MOMENTS = ("opened", "hashed", "listed", "loading")
YOUNG, OLD = 0, 3600  # age of a file when it is opened, s


def doubled(sound: bytes) -> bytes:
    """The same file with another torque, of the same size."""
    swaps = [
        (TORQUE.tobytes(), SPEED.tobytes()),
        (b"0.1 * X", b"0.2 * X"),  # formulas
        (b"0.1*X1", b"0.2*X1"),
        (b"1.0016", b"1.0018"),
        ("1.0016".encode("utf-16-le"), "1.0018".encode("utf-16-le")),
    ]
    other = next(sound.replace(*swap) for swap in swaps if swap[0] in sound)
    assert len(other) == len(sound)
    return other


def truncated(path: Path, sound: bytes) -> None:
    os.truncate(path, len(sound) // 2)


def emptied(path: Path, _: bytes) -> None:
    os.truncate(path, 0)


def grown(path: Path, sound: bytes) -> None:
    with path.open("ab") as file:
        file.write(sound[-200:])


def rewritten(path: Path, sound: bytes) -> None:
    """In place, with the same size and the old time."""
    before = path.stat()
    with path.open("r+b") as file:
        file.write(doubled(sound))
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


def replaced(path: Path, sound: bytes) -> None:
    before = path.stat()
    other = path.with_name("other")
    other.write_bytes(doubled(sound))
    os.utime(other, ns=(before.st_atime_ns, before.st_mtime_ns))
    other.replace(path)


def removed(path: Path, _: bytes) -> None:
    path.unlink()


CHANGES = [truncated, emptied, grown, rewritten, replaced, removed]


def what_was_told(path: Path, sound: bytes) -> str:
    """The error, or the warnings: then what was read has the hash of its bytes."""
    try:
        log = hersey.read(path)
    except HerseyError as error:
        return str(error)
    assert log.files[0].sha256 == hashlib.sha256(sound).hexdigest()
    np.testing.assert_allclose(log.runs[0].torque, TORQUE, atol=1e-6)
    return "; ".join(map(str, log.files[0].warnings))


def once(change: Callable[[], None]) -> Callable[[], None]:
    """The change at the first call."""
    left = [change]
    return lambda: left.pop()() if left else None


def at(moment: str, change: Callable[[], None], monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a change happen after a file was opened, hashed, or listed, or before numbers are loaded."""
    happen = once(change)
    owner, name = {
        "opened": (OpenFile, "__init__"),
        "hashed": (OpenFile, "sha256"),
        "listed": (opening._Reader, "recording"),
        "loading": (opening._Reader, "_numbers"),
    }[moment]
    original = getattr(owner, name)

    def changed(*given: Any) -> Any:
        if moment == "loading":
            happen()
        result = original(*given)
        if moment != "loading":
            happen()
        return result

    monkeypatch.setattr(owner, name, changed)


#: File, moment, age and change. Every format and moment goes through the same watch on the open file, so each
#: has one change, and all changes are tried on one binary file and one text.
CASES = [
    *itertools.product(BINARY, MOMENTS, (YOUNG, OLD), CHANGES),
    *itertools.product(TEXT, ("opened",), (YOUNG, OLD), CHANGES),
]
KEPT = [
    case
    for case in CASES
    if case[0] in ("run.h5", "comma.csv") or case[2:] in ((YOUNG, rewritten), (OLD, grown))
]


@pytest.mark.parametrize(("name", "moment", "age", "change"), mostly_nightly(CASES, *KEPT))
def test_a_change_is_told(
    name: str, age: int, moment: str, change: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sound = SEEDS[name]()
    path = tmp_path / name
    path.write_bytes(sound)
    now = path.stat().st_mtime
    os.utime(path, (now - age, now - age))
    at(moment, lambda: change(path, sound), monkeypatch)
    told = what_was_told(path, sound)
    if name in TEXT and change is grown:
        assert "grew" in told
    else:
        assert "changed while it was read" in told


@pytest.mark.parametrize("name", BINARY)
def test_a_change_through_a_map_of_memory(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It moves no time of the file where the page was written to before."""
    sound = SEEDS[name]()
    path = tmp_path / name
    path.write_bytes(sound)
    with path.open("r+b") as file, mmap.mmap(file.fileno(), 0) as mapped:
        mapped[:] = sound  # from here on its pages may be written
        os.utime(path, (1e9, 1e9))

        def change() -> None:
            mapped[:] = doubled(sound)

        at("hashed", change, monkeypatch)
        assert "changed while it was read" in what_was_told(path, sound)
