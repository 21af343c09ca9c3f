"""Sweeps in chunks: the bits of one process, kept, gone on with, and refused where they are others."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import warnings
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl
import psutil
import pytest
import xarray as xr

import hersey
from hersey import _core
from hersey.errors import MissingFileError, OutputError, ParameterError
from hersey.motion import checkpoint, following
from hersey.motion.scenario import read_scenario, rows, summary
from hersey.motion.sets import Later, Piece, Sets
from hersey.scale import store
from hersey.scale.cutting import Cut
from hersey.scale.kinds import kind_of
from tests.cli.command import HERSEY, run

if TYPE_CHECKING:
    from distributed import Client

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
GRID: dict[str, Any] = {
    "stiffness": np.geomspace(500, 2000, 5),
    "transition_force": [25.0, 100.0],
    "drive_speed": np.linspace(0.4, 2.4, 7),
}
PAIRS: dict[str, Any] = {
    "stiffness": np.linspace(500, 900, 23),
    "drive_speed": np.linspace(0.4, 2, 23),
    "zip": True,
}
TABLE: dict[str, Any] = {
    "stiffness": np.array([[500.0], [900.0], [2000.0]]),
    "drive_speed": np.array([0.4, 1.0, 1.6, 2.4]),
    "zip": True,
}
SCENARIO = """
[parameters]
stiffness = { from = 500, to = 2000, count = 40 }
mass = 1
transition_force = { from = 25, to = 100, count = 20 }
transition_speed = 1
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_speed = { from = 0.4, to = 2.4, count = 50 }
[options]
units = "consistent"
"""


def assert_same(kept: xr.Dataset, memory: xr.Dataset) -> None:
    words = kept.kind.attrs.get("flag_meanings", "").split()
    for name in memory.data_vars:
        values = kept[name].values
        values = np.array(words)[values] if words and name == "kind" else values
        assert kept[name].dims == memory[name].dims
        if name == "kind":
            assert values.tolist() == memory[name].values.tolist()
        else:
            assert (values.dtype, values.tobytes()) == (
                memory[name].values.dtype,
                memory[name].values.tobytes(),
            )
    for name in memory.coords:
        assert kept[name].dims == memory[name].dims
        np.testing.assert_array_equal(kept[name], memory[name])


@pytest.mark.parametrize(("given", "chunk"), [(GRID, 9), (GRID, 1), (PAIRS, 5), (TABLE, 4), ({}, 1)])
def test_chunks_have_the_bits_of_the_whole(given: dict[str, Any], chunk: int, tmp_path: Path) -> None:
    given = given or {"drive_speed": 1.0}
    memory = hersey.sweep(TRAIN, DRAG, **given)
    out = tmp_path / "sweep.zarr"
    assert_same(hersey.sweep(TRAIN, DRAG, **given, out=out, work=hersey.Work(chunk=chunk, threads=2)), memory)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert_same(xr.open_zarr(out, chunks=None), memory)
    hersey.sweep(TRAIN, DRAG, **given, out=tmp_path / "sweep.parquet", work=hersey.Work(chunk=chunk))
    table = pl.read_parquet(tmp_path / "sweep.parquet")
    whole = tmp_path / "whole.parquet"
    whole.write_bytes(rows(memory, ".parquet"))
    columns = pl.read_parquet(whole)
    assert table.select(columns.columns).equals(columns)


@pytest.mark.parametrize("given", [GRID, PAIRS])
def test_workers_find_the_same_bits(client: Client, given: dict[str, Any], tmp_path: Path) -> None:
    memory = hersey.sweep(TRAIN, DRAG, **given)
    seen: list[tuple[int, int]] = []
    brought = hersey.sweep(
        TRAIN,
        DRAG,
        **given,
        work=hersey.Work(client=client, chunk=6, progress=lambda now, of: seen.append((now, of))),
    )
    assert_same(brought, memory)
    assert brought.attrs == memory.attrs
    assert seen[-1] == (memory.kind.size, memory.kind.size)
    assert_same(
        hersey.sweep(TRAIN, DRAG, **given, work=hersey.Work(client=client, chunk=6), out=tmp_path / "a.zarr"),
        memory,
    )


def test_a_store_says_what_it_holds(tmp_path: Path) -> None:
    hersey.sweep(
        TRAIN, DRAG, **GRID, out=tmp_path / "a.zarr", work=hersey.Work(tolerance=1e-8), start="steady"
    )
    grid = xr.open_zarr(tmp_path / "a.zarr", chunks=None)
    assert grid.frequency.attrs["units"] == "Hz"
    assert grid.stiffness.attrs == {"long_name": "stiffness", "units": "N/m"}
    assert grid.kind.dtype == np.uint8
    assert grid.kind.attrs["flag_meanings"].split() == _core.KINDS
    assert grid.attrs["tolerance"] == 1e-8
    assert (grid.attrs["start"], grid.attrs["closure"]) == ("steady", "retained")
    assert grid.attrs["hersey_version"] == _core.VERSION
    assert len(grid.attrs["hersey"]["scenario_sha256"]) == 64
    assert grid.status.values.tolist() == [1] * grid.status.size
    path = tmp_path / "scenario.toml"
    path.write_text(SCENARIO.replace("count = 40", "count = 2").replace("count = 20", "count = 2"))
    read_scenario(path).keep(tmp_path / "b.zarr")
    assert xr.open_zarr(tmp_path / "b.zarr", chunks=None).attrs["units"] == "consistent"
    assert "units" not in xr.open_zarr(tmp_path / "b.zarr", chunks=None).frequency.attrs
    text = (tmp_path / "b.zarr" / "zarr.json").read_text()
    manifest = json.loads(text, parse_constant=pytest.fail)["attributes"]["hersey"]
    assert manifest["scenario"]["units"] == "consistent"


@pytest.mark.parametrize("suffix", [".zarr", ".parquet"])
def test_only_what_is_lacking_is_done_again(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / f"a{suffix}"
    before = hersey.sweep(TRAIN, DRAG, **GRID, out=out, work=hersey.Work(chunk=7))
    if suffix == ".zarr":
        (out / "status" / "c" / "3").unlink()  # as of a worker that was killed before it told
        (out / "frequency" / "c" / "1" / "1" / "0").write_bytes(b"torn")
    else:
        (out / "0000003.parquet").write_bytes(b"torn")
    followed = []
    rules_follow = following.Rules.follow
    monkeypatch.setattr(checkpoint, "trial", lambda _rules, sets: following.Trial(sets.sample(1), "", 1.0))
    monkeypatch.setattr(checkpoint, "refuse_early", lambda _rules, _sets: None)

    def follow(rules: following.Rules, sets: Sets, *more: Any) -> Any:
        followed.append(sets.shape)
        return rules_follow(rules, sets, *more)

    monkeypatch.setattr(following.Rules, "follow", follow)
    after = hersey.sweep(TRAIN, DRAG, **GRID, out=out)
    assert followed == [(1, 1, 7)]
    assert {k: after.attrs[k] for k in ("kinds", "stick_slip")} == {
        k: before.attrs[k] for k in ("kinds", "stick_slip")
    }
    monkeypatch.undo()
    if suffix == ".zarr":
        assert_same(after, hersey.sweep(TRAIN, DRAG, **GRID))
    assert len(pl.read_parquet(out) if suffix == ".parquet" else after.kind.values.ravel()) == 70


def test_a_task_looks_first_whether_its_chunk_is_there(shared: Path) -> None:
    manifest = kind_of(shared).read_manifest(shared)
    assert manifest is not None
    folder = kind_of(shared).open(shared, Cut(tuple(manifest["shape"]), tuple(manifest["chunk"])), ())
    rules = following.Rules(DRAG, None, "flying", None, 1e-9, 0)
    piece = Later(Sets({}, zip=False), folder.cut, 3)
    piece.piece = lambda: Piece(3, 21, Sets({}, zip=False))  # type: ignore[method-assign]
    assert following.keep(rules, folder, piece) == folder.note(3) != {}


def test_what_is_counted_is_what_is_counted_in_memory(tmp_path: Path) -> None:
    """With sets that fail: their indices and reasons too."""
    few = hersey.Work(most_steps=150)
    memory = hersey.sweep(TRAIN, DRAG, **GRID, work=few)
    counted = summary(memory)
    assert 20 < counted["kinds"]["failed"] < 70
    for suffix in (".zarr", ".parquet"):
        out = tmp_path / f"a{suffix}"
        found = hersey.sweep(TRAIN, DRAG, **GRID, out=out, work=replace(few, chunk=4))
        again = hersey.sweep(TRAIN, DRAG, **GRID, out=out, work=few)
        for each in (found, again):
            assert each.attrs["kinds"] == counted["kinds"]
            assert each.attrs["stick_slip"] == counted["stick_slip"]
            assert each.attrs["failures"][:20] == counted["failures"][:20]
            more = len(counted["failures"]) - 20
            assert each.attrs["failures"][20:] == ([f"and {more} more"] if more > 0 else [])


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"stiffness": [500.0]}, "stiffness has 5 values there, but 1 value here"),
        ({"stiffness": GRID["stiffness"] * 1.1}, "stiffness is 500 to 2000 there, but 550 to 2200 here"),
        ({"stiffness": GRID["stiffness"][[0, 2, 1, 3, 4]]}, "stiffness has other values there"),
        ({"mass": 2.0}, "mass is 1 there, but 2 here"),
        ({"work": hersey.Work(tolerance=1e-8)}, "tolerance is 1e-09 there, but 1e-08 here"),
        ({"start": "steady"}, "start is rest there, but steady here"),
        ({"work": hersey.Work(most_steps=1e6)}, "most steps is 5000000 there, but 1000000 here"),
        ({"duration": 3.0}, "duration is None there, but 3.0 here"),
        ({"work": hersey.Work(chunk=4)}, "has chunks of 7 sets, not 4"),
    ],
)
def test_another_sweep_is_refused(change: dict[str, Any], says: str, shared: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in shared.rglob("*") if path.is_file()}
    with pytest.raises(OutputError) as caught:
        hersey.sweep(TRAIN, DRAG, **{**GRID, **change}, out=shared)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)
    assert before == {path: path.stat().st_mtime_ns for path in before}


def test_a_sweep_that_shall_not_go_on_is_refused(shared: Path) -> None:
    with pytest.raises(OutputError, match="use overwrite=True to replace it, or omit resume=False"):
        hersey.sweep(TRAIN, DRAG, **GRID, out=hersey.SweepFolder(shared, resume=False))


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep that is kept, in chunks of 7."""
    out = tmp_path_factory.mktemp("kept") / "a.zarr"
    hersey.sweep(TRAIN, DRAG, **GRID, out=out, work=hersey.Work(chunk=7))
    return out


