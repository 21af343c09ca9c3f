"""Life tests of an independent generator: write them, ask hersey, count.

Usage:
    python -m benchmarks.life_tests write FOLDER FIRST LAST    campaigns of these seeds as files
    python -m benchmarks.life_tests run NAME FIRST LAST        ask; rows go to build/life_tests/NAME.jsonl,
                                                               and a run that was stopped goes on
    python -m benchmarks.life_tests count NAME                 the tables of rows
    python -m benchmarks.life_tests slips NAME FIRST LAST      the same with one mistake each, and clean ones

Seeds 0 to 19 are for developing, 1000 to 1199 for the count. Nobody looks at a campaign of the latter.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from benchmarks.life_tests import campaign, product, score, tables

BUILD = Path("build/life_tests")


def write(folder: Path, seeds: range) -> None:
    """Write the campaigns of seeds, each into a folder of its own."""
    for seed in seeds:
        tables.write(campaign.draw(seed), folder / f"c{seed}")


def run(name: str, seeds: range) -> None:
    """Ask hersey for the campaigns of seeds that have no row yet."""
    file = BUILD / f"{name}.jsonl"
    file.parent.mkdir(parents=True, exist_ok=True)
    there = {json.loads(line)["seed"] for line in file.read_text().splitlines()} if file.exists() else set()
    for seed in seeds:
        if seed in there:
            continue
        folder = BUILD / "campaigns" / f"c{seed}"
        if not (folder / "truth.json").exists():
            tables.write(campaign.draw(seed), folder)
        found = product.row(folder)
        with file.open("a") as out:
            out.write(json.dumps(found) + "\n")
        print(seed, found.get("seconds", found.get("error")), flush=True)


def main(arguments: list[str]) -> None:
    """Do what is asked."""
    what, name, *ends = arguments
    seeds = range(int(ends[0]), int(ends[1]) + 1) if ends else range(0)
    if what == "write":
        write(Path(name), seeds)
    elif what == "run":
        run(name, seeds)
    elif what == "count":
        print(score.report(score.read(BUILD / f"{name}.jsonl")))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
