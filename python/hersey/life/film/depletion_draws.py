"""Draws of the law of `depletion_law` from the layers of runs, all specimens together."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.film.depletion_law import (
    EVAPORATED,
    LAYER_NEW,
    LOSS,
    SENSITIVITY,
    THICKENING,
    VISCOSITY_NEW,
    Depletion,
    Rates,
    scale,
)
from hersey.life.film.layer import Layers
from hersey.life.film.run_search import DRY, FLOODED
from hersey.life.film.starved_drag import Flooded, cubic
from hersey.life.oil_layer import BY_THEORY

#: What is drawn: what specimens have of their own, and then what they share.
_NUMBERS = SENSITIVITY
#: Means over specimens, beforehand: mean and standard deviation; spreads over specimens: scale of a
#: half-normal.
_MEAN = np.array([0.0, -0.5, 0.0, 0.2, 0.0, np.log(BY_THEORY)])
_MEAN_DEVIATION = np.array([2.0, 2.0, 1.0, 0.7, 2.5, 0.7])
_SPREAD = np.array([0.5, 0.7, 0.2, 0.5, 0.0, 0.0])
#: Scatter of layer and viscosity of runs about the law, beyond their own errors (ln).
_SCATTER = 0.02
#: From so many specimens on they are many.
_MANY = 60
#: Steps from one of all specimens together to the next.
_TOGETHER = 3
#: Standard deviations of ln density below the upper quarter from which a walker is stuck.
_STUCK = 4.0
#: Steps from one cull of walkers to the next, while they still search.
_CULL = 8
#: Steps of the grid on which likelihoods and spreads are held.
_GRID, _SPREADS = 281, 40


@dataclass(frozen=True)
class _RunLikelihoods:
    """Likelihoods of runs on an even grid of places; runs of a specimen stand together.

    ``table`` holds the root of the deviance, ln of the factor on viscosity and its weight, (runs, grid, 3).
    """

    table: FloatArray
    unit: IntArray
    age: FloatArray
    reference: Flooded
    temperature_sensitivity: float
    scale: float
    rates: Rates

    @cached_property
    def first(self) -> IntArray:
        """First run of each specimen."""
        return np.flatnonzero(np.diff(self.unit, prepend=-1))

    @cached_property
    def _flat(self) -> FloatArray:
        return self.table.reshape(-1, 3)

    @cached_property
    def _rows(self) -> IntArray:
        return np.arange(self.age.size) * _GRID

    def log_likelihood(self, own: FloatArray) -> FloatArray:
        """Return that of specimens, (walkers, specimens), at what they have, (walkers, specimens, 5)."""
        layer = self.rates.layer(own[:, self.unit], self.age)
        thick = own[:, self.unit, VISCOSITY_NEW] + own[:, self.unit, THICKENING] * self.age
        at = np.clip(thick, -3.0, 5.0) + self.temperature_sensitivity * self.reference.steep.item()
        place = self.scale + layer - cubic(self.reference.film.reshape(4), at)[0]
        step = np.clip((place - DRY) * ((_GRID - 1) / (FLOODED - DRY)), 0.0, _GRID - 1.000001)
        index = step.astype(np.intp)
        share = (step - index)[..., None]
        rows = index + self._rows
        at_place = self._flat[rows] * (1.0 - share) + self._flat[rows + 1] * share
        loss, viscosity, weight = at_place[..., 0], at_place[..., 1], at_place[..., 2]
        # A layer beyond the table is thinner than any torque of these runs allows.
        beyond = np.minimum(place - DRY, 0.0)
        log = -0.5 * (loss**2 + (thick - viscosity) ** 2 * weight) + 100.0 * beyond
        return np.asarray(np.add.reduceat(log, self.first, axis=1))


def _likelihoods_of(
    layers: Layers, unit: IntArray, age: FloatArray, temperature_sensitivity: float, rates: Rates
) -> _RunLikelihoods:
    grid = np.linspace(DRY, FLOODED, _GRID)
    table = np.empty((len(age), _GRID, 3))
    low, high = layers.interval(level=0.68)[1:]
    width = np.clip(np.where(np.isfinite(high - low), 0.5 * (high - low), 0.5), 1e-3, None)
    error = np.hypot(layers.viscosity_error, _SCATTER)
    for i, place in enumerate(layers.place):
        root = np.sqrt(np.maximum(layers.deviance[i], 0.0)) * np.sign(place - layers.best[i])
        root = np.maximum.accumulate(root)
        # Beyond the places that were looked at the root goes on as a straight line.
        edge = np.interp(grid, place, root) + np.minimum(grid - place[0], 0.0) / width[i]
        table[i, :, 0] = edge * (width[i] / np.hypot(width[i], _SCATTER))
        table[i, :, 1] = np.interp(grid, place, layers.viscosity[i])
        table[i, :, 2] = np.interp(grid, place, error[i]) ** -2
    reference = layers.reference
    return _RunLikelihoods(table, unit, age, reference, temperature_sensitivity, scale(reference), rates)


def fit_depletion(
    layers: Layers,
    unit: IntArray,
    age: FloatArray,
    *,
    side_flow: float | None = None,
    evaporation: float | None = None,
    seed: int = 0,
) -> Depletion:
    """Fit the law to the layers of runs, all specimens together.

    Priors, all weak, are normal in T (the greatest age) and h (the flooded film at the reference), means over
    specimens as in `_MEAN` and `_MEAN_DEVIATION`; spreads are half-normal, as in `_SPREAD`.

    Parameters
    ----------
    layers
        Those of the runs.
    unit, age
        Of each run: number of its specimen from 0 on, ascending, and age in any one unit.
    side_flow, evaporation
        K in 1/(m^2 age) and e in 1/age, where they are known: the same for all specimens. Fitted if left out.
    seed
        Of the draws.
    """
    greatest, temperature_sensitivity = float(age.max()) or 1.0, float(layers.common[0])
    square = np.exp(2.0 * scale(layers.reference))
    rates = Rates(
        None if side_flow is None else side_flow * greatest * square,
        None if evaporation is None else evaporation * greatest,
    )
    likelihoods = _likelihoods_of(layers, unit, age / greatest, temperature_sensitivity, rates)
    plan = _FEW_SPECIMENS if likelihoods.first.size < _MANY else _MANY_SPECIMENS
    own, mean, spread = _walked(layers, likelihoods, plan, np.random.default_rng(seed))
    common = (temperature_sensitivity, layers.sharpness, layers.fading, layers.starved_at)
    own, mean = _with(own, common), _with(mean, common)
    return Depletion(own, mean, _with(spread, (0.0,) * len(common)), greatest, layers.reference, rates)


def pooled(each: list[Depletion], weight: FloatArray, seed: int) -> Depletion:
    """Return as many draws as one of them has, of each by its weight, in no order."""
    random = np.random.default_rng(seed)
    many = len(each[0].mean)
    ends = np.round(many * np.concatenate([[0.0], np.cumsum(weight)])).astype(np.intp)
    chosen = [random.choice(many, size, replace=False) for size in np.diff(ends).tolist()]
    order = random.permutation(many)
    draws = [
        np.concatenate([getattr(one, name)[some] for one, some in zip(each, chosen, strict=True)])[order]
        for name in ("specimens", "mean", "spread")
    ]
    return replace(each[0], specimens=draws[0], mean=draws[1], spread=draws[2])


def _with(values: FloatArray, last: tuple[float, ...]) -> FloatArray:
    """Return draws with more numbers."""
    return np.concatenate([values, np.broadcast_to(last, (*values.shape[:-1], len(last)))], axis=-1)


class _Plan(NamedTuple):
    """Walkers, steps of which the first are dropped, and draws kept."""

    walkers: int
    steps: int
    dropped: int
    kept: int


#: For few specimens, and for so many that they tell the spread over specimens by their number.
_FEW_SPECIMENS, _MANY_SPECIMENS = _Plan(64, 270, 120, 2000), _Plan(16, 320, 120, 240)


def _walked(
    layers: Layers, likelihoods: _RunLikelihoods, plan: _Plan, random: np.random.Generator
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Draws of specimens, means and spreads.

    Walkers move by differences of others (ter Braak, Stat. Comput. 16 (2006) 239); means and spreads are
    drawn given the specimens.
    """
    free = likelihoods.rates.free
    own, mean, spread = _begin(layers, likelihoods, (plan.walkers, likelihoods.first.size), random)
    density = likelihoods.log_likelihood(own)
    kept: list[tuple[FloatArray, FloatArray, FloatArray]] = []
    thin = max(1, (plan.steps - plan.dropped) * plan.walkers // plan.kept)
    for step in range(plan.steps):
        half_way = plan.walkers // 2
        for moved in (slice(0, half_way), slice(half_way, plan.walkers)):
            if step % _TOGETHER == 0:
                _move_together(likelihoods, own, density, mean, moved, random)
            _move(likelihoods, own, density, (mean, spread), moved, random)
        if step % _CULL == 0 and step < plan.dropped // 2:
            _culled(own, density, mean, spread, free)
            density = likelihoods.log_likelihood(own)
        elif step % _CULL == 0 and step < plan.dropped:
            _unstuck(own, density, mean, spread, free)
        _share(own, mean, spread, free, random)
        if step >= plan.dropped and step % thin == 0:
            kept.append((own.copy(), mean.copy(), spread.copy()))
    draws = [np.concatenate(each) for each in zip(*kept, strict=True)]
    return draws[0], draws[1], draws[2]


def _move(
    likelihoods: _RunLikelihoods,
    own: FloatArray,
    density: FloatArray,
    shared: tuple[FloatArray, FloatArray],
    moved: slice,
    random: np.random.Generator,
) -> None:
    """Let some walkers try to move by differences within the others."""
    others = np.delete(np.arange(len(own)), moved)
    tried, bias = _tried(own, *shared, moved, others, likelihoods.rates.free, random)
    found = likelihoods.log_likelihood(tried)
    gain = found - density[moved] + bias
    taken = np.log(random.random(gain.shape)) < gain
    own[moved] = np.where(taken[..., None], tried, own[moved])
    density[moved] = np.where(taken, found, density[moved])


def _move_together(
    likelihoods: _RunLikelihoods,
    own: FloatArray,
    density: FloatArray,
    mean: FloatArray,
    moved: slice,
    random: np.random.Generator,
) -> None:
    """Let some walkers try one step of all their specimens, and of their means with them.

    What specimens have in common moves by no other.
    """
    free = np.concatenate([likelihoods.rates.free, likelihoods.rates.common])
    here, others = mean[moved], np.delete(np.arange(len(own)), moved)
    one, other = random.integers(others.size, size=(2, len(here)))
    stride = 1.0 if random.random() < 0.1 else 2.38 / np.sqrt(2.0 * free.size)
    step = np.zeros_like(here)
    noise = 1e-4 * random.standard_normal((len(here), free.size))
    # By what specimens have on average, which the runs know better than the means of all there are.
    average = own[others].mean(axis=1)
    step[:, free] = stride * (average[one] - average[other])[:, free] + noise
    found = likelihoods.log_likelihood(own[moved] + step[:, None])
    prior = [-0.5 * (((at - _MEAN) / _MEAN_DEVIATION) ** 2).sum(axis=-1) for at in (here, here + step)]
    gain = (found - density[moved]).sum(axis=1) + prior[1] - prior[0]
    taken = np.log(random.random(gain.shape)) < gain
    step[~taken] = 0.0
    own[moved] += step[:, None]
    mean[moved] += step
    density[moved] = np.where(taken[:, None], found, density[moved])


def _begin(
    layers: Layers, likelihoods: _RunLikelihoods, shape: tuple[int, int], random: np.random.Generator
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Walkers spread about the layer of the youngest run of each specimen."""
    best, _, _ = layers.thickness()
    own = np.empty((*shape, _NUMBERS))
    for k, runs in enumerate(np.split(np.arange(likelihoods.age.size), likelihoods.first[1:])):
        young = runs[np.argmin(likelihoods.age[runs])]
        own[:, k, LAYER_NEW] = min(best[young] - likelihoods.scale, 1.5)
        own[:, k, VISCOSITY_NEW] = np.interp(layers.best[young], layers.place[young], layers.viscosity[young])
    own[..., LOSS], own[..., THICKENING] = 0.0, 0.3
    own[..., :EVAPORATED] += random.standard_normal((*shape, EVAPORATED)) * np.array([0.1, 0.3, 0.05, 0.1])
    common = _MEAN[EVAPORATED:] + np.array([1.0, 0.3]) * random.standard_normal((shape[0], 2))
    own[..., EVAPORATED:] = common[:, None]
    mean = own.mean(axis=1)
    mean[:, EVAPORATED:] = common
    return own, mean, np.tile(_SPREAD, (shape[0], 1))


def _tried(
    own: FloatArray,
    mean: FloatArray,
    spread: FloatArray,
    moved: slice,
    others: IntArray,
    free: IntArray,
    random: np.random.Generator,
) -> tuple[FloatArray, FloatArray]:
    """What walkers try, and what their prior adds to the odds of taking it."""
    here = own[moved]
    tried = here.copy()
    if (
        random.random() < 0.25
    ):  # one number anew from those of all specimens: then the likelihood alone decides
        k = free[random.integers(free.size)]
        drawn = random.standard_normal(here.shape[:2])
        tried[..., k] = mean[moved, None, k] + spread[moved, None, k] * drawn
        return tried, np.zeros(here.shape[:2])
    one, other = random.integers(others.size, size=(2, len(here)))
    some = random.random((*here.shape[:2], free.size)) < 0.7
    stride = 1.0 if random.random() < 0.1 else 2.38 / np.sqrt(2.0 * 0.7 * free.size)
    difference = own[others[one]][..., free] - own[others[other]][..., free]
    noise = 1e-3 * random.standard_normal(difference.shape)
    tried[..., free] += np.where(some, stride * difference + noise, 0.0)
    before, after = (_off_means(each, mean[moved], spread[moved], free) for each in (here, tried))
    return tried, 0.5 * (before - after)


def _culled(
    own: FloatArray, density: FloatArray, mean: FloatArray, spread: FloatArray, free: IntArray
) -> None:
    """Put the worse half of the walkers of each specimen where the better half is, while they search."""
    order = np.argsort(density - 0.5 * _off_means(own, mean, spread, free), axis=0)
    half = len(own) // 2
    # Each half moves by differences within the other, so both get walkers of every quality.
    worse, better = order[:half], order[half : 2 * half]
    unit = np.arange(own.shape[1])
    own[worse, unit] = own[better, unit]
    # What they have in common goes with the walker.
    own[..., EVAPORATED:] = mean[:, None, EVAPORATED:]


def _unstuck(
    own: FloatArray, density: FloatArray, mean: FloatArray, spread: FloatArray, free: IntArray
) -> None:
    """Put walkers that are far less likely than the best quarter where that is, while they search."""
    likely = density.sum(axis=1) - 0.5 * _off_means(own, mean, spread, free).sum(axis=1)
    likely -= own.shape[1] * np.log(spread[:, free]).sum(axis=1)
    order = np.argsort(likely)
    best = order[-(len(own) // 4) :]
    deviation = np.sqrt(0.5 * own.shape[1] * free.size)
    stuck = np.flatnonzero(likely < likely[best[0]] - _STUCK * deviation)
    there = np.resize(best, stuck.size)
    for each in (own, density, mean, spread):
        each[stuck] = each[there]


def _off_means(own: FloatArray, mean: FloatArray, spread: FloatArray, free: IntArray) -> FloatArray:
    """Squares of what specimens differ from the means, over the spreads, (walkers, specimens)."""
    away = (own[..., free] - mean[:, None, free]) / spread[:, None, free]
    return np.asarray((away**2).sum(axis=-1))


def _share(
    own: FloatArray, mean: FloatArray, spread: FloatArray, free: IntArray, random: np.random.Generator
) -> None:
    """Draw means and spreads over specimens, given the specimens."""
    units = own.shape[1]
    precision = units / spread[:, free] ** 2 + _MEAN_DEVIATION[free] ** -2
    pulled = own[..., free].sum(axis=1) / spread[:, free] ** 2 + _MEAN[free] * _MEAN_DEVIATION[free] ** -2
    mean[:, free] = pulled / precision + random.standard_normal(pulled.shape) / np.sqrt(precision)
    square = ((own[..., free] - mean[:, None, free]) ** 2).sum(axis=1)[..., None]
    # On an even grid of ln spread; the last spread of the density is that of the grid.
    grid = np.log(_SPREAD[free])[:, None] + np.linspace(np.log(0.02), np.log(4.0), _SPREADS)
    log = (1.0 - units) * grid - 0.5 * square * np.exp(-2.0 * grid)
    log = log - 0.5 * np.exp(2.0 * grid) / _SPREAD[free, None] ** 2
    heights = np.cumsum(np.exp(log - log.max(axis=-1, keepdims=True)), axis=-1)
    target = random.random(heights.shape[:2]) * heights[..., -1]
    index = np.minimum((heights < target[..., None]).sum(axis=-1), _SPREADS - 1)
    jitter = (random.random(index.shape) - 0.5) * (grid[0, 1] - grid[0, 0])
    spread[:, free] = np.exp(
        np.take_along_axis(np.broadcast_to(grid, heights.shape), index[..., None], -1)[..., 0] + jitter
    )
