"""How the layer of oil of specimens thins with age, and how their oil thickens, fitted together.

The layer thins by side flow and evaporation (`oil_layer`), viscosity grows as ``exp(g t)``. Each specimen has
its own layer when new, rate of loss then (``K h0^2/2 + e``), share of evaporation in it, viscosity when new,
and g. Their logarithms (logit of the share; g itself) are normal over the specimens, with unknown means and
spreads. What a run shows of layer and viscosity enters as its likelihood, so a lower bound enters as just
that.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import special

from hersey.arrays import FloatArray, IntArray
from hersey.life.film.layer import Layers
from hersey.life.film.run_search import DRY, FLOODED
from hersey.life.film.starved_drag import Flooded, cubic
from hersey.life.oil_layer import log_layer

#: What a specimen has, in this order: ln(h0/h), ln of the rate of loss when new times T, logit of the share
#: of evaporation in it, ln of the factor on viscosity when new, g T; T is the greatest age, h the flooded
#: film at the reference.
LAYER_NEW, LOSS, EVAPORATED, VISCOSITY_NEW, THICKENING, SENSITIVITY = range(6)
_NUMBERS = 5
#: Means over specimens, beforehand: mean and standard deviation; spreads over specimens: scale of a
#: half-normal.
_MEAN = np.array([0.0, -0.5, 0.0, 0.0, 0.2])
_MEAN_DEVIATION = np.array([2.0, 1.5, 1.5, 1.0, 0.7])
_SPREAD = np.array([0.5, 0.7, 0.7, 0.2, 0.5])
#: Scatter of layer and viscosity of runs about the law, beyond their own errors (ln).
_SCATTER = 0.02
#: From so many specimens on they are many.
_MANY = 60
#: Steps from one cull of walkers to the next, while they still search.
_CULL = 8
#: Steps of the grid on which likelihoods and spreads are held.
_GRID, _SPREADS = 281, 40


@dataclass(frozen=True)
class Depletion:
    """Draws of what specimens have, (draws, specimens, 6), and of all: means and spreads, (draws, 6).

    The last is the change of ln viscosity from hot to cold, which all have in common.
    """

    specimens: FloatArray
    mean: FloatArray
    spread: FloatArray
    greatest_age: float
    reference: Flooded
    rates: Rates

    def layer(self, own: FloatArray, age: FloatArray) -> FloatArray:
        """Return ln of the layer (m) of draws (..., 6) at ages in any unit; shape (..., ages)."""
        scaled, each = np.asarray(age) / self.greatest_age, own[..., None, :]
        return _scale(self.reference) + log_layer(_new(each), *self.rates.of(each), scaled)

    def rate(self, own: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return K (1/(m^2 age)), e and g (1/age) of draws (..., 6)."""
        side_flow, evaporation = self.rates.of(own)
        square = np.exp(2.0 * _scale(self.reference))
        each = (side_flow / square, evaporation, own[..., THICKENING])
        return tuple(rate / self.greatest_age for rate in each)  # type: ignore[return-value]

    def viscosity(self, own: FloatArray, age: FloatArray) -> FloatArray:
        """Return ln of the factor on viscosity of draws (..., 6) at ages; shape (..., ages)."""
        scaled = np.asarray(age) / self.greatest_age
        return own[..., VISCOSITY_NEW, None] + own[..., THICKENING, None] * scaled

    def over_flooded(self, own: FloatArray, age: FloatArray, point: Flooded) -> FloatArray:
        """Return ln of the layer over the flooded film at a point, of draws (..., 6) at ages."""
        at = self.viscosity(own, age) + own[..., SENSITIVITY, None] * point.steep.item()
        return self.layer(own, age) - cubic(point.film.reshape(4), at)[0]


