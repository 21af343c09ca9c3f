"""Plans against grip and motor: random machines, each plan followed again by other means.

Every machine has a roll that grips so far, a motor that gives so much, a no-load torque, and for some a
static force or a closure of its own; grip and motor lie between too little to start the belt and plenty. One
in four is known but for shares of its parameters, the others are known.

Of each plan: its schedule is followed at a tolerance of 1e-12 with the grip in the motion (is there an event
of a roll that slips?) and without (the greatest spring force, 400 samples a lap), and by scipy's `solve_ivp`
with located events up to the end of the first slide, where the force is greatest. Of plans that count draws:
the share of 1000 fresh draws, of another seed, that slide for good from the plan's end on and never let the
roll slip or ask more than the motor gives; where that is below the bound that the plan states, of 20,000.

Usage: python -m benchmarks.plans [--cases 200] [--seconds 600] --out plans.jsonl
       python -m benchmarks.plans --table plans.jsonl

The lines go to the end of the file; machines that are in it already are not run again.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.stats import binom

import hersey
from benchmarks.plan import CONFIDENCE, Case, case, planned
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.plan import Plan
from hersey.stability.plan.draws import drawn
from hersey.stability.plan.trial import MachineSample

#: Fresh draws, and those that settle it where the share of the first is below the bound.
FRESH, SETTLED = 1000, 20_000
#: One machine in so many is not wholly known.
ONE_IN = 4
SLIDES = ("mixed", "ehl")


class Asked(Case):
    """A machine without the grip of its roll, what is asked of it, and what is not known of it."""

    @property
    def bears(self) -> float:
        """The spring force at which the roll slips or the motor gives up, N."""
        assert self.limits.motor_torque is not None
        assert self.roll_radius is not None
        return min(float(self.limits.grip or math.inf), self.limits.motor_torque / self.roll_radius)


def asked(number: int) -> Asked:
    """Return a random machine: the drive of `benchmarks.plan`, at one temperature, with what it can bear."""
    given, rng = case(number), np.random.default_rng([2027, number])
    end = None if given.temperature is None else given.temperature.at(1e9)
    drag = given.drag.at(end)
    drag = replace(
        drag,
        closure="stiction" if rng.uniform() < 0.1 else "retained",
        rest_force=drag.transition_force * rng.uniform(0.0, 0.3),
        rest_damping=drag.transition_force / drag.transition_speed * rng.uniform(0.0, 0.05),
    )
    if rng.uniform() < 0.3:
        drag = replace(drag, static_force=drag.breakaway_force * rng.uniform(0.6, 1.3))
    radius, load = rng.uniform(0.008, 0.025), rng.uniform(100.0, 400.0)
    grip, motor = (drag.holding_force * 0.95 * 3.0 ** rng.uniform() for _ in range(2))
    limits = replace(
        given.limits,
        spring_force=None,
        nip_load=load,
        roll_friction=grip / load,
        motor_torque=motor * radius,
    )
    known = number % ONE_IN
    shares = {**given.uncertainty, "rest_force": Uncertainty(share=rng.uniform(0.05, 0.3))}
    return Asked(given.train, drag, given.target, limits, None, {} if known else shares, radius)


def followed(given: Asked, plan: Plan) -> tuple[float, int]:
    """Return the greatest spring force of the plan's motion (N), and how often roll or motor give way."""
    assert plan.schedule is not None
    lap = MachineSample(given.train, given.drag).lap
    duration = plan.duration + 30.0 * lap
    bound = replace(given.train, grip=given.bears)
    free, held = (
        hersey.simulate(
            train,
            given.drag,
            drive_speed=plan.schedule,
            duration=duration,
            samples=math.ceil(400 * duration / lap),
            tolerance=1e-12,
        )
        for train in (given.train, bound)
    )
    slips = sum(event.guard == "grip_lost" for event in held.events)
    stretches = [abs(event.stretch) for event in free.events]
    return float(
        max(np.abs(free.spring_force).max(), given.train.stiffness * max(stretches, default=0.0))
    ), slips


