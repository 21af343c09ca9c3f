"""The browser, opened once, and the pages of three logs, each rendered once."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from playwright.sync_api import Browser, sync_playwright

import hersey
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of
from hersey.machine.machine import read_machine
from hersey.report.page import render
from hersey.study import study
from tests.conftest import ROOT, shared
from tests.document.test_against import dwells, written

ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
#: Pictures of the pages, to be looked at: an artefact of the run.
SCREENS = ROOT / "build" / "screens"
_SCREW = "data/friction/tro2021_screw_drives/driveNo1/steady_state"


@pytest.fixture(scope="package")
def browser() -> Iterator[Browser]:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    assert chromium, "Chromium is missing: make browser installs it"
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=chromium, args=ARGUMENTS)
        yield opened
        opened.close()


def _demo() -> Analysis:
    """The example of the documentation, with its machine."""
    path = ROOT / "examples" / "machine.toml"
    machine = read_machine(path)
    points = hersey.Recipe(logs=(ROOT / "examples" / "bench.csv",), tare="standing").points(machine)
    command = "hersey report examples/bench.csv --machine examples/machine.toml --tare standing"
    return document_of(study(points, machine, machine_file=path), command=command)


def _screw() -> Analysis:
    """Measured by others: one file per speed, no machine, no temperature."""
    files = sorted(shared(_SCREW).glob("*.csv"))
    log = hersey.read(files, units={"torque": "-9.84 mN*m / 100", "speed": "-1 rpm"}, isothermal=True)
    return document_of(
        study(log.steady(rotation="forward")), command="hersey report FOLDER/*.csv --isothermal"
    )


def _plain() -> Analysis:
    """The example without machine and temperature."""
    log = hersey.read(ROOT / "examples" / "bench.csv", isothermal=True)
    return document_of(study(log.steady()), command="hersey report examples/bench.csv --isothermal")


def _against() -> Analysis:
    """Two logs compared, without a machine."""
    with TemporaryDirectory() as folder:
        now, earlier = (dwells(written(Path(folder), name)) for name in ("new.csv", "more.csv"))
        return document_of(study(now, against=earlier))


@pytest.fixture(scope="package")
def report(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[Path, Analysis]]:
    """Return the page of ``demo``, ``screw``, ``plain`` or ``against``, and its document, each made once."""
    kept: dict[str, tuple[Path, Analysis]] = {}

    def made(name: str) -> tuple[Path, Analysis]:
        if name not in kept:
            document = {"demo": _demo, "screw": _screw, "plain": _plain, "against": _against}[name]()
            path = tmp_path_factory.mktemp("report") / f"{name}.html"
            path.write_text(render(document), encoding="utf-8")
            kept[name] = path, document
        return kept[name]

    return made
