"""Drive profiles put to the test: random drives, each plan against fresh draws and against brute force.

Of every plan: the share of fresh draws (another seed, tolerance 1e-11) that slide for good from its end on
and keep all limits; and the quickest of a grid of up-over-down profiles that passes the plan's own rules on
its own draws. Infeasible drives are counted and left out.

Usage: python -m benchmarks.plan [--cases 200] [--first 0]
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import time
from dataclasses import dataclass, replace

import numpy as np

import hersey
from hersey.machine.machine import Limits
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.plan import Plan, plan_profile
from hersey.stability.plan.draws import drawn
from hersey.stability.plan.obstacles import Reach
from hersey.stability.plan.planner import Unknown
from hersey.stability.plan.trial import Shape, TemperatureProfile, rounded

CONFIDENCE = 0.95
FRESH = 1000
GRID = (0.0, 0.15, 0.3, 0.6, 1.0, 2.0, 4.0)


@dataclass(frozen=True)
class Case:
    """A drive, what is asked of it, and what is not known of it."""

    train: hersey.Drivetrain
    drag: hersey.Drag
    target: float
    limits: Limits
    temperature: hersey.Schedule | None
    uncertainty: dict[str, Uncertainty]


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
        given.train,
        given.drag,
        target_speed=given.target,
        temperature=given.temperature,
        limits=given.limits,
        uncertainty=given.uncertainty,
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
    machines = drawn(given.train, given.drag, given.uncertainty, {}, rng, draws if given.uncertainty else 1)
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


def main() -> None:
    """Print one line of JSON per case."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    asked = parser.parse_args()
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
