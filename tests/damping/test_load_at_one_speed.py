"""A torque that a load sets is no friction: a map of a motor is not called one."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hersey.damping.driving_torque import load_at_one_speed
from tests.cli import command

SPEED = np.repeat([1000.0, 2000.0, 4000.0, 6000.0, 8000.0], 6)
LOADS = np.tile([20.0, 40.0, 80.0, 120.0, 180.0, 240.0], 5)


def test_a_map_of_a_motor_names_no_regime(tmp_path: Path) -> None:
    torque = np.minimum(LOADS, 85e3 / (SPEED * np.pi / 30))  # cut by its power
    rows = [f"{w},{m:.2f}" for w, m in zip(SPEED, torque, strict=True)]
    (tmp_path / "map.csv").write_text("\n".join(["speed [rpm],torque [N*m]", *rows]) + "\n")
    done = command.run("fit", "map.csv", "--means", "--isothermal", cwd=tmp_path)
    assert done.returncode == 0
    said = " ".join(done.stdout.split())
    assert "at one speed: something other than speed sets it, such as temperature or a load, so no" in said
    assert "To see friction, record the drive without it." in said
    assert "falling branch" not in said


def test_friction_that_scatters_or_differs_at_one_speed_alone_may_be_friction() -> None:
    friction = 10.0 * SPEED**0.3
    found = load_at_one_speed(SPEED, LOADS, 0.7)
    assert found is not None
    assert found.ratio == 12.0
    assert load_at_one_speed(SPEED, LOADS, 0.3) is None  # the temperature explains it
    assert load_at_one_speed(SPEED, friction, 0.7) is None
    once = np.where(SPEED == 1000.0, LOADS, friction)
    assert load_at_one_speed(SPEED, once, 0.7) is None
    assert load_at_one_speed(np.arange(1.0, 31.0), LOADS, 0.7) is None  # each speed once


def test_temperature_is_blamed_only_where_it_is_not_known() -> None:
    said = {warm: str(load_at_one_speed(SPEED, LOADS, 0.7, warm=warm)) for warm in (True, False)}
    assert said[True].endswith("something other than speed and temperature sets it, such as a load")
    assert said[False].endswith("something other than speed sets it, such as temperature or a load")
