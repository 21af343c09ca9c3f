"""The true motion: a belt pulled through a spring, with two branches of drag below which it sticks.

Above the transition speed drag rises as a power of speed, below it falls as another; below the stick speed it
is A exp(-v/v_s), which joins with the same slope at the exponent -1 and is least known to any log. A held
belt keeps its speed, and lets go when the spring pulls more than that. Dormand and Prince's steps, events by
halving: nothing of it is hersey's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

State = tuple[float, float]

#: Coefficients of Dormand and Prince (J. Comput. Appl. Math. 6 (1980) 19).
_ROWS = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
_TIMES = (1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0)
_ERRORS = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)
_TOLERANCE, _MOST_STEPS = 1e-8, 400_000
#: Times the transition up to which a fold is looked for.
_FARTHEST = 1e4


@dataclass(frozen=True)
class Belt:
    """Drag of film and rest on a belt, its mass, and the spring that pulls it; forces in N at the belt."""

    force: float  #: of the film at the transition
    transition: float  #: m/s
    rising: float  #: exponent of the force in speed
    falling: float
    stick: float  #: m/s
    stiffness: float
    mass: float
    grip: float = math.inf  #: most that the roll pulls
    rest: float = 0.0

    @cached_property
    def hold(self) -> float:
        """Greatest pull of the film that a belt at rest bears."""
        return math.e * self.force * math.pow(self.stick / self.transition, self.falling)

    @property
    def start(self) -> float:
        """Pull that starts a belt from rest."""
        return self.hold + self.rest

    def drag(self, speed: float) -> float:
        """Force against the motion, rest included; signed."""
        size = abs(speed)
        if size < self.stick:
            film = self.hold * math.exp(-size / self.stick)
        else:
            film = self.force * (size / self.transition) ** (
                self.falling if size < self.transition else self.rising
            )
        return math.copysign(film + self.rest, speed)

    def holds(self, speed: float) -> float:
        """Pull up to which a belt slower than the stick speed is held."""
        return self.hold * math.exp(-abs(speed) / self.stick) + self.rest


class Drive:
    """Speed of the drive, straight between corners of time and speed; constant after the last."""

    def __init__(self, *corners: State) -> None:
        self.corners = corners

    def speed(self, time: float) -> float:
        """Speed at a time, after a step if there is one."""
        if time < self.corners[0][0]:
            return self.corners[0][1]
        for (t0, v0), (t1, v1) in zip(self.corners, self.corners[1:], strict=False):
            if time < t1:
                return v0 + (v1 - v0) * (time - t0) / (t1 - t0)
        return self.corners[-1][1]

    def corner_after(self, time: float) -> float:
        """When the next corner comes; infinite after the last."""
        return min((t for t, _ in self.corners if t > time + 1e-12), default=math.inf)


@dataclass(frozen=True)
class Fate:
    """What became of a motion: ``slides``, ``sticks``, ``stalls``, ``swings`` or ``not told``."""

    outcome: str
    pull: float  #: greatest, N
    stuck: tuple[float, ...]  #: when it stuck


def moved(belt: Belt, drive: Drive, start: State = (0.0, 0.0), laps: int = 60) -> Fate:
    """Follow a belt from a speed and a pull until what it does for ever is sure, or so many laps."""
    motion = _Motion(belt, drive, start, laps)
    outcome = motion.outcome()
    return Fate(outcome, motion.pull, tuple(time for time, _ in motion.stuck_at))


def from_rest(belt: Belt, speed: float, acceleration: float = math.inf) -> Fate:
    """Bring the drive to a speed, in a step or a ramp."""
    rise = 0.0 if math.isinf(acceleration) else speed / acceleration
    return moved(belt, Drive((0.0, speed)) if rise == 0.0 else Drive((0.0, 0.0), (rise, speed)))


def from_above(belt: Belt, speed: float, laps: int = 60) -> Fate:
    """Leave a belt that slides a little faster than a constant drive."""
    return moved(belt, Drive((0.0, speed)), (1.001 * speed, belt.drag(speed)), laps)


def fold(belt: Belt, tolerance: float = 1e-4) -> float:
    """Slowest drive speed at which a belt that lets go does not stick again; infinite if there is none."""

    def slides(speed: float) -> bool:
        start = belt.stick * (1.0 - 1e-13), belt.hold / math.e + belt.rest
        return moved(belt, Drive((0.0, speed)), start).outcome == "slides"

    low, high = belt.transition, 2.0 * belt.transition
    if slides(1.0005 * low):
        return low
    while not slides(high):
        low, high = high, 2.0 * high
        if high > _FARTHEST * belt.transition:
            return math.inf
    while high / low > 1.0 + tolerance:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if slides(middle) else (middle, high)
    return high


class _Motion:
    """One motion; ``time``, ``speed`` and ``pull_now`` are its state."""

    def __init__(self, belt: Belt, drive: Drive, start: State, laps: int) -> None:
        self.belt, self.drive = belt, drive
        self.time, (self.speed, self.pull_now) = 0.0, start
        self.pull, self.stuck_at = 0.0, list[tuple[float, float]]()
        self.period = math.tau * math.sqrt(belt.mass / belt.stiffness)
        self.settled, self.goal = drive.corners[-1]
        self.until = self.settled + laps * self.period + 6.0 * belt.start / (belt.stiffness * self.goal)
        self.first_step = self.step = self.period / 200.0
        self.stuck = self.speed < belt.stick and abs(self.pull_now) <= belt.holds(self.speed)
        self.slowed = False

    def outcome(self) -> str:
        """Move on until the outcome is sure."""
        for _ in range(_MOST_STEPS):
            if self.time >= self.until:
                return self._in_the_end()
            if found := self._held() if self.stuck else self._slid():
                return found
        return "not told"

    def _in_the_end(self) -> str:
        if self.stuck_at and self.stuck_at[-1][0] > self.until - 20.0 * self.period:
            return "sticks"
        if abs(self.speed - self.goal) > 0.02 * self.goal:
            return "swings"
        return "slides" if self.goal > self.belt.transition else "not told"

    def _held(self) -> str:
        """Wait until the spring pulls the belt off."""
        belt = self.belt
        hold = belt.holds(self.speed)
        if hold > belt.grip:
            self.pull = max(self.pull, belt.grip)
            return "stalls"
        while True:
            corner = self.drive.corner_after(self.time)
            ahead, growth = self.drive.speed(self.time + 1e-13), 0.0
            if corner < math.inf:
                growth = 0.5 * (self.drive.speed(corner - 1e-13) - ahead) / (corner - self.time)
            away = ahead - self.speed
            wait = _first_root(growth, away, (hold - self.pull_now) / belt.stiffness)
            if self.time + wait <= corner:
                break
            if corner == math.inf:
                return "stalls"
            passed = corner - self.time
            self.pull_now += belt.stiffness * (away * passed + growth * passed**2)
            self.time = corner
        self.time += wait
        self.pull_now, self.pull = hold, max(self.pull, hold)
        self.speed = max(self.speed, 0.0) + 1e-12 * belt.stick
        self.stuck, self.slowed = False, False
        self.step = min(self.first_step, self.period / 1e4)
        return ""

    def _slid(self) -> str:
        """Take one step, up to the next corner of the drive or event."""
        belt = self.belt
        size = min(self.step, self.period / 60.0, self.drive.corner_after(self.time) - self.time)
        after, error = self._stepped(size)
        scale = (
            _TOLERANCE * (1e-3 * self.goal + abs(self.speed)),
            _TOLERANCE * (belt.force + abs(self.pull_now)),
        )
        off = max(abs(error[0]) / scale[0], abs(error[1]) / scale[1])
        if off > 1.0 and size > 1e-10 * self.period:
            self.step = size * max(0.2, 0.9 * off**-0.2)
            return ""
        above = self.speed >= belt.stick
        if after[0] < belt.stick:
            if above or (after[0] < self.speed and self._short_of(after, above) <= 0.0):
                return self._met(size, above)
        elif not above and after[0] > 1.001 * belt.stick and size > 1e-9 * self.period:
            self.step = 0.3 * size
            return ""
        before, self.time = self.speed, self.time + size
        self.speed, self.pull_now = after[0], min(after[1], belt.grip)
        self.pull = max(self.pull, self.pull_now)
        if off < 1.0:
            self.step = size * min(4.0, 0.9 * max(off, 1e-8) ** -0.2)
        if self.time > self.settled and before < self.speed and self.slowed and self._safe(before):
            return "slides"
        self.slowed = self.speed < before
        return ""

    def _safe(self, least: float) -> bool:
        """Whether swings only die out from a least speed on: all of them lie where drag rises."""
        if self.goal <= self.belt.transition:
            return False
        free = least > 1.000001 * self.belt.transition and self.pull_now < 0.9999 * self.belt.grip
        return free or abs(least - self.goal) < 1e-3 * self.goal

    def _short_of(self, state: State, above: bool) -> float:
        """Falls through 0 where a belt comes down to the stick speed, or, slower, where it is held."""
        if above:
            return state[0] - self.belt.stick
        return abs(state[1]) - self.belt.holds(state[0])

    def _met(self, size: float, above: bool) -> str:
        """Go to the event within a step; the belt may stick there."""
        low, high = 0.0, size
        while high - low > 1e-13 * self.period:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            if self._short_of(self._stepped(middle)[0], above) <= 0.0:
                high = middle
            else:
                low = middle
        self.speed, self.pull_now = self._stepped(high)[0]
        self.time += high
        if above:
            self.speed = self.belt.stick * (1.0 - 1e-13)
        if abs(self.pull_now) > self.belt.holds(self.speed):
            return ""
        self.stuck = True
        self.stuck_at.append((self.time, self.speed))
        lasting = [speed for time, speed in self.stuck_at if time > self.settled]
        same = len(lasting) >= 3 and abs(lasting[-1] - lasting[-2]) < 1e-6 * self.belt.stick
        return "sticks" if same else ""

    def _stepped(self, size: float) -> tuple[State, State]:
        """State after a step of a size, and its error."""
        speeds, pulls = [], []
        first = self._slope(self.time, self.speed, self.pull_now)
        speeds.append(first[0])
        pulls.append(first[1])
        v, p = self.speed, self.pull_now
        for row, share in zip(_ROWS, _TIMES, strict=True):
            v = self.speed + size * sum(a * k for a, k in zip(row, speeds, strict=True))
            p = self.pull_now + size * sum(a * k for a, k in zip(row, pulls, strict=True))
            slope = self._slope(self.time + share * size, v, p)
            speeds.append(slope[0])
            pulls.append(slope[1])
        of_speed = size * sum(e * k for e, k in zip(_ERRORS, speeds, strict=True))
        return (v, p), (of_speed, size * sum(e * k for e, k in zip(_ERRORS, pulls, strict=True)))

    def _slope(self, time: float, speed: float, pull: float) -> State:
        belt = self.belt
        growth = belt.stiffness * (self.drive.speed(time) - speed)
        if pull >= belt.grip and growth > 0.0:
            growth, pull = 0.0, belt.grip
        return (pull - belt.drag(speed)) / belt.mass, growth


def _first_root(growth: float, away: float, need: float) -> float:
    """Least time at which growth t^2 + away t reaches what is needed; infinite if never."""
    if abs(growth) < 1e-15:
        return need / away if away > 0.0 else math.inf
    inside = away**2 + 4.0 * growth * need
    if inside < 0.0:
        return math.inf
    roots = [(-away + sign * math.sqrt(inside)) / (2.0 * growth) for sign in (1.0, -1.0)]
    return min((root for root in roots if root >= 0.0), default=math.inf)
