"""Reference values of the paper's motion, made without hersey: ``python tests/reference/make_values.py``.

The hybrid model of the paper, Eqs. 12-13 and 20-30, in inches, ounces of force and seconds, with v_t = 1:

    s' = v2 - v,    m v' = k s - F(v)
    F = F_t v^0.3 (v >= 1),    F_t v^-0.2 (v_s <= v < 1),    A exp(-v/v_s) below v_s,    A = e F_t v_s^-0.2

Each piece between two guards is integrated on its own, so no step crosses a kink, by an explicit method of
order 8 (DOP853 of SciPy) at 1e-13 in short steps. A belt that comes down to v_s

- ``retained``: keeps its speed as soon as |k s| <= A exp(-v/v_s), until k s = A exp(-v/v_s);
- ``stiction``: stops dead if |k s| <= A, until k s = A.

Above the upper fold V* a lap that starts at the release just misses v_s.
"""

from __future__ import annotations

import json
import math
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

PLACE = Path(__file__).with_name("values.json")
ACCURACY: dict[str, Any] = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}
LOW, MIXED, EHL = "low", "mixed", "ehl"
#: Longest step on each branch, s; below v_s a disturbance grows e-fold in some 0.03 ms.
LONGEST = {LOW: 2e-6, MIXED: 1e-3, EHL: 1e-3}


@dataclass(frozen=True)
class Belt:
    """The paper's baseline, or what is changed of it."""

    stiffness: float = 1000.0
    transition_force: float = 50.0
    stick_speed: float = 0.01
    drive_speed: float = 1.0
    closure: str = "retained"
    mass: float = 1.0

    def drag(self, branch: str, speed: float) -> float:
        """Eqs. 20-30, each branch a little beyond its guards too."""
        if branch == EHL:
            return self.transition_force * speed**0.3
        if branch == MIXED:
            return self.transition_force * max(speed, 1e-6) ** -0.2
        return self.breakaway * math.exp(min(-speed / self.stick_speed, 500.0))

    @property
    def breakaway(self) -> float:
        """A of Eqs. 28-29."""
        return math.e * self.transition_force * self.stick_speed**-0.2

    def motion(self, branch: str) -> Any:
        return lambda _t, y: (
            self.drive_speed - y[1],
            (self.stiffness * y[0] - self.drag(branch, y[1])) / self.mass,
        )


@dataclass(frozen=True)
class Event:
    """A release from sticking, or a stick."""

    kind: str
    time: float
    stretch: float
    speed: float


def guard(function: Any, direction: int, *, ends: bool = True) -> Any:
    function.direction, function.terminal = direction, ends
    return function


def reaches(speed: float, direction: int) -> Any:
    return guard(lambda _t, y: y[1] - speed, direction)


def turns(belt: Belt, branch: str, direction: int, *, ends: bool) -> Any:
    """Where the acceleration passes zero: the greatest speed going down, the least going up."""
    motion = belt.motion(branch)
    return guard(lambda t, y: motion(t, y)[1], direction, ends=ends)


def piece(belt: Belt, branch: str, state: tuple[float, float], guards: dict[str, Any]) -> Any:
    """Slide on one branch: the guard that ends it, the time it took, the state there, the greatest speed."""
    peak = turns(belt, branch, -1, ends=False)
    watched = [*guards.values(), peak]
    step = LONGEST[branch]
    run = solve_ivp(belt.motion(branch), (0.0, 60.0), state, events=watched, max_step=step, **ACCURACY)
    (name,) = [name for name, times in zip(guards, run.t_events, strict=False) if len(times)]
    fastest = max([state[1], *(y[1] for y in run.y_events[-1])])
    return name, float(run.t[-1]), (float(run.y[0, -1]), float(run.y[1, -1])), fastest