@pytest.mark.parametrize(
    "change",
    [
        {"chunk": [5, 2, 10**18]},
        {"chunk": [2, 1, 7]},
        {"chunk": [1, 1, 0]},
        {"chunk": [1, 7]},
        {"chunk": "../.."},
        {"shape": [-1, 2, 7]},
        {"format": 3},
        {"format": "1"},
        {"scenario": None},
        {"scenario": []},
        {"scenario": {"parameters": 3}},
        {"scenario_sha256": "00"},
        {"variables": []},
    ],
)
def test_a_damaged_manifest_is_not_believed(change: dict[str, Any], shared: Path, tmp_path: Path) -> None:
    out = tmp_path / "a.zarr"
    shutil.copytree(shared, out)
    told = json.loads((out / "zarr.json").read_text())
    told["attributes"]["hersey"] |= change
    (out / "zarr.json").write_text(json.dumps(told))
    with pytest.raises(OutputError, match=r"damaged|of another scenario") as caught:
        hersey.sweep(TRAIN, DRAG, **GRID, out=out)
    assert "\n" not in str(caught.value)


def test_a_damaged_note_is_told(tmp_path: Path) -> None:
    """One that is whole and says something else than a note does."""
    out = tmp_path / "a.parquet"
    hersey.sweep(TRAIN, DRAG, **GRID, out=out, work=hersey.Work(chunk=7))
    chunk = out / "0000004.parquet"
    pl.read_parquet(chunk).write_parquet(chunk, metadata={"hersey": '{"kinds": 3}'})
    with pytest.raises(OutputError, match="the record of chunk 4 is damaged"):
        hersey.sweep(TRAIN, DRAG, **GRID, out=out)


