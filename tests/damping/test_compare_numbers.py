"""The numbers of a comparison of two logs by hand: ratio, Scheffe's limits, Holm's p-values, words."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy import stats

from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.comparison import ModelComparison, compare_models
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.intervals import quantities
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.thermal import ARRHENIUS, Thermal
from hersey.damping.compare import Change, LogComparison, compare
from hersey.damping.estimate import Estimate
from hersey.errors import InsufficientDataError
from tests.damping.candidates.test_comparison import REFERENCE, SPEEDS, TEMPERATURES, dwells

BENT = Law(Thermal(ARRHENIUS, REFERENCE), HELD)
STRAIGHT = Law(None, ONE)
RPM = np.pi / 30


def about(data: Observations, factor: float, kelvin: float) -> Observations:
    """The same dwells about another reference speed and temperature."""
    inputs = replace(data.inputs, log_speed=data.inputs.log_speed - np.log(factor))
    speed = factor * data.reference_speed
    return replace(data, inputs=inputs, reference_speed=speed, reference_kelvin=kelvin)


def isothermal(level: float, c: float, *, seed: int = 1, scatter: float = 0.01) -> Observations:
    return dwells(STRAIGHT, [level, c], temperatures=None, seed=seed, scatter=scatter)


def between(data: Observations, slow: float, fast: float) -> Observations:
    """Dwells at speeds (rad/s) in a range."""
    return data.take(np.flatnonzero((data.speed > slow * 0.999) & (data.speed < fast * 1.001)))


@cache
def both() -> tuple[ModelComparison, ModelComparison, LogComparison]:
    """Two bent logs of different ranges, references and numbers of dwells, and their comparison."""
    a = dwells(BENT, [0.1, 2.8, -0.7, -1.2, -0.9])
    b = dwells(BENT, [0.2, 2.6, -0.68, -1.2, -0.7], seed=2)
    a = between(a, SPEEDS[0], SPEEDS[6])
    b = about(between(b, SPEEDS[1], SPEEDS[8]), 2.0, 415.0)
    first, second = (compare_models(d, bootstrap=0, cross_validate=False) for d in (a, b))
    return first, second, compare(a, b, names=("new", "aged"))


def fits() -> tuple[LawFit, LawFit]:
    first, second, found = both()
    picked = [
        next(r.fit for r in c.candidates if r.candidate.name == found.candidate) for c in (first, second)
    ]
    return picked[0], picked[1]


def at(
    fit: LawFit, data: Observations, speed: np.ndarray, kelvin: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Logarithm of torque, and its slopes by central differences."""
    inputs = data.at(speed, kelvin)
    columns = []
    for index, value in enumerate(fit.values):
        step = 1e-6 * max(abs(value), 1.0)
        ends = []
        for side in (step, -step):
            values = fit.values.copy()
            values[index] += side
            ends.append(fit.law.predict(values, inputs))
        columns.append((ends[0] - ends[1]) / (2 * step))
    return fit.law.predict(fit.values, inputs), np.column_stack(columns)


def difference() -> tuple[np.ndarray, np.ndarray, int]:
    """Of ln torque, B minus A, on the grid; its covariance; the degrees of freedom of the lesser log."""
    first, second, found = both()
    speed, kelvin = (g.ravel() for g in np.meshgrid(found.speeds, found.temperatures))
    a, b = fits()
    (y_a, g_a), (y_b, g_b) = at(a, first.data, speed, kelvin), at(b, second.data, speed, kelvin)
    return y_b - y_a, g_a @ a.covariance @ g_a.T + g_b @ b.covariance @ g_b.T, min(a.freedom, b.freedom)


def test_the_law_for_both_has_the_least_sum_of_aicc() -> None:
    first, second, found = both()
    sums = {}
    for r in first.candidates:
        for s in second.candidates:
            if r.candidate == s.candidate and not r.not_identified and not s.not_identified:
                sums[r.candidate.name] = (r.fit.aicc + s.fit.aicc, r.fit.parameters)
    least = min(total for total, _ in sums.values())
    near = {name: (size, total) for name, (total, size) in sums.items() if total <= least + 6.0}
    assert found.candidate == min(near, key=lambda name: near[name])


