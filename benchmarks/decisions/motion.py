"""The motion of a belt: steps of Dormand and Prince, with sticking and release located as events.

What a motion comes to is decided as early as it is certain: it sticks once two stick phases under a constant
drive are alike, and it slides once its energy no longer suffices to slow the belt to the transition speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from benchmarks.decisions.belt import Belt, Drive, State

Outcome = Literal["slides", "sticks", "stalls", "swings", "undecided"]
Slopes = tuple[float, float]

#: Relative tolerance of a step.
TOLERANCE = 1e-8
#: Steps after which a motion is given up.
_MOST_STEPS = 400_000
#: Longest step, as a share of the free period.
_LONGEST = 1.0 / 50.0
#: Free periods that a motion is followed at most, unless more are asked for.
LAPS = 80


@dataclass(frozen=True)
class Fate:
    """What a motion came to; ``swings`` is an oscillation that lasts without sticking."""

    outcome: Outcome
    pull: float  #: greatest spring force, N
    stuck: tuple[float, ...]  #: times at which the belt stuck, s


@dataclass(frozen=True)
class Event:
    """A belt sticks or is released."""

    kind: Literal["stick", "release"]
    time: float
    speed: float
    pull: float


def moved(belt: Belt, drive: Drive, start: State = (0.0, 0.0), laps: int = LAPS) -> Fate:
    """Follow a belt from a speed and a spring force until its fate is certain."""
    motion = Motion(belt, drive, start, laps)
    outcome = motion.outcome()
    stuck = tuple(event.time for event in motion.events if event.kind == "stick")
    return Fate(outcome, motion.greatest_pull, stuck)


def from_rest(belt: Belt, speed: float, acceleration: float = math.inf) -> Fate:
    """Start a belt at rest: the drive comes to a speed in a step or a ramp."""
    return moved(belt, start_drive(speed, acceleration))


def start_drive(speed: float, acceleration: float = math.inf) -> Drive:
    """Return a drive that comes from rest to a speed in a step or a ramp."""
    if math.isinf(acceleration):
        return Drive((0.0, speed))
    return Drive((0.0, 0.0), (speed / acceleration, speed))


def from_above(belt: Belt, speed: float, excess: float = 1.001, laps: int = LAPS) -> Fate:
    """Follow a belt that slid faster by a factor before the drive stepped down to a speed."""
    return moved(belt, Drive((0.0, speed)), (excess * speed, belt.drag(excess * speed)), laps)


class Motion:
    """One motion; ``time``, ``speed`` and ``pull`` are its state."""

    def __init__(self, belt: Belt, drive: Drive, start: State, laps: int, *, record: bool = False) -> None:
        self.belt, self.drive = belt, drive
        self.time, (self.speed, self.pull) = 0.0, start
        self.greatest_pull = self.greatest_speed = 0.0
        self.events = list[Event]()
        self.minima = list[float]()
        self.path: list[tuple[float, ...]] | None = [] if record else None
        self.settled, self.goal = drive.corners[-1]
        loading = 6.0 * belt.start / (belt.stiffness * max(self.goal, 1e-6 * belt.stick))
        self.until = self.settled + laps * belt.period + loading
        self.stuck = belt.held(self.speed, self.pull)
        self.step = belt.period / 1e4
        self.slopes: Slopes | None = None
        self.direction = 1.0  #: of the motion: drag acts against it until the belt has come to speed 0
        self.resting_pull = belt.drag(self.goal)

    def outcome(self) -> Outcome:
        """Move until the fate is certain or time is up."""
        for _ in range(_MOST_STEPS):
            if self.time >= self.until:
                return self._in_the_end()
            if self.stuck:
                if not self._wait(math.inf):
                    return "stalls"
            elif self._slide(math.inf) and self._sticks_for_ever():
                return "sticks"
            elif self._slides_for_ever():
                return "slides"
        return "undecided"

    def run(self, until: float) -> None:
        """Move up to a time, whatever happens."""
        while self.time < until:
            if self.stuck:
                self._wait(until)
            else:
                self._slide(until)

    def _sticks_for_ever(self) -> bool:
        """Whether the last two stick phases under the final drive speed are alike."""
        speeds = [e.speed for e in self.events if e.kind == "stick" and e.time > self.settled]
        return len(speeds) > 1 and abs(speeds[-1] - speeds[-2]) <= 1e-7 * self.belt.stick

    def _slides_for_ever(self) -> bool:
        """Whether the energy of the oscillation is too small to slow the belt to the transition speed."""
        belt = self.belt
        room = self.goal - belt.transition
        if room <= 0.0 or self.stuck or self.time < self.settled or self.resting_pull > belt.grip:
            return False
        away, stretched = self.speed - self.goal, self.pull - self.resting_pull
        energy = belt.mass * away**2 + stretched**2 / belt.stiffness
        highest = self.resting_pull + math.sqrt(energy * belt.stiffness)
        return highest < belt.grip and energy < 0.999999 * belt.mass * room**2

    def _in_the_end(self) -> Outcome:
        """Judge a motion whose time is up by its last minima of speed."""
        sticks = [event.time for event in self.events if event.kind == "stick"]
        if self.stuck or (sticks and sticks[-1] > self.until - 20.0 * self.belt.period):
            return "sticks"
        if len(self.minima) > 20 and self.goal > self.belt.transition:
            before, last = (self.goal - self.minima[n] for n in (-11, -1))
            return "slides" if last < 0.99 * before or last < 1e-3 * self.goal else "swings"
        return "undecided" if abs(self.speed - self.goal) < 0.02 * self.goal else "swings"

    def _wait(self, until: float) -> bool:
        """Wait until the spring pulls the belt off; return whether it ever does."""
        belt = self.belt
        hold = belt.hold(self.speed)
        while self.time < until:
            drive_speed, acceleration, corner = self.drive.piece(self.time)
            away, growth = drive_speed - self.speed, 0.5 * acceleration
            need = min(hold, belt.grip) - self.pull
            wait = _first_root(growth, away, need / belt.stiffness)
            end = min(corner, until)
            if self.time + wait <= end and hold <= belt.grip:
                self._load(wait, away, growth)
                self._release(hold)
                return True
            if self.time + wait <= end or end == math.inf:
                self.greatest_pull = max(self.greatest_pull, min(hold, belt.grip))
                return False
            self._load(end - self.time, away, growth)
        return True

    def _load(self, duration: float, away: float, growth: float) -> None:
        """Stretch the spring of a held belt for some time."""
        before, k = (self.time, self.pull), self.belt.stiffness
        self.time += duration
        self.pull += k * (away * duration + growth * duration**2)
        self._keep(before, k * away, k * (away + 2.0 * growth * duration))

    def _release(self, hold: float) -> None:
        self.events.append(Event("release", self.time, self.speed, hold))
        self.pull, self.greatest_pull = hold, max(self.greatest_pull, hold)
        self.direction = 1.0
        self.speed += 1e-12 * self.belt.stick
        self.stuck, self.slopes, self.step = False, None, self.belt.period / 1e4

    def _keep(self, before: State, slope: float, slope_after: float) -> None:
        """Keep the spring force since a time, if it is recorded."""
        if self.path is not None and self.time > before[0]:
            self.path.append((*before, slope, self.time, self.pull, slope_after))

    def _slide(self, until: float) -> bool:
        """Take one step at most; return whether the belt sticks at its end."""
        belt = self.belt
        drive_speed, acceleration, corner = self.drive.piece(self.time)
        size = min(self.step, _LONGEST * belt.period, min(corner, until) - self.time)
        first = self.slopes or self._slopes(self.speed, self.pull, drive_speed)
        after, last, error = self._stepped(size, first, drive_speed, acceleration)
        off = self._off(error)
        if off > 1.0 and size > 1e-11 * belt.period:
            self.step = size * max(0.2, 0.9 * off**-0.2)
            return False
        if self._ends_motion(after):
            return self._meet(size, first, drive_speed, acceleration)
        if first[0] < 0.0 < last[0] and self._dips(size, first[0], after[0], last[0]):
            return False
        self._accept(size, first, after, last)
        self.slopes = None if self.time >= corner else last
        self.step = size * min(4.0, 0.9 * max(off, 1e-8) ** -0.2) if size >= self.step else self.step
        return False

    def _accept(self, size: float, first: Slopes, after: State, last: Slopes) -> None:
        """Go to the end of a step, and note a minimum or maximum of speed in it."""
        if first[0] < 0.0 < last[0] and self.time > self.settled:
            self.minima.append(_extreme(size, self.speed, first[0], after[0], last[0]))
        if first[0] > 0.0 > last[0]:
            highest = _extreme(size, self.speed, first[0], after[0], last[0])
            self.greatest_speed = max(self.greatest_speed, highest)
        before = (self.time, self.pull)
        self.time += size
        self.speed, self.pull = after[0], min(after[1], self.belt.grip)
        self.greatest_pull = max(self.greatest_pull, self.pull)
        self._keep(before, first[1], last[1])

    def _off(self, error: Slopes) -> float:
        """Return the error of a step over its tolerance."""
        speed = 1e-3 * self.goal + 0.1 * self.belt.stick + abs(self.speed)
        pull = 0.1 * abs(self.resting_pull) + abs(self.pull)
        return max(abs(error[0]) / speed, abs(error[1]) / pull) / TOLERANCE

    def _ends_motion(self, after: State) -> bool:
        """Whether the belt comes to speed 0 in a step, or is held at its end."""
        if after[0] * self.direction < 0.0:
            return True
        return self.belt.closure == "retained" and self.belt.held(*after)

    def _dips(self, size: float, slope: float, speed: float, slope_after: float) -> bool:
        """Whether the belt is slow enough to stick within a step though not at its end; then shorten it."""
        threshold = 0.0 if self.belt.closure == "stiction" else self.belt.stick
        if self.speed < threshold or size < 1e-9 * self.belt.period:
            return False
        if _extreme(size, self.speed, slope, speed, slope_after) >= threshold:
            return False
        self.step = 0.9 * size * slope / (slope - slope_after)
        return True

    def _meet(self, size: float, first: Slopes, drive_speed: float, acceleration: float) -> bool:
        """Go to the event within a step; return whether the belt sticks there."""
        low, high = 0.0, size
        while high - low > 1e-13 * self.belt.period:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            met = self._ends_motion(self._stepped(middle, first, drive_speed, acceleration)[0])
            low, high = (low, middle) if met else (middle, high)
        after, last, _ = self._stepped(high, first, drive_speed, acceleration)
        self._accept(high, first, after, last)
        self.slopes = None
        if self.belt.closure == "stiction":
            self.speed = 0.0
        if not self.belt.held(self.speed, self.pull):
            self.direction = math.copysign(1.0, self.pull)
            self.speed = self.direction * 1e-12 * self.belt.stick
            return False
        self.stuck = True
        self.events.append(Event("stick", self.time, self.speed, self.pull))
        return True

    def _slopes(self, speed: float, pull: float, drive_speed: float) -> Slopes:
        belt = self.belt
        growth = belt.stiffness * (drive_speed - speed)
        if pull >= belt.grip:
            pull, growth = belt.grip, min(growth, 0.0)
        return (pull - self.direction * belt.drag(speed)) / belt.mass, growth

    def _stepped(self, h: float, first: Slopes, u: float, a: float) -> tuple[State, Slopes, Slopes]:
        """Return state and slopes after a step, and its error.

        Coefficients of Dormand and Prince (J. Comput. Appl. Math. 6 (1980) 19); ``u`` and ``a`` are speed and
        acceleration of the drive.
        """
        f, v, p = self._slopes, self.speed, self.pull
        v1, p1 = first
        v2, p2 = f(v + h * v1 / 5, p + h * p1 / 5, u + a * h / 5)
        b1, b2 = h * 3 / 40, h * 9 / 40
        v3, p3 = f(v + b1 * v1 + b2 * v2, p + b1 * p1 + b2 * p2, u + a * h * 3 / 10)
        b1, b2, b3 = h * 44 / 45, h * -56 / 15, h * 32 / 9
        v4, p4 = f(v + b1 * v1 + b2 * v2 + b3 * v3, p + b1 * p1 + b2 * p2 + b3 * p3, u + a * h * 4 / 5)
        b1, b2, b3, b4 = h * 19372 / 6561, h * -25360 / 2187, h * 64448 / 6561, h * -212 / 729
        v5, p5 = f(
            v + b1 * v1 + b2 * v2 + b3 * v3 + b4 * v4,
            p + b1 * p1 + b2 * p2 + b3 * p3 + b4 * p4,
            u + a * h * 8 / 9,
        )
        b1, b2, b3, b4, b5 = h * 9017 / 3168, h * -355 / 33, h * 46732 / 5247, h * 49 / 176, h * -5103 / 18656
        v6, p6 = f(
            v + b1 * v1 + b2 * v2 + b3 * v3 + b4 * v4 + b5 * v5,
            p + b1 * p1 + b2 * p2 + b3 * p3 + b4 * p4 + b5 * p5,
            u + a * h,
        )
        b1, b3, b4, b5, b6 = h * 35 / 384, h * 500 / 1113, h * 125 / 192, h * -2187 / 6784, h * 11 / 84
        new_v = v + b1 * v1 + b3 * v3 + b4 * v4 + b5 * v5 + b6 * v6
        new_p = p + b1 * p1 + b3 * p3 + b4 * p4 + b5 * p5 + b6 * p6
        v7, p7 = f(new_v, new_p, u + a * h)
        e1, e3, e4, e5, e6, e7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40
        error = (
            h * (e1 * v1 + e3 * v3 + e4 * v4 + e5 * v5 + e6 * v6 + e7 * v7),
            h * (e1 * p1 + e3 * p3 + e4 * p4 + e5 * p5 + e6 * p6 + e7 * p7),
        )
        return (new_v, new_p), (v7, p7), error


def recorded(belt: Belt, drive: Drive, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the spring force at given times of a motion that starts from rest."""
    motion = Motion(belt, drive, (0.0, 0.0), 1, record=True)
    motion.run(float(times[-1]) + 1e-9)
    t0, p0, d0, t1, p1, d1 = np.array(motion.path).T
    piece = np.clip(np.searchsorted(t0, times, side="right") - 1, 0, t0.size - 1)
    h = (t1 - t0)[piece]
    u = np.clip((times - t0[piece]) / h, 0.0, 1.0)
    ends = (1 + 2 * u) * (1 - u) ** 2 * p0[piece] + u**2 * (3 - 2 * u) * p1[piece]
    slopes = h * (u * (1 - u) ** 2 * d0[piece] - u**2 * (1 - u) * d1[piece])
    return np.asarray(ends + slopes, dtype=np.float64)


def _extreme(size: float, value: float, slope: float, after: float, slope_after: float) -> float:
    """Return the extreme of a cubic within a step at whose ends its slopes have opposite signs."""
    u = slope / (slope - slope_after)
    ends = (1 + 2 * u) * (1 - u) ** 2 * value + u**2 * (3 - 2 * u) * after
    return ends + size * (u * (1 - u) ** 2 * slope - u**2 * (1 - u) * slope_after)


def _first_root(growth: float, away: float, need: float) -> float:
    """Return the least time at which growth t^2 + away t reaches what is needed; infinite if never."""
    if need <= 0.0:
        return 0.0
    if abs(growth) < 1e-15:
        return need / away if away > 0.0 else math.inf
    inside = away**2 + 4.0 * growth * need
    if inside < 0.0:
        return math.inf
    roots = [(-away + sign * math.sqrt(inside)) / (2.0 * growth) for sign in (1.0, -1.0)]
    return min((root for root in roots if root >= 0.0), default=math.inf)
