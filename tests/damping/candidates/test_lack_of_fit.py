"""Whether a law holds: F tests of what it lacks against least squares written out here."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from hersey.damping.candidates.branched import FREE, ONE, Law
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.lack_of_fit import lack_of_fit
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.thermal import ARRHENIUS, KELVIN, Thermal
from tests.damping.candidates.cases import even
from tests.damping.candidates.test_comparison import REFERENCE, SPEEDS, dwells

ISOTHERMAL, THERMAL = Law(None, ONE), Law(Thermal(KELVIN, REFERENCE), ONE)


def f_by_hand(
    data: Observations, sigma: np.ndarray, columns: list[np.ndarray], added: list[np.ndarray]
) -> float:
    """p-value of no such terms beside these columns, by two weighted least squares."""
    y = data.log_torque / sigma

    def left(terms: list[np.ndarray]) -> float:
        rows = np.column_stack(terms) / sigma[:, None]
        return float(np.sum((y - rows @ np.linalg.lstsq(rows, y, rcond=None)[0]) ** 2))

    before, after = left(columns), left([*columns, *added])
    freedom = len(data) - len(columns) - len(added)
    return float(stats.f.sf((before - after) / len(added) / (after / freedom), len(added), freedom))


def test_each_p_value_by_two_least_squares() -> None:
    data = even(THERMAL, [0.1, -2.4, -0.7])
    fit = fit_law(THERMAL, data)
    assert np.max(np.abs(fit.residuals / fit.sigma)) < 2.5
    z, kelvin = data.inputs.log_speed, data.inputs.kelvin
    assert kelvin is not None
    columns = [np.ones_like(z), np.log(kelvin / REFERENCE), z]
    found, warm = lack_of_fit(fit, data), kelvin - kelvin.mean()
    z = z - z.mean()
    assert found.curvature == pytest.approx(f_by_hand(data, fit.sigma, columns, [z**2, z**3]), rel=1e-5)
    varying = f_by_hand(data, fit.sigma, columns, [z * warm])
    assert found.exponent_with_temperature == pytest.approx(varying, rel=1e-5)
    assert found.temperature == pytest.approx(f_by_hand(data, fit.sigma, columns, [warm**2]), rel=1e-5)


def test_local_exponents_are_the_slopes_of_a_cubic() -> None:
    """Of ln torque against ln speed, less one."""
    data = dwells(ISOTHERMAL, [0.1, -0.7], temperatures=None)
    z = data.inputs.log_speed
    bent = replace(data, log_torque=0.1 + 0.3 * z + 0.05 * z**2 - 0.01 * z**3)
    found = lack_of_fit(fit_law(ISOTHERMAL, bent), bent)
    expected = [0.3 + 0.1 * e - 0.03 * e**2 - 1.0 for e in (z.min(), z.max())]
    assert found.local_exponents == pytest.approx(expected, abs=2e-3)


def test_the_drift_is_that_of_a_cubic() -> None:
    data = dwells(ISOTHERMAL, [0.1, -0.7], temperatures=None)
    z = data.inputs.log_speed
    bent = replace(data, log_torque=0.1 + 0.3 * z + 0.05 * z**2 - 0.01 * z**3)
    slow, fast = (0.1 * e - 0.03 * e**2 for e in (z.min(), z.max()))
    assert lack_of_fit(fit_law(ISOTHERMAL, bent), bent).drift == pytest.approx(fast - slow, abs=1e-6)


def test_true_power_laws_hold_as_often_as_they_should() -> None:
    """The p-values are uniform, of curvature and of temperature."""
    fits = [
        lack_of_fit(fit_law(THERMAL, d), d)
        for d in (dwells(THERMAL, [0.1, -2.4, -0.7], seed=s) for s in range(80))
    ]
    for name in ("curvature", "exponent_with_temperature", "temperature"):
        assert stats.kstest([getattr(f, name) for f in fits], "uniform").pvalue > 0.02, name
    assert sum(not f.holds for f in fits) <= 5


def test_coulomb_and_viscous_is_no_power_law() -> None:
    data = dwells(ISOTHERMAL, [0.1, -0.7], temperatures=None)
    for seed in range(10):
        noise = 0.01 * np.random.default_rng(seed).standard_normal(len(data))
        seen = replace(data, log_torque=np.log(1.0 + 0.15 * data.speed) + noise)
        found = lack_of_fit(fit_law(ISOTHERMAL, seen), seen)
        assert found.curvature is not None
        assert found.curvature < 1e-8
        assert found.in_speed
        assert not found.holds
        share = 0.15 * SPEEDS / (1.0 + 0.15 * SPEEDS)
        assert found.drift == pytest.approx(share[-1] - share[0], rel=0.2)
        (miss,) = found.misses()
        slow, fast = found.local_exponents
        assert f"from {slow:.2f} at the slowest speeds to {fast:.2f} at the fastest" in miss


def test_an_exponent_that_varies_with_temperature_and_a_bend_in_temperature() -> None:
    data = dwells(THERMAL, [0.1, -2.4, -0.7])
    assert data.inputs.kelvin is not None
    warm = data.inputs.kelvin / REFERENCE - 1.0
    varying = replace(data, log_torque=data.log_torque + 0.5 * warm * data.inputs.log_speed)
    found = lack_of_fit(fit_law(THERMAL, varying), varying)
    assert found.exponent_with_temperature is not None
    assert found.exponent_with_temperature < 1e-6
    assert found.curvature is not None
    assert found.curvature > 0.01
    assert (found.in_speed, found.in_temperature, found.holds) == (True, False, False)
    assert "temperature" in found.misses()[0]
    bent = replace(data, log_torque=data.log_torque + 20.0 * warm**2)
    found = lack_of_fit(fit_law(THERMAL, bent), bent)
    assert found.temperature is not None
    assert found.temperature < 1e-6
    assert (found.in_speed, found.in_temperature, found.holds) == (False, True, False)
    assert len(found.misses()) == 1


def test_a_bend_that_visits_scatter_as_much_as_is_no_bend() -> None:
    """Errors that dwells share are among those that a term is tested against."""
    data = dwells(THERMAL, [0.1, -2.4, -0.7])
    visit = data.inputs.group
    off = 0.03 * np.array([1.0, -1.0, -1.0, 1.0])[visit]  # as warm^2 would have it
    shared = replace(data, log_torque=data.log_torque + off, visit=visit)
    alone = replace(shared, visit=np.arange(len(data)))
    (p, naive) = (lack_of_fit(fit_law(THERMAL, d), d).temperature for d in (shared, alone))
    assert p is not None
    assert naive is not None
    assert naive < 1e-6
    assert p > 0.01


def test_shared_errors_are_those_of_generalised_least_squares() -> None:
    """Each p-value by the covariance of all dwells, those of a visit sharing one error."""
    data = dwells(THERMAL, [0.1, -2.4, -0.7], temperatures=np.repeat([363.0, 393.0, 423.0, 453.0], 2), seed=8)
    visit = data.inputs.group
    off = 0.03 * np.random.default_rng(5).standard_normal(8)[visit]
    data = replace(data, log_torque=data.log_torque + off, visit=visit)
    fit = fit_law(THERMAL, data)
    assert fit.shared[0].deviation > 0.01
    assert np.max(np.abs(fit.residuals / fit.sigma)) < 2.5
    same = np.equal.outer(visit, visit).astype(float)
    root = np.linalg.inv(np.linalg.cholesky(np.diag(fit.sigma**2) + fit.shared[0].deviation ** 2 * same))
    z, kelvin = data.inputs.log_speed, data.inputs.kelvin
    assert kelvin is not None
    white = [root @ column for column in (np.ones_like(z), np.log(kelvin / REFERENCE), z)]
    whitened = replace(data, log_torque=root @ data.log_torque)
    warm, ones = kelvin - kelvin.mean(), np.ones(len(data))
    found = lack_of_fit(fit, data)
    for p, terms in (
        (found.curvature, [(z - z.mean()) ** 2, (z - z.mean()) ** 3]),
        (found.exponent_with_temperature, [(z - z.mean()) * warm]),
        (found.temperature, [warm**2]),
    ):
        expected = f_by_hand(whitened, ones, white, [root @ term for term in terms])
        assert p == pytest.approx(expected, rel=1e-4)


def test_too_few_speeds_or_temperatures_say_nothing() -> None:
    data = dwells(ISOTHERMAL, [0.1, -0.7], temperatures=None)
    step = np.argmin(np.abs(data.speed[:, None] - SPEEDS), axis=1)
    three, four = (data.take(np.flatnonzero(np.isin(step, keep))) for keep in ([0, 4, 8], [0, 3, 5, 8]))
    assert lack_of_fit(fit_law(ISOTHERMAL, three), three).curvature is None
    found = lack_of_fit(fit_law(ISOTHERMAL, four), four)
    assert found.curvature is not None
    assert found.temperature is found.exponent_with_temperature is None
    two = dwells(THERMAL, [0.1, -2.4, -0.7], temperatures=np.array([363.0, 453.0]))
    found = lack_of_fit(fit_law(THERMAL, two), two)
    assert found.temperature is None
    assert found.exponent_with_temperature is not None
    # four speeds say z^2, and no z^3 with it
    fit = fit_law(ISOTHERMAL, four)
    z = four.inputs.log_speed
    expected = f_by_hand(four, fit.sigma, [np.ones_like(z), z], [(z - z.mean()) ** 2])
    assert lack_of_fit(fit, four).curvature == pytest.approx(expected, rel=1e-4)


def test_a_law_that_has_the_term_already_is_not_tested_for_it() -> None:
    """An exponent for each of two temperatures is what z s(T) adds."""
    law = Law(Thermal(ARRHENIUS, REFERENCE), ONE, groups=2)
    data = dwells(law, [0.1, 2.8, -0.6, -0.7], temperatures=np.array([363.0, 453.0]))
    assert lack_of_fit(fit_law(law, data), data).exponent_with_temperature is None


def test_what_holds_misses_nothing() -> None:
    law = Law(None, FREE)
    data = dwells(law, [0.1, -0.7, -1.2, -0.4], temperatures=None)
    found = lack_of_fit(fit_law(law, data), data)
    assert found.holds
    assert found.misses() == []
    plain = lack_of_fit(fit_law(ISOTHERMAL, data), data)
    assert not plain.holds
    one_of_many = replace(found, curvature=None)
    assert one_of_many.holds


def test_a_law_without_temperature_does_not_hold_where_torque_varies_with_it() -> None:
    data = dwells(THERMAL, [0.1, -2.4, -0.7])
    found = lack_of_fit(fit_law(ISOTHERMAL, data), data)
    assert found.temperature is not None
    assert found.in_temperature
    assert not found.holds
    assert found.misses()[-1].startswith("the model does not describe how torque varies with temperature")
    alike = dwells(ISOTHERMAL, [0.1, -0.7])
    assert lack_of_fit(fit_law(ISOTHERMAL, alike), alike).holds