def test_the_range_is_what_both_measured() -> None:
    _, _, found = both()
    assert found.speeds == pytest.approx(np.geomspace(SPEEDS[1], SPEEDS[6], 9), rel=1e-9)
    assert found.temperatures == pytest.approx(np.linspace(TEMPERATURES[0], TEMPERATURES[-1], 4))
    assert found.ratio.shape == found.low.shape == found.high.shape == (4, 9)


def test_the_ratio_is_that_of_the_laws_with_scheffes_limits() -> None:
    _, _, found = both()
    y, covariance, freedom = difference()
    p = fits()[0].values.size
    assert fits()[0].freedom < fits()[1].freedom
    assert found.ratio.ravel() == pytest.approx(np.exp(y), rel=1e-9)
    reach = np.sqrt(p * stats.f.ppf(0.95, p, freedom) * np.diag(covariance))
    assert np.log(found.high / found.ratio).ravel() == pytest.approx(reach, rel=2e-3)
    assert np.log(found.ratio / found.low).ravel() == pytest.approx(reach, rel=2e-3)


def test_the_mean_ratio_is_geometric() -> None:
    _, _, found = both()
    y, covariance, freedom = difference()
    error = float(np.sum(covariance)) ** 0.5 / y.size
    mean, reach = found.mean_ratio, float(stats.t.ppf(0.975, freedom)) * error
    assert np.log(mean.value) == pytest.approx(float(np.mean(y)), rel=1e-9)
    assert mean.error == pytest.approx(mean.value * error, rel=2e-3)
    assert np.log(mean.high / mean.value) == pytest.approx(reach, rel=2e-3)
    assert np.log(mean.value / mean.low) == pytest.approx(reach, rel=2e-3)


def expected_changes() -> dict[str, tuple[float, float, float, float]]:
    """Value in A, in B, size of the change and its error; of speeds in logarithms."""
    first, second, _ = both()
    a, b = fits()
    u, v = ({q.name: q for q in quantities(f, c.data)} for f, c in ((a, first), (b, second)))
    out = {}
    for name, unit in (("c", 1.0), ("c below the transition", 1.0), ("activation energy of torque", None)):
        p, q = u[name].parameter, v[name].parameter
        x, y = u[name].of(a.values[p]), v[name].of(b.values[q])
        scale = (unit or x / a.values[p], unit or y / b.values[q])
        error = np.hypot(scale[0] * a.covariance[p, p] ** 0.5, scale[1] * b.covariance[q, q] ** 0.5)
        out[name] = (x, y, y - x, float(error))
    p, q = a.law.index("at"), b.law.index("at")
    kelvin = np.array([REFERENCE])
    assert isinstance(a.law, Law)
    assert isinstance(b.law, Law)
    x = first.data.reference_speed * float(np.exp(a.values[p]))
    moved = b.law.transition(b.values, second.data.at(np.ones(1), kelvin))
    y = second.data.reference_speed * float(np.exp(moved[0]))
    error = np.hypot(a.covariance[p, p] ** 0.5, b.covariance[q, q] ** 0.5)
    out["transition speed"] = (x, y, float(np.log(y / x)), float(error))
    return out


def test_changes_by_hand_corrected_as_holm_has_it() -> None:
    _, _, found = both()
    expected, freedom = expected_changes(), difference()[2]
    assert [c.name for c in found.changes] == sorted(expected)
    raw = {
        k: 2 * float(stats.t.sf(abs(size) / error, freedom)) for k, (_, _, size, error) in expected.items()
    }
    order = sorted(raw, key=lambda name: raw[name])
    for rank, name in enumerate(order):
        holm = max(min(1.0, raw[n] * (len(raw) - i)) for i, n in enumerate(order[: rank + 1]))
        change = next(c for c in found.changes if c.name == name)
        x, y, size, error = expected[name]
        reach = float(stats.t.ppf(0.975, freedom)) * error
        assert change.p_value == pytest.approx(holm, rel=1e-2)
        assert (change.of_a, change.of_b) == pytest.approx((x, y), rel=1e-6)
        assert change.is_ratio == (name == "transition speed")
        e = change.change
        got = np.array([e.value, e.low, e.high])
        assert (np.log(got) if change.is_ratio else got) == pytest.approx(
            [size, size - reach, size + reach], rel=1e-4, abs=1e-9
        )
        assert e.error == pytest.approx(error * (e.value if change.is_ratio else 1.0), rel=1e-4)
    assert len({round(c.p_value, 12) for c in found.changes}) > 1


