"""The candidates: laws and their derivatives, fits, refusals, the choice."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey.damping.candidates import Candidate, Observations, compare_models
from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.candidate import all_candidates
from hersey.damping.candidates.errors_in_variables import orthogonal_fit
from hersey.damping.candidates.fitting import AnyLaw, fit_law
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.refits import left_out
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, GAS_CONSTANT, KELVIN, VFT, Thermal
from hersey.errors import InsufficientDataError, ParameterError

REFERENCE = 400.0
SPEEDS = np.geomspace(0.4, 16.0, 9)
TEMPERATURES = np.array([363.0, 393.0, 423.0, 453.0])


def dwells(
    law: AnyLaw,
    values: list[float],
    *,
    temperatures: np.ndarray | None = TEMPERATURES,
    scatter: float = 0.01,
    seed: int = 1,
    twice: int = 2,
) -> Observations:
    """Return dwells of a law at a grid of speeds and temperatures, each visited twice."""
    levels = np.array([np.nan]) if temperatures is None else temperatures
    group, step = (
        a.ravel().repeat(twice) for a in np.meshgrid(np.arange(levels.size), np.arange(SPEEDS.size))
    )
    speed = SPEEDS[step]
    reference = float(np.exp(np.mean(np.log(speed))))
    kelvin = None if temperatures is None else levels[group]
    inputs = Inputs(np.log(speed / reference), kelvin, group.astype(np.intp))
    noise = scatter * np.random.default_rng(seed).standard_normal(speed.size)
    size = np.ones_like(speed)
    return Observations(
        inputs=inputs,
        log_torque=law.predict(np.array(values), inputs) + noise,
        torque_error=2e-3 * size,
        speed_error=1e-4 * size,
        temperature_error=0.02 * size,
        tare=np.empty((size.size, 0)),
        visit=np.arange(size.size),
        run=np.zeros(size.size, dtype=np.intp),
        cluster=(group * SPEEDS.size + step).astype(np.intp),
        clustered_by="level",
        reference_speed=reference,
        reference_kelvin=None if temperatures is None else REFERENCE,
        temperatures=np.empty(0) if temperatures is None else levels,
    )


LAWS: dict[str, tuple[Law | StribeckLaw, list[float]]] = {
    "power-degC/one": (Law(Thermal(CELSIUS, REFERENCE), ONE), [0.1, -0.9, -0.7]),
    "power-K/two-hersey": (Law(Thermal(KELVIN, REFERENCE), HELD), [0.1, -2.8, -0.7, -1.2, -0.9]),
    "arrhenius/two-hersey": (Law(Thermal(ARRHENIUS, REFERENCE), HELD), [0.1, 2.8, -0.7, -1.2, -0.9]),
    "vft/two-free": (Law(Thermal(VFT, REFERENCE), FREE), [0.1, 2.8, 1 / 200.0, -0.7, -1.2, -0.9, -5.0]),
    "vft/two-hersey": (Law(Thermal(VFT, REFERENCE), HELD), [0.1, 2.8, 1 / 200.0, -0.7, -1.2, -0.9]),
    "arrhenius/one/each": (
        Law(Thermal(ARRHENIUS, REFERENCE), ONE, groups=4),
        [0.1, 2.8, -0.6, -0.65, -0.7, -0.75],
    ),
    "power-degC/two-free/each": (
        Law(Thermal(CELSIUS, REFERENCE), FREE, groups=4),
        [0.1, -0.9, -0.6, -0.65, -0.7, -0.75, -1.3, -0.8, 2.0],
    ),
    "stribeck": (StribeckLaw(Thermal(ARRHENIUS, REFERENCE)), [-1.2, 9.0, -0.2, -2.0, 0.2]),
}


@pytest.mark.parametrize("key", LAWS)
def test_derivatives_are_those_of_the_law(key: str) -> None:
    law, values = LAWS[key]
    data, at = dwells(law, values), np.array(values) + 0.013
    step = 1e-6
    for index, column in enumerate(law.jacobian(at, data.inputs).T):
        aside = step * max(abs(at[index]), 1e-2) * np.eye(at.size)[index]
        change = law.predict(at + aside, data.inputs) - law.predict(at - aside, data.inputs)
        assert column == pytest.approx(change / (2 * aside[index]), rel=1e-5, abs=1e-6)
    by_speed, by_heat = law.slopes(at, data.inputs)
    inputs = data.inputs
    assert inputs.kelvin is not None
    faster, slower = (replace(inputs, log_speed=inputs.log_speed + s) for s in (step, -step))
    hotter, colder = (replace(inputs, kelvin=inputs.kelvin + 1e-3 * s) for s in (1.0, -1.0))
    for slope, (ahead, behind, width) in (
        (by_speed, (faster, slower, 2 * step)),
        (by_heat, (hotter, colder, 2e-3)),
    ):
        change = law.predict(at, ahead) - law.predict(at, behind)
        assert slope == pytest.approx(change / width, rel=1e-4, abs=1e-7)


@pytest.mark.parametrize("key", LAWS)
def test_exact_data_give_their_law_back(key: str) -> None:
    law, values = LAWS[key]
    found = fit_law(law, dwells(law, values, scatter=0.0))
    assert found.values == pytest.approx(values, rel=1e-4, abs=1e-4)
    assert found.scatter == 0.0


@pytest.mark.parametrize("key", LAWS)
def test_every_candidate_is_chosen_on_its_own_data(key: str) -> None:
    law, values = LAWS[key]

    def right(seed: int) -> bool:
        found = compare_models(dwells(law, values, seed=seed), bootstrap=0, cross_validate=False)
        gap = found.candidate(key).fit.aicc - found.chosen.fit.aicc
        return found.chosen.candidate.key == key or abs(gap) < 2.0

    assert any(right(seed) for seed in range(2))


def test_arrhenius_is_vft_with_a_pole_at_zero() -> None:
    kelvin = np.linspace(300.0, 500.0, 7)
    arrhenius, vft = Thermal(ARRHENIUS, REFERENCE), Thermal(VFT, REFERENCE)
    assert vft.shape(kelvin, 1.0 / REFERENCE)[0] == pytest.approx(arrhenius.shape(kelvin)[0], abs=1e-14)
    # Vogel's own form: D/(T - T0) about the reference
    t0, d = 200.0, 900.0
    q = 1.0 / (REFERENCE - t0)
    own = d / (kelvin - t0) - d / (REFERENCE - t0)
    assert d * q**2 * REFERENCE * vft.shape(kelvin, q)[0] == pytest.approx(own, abs=1e-12)


def test_apparent_energies_are_minus_the_slope_over_one_over_t() -> None:
    for kind in (CELSIUS, KELVIN, ARRHENIUS, VFT):
        law = Thermal(kind, REFERENCE)
        ends = np.array([419.99, 420.01])
        s = law.shape(ends, 0.004)[0]
        slope = GAS_CONSTANT * (s[1] - s[0]) / (1 / ends[1] - 1 / ends[0])
        assert law.energy(420.0, 0.004) == pytest.approx(slope, rel=1e-6)


def test_one_temperature_refuses_thermal_candidates_by_name() -> None:
    law = Law(None, FREE)
    data = dwells(law, [0.1, -0.7, -1.2, -0.9], temperatures=None)
    found = compare_models(data, bootstrap=0)
    assert found.chosen.candidate.key == "isothermal/two-free"
    names = [name for name, _ in found.refused]
    assert len(names) == sum(candidate.thermal is not None for candidate in all_candidates())
    assert all(why == "the log has no temperature" for _, why in found.refused)
    assert "[[Activation energy]]" not in found.summary()
    one = dwells(Law(Thermal(KELVIN, REFERENCE), ONE), [0.1, 0.0, -0.7], temperatures=np.array([400.0]))
    refused = dict(compare_models(one, bootstrap=0, cross_validate=False).refused)
    assert (
        refused["Arrhenius x power of speed, one branch"] == "needs 2 temperatures; the log has 1 (127 degC)"
    )


def test_two_temperatures_refuse_vft_alone() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), ONE)
    data = dwells(law, [0.1, 2.8, -0.7], temperatures=np.array([363.0, 453.0]))
    found = compare_models(data, bootstrap=0, cross_validate=False)
    assert found.refused
    assert all("VFT" in name for name, _ in found.refused)
    vft = [candidate for candidate in all_candidates() if candidate.thermal == VFT]
    assert len(found.refused) == len(vft)


def test_temperatures_below_freezing_refuse_powers_of_degrees_celsius() -> None:
    law = Law(Thermal(ARRHENIUS, 290.0), ONE)
    data = dwells(law, [0.1, 2.8, -0.7], temperatures=np.array([263.0, 283.0, 313.0]))
    refused = dict(compare_models(data, bootstrap=0, cross_validate=False).refused)
    assert (
        refused["power law in degC x power of speed, one branch"] == "T^b is not defined at or below 0 degC"
    )


def test_one_speed_yields_no_law(points: hersey.SteadyPoints) -> None:
    speed = np.abs(points.column("speed"))
    kept = np.abs(np.log(speed / np.median(speed))) < 0.02
    with pytest.raises(InsufficientDataError, match="Record dwells at three or more speeds"):
        compare_models(replace(points, table=points.table.filter(kept)))


def test_one_bad_dwell_moves_the_fit_little() -> None:
    law, values = LAWS["power-degC/one"]
    clean = dwells(law, values)
    spoilt = clean.log_torque.copy()
    spoilt[5] += 1.0
    before, after = fit_law(law, clean), fit_law(law, replace(clean, log_torque=spoilt))
    error = np.sqrt(np.diag(before.covariance))
    assert np.all(np.abs(after.values - before.values) < 2.0 * error)
    columns = law.jacobian(before.values, clean.inputs)
    plain, *_ = np.linalg.lstsq(columns, spoilt - clean.log_torque, rcond=None)
    assert np.max(np.abs(plain) / error) > 5.0  # what least squares would have done


def test_a_tare_shared_by_all_dwells_widens_the_intervals() -> None:
    law, values = LAWS["power-degC/one"]
    data = dwells(law, values)
    tare = 0.02 / np.exp(data.log_torque)[:, None]
    without, with_tare = fit_law(law, data), fit_law(law, replace(data, tare=tare))
    wider = np.sqrt(np.diag(with_tare.covariance) / np.diag(without.covariance))
    assert np.all(wider >= 1.0 - 1e-6)
    assert wider[0] > 2.0
    moved = replace(data, log_torque=data.log_torque + tare[:, 0], tare=tare)
    assert fit_law(law, moved).values == pytest.approx(with_tare.values, abs=4 * 0.01)
    assert fit_law(law, moved).effects[0] > with_tare.effects[0] + 0.2


def test_errors_of_speed_and_temperature_enter_by_the_slope() -> None:
    law, values = LAWS["power-K/two-hersey"]
    data = dwells(law, values)
    coarse = replace(data, speed_error=np.full(len(data), 0.05))
    found = fit_law(law, coarse)
    slopes, _ = law.slopes(found.values, data.inputs)
    expected = np.sqrt(
        data.torque_error**2 + (0.05 * slopes) ** 2 + (law.slopes(found.values, data.inputs)[1] * 0.02) ** 2
    )
    assert found.errors == pytest.approx(expected, rel=1e-3)


def test_odrpack_agrees_with_the_effective_variance() -> None:
    law, values = LAWS["arrhenius/two-hersey"]
    data = dwells(law, values)
    random = np.random.default_rng(4)
    shift = 0.02 * random.standard_normal(len(data))
    blurred = replace(
        data,
        inputs=replace(data.inputs, log_speed=data.inputs.log_speed + shift),
        speed_error=np.full(len(data), 0.02),
    )
    found = fit_law(law, blurred)
    check = orthogonal_fit(found, blurred)
    assert check.converged
    assert 0.05 < check.share < 1.0
    assert check.largest_shift < 1.5
    assert "ODRPACK" in check.verdict


def test_left_out_dwells_are_predicted_without_themselves() -> None:
    law, values = LAWS["power-degC/one"]
    data = dwells(law, values)
    spoilt = data.log_torque.copy()
    spoilt[:2] += 0.05  # one level, both visits
    data = replace(data, log_torque=spoilt)
    found = fit_law(law, data)
    missed = left_out(found, data)
    assert np.all(np.abs(missed[:2]) > np.abs(found.residuals[:2]))
    others = np.flatnonzero(data.cluster != data.cluster[0])
    alone = fit_law(law, data.take(others))
    expected = data.log_torque[:2] - law.predict(alone.values, data.inputs)[:2]
    assert missed[:2] == pytest.approx(expected, abs=2e-3)


def test_comparison_of_a_log_is_one_document(points: hersey.SteadyPoints) -> None:
    found = compare_models(points, bootstrap=20, seed=7)
    assert found.chosen.candidate.branches == HELD
    by_name = {p.name: p for p in found.parameters}
    low, high = by_name["c"].intervals["profile"]
    assert low < -0.7 < high
    text = found.summary()
    for heading in (
        "[[Models]]",
        "[[Choice]]",
        "[[Parameters]]",
        "[[Activation energy]]",
        "[[Hersey collapse]]",
    ):
        assert heading in text
    assert "seed 7" in text
    plain = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert plain["chosen"] == found.chosen.candidate.key
    assert len(plain["candidates"]) == len(found.candidates)
    assert sum(r["akaike_weight"] for r in plain["candidates"]) == pytest.approx(1.0)
    aicc = [r["aicc"] for r in plain["candidates"]]
    assert aicc == sorted(aicc)
    with pytest.raises(ParameterError, match="no model 'nonsense' was fitted"):
        found.candidate("nonsense")
    with pytest.raises(ParameterError, match="bootstrap is -1"):
        compare_models(points, bootstrap=-1)


def test_keys_and_names_of_candidates_are_their_own() -> None:
    candidates = all_candidates()
    assert len({r.key for r in candidates}) == len({r.name for r in candidates}) == len(candidates)
    assert Candidate(VFT, HELD).key == "vft/two-hersey"


@pytest.mark.filterwarnings("error")
def test_exact_data_leave_no_warning() -> None:
    """Their variances are so small that rounding takes them below 0."""
    speed, hot = np.tile(np.geomspace(10.0, 150.0, 8), 4), np.repeat([90.0, 120.0, 150.0, 180.0], 8)
    torque = 2.0 * (speed * np.pi / 30.0) ** 0.3 * (hot / 100.0) ** -0.9
    points = hersey.SteadyPoints.from_table(
        {"speed [rpm]": speed, "torque [N*m]": torque, "temperature [degC]": hot}
    )
    found = compare_models(points, bootstrap=0, cross_validate=False)
    assert found.chosen.candidate.key == "power-degC/one"
