"""The error falls with the tolerance as the order of the method says."""

from __future__ import annotations

import numpy as np
import pytest

import hersey

EXACT = 3.940313951318513  # at 1e-12, physics.md section 4
TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
TOLERANCES = 10.0 ** -np.arange(4, 12)


def slope(errors: list[float]) -> float:
    return float(np.polyfit(np.log10(TOLERANCES), np.log10(np.maximum(errors, 1e-15)), 1)[0])


@pytest.mark.parametrize("method", ["single", "lanes"])
def test_the_error_is_in_proportion_to_the_tolerance(method: str) -> None:
    def frequency(tolerance: float) -> float:
        if method == "single":
            return hersey.stick_slip(TRAIN, DRAG, drive_speed=1.0, tolerance=tolerance).frequency
        return float(
            hersey.sweep(TRAIN, DRAG, drive_speed=1.0, work=hersey.Work(tolerance=tolerance)).frequency
        )

    errors = [abs(frequency(tolerance) / EXACT - 1) for tolerance in TOLERANCES]
    assert slope(errors) == pytest.approx(1.0, abs=0.25)
    assert all(error < 20 * tolerance for error, tolerance in zip(errors, TOLERANCES, strict=True))


def test_steps_grow_as_the_inverse_of_the_order_says() -> None:
    """With terms up to t^14, ten times the accuracy costs 10^(1/14) times the steps."""
    steps = [
        hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=20.0, samples=2, tolerance=tolerance).steps
        for tolerance in TOLERANCES
    ]
    growth = (steps[-1] / steps[0]) ** (1 / (len(steps) - 1))
    assert growth == pytest.approx(10 ** (1 / 14), abs=0.04)


def test_the_work_of_a_run_is_pinned() -> None:
    """A loss of efficiency shows in the count of steps, without a clock."""
    run = hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=20.0)
    assert run.steps < 3000
