"""Which run to measure next, of draws that are known."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hersey.arrays import FloatArray
from hersey.life.growth.limit_ages import age_at_limit
from hersey.life.time_to_failure import next_run
from hersey.life.time_to_failure.first import Picks, SpecimenEnd
from hersey.life.time_to_failure.next_run import next_runs


def test_the_earliest_run_that_comes_near_the_best_is_chosen() -> None:
    chosen = next_run._chosen
    assert chosen(0.3, np.array([0.30, 0.12, 0.10, 0.09])) == 1  # gains 0.18, 0.20, 0.21
    assert chosen(0.3, np.array([0.30, 0.15, 0.10, 0.09])) == 2
    assert chosen(0.3, np.array([0.30, 0.26, 0.26, 0.26])) is None  # less than 15 % of 0.3


def test_a_run_errs_by_its_scatter_and_its_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """An age known to 100 and read to hypot(60, 80): arctan(1) / pi of risk is left."""
    monkeypatch.setattr(next_run, "_RUNS", 1000)
    random = np.random.default_rng(3)
    first = 1000.0 + 100.0 * random.standard_normal(2000)

    def drawn_values(unit: str, ages: FloatArray) -> tuple[FloatArray, FloatArray]:
        assert unit == "U1"
        return np.tile(first[:, None], (1, ages.size)), np.full((first.size, 1), 60.0)

    mode: Any = SimpleNamespace(
        row={"U1": 0}, error=80.0, drawn_values=drawn_values, mode=SimpleNamespace(name="torque")
    )
    end = SpecimenEnd("U1", age_at_limit("U1", first, 500.0), {"torque": 1.0}, ())
    picks = Picks(np.arange(first.size)[None, :, None], first[:, None])
    (found,) = next_runs([mode], [end], picks, np.eye(1), 1000.0, random)
    assert (found.unit, found.mode, found.until, found.present) == ("U1", "torque", 1000.0, False)
    assert found.before == pytest.approx(0.5, abs=0.03)
    assert found.after == pytest.approx(math.atan(1.0) / math.pi, abs=0.03)
