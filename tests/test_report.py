"""The page as a file: self-contained, small, and deaf to hostile text (how it looks: tests/browser)."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hersey.document import Analysis
from hersey.errors import OutputError
from hersey.report import render, write_atomically


@pytest.fixture(scope="module")
def page(document: Analysis) -> str:
    return render(document)


def test_it_is_small_and_needs_no_network(page: str) -> None:
    assert len(page.encode()) < 2_000_000
    assert not re.search(r"(src|href)=.?https?:", page)
    assert "default-src 'none'" in page


def test_hostile_text_stays_text(document: Analysis) -> None:
    hostile = "</script><script>alert(1)</script><img src=x onerror=alert(2)>"
    page = render(document.model_copy(update={"title": hostile, "command": hostile}))
    assert hostile not in page
    assert "alert(1)</script>" not in page
    assert "<img src=x" not in page
    assert page.count("</script>") == 4


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
