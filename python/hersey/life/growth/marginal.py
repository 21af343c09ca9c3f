"""The likelihood of what all specimens share, specimens integrated out; and draws of specimens given that.

Of specimen u at age t: ln y = ln y0_u + ln G(t; x_u) + e, e ~ N(0, s^2 + sigma^2), ln y0_u ~ N(m0, t0^2), and
x_u ~ N(m1, t1^2), s being the stated error. ln y0_u integrates out in closed form, x_u on a grid round its
mode. What all share has the columns m0, ln t0, ln sigma, m1, ln t1 and shapes, as far as the law has them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import special

from hersey.arrays import FloatArray
from hersey.life.growth.laws import Law
from hersey.life.growth.points import Points

#: Nodes of the grid over the size of a specimen: to each side and apart, in its standard deviations.
_NODES = np.arange(-6.0, 7.0)
#: Nodes from which a size is drawn.
_FINE = np.linspace(-5.0, 5.0, 26)
#: Steps to the mode of a specimen at the most, and how near it they end: the grid need not be right on it.
_POLISH, _NEAR = 7, 0.2
#: Numbers held at a time.
_AT_ONCE = 20_000
#: Least probability that is divided by.
_LEAST = 1e-300
#: Specimens drawn of the population for each draw of what they share.
_POPULATION = 256


@dataclass(frozen=True)
class Specimens:
    """Draws of specimens under one law, arrays of shape (draws, specimens)."""

    law: Law
    level: FloatArray  #: ln y0
    size: FloatArray
    shape: FloatArray  #: (shapes, draws, 1)
    scatter: FloatArray  #: of runs, (draws, 1)


def _shape(law: Law, shared: FloatArray) -> FloatArray:
    """Shapes of the law, (shapes, draws)."""
    return shared[:, 5 : 5 + len(law.shapes)].T


def weights_of(points: Points, shared: FloatArray) -> FloatArray:
    """Return the precision of each value, (ages, draws, specimens)."""
    runs = points.by_run
    return runs.given[:, None] / (runs.variance[:, None] + np.exp(2.0 * shared[:, 2:3]))


def _fit_of(
    law: Law, points: Points, shared: FloatArray, weight: FloatArray, size: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Weighed squares of what is left, less those that the level takes up, and the two sums of it.

    ``size`` is (draws, specimens, nodes).
    """
    runs, shape = points.by_run, _shape(law, shared)[:, None, :, None, None]
    left = (runs.value[:, None] - shared[:, :1])[..., None]
    left = left - law.log_growth(size, runs.age[:, None, :, None], shape)
    weighed = left * weight[..., None]
    first = weighed.sum(axis=0)
    total = weight.sum(axis=0)[..., None] + np.exp(-2.0 * shared[:, 1])[:, None, None]
    weighed *= left
    return weighed.sum(axis=0) - first**2 / total, first, total


def _constants(points: Points, shared: FloatArray, weight: FloatArray) -> FloatArray:
    """The part of the likelihood of each specimen that does not depend on its size."""
    logs = np.log(np.where(points.by_run.given[:, None], weight, 1.0)).sum(axis=0)
    spread = np.exp(2.0 * shared[:, 1])[:, None]
    number = points.given.sum(axis=1)
    logs -= np.log1p(spread * weight.sum(axis=0)) + number * math.log(2.0 * math.pi)
    return np.asarray(0.5 * logs)


def modes(
    law: Law, points: Points, shared: FloatArray, weight: FloatArray, start: FloatArray, together: int = 1
) -> tuple[FloatArray, FloatArray]:
    """Return the most probable size of each specimen, and its width (Gauss-Newton), (draws, specimens).

    So many draws ``together``, one after the other, end at the same step.
    """
    size = np.broadcast_to(start, weight.shape[1:]).copy()
    curvature = np.empty_like(size)
    open_ = np.arange(len(size))
    for _ in range(_POLISH):
        step, here = _step(law, points, shared, weight, size[open_])
        size[open_] += step
        curvature[open_] = here
        far = (step**2 * here).max(axis=1)
        goes_on = ~(np.maximum.reduceat(far, np.arange(0, far.size, together)) < _NEAR**2)
        if not goes_on.any():
            break
        if not goes_on.all():
            kept = np.repeat(goes_on, together)[: far.size]
            open_, shared, weight = open_[kept], shared[kept], weight[:, kept]
    else:
        curvature[open_] = _step(law, points, shared, weight, size[open_])[1]
    return size, 1.0 / np.sqrt(curvature)


