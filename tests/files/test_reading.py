"""A file that changes while it is read: told as such, whatever else goes wrong meanwhile."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from hersey.errors import MissingFileError, UnreadableLogError
from hersey.files.reading import open_once, unchanged

BYTES = b"0,1\n" * 100


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "log.csv"
    path.write_bytes(BYTES)
    os.utime(path, ns=(10**18, 10**18))
    return path


def appended(path: Path) -> None:
    with path.open("ab") as file:
        file.write(b"2,3\n")


def replaced(path: Path) -> None:
    other = path.with_name("other")
    other.write_bytes(BYTES)
    other.replace(path)


CHANGES: dict[str, tuple[Callable[[Path], object], str]] = {
    "grown": (appended, "it grew from 400 to 404 bytes"),
    "cut": (lambda path: os.truncate(path, 10), "it shrank from 400 to 10 bytes"),
    "written to": (lambda path: path.write_bytes(BYTES[::-1]), "it was written to"),
    "touched": (lambda path: os.utime(path, ns=(1, 1)), "it was written to"),
    "replaced": (replaced, "it was"),
    "removed": (Path.unlink, "it was"),
    "moved": (lambda path: path.rename(path.with_name("log.1")), "it was"),
}


def read_while(path: Path, happens: Callable[[Path], object], raised: Exception | None = None) -> None:
    with unchanged(path) as file:
        assert file.file.read() == BYTES
        happens(path)
        if raised is not None:
            raise raised


def nothing(_path: Path) -> None:
    """The file is left alone."""


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_is_told_with_the_way_out(change: str, file: Path) -> None:
    happens, told = CHANGES[change]
    with pytest.raises(UnreadableLogError, match=f"log.csv changed while it was read .{told}.*copy it first"):
        read_while(file, happens)


def test_a_file_left_alone_passes(file: Path) -> None:
    with unchanged(file) as opened:
        assert opened.file.read() == BYTES
    with open_once(file) as watched:
        assert watched.size == 400
        assert watched.growth(hashlib.sha256(BYTES).hexdigest()) == []


def test_what_fails_because_of_a_change_is_told_as_the_change(file: Path) -> None:
    with pytest.raises(UnreadableLogError, match="shrank"):
        read_while(file, lambda path: os.truncate(path, 3), ValueError("line 1: 3 cells"))
    file.write_bytes(BYTES)
    with pytest.raises(ValueError, match="3 cells"):
        read_while(file, nothing, ValueError("line 1: 3 cells"))


def test_growth_alone_is_a_warning(file: Path) -> None:
    with open_once(file) as watched:
        appended(file)
        (warning,) = watched.growth(hashlib.sha256(BYTES).hexdigest())
    assert (warning.kind, warning.values) == ("file grew while it was read", {"before": 400, "after": 404})
    assert (
        str(warning)
        == "the file grew from 400 to 404 bytes while it was read; only the first 400 bytes were used"
    )


def test_growth_with_other_bytes_is_refused(file: Path) -> None:
    with open_once(file) as watched:
        file.write_bytes(b"9" + BYTES)
        with pytest.raises(UnreadableLogError, match="content was replaced"):
            watched.growth(hashlib.sha256(BYTES).hexdigest())


def test_times_too_coarse_to_show_a_change_do_not_hide_it(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file written just before and just after the opening may bear one time for both."""
    os.utime(file)
    with open_once(file) as watched:
        file.write_bytes(BYTES[::-1])
        monkeypatch.setattr(watched, "change", str)
        with pytest.raises(UnreadableLogError, match="content was replaced"):
            watched.growth(hashlib.sha256(BYTES).hexdigest())


def test_what_cannot_be_opened(tmp_path: Path) -> None:
    with pytest.raises(MissingFileError, match="File not found"), unchanged(tmp_path / "none"):
        pass
    with pytest.raises(MissingFileError, match=r"is a folder. Name a file"), unchanged(tmp_path):
        pass