def first_slide(given: Asked, plan: Plan) -> float:
    """Return the greatest spring force up to the end of the first slide, by scipy."""
    assert plan.schedule is not None
    drag, k, m = given.drag, given.train.stiffness, given.train.mass
    times, speeds = np.asarray(plan.schedule.times), np.asarray(plan.schedule.values)
    end = plan.duration + 10.0 * MachineSample(given.train, drag).lap

    def drive(t: float) -> float:
        return float(np.interp(t, times, speeds))

    def force(v: float) -> float:
        exponent = drag.ehl_exponent if v >= drag.transition_speed else drag.mixed_exponent
        contact = drag.transition_force * (v / drag.transition_speed) ** (1.0 + exponent)
        return contact + drag.rest_force + drag.rest_damping * v

    sticking = drag.transition_force * (drag.stick_speed / drag.transition_speed) ** (
        1.0 + drag.mixed_exponent
    )
    static = math.e * sticking if drag.static_force is None else drag.static_force
    decay = drag.stick_speed / math.log(static / sticking)

    def slow(v: float) -> float:
        return static * math.exp(-v / decay) + drag.rest_force + drag.rest_damping * v

    held = static + drag.rest_force
    grid = np.unique(np.concatenate([np.linspace(0.0, end, 20_001), times]))
    way = np.concatenate(
        [
            [0.0],
            np.cumsum(
                np.diff(grid)
                * 0.5
                * (np.interp(grid[1:], times, speeds) + np.interp(grid[:-1], times, speeds))
            ),
        ]
    )
    t = float(
        np.interp(held / k, way, grid)
    )  # near enough to start from; the way is summed exactly at the corners
    i = int(np.searchsorted(grid, t)) - 1
    slope = (drive(grid[i + 1]) - drive(grid[i])) / (grid[i + 1] - grid[i])
    roots = (
        np.roots([0.5 * slope, drive(grid[i]), way[i] - held / k])
        if slope
        else [(held / k - way[i]) / drive(grid[i])]
    )
    t = float(grid[i] + min(abs(r) for r in np.real(roots) if r > -1e-12))
    state, best, law = [held / k, 0.0], held, slow
    thresholds = {slow: drag.stick_speed, force: drag.transition_speed}
    while t < end:
        stops = [float(s) for s in times if s > t * (1 + 1e-12)]
        until = min([end, *stops])

        def rate(t: float, y: np.ndarray, law: Any = law) -> tuple[float, float]:
            return drive(t) - y[1], (k * y[0] - law(max(y[1], 1e-12))) / m

        def sticks(_: float, y: np.ndarray) -> float:
            return float(y[1] - drag.stick_speed)

        def passes(_: float, y: np.ndarray, law: Any = law) -> float:
            return float(y[1] - thresholds[law])

        def turns(t: float, y: np.ndarray) -> float:
            return drive(t) - float(y[1])

        sticks.direction, sticks.terminal = -1, law is force  # type: ignore[attr-defined]
        passes.terminal = law is slow  # type: ignore[attr-defined]
        run = solve_ivp(
            rate, (t, until), state, method="DOP853", rtol=1e-11, atol=1e-14, events=[sticks, passes, turns],
            first_step=1e-6 * (until - t),
        )  # fmt: skip
        found = [abs(k * float(y[0])) for y in run.y_events[2]]
        best = max(best, *found, abs(k * float(run.y[0, -1])))
        t, state = float(run.t[-1]), [float(x) for x in run.y[:, -1]]
        if run.status == 1:
            if law is force:
                return best
            law, state[1] = force, drag.stick_speed * (1 + 1e-14)
    return best


def holds(given: Asked, plan: Plan, count: int, seed: int) -> float:
    """Return the share of fresh draws that slide for good from the plan's end on and exceed nothing."""
    assert plan.schedule is not None
    machines, _ = drawn(given.train, given.drag, given.uncertainty, {}, np.random.default_rng(seed), count)
    good = 0
    for machine in machines:
        train, lap = replace(machine.train, grip=given.bears), machine.lap
        duration = plan.duration + 12.0 * lap
        run = hersey.simulate(
            train, machine.drag, drive_speed=plan.schedule, duration=duration, samples=2, tolerance=1e-11
        )
        before = [e for e in run.events if e.time <= plan.duration * (1 + 1e-9)]
        after = run.events[len(before) :]
        slides = bool(before) and before[-1].to_mode in SLIDES and all(e.to_mode in SLIDES for e in after)
        if not slides or any(e.guard == "grip_lost" for e in run.events):
            continue
        state = float(run.belt_speed[-1]), float(run.stretch[-1])
        settled = hersey.stick_slip(train, machine.drag, drive_speed=given.target, start=state)
        good += settled.kind == "steady_sliding"
    return good / count


