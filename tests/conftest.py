"""Logs and documents shared by the tests."""

from __future__ import annotations

import fcntl
import importlib
import os
import pickle
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import pytest

import hersey
from hersey import testbench
from hersey.damping.candidates import comparison
from hersey.damping.candidates.candidate import all_candidates
from hersey.damping.curves import mixture
from hersey.damping.curves.shapes import SHAPES
from hersey.decision.behaviour import Working
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of
from hersey.machine.machine import read_machine
from hersey.posterior import sampling
from hersey.study import study
from hersey.verdict import explanations

os.environ["HERSEY_CACHE"] = "off"  # tests ask for results that are computed; those of the cache set it

Made = TypeVar("Made")
ROOT = Path(__file__).parents[1]
SHARED = ROOT.parent / "shared"
#: What `make quick` leaves out, by marker: the starts of names in a list of the same name.
LISTED = {
    marker: tuple(
        line for line in (ROOT / "tests" / f"{marker}.txt").read_text().splitlines() if line[:1] != "#"
    )
    for marker in ("slow", "lasting")
}


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add what `make nightly` asks for."""
    parser.addoption("--nightly", action="store_true", help="run the tests marked nightly too")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the tests that are listed, and leave the nightly ones out."""
    for item in items:
        for marker, starts in LISTED.items():
            if item.nodeid.startswith(starts):
                item.add_marker(marker)
    if not config.getoption("--nightly"):
        nightly = [item for item in items if item.get_closest_marker("nightly")]
        config.hook.pytest_deselected(items=nightly)
        items[:] = [item for item in items if not item.get_closest_marker("nightly")]


def mostly_nightly(cases: Iterable[Any], *kept: Any) -> list[Any]:
    """Cases of a test of which `make test` tries only those kept, for they take the paths of all others."""
    cases = list(cases)
    assert set(kept) <= set(cases)
    nightly = pytest.mark.nightly
    return [
        case if case in kept else pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=nightly)
        for case in cases
    ]


#: Where the processes of a run find what one of them made.
_COMMON: list[Path] = []


@pytest.fixture(scope="session", autouse=True)
def _common(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Let the processes of a run share a folder; a run in one process needs none."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        _COMMON[:] = [tmp_path_factory.getbasetemp().parent]


def made_once(name: str, make: Callable[[], Made]) -> Made:
    """Return what the first process of a run that asks makes, and the others read."""
    if not _COMMON:
        return make()
    made = _COMMON[0] / f"{name}.pickle"
    with made.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # ends with the process, so that none waits for one that died
        if not made.exists():
            part = made.with_suffix(".part")
            part.write_bytes(pickle.dumps(make()))
            part.rename(made)
    found: Made = pickle.loads(made.read_bytes())
    return found


@pytest.fixture(scope="session")
def nightly(request: pytest.FixtureRequest) -> bool:
    """Whether every case is tried."""
    return bool(request.config.getoption("--nightly"))


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


def shared(path: str) -> Path:
    """A file or folder of measurements by others, read in place; the test skips where it is absent."""
    found = SHARED / path
    if not found.exists():
        pytest.skip(f"the shared folder with {path} is not beside the repository")
    return found


@pytest.fixture(scope="session")
def bench_csv(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log of the virtual test stand."""
    path = tmp_path_factory.mktemp("bench") / "bench.csv"
    testbench.run(seed=3).write(path)
    return path


@pytest.fixture(scope="session")
def log(bench_csv: Path) -> hersey.TorqueLog:
    return hersey.read(bench_csv)


@pytest.fixture(scope="session")
def points(log: hersey.TorqueLog) -> hersey.SteadyPoints:
    return log.steady(tare="standing")


@pytest.fixture(scope="session")
def surface(points: hersey.SteadyPoints) -> hersey.DampingSurface:
    return hersey.fit(points)


@pytest.fixture(scope="session")
def document(points: hersey.SteadyPoints) -> Analysis:
    machine = read_machine(ROOT / "tests" / "stand" / "machine.toml")
    return document_of(study(points, machine), command="hersey report bench.csv")


@pytest.fixture
def few_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a report, a map or a plan rest on a quarter of the draws, where it is looked at in words."""
    monkeypatch.setattr(Working.__init__, "__defaults__", ((), None, 250))
    monkeypatch.setattr(sampling, "DRAWS", 250)


@pytest.fixture
def few_laws(monkeypatch: pytest.MonkeyPatch, nightly: bool) -> None:
    """Try two curves, three candidates and no film beside a constant torque; at night all."""
    if nightly:
        return
    monkeypatch.setattr(mixture, "SHAPES", (SHAPES[0], SHAPES[-1]))
    monkeypatch.setattr(comparison, "all_candidates", lambda: all_candidates()[:3])
    monkeypatch.setattr(explanations, "_beside_constant", lambda *_: ([], []))


@pytest.fixture
def one_branch(monkeypatch: pytest.MonkeyPatch, nightly: bool) -> None:
    """Look for no second branch, where the torque has one; at night it is looked for."""
    if not nightly:
        fitting = importlib.import_module("hersey.damping.fit")  # the package has a function of that name
        monkeypatch.setattr(fitting, "fit_branches", lambda _data, _single: None)


@pytest.fixture
def roughly(request: pytest.FixtureRequest) -> None:
    """Fit quickly, where a command is looked at, or what it reads, and not what it fits."""
    for quicker in ("few_draws", "few_laws", "one_branch"):
        request.getfixturevalue(quicker)


@pytest.fixture
def examples_here(tmp_path: Path) -> Path:
    """Return a fresh directory that holds the examples, to type commands in."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    return tmp_path
