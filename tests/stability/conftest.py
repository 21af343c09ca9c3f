"""The machine that maps are drawn of."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hersey.machine.machine import Machine, read_machine
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def machine() -> Machine:
    """The stand's machine with a roll that grips throughout, and a motor that starts the belt."""
    machine = read_machine(ROOT / "tests" / "stand" / "machine.toml")
    return replace(machine, limits=replace(machine.limits, roll_friction=None, motor_torque=4.5))