def _step(
    law: Law, points: Points, shared: FloatArray, weight: FloatArray, size: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return a step of Gauss and Newton from sizes of specimens, 1 at most, and the curvature there."""
    mean, precision = shared[:, 3:4], np.exp(-2.0 * shared[:, 4:5])
    total = weight.sum(axis=0) + np.exp(-2.0 * shared[:, 1:2])
    runs = points.by_run
    growth, slope = law.sloped(size, runs.age[:, None], _shape(law, shared)[:, None, :, None])
    left = runs.value[:, None] - shared[:, :1] - growth
    weighed = weight * slope
    across = weighed.sum(axis=0)
    curvature = (weighed * slope).sum(axis=0) - across**2 / total + precision
    gradient = (weighed * left).sum(axis=0) - across * (weight * left).sum(axis=0) / total
    return np.clip((gradient - precision * (size - mean)) / curvature, -1.0, 1.0), curvature


def _over_nodes(
    law: Law, points: Points, shared: FloatArray, start: FloatArray, nodes: FloatArray
) -> Iterator[tuple[FloatArray, FloatArray, FloatArray, FloatArray]]:
    """Yield log density of each specimen's values and size at nodes round its mode, the nodes, and its width.

    And the weight of the values. So many draws at a time as `_many` says, times the nodes: only the values
    of all runs at all nodes take much room.
    """
    many = _many(points, nodes)
    for i in range(0, len(shared), many * nodes.size):
        block = shared[i : i + many * nodes.size]
        weight = weights_of(points, block)
        mode, width = modes(law, points, block, weight, start, many)
        size = mode[..., None] + width[..., None] * nodes
        parts = [slice(j, j + many) for j in range(0, len(block), many)]
        square = [_fit_of(law, points, block[own], weight[:, own], size[own])[0] for own in parts]
        spread = block[:, 4][:, None, None]
        away = (size - block[:, 3][:, None, None]) * np.exp(-spread)
        density = -0.5 * (np.concatenate(square) + away**2 + math.log(2.0 * math.pi)) - spread
        yield density + _constants(points, block, weight)[..., None], size, width, weight


def _many(points: Points, nodes: FloatArray) -> int:
    """How many draws are held at a time."""
    return max(1, _AT_ONCE // (points.value.size * nodes.size))


def _log_sum(density: FloatArray) -> FloatArray:
    """Log of the sum over nodes: that of scipy takes ten times as long for so few numbers."""
    most = density.max(axis=2, keepdims=True)
    return np.asarray(np.log(np.exp(density - most).sum(axis=2)) + most[..., 0])


def likelihood(law: Law, points: Points, shared: FloatArray, start: FloatArray) -> FloatArray:
    """Return the log likelihood of draws of what all specimens share."""
    if not law.grows:
        weight = weights_of(points, shared)
        square, _, _ = _fit_of(law, points, shared, weight, np.zeros((*weight.shape[1:], 1)))
        return np.asarray((_constants(points, shared, weight) - 0.5 * square[..., 0]).sum(axis=1))
    over = _over_nodes(law, points, shared, start, _NODES)
    return np.concatenate([(_log_sum(density) + np.log(width)).sum(axis=1) for density, _, width, _ in over])


def drawn_specimens(
    law: Law, points: Points, shared: FloatArray, sizes_at_mode: FloatArray, random: np.random.Generator
) -> Specimens:
    """Return one draw of all specimens, given their own values, for each draw of what they share."""
    many = _many(points, _FINE)
    at_once = many * _FINE.size
    over = _over_nodes(law, points, shared, sizes_at_mode, _FINE) if law.grows else None
    levels, sizes = [], []
    for i in range(0, len(shared), many):
        part = shared[i : i + many]
        size = np.zeros((len(part), len(points.value)))
        if over is None:
            weight = weights_of(points, part)
        else:
            if i % at_once == 0:
                density, nodes, _, weights = next(over)
            own = slice(i % at_once, i % at_once + many)
            weight = weights[:, own]
            size = _drawn(density[own], nodes[own], random.random(size.shape))
        _, first, total = _fit_of(law, points, part, weight, size[..., None])
        normals = random.standard_normal(size.shape)
        levels.append(part[:, :1] + first[..., 0] / total[..., 0] + normals / np.sqrt(total[..., 0]))
        sizes.append(size)
    return _specimens(law, np.concatenate(levels), np.concatenate(sizes), shared)


def _specimens(law: Law, level: FloatArray, size: FloatArray, shared: FloatArray) -> Specimens:
    return Specimens(law, level, size, _shape(law, shared)[:, :, None], np.exp(shared[:, 2:3]))


def _drawn(density: FloatArray, nodes: FloatArray, uniform: FloatArray) -> FloatArray:
    """Return one size per specimen from its density at nodes, taken as straight between them."""
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


def new_specimens(law: Law, shared: FloatArray) -> Specimens:
    """Return specimens of the population for each draw of what they share."""
    normals = _spread_normals()
    level = shared[:, :1] + np.exp(shared[:, 1:2]) * normals[0]
    size = shared[:, 3:4] + np.exp(shared[:, 4:5]) * normals[1] if law.grows else np.zeros_like(level)
    return _specimens(law, level, size, shared)
