"""The sampler against targets whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.posterior.drives import Drives
from hersey.posterior.sampler import Moves, Population, sample

CLOSURES = np.array([0.5, 0.5])


def _drawn(target: object, *, size: int = 3, count: int = 2000, seed: int = 1) -> Population:
    random = np.random.default_rng(seed)
    start = Drives(
        np.zeros(count, dtype=np.intp),
        (np.arange(count) % 2).astype(np.intp),
        random.standard_normal((count, size)),
    )
    return sample(start, target, CLOSURES, np.ones(1), random, Moves(often=9.0, rounds=4, last=10))  # type: ignore[arg-type]


def test_a_normal_likelihood_gives_the_product_of_both() -> None:
    """Prior N(0, 1), likelihood N(2, 0.1): mean 2/(1 + 0.01), deviation 0.1/sqrt(1.01), evidence by hand."""

    def target(drives: Drives, _: np.ndarray) -> np.ndarray:
        return -0.5 * ((drives.latent[:, 0] - 2.0) / 0.1) ** 2 - np.log(0.1 * np.sqrt(2.0 * np.pi))

    found = _drawn(target)
    values = found.drives.latent[:, 0]
    assert values.mean() == pytest.approx(2.0 / 1.01, abs=0.01)
    assert values.std() == pytest.approx(0.1 / np.sqrt(1.01), rel=0.1)
    exact = -0.5 * 2.0**2 / 1.01 - 0.5 * np.log(2.0 * np.pi * 1.01)
    assert found.log_evidence == pytest.approx(exact, abs=0.15)
    # what the likelihood does not see keeps its prior
    assert found.drives.latent[:, 1].std() == pytest.approx(1.0, rel=0.1)


def test_both_modes_are_found_with_their_weights() -> None:
    """Two narrow modes, three to one."""

    def target(drives: Drives, _: np.ndarray) -> np.ndarray:
        x = drives.latent[:, 0]
        modes = [-0.5 * ((x - at) / 0.05) ** 2 + np.log(share) for at, share in ((-1.5, 0.75), (1.5, 0.25))]
        return np.logaddexp(*modes)

    shares = [float(np.mean(_drawn(target, seed=s).drives.latent[:, 0] < 0.0)) for s in range(4)]
    assert np.mean(shares) == pytest.approx(0.75, abs=0.06)


def test_closures_have_the_odds_of_their_evidence() -> None:
    """A likelihood nine times as great for the first."""

    def target(drives: Drives, _: np.ndarray) -> np.ndarray:
        return np.where(drives.closure == 0, np.log(9.0), 0.0)

    found = _drawn(target)
    assert np.mean(found.drives.closure == 0) == pytest.approx(0.9, abs=0.03)


def test_correlated_numbers_are_drawn() -> None:
    """A likelihood that knows the sum of two numbers to 1 % and not their difference."""

    def target(drives: Drives, _: np.ndarray) -> np.ndarray:
        return -0.5 * ((drives.latent[:, 0] + drives.latent[:, 1] - 1.0) / 0.01) ** 2

    found = _drawn(target).drives.latent
    assert (found[:, 0] + found[:, 1]).mean() == pytest.approx(1.0, abs=0.005)
    assert (found[:, 0] - found[:, 1]).std() == pytest.approx(np.sqrt(2.0), rel=0.15)


def test_the_same_seed_gives_the_same_bits() -> None:
    def target(drives: Drives, _: np.ndarray) -> np.ndarray:
        return -0.5 * (drives.latent[:, 0] / 0.1) ** 2

    first, again = (_drawn(target, count=200).drives.latent for _ in range(2))
    assert np.array_equal(first, again)


def test_draws_that_are_not_taken_need_no_target() -> None:
    asked, spared = [0], [0]

    def whole(drives: Drives, _: np.ndarray) -> np.ndarray:
        return -0.5 * ((drives.latent[:, 0] - 2.0) / 0.1) ** 2 - 0.1 * drives.closure

    def bounded(drives: Drives, least: np.ndarray) -> np.ndarray:
        value = whole(drives, least)
        asked[0] += value.size
        spared[0] += np.count_nonzero(value < least)
        return np.where(value < least, -np.inf, value)

    all_, some = (_drawn(target, count=400) for target in (whole, bounded))
    assert np.array_equal(all_.drives.latent, some.drives.latent)
    assert np.array_equal(all_.drives.closure, some.drives.closure)
    assert (all_.log_evidence, all_.accepted) == (some.log_evidence, some.accepted)
    assert spared[0] > 0.4 * asked[0]