def test_another_version_is_refused(shared: Path) -> None:
    manifest = kind_of(shared).read_manifest(shared)
    assert manifest is not None
    there = {**manifest["scenario"], "hersey_version": "0.0.1"}
    assert store.difference(there, manifest["scenario"]) == (
        f"hersey version is 0.0.1 there, but {_core.VERSION} here"
    )


def test_one_starts_anew_only_where_told_and_only_over_ours(tmp_path: Path) -> None:
    out = tmp_path / "a.zarr"
    hersey.sweep(TRAIN, DRAG, drive_speed=[1.0], out=out)
    anew = hersey.sweep(TRAIN, DRAG, **GRID, out=hersey.SweepFolder(out, resume=False, overwrite=True))
    assert_same(anew, hersey.sweep(TRAIN, DRAG, **GRID))
    assert [path.name for path in tmp_path.iterdir()] == ["a.zarr"]
    for name in ("b.zarr", "b.parquet"):
        other = tmp_path / name
        other.mkdir()
        (other / "mine.txt").write_text("dear")
        for out in (other, hersey.SweepFolder(other, resume=False, overwrite=True)):
            with pytest.raises(OutputError, match="not made by a hersey sweep"):
                hersey.sweep(TRAIN, DRAG, drive_speed=[1.0], out=out)
        assert (other / "mine.txt").read_text() == "dear"
    (tmp_path / "c.zarr").write_text("a file")
    for path, says in (
        ("c.zarr", "is a file"),
        ("none/d.zarr", "there is no directory .*Make it first"),
        ("e.txt", "must end in"),
    ):
        with pytest.raises(OutputError, match=says):
            hersey.sweep(TRAIN, DRAG, drive_speed=[1.0], out=tmp_path / path)


