"""Kills a process that adds runs to a campaign, again and again, and looks at what is left.

``python -m tests.life.kills 200`` in a folder that is empty. About half of the kills come from outside, at a
random moment after a sign of life, which the process gives before and after each commit. The others are set
off by the kernel in the middle of a write: no file may grow beyond a random size. Now and then the campaign
is taken away, so that the next process is killed while it makes a new one.
"""

from __future__ import annotations

import os
import random
import resource
import signal
import sqlite3
import sys
import time
import traceback
from dataclasses import replace
from pathlib import Path

from hersey.life.age import Age
from hersey.life.campaign import Campaign, Entry
from hersey.life.campaign.conversion import entry_of

#: Runs that a process adds if nothing kills it, and those of one transaction.
_RUNS, _TOGETHER = 40, 3
_LONGEST = 0.004


def sample() -> Entry:
    """What is kept of a small table of means."""
    from hersey.damping.dwells import SteadyPoints

    table = {"speed [rpm]": [10, 20, 40, 80], "torque [mN*m]": [5.0, 5.6, 6.3, 7.2]}
    return entry_of(SteadyPoints.from_table(table, isothermal=True), "sample.csv")


def adding(path: Path, first: int, entry: Entry, signs: int) -> None:
    """Add runs of three to a transaction, and say so before and after each commit."""
    with Campaign.create(path) as campaign:
        for number in range(first, first + _RUNS, _TOGETHER):

            def traced(statement: str, number: int = number) -> None:
                if statement.startswith("COMMIT"):
                    os.write(signs, f"b{number}\n".encode())

            campaign._database.set_trace_callback(traced)
            together = [
                (
                    replace(entry, sha256=f"{n:064x}", path=str(path.with_name(f"{n}.csv"))),
                    "F1",
                    Age(n, "pages"),
                )
                for n in range(number, number + _TOGETHER)
            ]
            campaign.add_entries(together)
            os.write(signs, f"d{number}\n".encode())


def killed(path: Path, first: int, entry: Entry, rng: random.Random) -> tuple[list[int], list[int], int]:
    """Numbers whose commit was begun, and was done, and the signal that ended the process."""
    end, signs = os.pipe()
    inside, grown = rng.random() < 0.5, rng.randrange(1, 200_000)
    process = os.fork()
    if process == 0:
        try:
            os.close(end)
            if inside:
                wal = path.with_name(f"{path.name}-wal")
                size = max((each.stat().st_size for each in (path, wal) if each.exists()), default=0)
                signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
                resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
                resource.setrlimit(resource.RLIMIT_FSIZE, (size + grown,) * 2)
            adding(path, first, entry, signs)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
        os._exit(0)
    os.close(signs)
    heard = b""
    if not inside:
        for _ in range(rng.randrange(2 * _RUNS // _TOGETHER)):
            part = os.read(end, 1)
            while part not in (b"\n", b""):
                heard += part
                part = os.read(end, 1)
            heard += part
        time.sleep(rng.uniform(0.0, _LONGEST))
        os.kill(process, signal.SIGKILL)
    _, status = os.waitpid(process, 0)
    while part := os.read(end, 4096):
        heard += part
    os.close(end)
    lines = heard.decode().split()
    begun, done = ([int(line[1:]) for line in lines if line[0] == sign] for sign in "bd")
    assert os.WIFSIGNALED(status) or status == 0, "the process that adds failed by itself"
    return begun, done, os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0


def faults(path: Path, done: set[int], begun: set[int]) -> list[str]:
    """What is wrong with the file that was left."""
    found = []
    if not path.exists():
        return ["the campaign is gone"] if done else []
    with Campaign.create(path) as campaign:
        found += [row[0] for row in campaign._database.execute("PRAGMA integrity_check") if row[0] != "ok"]
        ages = {int(age) for age in campaign.runs()["age"]}
        found += [f"run {n} was committed and is lost" for n in sorted(done - ages)]
        found += [f"run {n} is there and was never committed" for n in sorted(ages - begun)]
        parts = campaign._database.execute(
            "SELECT count(*) FROM runs r WHERE dwells != (SELECT count(*) FROM dwells WHERE run_id = r.id)"
        ).fetchone()[0]
        found += [f"{parts} runs lack dwells"] if parts else []
        for n in sorted(ages):
            first = n - n % _TOGETHER
            if not {first, first + 1, first + 2} <= ages:
                found.append(f"run {n} is there without those of its transaction")
    return found


def main(count: int, folder: Path, seed: int = 1) -> int:
    """Kill so many times and print what was found; return how many faults there are."""
    rng, entry = random.Random(seed), sample()
    path, done, begun = folder / "life.hersey", set[int](), set[int]()
    kills = {signal.SIGKILL: 0, signal.SIGXFSZ: 0, 0: 0}
    between, wrong, first = 0, 0, 0
    while kills[signal.SIGKILL] + kills[signal.SIGXFSZ] < count:
        if rng.random() < 0.2:
            for each in folder.glob("life.hersey*"):
                each.unlink()
            done, begun = set(), set()
        started, ended, how = killed(path, first, entry, rng)
        kills[how] += 1
        between += len(started) > len(ended)
        done |= {n + i for n in ended for i in range(_TOGETHER)}
        begun |= {n + i for n in started for i in range(_TOGETHER)}
        try:
            found = faults(path, done, begun)
        except (Exception, sqlite3.Error) as error:
            found = [f"{type(error).__name__}: {error}"]
        wrong += len(found)
        for each in found:
            sys.stdout.write(f"after kill {sum(kills.values())} by {how}: {each}\n")
        first = (max(begun, default=0) // _TOGETHER + 1) * _TOGETHER
    outside, inside = kills[signal.SIGKILL], kills[signal.SIGXFSZ]
    told = f"{outside} kills from outside, {inside} in a write, {between} of both in a commit: {wrong} faults"
    sys.stdout.write(f"{told}\n")
    return wrong


if __name__ == "__main__":
    sys.exit(bool(main(int(sys.argv[1]), Path.cwd())))
