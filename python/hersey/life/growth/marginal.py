"""The likelihood of what all specimens share, specimens integrated out; and draws of specimens given that.

Of specimen u at age t: ln y = ln y0_u + ln G(t; x_u) + e, e ~ N(0, s^2 + sigma^2), ln y0_u ~ N(m0, t0^2), and
x_u ~ N(m1, t1^2), s being the stated error. ln y0_u integrates out in closed form, x_u on a grid round its
mode. What all share has the columns m0, ln t0, ln sigma, m1, ln t1 and shapes, as far as the law has them.
"""

from __future__ import annotations

import math
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
    """Return the precision of each value, (draws, specimens, ages)."""
    return points.given / (points.variance + np.exp(2.0 * shared[:, 2])[:, None, None])


def _fit_of(
    law: Law, points: Points, shared: FloatArray, weight: FloatArray, size: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Weighed squares of what is left, less those that the level takes up, and the two sums of it.

    ``size`` is (draws, specimens, nodes).
    """
    shape = _shape(law, shared)[:, :, None, None, None]
    growth = law.log_growth(size[..., None], points.age[None, :, None, :], shape)
    left = points.value[None, :, None, :] - growth - shared[:, 0][:, None, None, None]
    first = (left @ weight[..., None])[..., 0]
    total = weight.sum(axis=2)[..., None] + np.exp(-2.0 * shared[:, 1])[:, None, None]
    return (left**2 @ weight[..., None])[..., 0] - first**2 / total, first, total


def _constants(points: Points, shared: FloatArray, weight: FloatArray) -> FloatArray:
    """The part of the likelihood of each specimen that does not depend on its size."""
    logs = np.where(points.given, np.log(np.where(points.given, weight, 1.0)), 0.0).sum(axis=2)
    spread = np.exp(2.0 * shared[:, 1])[:, None]
    number = points.given.sum(axis=1)
    logs -= np.log1p(spread * weight.sum(axis=2)) + number * math.log(2.0 * math.pi)
    return np.asarray(0.5 * logs)


def modes(
    law: Law, points: Points, shared: FloatArray, weight: FloatArray, start: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the most probable size of each specimen, and its width (Gauss-Newton), (draws, specimens)."""
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
            gradient = (weighed * left).sum(axis=2) - across * (weight * left).sum(axis=2) / total
            step = np.clip((gradient - precision * (size - mean)) / curvature, -1.0, 1.0)
            size += step
            if (step**2 * curvature).max() < _NEAR**2:
                break
    return size, 1.0 / np.sqrt(curvature)


def _over_nodes(
    law: Law, points: Points, shared: FloatArray, start: FloatArray, nodes: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Log density of each specimen's values and size at nodes round its mode, the nodes, and its width."""
    weight = weights_of(points, shared)
    mode, width = modes(law, points, shared, weight, start)
    size = mode[..., None] + width[..., None] * nodes
    square, _, _ = _fit_of(law, points, shared, weight, size)
    spread = shared[:, 4][:, None, None]
    away = (size - shared[:, 3][:, None, None]) * np.exp(-spread)
    density = -0.5 * (square + away**2 + math.log(2.0 * math.pi)) - spread
    return density + _constants(points, shared, weight)[..., None], size, width


def _log_sum(density: FloatArray) -> FloatArray:
    """Log of the sum over nodes: that of scipy takes ten times as long for so few numbers."""
    most = density.max(axis=2, keepdims=True)
    return np.asarray(np.log(np.exp(density - most).sum(axis=2)) + most[..., 0])


def likelihood(law: Law, points: Points, shared: FloatArray, start: FloatArray) -> FloatArray:
    """Return the log likelihood of draws of what all specimens share."""
    if not law.grows:
        weight = weights_of(points, shared)
        square, _, _ = _fit_of(law, points, shared, weight, np.zeros((*weight.shape[:2], 1)))
        return np.asarray((_constants(points, shared, weight) - 0.5 * square[..., 0]).sum(axis=1))
    many = max(1, _AT_ONCE // (points.value.size * _NODES.size))
    parts = []
    for i in range(0, len(shared), many):
        density, _, width = _over_nodes(law, points, shared[i : i + many], start, _NODES)
        parts.append((_log_sum(density) + np.log(width)).sum(axis=1))
    return np.concatenate(parts)


def drawn_specimens(
    law: Law, points: Points, shared: FloatArray, sizes_at_mode: FloatArray, random: np.random.Generator
) -> Specimens:
    """Return one draw of all specimens, given their own values, for each draw of what they share."""
    many = max(1, _AT_ONCE // (points.value.size * _FINE.size))
    levels, sizes = [], []
    for i in range(0, len(shared), many):
        part = shared[i : i + many]
        weight = weights_of(points, part)
        size = np.zeros((len(part), len(points.value)))
        if law.grows:
            density, nodes, _ = _over_nodes(law, points, part, sizes_at_mode, _FINE)
            size = _drawn(density, nodes, random.random(size.shape))
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
