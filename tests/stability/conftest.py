"""The fit and the machine that maps are drawn of."""

from __future__ import annotations

import pytest

import hersey
from hersey.damping.surface import DampingSurface
from hersey.machine.machine import Machine, read_machine
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def surface(points: hersey.SteadyPoints) -> DampingSurface:
    return hersey.fit(points)


@pytest.fixture(scope="module")
def machine() -> Machine:
    return read_machine(ROOT / "tests" / "stand" / "machine.toml")
