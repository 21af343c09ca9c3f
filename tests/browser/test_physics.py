"""The core in a page: the same numbers as in Python, in a real headless Chromium."""

from __future__ import annotations

import base64
import json
import re
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from hersey.arrays import FloatArray
from tests.browser.belts import Setting, settings

STATIC = resources.files("hersey.report") / "static"
ASKING = Path(__file__).with_name("asking.js").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(browser: Browser) -> Page:
    return browser.new_page()


def code() -> list[str]:
    """The script, and the module as text."""
    module = base64.b64encode((STATIC / "physics.wasm").read_bytes()).decode()
    return [(STATIC / "physics.js").read_text(encoding="utf-8"), module]


def asked(page: Page, belts: list[Setting]) -> list[list[list[float]] | str]:
    answers = page.evaluate(ASKING, [*code(), json.dumps([belt.asked() for belt in belts])])
    found: list[list[list[float]] | str] = json.loads(answers)
    return found


def apart(one: list[FloatArray], other: list[list[float]]) -> float:
    """Greatest difference of two answers, of each quantity relative to its greatest value."""
    if [len(mine) for mine in one] != [len(theirs) for theirs in other]:
        return np.inf
    worst = 0.0
    for mine, theirs in zip(one, (np.asarray(each, dtype=float) for each in other), strict=True):
        different = mine != theirs
        if different.any():
            most = np.max(np.abs(mine))
            worst = max(worst, float(np.max(np.abs(mine - theirs)[different]) / most) if most else np.inf)
    return worst


def without_time(words: str) -> str:
    """The words of an error without the time that a motion had reached."""
    return re.sub(r"reached time \S+", "", words)


def test_a_thousand_belts_have_the_numbers_of_python(page: Page) -> None:
    """To 1e-12 of the greatest value of each quantity; edges, which are searched for, to 1e-11."""
    belts = settings(1000, seed=15)
    refused, at_the_limit = 0, 0
    for belt, theirs in zip(belts, asked(page, belts), strict=True):
        mine = belt.answered()
        if isinstance(mine, str) and isinstance(theirs, str):
            assert without_time(mine) == without_time(theirs), belt
            refused += 1
        elif isinstance(mine, str) or isinstance(theirs, str):
            # the search for an edge just ends within the work allowed, or just does not
            assert "allow more by most_steps" in f"{mine} {theirs}", belt
            at_the_limit += 1
        else:
            off = apart(mine, theirs)
            assert off <= belt.tolerance, f"{off:.1e}: {belt}"
    assert refused < 100
    assert at_the_limit < 5
