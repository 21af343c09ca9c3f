"""Many logs, each by itself: the same as one by one, failures told, and nothing else of what failed."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import hersey
from hersey.errors import (
    ChannelError,
    HerseyError,
    InsufficientDataError,
    MissingFileError,
    ParameterError,
    UnfinishedError,
)
from hersey.log.many import each_of

HEAD = "t [s],torque [mN*m],speed [rpm],temperature [degC]\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for number in range(5):
        rows = [f"{row / 10},{number + row % 7},{10 * (1 + row // 100)},150" for row in range(300)]
        (tmp_path / f"{number}.csv").write_text(HEAD + "\n".join(rows) + "\n")
    return tmp_path


def mean(log: hersey.TorqueLog) -> float:
    return float(log.runs[0].torque.mean())


def late_first(log: hersey.TorqueLog) -> float:
    """The same, the first file last."""
    time.sleep(0.1 * (log.files[0].name == "0.csv"))
    return mean(log)


@pytest.mark.usefixtures("folder")
def test_they_are_those_of_one_by_one_however_many_threads() -> None:
    alone = {Path(f"{number}.csv"): hersey.read(f"{number}.csv") for number in range(5)}
    many = hersey.read_many("*.csv")
    assert list(many) == list(alone)
    assert [log.files for log in many.values()] == [log.files for log in alone.values()]
    means = {path: mean(log) for path, log in alone.items()}
    seen: list[tuple[int, int]] = []
    for threads in (1, 3):
        read = hersey.read_many(
            "*.csv", then=late_first, threads=threads, progress=lambda *counted: seen.append(counted)
        )
        assert list(read.items()) == list(means.items())
        assert read["3.csv"] == means[Path("3.csv")]
        assert repr(read) == "<ManyLogs: 5 logs, 0 skipped>"
    assert seen == [(count, 5) for count in range(1, 6)] * 2


def test_what_fails_is_left_out_and_told(folder: Path) -> None:
    (folder / "1.csv").write_text("no log at all\n")
    (folder / "3.csv").write_text(HEAD.replace("torque [mN*m]", "x [mm]") + "0,1,2,3\n1,1,2,3\n")

    def first_is_short(log: hersey.TorqueLog) -> int:
        if log.files[0].name == "0.csv":
            raise InsufficientDataError("too short")
        return log.rows

    many = hersey.read_many(["*.csv", "none.csv"], then=first_is_short, keep_going=True, threads=2)
    assert {path.name: rows for path, rows in many.items()} == {"2.csv": 300, "4.csv": 300}
    kinds = {path.name: type(error) for path, error in many.failures.items()}
    assert kinds.pop("1.csv").__mro__.index(HerseyError)
    assert kinds == {"0.csv": InsufficientDataError, "3.csv": ChannelError, "none.csv": MissingFileError}
    head, *lines = many.summary().splitlines()
    assert head == "read 2 of 6 logs"
    assert [line.split(": ")[0] for line in lines] == ["- 0.csv", "- 1.csv", "- 3.csv", "- none.csv"]
    assert lines[0] == "- 0.csv: too short"
    # which of two is raised hangs on their order, not on the time that they take
    with pytest.raises(InsufficientDataError, match=r"^0\.csv: too short$"):
        hersey.read_many("*.csv", then=first_is_short, threads=3)


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("call", "kind", "said"),
    [
        (lambda: hersey.read_many("x*.csv", keep_going=True), MissingFileError, "no file matches"),
        (lambda: hersey.read_many(["0.csv", "?.csv"], keep_going=True), ParameterError, "is given twice"),
        (lambda: hersey.read_many("0.csv", channels={"tork": "x"}), ParameterError, "unknown role 'tork'"),
        (lambda: hersey.read_many("0.csv", threads=0), ParameterError, "threads is 0"),
        (lambda: hersey.read_many(3), ParameterError, "an? int is not a log"),  # type: ignore[arg-type]
        (lambda: hersey.read_many([]), ParameterError, "no log file is given"),
    ],
)
def test_a_mistake_is_one_line(call: Callable[[], Any], kind: type[HerseyError], said: str) -> None:
    with pytest.raises(kind, match=said):
        call()


@pytest.mark.usefixtures("folder")
def test_a_mistake_of_the_callers_own_comes_through() -> None:
    with pytest.raises(ZeroDivisionError):
        hersey.read_many("*.csv", then=lambda _log: 1 / 0, keep_going=True, threads=2)


@pytest.mark.usefixtures("folder")
def test_no_more_logs_are_held_than_are_read_at_once() -> None:
    """What ``then`` returns is all that is kept: of 5 logs no two stay."""
    import weakref

    alive: list[weakref.ref[hersey.TorqueLog]] = []

    def held(log: hersey.TorqueLog) -> int:
        alive.append(weakref.ref(log))
        return sum(each() is not None for each in alive)

    assert list(hersey.read_many("*.csv", then=held).values()) == [1] * 5


def test_a_file_that_ends_its_workers_is_named() -> None:
    def ends_workers(path: Path) -> int:
        if path.name == "1.csv":
            raise UnfinishedError("item 1 ended 48 workers", index=1)
        return 0

    found = each_of(ends_workers, [Path("logs/0.csv"), Path("logs/1.csv")])
    assert next(found) == 0
    with pytest.raises(UnfinishedError, match=r"^logs/1\.csv: item 1 ended 48 workers$"):
        next(found)


def test_overlapping_limits_of_linear_algebra_hold_until_the_last() -> None:
    from threadpoolctl import threadpool_info, threadpool_limits

    from hersey.arrays import one_thread

    def threads() -> list[int]:
        return [each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"]

    entered, leave = threading.Event(), threading.Event()

    def other() -> None:
        with one_thread():
            entered.set()
            leave.wait(5)

    thread = threading.Thread(target=other)
    with threadpool_limits(2, user_api="blas"):  # whatever the environment says
        before = threads()
        with one_thread():
            thread.start()
            assert entered.wait(5)
        assert set(threads()) == {1}  # the other is inside
        leave.set()
        thread.join()
        assert threads() == before != [1] * len(before)
