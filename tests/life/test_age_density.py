"""How dense the ages of other specimens lie, by hand: a normal about each, and a share that follows none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hersey.life.diagnostics import slips


def test_the_density_of_ages_is_one_in_all(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(slips, "_least_gap", lambda *_: 3.0)
    rows: Any = SimpleNamespace(
        age=np.array([[0.0, 10.0, 20.0], [0.0, 12.0, 40.0]]),
        given=np.array([[True, True, True], [True, True, True]]),
    )
    ages = np.linspace(-60.0, 100.0, 16_001)
    dense = np.exp(slips._scheduled(ages, rows, 0))
    assert dense[0] == pytest.approx(0.05 / 40.0)  # far from all: a twentieth over the greatest age
    about = dense - 0.05 / 40.0
    assert about.sum() * 0.01 == pytest.approx(0.95)
    assert about[ages.searchsorted(12.0)] == pytest.approx(0.95 / 3.0 / (1.5 * np.sqrt(2.0 * np.pi)))