@dataclass(frozen=True)
class Rates:
    """The rates of side flow and evaporation in h and T, where known; None where specimens have their own.

    Where one is known, the loss of a specimen is that by the other.
    """

    side_flow: float | None = None
    evaporation: float | None = None

    def of(self, own: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return K T h^2 and e T of what specimens have, (..., 5)."""
        loss = np.exp(np.minimum(own[..., LOSS], 50.0))
        flows = 2.0 * np.exp(-2.0 * own[..., LAYER_NEW]) * loss
        if self.side_flow is not None:
            own_evaporation = loss if self.evaporation is None else np.full_like(loss, self.evaporation)
            return np.full_like(loss, self.side_flow), own_evaporation
        if self.evaporation is not None:
            return flows, np.full_like(loss, self.evaporation)
        evaporated = special.expit(own[..., EVAPORATED])
        return flows * (1.0 - evaporated), loss * evaporated

    @property
    def free(self) -> IntArray:
        """What specimens have of their own."""
        unknown = (self.side_flow is None) + (self.evaporation is None)
        fixed = {2: (), 1: (EVAPORATED,), 0: (LOSS, EVAPORATED)}[unknown]
        return np.array([k for k in range(_NUMBERS) if k not in fixed])


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
        side_flow, evaporation = (rate[:, self.unit] for rate in self.rates.of(own))
        new = _new(own)[:, self.unit]
        layer = log_layer(new, side_flow, evaporation, self.age)
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
    return _RunLikelihoods(table, unit, age, reference, temperature_sensitivity, _scale(reference), rates)


def _new(own: FloatArray) -> FloatArray:
    """The new layer to the power -2, over h."""
    return np.asarray(np.exp(-2.0 * own[..., LAYER_NEW]))


def _scale(reference: Flooded) -> float:
    """Logarithm of the flooded film of new oil at the reference, m."""
    return float(cubic(reference.film, np.zeros(()))[0].item())


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
    square = np.exp(2.0 * _scale(layers.reference))
    rates = Rates(
        None if side_flow is None else side_flow * greatest * square,
        None if evaporation is None else evaporation * greatest,
    )
    likelihoods = _likelihoods_of(layers, unit, age / greatest, temperature_sensitivity, rates)
    plan = _FEW_SPECIMENS if likelihoods.first.size < _MANY else _MANY_SPECIMENS
    own, mean, spread = _walked(layers, likelihoods, plan, np.random.default_rng(seed))
    own, mean = _with(own, temperature_sensitivity), _with(mean, temperature_sensitivity)
    return Depletion(own, mean, _with(spread, 0.0), greatest, layers.reference, rates)


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


def _with(values: FloatArray, last: float) -> FloatArray:
    """Return draws with one more number."""
    return np.concatenate([values, np.full((*values.shape[:-1], 1), last)], axis=-1)


class _Plan(NamedTuple):
    """Walkers, steps of which the first are dropped, and draws kept."""

    walkers: int
    steps: int
    dropped: int
    kept: int


#: For few specimens, and for so many that they tell the spread over specimens by their number.
_FEW_SPECIMENS, _MANY_SPECIMENS = _Plan(64, 340, 140, 2000), _Plan(16, 320, 120, 240)


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
            _move(likelihoods, own, density, (mean, spread), moved, random)
        if step < plan.dropped // 2 and step % _CULL == 0:
            _culled(own, density, mean, spread, free)
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
    own[..., LOSS], own[..., EVAPORATED], own[..., THICKENING] = 0.0, 0.0, 0.3
    own += random.standard_normal(own.shape) * np.array([0.1, 0.3, 1.0, 0.05, 0.1])
    mean = own.mean(axis=1)
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
    before = ((here - mean[moved, None]) / spread[moved, None]) ** 2
    after = ((tried - mean[moved, None]) / spread[moved, None]) ** 2
    return tried, 0.5 * (before - after)[..., free].sum(axis=-1)


def _culled(
    own: FloatArray, density: FloatArray, mean: FloatArray, spread: FloatArray, free: IntArray
) -> None:
    """Put the worse half of the walkers of each specimen where the better half is, while they search."""
    prior = -0.5 * (((own - mean[:, None]) / spread[:, None])[..., free] ** 2).sum(axis=-1)
    order = np.argsort(density + prior, axis=0)
    half = len(own) // 2
    # Each half moves by differences within the other, so both get walkers of every quality.
    worse, better = order[:half], order[half : 2 * half]
    unit = np.arange(own.shape[1])
    own[worse, unit], density[worse, unit] = own[better, unit], density[better, unit]


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