def test_two_at_once_are_refused(shared: Path) -> None:
    with (
        store._locked(shared / "status" / ".lock", shared),
        pytest.raises(OutputError, match="in use by another process"),
    ):
        hersey.sweep(TRAIN, DRAG, **GRID, out=shared)


def test_values_out_of_range_are_refused_before_anything_is_kept(tmp_path: Path) -> None:
    out = tmp_path / "a.zarr"
    with pytest.raises(ParameterError, match=r"^stiffness is -1: it must be greater than 0"):
        hersey.sweep(TRAIN, DRAG, stiffness=[100, -1], drive_speed=[1.0, 2.0], out=out)
    with pytest.raises(ParameterError, match="stick_speed is 2"):
        hersey.sweep(TRAIN, DRAG, stick_speed=[0.1, 2.0], drive_speed=[1.0, 2.0], out=out)
    with pytest.raises(ParameterError, match=r"^stick_speed is 0\.5"):  # each goes with some of the others
        hersey.sweep(
            TRAIN, DRAG, stick_speed=[0.1, 0.5], transition_speed=[0.3, 1.0], drive_speed=1.5, out=out
        )
    assert not out.exists()
    sets = {**PAIRS, "stiffness": np.where(np.arange(23) == 17, -1.0, PAIRS["stiffness"])}
    with pytest.raises(ParameterError, match=r"set 17: stiffness is -1") as caught:
        hersey.sweep(TRAIN, DRAG, **sets, out=out, work=hersey.Work(chunk=5))
    assert caught.value.index == 17
    with pytest.raises(ParameterError, match=r"chunk is the number 2\.5\. It must be a whole number"):
        hersey.sweep(TRAIN, DRAG, **GRID, out=out, work=hersey.Work(chunk=2.5))  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="without out or client"):
        hersey.sweep(TRAIN, DRAG, **GRID, work=hersey.Work(chunk=2))


