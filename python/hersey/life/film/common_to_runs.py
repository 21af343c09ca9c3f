"""What all runs of a campaign have in common in their torque, fitted to all of them together.

It belongs to the machine and its oil: how viscosity falls with temperature, how sharply starvation sets in,
how torque follows the film, and the drag that does not follow it (rolling, seals, gears). How much there is
of that the dwells seldom determine: it is held, and `shares` tries several values.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.film.run_search import COMMON, COMMON_ENDS, OWN, Search, within
from hersey.life.film.starved_drag import (
    FADING,
    FILM_POWER,
    FREE,
    ROLLING,
    ROLLING_BY_FLOODED,
    ROLLING_BY_SHARE,
    SHARPNESS,
    TEMPERATURE_SENSITIVITY,
)

#: What is known beforehand, mean and standard deviation: ln of the factor on the sharpness of starvation, the
#: powers of flooded film and of the share that is left on the other drag, the power of the film in shear less
#: 1, and how far starvation is by the law that fades.
_BEFOREHAND = {
    SHARPNESS: (0.0, 0.5),
    ROLLING_BY_FLOODED: (-0.2, 0.3),
    ROLLING_BY_SHARE: (1.7, 1.2),
    FILM_POWER: (0.0, 0.05),
    FADING: (0.5, 0.5),
}
#: How nearly the factor on the rolling part is held, ln; and standard deviations of all from run to run.
_HELD = 0.02
FROM_RUN_TO_RUN = np.array([0.03, 0.1, 0.1, 0.05, 0.1, 0.02, 0.05])
#: Steps that look for the layer of each run first, and those of all together; rounds of both.
_ALONE, _TOGETHER = 4, 8
_ROUNDS = 3


@dataclass(frozen=True)
class Common:
    """What is common to all runs, as known so far."""

    mean: FloatArray
    covariance: FloatArray

    @classmethod
    def beforehand(cls, sensitivity: float, factor: float) -> Common:
        """Return what is known before any dwell.

        ``sensitivity`` is the standard deviation of that of viscosity, ``factor`` ln of that on the computed
        rolling part.
        """
        mean, deviation = np.zeros(FREE), np.zeros(FREE)
        for which, (middle, known) in {**_BEFOREHAND, ROLLING: (factor, _HELD)}.items():
            mean[which], deviation[which] = middle, known
        deviation[TEMPERATURE_SENSITIVITY] = sensitivity
        return cls(mean[COMMON], np.diag(deviation[COMMON] ** 2))

    def squares(self, at: FloatArray) -> float:
        """Return the squares of a deviation from it."""
        away = at - self.mean
        return float(away @ np.linalg.solve(self.covariance, away))


@dataclass(frozen=True)
class Together:
    """What is common to all runs, and how unlikely their dwells then are: -2 ln of it, for each run."""

    common: Common
    unlikely: float


def fitted_together(searches: list[Search], beforehand: Common) -> Together:
    """Return what is common to runs, fitted to all at once by damped steps.

    What each run has of its own is eliminated from every step (Schur's complement).
    """
    searches = [each.without_common() for each in searches]
    mean, at = beforehand.mean, None
    for _ in range(_ROUNDS):
        # Each run anew from every layer: what is common may have moved far.
        free = [each.with_common(mean).searched(_ALONE, OWN)[0] for each in searches]
        begun = _Place.of(searches, free, mean, beforehand)
        at = begun if at is None or begun.squares < at.squares else at
        at = _settled(searches, at, beforehand)
        mean = at.mean
    assert at is not None
    # Of runs whose errors are known but for a factor, so that values of several assumptions can be compared.
    freedom = np.concatenate([each.freedom for each in searches])
    unlikely = float(freedom @ np.log(np.concatenate(at.each) / freedom)) + beforehand.squares(at.mean)
    stretch = max(float(np.median(np.concatenate(at.each) / freedom)), 1.0)
    return Together(
        Common(at.mean, np.asarray(stretch * np.linalg.inv(at.curvature()))), unlikely / freedom.size
    )


def _settled(searches: list[Search], at: _Place, beforehand: Common) -> _Place:
    damping = 1e-3
    for _ in range(_TOGETHER):
        tried, own = at.step(damping)
        moved = [within(one, step) for one, step in zip(at.free, own, strict=True)]
        for each in moved:
            each[:, COMMON] = tried
        moved = [
            search.settled(each, steps=1, of=OWN)[0] for search, each in zip(searches, moved, strict=True)
        ]
        then = _Place.of(searches, moved, tried, beforehand)
        if then.squares < at.squares:
            at, damping = then, max(0.2 * damping, 1e-6)
        else:
            damping = min(20.0 * damping, 1e6)
    return at


@dataclass(frozen=True)
class _Place:
    """The squares of all runs at one place, with slopes and curvatures."""

    free: list[FloatArray]
    mean: FloatArray
    squares: float
    each: list[FloatArray]  #: squares of each run
    gradient: list[FloatArray]
    bend: list[FloatArray]
    pull: FloatArray
    known: FloatArray

    @classmethod
    def of(
        cls,
        searches: list[Search],
        free: list[FloatArray],
        mean: FloatArray,
        beforehand: Common,
    ) -> _Place:
        known: FloatArray = np.asarray(np.linalg.inv(beforehand.covariance))
        found = [search.moved(each) for search, each in zip(searches, free, strict=True)]
        squares = sum(float(each[0].sum()) for each in found)
        return cls(
            free,
            mean,
            squares + beforehand.squares(mean),
            [each[0] for each in found],
            [each[1] for each in found],
            [each[2] for each in found],
            known @ (beforehand.mean - mean),
            known,
        )

    def _eliminated(
        self, damping: float
    ) -> tuple[FloatArray, FloatArray, list[FloatArray], list[FloatArray]]:
        """Curvature and slope of what is common, and what its own of each run adds and answers."""
        total, slope = self.known.copy(), self.pull.copy()
        inverse, across = [], []
        for gradient, bend in zip(self.gradient, self.bend, strict=True):
            own = bend[:, OWN[:, None], OWN]
            inner = np.arange(OWN.size)
            own[:, inner, inner] *= 1.0 + damping
            both = bend[:, OWN][:, :, COMMON]
            answer = np.linalg.solve(own, np.concatenate([gradient[:, OWN, None], both], axis=2))
            left = np.matmul(both.transpose(0, 2, 1), answer)
            total += (bend[:, COMMON, COMMON] - left[:, :, 1:]).sum(axis=0)
            slope += (gradient[:, COMMON] - left[:, :, 0]).sum(axis=0)
            inverse.append(answer[:, :, 0])
            across.append(answer[:, :, 1:])
        return total, slope, inverse, across

    def step(self, damping: float) -> tuple[FloatArray, list[FloatArray]]:
        """Return what is common after a damped step, and the steps of the runs."""
        total, slope, alone, across = self._eliminated(damping)
        bend, low, high = total + damping * np.diag(np.diag(total)), *(COMMON_ENDS - self.mean)
        moved, held = np.zeros_like(slope), np.zeros(slope.size, dtype=bool)
        for _ in range(slope.size):  # what would pass its end is held there
            left = slope[~held] - bend[np.ix_(~held, held)] @ moved[held]
            moved[~held] = np.linalg.solve(bend[np.ix_(~held, ~held)], left)
            passed = (moved < low) | (moved > high)
            if not passed.any():
                break
            moved, held = np.clip(moved, low, high), held | passed
        steps = []
        for free, one, by in zip(self.free, alone, across, strict=True):
            step = np.zeros_like(free)
            step[:, OWN] = one - by @ moved
            steps.append(step)
        return self.mean + moved, steps

    def curvature(self) -> FloatArray:
        """Return that of what is common, all else free."""
        return self._eliminated(0.0)[0]
