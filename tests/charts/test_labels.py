"""Where texts stand: in the chart, beside what they name, none over another; thinning that keeps extremes."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from hersey.charts.labels import Labels, apart
from hersey.study.thinning import kept


def test_names_stay_near_and_apart() -> None:
    assert apart([10.0, 100.0]) == [10.0, 100.0]
    assert apart([50.0, 50.0]) == pytest.approx([42.5, 57.5])
    ups = [100.0, 20.0, 104.0, 98.0, 180.0]
    placed = apart(ups)
    assert min(np.diff(sorted(placed))) >= 15.0 - 1e-9
    assert np.argsort(placed).tolist() == np.argsort(ups).tolist()
    assert placed[1] == 20.0
    assert placed[4] == 180.0
    assert np.mean([placed[i] for i in (0, 2, 3)]) == pytest.approx(np.mean([100.0, 104.0, 98.0]))


def test_names_of_points_do_not_overlap() -> None:
    labels = Labels(400, 300)
    for i in range(8):
        labels.beside(f"point {i}", 150.0 + 6.0 * i, 150.0 + 4.0 * i, "points")
    assert len(labels.texts) == 8
    for a, b in combinations([text.box for text in labels.texts], 2):
        assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]


def test_a_region_is_named_inside_or_not_at_all() -> None:
    across = np.linspace(0.0, 400.0, 41)
    low, high = np.full(41, 100.0), np.where(across < 200.0, 110.0, 180.0)
    labels = Labels(400, 300)
    labels.inside("a region", [(across, low, high)], "regions")
    (text,) = labels.texts
    assert text.box[0] > 190.0
    assert text.box[1] >= 100.0
    assert text.box[3] <= 180.0
    labels.inside("too long a name for so thin a region", [(across, low, low + 10.0)], "regions")
    assert len(labels.texts) == 1


def test_thinning_keeps_extremes_and_ends() -> None:
    values = np.sin(np.linspace(0.0, 40.0, 50_000))
    values[31_234], values[777], values[100:110] = 9.0, -9.0, np.nan
    index = kept(values, 500)
    assert index.size < 520
    assert {0, 777, 31_234, 49_999} <= set(index.tolist())
    assert np.isfinite(values[index]).all()
    assert kept(values[:50], 500).tolist() == list(range(50))
