"""Shares of drag that does not follow the film, and what runs have in common, against their formulas."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hersey.arrays import FloatArray, IntArray
from hersey.life.film.common_to_runs import Common, fitted_together
from hersey.life.film.layer import interpolated
from hersey.life.film.run_search import COMMON, COMMON_ENDS, OWN
from hersey.life.film.shares import SHARES, StarvesAt, by_share, other_drag, slower_by_share
from hersey.life.film.starved_drag import FREE


@dataclass(frozen=True)
class LinearSearch:
    """Dwells of runs whose torque is linear in what is free: (runs, dwells, FREE) times (runs, FREE)."""

    slopes: FloatArray
    torque: FloatArray
    common: FloatArray

    @property
    def freedom(self) -> FloatArray:
        return np.full(len(self.torque), float(self.torque.shape[1] - OWN.size))

    def without_common(self) -> LinearSearch:
        return self

    def with_common(self, common: FloatArray) -> LinearSearch:
        return replace(self, common=common)

    def moved(self, free: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        left = self.torque - np.einsum("rdf,rf->rd", self.slopes, free)
        gradient = np.einsum("rdf,rd->rf", self.slopes, left)
        return (left**2).sum(axis=1), gradient, np.einsum("rdf,rdg->rfg", self.slopes, self.slopes)

    def searched(self, steps: int, of: IntArray) -> tuple[FloatArray, None, None]:
        free = np.zeros((len(self.torque), FREE))
        free[:, COMMON] = self.common
        return self.settled(free, steps=steps, of=of)

    def settled(self, free: FloatArray, *, steps: int, of: IntArray) -> tuple[FloatArray, None, None]:
        assert steps > 0
        _, gradient, bend = self.moved(free)
        best = free.copy()
        best[:, of] += np.linalg.solve(bend[:, of[:, None], of], gradient[:, of, None])[..., 0]
        return best, None, None


def test_what_runs_have_in_common_is_that_of_least_squares() -> None:
    """Of all runs at once, with what is known beforehand: normal equations of all that is free."""
    random, runs, dwells = np.random.default_rng(4), 5, 30
    low, high = COMMON_ENDS
    known = Common(0.5 * (low + high), np.diag((0.1 * (high - low)) ** 2))
    slopes = random.normal(size=(runs, dwells, FREE))
    truth = np.zeros((runs, FREE))
    truth[:, COMMON] = known.mean + 0.05 * (high - low)
    truth[:, OWN] = random.normal(0.0, 0.1, (runs, OWN.size))
    torque = np.einsum("rdf,rf->rd", slopes, truth) + random.normal(0.0, 1.5, (runs, dwells))
    search: Any = LinearSearch(slopes, torque, known.mean)
    found = fitted_together([search], known)

    common = np.arange(FREE)[COMMON]
    columns = np.zeros((runs * dwells + 7, 7 + runs * OWN.size))
    for i in range(runs):
        rows = slice(i * dwells, (i + 1) * dwells)
        columns[rows, :7] = slopes[i][:, common]
        columns[rows, 7 + i * OWN.size : 7 + (i + 1) * OWN.size] = slopes[i][:, OWN]
    columns[-7:, :7] = np.diag(1 / np.sqrt(np.diag(known.covariance)))
    data = np.append(torque.ravel(), known.mean / np.sqrt(np.diag(known.covariance)))
    best = np.linalg.lstsq(columns, data, rcond=None)[0]
    assert ((low < best[:7]) & (best[:7] < high)).all()
    assert found.common.mean == pytest.approx(best[:7], abs=1e-7)

    left = ((torque.ravel() - columns[:-7] @ best) ** 2).reshape(runs, dwells).sum(axis=1)
    freedom = dwells - OWN.size
    stretch = np.median(left / freedom)
    assert stretch > 1.5
    inverse = np.linalg.inv(columns.T @ columns)[:7, :7]
    assert found.common.covariance == pytest.approx(stretch * inverse, rel=1e-6, abs=1e-12)
    away = (best[:7] - known.mean) ** 2 / np.diag(known.covariance)
    assert found.unlikely == pytest.approx(
        (freedom * np.log(left / freedom).sum() + away.sum()) / runs, rel=1e-9
    )


NO_YOUNG = np.zeros(2, dtype=bool)


@dataclass(frozen=True)
class OfShares:
    """A fit of two runs of which each share of other drag is so unlikely."""

    unlikely: dict[float, float]
    dwells: Any = field(default_factory=lambda: SimpleNamespace(rows=lambda _: None))
    computed_share: float = 0.04
    level: float = 0.1

    def together(self, share: float) -> Any:
        return SimpleNamespace(unlikely=self.unlikely[share], common=share)

    def layers(self, common: float) -> Any:
        return SimpleNamespace(best=[common, common])


def of_unlikely(unlikely: list[float]) -> Any:
    return OfShares(dict(zip(SHARES.tolist(), unlikely, strict=True)))


def test_shares_that_dwells_do_not_tell_apart_fall_from_0_to_45_percent_by_half() -> None:
    """Their density is 1 - s/0.9, and even between the ends of what each share stands for."""
    by = by_share(of_unlikely([3.0] * 4), ["U1", "U2"], NO_YOUNG)
    assert by.weight == pytest.approx(np.array([67.0, 57.0, 38.4, 32.0]) / 194.4)
    ends = [0.125 * 9.72 / 67.0, 0.125 + 0.125 * 30.2 / 57.0, 0.35 + 0.1 * (32.0 - 9.72) / 32.0]
    assert [by.quantile(of) for of in (0.05, 0.5, 0.95)] == pytest.approx(ends)
    drag = other_drag(by, [StarvesAt(0.05, 80.0, 100.0), StarvesAt(0.4, 40.0, 60.0)])
    assert (drag.low, drag.share, drag.high, drag.computed) == pytest.approx((*ends, 0.04))
    assert drag.sooner
    assert not drag.determined


def test_a_likelier_share_weighs_more_by_the_squares_of_one_run() -> None:
    """Half of them in the exponent, times what is known beforehand."""
    by = by_share(of_unlikely([np.log(4.0), 0.0, 9.0, 9.0]), ["U1", "U2"], NO_YOUNG)
    assert by.weight[0] / by.weight[1] == pytest.approx(0.5 * 67.0 / 57.0)
    assert by.likeliest.best == [0.2, 0.2]
    narrow = other_drag(by, [StarvesAt(0.05, 1.0, 60.0), StarvesAt(0.4, 1.0, 100.0)])
    assert narrow.determined
    assert not narrow.sooner


def test_ages_at_other_shares_are_those_factors_of_the_likeliest() -> None:
    starves = [
        StarvesAt(share, 1.0, age) for share, age in zip(SHARES, (120.0, 100.0, np.inf, 60.0), strict=True)
    ]
    weight = np.array([0.3, 0.4, 0.1, 0.2])
    factors = slower_by_share(starves, weight, 20_000, seed=1)
    values, counts = np.unique(factors, return_counts=True)
    assert values == pytest.approx([0.6, 1.0, 1.2])  # the age that is not known changes nothing
    assert counts / factors.size == pytest.approx([0.2, 0.5, 0.3], abs=0.02)


def test_rows_are_interpolated_as_numpy_does() -> None:
    random = np.random.default_rng(2)
    places, values = np.cumsum(random.uniform(0.1, 1.0, (5, 7)), axis=1), random.normal(size=(5, 7))
    at = np.array([-3.0, places[1, 2], 0.5 * (places[2, 3] + places[2, 4]), places[3, 0] + 0.01, 99.0])
    expected = [np.interp(x, *row) for x, *row in zip(at, places, values, strict=True)]
    assert interpolated(at, places, values) == pytest.approx(expected)