def test_no_p_value_is_less_than_that_of_a_greater_change() -> None:
    """Of three changes by chance alone the least, times one, would be less than the one before it."""
    law, values = Law(None, FREE), [0.1, -0.7, -1.2, -0.9]
    a, b = (dwells(law, values, temperatures=None, seed=seed) for seed in (1, 2))
    found = {c.name: c for c in compare(a, b).changes}
    assert set(found) == {"c", "c below the transition", "transition speed"}
    raw = {}
    for name, change in found.items():
        e = change.change
        ratio = np.log(e.value) * e.value / e.error if change.is_ratio else e.value / e.error
        raw[name] = 2 * float(stats.t.sf(abs(ratio), len(a) - 4))
    order = sorted(raw, key=lambda name: raw[name])
    holm = [min(1.0, raw[name] * (3 - rank)) for rank, name in enumerate(order)]
    assert holm != sorted(holm)
    for rank, name in enumerate(order):
        assert found[name].p_value == pytest.approx(max(holm[: rank + 1]), rel=1e-4)


def test_a_change_is_real_at_five_percent() -> None:
    nothing = Estimate(0.0, 1.0, -2.0, 2.0)
    assert Change("c", 0.0, 0.0, nothing, False, 0.0499).real
    assert not Change("c", 0.0, 0.0, nothing, False, 0.0501).real


def test_the_summary_and_the_document_say_the_same_numbers() -> None:
    _, _, found = both()
    lines = found.summary().splitlines()
    assert lines[:4] == ["A: new", "B: aged", f"model for both: {found.candidate}", found.verdict]
    assert lines[4] == f"damping ratio B/A, mean over the shared range: {found.mean_ratio}"
    for row, hot in enumerate((90, 120, 150, 180)):
        parts = []
        for i in (0, 4, 8):
            numbers = found.ratio[row, i], found.low[row, i], found.high[row, i]
            parts.append("{:.3g} rpm {:.3f} [{:.3f}, {:.3f}]".format(found.speeds[i] / RPM, *numbers))
        assert lines[5 + row] == f"  {hot} degC: {'; '.join(parts)}"
    speed = next(c for c in found.changes if c.is_ratio)
    assert (
        f"  transition speed: {speed.of_a / RPM:.4g} rpm and {speed.of_b / RPM:.4g} rpm, "
        f"B/A = {speed.change}, p = {speed.p_value:.2g}"
    ) in lines
    c = next(c for c in found.changes if c.name == "c")
    assert f"  c: {c.of_a:.4g} and {c.of_b:.4g}, B - A = {c.change}, p = {c.p_value:.2g}" in lines
    plain = found.to_dict()
    assert (plain["a"], plain["b"], plain["candidate"], plain["verdict"]) == (
        "new",
        "aged",
        found.candidate,
        found.verdict,
    )
    for name in ("speeds", "temperatures", "ratio", "low", "high"):
        assert np.asarray(plain[name]) == pytest.approx(getattr(found, name))
    assert plain["mean_ratio"] == vars(found.mean_ratio)
    changes = plain["changes"]
    assert isinstance(changes, list)
    assert [(c["name"], c["real"]) for c in changes] == [(c.name, c.real) for c in found.changes]


def test_more_or_less_throughout() -> None:
    a, b = isothermal(0.1, -0.7), isothermal(0.1 + np.log(1.2), -0.7, seed=2)
    more, less = compare(a, b, names=("x", "y")), compare(b, a, names=("y", "x"))
    up, down = 100 * (more.mean_ratio.value - 1), 100 * (1 - less.mean_ratio.value)
    assert more.verdict == (
        f"Damping of y is higher than that of x throughout the shared range, +{up:.1f} % on average."
    )
    assert less.verdict == (
        f"Damping of x is lower than that of y throughout the shared range, -{down:.1f} % on average."
    )
    assert less.ratio == pytest.approx(1.0 / more.ratio)
    assert less.low == pytest.approx(1.0 / more.high)
    assert less.mean_ratio.low == pytest.approx(1.0 / more.mean_ratio.high)
    assert more.temperatures.size == 0
    assert more.ratio.shape == (1, 9)
    assert [c.name for c in more.changes] == ["c"]


