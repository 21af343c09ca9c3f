"""Files that names and patterns stand for."""

from __future__ import annotations

from pathlib import Path

import pytest

from hersey.errors import MissingFileError, ParameterError
from hersey.files.patterns import files_of


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("b.csv", "a.csv", "c [1].csv", "inside/d.csv", ".hidden.csv", "folder.csv/e.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name)
    return tmp_path


@pytest.mark.usefixtures("folder")
def test_patterns_are_sorted_and_names_stay_in_their_places() -> None:
    assert files_of("*.csv") == [Path("a.csv"), Path("b.csv"), Path("c [1].csv")]
    assert files_of(["none.csv", "[ab].csv"]) == [Path("none.csv"), Path("a.csv"), Path("b.csv")]
    assert files_of(Path("**/?.csv")) == [Path("a.csv"), Path("b.csv"), Path("inside/d.csv")]


@pytest.mark.usefixtures("folder")
def test_a_file_whose_name_looks_like_a_pattern_is_that_file() -> None:
    assert files_of("c [1].csv") == [Path("c [1].csv")]


def test_no_match_and_a_file_named_twice_are_told(folder: Path) -> None:
    with pytest.raises(MissingFileError, match=r"^no file matches x\*\.csv"):
        files_of(["a.csv", "x*.csv"])
    with pytest.raises(MissingFileError, match=r"Write / between folders: 'inside/\*\.csv'$"):
        files_of(r"inside\*.csv")
    for twice in (["a.csv", "a.csv"], ["*.csv", folder / "b.csv"], ["inside/../a.csv", "a.csv"]):
        with pytest.raises(ParameterError, match=r"is given twice. Give each file once"):
            files_of(twice)
    (folder / "linked.csv").symlink_to("a.csv")
    with pytest.raises(ParameterError, match=r"linked\.csv is given twice"):
        files_of(["*.csv", "linked.csv"])
    with pytest.raises(MissingFileError, match="File not found"):
        files_of("a\0")


def test_of_links_to_one_file_the_first_is_taken_and_one_to_nowhere_is_kept_to_be_told(folder: Path) -> None:
    (folder / "linked.csv").symlink_to("a.csv")
    (folder / "lost.csv").symlink_to("gone.csv")
    assert [path.name for path in files_of("*.csv")] == ["a.csv", "b.csv", "c [1].csv", "lost.csv"]
