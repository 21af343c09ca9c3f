"""The virtual test stand's truth is recovered, and as often as the intervals claim."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey import testbench


@pytest.fixture(scope="module")
def fits(tmp_path_factory: pytest.TempPathFactory) -> list[hersey.DampingSurface]:
    """Fits of 20 seeded logs with 3 % torque noise, the first read from its file."""
    folder = tmp_path_factory.mktemp("logs")
    assert testbench.Stand().torque_noise == 0.03
    return [_fit(folder / f"{seed}.csv", seed) for seed in range(20)]


def _fit(path: Path, seed: int) -> hersey.DampingSurface:
    made = testbench.run(seed=seed)
    if seed:  # what is read of a file is the same
        return hersey.fit(hersey.read(made.table).steady(tare="standing"))
    made.write(path)
    return hersey.fit(hersey.read(path).steady(tare="standing"))


@pytest.mark.parametrize("name", ["a", "b", "c"])
def test_intervals_cover_the_truth(fits: list[hersey.DampingSurface], name: str) -> None:
    truth = getattr(testbench.Truth(), name)
    covered = sum(getattr(f, name).low <= truth <= getattr(f, name).high for f in fits)
    assert covered >= 17
    # and they are not so wide that they could not miss
    widths = [abs((getattr(f, name).high - getattr(f, name).low) / truth) for f in fits]
    assert np.median(widths) < 0.2


def test_transition_speed_within_ten_percent(fits: list[hersey.DampingSurface]) -> None:
    truth = testbench.Truth()
    for fit in fits:
        assert fit.transition is not None
        expected = float(truth.transition_speed(np.array(fit.reference_temperature - 273.15)))
        assert fit.transition.speed.value == pytest.approx(expected, rel=0.1)


def test_no_transition_is_announced_where_there_is_none() -> None:
    truth = testbench.Truth(transition_speed_rpm=0.2)
    for seed in range(5):
        fit = hersey.fit(hersey.read(testbench.run(seed=seed, truth=truth).table).steady(tare="standing"))
        assert fit.transition is None
        assert fit.c.value == pytest.approx(-0.7, abs=0.01)
