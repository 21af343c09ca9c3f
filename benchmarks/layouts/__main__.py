"""Usage: python -m benchmarks.layouts [--only NAME]."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from benchmarks.layouts.cases import CASES
from benchmarks.layouts.trying import tried

if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    chosen = parser.parse_args().only.split(",")
    with tempfile.TemporaryDirectory() as folder:
        for name, (write, ending) in CASES.items():
            if chosen != [""] and name not in chosen:
                continue
            for inspected in (False, True):
                path = Path(folder) / f"{name}{inspected}" / f"log{ending}"
                path.parent.mkdir()
                outcome = tried(path, write(path), inspected=inspected)
                word = "right" if outcome.right else outcome.wrong or "refused"
                print(f"{name:18} {len(outcome.commands)} {word}")
                if outcome.right and chosen == [""]:
                    continue
                for typed in outcome.commands:
                    print("      $", typed)
                for said in outcome.said:
                    print("      ", said[:600])