def row_of(number: int) -> dict[str, Any]:
    """Return what is found of one machine."""
    given = asked(number)
    begin = time.perf_counter()
    plan = planned(given, seed=number + 1)
    row: dict[str, Any] = {
        "case": number,
        "kind": plan.kind,
        "starts": given.drag.holding_force <= given.bears,
        "draws": bool(given.uncertainty),
        "seconds": round(time.perf_counter() - begin, 2),
    }
    if not plan.found:
        return row | {"why": [o.limit for o in plan.obstacles]}
    force, slips = followed(given, plan)
    row |= {"use": force / given.bears, "slips": slips, "scipy": first_slide(given, plan) / force - 1.0}
    if given.uncertainty:
        row |= {"share_low": plan.share_low, "fresh": holds(given, plan, FRESH, 990_001)}
        if row["fresh"] < plan.share_low:
            row["settled"] = holds(given, plan, SETTLED, 990_002)
    return row


def table(rows: list[dict[str, Any]]) -> str:
    """Return the rows as a table."""
    found = [row for row in rows if "use" in row]
    drawn_often = [row for row in found if "fresh" in row]
    below = [row for row in drawn_often if "settled" in row]
    why = Counter(limit for row in rows for limit in row.get("why", []))
    refused = len(rows) - len(found)
    unlikely = [
        row for row in below if binom.cdf(round(row["settled"] * SETTLED), SETTLED, row["share_low"]) < 1e-3
    ]
    lines = [
        ("machines, plans found", f"{len(rows)}, {len(found)}"),
        ("kinds", ", ".join(f"{n} {kind}" for kind, n in Counter(r["kind"] for r in found).most_common())),
        ("refused", f"{refused}; limits named: " + ", ".join(f"{n} {w}" for w, n in why.most_common())),
        ("plans for a machine that its roll or motor does not start", sum(not r["starts"] for r in found)),
        ("plans in which the roll slips or the motor gives up", sum(r["slips"] > 0 for r in found)),
        (
            "greatest spring force over what roll and motor bear, nominal",
            f"{max(r['use'] for r in found):.5f} at most",
        ),
        ("plans that take more than 0.9 of it", sum(r["use"] > 0.9 for r in found)),
        (
            "greatest force of the first slide by scipy, relative to that of the motion",
            f"{max(r['scipy'] for r in found):+.1e} at most",
        ),
        ("plans that count draws", len(drawn_often)),
        (
            "share of 1000 fresh draws that holds",
            f"{min(r['fresh'] for r in drawn_often):.3f} at least, asked {CONFIDENCE}",
        ),
        ("bound (95 %) that the plans state", f"{min(r['share_low'] for r in drawn_often):.4f} at least"),
        ("share below the plan's own bound in 1000 draws", f"{len(below)} of {len(drawn_often)}"),
        ("of these still below it in 20,000 draws", sum(r["settled"] < r["share_low"] for r in below)),
        ("of these too far below it to be chance (1 in 1000)", len(unlikely)),
        (
            "time of a plan, median",
            f"{np.median([r['seconds'] for r in rows]):.1f} s, at most {max(r['seconds'] for r in rows):.0f}",
        ),
    ]
    return "\n".join(["| what | found |", "|---|---|", *(f"| {name} | {value} |" for name, value in lines)])


def main() -> None:
    """Print one line of JSON per machine, or the table of such lines."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--table", type=Path)
    given = parser.parse_args()
    if given.table is not None:
        print(table([json.loads(line) for line in given.table.read_text().splitlines()]))
        return
    before = given.out.read_text().splitlines() if given.out is not None and given.out.exists() else []
    done = {json.loads(line)["case"] for line in before}
    end = time.monotonic() + given.seconds
    for number in range(given.cases):
        if time.monotonic() > end:
            break
        if number not in done:
            line = json.dumps(row_of(number))
            if given.out is None:
                print(line, flush=True)
            else:
                with given.out.open("a") as file:
                    file.write(line + "\n")


if __name__ == "__main__":
    main()
