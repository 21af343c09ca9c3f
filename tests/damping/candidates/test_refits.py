"""Refits that go together: each ends at its own minimum, however many go at once."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.arrays import FloatArray
from hersey.damping.candidates import refits
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.refits import left_out, resampled
from hersey.damping.candidates.simultaneous import Minima
from tests.damping.candidates.test_comparison import LAWS, dwells


def test_refits_end_near_their_minima(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a curved law, off a search as close as numbers allow by less than a hundredth of an error."""
    law, values = LAWS["stribeck"]
    data = dwells(law, values, scatter=0.03)
    fit = fit_law(law, data)
    missed, drawn = left_out(fit, data), resampled(fit, data, 30, seed=2)
    monkeypatch.setattr(refits, "_PRECISION", 1e-13)
    assert np.max(np.abs(missed - left_out(fit, data))) < 5e-4 * fit.scatter
    off = np.abs(drawn - resampled(fit, data, 30, seed=2)) / np.sqrt(np.diag(fit.covariance))
    assert np.max(off) < 0.006


def test_refits_in_several_parts_are_those_in_one(monkeypatch: pytest.MonkeyPatch) -> None:
    law, values = LAWS["arrhenius/two-hersey"]
    data = dwells(law, values, scatter=0.02)
    fit = fit_law(law, data)
    missed, drawn = left_out(fit, data), resampled(fit, data, 5, seed=3)
    monkeypatch.setattr(refits, "_TOGETHER", 4 * len(data) * fit.values.size)  # four at once
    np.testing.assert_array_equal(left_out(fit, data), missed)
    np.testing.assert_array_equal(resampled(fit, data, 5, seed=3), drawn)


def test_each_draw_is_the_likeliest_of_its_own_searches(monkeypatch: pytest.MonkeyPatch) -> None:
    law, values = LAWS["arrhenius/two-hersey"]
    data = dwells(law, values, scatter=0.1)
    fit = fit_law(law, data)
    calls: list[tuple[FloatArray, FloatArray, Minima]] = []
    together = refits._refitted

    def noted(
        fit: LawFit, data: Observations, start: FloatArray, times: FloatArray, expected: FloatArray
    ) -> Minima:
        calls.append((start, times, together(fit, data, start, times, expected)))
        return calls[0][2]

    monkeypatch.setattr(refits, "_refitted", noted)
    drawn = resampled(fit, data, 8, seed=3)
    ((start, times, found),) = calls
    differ = 0
    for row, dwells_drawn in enumerate(times[::3]):
        mine = np.flatnonzero((times == dwells_drawn).all(axis=1))
        assert mine.size == np.unique(start[mine], axis=0).shape[0] == 3
        costs = found.cost[mine]
        np.testing.assert_array_equal(drawn[row], found.values[mine[np.argmin(costs)]])
        differ += np.ptp(costs) > 1e-3
    assert differ > 0
