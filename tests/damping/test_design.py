"""What to record next."""

from __future__ import annotations

import json

import numpy as np
import pytest

from hersey.damping.candidates import ModelComparison, compare_models
from hersey.damping.candidates.branched import HELD, ONE, Law
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.thermal import ARRHENIUS, KELVIN, Thermal
from hersey.damping.design import design
from hersey.errors import ParameterError
from tests.damping.candidates.test_comparison import REFERENCE, SPEEDS, TEMPERATURES, dwells
from tests.damping.candidates.test_shared_errors import visited

STRAIGHT = Law(Thermal(ARRHENIUS, REFERENCE), ONE)


@pytest.fixture(scope="module")
def straight() -> ModelComparison:
    data = dwells(STRAIGHT, [0.1, 2.8, -0.7])
    return compare_models(data, candidates=(Candidate(ARRHENIUS, ONE),), bootstrap=0, cross_validate=False)


@pytest.fixture(scope="module")
def bent() -> ModelComparison:
    data = dwells(Law(Thermal(ARRHENIUS, REFERENCE), HELD), [0.1, 2.8, -0.7, -1.2, -0.9])
    return compare_models(data, candidates=(Candidate(ARRHENIUS, HELD),), bootstrap=0, cross_validate=False)


def test_d_optimal_points_of_a_plane_are_its_corners(straight: ModelComparison) -> None:
    found = design(straight, count=4)
    for point in found.points:
        assert point.kelvin is not None
        assert min(abs(np.log(point.speed / end)) for end in (SPEEDS[0], SPEEDS[-1])) < 1e-6
        assert point.kelvin in (TEMPERATURES[0], TEMPERATURES[-1])
    assert len({round(p.speed, 3) for p in found.points}) == 2
    volumes = [p.volume for p in found.points]
    assert volumes == sorted(volumes, reverse=True)
    assert volumes[0] < 1.0


def test_the_error_foretold_is_the_error_found(straight: ModelComparison) -> None:
    """Record the dwells it proposes, and look."""
    found = design(straight, count=8, quantity="c")
    data = straight.data
    where = data.at(np.array([p.speed for p in found.points]), np.array([p.kelvin for p in found.points]))
    fit = straight.chosen.fit
    old = STRAIGHT.jacobian(fit.values, data.inputs) / fit.sigma[:, None]
    new = STRAIGHT.jacobian(fit.values, where) / np.median(fit.sigma)
    rows = np.vstack([old, new])
    error = np.sqrt(np.linalg.inv(rows.T @ rows)[2, 2])
    assert found.points[-1].error == pytest.approx(error, rel=0.01)
    assert found.error_now == pytest.approx(np.sqrt(fit.covariance[2, 2]))
    errors = [p.error for p in found.points if p.error is not None]
    assert errors == sorted(errors, reverse=True)


def test_no_other_point_pins_a_quantity_better(straight: ModelComparison) -> None:
    first = design(straight, count=1, quantity="activation energy").points[0]
    fit, data = straight.chosen.fit, straight.data
    old = STRAIGHT.jacobian(fit.values, data.inputs) / fit.sigma[:, None]

    def variance(speed: float, kelvin: float) -> float:
        where = data.at(np.array([speed]), np.array([kelvin]))
        rows = np.vstack([old, STRAIGHT.jacobian(fit.values, where) / np.median(fit.sigma)])
        return float(np.linalg.inv(rows.T @ rows)[1, 1])

    assert first.kelvin is not None
    best = variance(first.speed, first.kelvin)
    assert best <= min(variance(s, t) for s in SPEEDS for t in TEMPERATURES) * (1 + 1e-9)


def test_a_transition_is_pinned_around_itself(bent: ModelComparison) -> None:
    found = design(bent, count=4, quantity="transition speed", seed=3)
    law, values = bent.chosen.fit.law, bent.chosen.fit.values
    assert isinstance(law, Law)
    for point in found.points:
        where = bent.data.at(np.array([point.speed]), np.array([point.kelvin]))
        away = float(where.log_speed[0] - law.transition(values, where)[0])
        assert abs(away) < 1.5
    assert found == design(bent, count=4, quantity="transition speed", seed=3)


def test_a_wider_range_is_used(straight: ModelComparison) -> None:
    wide = design(straight, count=2, speeds=(0.1, 50.0), temperatures=(330.0, 480.0))
    for point in wide.points:
        assert min(abs(np.log(point.speed / end)) for end in (0.1, 50.0)) < 1e-6
        assert point.kelvin == pytest.approx(330.0) or point.kelvin == pytest.approx(480.0)
    assert wide.points[0].volume < design(straight, count=1).points[0].volume


def test_what_cannot_be_asked_is_refused(straight: ModelComparison) -> None:
    with pytest.raises(ParameterError, match=r"'T0' matches no parameters of this model. Use one of"):
        design(straight, quantity="T0")
    with pytest.raises(ParameterError, match="the lower one first"):
        design(straight, speeds=(5.0, 1.0))
    with pytest.raises(ParameterError, match="the lower one first"):
        design(straight, temperatures=(400.0, 300.0))
    with pytest.raises(ParameterError, match="count is 0"):
        design(straight, count=0)


def test_the_design_is_one_document(bent: ModelComparison) -> None:
    found = design(bent, count=2, quantity="c below")
    plain = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert len(plain["points"]) == 2
    assert plain["quantity"] == "c below the transition"
    text = found.summary()
    assert "rpm at" in text
    assert "standard error" in text
    assert fit_law(STRAIGHT, bent.data).freedom > 0


def test_a_dwell_more_takes_away_no_error_that_the_others_share() -> None:
    """Visits that stand off the law leave the level open, whatever a single dwell is good for."""
    data = visited([363.0, 383.0, 403.0, 423.0, 443.0, 453.0], between=0.03, within=0.002, seed=2)
    found = compare_models(data, candidates=(Candidate(KELVIN, ONE),), bootstrap=0, cross_validate=False)
    fit = found.chosen.fit
    assert fit.shared[0].deviation > 5.0 * fit.scatter
    proposed = design(found, count=2, quantity="damping at reference")
    assert proposed.error_now is not None
    first, second = (p.error for p in proposed.points)
    assert first is not None
    assert second is not None
    # one visit beside six: by 1/6 of the variance and what its temperature adds
    assert 0.85 * proposed.error_now < first < proposed.error_now
    assert 0.85 * first < second < first
