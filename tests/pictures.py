"""The pictures of the docs, all made anew in minutes: ``python -m tests.pictures``.

Types the commands of the tutorial and of how-to pages with pictures, in order and as they stand there, in a
folder of its own. Photographs the pages that they write, and makes their charts small.
"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

from tests.app.conftest import end, start
from tests.app.test_page import MACHINE, Watched
from tests.browser.conftest import ARGUMENTS
from tests.browser.opening import Opened
from tests.cli.command import run_apart
from tests.guide import DOCS, HOW_TO, TUTORIAL, commands, words

IMAGES = DOCS / "images"
#: Picture, page that a command writes, and the part of it that is shown, in pixels.
SCREENS = {
    "report.png": ("machine-report.html", (1280, 800)),
    "report-log.png": ("report.html", (1280, 800)),
    "life.png": ("life.html", (1280, 800)),
}
#: Pictures that a command writes.
CHARTS = ("map.png", "plan.png", "cycles.png", "film.png")
WIDEST = 1000  # pixels of a chart
COLOURS = 256  # more would not fit a palette, and take three times as many bytes


def main() -> None:
    """Make every picture, and print its size."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = type_commands(Path(temporary))
        photographs = photograph(folder)
        IMAGES.mkdir(exist_ok=True)
        for name in (*photographs, *CHARTS):
            picture = Image.open(photographs[name] if name in photographs else folder / name).convert("RGB")
            save(picture, IMAGES / name)
            sys.stdout.write(f"{name:16} {(IMAGES / name).stat().st_size / 1000:.0f} kB\n")


def type_commands(folder: Path) -> Path:
    """Type the commands of the pages with pictures; return the folder of examples in which they work."""
    pages = [*TUTORIAL, *(page for page in HOW_TO if "](../images/" in page.read_text(encoding="utf-8"))]
    for line in (line for page in pages for line in commands(page)):
        sys.stdout.write(f"{line}\n")
        arguments, output = words(line)
        done = run_apart(*arguments, cwd=folder)
        if done.returncode:
            raise SystemExit(f"{line}\n{done.stderr}")
        if output:
            (folder / output).write_text(done.stdout)
        if arguments[0] == "examples":
            folder = folder / arguments[1]
    return folder


def photograph(folder: Path) -> dict[str, io.BytesIO]:
    """Return the first screens of the pages in a folder and of the app, by the name of the picture."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        raise SystemExit("Chromium is missing: make browser installs it")
    taken: dict[str, io.BytesIO] = {}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=ARGUMENTS)
        for name, (page, size) in SCREENS.items():
            opened = Opened(browser, folder / page, size=size)
            opened.page.wait_for_timeout(1000)  # what the panel computes is drawn
            taken[name] = io.BytesIO(opened.page.screenshot())
        taken["app.png"] = photograph_app(browser, folder)
        browser.close()
    return taken


def photograph_app(browser: Browser, folder: Path) -> io.BytesIO:
    """Return the app with the log of the example and numbers of its machine, before it is run."""
    started = start(folder)
    try:
        watched = Watched(browser, started.address)
        watched.drop("bench.csv", (folder / "bench.csv").read_bytes())
        watched.page.wait_for_selector("table.channels")
        for field, value in MACHINE.items():
            watched.page.fill(f'[data-control="field:drivetrain.{field}"]', value)
        watched.page.locator("h1").click()
        watched.page.wait_for_timeout(2000)  # what the fields change is drawn
        return io.BytesIO(watched.page.screenshot(clip={"x": 0, "y": 0, "width": 1280, "height": 600}))
    finally:
        end(started)


def save(picture: Image.Image, path: Path) -> None:
    """Save a picture with few colours and no more than `WIDEST` pixels across, unless it is a screen."""
    if path.name in CHARTS:
        picture.thumbnail((WIDEST, WIDEST), Image.Resampling.LANCZOS)
    small = picture.quantize(COLOURS, dither=Image.Dither.NONE)
    small.save(path, optimize=True)


if __name__ == "__main__":
    main()
