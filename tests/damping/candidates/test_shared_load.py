"""The law of a known contact as a candidate: recovery, derivatives, and what a log does not tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hersey.damping.candidates import Candidate, compare_models
from hersey.damping.candidates.branched import HELD, SHARED
from hersey.damping.candidates.candidate import contact_candidates
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.identifiability import not_identified
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.shared_load import SharedLoadLaw
from hersey.damping.candidates.thermal import ARRHENIUS
from hersey.errors import InsufficientDataError, ParameterError
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.lubrication.mixed import mixed_contact
from tests.lubrication.roll import OIL, ROLL

CONTACT = mixed_contact(
    ROLL,
    OIL,
    Asperities(modulus="50 GPa"),
    BoundaryFriction(0.1, slope=-1e-4, temperature="100 degC"),
    speed=4.0,
    temperature=373.15,
)
KNOWN, FREE = contact_candidates(CONTACT)
#: Logarithms of factors on what the contact states, and N m.
TRUTH = {"viscosity": 0.2, "roughness": -0.15, "boundary": 0.1, "rest": 0.02}
TEMPERATURES = np.array([333.15, 353.15, 373.15, 393.15])


def dwells(seed: int = 1, slowest: float = 0.1, truth: dict[str, float] = TRUTH) -> Observations:
    """12 speeds at 4 temperatures with 1 % noise."""
    grid = np.meshgrid(np.geomspace(slowest, 30.0, 12), np.arange(4))
    speed, group = grid[0].ravel(), grid[1].ravel().astype(np.intp)
    reference, size = float(np.exp(np.mean(np.log(speed)))), np.ones(speed.size)
    inputs = Inputs(np.log(speed / reference), TEMPERATURES[group], group)
    law = SharedLoadLaw(CONTACT, reference, 1.0)
    exact = law.predict(np.array([truth[name] for name in law.names]), inputs)
    return Observations(
        inputs=inputs,
        log_torque=exact + 0.01 * np.random.default_rng(seed).standard_normal(speed.size),
        torque_error=0.01 * size,
        speed_error=1e-5 * size,
        temperature_error=1e-3 * size,
        tare=np.empty((speed.size, 0)),
        visit=np.zeros(speed.size, dtype=np.intp),
        run=np.zeros(speed.size, dtype=np.intp),
        cluster=np.arange(speed.size),
        clustered_by="level",
        reference_speed=reference,
        reference_kelvin=float(1.0 / np.mean(1.0 / TEMPERATURES)),
        temperatures=TEMPERATURES,
    )


def test_the_truth_is_in_its_intervals() -> None:
    held = []
    for seed in range(5):
        data = dwells(seed)
        fit = fit_law(FREE.law(data), data)
        assert isinstance(fit.law, SharedLoadLaw)
        assert not not_identified(fit, data)
        for name, value in TRUTH.items():
            found = fit.estimate(name)
            held.append(found.low <= (value / fit.law.torque if name == "rest" else value) <= found.high)
            assert fit.error(name) < 0.05
    assert sum(held) >= 18


def test_derivatives_are_those_of_the_law() -> None:
    data = dwells()
    law, values = FREE.law(data), np.array([0.1, -0.2, 0.05, 0.03])
    slopes = law.jacobian(values, data.inputs)
    for i in range(values.size):
        step = 1e-5 * np.eye(values.size)[i]
        rise = law.predict(values + step, data.inputs) - law.predict(values - step, data.inputs)
        assert slopes[:, i] == pytest.approx(rise / 2e-5, abs=1e-7)
    by_speed, by_heat = law.slopes(values, data.inputs)
    assert data.inputs.kelvin is not None
    faster, slower = (replace(data.inputs, log_speed=data.inputs.log_speed + e) for e in (1e-5, -1e-5))
    hotter, colder = (replace(data.inputs, kelvin=data.inputs.kelvin + e) for e in (1e-3, -1e-3))
    rise = law.predict(values, faster) - law.predict(values, slower)
    assert by_speed == pytest.approx(rise / 2e-5, abs=1e-7)
    rise = law.predict(values, hotter) - law.predict(values, colder)
    assert by_heat == pytest.approx(rise / 2e-3, abs=1e-7)


def test_it_is_chosen_where_it_made_the_dwells() -> None:
    data = dwells(seed=2)
    beside = (Candidate(ARRHENIUS, HELD),)
    found = compare_models(data, candidates=beside, contact=CONTACT, bootstrap=0, cross_validate=False)
    assert found.chosen.candidate.key == "mixed"
    assert SHARED in found.summary()
    named = {p.name: p for p in found.parameters}
    low, high = named["roughness of both faces, rms"].interval or (0.0, 0.0)
    assert low < 0.4e-6 * np.exp(-0.15) < high
    low, high = named["boundary friction"].interval or (0.0, 0.0)
    assert low < 0.1 * np.exp(0.1) < high
    law = SharedLoadLaw(CONTACT, data.reference_speed, 1.0)
    exact = np.exp(law.predict(np.array(list(TRUTH.values())), data.at(np.array([5.0]), np.array([353.15]))))
    assert found.predict(speed=5.0, temperature=353.15).torque == pytest.approx(exact, rel=0.01)
    with pytest.raises(ParameterError, match="temperature"):
        found.predict(speed=5.0)


def test_a_viscosity_that_is_right_as_stated_is_not_fitted() -> None:
    data = dwells(truth=TRUTH | {"viscosity": 0.0})
    found = compare_models(data, candidates=(KNOWN, FREE), bootstrap=0, cross_validate=False)
    assert found.chosen.candidate.key == "mixed/viscosity-known"
    assert found.chosen.fit.values[0] == pytest.approx(-0.15, abs=0.03)


def test_a_film_alone_tells_neither_roughness_nor_friction() -> None:
    data = dwells(slowest=12.0)
    data = data.take(np.flatnonzero(data.inputs.group < 2))
    lost = not_identified(fit_law(FREE.law(data), data), data)
    assert {"roughness", "boundary"} <= lost.keys()
    assert "uncertain by more than a factor" in lost["roughness"]


def test_a_log_that_cannot_carry_it_is_told() -> None:
    data = dwells()
    assert data.inputs.kelvin is not None
    isothermal = replace(data, inputs=replace(data.inputs, kelvin=None))
    assert FREE.refused(isothermal) == "the log has no temperature"
    frozen = replace(data, inputs=replace(data.inputs, kelvin=data.inputs.kelvin - 250.0))
    assert "viscosity of cylinder oil" in FREE.refused(frozen)
    few = data.take(np.flatnonzero(np.isin(np.arange(48) % 12, [0, 4, 8])))
    with pytest.raises(InsufficientDataError, match="needs 5 speeds"):
        compare_models(few, candidates=(FREE,))
