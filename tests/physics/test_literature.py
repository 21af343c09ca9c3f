"""Published and independently computed numbers, and the paper's own claims."""

from __future__ import annotations

import json

import numpy as np
import pytest

import hersey
from tests.conftest import shared


def baseline(
    k: float = 1000, b0: float = 50, m: float = 1, v_s: float = 0.01, v2: float = 1
) -> hersey.StickSlipCycle:
    drag = hersey.Drag(b0, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=v_s)
    return hersey.stick_slip(hersey.Drivetrain(k, m), drag, drive_speed=v2)


def test_baseline_numbers() -> None:
    cycle = baseline()
    assert cycle.kind == "stick_slip"
    assert cycle.frequency == pytest.approx(3.940314, rel=1e-6)
    assert cycle.speed_max == pytest.approx(3.152923, rel=1e-6)
    assert cycle.stuck_fraction == pytest.approx(0.474319, rel=2e-6)


def test_every_reference_row_of_the_retained_law() -> None:
    rows = json.loads(shared("reference/stick-slip.json").read_text())
    rows = [row for row in rows if row["law"] == "retained"]
    assert len(rows) >= 10
    for row in rows:
        cycle = baseline(row["k"], row["B0"], row["m"], row["vs"], row["v2"])
        assert cycle.kind == "stick_slip"
        found = (cycle.frequency, cycle.speed_max, cycle.stuck_fraction)
        expected = (row["frequency"], row["v_max"], row["stuck_fraction"])
        assert found == pytest.approx(expected, rel=1e-7), row
        # the reference reads the greatest stretch off its samples, so it may fall short of ours a little
        assert row["s_max"] * (1 - 1e-7) <= cycle.stretch_max <= row["s_max"] * (1 + 1e-3)


def test_eq_29_breakaway_force() -> None:
    """Eq. 29: A = e 50 (0.01)^-0.2, about 341.4."""
    drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    assert drag.breakaway_force == pytest.approx(np.e * 50 * 0.01**-0.2, rel=1e-12)
    assert drag.breakaway_force == pytest.approx(341.4, abs=0.05)


def test_fig_10_more_stiffness_raises_frequency_and_lowers_slip_speed() -> None:
    cycles = [baseline(k=k) for k in (500, 1000, 1500, 2000)]
    frequencies = np.array([c.frequency for c in cycles])
    assert (np.diff(frequencies) > 0).all()
    assert (np.diff([c.speed_max for c in cycles]) < 0).all()
    # the paper calls it proportional; the exponent is nearer two thirds
    power = np.polyfit(np.log([500, 1000, 1500, 2000]), np.log(frequencies), 1)[0]
    assert power == pytest.approx(0.66, abs=0.01)


def test_fig_11_more_damping_lowers_frequency_and_raises_slip_speed() -> None:
    cycles = [baseline(b0=b0) for b0 in (25, 50, 75, 100)]
    assert (np.diff([c.frequency for c in cycles]) < 0).all()
    assert (np.diff([c.speed_max for c in cycles]) > 0).all()


def test_fig_12_more_drive_speed_raises_both() -> None:
    cycles = [baseline(v2=v2) for v2 in (0.4, 0.7, 1.0, 1.3, 1.6)]
    assert (np.diff([c.frequency for c in cycles]) > 0).all()
    assert (np.diff([c.speed_max for c in cycles]) > 0).all()


def test_figs_13_14_hysteresis() -> None:
    """Fig. 13: stick-slip persists at 1.9 v_t from below; beyond the fold at 2.173493 it cannot."""
    assert baseline(v2=1.9).kind == "stick_slip"
    assert baseline(v2=2.1734).kind == "stick_slip"
    assert baseline(v2=2.1736).kind == "steady_sliding"


def test_error_falls_with_the_tolerance() -> None:
    drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    train = hersey.Drivetrain(1000, 1)
    exact = 3.940313951318513
    errors = [
        abs(hersey.stick_slip(train, drag, drive_speed=1.0, tolerance=t).frequency / exact - 1)
        for t in (1e-5, 1e-8, 1e-11)
    ]
    assert errors[0] < 1e-4
    assert errors[1] < 1e-3 * max(errors[0], 1e-6)
    assert errors[2] < 1e-11
