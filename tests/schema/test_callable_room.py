"""A package that is called like a verb can be called like it, whatever was imported before."""

from __future__ import annotations

import subprocess
import sys

import pytest

ROOMS = ("posterior", "report", "study")


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_that_was_imported_calls_its_verb(room: str) -> None:
    """The package hides the function of its name, e.g. after ``import hersey.study``."""
    code = f"import hersey.{room}, sys; sys.modules['hersey.{room}']()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert f"hersey.errors.ArgumentError: {room} needs the argument" in done.stderr


def test_a_room_that_can_be_called_loads_no_more() -> None:
    code = "import hersey.report, sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numpy", "pydantic", "hersey.report.page"} & set(done.stdout.split())
