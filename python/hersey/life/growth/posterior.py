"""How far units, their spread and the law of growth are known: draws of the posterior and the evidence.

Of unit u at age t: ln y = ln y0_u + ln G(t; x_u) + e, e ~ N(0, s^2 + sigma^2), ln y0_u ~ N(m0, t0^2), and
x_u ~ N(m1, t1^2), s being the stated error. ln y0_u integrates out in closed form, x_u on a grid round its
mode. What all units share, (m0, t0, sigma, m1, t1, shapes), is drawn from t distributions fitted to its
posterior and weighed (Cornuet et al., Scand. J. Stat. 39 (2012) 798); the mean weight is the evidence of
the law.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy import special

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.growth.laws import Law

#: Priors: mean and standard deviation of m1 = E ln(r T); scales of the half-normal spreads. m0 is flat.
RATE_PRIOR = (-0.5, 2.0)
LEVEL_SPREAD, RATE_SPREAD, RUN_SCATTER = 1.0, 1.0, 0.1
#: Nodes of the grid over the size of a unit: to each side and apart, in its standard deviations.
_NODES = np.arange(-6.0, 7.0)
_FINE = np.linspace(-5.0, 5.0, 26)
#: Steps to the mode of a unit at the most, and how near it they end: the grid need not stand right on it.
_POLISH, _NEAR = 7, 0.2
#: Draws of each round of the importance sampling for 80 runs; more for fewer runs and fewer for more, within
#: these factors; the last round again, so often at the most, while they are worth too few.
_ROUNDS, _USUAL, _LEAST_SHARE, _MOST, _WORTH, _AGAIN = (250, 250, 300, 600), 80, 0.25, 3.0, 100.0, 3
#: Units whose mode is sought before that of all; how much worse a law may fit to be drawn from at all.
_FIRST, _HOPELESS = 40, 25.0
#: Its t distributions: degrees of freedom, number in later rounds; widths of the first and of later ones in
#: standard deviations.
_FREEDOM, _KERNELS, _WIDE, _BANDWIDTH = 4.0, 100, 1.5, 0.6
#: Steps to the mode at the most, and the longest.
_STEPS, _STRIDE = 25, 2.0
#: How well m0 and m1 are known at best, about.
_KNOWN = (0.02, 0.1)
#: Numbers held at a time.
_AT_ONCE = 20_000
_LEAST = 1e-300
#: Units drawn of the population for each draw of what they share.
_POPULATION = 256
#: Log density that stands for none where slopes are taken.
_NOTHING = -1e6


@dataclass(frozen=True)
class Points:
    """Logarithms of the indicator, one row per unit, filled up to the longest; ages in the greatest age."""

    age: FloatArray
    value: FloatArray
    variance: FloatArray  #: of the stated errors
    given: BoolArray
    place: IntArray = field(
        default_factory=lambda: np.zeros((2, 0), dtype=np.intp)
    )  #: row and column of each run

    def part(self, units: int) -> Points:
        """The first units alone."""
        return Points(
            self.age[:units], self.value[:units], self.variance[:units], self.given[:units], self.place
        )


@dataclass(frozen=True)
class Posterior:
    """Weighed draws of what all units share, under one law."""

    law: Law
    shared: FloatArray  #: columns m0, ln t0, ln sigma, m1, ln t1, shapes (as far as the law has them)
    weight: FloatArray  #: sums to 1
    log_evidence: float
    sizes: FloatArray  #: of each unit at the mode: where searches for it begin

    @property
    def effective(self) -> float:
        """How many independent draws they are worth."""
        return float(1.0 / np.sum(self.weight**2))


@dataclass(frozen=True)
class Units:
    """Draws of units under one law, arrays of shape (draws, units)."""

    law: Law
    level: FloatArray  #: ln y0
    size: FloatArray
    shape: FloatArray  #: (shapes, draws, 1)
    scatter: FloatArray  #: of runs, (draws, 1)


def _shape(law: Law, shared: FloatArray) -> FloatArray:
    """Shapes of the law, (shapes, draws)."""
    return shared[:, 5 : 5 + len(law.shapes)].T


def _weights(points: Points, shared: FloatArray) -> FloatArray:
    """Precision of each value, (draws, units, ages)."""
    return points.given / (points.variance + np.exp(2.0 * shared[:, 2])[:, None, None])


def _fit_of(
    law: Law, points: Points, shared: FloatArray, weight: FloatArray, size: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Weighed squares of what is left, less those that the level takes up, and the two sums of it.

    ``size`` is (draws, units, nodes).
    """
    shape = _shape(law, shared)[:, :, None, None, None]
    growth = law.log_growth(size[..., None], points.age[None, :, None, :], shape)
    left = points.value[None, :, None, :] - growth - shared[:, 0][:, None, None, None]
    first = (left @ weight[..., None])[..., 0]
    total = weight.sum(axis=2)[..., None] + np.exp(-2.0 * shared[:, 1])[:, None, None]
    return (left**2 @ weight[..., None])[..., 0] - first**2 / total, first, total


