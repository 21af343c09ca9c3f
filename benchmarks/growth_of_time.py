"""How processor time grows with rows, dwells, candidates, draws, specimens and sets.

Every work is run at growing sizes, until the next would take longer than ``--most`` seconds; each size once,
since some results are kept for a second call. The slope of ln(time) over ln(size) is fitted to the upper half
of the range, where the fixed costs matter least. Above 1.1 a work grows faster than its input.
Writes docs/validation/growth.md and growth.svg, or prints the works that are named.

Usage: python -m benchmarks.growth_of_time [rows dwells ...] [--most 10] [--long]
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from pathlib import Path
from typing import Any

import altair as alt
import numpy as np

from benchmarks.motion import machine
from benchmarks.sizes import GROUPS, SERIES, Series

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "validation" / "growth.md"
#: Slope above which a work is explained, and seconds that a size may take.
STEEP, MOST = 1.1, 10.0
WORDS = """# Growth of computing time

`python -m benchmarks.growth_of_time` writes this page. It runs every work at growing sizes and fits the
slope of time over size, both logarithmic, to the upper half of the range. Slope 1 means that twice the input
takes twice the time. Below 1, fixed costs still matter.

{machine}; processor time of all threads, without the start of Python.

![Processor time against size, both logarithmic, for every work](growth.svg)
"""
Measured = list[tuple[int, float]]


def measured(series: Series, most: float, long: bool) -> Measured:
    """Return sizes and seconds of a work."""
    found: Measured = []
    series.run(series.prepare(series.sizes[0]))  # modules are loaded
    for size in (*series.sizes, *(series.more if long else ())):
        if found and not long and found[-1][1] * (size / found[-1][0]) ** STEEP > most:
            break
        found.append((size, _seconds(series, series.prepare(size))))
        print(f"{series.work}: {size:,} {found[-1][1]:.3g} s", file=sys.stderr, flush=True)
    return found


def _seconds(series: Series, given: Any) -> float:
    """Processor time of a work and of the processes that it starts, s."""
    begin = _used()
    series.run(given)
    return _used() - begin


def _used() -> float:
    used = time.process_time()
    if sys.platform != "win32":
        import resource

        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        used += ended.ru_utime + ended.ru_stime
    return used


def slope(found: Measured) -> float:
    """Return the slope over the upper half of the sizes, by their logarithm."""
    middle = math.sqrt(found[0][0] * found[-1][0])
    upper = [each for each in found if each[0] >= 0.9 * middle]
    if len(upper) < 2:
        return math.nan
    x, y = np.log(np.array(upper)).T
    return float(np.polyfit(x, y, 1)[0])


def table(results: dict[Series, Measured]) -> list[str]:
    """Return a row of Markdown for each work."""
    rows = ["| grows | work | from | to | time of the largest | slope |", "|---|---|---|---|---|---|"]
    for series, found in results.items():
        (least, _), (largest, seconds) = found[0], found[-1]
        rows.append(
            f"| {series.group} | {series.work} | {least:,} | {largest:,} | {seconds:.2g} s "
            f"| {_shown(slope(found))} |"
        )
    return rows


def _shown(slope: float) -> str:
    return "-" if math.isnan(slope) else f"{slope:.2f}"


def reasons(results: dict[Series, Measured]) -> list[str]:
    """Return why the steep ones are steep."""
    return [
        f"- **{series.work}**, slope {slope(found):.2f}. {series.why or 'Not explained yet.'}"
        for series, found in results.items()
        if slope(found) > STEEP
    ]


def chart(results: dict[Series, Measured]) -> Any:
    """Return a panel for each thing that grows, with the line of slope 1 through its slowest work."""
    panels = [_panel(group, results) for group in GROUPS]
    return alt.concat(*panels, columns=2).resolve_scale(color="independent")


def _panel(group: str, results: dict[Series, Measured]) -> Any:
    own = {series.work: found for series, found in results.items() if series.group == group}
    rows = [{"size": n, "s": s, "work": work} for work, found in own.items() for n, s in found]
    slowest = max(own.values(), key=lambda found: (len(found) > 1, found[-1][1] / found[-1][0]))
    (least, _), (largest, seconds) = slowest[0], slowest[-1]
    straight = [{"size": n, "s": seconds * n / largest} for n in (least, largest)]
    scale, sizes = alt.Scale(type="log"), {row["size"] for row in rows}
    x = alt.X("size:Q", title=group, scale=scale, axis=_decades(min(sizes), max(sizes), "~s"))
    times = [row["s"] for row in rows]
    y = alt.Y("s:Q", title="Processor time (s)", scale=scale, axis=_decades(min(times), max(times), "~g"))
    legend = alt.Legend(title=None, orient="bottom", columns=1, labelLimit=330)
    guide = alt.Chart(alt.Data(values=straight)).mark_line(color="#73808c", strokeDash=[3, 3])
    lines = alt.Chart(alt.Data(values=rows)).mark_line(point=True)
    return alt.layer(
        guide.encode(x=x, y=y),
        lines.encode(x=x, y=y, color=alt.Color("work:N", sort=list(own), legend=legend)),
    ).properties(width=320, height=220)


def _decades(least: float, largest: float, form: str) -> alt.Axis:
    ends = math.floor(math.log10(least)), math.ceil(math.log10(largest))
    return alt.Axis(format=form, values=[10.0**k for k in range(ends[0], ends[1] + 1)], grid=False)


def page(results: dict[Series, Measured]) -> str:
    """Return the page as Markdown."""
    parts = [WORDS.format(machine=machine()), *table(results)]
    if steep := reasons(results):
        parts += ["", f"Steeper than {STEEP:g}:", "", *steep]
    return "\n".join([*parts, "", "Dashed in the chart: slope 1.", ""])


def main() -> None:
    """Measure, print, and write the page if every work was measured."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("groups", nargs="*", choices=[[], *GROUPS], metavar="group", help="else all")
    parser.add_argument("--most", type=float, default=MOST, help="seconds that a size may take")
    parser.add_argument("--long", action="store_true", help="the largest sizes too, however long they take")
    given = parser.parse_args()
    wanted = [each for each in SERIES if not given.groups or each.group in given.groups]
    results = {each: measured(each, given.most, given.long) for each in wanted}
    print("\n".join([*table(results), "", *reasons(results)]))
    if not given.groups:
        PAGE.write_text(page(results), encoding="utf-8")
        chart(results).save(PAGE.with_suffix(".svg"))


if __name__ == "__main__":
    main()
