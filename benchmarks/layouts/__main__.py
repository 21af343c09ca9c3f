"""Write docs/validation/layouts.md: exports of instruments, rebuilt, and what commands make of each.

Usage: python -m benchmarks.layouts [--only NAME,NAME]
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from benchmarks.layouts.cases import CASES
from benchmarks.layouts.trying import Outcome, tried

PAGE = Path(__file__).parents[2] / "docs" / "validation" / "layouts.md"
WORDS = """# Exports of instruments

`python -m benchmarks.layouts` writes this page. It rebuilds the exports of {count} instruments and loggers
with made-up numbers, types commands on each, follows their advice to the letter, and compares every number
with what was written. Where the second column says so, the form is that of a real file, or of a reader of
such files by others. The rest is rebuilt from what is known of the instrument; a real file may differ. What
proposes a layout was developed on these exports.

| | right | wrong | refused |
| --- | --- | --- | --- |
| `hersey fit`, and what it advises | {right} | {wrong} | {refused} |
| of these at once | {once} | | |
| `hersey inspect --save-mapping`, then `hersey fit` | {inspected} | {inspected_wrong} | {inspected_refused} |

Before hersey knew `[layout]`, 18 were right from `hersey fit`, 5 were wrong and 23 were refused. The table
counts the commands that were typed until the numbers were right. A user states the units or the time between
rows where the file does not.

| export | | from `fit` | from `inspect` | `[layout]` |
| --- | --- | --- | --- | --- |
"""


def _word(outcome: Outcome) -> str:
    return str(len(outcome.commands)) if outcome.right else outcome.wrong or "refused"


def _layout(folder: Path) -> str:
    """The proposed layout in one cell."""
    mapping = folder / "hersey.toml"
    text = mapping.read_text(encoding="utf-8") if mapping.exists() else ""
    lines = text.partition("[layout]\n")[2].partition("\n\n")[0].splitlines()
    return "; ".join(f"`{line}`" for line in lines)


def _tried(folder: Path, name: str) -> tuple[Outcome, Outcome, str]:
    """What comes of an export from a fit, from an inspection, and the layout."""
    write, ending = CASES[name]
    outcomes = []
    for inspected in (False, True):
        path = folder / f"{name}-{inspected}" / f"log{ending}"
        path.parent.mkdir()
        outcomes.append(tried(path, write(path), inspected=inspected))
    return outcomes[0], outcomes[1], _layout(path.parent)


def _page(found: dict[str, tuple[Outcome, Outcome, str]]) -> str:
    fits, inspections = ([each[i] for each in found.values()] for i in (0, 1))
    head = WORDS.format(
        count=len(found),
        right=sum(each.right for each in fits),
        wrong=sum(bool(each.wrong) for each in fits),
        refused=sum(not each.read for each in fits),
        once=sum(each.right and len(each.commands) == 1 for each in fits),
        inspected=sum(each.right for each in inspections),
        inspected_wrong=sum(bool(each.wrong) for each in inspections),
        inspected_refused=sum(not each.read for each in inspections),
    )
    rows = []
    for name, (fit, inspection, layout) in found.items():
        said = (CASES[name][0].__doc__ or "").rstrip(".")
        title, _, about = said.partition(": ")
        rows.append(f"| {title} | {about} | {_word(fit)} | {_word(inspection)} | {layout} |")
    return head + "\n".join(rows) + "\n"


def main() -> None:
    """Try all layouts, or some of them without writing the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="names of layouts, with commas between them")
    only = [name for name in parser.parse_args().only.split(",") if name]
    with tempfile.TemporaryDirectory() as folder:
        found = {name: _tried(Path(folder), name) for name in only or CASES}
    if only:
        for name, (*outcomes, layout) in found.items():
            for outcome in outcomes:
                print(name, _word(outcome), layout, *outcome.commands, *outcome.said, sep="\n  ")
        return
    PAGE.write_text(_page(found), encoding="utf-8")


if __name__ == "__main__":
    main()
