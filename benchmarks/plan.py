"""Drive profiles put to the test: random drives, each plan against fresh draws and against brute force.

Of every plan: the share of fresh draws (another seed, tolerance 1e-11) that slide for good from its end on
and keep all limits; and the quickest of a grid of up-over-down profiles that passes the plan's own rules on
its own draws. Infeasible drives are counted and left out.

With ``--compare``, the refinement of the search against `scipy.optimize` (differential evolution, and Nelder
and Mead), each from the same grid, on the same family, draws and rule of what works: the time of the quickest
profile found as a multiple of the own, and the wall time.

Usage: python -m benchmarks.plan [--cases 200] [--first 0] [--compare]
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import time
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import differential_evolution, minimize

import hersey
from hersey.machine.limits import Limits
from hersey.machine.machine import Machine
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.hysteresis import hysteresis
from hersey.stability.plan import Plan, plan_profile
from hersey.stability.plan.draws import drawn
from hersey.stability.plan.grid import Room
from hersey.stability.plan.obstacles import Reach
from hersey.stability.plan.proof import Unknown
from hersey.stability.plan.search import Search
from hersey.stability.plan.trial import MachineSample, Shape, TemperatureProfile, rounded

CONFIDENCE = 0.95
FRESH = 1000
GRID = (0.0, 0.15, 0.3, 0.6, 1.0, 2.0, 4.0)
#: Motions that scipy's searches may follow as a multiple of those of the own search.
MOTIONS = 1.5
#: Longest rise, hold and fall of scipy's searches, laps.
LONGEST = 40.0
#: A profile slower than the best by this factor counts as failed.
BELOW = 1.5


@dataclass(frozen=True)
class Case:
    """A drive, what is asked of it, and what is not known of it."""

    train: hersey.Drivetrain
    drag: hersey.Drag
    target: float
    limits: Limits
    temperature: hersey.Schedule | None
    uncertainty: dict[str, Uncertainty]
    roll_radius: float | None = None


def case(number: int) -> Case:
    """Return a random drive in SI units, about the size of a fuser."""
    rng = np.random.default_rng([2026, number])

    def between(low: float, high: float) -> float:
        return float(low * (high / low) ** rng.uniform())

    train = hersey.Drivetrain(between(3e3, 3e4), between(0.3, 12.0))
    speed = between(0.01, 0.05)
    force = between(0.15, 0.9) * speed * math.sqrt(train.stiffness * train.mass) * 2.0
    drag = hersey.Drag(
        force,
        speed,
        ehl_exponent=-rng.uniform(0.5, 0.8),
        mixed_exponent=-rng.uniform(1.1, 1.35),
        stick_speed=speed * between(0.003, 0.05),
    )
    band = hersey.hysteresis(train, drag, sensitivity=False)
    target = band.transition * between(1.12, 1.25 * max(band.upper / band.transition, 1.2))
    lap = 2.0 * math.pi * math.sqrt(train.mass / train.stiffness)
    warm = rng.uniform() < 0.2
    temperature = None
    if warm:
        ends = (300.0, 400.0) if rng.uniform() < 0.7 else (380.0, 330.0)
        temperature = hersey.Schedule([0.0, 20.0, 30.0], [ends[0], ends[1], ends[1]])
        drag = replace(
            drag,
            reference_temperature=ends[1],
            force_temperature_exponent=-rng.uniform(0.3, 1.2),
            speed_temperature_exponent=rng.uniform(0.2, 0.8),
            temperature_zero=200.0,
        )
    limits = Limits(
        speed=between(1.3, 3.0) * max(band.upper, target),
        acceleration=None if rng.uniform() < 0.1 else target / (lap * between(0.1, 3.0)),
        spring_force=drag.breakaway_force * between(1.25, 2.0) if rng.uniform() < 0.4 else None,
    )
    uncertainty = {
        "stiffness": Uncertainty(share=rng.uniform(0.05, 0.15)),
        "transition_force": Uncertainty(share=rng.uniform(0.03, 0.1)),
        "transition_speed": Uncertainty(share=rng.uniform(0.01, 0.05)),
        "stick_speed": Uncertainty(share=rng.uniform(0.1, 1.0)),
    }
    if rng.uniform() < 0.15:
        uncertainty = {}
    return Case(train, drag, target, limits, temperature, uncertainty)


def planned(given: Case, seed: int) -> Plan:
    """Return the plan of a case."""
    return plan_profile(
        Machine(
            given.train.stiffness,
            given.train.mass,
            given.roll_radius or 0.02,
            given.drag.stick_speed,
            limits=given.limits,
            uncertainty=given.uncertainty,
        ),
        given.drag,
        target_speed=given.target,
        temperature=given.temperature,
        confidence=CONFIDENCE,
        seed=seed,
    )


def fresh_share(given: Case, plan: Plan, draws: int = FRESH, seed: int = 990_001) -> float:
    """Return the share of fresh draws that slide for good from the end of the plan on, limits kept."""
    assert plan.schedule is not None
    times, speeds = np.asarray(plan.schedule.times), np.asarray(plan.schedule.values)
    steps = np.diff(times)
    assert speeds.max() <= (given.limits.speed or math.inf) * (1 + 1e-9)
    if given.limits.acceleration is not None:
        assert np.all(np.abs(np.diff(speeds)) <= given.limits.acceleration * steps * (1 + 1e-6))
    rng = np.random.default_rng(seed)
    machines, _ = drawn(
        given.train, given.drag, given.uncertainty, {}, rng, draws if given.uncertainty else 1
    )
    good = 0
    for machine in machines:
        course_end = 0.0 if given.temperature is None else 30.0
        duration = max(plan.duration + 12.0 * machine.lap, course_end)
        run = hersey.simulate(
            machine.train,
            machine.drag,
            drive_speed=plan.schedule,
            temperature=given.temperature,
            duration=duration,
            samples=20 * math.ceil(duration / machine.lap) + 2,
            tolerance=1e-11,
        )
        ends = [e for e in run.events if e.time <= plan.duration * (1 + 1e-9)]
        slides = bool(ends) and ends[-1].to_mode not in ("stuck", "microslip")
        later = any(e.to_mode in ("stuck", "microslip") for e in run.events[len(ends) :])
        course = None if given.temperature is None else given.temperature.at(1e9)
        cycle = hersey.stick_slip(
            machine.train,
            machine.drag,
            drive_speed=given.target,
            temperature=course,
            start=(float(run.belt_speed[-1]), float(run.stretch[-1])),
            tolerance=1e-11,
        )
        force = (
            max(np.abs(run.spring_force).max(), *(abs(e.stretch) for e in run.events)) if run.events else 0
        )
        force = max(float(np.abs(run.spring_force).max()), force)
        within = force <= (given.limits.spring_force or math.inf)
        good += slides and not later and cycle.kind == "steady_sliding" and within
    return good / len(machines)


def brute_force(given: Case, plan: Plan, seed: int) -> tuple[float, Shape | None]:
    """Return the time of the quickest profile of a grid that is quicker than the plan, or the plan's."""
    course = TemperatureProfile(given.temperature)
    unknown = Unknown(given.train, given.drag, given.uncertainty, {}, seed)
    trials = unknown.trials(CONFIDENCE, course, Reach.of(given.limits, None).force)
    lap = trials.machines[0].lap
    most = given.limits.acceleration or plan.greatest_speed / (0.05 * lap)
    waits = np.linspace(0.0, course.end, 13).tolist() if given.temperature is not None else [0.0]
    peaks = np.linspace(given.target, plan.greatest_speed, 8).tolist()
    shapes = [
        Shape(
            given.target, peak, peak / (most * share), h * lap, (peak - given.target) / most + f * lap, wait
        )
        for wait, peak, share, h, f in itertools.product(waits, peaks, (1.0, 0.7, 0.4, 0.2), GRID, GRID)
    ]
    best, found = plan.duration, None
    for shape in sorted(set(shapes), key=lambda s: s.end):
        if shape.end >= best:
            break
        value = trials.time(shape, best)
        if value < best:
            proof = unknown.verify(shape, rounded(value, up=True), course, trials.force_limit, CONFIDENCE, 1)
            if proof.accepted:
                best, found = value, shape
    return best, found


