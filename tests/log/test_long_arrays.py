"""Long logs lie on disk: memory does not grow with them, and nothing else differs."""

from __future__ import annotations

import mmap
import pickle
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.arrays import FloatArray
from hersey.damping.dwells import counted_speed, noise, resolution, ripple, segments
from hersey.log import exchanged, friction, impossible, long_arrays, middle
from hersey.log.long_arrays import (
    Filling,
    blocks,
    deviation,
    every,
    let_go,
    mean,
    means_of,
    rows_before,
    without,
)
from hersey.log.middle import median_step
from hersey.log.text import blocks as text
from tests.conftest import ROOT

HEADER = "Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n"
SPEEDS = (0, 10, 20, 40, 80, 40, 20, 10)
BENCH = ROOT / "examples" / "bench.csv"
HELD = 1000  # rows of a dwell, at 10 Hz


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a few hundred rows count as long."""
    for module in (long_arrays, friction, counted_speed):
        monkeypatch.setattr(module, "HELD", 512)
    monkeypatch.setattr(long_arrays, "BLOCK", 256)
    monkeypatch.setattr(long_arrays, "_LET_GO", 1024)
    monkeypatch.setattr(middle, "_AT_ONCE", 512)
    monkeypatch.setattr(text, "BLOCK", 1 << 13)


def write(path: Path, cycles: int) -> None:
    random = np.random.default_rng(1)
    speed = np.repeat(np.tile(SPEEDS, cycles), HELD)
    torque = 0.1 * np.sign(speed) * (1 + speed) ** 0.3 * (1 + 0.01 * random.standard_normal(speed.size))
    hot = 80 + 0.1 * random.standard_normal(speed.size)
    with path.open("w") as file:
        file.write(HEADER)
        for i, (t, n, h) in enumerate(zip(torque, speed, hot, strict=True)):
            file.write(f"{0.1 * i:.1f},{t:.5f},{n},{h:.2f}\n")


def is_mapped(values: FloatArray) -> bool:
    owner: Any = values
    while isinstance(owner, np.ndarray):
        owner = owner.base
    return isinstance(getattr(owner, "obj", None), mmap.mmap)


def filled(parts: list[FloatArray]) -> FloatArray:
    filling = Filling()
    for part in parts:
        filling.add(part)
    return filling.whole()


PARTS = [np.arange(300.0), np.empty(0), np.arange(1.0, 700.0), np.arange(3.0)]


@pytest.mark.usefixtures("short")
def test_a_long_array_lies_in_a_file_that_no_folder_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    values = filled(PARTS)
    assert is_mapped(values)
    assert not is_mapped(filled(PARTS[:1]))
    assert not any(tmp_path.iterdir())
    np.testing.assert_array_equal(values, np.concatenate(PARTS))
    values[5] = -1.0
    let_go(values)
    assert values[5] == -1.0
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(values)), values)


@pytest.mark.usefixtures("short")
@pytest.mark.parametrize("written", range(4))
def test_where_the_disk_is_full_memory_holds_the_numbers(
    written: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    left = written

    def full(file: Any, part: FloatArray) -> None:
        nonlocal left
        left -= 1
        if left < 0:
            file.write(part.data.cast("B")[:11])
            raise OSError(28, "No space left on device")
        file.write(part.data.cast("B"))

    monkeypatch.setattr(long_arrays, "_write", full)
    values = filled([*PARTS, np.arange(900.0)])
    assert is_mapped(values) == (written > 3)
    np.testing.assert_array_equal(values, np.concatenate([*PARTS, np.arange(900.0)]))


@pytest.mark.usefixtures("short")
def test_passes_over_blocks_are_those_over_the_whole() -> None:
    random = np.random.default_rng(3)
    for size in (1, 255, 256, 257, 5000):
        values = random.standard_normal(size)
        rows = np.unique(random.integers(0, size, size // 3))
        kept = np.delete(values, rows)
        np.testing.assert_array_equal(without(values, rows), kept)
        assert [values[rows_before(row, rows)] for row in range(kept.size)] == kept.tolist()
        assert sum(rows.stop - rows.start for rows in blocks(size)) == size
        for step in (1, 7, 300):
            np.testing.assert_array_equal(every(values, step), values[::step])
            starts = np.arange(0, size, step)
            sums = np.add.reduceat(values, starts) / np.diff(starts, append=size)
            np.testing.assert_array_equal(means_of(values, step), sums)


@pytest.mark.usefixtures("short")
def test_sums_over_blocks_round_as_those_of_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(noise, "AT_ONCE", 256)
    monkeypatch.setattr(noise, "THINNED", 100)
    random = np.random.default_rng(4)
    for size in (1, 256, 257, 1000, 12_345, 99_999):
        values = 3.0 + random.standard_normal(size)
        assert mean(values) == float(np.mean(values))
        assert deviation(values) == float(np.std(values))
        wide = max(1, size // 100)
        thin = values[: size // wide * wide].reshape(-1, wide).mean(axis=1)
        np.testing.assert_array_equal(noise.thinned(values), thin)
    time, speed = np.cumsum(random.exponential(0.01, 5000)), random.standard_normal(5000)
    steps = np.diff(time) * (np.abs(speed[1:]) + np.abs(speed[:-1])) / 2.0
    angle = np.concatenate([[0.0], np.cumsum(steps)])
    np.testing.assert_array_equal(ripple.turned(time, speed), angle)
    turns = np.searchsorted(angle, 2.0 * np.pi * np.arange(1 + int(angle[-1] / (2.0 * np.pi))))
    np.testing.assert_array_equal(ripple._turns(time, speed), turns)


CLOCKS: dict[str, Callable[[int], FloatArray]] = {
    "even": lambda n: 0.001 * np.arange(n),
    "rounded": lambda n: np.round(np.arange(n) / 6000.0, 5),
    "stamps repeat": lambda n: np.floor(np.arange(n) / 3.0),
    "two rates": lambda n: np.cumsum(np.where(np.arange(n) < 0.52 * n, 0.001, 0.1)),
    "random": lambda n: np.cumsum(np.random.default_rng(0).exponential(1.0, n)),
    "starts anew": lambda n: np.arange(float(n)) % 100.0,
    "stands": lambda n: np.zeros(n),
}


@pytest.mark.usefixtures("short")
@pytest.mark.parametrize("clock", CLOCKS)
@pytest.mark.parametrize("forward", [False, True])
def test_the_median_step_is_that_of_numpy(clock: str, forward: bool) -> None:
    for size in (513, 5000, 5001, 40_000):
        time = CLOCKS[clock](size)
        steps = np.diff(time)
        steps = steps[steps > 0] if forward else steps
        assert median_step(time, forward=forward) == (float(np.median(steps)) if steps.size else None)


def reduced(path: Path) -> tuple[Any, ...]:
    log = hersey.read(path)
    run, points = log.runs[0], log.steady(tare="standing")
    channels = [each.tobytes() for each in (run.time, run.torque, run.speed, run.temperature)]
    return log.files, channels, points.table.to_dicts(), points.rejected, points.tare_errors.tolist()


def test_a_long_log_is_read_and_reduced_as_a_short_one(request: pytest.FixtureRequest) -> None:
    in_memory = reduced(BENCH)
    request.getfixturevalue("short")
    assert is_mapped(hersey.read(BENCH).runs[0].torque)
    assert reduced(BENCH) == in_memory


def most_memory(work: Callable[[], object]) -> int:
    """Bytes held at the most while something is done."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.usefixtures("short")
