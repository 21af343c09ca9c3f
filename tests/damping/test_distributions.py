"""Distributions of the statistics are those of `scipy.stats`."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from hersey.damping import distributions

X = np.array([0.0, 0.3, 1.0, 2.7, 9.0])
SHARES = np.array([0.001, 0.025, 0.3, 0.5, 0.975, 0.9999])


@pytest.mark.parametrize("freedom", [1.0, 2.5, 4.0, 60.0])
def test_tails_and_quantiles_are_those_of_scipy_stats(freedom: float) -> None:
    student, square, ratio = stats.t(freedom), stats.chi2(freedom), stats.f(3.0, freedom)
    for told, known in (
        (distributions.student_below(X, freedom), student.cdf(X)),
        (distributions.student_above(X, freedom), student.sf(X)),
        (distributions.student_quantile(SHARES, freedom), student.ppf(SHARES)),
        (distributions.square_above(X, freedom), square.sf(X)),
        (distributions.square_quantile(SHARES, freedom), square.ppf(SHARES)),
        (distributions.ratio_above(X, 3.0, freedom), ratio.sf(X)),
        (distributions.ratio_quantile(SHARES, 3.0, freedom), ratio.ppf(SHARES)),
        (distributions.beta_quantile(SHARES, 2.0, freedom), stats.beta(2.0, freedom).ppf(SHARES)),
        (distributions.normal_density(X), stats.norm.pdf(X)),
        (distributions.normal_above(X), stats.norm.sf(X)),
        (distributions.normal_quantile(SHARES), stats.norm.ppf(SHARES)),
    ):
        assert told == pytest.approx(known, rel=1e-9, abs=1e-15)