def search_of(given: Case, draws: int, seed: int) -> Search:
    """Return the search of a case as the planner sets it up; ``draws`` is the seed of the machines."""
    thermal, reach = TemperatureProfile(given.temperature), Reach.of(given.limits, None)
    end = thermal.at(thermal.end)
    band = hysteresis(given.train, given.drag, temperature=end, sensitivity=False)
    trials = Unknown(given.train, given.drag, given.uncertainty, {}, draws).trials(
        CONFIDENCE, thermal, reach.force
    )
    room = Room(given.limits.speed or 3.0 * band.upper, reach.acceleration)
    return Search(MachineSample(given.train, given.drag), trials, thermal, given.target, room, seed=seed)


def trials_of(search: Search) -> int:
    """Return how many motions of a machine a search has followed."""
    return search.count + search.trials.count


def started(search: Search) -> list[tuple[float, Shape]]:
    """Run the grid of the own search alone, and return the profiles from which its refinement would start."""
    search.over_grids()
    return search.starts() if search.best is not None else []


class Family:
    """The profiles of a search as points of a unit cube, and what scipy minimises over it."""

    def __init__(self, search: Search, budget: float) -> None:
        """Count motions up to the budget, after which every profile counts as failed."""
        self.search, self.budget, self.limit = search, budget, math.inf
        self.lap, self.span = search.nominal.lap, max(search.room.speed - search.target, 0.0)
        self.worst = 200.0 * self.lap + 2.0 * search.thermal.end
        self.sides = 4 if len(search.waits()) == 1 else 5  # no wait helps where the temperature stays

    def spent(self, *_: object, **__: object) -> bool:
        """Return whether the motions of the budget have been followed."""
        return trials_of(self.search) >= self.budget

    def shape(self, row: np.ndarray) -> Shape:
        """Return the profile of a point."""
        peak = self.search.target + row[0] * self.span
        rise, hold, fall = (LONGEST * self.lap * x**2 for x in row[1:4])
        wait = row[4] * self.search.thermal.end if self.sides > 4 else 0.0
        return self.search.room.shape(self.search.target, peak, rise, hold, fall, wait)

    def row(self, shape: Shape) -> np.ndarray:
        """Return the point of a profile."""
        least = self.search.room.shape(shape.target, shape.peak, 0.0, 0.0, 0.0)
        spare = (shape.rise - least.rise, shape.hold, shape.fall - least.fall)
        row = [(shape.peak - shape.target) / (self.span or 1.0)]
        row += [math.sqrt(max(time, 0.0) / (LONGEST * self.lap)) for time in spare]
        row += [shape.wait / (self.search.thermal.end or 1.0)]
        return np.clip(row[: self.sides], 0.0, 1.0)

    def value(self, row: np.ndarray) -> float:
        """Return the time of the profile at a point; a great number if it fails or is far from the best."""
        if self.spent():
            return self.worst
        took = self.search.attempt(self.shape(np.clip(row, 0.0, 1.0)), self.limit)
        if took == math.inf:
            return self.worst
        self.limit = min(self.limit, took * BELOW)
        return took


