"""Refits that go together: each ends at its own minimum, however many go at once."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.damping.candidates import refits
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.refits import left_out, resampled
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
