"""Life tests of an independent generator: write them, ask hersey, count.

Usage:
    python -m benchmarks.life_tests write FOLDER FIRST LAST    campaigns of these seeds as files
    python -m benchmarks.life_tests run NAME FIRST LAST        ask; rows go to build/life_tests/NAME.jsonl,
                                                               and a run that was stopped goes on
    python -m benchmarks.life_tests count NAME                 the tables of rows
    python -m benchmarks.life_tests page NAME [SLIPS]          write them to benchmarks/LIFE_TESTS.md
    python -m benchmarks.life_tests slips NAME FIRST COUNT     with one mistake each, and as many without
    python -m benchmarks.life_tests suspects NAME FIRST COUNT  the same by the diagnostics alone: no files

Seeds 0 to 999 are for developing and 2000 to 3999 for developing with mistakes; 1000 to 1199 and 5000 to 5399
were counted, 4000 to 4499 with mistakes.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from benchmarks.life_tests import campaign, product, score, slips, suspects, tables
from benchmarks.life_tests.page import page

PAGE = Path("benchmarks/LIFE_TESTS.md")
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


def run_slips(name: str, first: int, count: int, *, files: bool = True) -> None:
    """Ask hersey, or the diagnostics alone, for as many campaigns with a mistake as clean ones."""
    file = BUILD / f"{name}.jsonl"
    file.parent.mkdir(parents=True, exist_ok=True)
    there = {json.loads(line)["seed"] for line in file.read_text().splitlines()} if file.exists() else set()
    for number, seed in enumerate(slips.seeds(first, 2 * count)):
        if seed in there:
            continue
        with file.open("a") as out:
            out.write(json.dumps(_of_slip(seed, number, number < count, files)) + "\n")


def _of_slip(seed: int, number: int, slip: bool, files: bool) -> dict[str, Any]:
    if not files:
        return suspects.row(seed, slip=slip, number=number)
    folder = BUILD / "slips" / f"s{seed}"
    if not (folder / "slip.json").exists():
        slips.write(seed, folder, slip=slip, number=number)
    return slips.row(folder)


def main(arguments: list[str]) -> None:
    """Do what is asked."""
    what, name, *others = arguments
    numbers = [int(each) for each in others if each.isdigit()]
    if what == "write":
        write(Path(name), range(numbers[0], numbers[1] + 1))
    elif what == "run":
        run(name, range(numbers[0], numbers[1] + 1))
    elif what in ("slips", "suspects"):
        run_slips(name, *numbers, files=what == "slips")
    elif what == "count":
        rows = score.read(BUILD / f"{name}.jsonl")
        print(slips.report(rows) if "slip" in rows[0] else score.report(rows))
    elif what == "page":
        mistakes = score.read(BUILD / f"{others[0]}.jsonl") if others else []
        PAGE.write_text(page(score.read(BUILD / f"{name}.jsonl"), mistakes))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
