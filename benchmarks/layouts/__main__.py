"""Write docs/validation/layouts.md: exports of instruments, rebuilt, and what commands make of each.

Usage: python -m benchmarks.layouts [--only NAME,NAME]
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path

from benchmarks.layouts.cases import CASES, UNSEEN
from benchmarks.layouts.truth import Made
from benchmarks.layouts.trying import Outcome, tried

PAGE = Path(__file__).parents[2] / "docs" / "validation" / "layouts.md"
WORDS = """# Exports of instruments

`python -m benchmarks.layouts` writes this page. It rebuilds exports of instruments and loggers with made-up
numbers, types commands on each, follows their advice to the letter, and compares every number with what was
written. Where the second column says so, the form is that of a real file, or of a reader of such files by
others. The rest is rebuilt from what is known of the instrument; a real file may differ. A user states names
of columns, units or the time between rows where the file does not. The tables count the commands that were
typed until the numbers were right.

| | exports | right at once | right after two commands | after more | wrong | refused |
| --- | --- | --- | --- | --- | --- | --- |
{counts}

## Developed on these

What proposes a layout was developed on these {count} exports. Before hersey knew `[layout]`, 18 were right
from `hersey fit`, 5 were wrong and 23 were refused.

{known}

## Not developed on these

These were written from what is known of the instruments before anyone looked at how they are read. At the
first try, 8 of the first 12 were right, 6 of them within two commands; one was wrong (a friction coefficient
was read beside a torque) and three were refused with advice that did not lead to the end. That was mended.
Of the other 11, written after that, 7 were right within two commands at the first try; the advice for one
passed over its clock, and three were refused with the advice to change the file. The table shows them as they
are read now. The two that are refused have a unit behind every number; they are read once it stands in the
header.

{unseen}
"""
HEAD = """| export | | from `fit` | from `inspect` | `[layout]` |
| --- | --- | --- | --- | --- |
"""
Tried = dict[str, tuple[Outcome, Outcome, str]]
Cases = dict[str, tuple[Callable[[Path], Made], str]]


def _word(outcome: Outcome) -> str:
    return str(len(outcome.commands)) if outcome.right else outcome.wrong or "refused"


def _layout(folder: Path) -> str:
    """The proposed layout in one cell."""
    mapping = folder / "hersey.toml"
    text = mapping.read_text(encoding="utf-8") if mapping.exists() else ""
    lines = text.partition("[layout]\n")[2].partition("\n\n")[0].splitlines()
    return "; ".join(f"`{line}`" for line in lines)


def _tried(folder: Path, name: str, cases: Cases) -> tuple[Outcome, Outcome, str]:
    """What comes of an export from a fit, from an inspection, and the layout."""
    write, ending = cases[name]
    outcomes = []
    for inspected in (False, True):
        path = folder / f"{name}-{inspected}" / f"log{ending}"
        path.parent.mkdir()
        outcomes.append(tried(path, write(path), inspected=inspected))
    return outcomes[0], outcomes[1], _layout(path.parent)


def _table(found: Tried, cases: Cases) -> str:
    rows = []
    for name, (fit, inspection, layout) in found.items():
        said = (cases[name][0].__doc__ or "").rstrip(".")
        title, _, about = said.partition(": ")
        rows.append(f"| {title} | {about} | {_word(fit)} | {_word(inspection)} | {layout} |")
    return HEAD + "\n".join(rows)


def _counts(title: str, outcomes: list[Outcome]) -> str:
    """A row of the first table."""
    right = [len(each.commands) for each in outcomes if each.right]
    numbers = [len(outcomes), right.count(1), right.count(2), sum(each > 2 for each in right)]
    numbers += [sum(bool(each.wrong) for each in outcomes), sum(not each.read for each in outcomes)]
    return f"| {title} | {' | '.join(map(str, numbers))} |"


def _page(known: Tried, unseen: Tried) -> str:
    counts = [
        _counts("`hersey fit`, and what it advises", [fit for fit, _, _ in known.values()]),
        _counts("`hersey inspect --save-mapping` first", [inspected for _, inspected, _ in known.values()]),
        _counts("not developed on, `hersey fit`", [fit for fit, _, _ in unseen.values()]),
    ]
    return WORDS.format(
        counts="\n".join(counts),
        count=len(known),
        known=_table(known, CASES),
        unseen=_table(unseen, UNSEEN),
    )


def main() -> None:
    """Try all layouts, or some of them without writing the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="names of layouts, with commas between them")
    only = [name for name in parser.parse_args().only.split(",") if name]
    every = CASES | UNSEEN
    with tempfile.TemporaryDirectory() as folder:
        found = {name: _tried(Path(folder), name, every) for name in only or every}
    if only:
        for name, (*outcomes, layout) in found.items():
            for outcome in outcomes:
                print(name, _word(outcome), layout, *outcome.commands, *outcome.said, sep="\n  ")
        return
    known, unseen = ({name: found[name] for name in cases} for cases in (CASES, UNSEEN))
    PAGE.write_text(_page(known, unseen), encoding="utf-8")


if __name__ == "__main__":
    main()
