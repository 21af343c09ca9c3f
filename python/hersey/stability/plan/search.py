"""The quickest profile: a grid in the order of its duration, then ever finer steps around the best found.

A profile is first tried at the nominal parameters, which refuse most, then on all drawn machines, those that
refused others before first. It counts only if it works on all but the few allowed. Steps of the refinement
are tried on those that refused others alone, and the last of them on all.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hersey.stability.plan.draws import Trials
from hersey.stability.plan.grid import STRETCHES, WAITS, Room, profiles, thinned, waits_of
from hersey.stability.plan.trial import (
    COARSE,
    FINE,
    Follow,
    MachineSample,
    Shape,
    TemperatureProfile,
    outcomes,
    rounded,
)

Progress = Callable[[int, int], object]

#: Profiles tried at random below the best found.
_RANDOM = 600
#: Steps of the refinement as shares of its duration.
_STEPS = (0.15, 0.06, 0.025, 0.01, 0.004, 0.0015)
#: Factors by which rise, hold and fall of failed profiles become longer.
_LONGER = (1.0, 1.02, 1.05, 1.1, 1.2, 1.4, 2.0)
#: Profiles of the grid so much slower than the best are starts too.
_NEAR = 1.03
#: Those of them that differ by this share.
_DIFFERENT = 0.15
#: And no more of them than this.
_STARTS = 5
#: Profiles that differ, kept for the search after a failed verification.
_KEPT = 12
#: Best profiles refined.
_BEST = 3
#: Other profiles of the grid that are.
_OTHERS = 9
#: So much slower than the best at most.
_VALLEYS = 1.15
#: Steps at random from a profile.
_TRIES = 160
#: Draws of a step.
_DRAWS = 6
#: Profiles followed at once, spread over the cores.
_TOGETHER = 16
#: Speeds and durations within this factor are the same.
_SAME = 1.01
#: Relative time that a simpler profile may cost.
_SAME_TIME = 1e-5
#: Profiles of the grid after each of several waits, and of the slow grid.
_THINNED = 300
#: Share of the profile's duration to which a wait is found.
_WAIT_STEP = 0.02


class Search:
    """The search for the quickest profile on given machines."""

    def __init__(
        self,
        nominal: MachineSample,
        trials: Trials,
        thermal: TemperatureProfile,
        target: float,
        room: Room,
        *,
        seed: int,
        progress: Progress | None = None,
    ) -> None:
        """Keep what the search needs; the seed is that of the profiles tried at random."""
        self.nominal, self.trials, self.thermal = nominal, trials, thermal
        self.target, self.room, self.seed = target, room, seed
        self.progress = progress
        self.best: Shape | None = None
        self.time = math.inf
        self.working: list[tuple[float, Shape]] = []
        self.known: list[Shape] = []
        self.refused: set[Shape] = set()
        self._grids: dict[float, list[Shape]] = {}
        self.count = 0

    def run(self, *, again: bool = False) -> Shape | None:
        """Return the quickest profile, or None if none of the family works; again: not far from the best."""
        self.over_grids()
        if self.best is None:
            return None
        self._at_random()
        starts = self.starts(again=again)
        rng = np.random.default_rng([self.seed, 8])
        valleys = []
        for i, start in enumerate(starts):
            self.report(i, len(starts))
            valleys.append(self._wander(start, rng))
        for valley in sorted(valleys, key=_time)[:_BEST]:
            self._descend(valley)
        self._wander((self.time, self.best), rng)
        return self.settle()

    def over_grids(self) -> None:
        """Try the grid, then ever slower ones until a profile works."""
        for stretch in STRETCHES:
            self._over_grid(stretch)
            if self.best is not None:
                break

    def starts(self, *, again: bool = False) -> list[tuple[float, Shape]]:
        """Return the profiles found from which to refine, with those of other valleys unless ``again``."""
        return self._apart(_STARTS) + ([] if again else self._others())

    def settle(self) -> Shape | None:
        """Simplify the best profile, and find its time to a fine tolerance."""
        if self.best is not None:
            self._simplify()
            fine = self.trials.time(self.best, tolerance=FINE)
            self.time = fine if fine < math.inf else self.time
        return self.best

    def again(self, machines: Sequence[MachineSample], allowed: int) -> Shape | None:
        """Return the quickest profile that works on these machines too, all but the allowed."""
        everyone = [*self.trials.machines, *machines]
        self.trials = Trials(everyone, allowed, self.thermal, self.trials.force_limit)
        self.known += [shape for _, shape in self._apart(_KEPT)]
        self.working, self.best, self.time = [], None, math.inf
        self.refused = set()
        longer = {
            replace(shape, rise=shape.rise * up, hold=shape.hold * on, fall=shape.fall * down)
            for shape in self.known
            for up, on, down in itertools.product(_LONGER, repeat=3)
        }
        for shape in sorted(longer, key=lambda shape: shape.end):
            self.attempt(shape)
        return self.run(again=True)

    def grid(self, stretch: float = 1.0) -> list[Shape]:
        """Return the profiles of the grid that the room allows, quickest first, without waits."""
        if stretch not in self._grids:
            self._grids[stretch] = profiles(self.room, self.target, self.nominal.lap * stretch)
        return self._grids[stretch]

    def waits(self) -> list[float]:
        """Return the waits of the grid."""
        return waits_of(self.thermal)

    def attempt(self, shape: Shape, below: float = math.inf) -> float:
        """Return the time of a profile, infinite if it fails or is not below that of the best, or another."""
        below = self.time if below == math.inf else below
        if not self._is_worth(shape, below):
            return math.inf
        return self._on_all(shape, self._alone([shape], below)[0], below)

    def _may(self, shape: Shape, below: float) -> float:
        """Time of a profile on the machines that refused others before, infinite if not below another."""
        if not self._is_worth(shape, below):
            return math.inf
        self.count += 1
        return self.trials.may(shape, below, self.nominal)

    def _confirmed(self, way: list[tuple[float, Shape]]) -> tuple[float, Shape]:
        """Return the quickest of ever quicker profiles that works on all machines, as the first does."""
        while len(way) > 1:
            _, shape = way.pop()
            time = self.trials.time(shape, way[0][0])
            if time < way[0][0]:
                self._keep(time, shape)
                return time, shape
        return way[0]

    def _is_worth(self, shape: Shape, below: float) -> bool:
        return shape not in self.refused and shape.end < below and self.room.allows(shape)

    def _alone(self, shapes: Sequence[Shape], below: float = math.inf) -> list[float]:
        """Times at which the nominal machine is ready with each of some profiles of one wait."""
        limit = self.trials.force_limit
        how = Follow(latest=below, tolerance=COARSE)
        found = outcomes([self.nominal], shapes, self.thermal, limit, how)
        return [outcome.ready for outcome in found]

    def _on_all(self, shape: Shape, alone: float, below: float) -> float:
        """Time of a profile on all machines, after that of the nominal one; infinite if not below another."""
        self.count += 1
        time = self.trials.time(shape, below) if alone < below else math.inf
        if time >= below:
            if below == math.inf:
                self.refused.add(shape)
            return math.inf
        self._keep(time, shape)
        return time

    def _keep(self, time: float, shape: Shape) -> None:
        self.working.append((time, shape))
        if time < self.time:
            self.best, self.time = shape, time

    def report(self, done: int, total: int) -> None:
        """Say how far a stage is."""
        if self.progress is not None:
            self.progress(done, total)

    def _over_grid(self, stretch: float) -> None:
        """Try the grid at every wait that is not hopeless, the least wait first, until something works."""
        grid = self.grid(stretch)
        waits = [wait for wait in self.waits() if self._may_start(wait)]
        if len(waits) > 1 or stretch > 1.0:
            grid = grid[:: max(1, len(grid) // _THINNED)]
        elif waits and self._at_wait(thinned(grid), waits[0], 0, len(grid)):
            return
        for i, wait in enumerate(waits):
            self._at_wait(grid, wait, i * len(grid), len(waits) * len(grid))
            if self.best is not None:
                if wait > 0:
                    self._earlier(max((w for w in self.waits() if w < wait), default=0.0), wait, grid)
                return

    def _at_wait(self, grid: Sequence[Shape], wait: float, done: int, total: int) -> bool:
        """Try the grid after a wait; whether something worked that was quicker than the best."""
        before = self.time
        for j in range(0, len(grid), _TOGETHER):
            self.report(done + j, total)
            some = grid[j : j + _TOGETHER]
            moved = [replace(shape, wait=wait) for shape in some] if wait > 0 else some
            if moved[0].end >= self.time:
                break
            below = self.time * _NEAR
            worth = [shape for shape in moved if self._is_worth(shape, below)]
            for shape, alone in zip(worth, self._alone(worth, below), strict=True):
                if shape.end < self.time:
                    self._on_all(shape, alone, self.time * _NEAR)
        return self.time < before

    def _may_start(self, wait: float) -> bool:
        """Whether enough belts break away within the force allowed, after this wait or a little later."""
        later = self.thermal.end / WAITS if self.thermal.schedule is not None else 0.0
        limit = self.trials.force_limit
        if limit == math.inf:
            return True
        temperatures = self.thermal.at(wait), self.thermal.at(wait + later)
        return any(
            self.trials.kept([m.drag.law_at(t).holding_force for m in self.trials.machines]) <= limit
            for t in temperatures
        )

    def _earlier(self, early: float, late: float, grid: Sequence[Shape]) -> None:
        """Halve the wait between one at which nothing works and one at which something does."""
        assert self.best is not None
        while late - early > _WAIT_STEP * self.best.ramps:
            middle = 0.5 * (early + late)
            tried = [replace(shape, wait=middle) for _, shape in sorted(self.working, key=_time)[:8]]
            works = [self.attempt(shape) < math.inf for shape in tried]
            if any(works) or self._at_wait(grid, middle, 0, len(grid)):
                late = middle
            else:
                early = middle

    def _at_random(self) -> None:
        """Try profiles quicker than the best, spread evenly over the family."""
        rng = np.random.default_rng([self.seed, 7])
        count = _RANDOM if len(self.waits()) == 1 else _RANDOM // 4
        for i, row in enumerate(rng.uniform(size=(count, 5))):
            if i % 64 == 0:
                self.report(i, count)
            assert self.best is not None
            self.attempt(self._between(row, self.best))

    def _between(self, row: NDArray[np.float64], best: Shape) -> Shape:
        peak = self.target + row[0] * max(self.room.speed - self.target, 0.0)
        least = (2.0 * peak - self.target) / self.room.acceleration
        spare = max(best.ramps - least, 0.0) * row[1]
        shares = np.sort(row[2:4])
        return self.room.shape(
            self.target,
            peak,
            spare * shares[0] ** 2,
            spare * (shares[1] - shares[0]),
            spare * (1.0 - shares[1]),
            best.wait * (1.0 if row[4] < 0.5 else 1.0 - 0.1 * (row[4] - 0.5)),
        )

    def _others(self) -> list[tuple[float, Shape]]:
        """Profiles of the grid a little slower than the best, one for each peak speed: other valleys."""
        assert self.best is not None
        most, seen = self.time * _VALLEYS, set[float]()
        slower: list[tuple[float, Shape]] = []
        for j, shape in enumerate(thinned(self.grid())):
            moved = replace(shape, wait=self.best.wait)
            if j % 64 == 0:
                self.report(j, _OTHERS * 1000)
            if moved.end >= most or len(slower) >= _OTHERS:
                break
            if moved.peak not in seen and (time := self.attempt(moved, most)) < math.inf:
                seen.add(moved.peak)
                slower.append((time, moved))
        return slower

    def _apart(self, count: int) -> list[tuple[float, Shape]]:
        """The quickest of the profiles found that differ from one another."""
        chosen: list[tuple[float, Shape]] = []
        for time, shape in sorted(self.working, key=_time):
            if all(_differ(shape, other) for _, other in chosen):
                chosen.append((time, shape))
                if len(chosen) == count:
                    break
        return chosen

    def _wander(self, start: tuple[float, Shape], rng: np.random.Generator) -> tuple[float, Shape]:
        """Step at random, far and near, and keep what makes the profile quicker."""
        way = [start]
        span = max(self.room.speed - self.target, 0.0)
        low, high = np.log(_STEPS[-1]), np.log(2.0 * _STEPS[0])
        for _ in range(_TRIES):
            time, shape = way[-1]
            moved = shape
            for _ in range(_DRAWS):
                step = np.exp(rng.uniform(low, high))
                up, rise, hold, fall = step * rng.standard_normal(4) * (rng.uniform(size=4) < 0.6)
                wait = -abs(step * rng.standard_normal()) * shape.ramps if shape.wait > 0 else 0.0
                size = shape.ramps
                moved = self._moved(shape, up * span, rise * size, hold * size, fall * size, wait)
                if moved.end < time:
                    break
            quicker = self._may(moved, time)
            if quicker < time:
                way.append((quicker, moved))
        return self._confirmed(way)

    def _descend(self, valley: tuple[float, Shape]) -> None:
        """Step along every combination of the numbers of a profile, ever finer."""
        tried: set[Shape] = set()  # what is not quicker than one profile is not quicker than a quicker one
        for step in _STEPS:
            way = [valley]
            while (moved := self._stepped(*way[-1], step, tried)) is not None:
                way.append(moved)
            quickest = way[-1][1]
            valley = self._confirmed(way)
            if valley[1] != quickest:
                tried.clear()

    def _simplify(self) -> None:
        """Leave out what is too short to matter: an overshoot, a hold."""
        assert self.best is not None
        shape = self.best
        if shape.peak < _SAME * shape.target:
            shape = replace(shape, peak=shape.target)
        if shape.hold < (_SAME - 1.0) * shape.ramps:
            shape = replace(shape, hold=0.0)
        if shape == self.best or not self.room.allows(shape):
            return
        time = self.trials.time(shape)
        if time < self.time * (1.0 + _SAME_TIME):
            self.best, self.time = shape, time

    def _stepped(
        self, time: float, shape: Shape, step: float, tried: set[Shape]
    ) -> tuple[float, Shape] | None:
        span, size = step * max(self.room.speed - self.target, 0.0), step * shape.ramps
        for up, rise, hold, fall in itertools.product((0, -1, 1), repeat=4):
            moved = self._moved(shape, up * span, rise * size, hold * size, fall * size, 0.0)
            if moved in tried:
                continue
            tried.add(moved)
            quicker = self._may(moved, time)
            if quicker < time:
                return quicker, moved
        return None

    def _moved(self, shape: Shape, up: float, rise: float, hold: float, fall: float, wait: float) -> Shape:
        """The profile with its numbers changed by so much, its ramps as long as they must be."""
        peak = rounded(max(min(shape.peak + up, self.room.speed), self.target))
        return Shape(
            self.target,
            peak,
            max(shape.rise + rise, peak / self.room.acceleration),
            max(shape.hold + hold, 0.0),
            max(shape.fall + fall, (peak - self.target) / self.room.acceleration),
            max(shape.wait + wait, 0.0),
        )


def _time(row: tuple[float, Shape]) -> float:
    return row[0]


def _differ(one: Shape, other: Shape) -> bool:
    pairs = ((one.rise, other.rise), (one.hold, other.hold), (one.fall, other.fall))
    return max(abs(a - b) for a, b in pairs) > _DIFFERENT * other.ramps
