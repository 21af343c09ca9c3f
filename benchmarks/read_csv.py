"""Reading and reducing a large CSV, beside plain `polars.read_csv` of the same file in the same run.

Each part runs in a process of its own on one core, so that its peak memory is its own, and times its imports
too; the file is read once before, so that all find it in the page cache.

Usage: python -m benchmarks.table read [--size "1 GB"]
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

from benchmarks.lines import Line, in_turn

#: Share of the speed of polars that is asked.
ASKED = {"hersey.read": 0.7, "hersey.read + steady": 0.4}
PARTS = {
    "polars.read_csv": """
import polars
frame = polars.read_csv(path, comment_prefix="#")
rows = frame.height
""",
    "hersey.read": """
import hersey
log = hersey.read(path)
rows = log.rows
""",
    "hersey.read + steady": """
import hersey
log = hersey.read(path)
points = log.steady(tare="standing")
rows = log.rows
assert points.table["rows"].sum() + points.table["settling_rows"].sum() + sum(
    r.rows for r in points.rejected
) == rows
""",
}
MEASURED = """
import json, os, resource, sys, time
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, {{min(os.sched_getaffinity(0))}})
path = sys.argv[1]
begin = time.perf_counter()
{part}
seconds = time.perf_counter() - begin
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
print(json.dumps({{"seconds": seconds, "peak": peak, "rows": rows}}))
"""


def measure(part: str, path: Path) -> dict[str, float]:
    """Return seconds, peak memory in GB, and rows of one run."""
    command = [sys.executable, "-c", MEASURED.format(part=part), str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def lines(runs: int, size: str = "275 MB") -> list[Line]:
    """Return reading, and reading with its dwells, beside polars."""
    peaks: dict[str, float] = {}

    def run(name: str, path: Path) -> float:
        found = measure(PARTS[name], path)
        peaks[name] = max(peaks.get(name, 0.0), found["peak"])
        return found["seconds"]

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.csv"
        command = [sys.executable, "-m", "hersey.cli", "testbench", "--out", str(path), "--size", size]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        path.read_bytes()
        found = in_turn({name: partial(run, name, path) for name in PARTS}, runs)
        megabytes = path.stat().st_size / 1e6
    peer = "polars.read_csv"
    return [
        Line(
            f"{name}, one core, {megabytes:.0f} MB at {megabytes / found[name]:.0f} MB/s",
            found[name],
            peer,
            found[peer],
            faster=asked,
            beside=f"{peaks[name]:.2f} GB; peer {peaks[peer]:.2f} GB",
        )
        for name, asked in ASKED.items()
    ]
