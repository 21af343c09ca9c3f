"""Sweeps that outgrow a machine: what workers cost, what is lost when they are killed, what memory they take.

Parts, each against its bound (writes SCALE.md, or the parts that were run into it):

chunk   following and keeping a chunk, and what the scheduler takes for a task, against the time of a task
split   a million sets by two workers against half of the time of one process, in turn; bits compared
kills   workers killed ten times and the command three times (SIGKILL); chunks and bits compared
memory  ten million sets by two workers: greatest memory of each process

Usage: python -m benchmarks.scale [chunk split kills memory] [--sets 1e6]
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import psutil
from distributed import Client, LocalCluster

import hersey
from hersey.motion.following import note_of, trial, usual_chunk, values_of
from hersey.motion.sets import Later
from hersey.motion.sweep import planned
from hersey.scale.cluster import quiet
from hersey.scale.cutting import Cut
from hersey.scale.kinds import kind_of
from hersey.scale.local import local_workers
from hersey.scale.tasks import done

WORKERS = 2
#: Bounds: of the split, of the scheduler's share of a task, of memory in bytes.
SPLIT, SHARE, MEMORY = 1.15, 0.02, 1.5e9
KILLS, CLIENT_KILLS = 10, 3
OUT = Path(__file__).with_name("SCALE.md")
TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
COMMAND = [sys.executable, "-m", "hersey.cli", "sweep"]
SCENARIO = """
[parameters]
stiffness = {{ from = 500, to = 2000, count = {stiffness}, spacing = "log" }}
mass = 1
transition_force = {{ from = 25, to = 100, count = {force} }}
transition_speed = 1
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_speed = {{ from = 0.4, to = 2.4, count = 100 }}
[options]
units = "consistent"
"""


def axes(sets: int) -> dict[str, Any]:
    """Return the values of the sweep: 100 drive speeds, 100 stiffnesses, as many forces as it takes."""
    stiffness = min(100, max(sets // 100, 1))
    force = max(sets // (100 * stiffness), 1)
    return {
        "stiffness": np.geomspace(500, 2000, stiffness),
        "transition_force": np.linspace(25, 100, force),
        "drive_speed": np.linspace(0.4, 2.4, 100),
    }


def scenario(folder: Path, sets: int) -> Path:
    """Write the same sweep as a scenario."""
    values = axes(sets)
    path = folder / "scenario.toml"
    path.write_text(
        SCENARIO.format(stiffness=values["stiffness"].size, force=values["transition_force"].size)
    )
    return path


def bits(result: Any) -> str:
    """Return the hash of all numbers, in memory or read from a folder."""
    words = result.kind.attrs.get("flag_meanings", "").split()
    digest = hashlib.sha256()
    for name in sorted(str(name) for name in result.data_vars if name != "status"):
        values = result[name].values
        values = np.array(words)[values] if words and name == "kind" else values
        digest.update(np.ascontiguousarray(values.astype("U16") if name == "kind" else values).tobytes())
    return digest.hexdigest()


def opened(path: Path) -> Any:
    """Return a kept sweep."""
    import xarray as xr

    return xr.open_zarr(path, chunks=None)


def chunk(folder: Path, sets: int) -> dict[str, Any]:
    """Cost of a task: following, keeping, and the scheduler's share."""
    given = dict.fromkeys(("mass", "transition_speed", "ehl_exponent", "mixed_exponent", "stick_speed"))
    some = axes(sets)
    order = ("stiffness", "mass", "transition_force", "transition_speed", "ehl_exponent", "mixed_exponent")
    varied = {name: some.get(name, given.get(name)) for name in (*order, "stick_speed", "drive_speed")}
    all_sets, rules = planned(TRAIN, DRAG, varied, zip=False, start="rest", duration=None)
    path = folder / "chunk.zarr"
    wished = usual_chunk(10**9, trial(rules, all_sets).each, WORKERS)
    cut = Cut.into(all_sets.shape, min(wished, all_sets.count))
    few = {name: values[:2] for name, values in some.items()}
    hersey.sweep(TRAIN, DRAG, **few, out=path)  # of which the empty folder is used
    manifest = kind_of(path).read_manifest(path)
    assert manifest is not None
    from hersey.scale.store import Variable

    variables = tuple(Variable(name, dtype, {}, float(fill)) for name, dtype, fill in manifest["variables"])
    target = kind_of(path).open(path, cut, variables)
    for each in (*path.glob("*/c/0"), path / "status" / "c"):
        if each.is_dir():  # of an array with chunks
            shutil.rmtree(each)
    writing, following = [], []
    for number in range(min(5, cut.count)):
        piece = Later(all_sets, cut, number)
        begun = time.perf_counter()
        motions = rules.follow(piece.piece().sets)
        following.append(time.perf_counter() - begun)
        values = values_of(motions)
        begun = time.perf_counter()
        columns = piece.piece().sets.columns()
        target.write(number, values, columns, note_of(motions, values, 0))
        writing.append(time.perf_counter() - begun)
    with dask_workers(WORKERS) as client:
        tasks = 2000
        for _ in done(_nothing, range(100), client=client):
            pass
        begun = time.perf_counter()
        for _ in done(_nothing, range(tasks), client=client):
            pass
        each_task = (time.perf_counter() - begun) / tasks
        lasting = 0.5
        begun = time.perf_counter()
        for _ in done(partial(_lasting, lasting), range(40), client=client):
            pass
        idle = (time.perf_counter() - begun) / (40 / WORKERS) / lasting - 1
    took = median(following)
    share = (median(writing) + each_task) / took
    return {
        "sets of a chunk": cut.size(0),
        "following it, s": round(took, 3),
        "per set, us": round(took / cut.size(0) * 1e6, 2),
        "keeping it, ms": round(median(writing) * 1e3, 2),
        "scheduler and client per task, ms": round(each_task * 1e3, 2),
        "both, of a task": f"{share:.2%} (bound {SHARE:.0%})",
        "time that 40 tasks of 0.5 s take beyond an ideal split": f"{idle:.2%}",
        "kept": share < SHARE,
    }


