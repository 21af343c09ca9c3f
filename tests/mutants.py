"""Faults planted one by one and what became of them: `make mutants-python` calls it in a copy of the tree.

Mutmut plants the faults and switches one on by an environment variable. Each is tried here in a process of
its own: in a forked one, as mutmut has it, polars waits for ever on threads that the fork left behind.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatch
from pathlib import Path

#: `hersey.damping.design.x_design__mutmut_3: survived`; a method's name begins with another letter.
_LINE = re.compile(r"\s*((hersey[\w.]*?)\.x[_\u01c1]\S*): (.+?)\s*")
_PYTEST = [sys.executable, "-m", "pytest", "-q", "-x", "-n0", "-pno:cacheprovider", "-mnot slow"]
#: Exit codes of pytest that say that no test saw the fault: all passed, or none was there.
_UNSEEN = (0, 5)


def named(lines: Iterable[str]) -> dict[str, list[str]]:
    """Faults by module, from the list that mutmut prints."""
    faults: dict[str, list[str]] = defaultdict(list)
    for line in lines:
        if match := _LINE.fullmatch(line):
            faults[match[2]].append(match[1])
    return faults


def sample(faults: dict[str, list[str]], patterns: Sequence[str], most: int, seed: int) -> list[str]:
    """At most so many faults of each module that is asked for, drawn by a seed."""
    drawn = []
    for module in sorted(faults):
        asked = [f for f in faults[module] if not patterns or any(fnmatch(f, p) for p in patterns)]
        drawn += random.Random(f"{seed} {module}").sample(asked, min(most, len(asked)))
    return drawn


def files_for(module: str, root: Path) -> list[str]:
    """Tests of a module: those of its own name first, then all of its room."""
    _, room, *_, stem = module.split(".")
    files = (root / "tests" / room).rglob(f"test_{stem}*.py")
    return [*sorted(path.relative_to(root).as_posix() for path in files), f"tests/{room}"]


def seen(fault: str, module: str, root: Path) -> bool:
    """Whether a test fails while the fault is switched on."""
    done = subprocess.run(
        [*_PYTEST, *files_for(module, root)],
        cwd=root,
        env={**os.environ, "MUTANT_UNDER_TEST": fault, "PYTHONPATH": str(root / "src")},
        capture_output=True,
        check=False,
    )
    return done.returncode not in _UNSEEN


def table(outcomes: dict[str, Counter[bool]]) -> str:
    """One line per module and one for all: faults seen, and how many there were."""
    lines = [f"{name:48s} {c[True]:5d} of {c.total():5d} seen" for name, c in sorted(outcomes.items())]
    total = sum(outcomes.values(), Counter[bool]())
    share = total[True] / max(total.total(), 1)
    return "\n".join([*lines, f"{'all':48s} {total[True]:5d} of {total.total():5d} seen, {share:.0%}"])


def main() -> None:
    """Try the faults that mutmut listed on standard input."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("patterns", nargs="*", help="as 'hersey.damping.design.*'; all if none is given")
    parser.add_argument("--most", type=int, default=10**9, help="of each module, drawn by --seed")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    given = parser.parse_args()
    faults = named(sys.stdin)
    module_of = {fault: module for module, each in faults.items() for fault in each}
    drawn = sample(faults, given.patterns, given.most, given.seed)
    root, outcomes = Path("mutants").resolve(), defaultdict[str, Counter[bool]](Counter)
    with ThreadPoolExecutor(given.cores) as pool:
        for fault, was_seen in zip(
            drawn, pool.map(lambda fault: seen(fault, module_of[fault], root), drawn), strict=True
        ):
            outcomes[module_of[fault]][was_seen] += 1
            if not was_seen:
                sys.stdout.write(f"unseen: {fault}\n")
                sys.stdout.flush()
    sys.stdout.write(f"seed {given.seed}\n{table(outcomes)}\n")


if __name__ == "__main__":
    main()
