"""The table of regimes against an exponent: what sensors may do, and Holm's p-values, by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from hersey.damping import distributions
from hersey.damping.estimate import Estimate, estimate
from hersey.verdict.regimes import judged
from tests.verdict.cases import alone, holm

DOWSON_HIGGINSON = "Dowson-Higginson EHL"


def of(exponent: Estimate, name: str) -> tuple[float, bool]:
    """p-value of a regime, and whether it is kept."""
    (hypothesis,) = (h for h in judged(exponent) if h.name == name)
    return hypothesis.p_value, hypothesis.consistent


def test_holm_by_hand() -> None:
    assert distributions.holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert distributions.holm([0.5, 0.4, 0.9]) == pytest.approx([1.0, 1.0, 1.0])
    assert distributions.holm([0.02]) == [0.02]
    # one just within its own level is not refuted among six
    assert distributions.holm([0.02, 1.0, 1.0, 1.0, 1.0, 1.0])[0] == pytest.approx(0.12)


def test_a_bias_that_the_sensors_allow_excludes_nothing() -> None:
    """An exponent of -0.6984, 5.3 errors from -0.70, of a film that has it."""
    c = estimate(-0.6984, 0.0003, 40)
    p, kept = of(c, DOWSON_HIGGINSON)
    assert not kept
    assert p == pytest.approx(2.0 * stats.t.sf(0.0016 / 0.0003, 40), rel=1e-9)
    assert of(c.with_systematic(0.005), DOWSON_HIGGINSON) == (1.0, True)
    # what lies beyond the margin counts as before: 0.0006 of 0.0016
    p, kept = of(c.with_systematic(0.001), DOWSON_HIGGINSON)
    assert p == pytest.approx(2.0 * stats.t.sf(2.0, 40), rel=1e-9)
    assert kept
    assert not of(c.with_systematic(0.0005), DOWSON_HIGGINSON)[1]
    # and the margin is no more than itself: a neighbour stays refuted
    assert not of(c.with_systematic(0.005), "rigid piezoviscous film")[1]


def test_a_margin_counts_on_the_one_side_of_a_falling_branch() -> None:
    c = estimate(-0.98, 0.005, 20)
    alone_p = float(stats.t.sf((0.02 - 0.012) / 0.005, 20))
    p = alone(c.with_systematic(0.012))["falling branch"]
    assert p == pytest.approx(alone_p)
    assert not of(c, "falling branch")[1]
    assert of(c.with_systematic(0.012), "falling branch")[1]


def test_every_exponent_is_judged_so() -> None:
    random = np.random.default_rng(6)
    for _ in range(40):
        c = estimate(random.uniform(-1.3, 0.2), random.uniform(0.002, 0.1), random.uniform(2.0, 60.0))
        c = c.with_systematic(random.uniform(0.0, 0.02))
        assert {h.name: h.p_value for h in judged(c)} == pytest.approx(holm(alone(c)), rel=1e-9)


def test_few_degrees_of_freedom_refute_less() -> None:
    assert not of(estimate(-0.65, 0.01, 40), DOWSON_HIGGINSON)[1]
    assert of(estimate(-0.65, 0.01, 2), DOWSON_HIGGINSON)[1]


def test_film_theory_marks_the_regime_of_the_contact() -> None:
    held = {h.name: h.holds_here for h in judged(estimate(-0.7, 0.01, 9), film="isoviscous-elastic")}
    assert [name for name, here in held.items() if here] == ["soft EHL"]
    assert all(h.holds_here is None for h in judged(estimate(-0.7, 0.01, 9)))
