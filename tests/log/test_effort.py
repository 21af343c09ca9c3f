"""How much work reading takes, counted and not timed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.log.long_arrays import Filling
from hersey.log.text import blocks, cells, layout

HEADER = "Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n"


def rows(count: int) -> list[str]:
    return [
        f"{0.1 * i:.1f},{0.2 + 0.001 * (i % 7):.3f},{10 + i % 3},{25 + 0.01 * (i % 5):.2f}"
        for i in range(count)
    ]


def parsed(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Whether each parse looked for words, as they happen."""
    found: list[bool] = []
    read_csv = pl.read_csv

    def counted(*given: Any, **named: Any) -> pl.DataFrame:
        found.append(named["null_values"] is not None)
        return read_csv(*given, **named)

    monkeypatch.setattr(cells.pl, "read_csv", counted)
    return found


def test_words_are_looked_for_only_in_the_blocks_that_have_some(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lines = rows(3000)
    lines[2000] = lines[2000].rpartition(",")[0] + ",NA"
    path = tmp_path / "log.csv"
    path.write_text(HEADER + "\n".join(lines) + "\n")
    monkeypatch.setattr(blocks, "BLOCK", len("\n".join(lines)) // 3)
    found = parsed(monkeypatch)
    log = hersey.read(path)
    assert log.rows == 2999
    assert found.count(True) == 1  # the block with the word, after it was tried without
    assert found.count(False) == 4


def test_a_layout_is_found_once_however_often_a_file_is_opened(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(HEADER + "\n".join(rows(500)) + "\n")
    layout._layout.cache_clear()
    for _ in range(3):
        hersey.read(path)
    assert layout._layout.cache_info().misses == 1
    path.write_text(HEADER + "\n".join(rows(501)) + "\n")
    assert hersey.read(path).rows == 501
    assert layout._layout.cache_info().misses == 2


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize("between", ["", "# a note", "#"])
def test_blank_lines_and_comments_are_passed_over_wherever_blocks_end(
    ends: str, between: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lines = rows(200)
    sparse = [line for row in lines for line in (row, between)]
    path = tmp_path / "log.csv"
    path.write_bytes((HEADER.strip() + ends + ends.join(sparse) + ends).encode())
    whole = hersey.read(path)
    for size in (64, 101, 1000):
        monkeypatch.setattr(blocks, "BLOCK", size)
        log = hersey.read(path)
        assert log.rows == 200
        np.testing.assert_array_equal(log.runs[0].torque, whole.runs[0].torque)


def test_an_array_that_is_filled_part_by_part_holds_them_all() -> None:
    filling = Filling()
    parts = [np.arange(5.0), np.empty(0), np.arange(700.0), np.arange(3.0)]
    for done, part in enumerate(parts, start=1):
        filling.add(part, done / len(parts))
    np.testing.assert_array_equal(filling.whole(), np.concatenate(parts))
    assert Filling().whole().size == 0


@pytest.mark.parametrize("between", ["\n", "\r\n", "\n\n", "\r\n\r\n", "\n\r\n", "\r\r\n", "\n \n"])
def test_an_empty_line_is_seen_wherever_a_block_is_cut(between: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "_AT_ONCE", 8)
    for first in range(20):
        text = "1" * first + between + "1" * (20 - first) + "\n"
        lines = text.split("\n")[:-1]
        empty = any(line in ("", "\r") for line in lines)
        assert blocks._line_ends(text.encode()) == (len(lines), empty)
