"""What to record next, against every candidate tried by hand: volumes, errors and the words for them."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.damping.candidates import ModelComparison, compare_models
from hersey.damping.candidates.branched import HELD, ONE, Law
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.thermal import ARRHENIUS, Thermal
from hersey.damping.design import TestDesign, design
from hersey.errors import ParameterError
from tests.damping.candidates.test_comparison import REFERENCE, SPEEDS, TEMPERATURES, dwells

RPM = np.pi / 30


@pytest.fixture(scope="module")
def straight() -> ModelComparison:
    law = Law(Thermal(ARRHENIUS, REFERENCE), ONE)
    candidates = (Candidate(ARRHENIUS, ONE),)
    return compare_models(
        dwells(law, [0.1, 2.8, -0.7]), candidates=candidates, bootstrap=0, cross_validate=False
    )


@pytest.fixture(scope="module")
def bent() -> ModelComparison:
    data = dwells(Law(Thermal(ARRHENIUS, REFERENCE), HELD), [0.1, 2.8, -0.7, -1.2, -0.9])
    return compare_models(data, candidates=(Candidate(ARRHENIUS, HELD),), bootstrap=0, cross_validate=False)


@pytest.fixture(scope="module")
def vague() -> ModelComparison:
    """A bend hardly known: draws of it differ so much that their mean gain is another than their median."""
    law = Law(Thermal(ARRHENIUS, REFERENCE), HELD)
    data = dwells(law, [0.1, 2.8, -0.7, -1.2, -0.9], scatter=0.1, twice=1, seed=3)
    return compare_models(data, candidates=(Candidate(ARRHENIUS, HELD),), bootstrap=0, cross_validate=False)


@pytest.fixture(scope="module")
def isothermal() -> ModelComparison:
    data = dwells(Law(None, ONE), [0.1, -0.7], temperatures=None)
    return compare_models(data, candidates=(Candidate(None, ONE),), bootstrap=0, cross_validate=False)


def every_candidate(comparison: ModelComparison) -> Inputs:
    speeds = np.geomspace(SPEEDS[0], SPEEDS[-1], 25)
    w, t = np.meshgrid(speeds, TEMPERATURES)
    return comparison.data.at(w.ravel(), t.ravel())


def information(comparison: ModelComparison, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """That of the dwells recorded, and the row that each candidate would add."""
    fit = comparison.chosen.fit
    old = fit.law.jacobian(values, comparison.data.inputs) / fit.sigma[:, None]
    sigma = (fit.scatter**2 + float(np.median(fit.errors)) ** 2) ** 0.5
    return old.T @ old, fit.law.jacobian(values, every_candidate(comparison)) / sigma


def where(found: TestDesign, comparison: ModelComparison) -> list[int]:
    """Which candidate each point is."""
    grid = every_candidate(comparison)
    speed = comparison.data.reference_speed * np.exp(grid.log_speed)
    assert grid.kelvin is not None
    out = []
    for point in found.points:
        assert point.kelvin is not None
        away = np.abs(np.log(speed / point.speed)) + np.abs(grid.kelvin - point.kelvin)
        assert away.min() < 1e-9
        out.append(int(np.argmin(away)))
    return out


def test_each_point_of_a_plane_shrinks_the_region_most(straight: ModelComparison) -> None:
    """The volume is as the root of the determinant of the covariance."""
    found = design(straight, count=5)
    total, rows = information(straight, straight.chosen.fit.values)
    start = np.linalg.det(total)
    for index, point in zip(where(found, straight), found.points, strict=True):
        volumes = [(start / np.linalg.det(total + np.outer(row, row))) ** 0.5 for row in rows]
        assert volumes[index] == pytest.approx(min(volumes), rel=1e-9)
        assert point.volume == pytest.approx(volumes[index], rel=1e-6)
        assert point.error is None
        total = total + np.outer(rows[index], rows[index])
    assert (found.quantity, found.unit, found.error_now) == ("", "", None)


@pytest.mark.parametrize(("quantity", "index"), [("activation energy", 1), ("c", 2), ("damping", 0)])
def test_each_point_leaves_the_least_error(straight: ModelComparison, quantity: str, index: int) -> None:
    found = design(straight, count=4, quantity=quantity)
    fit = straight.chosen.fit
    total, rows = information(straight, fit.values)
    start = np.linalg.det(total)
    (estimate,) = (p for p in straight.parameters if p.name == found.quantity)
    assert estimate.error is not None
    scale = estimate.error / fit.covariance[index, index] ** 0.5
    assert found.error_now == pytest.approx(estimate.error, rel=1e-5)
    assert found.unit == estimate.unit
    for place, point in zip(where(found, straight), found.points, strict=True):
        left = [np.linalg.inv(total + np.outer(row, row))[index, index] for row in rows]
        assert left[place] == pytest.approx(min(left), rel=1e-9)
        assert point.error == pytest.approx(scale * left[place] ** 0.5, rel=1e-4)
        total = total + np.outer(rows[place], rows[place])
        assert point.volume == pytest.approx((start / np.linalg.det(total)) ** 0.5, rel=1e-6)


def draws_of(comparison: ModelComparison, seed: int) -> np.ndarray:
    """The fit itself and forty draws of it."""
    fit = comparison.chosen.fit
    random = np.random.default_rng(seed)
    return np.vstack([fit.values, random.multivariate_normal(fit.values, fit.covariance, 40)])


def test_where_the_law_bends_the_gain_is_that_of_most_draws(vague: ModelComparison) -> None:
    found = design(vague, count=5, seed=4)
    known = [information(vague, values) for values in draws_of(vague, 4)]
    totals, rows = np.array([total for total, _ in known]), np.array([row for _, row in known])
    start = np.linalg.slogdet(totals)[1]
    for place, point in zip(where(found, vague), found.points, strict=True):
        inverse = np.linalg.inv(totals)
        gains = [
            np.median([np.log(1 + rows[k, n] @ inverse[k] @ rows[k, n]) for k in range(41)])
            for n in range(rows.shape[1])
        ]
        assert gains[place] == pytest.approx(max(gains), rel=1e-6)
        totals = totals + np.einsum("ki,kj->kij", rows[:, place], rows[:, place])
        volume = np.exp(-np.median(np.linalg.slogdet(totals)[1] - start) / 2)
        assert point.volume == pytest.approx(float(volume), rel=1e-4)


def test_where_the_law_bends_an_error_is_that_of_most_draws(bent: ModelComparison) -> None:
    found = design(bent, count=2, quantity="transition speed", seed=4)
    fit = bent.chosen.fit
    assert isinstance(fit.law, Law)
    i = fit.law.index("at")
    known = [information(bent, values) for values in draws_of(bent, 4)]
    totals, rows = np.array([total for total, _ in known]), np.array([row for _, row in known])
    speed = bent.data.reference_speed * float(np.exp(fit.values[i]))
    assert found.error_now == pytest.approx(speed * fit.covariance[i, i] ** 0.5, rel=1e-5)
    assert (found.quantity, found.unit) == ("transition speed", "rad/s")
    for place, point in zip(where(found, bent), found.points, strict=True):
        now = np.linalg.inv(totals)[:, i, i]
        shares = []
        for n in range(rows.shape[1]):
            then = np.linalg.inv(totals + np.einsum("ki,kj->kij", rows[:, n], rows[:, n]))[:, i, i]
            shares.append(float(np.mean(1.0 - then / now)))
        assert shares[place] == pytest.approx(max(shares), rel=1e-5)
        totals = totals + np.einsum("ki,kj->kij", rows[:, place], rows[:, place])
        left = float(np.median(np.linalg.inv(totals)[:, i, i]))
        assert point.error == pytest.approx(speed * left**0.5, rel=1e-4)


def test_the_seed_is_of_the_draws(bent: ModelComparison, straight: ModelComparison) -> None:
    one, other = design(bent, count=2, seed=1), design(bent, count=2, seed=2)
    assert (one.seed, other.seed) == (1, 2)
    assert all(p.volume != q.volume for p, q in zip(one.points, other.points, strict=True))
    assert design(bent, count=2) == one
    assert design(straight, seed=1).points == design(straight, seed=2).points  # nothing is drawn


def test_six_points_unless_asked(straight: ModelComparison) -> None:
    assert len(design(straight).points) == 6
    assert len(design(straight, count=1).points) == 1


def test_the_ranges_that_can_be_run(straight: ModelComparison, isothermal: ModelComparison) -> None:
    fast = design(straight, count=6, speeds=(20.0, 40.0))
    assert {round(p.speed, 9) for p in fast.points} <= {round(v, 9) for v in np.geomspace(20.0, 40.0, 25)}
    assert {p.kelvin for p in fast.points} <= set(TEMPERATURES)
    hot = design(straight, count=6, temperatures=(460.0, 520.0))
    assert {p.kelvin for p in hot.points} <= set(np.linspace(460.0, 520.0, 7))
    assert SPEEDS[0] * 0.999 < min(p.speed for p in hot.points)
    level = design(isothermal, count=3, temperatures=(460.0, 520.0))
    assert {p.kelvin for p in level.points} == {None}
    assert round(level.points[0].speed, 6) in (round(SPEEDS[0], 6), round(SPEEDS[-1], 6))
    for bad in ((0.0, 5.0), (5.0, 5.0)):
        with pytest.raises(ParameterError, match=f"speeds are {bad[0]:g} to 5 rad/s: both must be above 0"):
            design(straight, speeds=bad)
        with pytest.raises(ParameterError, match=f"temperatures is {bad[0]:g} without a unit"):
            design(straight, temperatures=bad)


def test_a_quantity_is_named_by_its_beginning(bent: ModelComparison) -> None:
    assert design(bent, count=1, quantity="TRANS").quantity == "transition speed"
    assert design(bent, count=1, quantity="c").quantity == "c"  # in full, though two begin so
    assert design(bent, count=1, quantity="c b").quantity == "c below the transition"
    with pytest.raises(ParameterError, match="'x' matches no parameters") as none:
        design(bent, quantity="x")
    assert "'damping at reference', 'activation energy of torque', 'c'" in str(none.value)
    with pytest.raises(ParameterError, match="count is -1: it must be at least 1"):
        design(bent, count=-1)


def test_the_points_in_words(bent: ModelComparison, straight: ModelComparison) -> None:
    found = design(bent, count=2, quantity="transition speed", seed=3)
    first, second = found.points
    assert found.error_now is not None
    lines = found.summary().splitlines()
    assert lines[0] == f"Next dwells to determine the transition speed (model: {found.law}; seed 3):"
    assert lines[1] == f"  present standard error: {found.error_now / RPM:.3g} rpm"
    for number, point in ((1, first), (2, second)):
        assert point.kelvin is not None
        assert point.error is not None
        celsius = f"{point.kelvin - 273.15:.0f} degC"
        error = f"{point.error / RPM:.3g} rpm"
        assert lines[number + 1] == (
            f"  {number}. {point.speed / RPM:.3g} rpm at {celsius}: standard error {error}"
        )
    assert found.law == bent.chosen.candidate.name
    whole = design(straight, count=1)
    (point,) = whole.points
    lines = whole.summary().splitlines()
    assert lines[0] == f"Next dwells to determine all parameters (model: {whole.law}; seed 1):"
    assert lines[1].endswith(f"confidence region of all parameters shrinks to {100 * point.volume:.0f} %")
    assert len(lines) == 2
    energy = design(straight, count=1, quantity="activation")
    assert f"present standard error: {energy.error_now:.3g} kJ/mol" in energy.summary()
    exponent = design(straight, count=1, quantity="c")
    assert exponent.summary().splitlines()[1] == f"  present standard error: {exponent.error_now:.3g}"


def test_the_document_holds_every_number(bent: ModelComparison) -> None:
    found = design(bent, count=2, quantity="transition speed", seed=3)
    assert found.to_dict() == {
        "quantity": "transition speed",
        "unit": "rad/s",
        "error_now": found.error_now,
        "law": found.law,
        "seed": 3,
        "points": [
            {"speed": p.speed, "kelvin": p.kelvin, "error": p.error, "volume": p.volume} for p in found.points
        ],
    }
