"""Commands with the cache: they print the same to the bit, and do nothing twice."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from hersey.cache import origin
from hersey.cache.switch import use_cache
from hersey.damping import once
from hersey.damping.candidates import fitting
from hersey.damping.curves import fitting as curves
from hersey.damping.dwells import reduction
from hersey.errors import SandboxWarning
from hersey.log import reading
from hersey.log.text import layout
from hersey.machine import no_load
from hersey.posterior import sampling
from tests.cli.command import Done, run
from tests.conftest import ROOT, mostly_nightly

EXAMPLES = ROOT / "examples"
#: Places where work is counted: parts of files read, logs reduced, laws and curves fitted, draws.
WORK = {
    "read": (reading, "_runs"),
    "looked at": (layout, "_layout"),
    "reduced": (reduction, "_Reduction"),
    "fitted": (fitting, "_fit_from"),
    "curves": (curves, "_climbed"),
    "drawn": (sampling, "sample"),
}


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    """How often each kind of work was done since it was cleared."""
    done = dict.fromkeys(WORK, 0)

    def counted(name: str, function: Any) -> Any:
        def call(*given: Any, **named: Any) -> Any:
            done[name] += 1
            return function(*given, **named)

        return call

    for name, (module, attribute) in WORK.items():
        monkeypatch.setattr(module, attribute, counted(name, getattr(module, attribute)))
    return done


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a log, its no-load log and its machine."""
    for name in ("bench.csv", "no-load.csv", "machine.toml"):
        shutil.copy(EXAMPLES / name, tmp_path)
    return tmp_path


def typed(folder: Path, line: str) -> Done:
    """What a command prints, without the time at which a report was made."""
    no_load._fitted.cache_clear()  # a process of its own would not have it
    done = run(*line.split(), cwd=folder)
    assert done.returncode == 0, done.stderr
    if not done.stdout.startswith("{"):
        return done
    document = json.loads(done.stdout)
    document.pop("made", None)
    return Done(0, json.dumps(document), done.stderr)


def without(folder: Path, line: str) -> Done:
    """What it prints without the cache."""
    done = typed(folder, f"{line} --no-cache")
    stdout = done.stdout.replace(" --no-cache", "")  # a report names its command
    return Done(done.returncode, stdout, done.stderr)


LINES = [
    "fit bench.csv --tare standing --json",
    "fit bench.csv --no-load no-load.csv --tare standing --isothermal",
    "models bench.csv --tare standing --bootstrap 20 --json",
    "compare bench.csv no-load.csv",
    "report bench.csv --tare standing --json",
    "report bench.csv --tare standing --machine machine.toml --json",
    "posterior bench.csv --tare standing --machine machine.toml --draws 400 --json",
]


@pytest.mark.parametrize("line", mostly_nightly(LINES, LINES[0], LINES[1], LINES[3], LINES[5]))
def test_a_command_prints_the_same_with_and_without_the_cache(
    line: str, folder: Path, cache: Path, work: dict[str, int]
) -> None:
    plain = without(folder, line)
    assert list(cache.iterdir()) == []
    assert typed(folder, line) == plain
    assert list(cache.iterdir()) != []
    assert any(work.values())
    work.update(dict.fromkeys(WORK, 0))
    assert typed(folder, line) == plain
    assert work == dict.fromkeys(WORK, 0)
    assert without(folder, line) == plain
    assert any(work.values())


def test_commands_share_what_they_did(folder: Path, cache: Path, work: dict[str, int]) -> None:
    """In either order: the fit of a report is that of `fit`, and its own."""
    fit, report = (f"{verb} bench.csv --tare standing --json" for verb in ("fit", "report"))
    plain = {line: without(folder, line) for line in (fit, report)}
    for first, second in ((fit, report), (report, fit)):
        shutil.rmtree(cache)
        assert typed(folder, first) == plain[first]
        work.update(dict.fromkeys(WORK, 0))
        assert typed(folder, second) == plain[second]
        assert work == dict.fromkeys(WORK, 0)