def test_nothing_as_long_as_the_sweep_is_laid_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A thousand million sets are begun, and the first chunk fails for want of a disk."""
    monkeypatch.setattr("hersey.scale.zarr_folder.write_file", _full)
    with pytest.raises(
        OutputError, match=r"No space left on device; 0 of \d+ chunks are finished. Repeat the command"
    ):
        hersey.sweep(
            TRAIN,
            DRAG,
            stiffness=np.linspace(500, 900, 1000),
            mass=np.linspace(1, 2, 1000),
            drive_speed=np.linspace(0.4, 2, 1000),
            out=tmp_path / "a.zarr",
            work=hersey.Work(chunk=10_000),
        )


def _full(path: Path, _content: bytes) -> None:
    raise OutputError(f"{path} cannot be written: No space left on device")


def test_a_worker_that_does_not_see_the_folder_is_told(client: Client, tmp_path: Path) -> None:
    rules = following.Rules(DRAG, None, "rest", None, 1e-9, 1000)
    sets = Sets({name: np.array(1.0) for name in following.PARAMETERS}, zip=False)
    tried = following.Trial(sets, "", 1.0)
    seen = (tmp_path / "none.zarr", kind_of(Path("a.zarr")), "0" * 64)
    with pytest.raises(OutputError, match=r"none.zarr is not visible on "):
        checkpoint._probed(client, rules, tried, seen)


def test_other_last_bits_are_told() -> None:
    assert following.hashes_differ([("a", "1"), ("b", "1")], "1") == []
    (differ,) = following.hashes_differ([("a", "1"), ("b", "2"), ("c", "2")], "1")
    assert (differ.kind, differ.values) == ("workers with other last bits", {"worker": "b", "more": 1})
    assert str(differ).startswith("worker b and 1 more gives slightly different last bits")


def test_chunks_take_a_second_or_two_and_all_have_enough_to_do() -> None:
    assert following.usual_chunk(10**9, 25e-6, 2) == 60_000
    assert following.usual_chunk(10**6, 25e-6, 2) == 31_250
    assert following.usual_chunk(10**5, 25e-6, 2) == 10_000  # a quarter of a second, and more than one each
    assert following.usual_chunk(10**9, 15e-3, 100) == 10_000  # a hundred thousand chunks at the most
    assert following.usual_chunk(3, 10.0, 2) == 1
    assert following.usual_chunk(10**9, 0.0, 2) == 500_000


def test_without_zarr_the_way_out_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(MissingFileError, match=r"pip install 'hersey\[scale\]', or use .parquet"):
        hersey.sweep(TRAIN, DRAG, drive_speed=1.0, out=tmp_path / "a.zarr")
    monkeypatch.setitem(sys.modules, "distributed", None)
    hersey.sweep(TRAIN, DRAG, drive_speed=1.0, out=tmp_path / "a.parquet")


def test_a_command_that_is_killed_goes_on(tmp_path: Path) -> None:
    """Killed outright, then by Ctrl-C, then to the end: nothing finished is lost, no bit is another."""
    (tmp_path / "s.toml").write_text(SCENARIO)
    typed = [*HERSEY, "sweep", "s.toml", "--out", "a.zarr", "--chunk", "500"]
    out, before = tmp_path / "a.zarr", set[str]()
    for kill in (signal.SIGKILL, signal.SIGINT):
        process = subprocess.Popen(typed, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
        begun = time.monotonic()
        while len(finished(out)) <= len(before) + 2 and time.monotonic() - begun < 20:
            time.sleep(0.01)
        os.kill(process.pid, kill)
        _, said = process.communicate()
        assert before < finished(out)
        before = finished(out)
        assert len(before) < 80
        if kill == signal.SIGINT:
            assert said.splitlines()[-2:] == [
                f"hersey: {len(before)} of 80 chunks are finished. Repeat the command to continue",
                "hersey: interrupted",
            ]
    done = run("sweep", "s.toml", "--out", "a.zarr", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert f"- {len(before)} of 80 chunks were there already" in done.stdout
    assert_same(xr.open_zarr(out, chunks=None), read_scenario(tmp_path / "s.toml").run())


def finished(out: Path) -> set[str]:
    folder = out / "status" / "c"
    return {each.name for each in folder.iterdir() if each.name.isdigit()} if folder.is_dir() else set()


def test_ctrl_c_while_workers_start_is_for_the_command_alone(tmp_path: Path) -> None:
    """A terminal sends it to all that it began; workers that load say nothing of it."""
    (tmp_path / "s.toml").write_text(SCENARIO)
    typed = [*HERSEY, "sweep", "s.toml", "--out", "a.zarr", "--workers", "2"]
    process = subprocess.Popen(typed, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True)
    begun, command = time.monotonic(), psutil.Process(process.pid)
    while time.monotonic() - begun < 20 and len(command.children()) < 2:
        time.sleep(0.01)
    time.sleep(0.1)  # they have begun to load
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate()
    assert process.returncode == 130
    assert said.splitlines()[-1:] == ["hersey: interrupted"]
    assert "Traceback" not in said


def test_the_command_lets_processes_work_and_says_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(SCENARIO.replace("count = 40", "count = 4"))
    done = run("sweep", "s.toml", "--out", "a.parquet", "--workers", "2", "--json", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    printed = json.loads(done.stdout)
    counted = summary(read_scenario(tmp_path / "s.toml").run())
    assert {name: printed[name] for name in counted} == counted
    assert pl.read_parquet(tmp_path / "a.parquet").height == 4000


@pytest.mark.parametrize(
    ("typed", "says"),
    [
        (["--out", "a.zarr", "--chunk", "0"], "chunk is 0: it must be from 1 to 40000 sets"),
        (["--out", "a.csv", "--chunk", "10"], "--chunk needs a folder: add --out sweep.zarr"),
        (["--chunk", "10"], "--chunk needs a folder: add --out sweep.zarr"),
        (
            ["--out", "a.zarr", "--workers", "2", "--scheduler", "tcp://a:1"],
            "exclude each other",
        ),
        (["--out", "a.zarr", "--workers", "2", "--threads", "2"], "--threads is for this process only"),
        (["--scheduler", "nowhere"], "'nowhere' is not the address of a scheduler"),
    ],
)
def test_what_cannot_be_asked_is_one_line(typed: list[str], says: str, tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(SCENARIO)
    done = run("sweep", "s.toml", *typed, cwd=tmp_path)
    assert done.returncode == 2
    assert says in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]
