"""The page as a file: self-contained, small, and deaf to hostile text (how it looks: tests/browser)."""

from __future__ import annotations

import re
from pathlib import Path
from typing import BinaryIO

import pytest

from hersey.document.analysis import Analysis
from hersey.errors import OutputError
from hersey.files.writing import write_atomically
from hersey.report.page import render


@pytest.fixture(scope="module")
def page(document: Analysis) -> str:
    return render(document)


def test_it_is_small_and_needs_no_network(page: str) -> None:
    assert len(page.encode()) < 2_500_000
    assert not re.search(r"(src|href)=.?https?:", page)
    assert "default-src 'none'" in page


def test_hostile_text_stays_text(document: Analysis) -> None:
    hostile = "</script><script>alert(1)</script><img src=x onerror=alert(2)>"
    page = render(document.model_copy(update={"title": hostile, "command": hostile}))
    assert hostile not in page
    assert "alert(1)</script>" not in page
    assert "<img src=x" not in page
    assert page.count("</script>") == 6  # document, charts, core, glossary; the runtime and the page's own


def test_files_are_written_whole_or_not_at_all(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    write_atomically(path, "one", overwrite=False)
    with pytest.raises(OutputError, match="exists"):
        write_atomically(path, "two", overwrite=False)
    assert path.read_text() == "one"
    with pytest.raises(UnicodeEncodeError):
        write_atomically(path, "\ud800", overwrite=True)
    assert path.read_text() == "one"
    assert [p.name for p in tmp_path.iterdir()] == ["page.html"]


class _Disk:
    """A file on a disk that fills up half way."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def __enter__(self) -> _Disk:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def write(self, content: bytes) -> None:
        self._file.write(content[: len(content) // 2])
        self._file.flush()
        raise OSError(28, "No space left on device")


def test_a_disk_that_fills_up_leaves_the_old_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "page.html"
    path.write_text("the old page")

    whole = Path.open
    monkeypatch.setattr(Path, "open", lambda part, mode: _Disk(whole(part, mode)))
    with pytest.raises(OutputError, match=r"page\.html cannot be written: No space left on device"):
        write_atomically(path, "a new page", overwrite=True)
    monkeypatch.undo()
    assert path.read_text() == "the old page"
    assert [p.name for p in tmp_path.iterdir()] == ["page.html"]


def test_the_old_page_stays_readable_to_who_has_it_open(tmp_path: Path) -> None:
    """A file is replaced, not written over: whoever reads the old one reads it to its end."""
    path = tmp_path / "page.html"
    path.write_text("the old page")
    with path.open() as reader:
        write_atomically(path, "new", overwrite=True)
        assert reader.read() == "the old page"
    assert path.read_text() == "new"


def test_a_written_file_has_the_rights_of_any_other(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("x")
    write_atomically(tmp_path / "page", b"\x00y", overwrite=False)
    assert (tmp_path / "page").stat().st_mode == (tmp_path / "plain").stat().st_mode
    assert (tmp_path / "page").read_bytes() == b"\x00y"


def test_where_nothing_can_be_written(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"is a folder\. Name a file in it"):
        write_atomically(tmp_path, "x", overwrite=True)
    with pytest.raises(OutputError, match=r"page cannot be written: No such file or directory"):
        write_atomically(tmp_path / "none" / "page", "x", overwrite=True)


def test_without_a_machine_no_core_goes_in(document: Analysis) -> None:
    page = render(document.model_copy(update={"map": None}))
    assert 'id="physics"' not in page
    assert "wasm-unsafe-eval" not in page
    assert "worker-src" not in page
