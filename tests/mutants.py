"""Faults planted one by one and what became of them: `make mutants-python` pipes the list of mutmut in."""

from __future__ import annotations

import re
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable

#: `hersey.damping.design.x_design__mutmut_3: survived`; a method's name begins with another letter.
_LINE = re.compile(r"\s*(hersey[\w.]*?)\.x[_\u01c1]\S*: (.+?)\s*")


def counted(lines: Iterable[str]) -> dict[str, Counter[str]]:
    """Number of faults by module and outcome."""
    outcomes: dict[str, Counter[str]] = defaultdict(Counter)
    for line in lines:
        if match := _LINE.fullmatch(line):
            outcomes[match[1]][match[2]] += 1
    return outcomes


def table(outcomes: dict[str, Counter[str]]) -> str:
    """One line per module: killed, survived, and whatever else there was."""
    lines = []
    for module in sorted(outcomes):
        count = outcomes[module]
        rest = [f"{n} {what}" for what, n in sorted(count.items()) if what not in ("killed", "survived")]
        lines.append(
            f"{module:48s} {count['killed']:5d} killed {count['survived']:5d} survived  " + ", ".join(rest)
        )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.stdout.write(table(counted(sys.stdin)) + "\n")
