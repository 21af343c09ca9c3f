"""Functions whose results are kept: found by all that they follow from, computed otherwise."""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hersey import errors
from hersey.cache import origin as of_origin
from hersey.cache.kept import kept
from hersey.cache.switch import cache_folder, spoil, use_cache

Counted = tuple[Callable[..., Any], list[Any]]


@pytest.fixture
def counted(cache: Path) -> Counted:
    """A function whose results are kept, and the calls of what computes them."""
    assert cache.is_dir()
    calls: list[Any] = []

    def computed(value: Any, *, factor: float = 2.0, progress: Any = None, **more: Any) -> Any:
        calls.append((value, factor, more))
        if progress is not None:
            progress()
        return None if value is None else factor * value

    use_cache(True)
    return kept(apart=("progress", "threads"))(computed), calls


def test_a_result_is_computed_once(counted: Counted) -> None:
    function, calls = counted
    assert [function(1.5), function(value=1.5), function(1.5, factor=2.0)] == [3.0, 3.0, 3.0]
    assert len(calls) == 1


def test_a_result_that_is_none_is_one(counted: Counted) -> None:
    function, calls = counted
    assert function(None) is None
    assert function(None) is None
    assert len(calls) == 1


def test_every_argument_counts_to_the_last_bit(counted: Counted) -> None:
    function, calls = counted
    numbers = np.arange(4.0)
    moved = numbers.copy()
    moved[3] = np.nextafter(3.0, 4.0)
    values = (1, 1.0, True, np.float64(1.0), numbers, moved, numbers[::2], numbers.reshape(2, 2),
              np.asfortranarray(numbers.reshape(2, 2)), numbers.astype(np.float32), -0.0, 0.0)  # fmt: skip
    for value in values:
        function(value)
    function(1.0, factor=3.0)
    function(1.0, other=1)
    assert len(calls) == len(values) + 2


def test_what_does_not_count_does_not(counted: Counted) -> None:
    function, calls = counted
    said: list[int] = []
    for threads in (1, 2):
        function(1.0, threads=threads, progress=lambda: said.append(1))
    assert len(calls) == 1
    assert said == [1]


def test_what_cannot_be_written_is_computed_each_time(counted: Counted) -> None:
    function, calls = counted
    for _ in range(2):
        assert function(1j) == 2j  # as a key
        assert function(2, factor=[None]) == [None, None]
    assert len(calls) == 3


def test_an_error_is_not_kept(cache: Path) -> None:
    use_cache(True)
    calls = []

    @kept()
    def failing(value: int) -> int:
        calls.append(value)
        raise errors.ParameterError("wrong")

    for _ in range(2):
        with pytest.raises(errors.ParameterError):
            failing(1)
    assert len(calls) == 2
    assert list(cache.iterdir()) == []


def test_a_result_with_a_printed_warning_is_not_kept(cache: Path) -> None:
    use_cache(True)

    @kept()
    def warning(value: int) -> int:
        spoil()
        return value

    warning(1)
    assert list(cache.iterdir()) == []


def test_an_unsound_result_is_not_kept(cache: Path) -> None:
    use_cache(True)

    @kept(sound=lambda found, given: found == given["value"])
    def off(value: int) -> int:
        return value + value % 2

    off(1)
    assert list(cache.iterdir()) == []
    off(2)
    assert len(list(cache.iterdir())) == 1


def test_advice_in_other_words_is_another_result(counted: Counted) -> None:
    function, calls = counted
    function(1.0)
    errors.speak("terminal")
    try:
        function(1.0)
    finally:
        errors.speak("python")
    assert len(calls) == 2


def test_in_python_nothing_is_kept(cache: Path) -> None:
    assert cache_folder() is None
    calls = []

    @kept()
    def computed(value: int) -> int:
        calls.append(value)
        return value

    computed(1)
    computed(1)
    assert len(calls) == 2
    assert list(cache.iterdir()) == []


@pytest.mark.parametrize("word", ["", "0", "off", "OFF", " none ", "no"])
def test_the_environment_turns_it_off(word: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HERSEY_CACHE", word)
    use_cache(True)
    assert cache_folder() is None


def test_the_folder_is_that_of_the_system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("HERSEY_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr("sys.platform", "linux")
    use_cache(True)
    try:
        assert cache_folder() == tmp_path / "hersey" / "results"
    finally:
        use_cache(False)


def test_without_a_home_there_is_no_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("HERSEY_CACHE")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(os.path, "expanduser", lambda path: path)
    use_cache(True)
    assert cache_folder() is None


def test_a_changed_file_of_the_program_is_another_origin(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "hersey"
    (package / "log").mkdir(parents=True)
    module = package / "log" / "reading.py"
    module.write_text("a = 1\n")
    monkeypatch.setattr(of_origin, "_PACKAGE", package)
    origin = of_origin.origin.__wrapped__
    before, times = origin(), module.stat()
    assert origin() == before
    module.write_text("a = 2\n")  # as long, and as old as it was
    os.utime(module, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert origin() != before
    seen = {before, origin()}
    (package / "log" / "new.py").write_text("")
    assert origin() not in seen
    now = origin()
    (package / "__pycache__").mkdir()
    assert origin() == now


def test_another_library_is_another_origin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    origin = of_origin.origin.__wrapped__
    monkeypatch.syspath_prepend(str(tmp_path))
    before = origin()
    (tmp_path / "polars-9.9.9.dist-info").mkdir()
    assert origin() != before


def test_another_processor_is_another_origin(monkeypatch: pytest.MonkeyPatch) -> None:
    """Several machines may share a folder, and linear algebra rounds by what a processor can do."""
    origin = of_origin.origin.__wrapped__
    before = origin()
    features = import_module("numpy._core._multiarray_umath").__cpu_features__
    changed = features | {next(iter(features)): not next(iter(features.values()))}
    monkeypatch.setattr("numpy._core._multiarray_umath.__cpu_features__", changed)
    assert origin() != before


def test_another_origin_is_another_result(counted: Counted, monkeypatch: pytest.MonkeyPatch) -> None:
    function, calls = counted
    for origin, computed in (("before", 1), ("before", 1), ("after an edit", 2)):
        monkeypatch.setattr("hersey.cache.kept.origin", lambda origin=origin: origin)
        assert function(1.5) == 3.0
        assert len(calls) == computed