@contextmanager
def dask_workers(count: int) -> Iterator[Client]:
    """Yield the client of a scheduler with workers on this machine: what a task costs on a cluster."""
    quiet()
    with (
        LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        yield client


def _nothing(item: int) -> int:
    return item


def _lasting(seconds: float, item: int) -> int:
    time.sleep(seconds)
    return item


def split(folder: Path, sets: int) -> dict[str, Any]:
    """One process and two workers in turn."""
    values = axes(sets)
    alone, shared, same = [], [], True
    with local_workers(WORKERS) as client:
        hersey.sweep(
            TRAIN,
            DRAG,
            drive_speed=values["drive_speed"],
            work=hersey.Work(client=client),
            out=folder / "warm.zarr",
        )
        for turn in range(3):
            begun = time.perf_counter()
            one = hersey.sweep(TRAIN, DRAG, **values)
            alone.append(time.perf_counter() - begun)
            path = folder / f"split-{turn}.zarr"
            begun = time.perf_counter()
            two = hersey.sweep(TRAIN, DRAG, **values, work=hersey.Work(client=client), out=path)
            shared.append(time.perf_counter() - begun)
            same = same and bits(one) == bits(two)
            shutil.rmtree(path)
    ratios = [two / (one / WORKERS) for one, two in zip(alone, shared, strict=True)]
    return {
        "sets": int(np.prod([each.size for each in values.values()])),
        "one process, s": [round(each, 1) for each in alone],
        f"{WORKERS} workers, kept in .zarr, s": [round(each, 1) for each in shared],
        "of an ideal split": f"{median(ratios):.3f} (bound {SPLIT})",
        "same bits": same,
        "kept": same and median(ratios) <= SPLIT,
    }


def workers_of(process: int) -> list[psutil.Process]:
    """Return the workers of a command."""
    try:
        children = psutil.Process(process).children(recursive=True)
        return [each for each in children if "worker.py" in " ".join(each.cmdline())]
    except psutil.Error:
        return []


def finished(path: Path) -> set[str]:
    """Return the chunks that are kept."""
    folder = path / "status" / "c"
    return {each.name for each in folder.iterdir() if each.name.isdigit()} if folder.is_dir() else set()


def kills(folder: Path, sets: int) -> dict[str, Any]:
    """Kill workers and the command; go on; compare."""
    sets = 2 * sets
    described, path, chance = scenario(folder, sets), folder / "killed.zarr", random.Random(1)
    command = [*COMMAND, str(described), "--out", str(path), "--workers", str(WORKERS), "--json"]
    command += ["--chunk", str(sets // 200)]
    one = hersey.sweep(TRAIN, DRAG, **axes(sets))
    workers_killed = clients_killed = lost = orphans = 0
    while True:
        before = finished(path)
        begun = len(before)
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while process.poll() is None:
            time.sleep(chance.uniform(0.3, 1.5))
            now = finished(path)
            lost += len(before - now)
            before |= now
            found = workers_of(process.pid)
            if not found or len(now) <= begun:
                continue  # the workers are not all there yet
            if clients_killed < CLIENT_KILLS and workers_killed >= 3 * (clients_killed + 1):
                process.kill()
                process.wait()
                clients_killed += 1
                time.sleep(2)
                orphans += sum(each.is_running() and each.status() != "zombie" for each in found)
            elif workers_killed < KILLS:
                chance.choice(found).send_signal(signal.SIGKILL)
                workers_killed += 1
        stdout, stderr = process.communicate()
        lost += len(before - finished(path))
        if process.returncode == 0:
            break
        if process.returncode != -signal.SIGKILL:
            raise RuntimeError(stderr)
    same = bits(opened(path)) == bits(one)
    return {
        "sets": json.loads(stdout)["sets"],
        "chunks": len(finished(path)),
        "workers killed": workers_killed,
        "commands killed": clients_killed,
        "workers that outlived their command": orphans,
        "finished chunks lost": lost,
        "same bits as one process": same,
        "kept": same and not lost and (workers_killed, clients_killed) == (KILLS, CLIENT_KILLS),
    }


def memory(folder: Path, sets: int) -> dict[str, Any]:
    """Greatest memory of each process."""
    sets = 10 * sets
    described, path = scenario(folder, sets), folder / "memory.zarr"
    command = [*COMMAND, str(described), "--out", str(path), "--workers", str(WORKERS), "--json"]
    begun = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    own, greatest = 0, 0
    while process.poll() is None:
        time.sleep(0.2)
        own = max(own, *peaks([process.pid]))
        greatest = max(greatest, *peaks([each.pid for each in workers_of(process.pid)]))
    took = time.perf_counter() - begun
    stdout, _ = process.communicate()
    size = sum(each.stat().st_size for each in path.rglob("*") if each.is_file())
    counted = json.loads(stdout)["sets"]
    return {
        "sets": counted,
        "chunks": len(finished(path)),
        "wall, s": round(took, 1),
        "client with scheduler, MB": round(own / 1e6),
        "greatest worker, MB": round(greatest / 1e6),
        "bound, MB": round(MEMORY / 1e6),
        "on disk, bytes per set": round(size / counted, 1),
        "kept": max(own, greatest) < MEMORY and process.returncode == 0,
    }


def peaks(processes: list[int]) -> Iterator[int]:
    """Yield the greatest memory that each process has held, bytes; 0 of one that is gone."""
    yield 0
    for process in processes:
        try:
            lines = Path(f"/proc/{process}/status").read_text().splitlines()
        except OSError:
            continue
        yield from (int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM"))


PARTS = {"chunk": chunk, "split": split, "kills": kills, "memory": memory}
HEAD = f"""# Sweeps that outgrow a machine

Written by `python -m benchmarks.scale`, Python {platform.python_version()}, on {os.cpu_count()} cores:
the paper's law, started from rest.
Bounds stand beside the figures. What they mean for 10^9 sets stands in `docs/reference/scale.md`.
"""


def section(name: str, figures: dict[str, Any]) -> str:
    """Return the figures of a part as a table."""
    function = PARTS[name]
    rows = "\n".join(f"| {key} | {value} |" for key, value in figures.items())
    return f"## {name}\n\n{(function.__doc__ or '').strip()}\n\n| | |\n|---|---|\n{rows}\n"


def main() -> None:
    """Measure the parts that are named, all by default, and write them."""
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="*", choices=[[], *PARTS], default=list(PARTS))
    parser.add_argument("--sets", type=float, default=1e6)
    asked = parser.parse_args()
    written = dict(part.split("\n", 1) for part in _sections())
    kept = True
    for name in asked.parts:
        with tempfile.TemporaryDirectory() as folder:
            figures = PARTS[name](Path(folder), int(asked.sets))
        kept = kept and figures["kept"]
        text = section(name, figures)
        print(text)
        written[name] = text.split("\n", 1)[1]
    if asked.sets == 1e6:
        body = "\n".join(f"## {name}\n{written[name].rstrip()}\n" for name in PARTS if name in written)
        OUT.write_text(f"{HEAD}\n{body}")
    sys.exit(not kept)


def _sections() -> list[str]:
    """What was written before, by part."""
    return OUT.read_text().split("\n## ")[1:] if OUT.exists() else []


if __name__ == "__main__":
    main()
