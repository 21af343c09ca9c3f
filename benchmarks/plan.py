"""Drive profiles put to the test: random drives, each plan against fresh draws and against brute force.

Of every plan: the share of fresh draws (another seed, tolerance 1e-11) that slide for good from its end on
and keep all limits; and the quickest of a grid of up-over-down profiles that passes the plan's own rules on
its own draws. Infeasible drives are counted and left out.

With ``--compare``, the search alone against `scipy.optimize.differential_evolution` on the same family, the
same draws and the same rule of what works: the quickest profile found, and the trials of a machine it took.

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
from scipy.optimize import differential_evolution

import hersey
from hersey.machine.limits import Limits
from hersey.machine.machine import Machine
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.hysteresis import hysteresis
from hersey.stability.plan import Plan, plan_profile
from hersey.stability.plan.draws import drawn
from hersey.stability.plan.obstacles import Reach
from hersey.stability.plan.planner import Unknown
from hersey.stability.plan.search import Room, Search
from hersey.stability.plan.trial import MachineSample, Shape, TemperatureProfile, rounded

CONFIDENCE = 0.95
FRESH = 1000
GRID = (0.0, 0.15, 0.3, 0.6, 1.0, 2.0, 4.0)
#: Seeds of the comparison, and trials of the evolution as multiples of those of the own search.
SEEDS, BUDGETS = 3, (1, 3)
#: Longest rise, hold and fall of the evolution, laps; what is so much slower than its best counts as failed.
LONGEST, BELOW = 12.0, 1.5


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


def evolved(search: Search, budget: int, seed: int) -> None:
    """Let differential evolution search, until it has followed so many motions."""
    lap, room, target = search.nominal.lap, search.room, search.target
    limit = [math.inf]
    worst = 100.0 * lap + search.thermal.end

    def shape(row: np.ndarray) -> Shape:
        peak = target + row[0] * max(room.speed - target, 0.0)
        rise, hold, fall = (LONGEST * lap * x**2 for x in row[1:4])
        return room.shape(target, peak, rise, hold, fall, row[4] * search.thermal.end if len(row) > 4 else 0)

    def value(row: np.ndarray) -> float:
        took = search.attempt(shape(row), limit[0])
        if took == math.inf:
            return 2.0 * worst
        limit[0] = min(limit[0], took * BELOW)
        return took

    def spent(*_: object, **__: object) -> bool:
        return trials_of(search) >= budget

    sides = 4 if len(search.waits()) == 1 else 5  # no wait helps where the temperature stays
    differential_evolution(
        value, [(0.0, 1.0)] * sides, rng=seed, maxiter=100_000, tol=0.0, polish=False, callback=spent
    )


def compared(number: int, seeds: int) -> None:
    """Print a line for each seed: times in laps and trials of the own search and of the evolution."""
    given = case(number)
    for seed in range(seeds):
        row: dict[str, object] = {"case": number, "seed": seed}
        own = search_of(given, number + 1, seed)
        begin = time.perf_counter()
        own.run()
        if own.best is None:
            return
        lap = own.nominal.lap
        row |= {"own": own.time / lap, "trials": trials_of(own), "s": time.perf_counter() - begin}
        for budget in BUDGETS:
            other = search_of(given, number + 1, seed)
            begin = time.perf_counter()
            evolved(other, budget * trials_of(own), seed)
            took = time.perf_counter() - begin
            row[f"evolved {budget}"] = other.time / own.time
            row[f"s {budget}"] = took
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
            compared(number, SEEDS)
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
