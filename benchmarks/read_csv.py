"""Reading and reducing a large CSV, beside plain `polars.read_csv` of the same file in the same run.

Usage: python benchmarks/read_csv.py [--size "1 GB"]. Each part runs in a process of its own, so that its
peak memory is its own; the file is read once before, so that both find it in the page cache.
"""

from __future__ import annotations

import argparse
import json
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
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
import json, resource, sys, time
path = sys.argv[1]
begin = time.perf_counter()
{part}
seconds = time.perf_counter() - begin
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
print(json.dumps({{"seconds": seconds, "peak": peak, "rows": rows}}))
"""


def measure(part: str, path: Path) -> dict[str, float]:
    """Better of two runs: seconds, peak memory in GB, rows."""
    runs = []
    for _ in range(2):
        command = [sys.executable, "-c", MEASURED.format(part=part), str(path)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        runs.append(json.loads(done.stdout))
    return min(runs, key=lambda r: r["seconds"])


def cpu() -> str:
    """Name of the processor, as the system knows it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))


def main() -> None:
    """Make the file, measure, print the table and keep it in RESULTS.md."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", default="1 GB")
    size = parser.parse_args().size
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.csv"
        command = [sys.executable, "-m", "hersey.cli", "testbench", "--out", str(path), "--size", size]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        megabytes = path.stat().st_size / 1e6
        path.read_bytes()
        found = {name: measure(part, path) for name, part in PARTS.items()}
    floor = found["polars.read_csv"]["seconds"]
    lines = [
        "# Reading a large CSV",
        "",
        f"{megabytes:.0f} MB, {found['hersey.read']['rows'] / 1e6:.1f} million rows; {cpu()};",
        "better of two runs; imports inside, file in the page cache. `python benchmarks/read_csv.py`.",
        "",
        "| | MB/s | time against polars | peak memory (GB) |",
        "|---|---|---|---|",
    ]
    for name, f in found.items():
        rate, ratio = megabytes / f["seconds"], f["seconds"] / floor
        lines.append(f"| {name} | {rate:.0f} | {ratio:.2f} | {f['peak']:.2f} |")
    text = "\n".join(lines) + "\n"
    print(text)
    (HERE / "RESULTS.md").write_text(text)


if __name__ == "__main__":
    main()