def test_more_in_one_part_and_less_in_another() -> None:
    found = compare(isothermal(0.1, -0.7), isothermal(0.1, -0.5, seed=2))
    assert found.verdict == (
        "Damping of B is higher than that of A in one part of the shared range and lower in another. "
        "Also different: c."
    )
    assert found.ratio[0, 0] < 0.9 < 1.1 < found.ratio[0, -1]


def test_more_over_a_part() -> None:
    middle = float(np.log(SPEEDS[-1] / SPEEDS[0])) / 2
    found = compare(isothermal(0.1, -0.7), isothermal(0.1 + 0.05 * middle, -0.65, seed=2))
    share = float(np.mean(found.low > 1.0))
    assert 0.0 < share < 1.0
    assert (
        f"Damping of B is higher than that of A over {100 * share:.0f} % of the shared range, +"
        in found.verdict
    )
    other = compare(isothermal(0.1, -0.7), isothermal(0.1 - 0.05 * middle, -0.75, seed=2))
    share = float(np.mean(other.high < 1.0))
    assert 0.0 < share < 1.0
    assert (
        f"Damping of B is lower than that of A over {100 * share:.0f} % of the shared range, -"
        in other.verdict
    )


def test_no_difference_is_bounded() -> None:
    for level in (0.108, 0.092):
        found = compare(isothermal(0.1, -0.7, scatter=0.03), isothermal(level, -0.7, seed=2, scatter=0.03))
        widest = max(float(np.max(found.high)) - 1.0, 1.0 - float(np.min(found.low)))
        assert found.verdict == (
            f"No difference in damping is proven; any difference is at most {100 * widest:.1f} %."
        )
        assert found.warnings == ()


def test_what_each_alone_would_be_given_is_noted() -> None:
    straight = isothermal(0.1, -0.7)
    bent = dwells(Law(None, FREE), [0.1, -0.7, -1.2, -0.9], temperatures=None, seed=2)
    alone, given = (
        compare_models(d, bootstrap=0, cross_validate=False).chosen.candidate.name for d in (straight, bent)
    )
    for a, b, shown in (
        (straight, bent, {"A": alone, "B": given}),
        (bent, straight, {"A": given, "B": alone}),
    ):
        found = compare(a, b)
        lost = [
            f"fitted separately, {n} would get another model: {candidate}"
            for n, candidate in shown.items()
            if candidate != found.candidate
        ]
        assert lost
        assert [str(each) for each in found.warnings] == [
            *lost,
            "only one of the two logs shows a falling branch",
        ]


def test_speeds_are_shared_from_a_factor_of_1_2_on() -> None:
    data = isothermal(0.1, -0.7)
    span = SPEEDS[-1] / SPEEDS[0]
    for overlap in (1.25, 1.15):
        faster = replace(data, reference_speed=data.reference_speed * span / overlap)
        if overlap > 1.2:
            found = compare(data, faster)
            assert found.speeds[[0, -1]] == pytest.approx([SPEEDS[-1] / overlap, SPEEDS[-1]])
        else:
            words = rf"A covers {SPEEDS[0] / RPM:.3g} to {SPEEDS[-1] / RPM:.3g} rpm, B covers {133:.3g} to"
            with pytest.raises(InsufficientDataError, match=words):
                compare(data, faster)


def test_temperatures_are_shared_within_three_kelvin() -> None:
    law, values = Law(Thermal(ARRHENIUS, REFERENCE), ONE), [0.1, 2.8, -0.7]
    hot = dwells(law, values, temperatures=np.array([400.0, 430.0, 460.0]))
    for end, shared in ((398.0, True), (396.0, False)):
        cold = dwells(law, values, temperatures=np.array([340.0, 370.0, end]), seed=2)
        if shared:
            assert compare(cold, hot).temperatures == pytest.approx(np.linspace(398.0, 400.0, 4))
        else:
            words = "B ends at 123 degC, A starts at 127 degC"
            with pytest.raises(InsufficientDataError, match=words):
                compare(hot, cold)
