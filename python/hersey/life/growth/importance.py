"""Adaptive importance sampling of a density that is known up to a constant, from its mode outwards.

Draws come from t distributions round heavy draws of earlier rounds, and are weighed by all rounds together
(Cornuet et al., Scand. J. Stat. 39 (2012) 798); the mean weight is the integral of the density.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from hersey.arrays import FloatArray, IntArray

#: Degrees of freedom of the t distributions.
_FREEDOM = 4.0
#: Kernels of a later round.
_KERNELS = 100
#: Width of the first distribution, in standard deviations.
_WIDE = 1.5
#: Width of later ones, in standard deviations.
_BANDWIDTH = 0.6
#: Effective draws from which no further round is made, and further rounds at the most.
_WORTH, _AGAIN = 100.0, 3
#: Greatest weight with which a draw decides where the next round looks, in mean weights.
_HELD = 20.0


@dataclass(frozen=True)
class Weighed:
    """Draws, their weights, which sum to 1, and the logarithm of the integral of the density."""

    draws: FloatArray
    weight: FloatArray
    log_integral: float


def importance_sampled(
    log_density: Callable[[FloatArray], FloatArray],
    mode: FloatArray,
    covariance: FloatArray,
    rounds: Sequence[int],
    random: np.random.Generator,
) -> Weighed:
    """Return weighed draws of a density.

    Parameters
    ----------
    log_density
        Of places (places, numbers).
    mode, covariance
        Where the first round draws from.
    rounds
        Draws of each round; the last is repeated while all are worth too few.
    """
    spots, density = np.empty((0, mode.size)), np.empty(0)
    proposed: list[tuple[int, _Kernels, FloatArray]] = []
    kernels = _Kernels(mode[None], _WIDE**2 * covariance)
    for turn in range(len(rounds) + _AGAIN):
        count = rounds[min(turn, len(rounds) - 1)]
        draws = kernels.drawn(count, random)
        spots = np.concatenate([spots, draws])
        density = np.concatenate([density, log_density(draws)])
        proposed.append((count, kernels, np.empty(0)))
        # what earlier rounds make of earlier spots is known
        proposed = [
            (number, each, np.append(known, math.log(number) + each.log_density(spots[known.size :])))
            for number, each, known in proposed
        ]
        logs = density - special.logsumexp([of_round for _, _, of_round in proposed], axis=0)
        weight = np.exp(logs - special.logsumexp(logs))
        if turn + 1 >= len(rounds) and 1.0 / np.sum(weight**2) > _WORTH:
            break
        kernels = _round_draws(spots, weight, random)
    kept = weight > 0.0
    return Weighed(spots[kept], weight[kept], float(special.logsumexp(logs)))


def systematic(weight: FloatArray, count: int, random: np.random.Generator) -> IntArray:
    """Return so many indices drawn by weight, ascending: each as often as its share asks for, to one."""
    steps = (np.arange(count) + random.random()) / count
    return np.minimum(np.searchsorted(np.cumsum(weight) / weight.sum(), steps), weight.size - 1)


def _round_draws(spots: FloatArray, weight: FloatArray, random: np.random.Generator) -> _Kernels:
    """Kernels round heavy draws (West, J. R. Stat. Soc. B 55 (1993) 409): they follow a bent density."""
    held = np.minimum(weight, _HELD / weight.size)
    held /= held.sum()
    away = spots - held @ spots
    covariance = away.T @ (away * held[:, None]) + 1e-6 * np.eye(spots.shape[1])
    return _Kernels(spots[systematic(held, _KERNELS, random)], _BANDWIDTH**2 * covariance)


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
        tails = spots @ (-2.0 * centres.T)
        tails += (spots**2).sum(axis=1)[:, None] + (centres**2).sum(axis=1)
        np.log1p(np.maximum(tails, 0.0, out=tails) / _FREEDOM, out=tails)
        tails *= -0.5 * (_FREEDOM + number)
        np.exp(tails, out=tails)
        constant = special.gammaln(0.5 * (_FREEDOM + number)) - special.gammaln(0.5 * _FREEDOM)
        constant -= 0.5 * number * math.log(_FREEDOM * math.pi) + np.log(np.diag(factor)).sum()
        return np.asarray(np.log(tails.mean(axis=1)) + constant)
