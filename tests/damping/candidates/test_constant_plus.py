"""A constant torque beside a film: derivatives, its limits, and the truth recovered."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hersey.damping.candidates.branched import CONSTANT_PLUS, ONE, REST_PLUS, Law
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.comparison import compare_models
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.identifiability import not_identified
from hersey.damping.candidates.intervals import quantities
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, KELVIN, VFT, Thermal
from tests.damping.candidates.cases import hand_fit, inputs
from tests.damping.candidates.test_comparison import REFERENCE, dwells
from tests.damping.test_surface import points_of

CASES: dict[str, tuple[ConstantPlusLaw, list[float]]] = {
    "isothermal": (ConstantPlusLaw(None), [0.1, -0.6, -0.8]),
    "coulomb-viscous": (ConstantPlusLaw(None, 0.0), [0.1, -0.3]),
    "soft": (ConstantPlusLaw(Thermal(KELVIN, REFERENCE), -0.6), [0.1, -2.8, -0.8]),
    "free": (ConstantPlusLaw(Thermal(CELSIUS, REFERENCE)), [0.1, -0.9, -0.5, -0.8]),
    "arrhenius": (ConstantPlusLaw(Thermal(ARRHENIUS, REFERENCE), 0.0), [0.1, 2.8, 0.4]),
    "warm rest": (ConstantPlusLaw(Thermal(KELVIN, REFERENCE), None, True), [0.1, -4.0, -0.5, -0.8, 1.3]),
    "rest": (ConstantPlusLaw(None, viscous=True), [0.1, -0.6, -0.8, -1.2]),
    "warm viscous": (
        ConstantPlusLaw(Thermal(KELVIN, REFERENCE), -0.6, True, True),
        [0.1, -4.0, -0.8, -1.2, 1.3],
    ),
    "vft": (ConstantPlusLaw(Thermal(VFT, REFERENCE), -0.6, True), [0.1, 2.8, 1 / 200.0, -0.8, 1.3]),
}


def torque(
    law: ConstantPlusLaw, values: list[float], z: np.ndarray, s: np.ndarray | float = 0.0
) -> np.ndarray:
    """F (exp(e s) (w/w_ref)^(1 + c) + (exp(rest) + exp(viscous) w/w_ref) exp(r s)), as the law is defined."""
    named = {"e": 0.0, "r": 0.0, "viscous": -np.inf, "c": law.exponent or 0.0} | dict(
        zip(law.names, values, strict=True)
    )
    film = np.exp(named["e"] * s) * np.exp(z) ** (1.0 + named["c"])
    rest = (np.exp(named["rest"]) + np.exp(named["viscous"]) * np.exp(z)) * np.exp(named["r"] * s)
    return np.asarray(np.exp(named["level"]) * (film + rest))


@pytest.mark.parametrize("key", CASES)
def test_derivatives_are_those_of_the_law(key: str) -> None:
    law, values = CASES[key]
    data, at = dwells(law, values), np.array(values) + 0.013
    step = 1e-6
    for index, column in enumerate(law.jacobian(at, data.inputs).T):
        aside = step * max(abs(at[index]), 1e-2) * np.eye(at.size)[index]
        change = law.predict(at + aside, data.inputs) - law.predict(at - aside, data.inputs)
        assert column == pytest.approx(change / (2 * aside[index]), rel=1e-5, abs=1e-6), law.names[index]
    by_speed, by_heat = law.slopes(at, data.inputs)
    assert data.inputs.kelvin is not None
    faster, slower = (replace(data.inputs, log_speed=data.inputs.log_speed + s) for s in (step, -step))
    change = law.predict(at, faster) - law.predict(at, slower)
    assert by_speed == pytest.approx(change / (2 * step), rel=1e-5, abs=1e-8)
    hotter, colder = (replace(data.inputs, kelvin=data.inputs.kelvin + s) for s in (1e-3, -1e-3))
    change = law.predict(at, hotter) - law.predict(at, colder)
    assert by_heat == pytest.approx(change / 2e-3, rel=1e-4, abs=1e-8)


@pytest.mark.parametrize(
    "key", ["isothermal", "coulomb-viscous", "soft", "free", "warm rest", "rest", "warm viscous"]
)
def test_the_law_is_the_sum_of_a_film_and_a_rest(key: str) -> None:
    law, values = CASES[key]
    z, hot = np.linspace(-1.5, 1.5, 7), np.linspace(360.0, 450.0, 7)
    at = inputs(z.tolist(), hot.tolist())
    s: np.ndarray | float = 0.0
    if law.thermal:
        celsius = law.thermal.kind == CELSIUS
        s = np.log((hot - 273.15) / (REFERENCE - 273.15)) if celsius else np.log(hot / REFERENCE)
    total = torque(law, values, z, s)
    assert np.exp(law.predict(np.array(values), at)) == pytest.approx(total, rel=1e-12)
    named = {"r": 0.0} | dict(zip(law.names, values, strict=True))
    rest = np.exp(named["level"] + named["rest"] + named["r"] * s)
    rest = rest + np.exp(named["level"] + named.get("viscous", -np.inf) + named["r"] * s + z)
    assert law.film_share(np.array(values), at) == pytest.approx(1.0 - rest / total, rel=1e-12)


@pytest.mark.parametrize("key", CASES)
def test_the_truth_is_recovered(key: str) -> None:
    law, values = CASES[key]
    temperatures = np.array([363.0, 393.0, 423.0, 453.0]) if law.thermal else None
    exact = fit_law(law, dwells(law, values, temperatures=temperatures, scatter=0.0))
    assert exact.law.predict(
        exact.values, dwells(law, values, temperatures=temperatures).inputs
    ) == pytest.approx(
        law.predict(np.array(values), dwells(law, values, temperatures=temperatures).inputs), abs=1e-5
    )
    if key not in ("warm rest", "vft"):  # in which two laws of temperature share one torque
        assert exact.values == pytest.approx(values, abs=2e-3)
        data = dwells(law, values, temperatures=temperatures, scatter=0.005)
        fit = fit_law(law, data)
        error = np.sqrt(np.diag(fit.covariance))
        assert np.all(np.abs(fit.values - values) < 3.5 * error)


def test_without_a_constant_it_is_a_power_law() -> None:
    z, hot = np.linspace(-1.5, 1.5, 7), np.linspace(360.0, 450.0, 7)
    at = inputs(z.tolist(), hot.tolist())
    law, plain = ConstantPlusLaw(Thermal(KELVIN, REFERENCE)), Law(Thermal(KELVIN, REFERENCE), ONE)
    none = np.array([0.1, -2.4, -0.7, -39.0])
    assert law.predict(none, at) == pytest.approx(plain.predict(none[:3], at), abs=1e-12)
    assert law.jacobian(none, at)[:, :3] == pytest.approx(plain.jacobian(none[:3], at), abs=1e-12)
    assert law.jacobian(none, at)[:, 3] == pytest.approx(np.zeros(7), abs=1e-12)
    for ours, theirs in zip(law.slopes(none, at), plain.slopes(none[:3], at), strict=True):
        assert ours == pytest.approx(theirs, abs=1e-12)


def test_at_exponent_nil_it_is_coulomb_friction_and_a_viscous_part() -> None:
    w = np.array([0.5, 1.0, 2.0, 4.0])
    reference = 1.6
    constant, k = 0.8, 0.3
    values = np.array([np.log(k * reference), np.log(constant / (k * reference))])
    at = inputs(np.log(w / reference).tolist())
    assert np.exp(ConstantPlusLaw(None, 0.0).predict(values, at)) == pytest.approx(
        constant + k * w, rel=1e-12
    )
    free = np.array([values[0], 0.0, values[1]])
    assert np.exp(ConstantPlusLaw(None).predict(free, at)) == pytest.approx(constant + k * w, rel=1e-12)


def test_a_constant_that_hardly_shows_is_not_determined() -> None:
    law = ConstantPlusLaw(None, -0.6)
    values = [0.1, -1.0]
    data = dwells(law, values, temperatures=None)
    share = 1.0 - law.film_share(np.array(values), data.inputs)
    norm = float(np.sqrt(np.sum(share**2)))
    for error, lost in ((0.49 * norm, set()), (0.51 * norm, {"rest"})):
        fit = hand_fit(law, values, covariance=0.01 * np.eye(2), points=len(data), scatter=0.0)
        fit = replace(fit, errors=np.full(len(data), error))
        assert set(not_identified(fit, data)) == lost
    for variance, lost in ((0.99, set()), (1.01, {"rest"})):
        fit = hand_fit(law, values, covariance=np.diag([0.01, variance]), points=len(data), scatter=0.0)
        fit = replace(fit, errors=np.full(len(data), 0.01))
        assert set(not_identified(fit, data)) == lost


def test_quantities_are_named_as_those_of_the_film() -> None:
    law, values = CASES["free"]
    data = dwells(law, values)
    named = {
        q.name: q.of(values[q.parameter]) for q in quantities(hand_fit(law, values, points=len(data)), data)
    }
    assert named == {
        "torque of the film at reference": pytest.approx(np.exp(0.1)),
        "constant torque over that of the film at reference": pytest.approx(np.exp(-0.8)),
        "b of the film": -0.9,
        "c of the film": -0.5,
    }


def test_a_part_that_rises_with_speed_is_told_where_the_speeds_tell() -> None:
    """Over a factor of 300 in speed all three parts show; over 20 and noisier a simpler law is taken."""
    candidates = tuple(Candidate(None, kind) for kind in (ONE, CONSTANT_PLUS, REST_PLUS))
    for reach, noise in ((300.0, 1e-3), (20.0, 1e-2)):
        w = np.geomspace(0.1, 0.1 * reach, 16)
        off = 1.0 + noise * np.random.default_rng(2).standard_normal(w.size)
        points = points_of(w, (0.02 + 0.002 * w + 0.03 * w**0.3) * off, error=noise)
        found = compare_models(points, candidates=candidates, bootstrap=0, cross_validate=False)
        assert (found.chosen.candidate.branches == REST_PLUS) == (noise < 5e-3)
