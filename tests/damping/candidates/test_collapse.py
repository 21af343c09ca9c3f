"""Collapse on the Hersey number: an F test, deviation, scatter and overlap by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from hersey.damping.candidates.branched import FREE, ONE, Law
from hersey.damping.candidates.collapse import (
    NEGLIGIBLE,
    HerseyCollapse,
    hersey_collapse,
    temperature_collapse,
)
from hersey.damping.candidates.thermal import ARRHENIUS, KELVIN, Thermal
from hersey.errors import InsufficientDataError, ParameterError
from tests.damping.candidates.test_comparison import REFERENCE, dwells


def by_hand(x: np.ndarray, y: np.ndarray, group: np.ndarray, fitted: int = 0) -> tuple[float, float, float]:
    """Deviation, scatter and p-value, the common curve as hat functions on its knots."""
    knots = np.quantile(x, np.linspace(0, 1, min(max(x.size // 4, 2), 8)))
    common = np.column_stack([np.interp(x, knots, row) for row in np.eye(knots.size)])
    own = [(group == g) * part for g in np.unique(group) for part in (np.ones_like(x), x)]
    both = np.column_stack([common, *own])

    def left(columns: np.ndarray) -> tuple[float, int]:
        axes, singular, _ = np.linalg.svd(columns, full_matrices=False)
        axes = axes[:, singular > 1e-10 * singular[0]]
        r = y - axes @ (axes.T @ y)
        return float(r @ r), axes.shape[1]

    (s_common, n_common), (s_both, n_both) = left(common), left(both)
    freedom, more = x.size - n_both - fitted, n_both - n_common
    variance = s_both / freedom
    p = stats.f.sf((s_common - s_both) / more / variance, more, freedom)
    deviation = np.sqrt(max(s_common - s_both - more * variance, 0.0) / x.size)
    return float(deviation), float(np.sqrt(variance)), float(p)


def curves(
    off: float, scatter: float, seed: int = 0, count: int = 12, groups: int = 3
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A bent curve, the first group off it by a level and a slope."""
    random = np.random.default_rng(seed)
    x = np.sort(random.uniform(-2, 2, (groups, count)), axis=1).ravel()
    group = np.repeat(np.arange(groups), count)
    y = np.abs(x) * 0.5 + scatter * random.standard_normal(x.size) + off * (group == 0) * (1 + 0.5 * x)
    return x, y, group


def overlap_by_hand(x: np.ndarray, group: np.ndarray) -> float:
    inside = 0
    for i in range(x.size):
        for g in np.unique(group):
            if g != group[i] and x[group == g].min() <= x[i] <= x[group == g].max():
                inside += 1
                break
    return inside / x.size


@pytest.mark.parametrize(
    ("off", "scatter", "collapses"), [(0.0, 0.05, True), (0.3, 0.05, False), (0.02, 0.03, True)]
)
@pytest.mark.parametrize("count", [5, 12])
def test_known_hersey_numbers_are_judged_by_an_f_test(
    off: float, scatter: float, collapses: bool, count: int
) -> None:
    x, y, group = curves(off, scatter, count=count)
    found = hersey_collapse(x, y, group)
    deviation, spread, p = by_hand(x, y, group)
    assert found.deviation == pytest.approx(deviation, rel=1e-7, abs=1e-9)
    assert found.scatter == pytest.approx(spread, rel=1e-8)
    assert found.p_value == pytest.approx(p, rel=1e-6)
    assert found.overlap == pytest.approx(overlap_by_hand(x, group), abs=1e-12)
    assert found.spread_before == 0.0
    assert found.shifts.size == 0
    assert found.collapses is collapses
    if collapses:
        assert found.verdict == (
            "The curves collapse onto one against the Hersey number: they differ by "
            f"{100 * deviation:.1f} % rms and scatter by {100 * spread:.1f} %."
        )
    else:
        assert found.verdict == (
            "The curves do NOT collapse onto one against the Hersey number: they differ by "
            f"{100 * deviation:.0f} % rms and each scatters by {100 * spread:.1f} % (p = {p:.1g}). Do not "
            "draw one Stribeck curve through them."
        )


def near(p: float) -> HerseyCollapse:
    """Curves whose deviation has a given p-value, the scatter small beside it."""
    x, y, group = curves(0.0, 0.3, count=8)
    _, off, _ = curves(1.0, 0.0, count=8)
    flat = curves(0.0, 0.0, count=8)[1]
    low, high = 0.0, 3.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if by_hand(x, y + middle * (off - flat), group)[2] > p else (low, middle)
    return hersey_collapse(x, y + low * (off - flat), group)


