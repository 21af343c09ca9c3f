"""How fast the page answers: sliders of the demo's report moved in Chromium, 60 settings in a row each.

The processor time of the page's own thread is what Chromium counts for its tasks (script, layout, painting)
from one setting to the next; the wall time until the map's edges stand anew is that of their worker, too.
Writes PAGE.md.

Usage: python benchmarks/page.py [REPORT.html]
"""

from __future__ import annotations

import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).parents[1]
SETTINGS = 60
#: Sliders that are moved, and between which thousandths of their track.
SLIDERS = {"speed": (200, 900), "temperature": (300, 950), "stiffness": (350, 650), "stick_speed": (350, 650)}
#: The most that a setting may take on the page's thread, and the edges of the whole map, ms.
FRAME, EDGES = 16.0, 100.0
#: Moves a slider, and waits until the frame that follows is drawn.
_MOVE = """async ([name, value]) => {
  const slider = document.getElementById(`slide-${name}`);
  slider.value = value;
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  await new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)));
}"""
#: The same, until the edges of the map are drawn anew.
_EDGES = """async ([name, value]) => {
  const fold = () => document.querySelector("#map [role=img] .fold").getAttribute("d");
  const before = fold(), start = performance.now();
  const slider = document.getElementById(`slide-${name}`);
  slider.value = value;
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  while (fold() === before) await new Promise((done) => setTimeout(done, 1));
  return performance.now() - start;
}"""


@dataclass(frozen=True)
class Spent:
    """Times in ms, each of one setting."""

    task: list[float]
    script: list[float]


def made() -> Path:
    """The demo's report."""
    path = Path(tempfile.mkdtemp()) / "report.html"
    command = [sys.executable, "-m", "hersey.cli", "report", "examples/bench.csv", "--tare", "standing"]
    options = ["--machine", "examples/machine.toml", "--out", str(path)]
    subprocess.run([*command, *options], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return path


def moved(page: Page, metrics: Callable[[], dict[str, float]], name: str) -> Spent:
    """Move a slider through its settings."""
    spent = Spent([], [])
    low, high = SLIDERS[name]
    for i in range(SETTINGS):
        before = metrics()
        page.evaluate(_MOVE, [name, low + (high - low) * i / (SETTINGS - 1)])
        after = metrics()
        spent.task.append(1e3 * (after["TaskDuration"] - before["TaskDuration"]))
        spent.script.append(1e3 * (after["ScriptDuration"] - before["ScriptDuration"]))
    return spent


def measure(path: Path) -> tuple[dict[str, Spent], list[float]]:
    """Processor times by slider, and wall times of the map's edges, ms."""
    with sync_playwright() as playwright:
        chromium = shutil.which("chromium") or shutil.which("chromium-browser")
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(path.as_uri())
        page.wait_for_selector("body[data-ready]")
        page.wait_for_timeout(2000)
        client = page.context.new_cdp_session(page)
        client.send("Performance.enable", {"timeDomain": "threadTicks"})

        def metrics() -> dict[str, float]:
            return {each["name"]: each["value"] for each in client.send("Performance.getMetrics")["metrics"]}

        edges = [page.evaluate(_EDGES, ["stiffness", 380 + 10 * i]) for i in range(20)]
        spent = {name: moved(page, metrics, name) for name in SLIDERS}
        browser.close()
    return spent, edges


def table(spent: dict[str, Spent], edges: list[float]) -> list[str]:
    """Medians and the 95th of 100."""
    rows = ["| moved | of | median, ms | 95 % below, ms | aim |", "|---|---|---|---|---|"]
    measured = [
        (name.replace("_", " "), what, times, FRAME)
        for name, each in spent.items()
        for what, times in (("tasks", each.task), ("script", each.script))
    ]
    for name, what, times, aim in [*measured, ("stiffness", "map's edges drawn, wall", edges, EDGES)]:
        late = statistics.quantiles(times, n=20)[-1]
        rows.append(f"| {name} | {what} | {statistics.median(times):.1f} | {late:.1f} | {aim:g} |")
    return rows


def main() -> None:
    """Measure, print and write."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else made()
    size = path.stat().st_size / 1e6
    text = "\n".join(
        [
            "# How fast the page answers",
            "",
            f"`python benchmarks/page.py`: the demo's report of {size:.2f} MB in Chromium, "
            f"{SETTINGS} settings of each slider in a row.",
            "Processor time of the page's thread from one setting to the next, but for the last row.",
            "",
            *table(*measure(path)),
            "",
        ]
    )
    print(text)
    Path(__file__).with_name("PAGE.md").write_text(text)


if __name__ == "__main__":
    main()