def slip(belt: Belt, state: tuple[float, float]) -> tuple[float, tuple[float, float], float]:
    """From a release to the next stick: time, state there, greatest speed."""
    k, v_s = belt.stiffness, belt.stick_speed
    branch = LOW if state[1] < v_s else MIXED
    time, fastest, down = 0.0, state[1], False
    while True:
        guards = {
            LOW: {"up": reaches(v_s, 1)},
            MIXED: {"up": reaches(1.0, 1), "down": reaches(v_s, -1)},
            EHL: {"down": reaches(1.0, -1)},
        }[branch]
        if branch == LOW and down:
            held = guard(lambda _t, y: abs(k * y[0]) - belt.drag(LOW, y[1]), -1)
            guards = {"held": held}
        name, took, state, peak = piece(belt, branch, state, guards)
        time, fastest, down = time + took, max(fastest, peak), name == "down"
        if name == "held":
            return time, state, fastest
        if branch == MIXED and down:
            state = (state[0], v_s)
            limit = belt.breakaway if belt.closure == "stiction" else belt.drag(LOW, v_s)
            if abs(k * state[0]) <= limit:
                return time, (state[0], 0.0 if belt.closure == "stiction" else v_s), fastest
            assert belt.closure == "retained"
        state = (state[0], {LOW: v_s, MIXED: 1.0 if not down else v_s, EHL: 1.0}[branch])
        branch = {LOW: MIXED, MIXED: LOW if down else EHL, EHL: MIXED}[branch]


def events(belt: Belt, laps: int) -> tuple[list[Event], float]:
    """Releases and sticks from rest with a slack spring, and the greatest speed of the last lap."""
    time, state, found, fastest = 0.0, (0.0, 0.0), [], 0.0
    for _ in range(laps):
        pull = belt.breakaway if belt.closure == "stiction" else belt.drag(LOW, state[1])
        time += (pull / belt.stiffness - state[0]) / (belt.drive_speed - state[1])
        state = (pull / belt.stiffness, state[1])
        found.append(Event("release", time, *state))
        took, state, fastest = slip(belt, state)
        time += took
        found.append(Event("stick", time, *state))
    return found, fastest


def cycle(belt: Belt) -> dict[str, float]:
    """Stick-slip that has settled."""
    found, fastest = events(belt, 6)
    (start, stick), release = found[-4:-2], found[-2]
    period = release.time - start.time
    return {
        "frequency": 1 / period,
        "speed_max": fastest,
        "stuck_fraction": (release.time - stick.time) / period,
    }


def margin(belt: Belt) -> float:
    """Least speed of a lap from the release, less the stick speed, the mixed branch going on below it."""
    v_s = belt.stick_speed
    start = belt.breakaway if belt.closure == "stiction" else belt.drag(LOW, v_s)
    state = (start / belt.stiffness, 0.0 if belt.closure == "stiction" else v_s)
    if state[1] < v_s:
        state = piece(belt, LOW, state, {"up": reaches(v_s, 1)})[2]
    state = piece(belt, MIXED, (state[0], v_s), {"up": reaches(1.0, 1)})[2]
    guards = {"down": reaches(1.0, -1), "turn": turns(belt, EHL, 1, ends=True)}
    name, _, state, _ = piece(belt, EHL, (state[0], 1.0), guards)
    if name == "down":
        guards = {"down": reaches(v_s / 2, -1), "turn": turns(belt, MIXED, 1, ends=True)}
        _, _, state, _ = piece(belt, MIXED, (state[0], 1.0), guards)
    return state[1] - v_s


def fold(belt: Belt) -> float:
    """Drive speed above which stick-slip cannot last, V*."""
    return float(brentq(lambda speed: margin(replace(belt, drive_speed=speed)), 1.2, 20.0, xtol=1e-13))


CYCLES = [
    *({"drive_speed": speed} for speed in (0.4, 0.7, 1.0, 1.3, 1.6, 1.9)),
    *({"stiffness": k} for k in (500.0, 1500.0, 2000.0)),
    *({"transition_force": force} for force in (25.0, 75.0, 100.0)),
    *({"closure": "stiction", "drive_speed": speed} for speed in (1.0, 1.9)),
]
FOLDS = [
    {},
    *({"stiffness": k} for k in (500.0, 2000.0)),
    *({"transition_force": force} for force in (25.0, 100.0)),
    *({"stick_speed": speed} for speed in (0.001, 0.05)),
    {"closure": "stiction"},
]


def values() -> dict[str, Any]:
    """Everything that stands in the file."""
    first, _ = events(Belt(), 3)
    return {
        "made_by": "python tests/reference/make_values.py",
        "units": "inches, ounces of force, seconds",
        "baseline": asdict(Belt()),
        "events_from_rest": [asdict(event) for event in first],
        "cycles": [{"change": change} | cycle(replace(Belt(), **change)) for change in CYCLES],
        "folds": [{"change": change, "fold": fold(replace(Belt(), **change))} for change in FOLDS],
    }


if __name__ == "__main__":
    PLACE.write_text(json.dumps(values(), indent=1) + "\n")
    sys.stdout.write(f"{PLACE.name}\n")