def test_deviations_beyond_one_per_cent_of_chance_are_none() -> None:
    assert near(0.0101).p_value == pytest.approx(0.0101, rel=1e-4)
    assert near(0.0101).collapses is True
    assert near(0.0099).collapses is False


@pytest.mark.parametrize(("deviation", "collapses"), [(0.0297, True), (0.0303, False)])
def test_deviations_below_three_per_cent_are_negligible(deviation: float, collapses: bool) -> None:
    assert NEGLIGIBLE == 0.03
    x, y, group = curves(0.0, 0.001)
    off = (group == 0) * (1 + 0.5 * x)
    low, high = 0.0, 0.5
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if by_hand(x, y + middle * off, group)[0] < deviation else (low, middle)
    found = hersey_collapse(x, y + low * off, group)
    assert found.deviation == pytest.approx(deviation, rel=1e-5)
    assert found.p_value < 1e-6
    assert found.collapses is collapses


@pytest.mark.parametrize(("share", "collapses"), [(0.49, True), (0.51, False)])
def test_deviations_below_half_the_scatter_are_negligible(share: float, collapses: bool) -> None:
    x, y, group = curves(0.0, 0.2, count=60)
    off = (group == 0) * (1 + 0.5 * x)
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        deviation, scatter, _ = by_hand(x, y + middle * off, group)
        low, high = (middle, high) if deviation < share * scatter else (low, middle)
    found = hersey_collapse(x, y + low * off, group)
    assert found.deviation == pytest.approx(share * found.scatter, rel=1e-5)
    assert found.p_value < 0.01
    assert found.collapses is collapses


@pytest.mark.parametrize(("shared", "told"), [(3, True), (2, False)])
def test_three_points_in_ten_must_share_a_number(shared: int, told: bool) -> None:
    # ten points: those of the second within the range of the first, its end on a point included
    x = np.concatenate([np.arange(5.0), 4.0 - (shared - 2) + np.arange(5.0)])
    y, group = 0.3 * x, np.repeat([0, 1], 5)
    found = hersey_collapse(x, y, group)
    inside = 2 * (shared - 1)
    assert found.overlap == pytest.approx(inside / 10)
    assert (found.collapses is not None) is told
    if not told:
        assert found.verdict == (
            "Whether the curves collapse cannot be determined: only 20 % of the points "
            "share a Hersey number with another curve. Widen the speed range."
        )


def test_points_of_an_exact_curve_have_no_scatter() -> None:
    x = np.tile(np.linspace(-1, 1, 8), 3)
    found = hersey_collapse(x, 0.3 * x + 0.1, np.repeat(["c", "a", "b"], 8))
    assert found.collapses is True
    assert found.scatter == pytest.approx(0.0, abs=1e-12)
    assert found.deviation == pytest.approx(0.0, abs=1e-12)


def test_viscosities_that_were_fitted_cost_degrees_of_freedom() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), FREE)
    data = dwells(law, [0.1, 2.8, -0.7, -1.2, -0.9, -5.0], scatter=0.04)
    found = temperature_collapse(data)
    z, y, group = data.inputs.log_speed, data.log_torque, data.inputs.group
    assert found.shifts[0] == 0.0
    assert found.shifts.shape == (4,)
    x = z + found.shifts[group]
    deviation, scatter, p = by_hand(x, y, group, fitted=3)
    assert found.p_value == pytest.approx(p, rel=1e-6)
    assert found.scatter == pytest.approx(scatter, rel=1e-8)
    assert found.deviation == pytest.approx(deviation, rel=1e-6, abs=1e-9)
    assert found.spread_before == pytest.approx(by_hand(z, y, group)[0], rel=1e-8)
    assert found.overlap == pytest.approx(overlap_by_hand(x, group), abs=1e-12)
    # nothing beside it brings the curves nearer
    cost = misfit(x, y)
    for index in (1, 2, 3):
        for aside in (-0.02, 0.02):
            moved = found.shifts + aside * np.eye(4)[index]
            assert misfit(z + moved[group], y) >= cost - 1e-9


