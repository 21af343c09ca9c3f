"""Tempered sequential Monte Carlo over draws whose prior is standard normal.

The evidence is brought in by degrees. After each, draws are resampled by weight and moved: along differences
of two other draws (ter Braak, Stat. Comput. 16 (2006) 239), towards and away from the prior (Cotter et al.,
Stat. Sci. 28 (2013) 424), from closure to closure and from law to law. Two populations that know nothing
of each other show whether the result has converged. Del Moral, Doucet and Jasra, J. R. Stat. Soc. B 68
(2006) 411.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.posterior.drives import Drives

#: ln weight of dwells and of evidence of each draw; anything below the least given beside it, where it cannot
#: come to that, as such a draw is not taken.
Target = Callable[[Drives, FloatArray], FloatArray]
#: Share of the draws kept that must stay effective from one degree of evidence to the next.
_EFFECTIVE = 0.5
#: Most degrees, and the least by which each brings evidence in.
_STAGES, _LEAST = 60, 1e-4
#: Part of the way of a step towards the prior, at the first and at the least.
_PART, _LEAST_PART = 0.5, 0.02
#: Share of accepted moves that the steps aim at.
_ACCEPTED = 0.3


@dataclass(frozen=True)
class Population:
    """Draws with equal weights, and how they came about."""

    drives: Drives
    log_evidence: float
    stages: int
    accepted: float  #: share of the moves of the last stage
    distinct: float  #: share of draws that no other equals
    counted: float  #: degree to which the evidence is in, 1 where all of it is


@dataclass(frozen=True)
class Moves:
    """How draws move after each stage: until each has moved so often on average, in so many rounds at most.

    ``last`` holds after the last stage.
    """

    often: float = 2.0
    rounds: int = 12
    last: int = 24


def sample(
    draws: Drives,
    target: Target,
    closures: FloatArray,
    laws: FloatArray,
    random: np.random.Generator,
    moves: Moves,
    progress: Callable[[float], object] | None = None,
    *,
    count: int | None = None,
) -> Population:
    """Return draws of the target, starting from those of the prior.

    Parameters
    ----------
    draws
        From the prior: latents standard normal.
    count
        How many are kept, as many as there are by default; with more at first fewer are equal later.
    target
        ln of the likelihood of everything for each draw, if it comes to a least.
    closures
        Prior probability of each closure, shape (closures,).
    laws
        Weight of each law of drag curves, shape (laws,).
    progress
        Called with the share of the evidence that is in.
    """
    value, kept_count = target(draws, np.full(len(draws), -np.inf)), count or len(draws)
    beta, log_evidence, stage, accepted = 0.0, 0.0, 0, 1.0
    part = _PART
    while beta < 1.0 and stage < _STAGES:
        step = _step(value, beta, _EFFECTIVE * kept_count)
        weight = np.exp(step * (value - value.max()))
        log_evidence += float(np.log(weight.mean()) + step * value.max())
        beta, stage = min(beta + step, 1.0), stage + 1
        kept = _resampled(weight, kept_count, random)
        draws, value = draws.take(kept), value[kept]
        moved, last = 0.0, beta >= 1.0
        for _ in range(moves.last if last else moves.rounds):
            draws, value, share = _moved(draws, value, beta, target, (closures, laws), part, random)
            part = float(np.clip(part * np.exp(share - _ACCEPTED), _LEAST_PART, 0.9))
            accepted, moved = share, moved + share
            if moved >= (2.0 if last else 1.0) * moves.often:
                break
        if progress is not None:
            progress(beta)
    distinct = np.unique(draws.latent[:, 0]).size / max(len(draws), 1)
    return Population(draws, log_evidence, stage, accepted, distinct, beta)


def _step(value: FloatArray, beta: float, least: float) -> float:
    """By how much evidence may be brought in so that as many draws stay effective."""

    def effective(step: float) -> float:
        weight = np.exp(step * (value - value.max()))
        return float(weight.sum() ** 2 / np.sum(weight**2))

    low, high = 0.0, 1.0 - beta
    if effective(high) >= least:
        return high
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if effective(middle) >= least else (low, middle)
    return max(low, min(_LEAST, 1.0 - beta))


def _resampled(weight: FloatArray, count: int, random: np.random.Generator) -> IntArray:
    """So many indices drawn by weight, systematically: each as often as its share asks for, to one.

    In random order, as weights that repeat with the spacing of the samples would be drawn wrongly.
    """
    order = random.permutation(weight.size)
    edges = np.cumsum(weight[order]) / weight.sum()
    at = (np.arange(count) + random.random()) / count
    return order[np.minimum(np.searchsorted(edges, at), weight.size - 1)].astype(np.intp)


def _moved(
    draws: Drives,
    value: FloatArray,
    beta: float,
    target: Target,
    prior: tuple[FloatArray, FloatArray],
    part: float,
    random: np.random.Generator,
) -> tuple[Drives, FloatArray, float]:
    """One round: half of the draws move along differences, half about the prior; some change their law."""
    closures, laws = prior
    size, count = draws.latent.shape[1], len(draws)
    along = random.random(count) < 0.5
    pcn = np.sqrt(1.0 - part**2) * draws.latent + part * random.standard_normal((count, size))
    latent = np.where(along[:, None], _along_differences(draws, random), pcn)
    # some change nothing but the closure: where little tells it, it should be free
    alone = random.random(count) < 0.2
    latent = np.where(alone[:, None], draws.latent, latent)
    changed = alone | (random.random(count) < 0.1)
    closure = np.where(changed, random.integers(0, closures.size, count), draws.closure)
    # a law of other numbers: only from the prior's own moves, whose latents mean the same to all laws
    changes = ~along & ~alone & (random.random(count) < 0.2)
    law = np.where(changes, random.integers(0, laws.size, count), draws.law).astype(np.intp)
    proposed = Drives(law, closure.astype(np.intp), latent)
    # moves about the prior leave it as it is; those along differences do not
    likelier = np.where(along, 0.5 * np.sum(draws.latent**2 - latent**2, axis=1), 0.0)
    likelier += np.log(closures[closure] / closures[draws.closure]) + np.log(laws[law] / laws[draws.law])
    chance = np.log(random.random(count))
    stays = alone & (closure == draws.closure)
    least = np.where(stays, np.inf, value + (chance - likelier) / beta)
    new = np.where(stays, value, target(proposed, least))
    takes = chance < beta * (new - value) + likelier
    kept = Drives(
        np.where(takes, law, draws.law).astype(np.intp),
        np.where(takes, closure, draws.closure).astype(np.intp),
        np.where(takes[:, None], latent, draws.latent),
    )
    return kept, np.where(takes, new, value), float(takes.mean())


def _along_differences(draws: Drives, random: np.random.Generator) -> FloatArray:
    """Latents moved by the difference of two others of the same law, of all numbers or of some."""
    size = draws.latent.shape[1]
    out = draws.latent.copy()
    for law in np.unique(draws.law):
        mine = np.flatnonzero(draws.law == law)
        if mine.size < 4:
            continue
        a, b = (mine[random.integers(0, mine.size, mine.size)] for _ in range(2))
        chosen = random.random((mine.size, size)) < random.choice([0.2, 0.5, 1.0], mine.size)[:, None]
        scale = 2.38 / np.sqrt(2.0 * np.maximum(chosen.sum(axis=1), 1))
        scale = np.where(random.random(mine.size) < 0.1, 1.0, scale)
        step = scale[:, None] * (draws.latent[a] - draws.latent[b]) * chosen
        out[mine] += step + 1e-3 * random.standard_normal((mine.size, size)) * chosen
    return out