def _constants(points: Points, shared: FloatArray, weight: FloatArray) -> FloatArray:
    """The part of the likelihood of each unit that does not hang on its size."""
    logs = np.where(points.given, np.log(np.where(points.given, weight, 1.0)), 0.0).sum(axis=2)
    spread = np.exp(2.0 * shared[:, 1])[:, None]
    number = points.given.sum(axis=1)
    logs -= np.log1p(spread * weight.sum(axis=2)) + number * math.log(2.0 * math.pi)
    return np.asarray(0.5 * logs)


def _modes(
    law: Law, points: Points, shared: FloatArray, weight: FloatArray, start: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Most probable size of each unit, and its width (Gauss-Newton), (draws, units)."""
    mean, precision = shared[:, 3][:, None], np.exp(-2.0 * shared[:, 4])[:, None]
    shape = _shape(law, shared)[:, :, None, None]
    total = weight.sum(axis=2) + np.exp(-2.0 * shared[:, 1])[:, None]
    size = np.broadcast_to(start, weight.shape[:2]).copy()
    for turn in range(_POLISH + 1):
        growth = law.log_growth(size[..., None], points.age, shape)
        slope = law.slope(size[..., None], points.age, shape)
        left = points.value - growth - shared[:, 0][:, None, None]
        weighed = weight * slope
        across = weighed.sum(axis=2)
        curvature = (weighed * slope).sum(axis=2) - across**2 / total + precision
        if turn < _POLISH:
            pull = (weighed * left).sum(axis=2) - across * (weight * left).sum(axis=2) / total
            step = np.clip((pull - precision * (size - mean)) / curvature, -1.0, 1.0)
            size += step
            if (step**2 * curvature).max() < _NEAR**2:
                break
    return size, 1.0 / np.sqrt(curvature)


def _over_nodes(
    law: Law, points: Points, shared: FloatArray, start: FloatArray, nodes: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Log density of each unit's values and size at nodes round its mode, the nodes, and its width."""
    weight = _weights(points, shared)
    mode, width = _modes(law, points, shared, weight, start)
    size = mode[..., None] + width[..., None] * nodes
    square, _, _ = _fit_of(law, points, shared, weight, size)
    spread = shared[:, 4][:, None, None]
    away = (size - shared[:, 3][:, None, None]) * np.exp(-spread)
    density = -0.5 * (square + away**2 + math.log(2.0 * math.pi)) - spread
    return density + _constants(points, shared, weight)[..., None], size, width


def _likelihood(law: Law, points: Points, shared: FloatArray, start: FloatArray) -> FloatArray:
    """Log likelihood of what all units share, units integrated out."""
    if not law.grows:
        weight = _weights(points, shared)
        square, _, _ = _fit_of(law, points, shared, weight, np.zeros((*weight.shape[:2], 1)))
        return np.asarray((_constants(points, shared, weight) - 0.5 * square[..., 0]).sum(axis=1))
    many = max(1, _AT_ONCE // (points.value.size * _NODES.size))
    parts = []
    for i in range(0, len(shared), many):
        density, _, width = _over_nodes(law, points, shared[i : i + many], start, _NODES)
        parts.append((special.logsumexp(density, axis=2) + np.log(width)).sum(axis=1))
    return np.concatenate(parts)


def _half_normal(logs: FloatArray, scale: float) -> FloatArray:
    """Log density of the logarithm of a half-normal number."""
    return 0.5 * math.log(2.0 / math.pi) - math.log(scale) + logs - 0.5 * np.exp(2.0 * logs) / scale**2


def _normal(values: FloatArray, mean: float, deviation: float) -> FloatArray:
    return -0.5 * ((values - mean) / deviation) ** 2 - math.log(deviation * math.sqrt(2.0 * math.pi))


def _told(
    law: Law, coordinates: FloatArray, middle: FloatArray | None, units: int
) -> tuple[FloatArray, FloatArray]:
    """What all units share, and the log of the Jacobian, from coordinates in which it is no funnel.

    The means m0 and m1 are known the worse, the more units differ: they are counted from a middle in what
    so many units tell of them. Without a middle they are what all units share.
    """
    if middle is None:
        return coordinates, np.zeros(len(coordinates))
    shared = coordinates.copy()
    scales = np.sqrt(np.exp(2.0 * coordinates[:, 1]) / units + _KNOWN[0] ** 2)
    shared[:, 0] = middle[0] + scales * coordinates[:, 0]
    jacobian = np.log(scales)
    if law.grows:
        precision = 1.0 / (np.exp(2.0 * coordinates[:, 4]) / units + _KNOWN[1] ** 2) + RATE_PRIOR[1] ** -2
        shared[:, 3] = middle[1] + coordinates[:, 3] / np.sqrt(precision)
        jacobian -= 0.5 * np.log(precision)
    return shared, jacobian


def _log_posterior(
    law: Law, points: Points, coordinates: FloatArray, middle: FloatArray | None, start: FloatArray
) -> FloatArray:
    """Likelihood times priors over coordinates; far outside any sense it is nothing."""
    total = np.full(len(coordinates), -np.inf)
    near: BoolArray = np.asarray((np.abs(coordinates) < 40.0).all(axis=1))
    shared, jacobian = _told(law, np.where(near[:, None], coordinates, 0.0), middle, len(points.value))
    sane = near & np.asarray((np.abs(shared[:, 1:3]) < 20.0).all(axis=1))
    if law.grows:
        sane &= np.asarray((np.abs(shared[:, 3:5]) < 20.0).all(axis=1))
    for i, (_, mean, deviation) in enumerate(law.shapes, 5):
        sane &= np.abs(shared[:, i] - mean) < 6.0 * deviation
    held = shared[sane]
    if not len(held):
        return total
    density = _half_normal(held[:, 1], LEVEL_SPREAD) + _half_normal(held[:, 2], RUN_SCATTER)
    if law.grows:
        density += _normal(held[:, 3], *RATE_PRIOR) + _half_normal(held[:, 4], RATE_SPREAD)
    for i, (_, mean, deviation) in enumerate(law.shapes, 5):
        density += _normal(held[:, i], mean, deviation)
    total[sane] = density + jacobian[sane] + _likelihood(law, points, held, start)
    return np.where(np.isfinite(total), total, -np.inf)


def _first_guess(law: Law, points: Points) -> tuple[FloatArray, FloatArray]:
    """What all share, and sizes of the units, from lines through each unit."""
    number = points.given.sum(axis=1)
    mean_age = (points.age * points.given).sum(axis=1) / number
    mean = (points.value * points.given).sum(axis=1) / number
    away = (points.age - mean_age[:, None]) * points.given
    square = (away**2).sum(axis=1)
    slope = (away * points.value).sum(axis=1) / np.where(square > 0, square, 1.0)
    pooled = (away * points.value).sum() / max(square.sum(), _LEAST)
    slope = np.where(square > 0, slope, pooled) if law.grows else np.zeros(len(number))
    left = (points.value - mean[:, None] - slope[:, None] * away) * points.given
    scatter = max(math.sqrt((left**2).sum() / max(number.sum() - 2 * len(number), 1)), 1e-3)
    level = mean - slope * mean_age
    spread = max(float(np.std(level)), 0.05)
    size = np.log(np.maximum(slope, 0.02))
    guess = [level.mean(), math.log(spread), math.log(min(scatter, 0.3))]
    if law.grows:
        guess += [size.mean(), math.log(max(float(np.std(size)), 0.1))]
    return np.array([*guess, *(mean for _, mean, _ in law.shapes)]), size


def _derivatives(
    law: Law, points: Points, at: FloatArray, middle: FloatArray | None, start: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Gradient of the log posterior and the covariance that its curvature tells, by central differences."""
    number, step = at.size, 0.03
    unit = np.eye(number) * step
    pairs = [(i, j) for i in range(number) for j in range(i)]
    spots = [at, *(at + unit), *(at - unit)]
    spots += [at + unit[i] + unit[j] for i, j in pairs] + [at - unit[i] - unit[j] for i, j in pairs]
    found = np.maximum(_log_posterior(law, points, np.array(spots), middle, start), _NOTHING)
    here, up, down = found[0], found[1 : number + 1], found[number + 1 : 2 * number + 1]
    if not np.isfinite(found).all():
        found = np.where(np.isfinite(found), found, -1e6)
    second = np.diag((up - 2 * here + down) / step**2)
    both, neither = np.split(found[2 * number + 1 :], 2)
    for k, (i, j) in enumerate(pairs):
        mixed = both[k] + neither[k] + 2 * here - up[i] - up[j] - down[i] - down[j]
        second[i, j] = second[j, i] = mixed / (2 * step**2)
    values, vectors = np.linalg.eigh(-second)
    return (up - down) / (2 * step), (vectors / np.maximum(np.abs(values), 0.3)) @ vectors.T


def _climbed(law: Law, points: Points, at: FloatArray, sizes: FloatArray) -> tuple[FloatArray, FloatArray]:
    fractions = np.array([1.0, 0.5, 0.2, 0.05, 0.01, 0.0])
    for _ in range(_STEPS):
        if law.grows:
            one = at[None]
            sizes = _modes(law, points, one, _weights(points, one), sizes)[0][0]
        gradient, covariance = _derivatives(law, points, at, None, sizes)
        step = covariance @ gradient
        step *= min(1.0, _STRIDE / max(np.abs(step).max(), _LEAST))
        tried = at + fractions[:, None] * step
        best = int(np.argmax(_log_posterior(law, points, tried, None, sizes)))
        at = tried[best]
        if np.abs(fractions[best] * step).max() < 0.05:
            break
    return at, sizes


@dataclass(frozen=True)
class Peak:
    """The mode of what all units share under a law."""

    law: Law
    at: FloatArray
    mode: FloatArray  #: the same in coordinates round the middle
    covariance: FloatArray
    middle: FloatArray
    sizes: FloatArray
    log_evidence: float  #: by a normal law round the mode


def peaks(laws: list[Law], points: Points) -> list[Peak]:
    """Return the modes of the laws that need be drawn from: the others fit hopelessly worse.

    Those of the first units come before those of all: they tell where to begin, and what need not be tried.
    """
    few = points.part(_FIRST)
    guesses = [_first_guess(law, few) for law in laws]
    found = _hopeful([_peak_of(law, few, *guess) for law, guess in zip(laws, guesses, strict=True)])
    if len(few.value) == len(points.value):
        return found
    sizes = {each.law.name: _first_guess(each.law, points)[1] for each in found}
    return _hopeful([_peak_of(each.law, points, each.at, sizes[each.law.name]) for each in found])


def _hopeful(found: list[Peak]) -> list[Peak]:
    best = max(each.log_evidence for each in found)
    return [each for each in found if each.log_evidence > best - _HOPELESS]


def _peak_of(law: Law, points: Points, guess: FloatArray, sizes: FloatArray) -> Peak:
    at, sizes = _climbed(law, points, guess, sizes)
    middle = at[[0, 3]] if law.grows else at[:1]
    mode = at.copy()
    mode[[0, 3] if law.grows else [0]] = 0.0
    _, covariance = _derivatives(law, points, mode, middle, sizes)
    height = float(_log_posterior(law, points, mode[None], middle, sizes)[0])
    width = 0.5 * (np.linalg.slogdet(covariance)[1] + mode.size * math.log(2.0 * math.pi))
    return Peak(law, at, mode, covariance, middle, sizes, height + float(width))


def posterior(peak: Peak, points: Points, random: np.random.Generator) -> Posterior:
    """Return weighed draws of what all units share under a law."""
    law, middle, sizes = peak.law, peak.middle, peak.sizes
    more = float(np.clip(_USUAL / points.value.size, _LEAST_SHARE, _MOST))
    spots, density = np.empty((0, peak.mode.size)), np.empty(0)
    proposed: list[tuple[int, _Kernels]] = []
    kernels = _Kernels(peak.mode[None], _WIDE**2 * peak.covariance)
    for turn in range(len(_ROUNDS) + _AGAIN):
        count = round(more * _ROUNDS[min(turn, len(_ROUNDS) - 1)])
        draws = kernels.drawn(count, random)
        spots = np.concatenate([spots, draws])
        density = np.concatenate([density, _log_posterior(law, points, draws, middle, sizes)])
        proposed.append((count, kernels))
        of_all = [math.log(number) + each.log_density(spots) for number, each in proposed]
        logs = density - special.logsumexp(of_all, axis=0)
        weight = np.exp(logs - special.logsumexp(logs))
        if turn + 1 >= len(_ROUNDS) and 1.0 / np.sum(weight**2) > _WORTH:
            break
        kernels = _round_draws(spots, weight, random)
    kept = weight > 0.0
    shared, _ = _told(law, spots[kept], middle, len(points.value))
    return Posterior(law, shared, weight[kept], float(special.logsumexp(logs)), sizes)


def _round_draws(shared: FloatArray, weight: FloatArray, random: np.random.Generator) -> _Kernels:
    """Kernels round heavy draws (West, J. R. Stat. Soc. B 55 (1993) 409): they follow a bent posterior."""
    # A few heavy draws must not decide where the next round looks.
    held = np.minimum(weight, 20.0 / weight.size)
    held /= held.sum()
    away = shared - held @ shared
    covariance = away.T @ (away * held[:, None]) + 1e-6 * np.eye(shared.shape[1])
    steps = (np.arange(_KERNELS) + random.random()) / _KERNELS
    index = np.minimum(np.searchsorted(np.cumsum(held), steps), weight.size - 1)
    return _Kernels(shared[index], _BANDWIDTH**2 * covariance)


@dataclass(frozen=True)
class _Kernels:
    """Equal shares of t distributions round centres."""

    centres: FloatArray
    covariance: FloatArray

    def drawn(self, count: int, random: np.random.Generator) -> FloatArray:
        """Return draws, in turn from each centre."""
        number = self.centres.shape[1]
        normals = random.standard_normal((count, number)) @ np.linalg.cholesky(self.covariance).T
        tails = np.sqrt(random.chisquare(_FREEDOM, count) / _FREEDOM)
        return self.centres[np.arange(count) % len(self.centres)] + normals / tails[:, None]

    def log_density(self, at: FloatArray) -> FloatArray:
        """Return its logarithm."""
        number = at.shape[1]
        factor = np.linalg.cholesky(self.covariance)
        spots, centres = (np.linalg.solve(factor, each.T).T for each in (at, self.centres))
        square = (spots**2).sum(axis=1)[:, None] + (centres**2).sum(axis=1) - 2.0 * spots @ centres.T
        tails = -0.5 * (_FREEDOM + number) * np.log1p(np.maximum(square, 0.0) / _FREEDOM)
        constant = special.gammaln(0.5 * (_FREEDOM + number)) - special.gammaln(0.5 * _FREEDOM)
        constant -= 0.5 * number * math.log(_FREEDOM * math.pi) + np.log(np.diag(factor)).sum()
        return np.asarray(special.logsumexp(tails, axis=1) - math.log(len(self.centres)) + constant)


def drawn_units(found: Posterior, points: Points, shared: FloatArray, random: np.random.Generator) -> Units:
    """Return one draw of all units, given their own values, for each draw of what they share."""
    law = found.law
    many = max(1, _AT_ONCE // (points.value.size * _FINE.size))
    levels, sizes = [], []
    for i in range(0, len(shared), many):
        part = shared[i : i + many]
        weight = _weights(points, part)
        size = np.zeros((len(part), len(points.value)))
        if law.grows:
            density, nodes, _ = _over_nodes(law, points, part, found.sizes, _FINE)
            size = _drawn(density, nodes, random.random(size.shape))
        _, first, total = _fit_of(law, points, part, weight, size[..., None])
        normals = random.standard_normal(size.shape)
        levels.append(part[:, :1] + first[..., 0] / total[..., 0] + normals / np.sqrt(total[..., 0]))
        sizes.append(size)
    return _units(law, np.concatenate(levels), np.concatenate(sizes), shared)


def _units(law: Law, level: FloatArray, size: FloatArray, shared: FloatArray) -> Units:
    return Units(law, level, size, _shape(law, shared)[:, :, None], np.exp(shared[:, 2:3]))


def _drawn(density: FloatArray, nodes: FloatArray, uniform: FloatArray) -> FloatArray:
    """Return one size per unit from its density at nodes: the inverse of its straight-lined distribution."""
    heights = np.exp(density - density.max(axis=2, keepdims=True))
    steps = np.cumsum(0.5 * (heights[..., 1:] + heights[..., :-1]), axis=2)
    target = uniform * steps[..., -1]
    index = np.minimum((steps < target[..., None]).sum(axis=2), steps.shape[2] - 1)[..., None]
    after = np.take_along_axis(steps, index, axis=2)[..., 0]
    before = np.where(
        index[..., 0] > 0, np.take_along_axis(steps, np.maximum(index - 1, 0), axis=2)[..., 0], 0.0
    )
    share = (target - before) / np.maximum(after - before, _LEAST)
    left = np.take_along_axis(nodes, index, axis=2)[..., 0]
    return np.asarray(left + share * (nodes[..., 1] - nodes[..., 0]))


def _spread_normals() -> FloatArray:
    """Pairs of standard normal numbers that fill the plane evenly (Roberts' sequence)."""
    steps = np.arange(1, _POPULATION + 1) * np.array([[0.7548776662466927], [0.5698402909980532]])
    return np.asarray(special.ndtri((0.5 + steps) % 1.0))


def new_units(law: Law, shared: FloatArray) -> Units:
    """Return units of the population for each draw of what they share."""
    normals = _spread_normals()
    level = shared[:, :1] + np.exp(shared[:, 1:2]) * normals[0]
    size = shared[:, 3:4] + np.exp(shared[:, 4:5]) * normals[1] if law.grows else np.zeros_like(level)
    return _units(law, level, size, shared)