@pytest.mark.parametrize("steady", [False, True])
def test_memory_does_not_grow_with_the_log(
    steady: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(impossible, "_LOOKED_AT", 500)  # which long logs have many more of
    monkeypatch.setattr(exchanged, "_MOST", 100)
    monkeypatch.setattr(segments, "MAX_BLOCKS", 1000)

    def work(path: Path) -> None:
        log = hersey.read(path)
        if steady:
            log.steady(tare="standing")

    held = {}
    for cycles in (3, 9):
        path = tmp_path / f"{cycles}.csv"
        write(path, cycles)
        work(path)  # imports and caches
        held[cycles] = most_memory(lambda path=path: work(path))  # type: ignore[misc]
    per_row = (held[9] - held[3]) / (6 * len(SPEEDS) * HELD)
    assert per_row < 8.0, held  # which one channel takes of the four


def in_memory(values: FloatArray) -> int:
    """Bytes of an array on disk that are in the memory of this process."""
    start = values.__array_interface__["data"][0]
    found, within = 0, False
    for line in Path("/proc/self/smaps").read_text().splitlines():
        if "-" in line.split()[0]:
            first, last = (int(end, 16) for end in line.split()[0].split("-"))
            within = first < start + values.nbytes and last > start
        elif within and line.startswith("Rss:"):
            found += 1024 * int(line.split()[1])
    return found


@pytest.mark.skipif(
    not Path("/proc/self/smaps").exists(), reason="the system does not tell what is in memory"
)
@pytest.mark.usefixtures("short")
def test_a_look_at_each_dwell_leaves_none_in_memory() -> None:
    """The system brings up to 2 MB into memory for a few numbers, so that all of a log may come."""
    rows = 1 << 17
    values = filled([np.arange(float(rows))] * 16)
    let_go(values)
    dwells = [values[at : at + rows] for at in range(0, values.size, rows)]
    looked_at = sum(8 * resolution.MOST_ROWS for _ in dwells)
    assert resolution.step_of(dwells) == 1.0
    assert in_memory(values) < looked_at
    assert sum(dwell[0] for dwell in dwells) == 0.0
    assert in_memory(values) >= 16 * mmap.PAGESIZE
