"""The runtime of the pages: bundled once, kept whole or bundled anew, never needed to be kept."""

from __future__ import annotations

from pathlib import Path

import pytest

from hersey.charts import runtime as module
from hersey.charts.runtime import runtime


class Bundler:
    """Stands in for vl-convert, and counts."""

    def __init__(self) -> None:
        self.calls = 0

    def __call__(self, snippet: str) -> str:
        self.calls += 1
        return f"/* </script> */ {snippet}"


@pytest.fixture
def bundler(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Bundler:
    counting = Bundler()
    monkeypatch.setattr(module, "bundled", counting)
    monkeypatch.setattr(module, "user_cache_path", lambda name: tmp_path / name)
    return counting


def test_it_is_bundled_once(bundler: Bundler) -> None:
    first = runtime()
    assert first.endswith("window.vegaEmbed = vegaEmbed;")
    assert "</script" not in first
    assert runtime() == first
    assert bundler.calls == 1


def test_a_script_that_was_changed_is_bundled_anew(bundler: Bundler, tmp_path: Path) -> None:
    first = runtime()
    (kept,) = (tmp_path / "hersey").iterdir()
    for damaged in (kept.read_bytes()[:-3], kept.read_bytes() + b"alert(1)", b"", b"\xff"):
        kept.write_bytes(damaged)
        assert runtime() == first
    assert bundler.calls == 5


def test_without_a_cache_it_is_bundled_each_time(bundler: Bundler, tmp_path: Path) -> None:
    (tmp_path / "hersey").write_text("a file where the folder would be")
    assert runtime() == runtime()
    assert bundler.calls == 2


def test_the_script_of_a_wheel_is_taken_as_it_is(
    bundler: Bundler, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shipped = tmp_path / "vega-embed.js"
    shipped.write_text("window.vegaEmbed = 1;")
    monkeypatch.setattr(module, "_SHIPPED", shipped)
    assert runtime() == "window.vegaEmbed = 1;"
    assert bundler.calls == 0