def misfit(x: np.ndarray, y: np.ndarray) -> float:
    knots = np.quantile(x, np.linspace(0, 1, min(max(x.size // 4, 2), 8)))
    common = np.column_stack([np.interp(x, knots, row) for row in np.eye(knots.size)])
    return float(np.sum((y - common @ np.linalg.lstsq(common, y, rcond=None)[0]) ** 2))


@pytest.mark.parametrize("e", [8.0, -8.0])
def test_viscosities_of_exact_curves_come_back(e: float) -> None:
    law = Law(Thermal(KELVIN, REFERENCE), FREE)
    # torque in viscosity x speed alone: level moves as the power of speed does, the transition against it
    data = dwells(law, [0.1, 0.4 * e, -0.6, -1.6, 0.0, -e], scatter=0.0)
    found = temperature_collapse(data)
    s = e * np.log(data.temperatures / REFERENCE)
    assert found.collapses is True
    assert found.shifts == pytest.approx(s - s[0], abs=0.05)


def test_what_is_too_little_is_refused() -> None:
    x = np.arange(6.0)
    with pytest.raises(
        InsufficientDataError, match=r"^one curve cannot collapse. Record other temperatures or loads$"
    ):
        hersey_collapse(x, x, np.zeros(6))
    with pytest.raises(InsufficientDataError, match=r"^a curve has fewer than 3 points. Record more speeds$"):
        hersey_collapse(x, x, [0, 0, 0, 0, 1, 1])
    # six points, a line each and none to spare: 6 - 4 = 2 is enough, with a kink more it is not
    found = hersey_collapse(x, x**2, [0, 0, 0, 1, 1, 1])
    assert found.p_value == pytest.approx(by_hand(x, x**2, np.repeat([0, 1], 3))[2], rel=1e-6)
    cold = dwells(Law(Thermal(KELVIN, REFERENCE), ONE), [0.1, -2.0, -0.7], temperatures=np.array([400.0]))
    with pytest.raises(InsufficientDataError, match="one curve cannot collapse"):
        temperature_collapse(cold)
    one = dwells(
        Law(Thermal(KELVIN, REFERENCE), ONE), [0.1, -2.0, -0.7], temperatures=np.array([390.0, 410.0])
    )
    few = one.take(np.array([0, 4, 8, 18, 22, 26]))
    with pytest.raises(
        InsufficientDataError, match=r"^too few points to separate curves from scatter. Record more speeds$"
    ):
        temperature_collapse(few)


def test_what_is_no_list_of_logarithms_is_refused() -> None:
    said = "^log_hersey, log_friction and groups must be one-dimensional and of equal length$"
    x = np.arange(6.0)
    for bad in (
        (x, x[:5], np.repeat([0, 1], 3)),
        (x[:5], x, np.repeat([0, 1], 3)),
        (x, x, np.repeat([0, 1], 2)),
        (x.reshape(2, 3), x.reshape(2, 3), np.repeat([0, 1], 3).reshape(2, 3)),
    ):
        with pytest.raises(ParameterError, match=said):
            hersey_collapse(*bad)
    for spoilt in (np.nan, np.inf):
        y = np.where(x == 2, spoilt, x)
        for pair in ((x, y), (y, x)):
            with pytest.raises(
                ParameterError,
                match=r"^Hersey number and friction must be positive and finite$",
            ):
                hersey_collapse(*pair, np.repeat([0, 1], 3))


def test_temperatures_that_stand_off_as_whole_visits_do_are_not_said_to_part() -> None:
    """Each visit some per cent off, the same Stribeck curve underneath: the curves are not to blame."""
    exact = dwells(Law(Thermal(KELVIN, REFERENCE), FREE), [0.1, 3.2, -0.6, -1.6, 0.0, -8.0], scatter=0.0)
    group = exact.inputs.group

    def judged(size: float, seed: int, shared: float) -> HerseyCollapse:
        random = np.random.default_rng(seed)
        off = size * random.standard_normal(4)[group] + 0.002 * random.standard_normal(group.size)
        return temperature_collapse(replace(exact, log_torque=exact.log_torque + off), shared=shared)

    alone = [judged(0.08, seed, 0.0) for seed in range(4)]
    beside = [judged(0.08, seed, 0.08) for seed in range(4)]
    assert [b.deviation for b in beside] == [a.deviation for a in alone]
    assert any(a.collapses is False for a in alone)
    assert all(b.collapses is not False for b in beside)
    assert any("no more than whole visits do (8 %)" in b.verdict for b in beside)
    assert judged(0.5, 1, 0.05).collapses is False
