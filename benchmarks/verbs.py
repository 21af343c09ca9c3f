"""Commands on the shipped examples, each a process of its own, and a second log read and fitted in one.

Usage: python -m benchmarks.table verbs
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

import hersey
from benchmarks.lines import Line, in_turn, timed

EXAMPLES = Path(__file__).parents[1] / "examples"
LOG, MACHINE = str(EXAMPLES / "bench.csv"), str(EXAMPLES / "machine.toml")
TARE = ["--tare", "standing"]
#: Commands as typed in a folder for what they write, and the seconds asked.
VERBS: dict[str, tuple[list[str], float]] = {
    "report": (["report", LOG, "--machine", MACHINE, *TARE, "--out", "report.html", "--force"], 2.5),
    "models": (["models", LOG, *TARE], 1.7),
    "fit": (["fit", LOG, *TARE], 0.7),
    "inspect": (["inspect", LOG], 0.4),
    "map": (["map", MACHINE, LOG, *TARE, "--out", "map.html", "--force"], 0.8),
}
#: The libraries that every command imports: none can be faster than that.
LIBRARIES = "import typer, pydantic, polars, scipy.optimize"
CAMPAIGN = "life.hersey"
ADD = ["--table", str(EXAMPLES / "life" / "runs.csv"), "--means", "--machine", MACHINE]
LIFE = ["life", CAMPAIGN, "--machine", MACHINE, "--out", "life.html", "--force"]


def typed(words: list[str], folder: Path, cache: str = "off") -> float:
    """Return the wall time of a command, s, without what others have kept unless there is a ``cache``."""
    command, around = [sys.executable, "-m", "hersey.cli", *words], os.environ | {"HERSEY_CACHE": cache}
    return timed(lambda: subprocess.run(command, cwd=folder, capture_output=True, check=True, env=around))


def imported() -> float:
    """Return the wall time of importing what commands stand on, in a process of its own, s."""
    return timed(lambda: subprocess.run([sys.executable, "-c", LIBRARIES], check=True))


def added(folder: Path) -> float:
    """Return the wall time of adding every run to a new campaign, s."""
    (folder / CAMPAIGN).unlink(missing_ok=True)
    return typed(["campaign", "add", CAMPAIGN, *ADD], folder)


def fitted() -> float:
    """Return the wall time of reading and fitting a log, s."""
    return timed(lambda: hersey.fit(hersey.read(LOG).steady(tare="standing")))


def lines(runs: int) -> list[Line]:
    """Return every command, and the second log of a process."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for words, _ in VERBS.values():
            typed(words, folder, "kept")  # everything is compiled and in the page cache
        fitted()
        verbs = {name: partial(typed, words, folder) for name, (words, _) in VERBS.items()}
        found = in_turn(verbs | {LIBRARIES: imported}, runs)
        again = in_turn({"fit": partial(typed, VERBS["fit"][0], folder, "kept")}, runs)["fit"]
        second = in_turn({"fit": fitted}, runs)["fit"]
        life = in_turn({"add": partial(added, folder), "life": partial(typed, LIFE, folder)}, runs)
    return [
        *(
            Line(f"`hersey {name}`, demo", found[name], f"`{LIBRARIES}`", found[LIBRARIES], limit=limit)
            for name, (_, limit) in VERBS.items()
        ),
        Line("`hersey fit`, demo, from the cache", again),
        Line("a second log of 35,000 rows in one process, read and fitted", second, limit=0.3),
        Line("`hersey campaign add`, means of 48 runs", life["add"], limit=5),
        Line("`hersey life`, 48 runs", life["life"], limit=10),
    ]
