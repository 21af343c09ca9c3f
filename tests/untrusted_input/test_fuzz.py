"""Damaged files, 75 in make test and 1200 at night, and a check that the driver sees what it looks for."""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import UnreadableLogError
from tests.conftest import mostly_nightly
from tests.untrusted_input import fuzz_read
from tests.untrusted_input.fuzz_read import Fuzz, Input, fuzz, sound_files
from tests.untrusted_input.watching import linux

pytestmark = linux
pytest.importorskip("asammdf")
pytest.importorskip("h5py")
pytest.importorskip("nptdms")
SEED, PARTS, EACH = 2015, 16, 75


@pytest.fixture(scope="session")
def sound() -> dict[str, bytes]:
    return sound_files()


@pytest.mark.parametrize("part", mostly_nightly(range(PARTS), 0))  # make fuzz-read has as many as one likes
def test_a_damaged_file_ends_in_a_log_or_one_line(
    part: int, sound: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    failed, count, reader = fuzz(SEED, range(part * EACH, part * EACH + EACH), sound, tmp_path / "fuzz")
    assert failed == []
    assert count == EACH
    assert list(tmp_path.iterdir()) == [tmp_path / "fuzz"]
    assert {"read", "UnreadableLogError"} <= reader.ends.keys()


def _print(path: Path) -> None:
    os.write(1, path.name.encode())


def _spin(_: Path) -> None:
    end = time.process_time() + 0.2
    while time.process_time() < end:
        pass


def _warn(_: Path) -> None:
    warnings.warn("beware", stacklevel=1)


def _fail(_: Path) -> None:
    raise ZeroDivisionError


def _tell_another(_: Path) -> None:
    raise UnreadableLogError("it is damaged")


def _tell_much(path: Path) -> None:
    raise UnreadableLogError(f"{path.name} is " + "very " * 1000 + "wrong")


def _leave(path: Path) -> None:
    (path.parent / "left").touch()


def _start(_: Path) -> None:
    for _number in range(2):
        _started.append(__import__("subprocess").Popen([sys.executable, "-c", "input()"], stdin=-1))


def _log(time: list[float], torque: list[float]) -> hersey.TorqueLog:
    run = hersey.log.torque_log.Run("a", np.array(time), np.array(torque), np.array(torque), None)
    return hersey.TorqueLog((run,), ())


_started: list[object] = []
FAULTS: dict[str, Callable[[Path], object]] = {
    "printed": _print,
    "processor time": _spin,
    "warns: beware": _warn,
    "ZeroDivisionError": _fail,
    "without the name": _tell_another,
    "characters": _tell_much,
    "left [": _leave,
    "processes": _start,
    "no number": lambda _: _log([0.0, 1.0], [1.0, np.nan]),
    "time falls": lambda _: _log([0.0, 1.0, 0.5], [1.0, 1.0, 1.0]),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_the_driver_sees(fault: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reader = Fuzz(tmp_path / "fuzz")
    one = Input(1, 1, {"comma.csv": b"a,b\n1,2\n"})
    assert reader.faults(one) == [] or fault == ""
    monkeypatch.setattr(reader, "calls", lambda _: [FAULTS[fault]])
    monkeypatch.setattr(fuzz_read, "MOST_TIME", 0.1)
    faults = reader.faults(one)
    for process in _started:
        process.communicate()  # type: ignore[attr-defined]
    _started.clear()
    assert len(faults) == 1
    assert fault in faults[0]


def test_an_input_is_told_by_its_number(sound: dict[str, bytes]) -> None:
    first, again = (Input(SEED, 7, sound) for _ in range(2))
    assert (first.data, first.recipe) == (again.data, again.recipe)
    assert Input(SEED, 8, sound).data != first.data