def evolved(search: Search, budget: float, seed: int) -> None:
    """Let differential evolution go on from the profiles that the grid found."""
    starts, family = started(search), Family(search, budget)
    if not starts:
        return
    rng = np.random.default_rng(seed)
    rows = np.array([family.row(shape) for _, shape in starts])
    crowd = rows[rng.integers(0, len(rows), 15 * family.sides)]
    crowd = crowd + rng.standard_normal(crowd.shape) * np.exp(rng.uniform(-6.0, -1.2, (len(crowd), 1)))
    crowd[: len(rows)] = rows
    differential_evolution(
        family.value,
        [(0.0, 1.0)] * family.sides,
        init=np.clip(crowd, 0.0, 1.0),
        rng=seed,
        maxiter=100_000,
        tol=0.0,
        polish=False,
        callback=family.spent,
    )


def descended(search: Search, budget: float, seed: int) -> None:
    """Let Nelder and Mead go down from each of the profiles that the grid found, then again from the best."""
    starts, family = started(search), Family(search, budget)
    rng = np.random.default_rng(seed)
    rows = [family.row(shape) for _, shape in starts]
    for round_ in itertools.count():
        for row in rows:
            sizes = np.exp(rng.uniform(-5.0, -1.5, family.sides)) * rng.choice((-1.0, 1.0), family.sides)
            simplex = np.clip(np.vstack([row, row + np.diag(sizes)]), 0.0, 1.0)
            family.limit = math.inf
            minimize(
                family.value,
                row,
                method="Nelder-Mead",
                options={"initial_simplex": simplex, "maxfev": 300, "xatol": 1e-4, "fatol": 1e-9},
            )
        if search.best is None or family.spent() or round_ > 200:
            return
        rows = [family.row(search.best)]


def compared(number: int, motions: float) -> None:
    """Print a line: time in laps and motions of the own search, and of scipy's from the same grid."""
    given = case(number)
    own = search_of(given, number + 1, 0)
    begin = time.perf_counter()
    own.run()
    row: dict[str, object] = {"case": number, "own": own.time / own.nominal.lap, "motions": trials_of(own)}
    row["s"] = took = time.perf_counter() - begin
    for name, other in (("evolution", evolved), ("simplex", descended)):
        search = search_of(given, number + 1, 0)
        begin = time.perf_counter()
        other(search, motions * trials_of(own), 0)
        search.settle()
        row[name] = search.time / own.time if own.best is not None else search.time / own.nominal.lap
        row[f"s {name}"] = (time.perf_counter() - begin) / took
    print(json.dumps(row), flush=True)


def main() -> None:
    """Print one line of JSON per case."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--compare", action="store_true")
    asked = parser.parse_args()
    if asked.compare:
        for number in range(asked.first, asked.first + asked.cases):
            compared(number, MOTIONS)
        return
    feasible, number = 0, asked.first
    while feasible < asked.cases:
        given, seed = case(number), number + 1
        begin = time.perf_counter()
        plan = planned(given, seed)
        took = time.perf_counter() - begin
        row: dict[str, object] = {"case": number, "kind": plan.kind, "seconds": round(took, 2)}
        if plan.found:
            feasible += 1
            best, shape = brute_force(given, plan, seed)
            row |= {
                "duration": plan.duration,
                "wait": plan.wait,
                "share": plan.share,
                "share_low": round(plan.share_low, 4),
                "fresh": fresh_share(given, plan),
                "brute": best / plan.duration,
                "by": None if shape is None else vars(shape),
            }
        else:
            row["why"] = [o.text for o in plan.obstacles]
        print(json.dumps(row), flush=True)
        number += 1


if __name__ == "__main__":
    main()