def test_another_machine_file_does_not_read_the_log_again(
    folder: Path, cache: Path, work: dict[str, int]
) -> None:
    assert cache.is_dir()
    line = "report bench.csv --tare standing --machine {} --json"
    typed(folder, line.format("machine.toml"))
    other = folder / "other.toml"
    other.write_text((folder / "machine.toml").read_text().replace('mass = "11 kg"', 'mass = "9 kg"'))
    work.update(dict.fromkeys(WORK, 0))
    with_cache = typed(folder, line.format("other.toml"))
    assert work == dict.fromkeys(WORK, 0) | {"drawn": work["drawn"]}
    assert work["drawn"] > 0
    assert with_cache == without(folder, line.format("other.toml"))


def changed_byte(folder: Path) -> None:
    """One digit of one row in the middle of the log."""
    log = folder / "bench.csv"
    content, times = bytearray(log.read_bytes()), log.stat()
    middle = content.index(b"\n", len(content) // 2) + 1
    place = next(i for i in range(middle, len(content)) if content[i : i + 1].isdigit())
    content[place] = ord("1") if content[place] != ord("1") else ord("2")
    log.write_bytes(bytes(content))
    assert log.stat().st_size == times.st_size


def mapping_beside(folder: Path) -> None:
    (folder / "hersey.toml").write_text('[torque]\ntare = "3 mN*m"\n')


def changed_mapping(folder: Path) -> None:
    (folder / "m.toml").write_text('[torque]\ntare = "4 mN*m"\n')


def changed_no_load(folder: Path) -> None:
    log = folder / "no-load.csv"
    lines = log.read_text().splitlines(keepends=True)
    log.write_text("".join(lines[:-400]))


CHANGES = [
    ("fit bench.csv --tare standing --json", changed_byte),
    ("fit bench.csv --json", mapping_beside),
    ("fit bench.csv --mapping m.toml --json", changed_mapping),
    ("fit bench.csv --tare standing --no-load no-load.csv --json", changed_no_load),
    ("fit bench.csv --tare standing --machine machine.toml --json", changed_no_load),
    ("fit bench.csv --mapping with.toml --json", changed_no_load),
]


@pytest.mark.parametrize(
    ("line", "change"), CHANGES, ids=[f"{line.removesuffix(' --json')}" for line, _ in CHANGES]
)
def test_what_changed_is_read_again(line: str, change: Any, folder: Path, cache: Path) -> None:
    assert cache.is_dir()
    (folder / "m.toml").write_text('[torque]\ntare = "3 mN*m"\n')
    (folder / "with.toml").write_text('[torque]\nno_load = "no-load.csv"\n')
    before = typed(folder, line)
    change(folder)
    after = typed(folder, line)
    assert after.stdout != before.stdout
    assert after == without(folder, line)


@pytest.mark.parametrize(
    "options",
    mostly_nightly(
        ["--tare standing", "--min-dwell 5s", "--rotation forward", "--temperature-scale K", "--isothermal",
         "--torque-unit mN*m"],
        "--tare standing", "--isothermal",
    ),
)  # fmt: skip
def test_other_options_are_other_results(options: str, folder: Path, cache: Path) -> None:
    assert cache.is_dir()
    typed(folder, "fit bench.csv --json")
    assert typed(folder, f"fit bench.csv {options} --json") == without(
        folder, f"fit bench.csv {options} --json"
    )


def test_a_log_of_another_name_is_called_so(folder: Path, cache: Path) -> None:
    assert cache.is_dir()
    (folder / "other.csv").write_bytes((folder / "bench.csv").read_bytes())
    typed(folder, "fit bench.csv --json")
    files = json.loads(typed(folder, "fit other.csv --json").stdout)["files"]
    assert [file["name"] for file in files] == ["other.csv"]


def test_another_program_computes_again(
    folder: Path, cache: Path, work: dict[str, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    line = "fit bench.csv --tare standing --json"
    first = typed(folder, line)
    count = len(list(cache.iterdir()))
    monkeypatch.setattr("hersey.cache.kept.origin", lambda: origin.origin() + "edited")
    work.update(dict.fromkeys(WORK, 0))
    assert typed(folder, line) == first
    assert work["read"] == work["reduced"] == 1
    assert work["fitted"] > 0
    assert len(list(cache.iterdir())) == 2 * count


def damaged(content: bytes) -> Iterator[bytes]:
    """What can become of a file."""
    yield b""
    yield content[: len(content) // 2]
    yield content[:-1] + bytes([content[-1] ^ 1])
    yield b"\0" * len(content)
    yield b"import os\n"
    yield np.random.default_rng(1).bytes(len(content))


def test_damaged_entries_are_ignored_and_written_again(folder: Path, cache: Path) -> None:
    line = "fit bench.csv --tare standing --json"
    plain = typed(folder, line)
    whole = {file: file.read_bytes() for file in cache.iterdir()}
    for kind in range(6):
        for file, content in whole.items():
            file.write_bytes([*damaged(content)][kind])
        assert typed(folder, line) == plain
        assert {file: file.read_bytes() for file in cache.iterdir()} == whole


def test_entries_that_changed_places_are_ignored(folder: Path, cache: Path) -> None:
    line = "fit bench.csv --tare standing --json"
    plain = typed(folder, line)
    files = sorted(cache.iterdir())
    contents = [file.read_bytes() for file in files]
    for file, content in zip(files, [*contents[1:], contents[0]], strict=True):
        file.write_bytes(content)
    assert typed(folder, line) == plain
    assert [file.read_bytes() for file in files] == contents


def test_without_a_place_for_it_a_command_works_as_ever(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = "fit bench.csv --tare standing --json"
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("HERSEY_CACHE", str(tmp_path / "file" / "below"))
    try:
        assert typed(folder, line) == without(folder, line)
    finally:
        use_cache(False)


def formats(folder: Path) -> Iterator[str]:
    """The same log in files of other kinds, and tables of means."""
    frame = pl.read_csv(folder / "bench.csv", comment_prefix="#")
    frame.write_parquet(folder / "bench.parquet")
    yield "bench.parquet"
    table = "\n".join(f"{speed},{5 + speed**0.4:.12f},0.05" for speed in (10, 20, 40, 80, 120, 160, 200))
    (folder / "means.csv").write_text(f"speed [rpm],torque [mN*m],torque error [mN*m]\n{table}\n")
    yield "means.csv --isothermal --means"


def test_logs_of_other_kinds_are_read_once_too(
    folder: Path, cache: Path, work: dict[str, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert cache.is_dir()
    monkeypatch.setattr(once, "_WORTH_KEEPING", 0)
    for log in formats(folder):
        line = f"fit {log} --json"
        plain = without(folder, line)
        assert typed(folder, line) == plain, log
        work.update(dict.fromkeys(WORK, 0))
        assert typed(folder, line) == plain, log
        assert work == dict.fromkeys(WORK, 0), log


def test_a_small_log_is_read_again_since_that_takes_less(
    tmp_path: Path, cache: Path, work: dict[str, int]
) -> None:
    rows = [f"{speed},{5 + speed**0.4:.3f}" for speed in (10, 20, 40, 80, 120, 160, 200)]
    (tmp_path / "means.csv").write_text("speed [rpm],torque [mN*m]\n" + "\n".join(rows) + "\n")
    line = "fit means.csv --isothermal --json"
    plain = typed(tmp_path, line)
    assert list(cache.iterdir()) != []
    work.update(dict.fromkeys(WORK, 0))
    assert typed(tmp_path, line) == plain
    assert work["looked at"] > 0
    assert work["fitted"] == 0


def test_a_log_that_changes_while_it_is_read_is_not_kept(
    folder: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was hashed and what was read must be the same bytes."""
    line = "fit bench.csv --tare standing --json"
    first = typed(folder, line)
    use_cache(False)
    shutil.rmtree(cache)
    runs = reading._runs

    def late(*given: Any) -> Any:
        changed_byte(folder)
        return runs(*given)

    with monkeypatch.context() as patched:
        patched.setattr(reading, "_runs", late)
        assert typed(folder, line).stdout != first.stdout
    shutil.copy(EXAMPLES / "bench.csv", folder)
    assert typed(folder, line) == first


def test_a_warning_is_printed_each_time(folder: Path, cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert cache.is_dir()
    runs = reading._runs

    def warning(*given: Any) -> Any:
        import warnings

        warnings.warn(SandboxWarning(["read"]), stacklevel=1)
        return runs(*given)

    monkeypatch.setattr(reading, "_runs", warning)
    said = [typed(folder, "fit bench.csv --tare standing").stderr for _ in range(3)]
    assert said[0] == said[1] == said[2]
    assert "could read" in said[0]
